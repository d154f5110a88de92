#include "photos/run_colmap.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <utility>

#include "error.h"
#include "file_bytes.h"
#include "photos/colmap_advice.h"
#include "photos/colmap_work.h"
#include "photos/photo_folder.h"
#include "photos/quiet_progress.h"
#include "photos/run_stage.h"
#include "photos/sift_matches.h"
#include "photos/sift_stages.h"
#include "photos/sparse_points.h"
#include "photos/track_stages.h"

namespace treerec {

namespace {

namespace fs = std::filesystem;

constexpr double kSiftEnd = 0.7;      // where corners are tracked, too, as a share of the whole
constexpr double kAloneShare = 0.02;  // of the whole: placing cameras by SIFT alone, before that
constexpr const char* kBlanks =
    "Some photos' names have blanks in them: rename them for corners to be tracked.";
constexpr const char* kSiftDatabase = "matching.db";

struct Model {
    fs::path folder;
    std::set<std::string> photos;
};

// COLMAP's models in a folder, the one with most photos first.
std::vector<Model> models_in(const fs::path& folder, Progress* whole) {
    QuietProgress progress(whole);
    std::vector<Model> models;
    std::error_code failure;
    for (fs::directory_iterator at(folder, failure), end; !failure && at != end; at.increment(failure)) {
        std::error_code ignored;
        if (!fs::is_regular_file(at->path() / "images.bin", ignored)) continue;
        Model model{at->path(), {}};
        for (const Photo& photo : read_photo_model(utf8_of(model.folder), &progress).photos)
            model.photos.insert(photo.name);
        models.push_back(std::move(model));
    }
    std::sort(models.begin(), models.end(), [](const Model& a, const Model& b) {
        return a.photos.size() != b.photos.size() ? a.photos.size() > b.photos.size() : a.folder < b.folder;
    });
    return models;
}

void replace_folder(const fs::path& made, const fs::path& target) {
    std::error_code failure;
    fs::remove_all(target, failure);
    if (!failure) fs::rename(made, target, failure);
    if (failure)
        throw Error("The folder '" + utf8_of(target) + "' cannot be written: " + failure.message() + ".");
}

void copy_model(const fs::path& model, const fs::path& sparse) {
    const fs::path part = sparse.parent_path() / "colmap" / "sparse.part";
    std::error_code failure;
    fs::remove_all(part, failure);
    fs::create_directories(part, failure);
    if (!failure) fs::copy(model, part / "0", fs::copy_options::recursive, failure);
    if (failure) throw Error("'" + utf8_of(part) + "' could not be written: " + failure.message() + ".");
    replace_folder(part, sparse);
}

// What the mapper made of one database.
struct Mapped {
    std::string database;
    std::string part;  // the folder of the models, in out/colmap
    std::vector<Model> models;
    PhotoJoints joints;  // of the largest one

    size_t placed() const { return models.empty() ? 0 : models[0].photos.size(); }
    bool sound() const { return joints.contradictions.empty(); }
};

// What was placed against its own matches is worth less than half as many photos.
bool better(const Mapped& one, const Mapped& other) {
    if (one.sound() != other.sound()) {
        const Mapped &sound = one.sound() ? one : other, &bent = one.sound() ? other : one;
        if (2 * sound.placed() >= bent.placed()) return one.sound();
    }
    if (one.placed() != other.placed()) return one.placed() > other.placed();
    return one.joints.weak.empty() && !other.joints.weak.empty();
}

// What a model's points tell, and what the matches say of it that are in a database.
PhotoJoints judge(ColmapWork& work, const PhotoModel& model, const std::vector<CameraAround>& around,
                  const std::vector<SparsePoint>& points, const std::string& database) {
    const Progress* const progress = work.job.progress();
    PhotoJoints joints;
    joints.weak = weak_joints(joints_around(model, around, points, progress));
    std::vector<std::string> names;
    for (const PhotoFile& photo : work.photos.photos)
        names.push_back(photo.name);
    try {
        const std::vector<PhotoPlaceMatches> matches = read_sift_matches(work.at(database), work.photos);
        joints.contradictions = contradictions_in(model, around, matches, names, progress);
    } catch (const Cancelled&) {
        throw;
    } catch (const Error& error) {
        // The model is there all the same.
        work.job.note(std::string("-- the places could not be compared with the matches. ") + error.what());
    }
    return joints;
}

std::vector<DVec3> positions_of(const std::vector<SparsePoint>& points) {
    std::vector<DVec3> positions;
    for (const SparsePoint& point : points)
        positions.push_back(point.position);
    return positions;
}

// Finds the cameras' places, from what is in a database, into a folder of models. begin, end: its share of
// the whole.
Mapped map_cameras(ColmapWork& work, ColmapCall call, const std::string& database, const std::string& folder,
                   double begin, double end_of_it) {
    Progress* const progress = work.job.progress();
    Mapped mapped{database, folder, {}, {}};
    const fs::path part = work.folder / folder;
    call.places.insert(call.places.end(), {"--database_path", work.at(database), "--image_path",
                                           work.photos.path, "--output_path", utf8_of(part)});
    std::error_code failure;
    fs::remove_all(part, failure);
    make_folder(utf8_of(part));
    const size_t all = work.photos.photos.size();
    size_t most = 0;
    bool none = false;
    if (progress) progress->update(begin, "Cameras");
    const ColmapEnd end = work.job.run(call, [&](const std::string& line) {
        none = none || line.find("failed to create") != std::string::npos ||
               line.find("Failed to create") != std::string::npos;
        if (line.find("Registering image") == std::string::npos) return;
        const size_t count = number_after(line, "(");
        if (!progress || count <= most || count > all) return;
        most = count;
        progress->update(begin + (end_of_it - begin) * static_cast<double>(count) / static_cast<double>(all),
                         "Cameras");
        progress->count(count, all);
    });
    mapped.models = models_in(part, progress);
    if (!end.end.well() && !(mapped.models.empty() && none)) throw work.job.failure(call, end);
    if (mapped.models.empty()) return mapped;
    QuietProgress quiet(progress);
    const std::string largest = utf8_of(mapped.models[0].folder);
    const PhotoModel model = read_photo_model(largest, &quiet);
    const std::vector<SparsePoint> points = read_sparse_points(largest, &quiet);
    mapped.joints = judge(work, model, cameras_around(model, positions_of(points)), points, database);
    return mapped;
}

// What the model that was taken was made of.
struct Placed {
    std::string database;
    // Photos that SIFT's matches alone had placed, where that was not enough, and more were looked for.
    std::optional<size_t> by_sift;
};

constexpr const char* kTaken = "model of: ";
constexpr const char* kBySift = ", by SIFT alone: ";

std::string note_of(const Placed& placed) {
    return kTaken + placed.database + (placed.by_sift ? kBySift + std::to_string(*placed.by_sift) : "");
}

// before: the basis of what is matched. tracked: corners are, or may be where the matcher is auto.
Placed place_cameras(ColmapWork& work, const std::string& before, bool tracked) {
    const bool automatic = work.options.matcher == PhotoMatcher::kAuto;
    const bool both = work.options.matcher == PhotoMatcher::kBoth;
    Placed placed{tracked && !automatic ? kTracksDatabase : kSiftDatabase, {}};
    ColmapCall call{"mapper", {}, {}};
    // COLMAP's own 30 are too many where leaves move, and few points agree. 15 also take photos that are
    // too far from all others, and put these up to a tenth of the circle beside their place.
    work.job.set(call.settings, call.command, {"--Mapper.abs_pose_min_num_inliers"}, "20");
    work.set_threads(call, {"--Mapper.num_threads"});
    RunStage stage(work.at("models.json"), basis_of((automatic ? "auto\n" : "") + before, {call}));
    if (stage.done() && fs::exists(work.sparse / "0" / "images.bin")) {
        if (stage.note().find(kTracksDatabase) != std::string::npos) placed.database = kTracksDatabase;
        if (stage.note().find(kSiftDatabase) != std::string::npos) placed.database = kSiftDatabase;
        if (stage.note().find(kBySift) != std::string::npos)
            placed.by_sift = number_after(stage.note(), kBySift);
        return placed;
    }

    stage.begin();
    const bool once = !automatic || !tracked;
    const double first_begin = once ? kMatchingEnd : work.sift_end,
                 first_end = once ? 1.0 : work.sift_end + kAloneShare;
    Mapped taken = map_cameras(work, call, placed.database, "models.part", first_begin, first_end);
    const auto weigh = [&](Mapped other) {
        if (better(other, taken)) std::swap(taken, other);
    };
    const bool whole = taken.placed() == work.photos.photos.size() && taken.sound();
    if (automatic && tracked && !(whole && taken.joints.weak.empty())) {
        work.job.note("-- SIFT's matches alone place " + std::to_string(taken.placed()) +
                      " photos, or some of them doubtfully: corners are tracked, too");
        work.sift_end = first_end;
        try {
            track_photos(work, before);
            const size_t by_sift = taken.placed();
            weigh(map_cameras(work, call, kTracksDatabase, "models.more", kMatchingEnd, 1.0));
            placed.by_sift = by_sift;
        } catch (const Cancelled&) {
            throw;
        } catch (const Error& error) {
            if (taken.models.empty()) throw;
            // What was only to be made better is there all the same.
            work.warnings.push_back(no_more_matches(error.what()));
        }
    } else if (both && placed.database == kTracksDatabase && !whole) {
        // More matches may also mislead: what SIFT's alone place is not given away.
        work.job.note("-- once more, with SIFT's matches alone");
        weigh(map_cameras(work, call, kSiftDatabase, "models.more", kMatchingEnd, 1.0));
    }
    if (taken.models.empty()) throw none_registered(work.photos.photos.size(), work.usual_features);
    placed.database = taken.database;
    const fs::path models = work.folder / "models";
    replace_folder(work.folder / taken.part, models);
    std::error_code failure;
    for (const char* left : {"models.part", "models.more"})
        fs::remove_all(work.folder / left, failure);
    copy_model(models / taken.models[0].folder.filename(), work.sparse);
    stage.finish(note_of(placed));
    return placed;
}

ColmapRun tell(ColmapWork& work, const Placed& placed) {
    QuietProgress quiet(work.job.progress());
    Progress* const progress = &quiet;
    ColmapRun run;
    run.model = utf8_of(work.sparse / "0");
    run.version = work.job.colmap().version();
    run.photos = work.photos.photos.size();
    const PhotoModel model = read_photo_model(run.model, progress);
    std::set<std::string> known;
    for (const Photo& photo : model.photos)
        known.insert(photo.name);
    run.registered = known.size();
    for (const PhotoFile& photo : work.photos.photos)
        if (!known.count(photo.name)) run.missing.push_back(photo.name);
    const std::vector<SparsePoint> points = read_sparse_points(run.model, progress);
    const std::vector<DVec3> positions = positions_of(points);
    run.around = cameras_around(model, positions);
    run.widest_gap = widest_gap_of(run.around);
    run.joints = judge(work, model, run.around, points, placed.database);
    run.gps = ask_gps(model, work.photos.path, positions, progress);
    // Of each further model, what no other one has.
    std::vector<size_t> sizes;
    std::set<std::string> seen;
    for (const Model& one : models_in(work.folder / "models", progress)) {
        const size_t before = seen.size();
        seen.insert(one.photos.begin(), one.photos.end());
        sizes.push_back(seen.size() - before);
    }
    std::sort(sizes.begin() + (sizes.empty() ? 0 : 1), sizes.end(), std::greater<>());
    run.warnings = work.photos.warnings;
    run.warnings.insert(run.warnings.end(), work.warnings.begin(), work.warnings.end());
    if (work.unreadable > 0)
        run.warnings.push_back(std::to_string(work.unreadable) +
                               " of the photos could not be read; open them, and save them again.");
    if (placed.by_sift && placed.database == kTracksDatabase)
        run.warnings.push_back(more_matches(*placed.by_sift, run));
    const bool further =
        work.options.matcher == PhotoMatcher::kSift || work.options.matcher == PhotoMatcher::kPyrlk;
    const std::vector<std::string> advice = advice_on(run, sizes, further);
    run.warnings.insert(run.warnings.end(), advice.begin(), advice.end());
    return run;
}

}  // namespace

PhotoOrder parse_photo_order(const std::string& word) {
    if (word == "auto") return PhotoOrder::kAuto;
    if (word == "sequence") return PhotoOrder::kSequence;
    if (word == "exhaustive") return PhotoOrder::kExhaustive;
    throw Error("The photos' order is auto, sequence or exhaustive, not " + quote_word(word) + ".");
}

PhotoMatcher parse_photo_matcher(const std::string& word) {
    if (word == "auto") return PhotoMatcher::kAuto;
    if (word == "sift") return PhotoMatcher::kSift;
    if (word == "pyrlk") return PhotoMatcher::kPyrlk;
    if (word == "both") return PhotoMatcher::kBoth;
    throw Error("Photos are matched by auto, sift, pyrlk or both, not " + quote_word(word) + ".");
}

PhotoEffort parse_photo_effort(const std::string& word) {
    if (word == "quick") return PhotoEffort::kQuick;
    if (word == "normal") return PhotoEffort::kNormal;
    if (word == "best") return PhotoEffort::kBest;
    throw Error("The time for photos is quick, normal or best, not " + quote_word(word) + ".");
}

std::string claim_folder(const std::string& out, const std::string& photos) {
    std::error_code failure;
    const fs::path whole = fs::absolute(path_of(out), failure).lexically_normal();
    if (failure) throw Error("The folder '" + out + "' cannot be reached.");
    if (fs::equivalent(whole, path_of(photos), failure))
        throw Error("'" + utf8_of(whole) +
                    "' is the folder of the photos itself; name another one to write to.");
    const fs::path work = whole / "colmap";
    const bool ours = fs::exists(work / "lock", failure) ||
                      (fs::is_directory(work, failure) && fs::is_empty(work, failure));
    // With what 'treerec photos' puts beside it.
    for (const char* name :
         {"colmap", "sparse", "cloud.ply", "photos.log", "tree.glb", "tree.txt", "report.json", "report.html",
          "compare.png", "stages.png", "fidelity.png", "bark"})
        if (!ours && fs::exists(whole / name, failure))
            throw Error(
                "'" + utf8_of(whole / name) +
                "' is there already, and is not from photos that were worked on here; it was left as it "
                "is. Name another folder to write to.");
    make_folder(utf8_of(work));
    return utf8_of(whole);
}

ColmapRun run_colmap(const std::string& folder, const std::string& out, const ColmapOptions& options,
                     Progress* progress) {
    if (progress) progress->update(0.0, "Photos");
    const PhotoFolder photos = list_photos(folder);
    if (photos.photos.size() < kLeastPhotos) throw too_few_photos(photos.photos.size(), folder);
    Colmap colmap = find_colmap(options.program, progress);
    const fs::path whole = path_of(claim_folder(out, photos.path));
    FolderLock lock(utf8_of(whole / "colmap" / "lock"));
    ColmapJob job(std::move(colmap), utf8_of(whole / "photos.log"), lock, progress);
    ColmapWork work{job, photos, options, whole / "colmap", whole / "sparse"};
    const bool sift = options.matcher != PhotoMatcher::kPyrlk;
    bool tracked = options.matcher != PhotoMatcher::kSift;
    if (tracked && !names_can_be_paired(photos)) {
        if (!sift) throw Error(kBlanks);
        if (options.matcher == PhotoMatcher::kBoth) work.warnings.emplace_back(kBlanks);
        tracked = false;
    }
    if (tracked && sift) work.sift_end = kSiftEnd;
    std::string basis;
    if (sift) basis = match_photos(work, find_features(work));
    if (tracked && options.matcher != PhotoMatcher::kAuto) basis = track_photos(work, basis);
    const Placed placed = place_cameras(work, basis, tracked);
    const ColmapRun run = tell(work, placed);
    for (const std::string& warning : run.warnings)
        job.note("-- " + warning);
    return run;
}

}  // namespace treerec
