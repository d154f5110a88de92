#include "photos/run_colmap.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "error.h"
#include "file_bytes.h"
#include "photos/colmap_advice.h"
#include "photos/colmap_work.h"
#include "photos/photo_folder.h"
#include "photos/quiet_progress.h"
#include "photos/run_stage.h"
#include "photos/sift_stages.h"
#include "photos/sparse_points.h"
#include "photos/track_stages.h"

namespace treerec {

namespace {

namespace fs = std::filesystem;

constexpr double kSiftEnd = 0.7;  // where corners are tracked, too, as a share of the whole

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

// Finds the cameras' places, from what is in a database, into a folder of models. The models.
std::vector<Model> map_cameras(ColmapWork& work, ColmapCall call, const std::string& database,
                               const std::string& folder) {
    Progress* const progress = work.job.progress();
    const fs::path part = work.folder / folder;
    call.places.insert(call.places.end(), {"--database_path", work.at(database), "--image_path",
                                           work.photos.path, "--output_path", utf8_of(part)});
    std::error_code failure;
    fs::remove_all(part, failure);
    make_folder(utf8_of(part));
    const size_t all = work.photos.photos.size();
    size_t most = 0;
    bool none = false;
    const ColmapEnd end = work.job.run(call, [&](const std::string& line) {
        none = none || line.find("failed to create") != std::string::npos ||
               line.find("Failed to create") != std::string::npos;
        if (line.find("Registering image") == std::string::npos) return;
        const size_t count = number_after(line, "(");
        if (!progress || count <= most || count > all) return;
        most = count;
        progress->update(
            kMatchingEnd + (1.0 - kMatchingEnd) * static_cast<double>(count) / static_cast<double>(all),
            "Cameras");
        progress->count(count, all);
    });
    std::vector<Model> found = models_in(part, progress);
    if (!end.end.well() && !(found.empty() && none)) throw work.job.failure(call, end);
    return found;
}

void place_cameras(ColmapWork& work, const std::string& before, const std::string& database) {
    Progress* const progress = work.job.progress();
    ColmapCall call{"mapper", {}, {}};
    // COLMAP's own 30 are too many where leaves move, and few points agree. 15 also take photos that are
    // too far from all others, and put these up to a tenth of the circle beside their place.
    work.job.set(call.settings, call.command, {"--Mapper.abs_pose_min_num_inliers"}, "20");
    work.set_threads(call, {"--Mapper.num_threads"});
    RunStage stage(work.at("models.json"), basis_of(before, {call}));
    if (stage.done() && fs::exists(work.sparse / "0" / "images.bin")) return;

    if (progress) progress->update(kMatchingEnd, "Cameras");
    stage.begin();
    std::string part = "models.part";
    std::vector<Model> found = map_cameras(work, call, database, part);
    const auto placed = [](const std::vector<Model>& models) {
        return models.empty() ? size_t{0} : models[0].photos.size();
    };
    // More matches may also mislead: what SIFT's alone place is not given away.
    if (work.options.matcher == PhotoMatcher::kBoth && database == kTracksDatabase &&
        placed(found) < work.photos.photos.size()) {
        work.job.note("-- once more, with SIFT's matches alone");
        std::vector<Model> sift = map_cameras(work, call, "matching.db", "models.sift");
        if (placed(sift) > placed(found)) {
            found = std::move(sift);
            part = "models.sift";
        }
    }
    if (found.empty()) throw none_registered(work.photos.photos.size(), work.usual_features);
    const fs::path models = work.folder / "models";
    replace_folder(work.folder / part, models);
    std::error_code failure;
    for (const char* left : {"models.part", "models.sift"})
        fs::remove_all(work.folder / left, failure);
    copy_model(models / found[0].folder.filename(), work.sparse);
    stage.finish();
}

ColmapRun tell(ColmapWork& work) {
    QuietProgress quiet(work.job.progress());
    Progress* const progress = &quiet;
    ColmapRun run;
    run.model = utf8_of(work.sparse / "0");
    run.version = work.job.colmap().version();
    run.photos = work.photos.photos.size();
    const PhotoModel model = read_photo_model(run.model, progress);
    std::set<std::string> placed;
    for (const Photo& photo : model.photos)
        placed.insert(photo.name);
    run.registered = placed.size();
    for (const PhotoFile& photo : work.photos.photos)
        if (!placed.count(photo.name)) run.missing.push_back(photo.name);
    std::vector<DVec3> points;
    for (const SparsePoint& point : read_sparse_points(run.model, progress))
        points.push_back(point.position);
    run.around = cameras_around(model, points);
    run.widest_gap = widest_gap_of(run.around);
    run.gps = ask_gps(model, work.photos.path, points, progress);
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
    const std::vector<std::string> advice = advice_on(run, sizes);
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
    if (word == "sift") return PhotoMatcher::kSift;
    if (word == "pyrlk") return PhotoMatcher::kPyrlk;
    if (word == "both") return PhotoMatcher::kBoth;
    throw Error("Photos are matched by sift, pyrlk or both, not " + quote_word(word) + ".");
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
        const std::string why =
            "The names of some photos have blanks in them, which COLMAP's list of matches can't hold: rename "
            "them for corners to be tracked.";
        if (!sift) throw Error(why);
        work.warnings.push_back(why);
        tracked = false;
    }
    if (tracked && sift) work.sift_end = kSiftEnd;
    std::string basis;
    if (sift) basis = match_photos(work, find_features(work));
    if (tracked) basis = track_photos(work, basis);
    place_cameras(work, basis, tracked ? kTracksDatabase : "matching.db");
    const ColmapRun run = tell(work);
    for (const std::string& warning : run.warnings)
        job.note("-- " + warning);
    return run;
}

}  // namespace treerec
