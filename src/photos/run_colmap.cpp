#include "photos/run_colmap.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "error.h"
#include "file_bytes.h"
#include "photos/colmap_advice.h"
#include "photos/colmap_job.h"
#include "photos/photo_folder.h"
#include "photos/quiet_progress.h"
#include "photos/run_stage.h"
#include "photos/sparse_points.h"

namespace treerec {

namespace {

namespace fs = std::filesystem;

// Where the stages end, as shares of the whole (71 photos on two cores: 30, 490 and 10 s).
constexpr double kFeaturesEnd = 0.1;
constexpr double kMatchingEnd = 0.9;

constexpr size_t kMostExhaustive = 80;  // photos
constexpr size_t kClosing = 10;         // first and last photos of a sequence that are compared
constexpr const char* kUsualFeatures = "features in a usual photo: ";
constexpr const char* kBlock = "10";  // photos that are compared at once: what a kill may lose

struct Effort {
    const char* pixels;    // of a photo's longer side
    const char* features;  // of a photo
};

Effort effort_of(PhotoEffort effort) {
    switch (effort) {
        case PhotoEffort::kQuick:
            return {"1000", "1500"};
        case PhotoEffort::kNormal:
            return {"1600", "2500"};
        case PhotoEffort::kBest:
            break;
    }
    return {"3200", "8192"};
}

// All there is to know while the stages run.
struct Work {
    ColmapJob& job;
    const PhotoFolder& photos;
    const ColmapOptions& options;
    fs::path folder;               // out/colmap
    fs::path sparse;               // out/sparse
    std::vector<size_t> features;  // of the photos that are new
    size_t usual_features = 0;     // of a photo; 0 where COLMAP did not tell
    size_t unreadable = 0;

    std::string at(const char* name) const { return utf8_of(folder / name); }
};

void remove_database(const Work& work, const std::string& name) {
    for (const char* more : {"", "-wal", "-shm", "-journal"}) {
        std::error_code failure;
        fs::remove(work.folder / (name + more), failure);
        if (failure)
            throw Error("'" + work.at(name.c_str()) + "' cannot be removed: " + failure.message() + ".");
    }
}

void set_threads(Work& work, ColmapCall& call, const OptionNames& names) {
    if (work.options.threads > 0)
        work.job.set(call.places, call.command, names, std::to_string(work.options.threads));
}

// Runs a call on the graphics card where COLMAP can, and where that fails, without.
ColmapEnd run_on_either(Work& work, const ColmapCall& call, const OptionNames& use_gpu,
                        const std::function<void()>& begin_anew,
                        const std::function<void(const std::string&)>& on_line) {
    for (bool gpu = work.job.colmap().cuda();; gpu = false) {
        ColmapCall whole = call;
        work.job.set(whole.places, call.command, use_gpu, gpu ? "1" : "0");
        const ColmapEnd end = work.job.run(whole, on_line);
        if (end.end.well() || !gpu) return end;
        work.job.note("-- once more, without the graphics card");
        begin_anew();
    }
}

std::string basis_of(const std::string& before, const std::vector<ColmapCall>& calls) {
    std::string basis = before;
    for (const ColmapCall& call : calls) {
        basis += "\n" + call.command;
        for (const std::string& word : call.settings)
            basis += " " + word;
    }
    return basis;
}

// Finds what can be recognised in each photo. Returns the basis of what follows.
std::string find_features(Work& work) {
    Progress* const progress = work.job.progress();
    const Effort effort = effort_of(work.options.effort);
    ColmapCall call{"feature_extractor", {}, {}};
    const bool one_camera = work.photos.one_size();
    if (one_camera) work.job.set(call.settings, call.command, {"--ImageReader.single_camera"}, "1");
    work.job.set(call.settings, call.command,
                 {"--FeatureExtraction.max_image_size", "--SiftExtraction.max_image_size"}, effort.pixels);
    work.job.set(call.settings, call.command, {"--SiftExtraction.max_num_features"}, effort.features);
    set_threads(work, call, {"--FeatureExtraction.num_threads", "--SiftExtraction.num_threads"});
    call.places.insert(call.places.end(), {"--database_path", work.at("features.db"), "--image_path",
                                           work.photos.path, "--image_list_path", work.at("photos.txt")});
    const std::string basis =
        basis_of("COLMAP " + work.job.colmap().version() + "\n" + photos_as_text(work.photos), {call});
    RunStage stage(work.at("features.json"), basis);
    if (stage.done() && fs::exists(work.folder / "features.db")) {
        work.usual_features = number_after(stage.note(), kUsualFeatures);
        return basis;
    }

    if (progress) progress->update(0.0, "Features");
    std::string names;
    for (const PhotoFile& photo : work.photos.photos)
        names += photo.name + "\n";
    write_file(work.at("photos.txt"), names);
    // COLMAP goes on with a database, but would give the rest of the photos a camera of their own.
    constexpr const char* kCameraKnown = "camera 1 is there";
    const auto begin_anew = [&] {
        remove_database(work, "features.db");
        stage.begin();
        work.features.clear();
        work.unreadable = 0;
    };
    bool goes_on = stage.begun() && (!one_camera || stage.note() == kCameraKnown);
    if (goes_on && one_camera) {
        const size_t before = call.places.size();
        work.job.set(call.places, call.command, {"--ImageReader.existing_camera_id"}, "1");
        goes_on = call.places.size() > before;
    }
    if (!goes_on) begin_anew();
    const auto listen = [&](const std::string& line) {
        if (line.find("Processed file") != std::string::npos) {
            const CountInLine count = count_in(line);
            if (progress && count.all > 0) {
                progress->update(
                    kFeaturesEnd * static_cast<double>(count.done) / static_cast<double>(count.all),
                    "Features");
                progress->count(count.done, count.all);
            }
            if (stage.note() != kCameraKnown) stage.begin(kCameraKnown);
        }
        if (const size_t features = number_after(line, "Features:"); features > 0)
            work.features.push_back(features);
        work.unreadable += line.find("Failed to read image") != std::string::npos;
    };
    const OptionNames use_gpu = {"--FeatureExtraction.use_gpu", "--SiftExtraction.use_gpu"};
    ColmapEnd end = run_on_either(work, call, use_gpu, begin_anew, listen);
    if (!end.end.well() && goes_on) {
        work.job.note("-- once more, from the beginning");
        std::erase(call.places, "--ImageReader.existing_camera_id");
        if (one_camera && call.places.back() == "1") call.places.pop_back();
        begin_anew();
        end = run_on_either(work, call, use_gpu, begin_anew, listen);
    }
    if (!end.end.well()) throw work.job.failure(call, end);
    if (!work.features.empty()) {
        const auto middle = work.features.begin() + static_cast<ptrdiff_t>(work.features.size() / 2);
        std::nth_element(work.features.begin(), middle, work.features.end());
        work.usual_features = *middle;
    }
    stage.finish(kUsualFeatures + std::to_string(work.usual_features));
    return basis;
}

bool in_sequence(const Work& work) {
    return work.options.order == PhotoOrder::kSequence ||
           (work.options.order == PhotoOrder::kAuto && work.photos.photos.size() > kMostExhaustive);
}

// The pairs of the last and the first photos, which close the circle. "" where COLMAP can't be told them: it
// takes a blank for the end of a name.
std::string closing_pairs(const PhotoFolder& photos) {
    const size_t count = photos.photos.size();
    std::string pairs;
    for (size_t i = 0; i < std::min(kClosing, count); i++)
        for (size_t j = std::max(i + 1, count - std::min(kClosing, count)); j < count; j++) {
            const std::string &first = photos.photos[i].name, &last = photos.photos[j].name;
            if ((first + last).find_first_of(" \t") != std::string::npos) return "";
            pairs += first + " " + last + "\n";
        }
    return pairs;
}

std::vector<ColmapCall> matching_calls(Work& work) {
    std::vector<ColmapCall> calls;
    if (!in_sequence(work)) {
        calls.push_back({"exhaustive_matcher", {}, {}});
        work.job.set(calls[0].settings, calls[0].command, {"--ExhaustiveMatching.block_size"}, kBlock);
    } else {
        ColmapCall& call = calls.emplace_back(ColmapCall{"sequential_matcher", {}, {}});
        work.job.set(call.settings, call.command, {"--SequentialMatching.overlap"}, "10");
        const std::string words = vocabulary_tree_of(work.job.colmap());
        if (!words.empty()) {
            work.job.set(call.settings, call.command, {"--SequentialMatching.loop_detection"}, "1");
            work.job.set(call.places, call.command, {"--SequentialMatching.vocab_tree_path"}, words);
        }
        if (const std::string pairs = closing_pairs(work.photos); !pairs.empty()) {
            write_file(work.at("closing.txt"), pairs);
            calls.push_back({"matches_importer", {}, {"--match_list_path", work.at("closing.txt")}});
            work.job.set(calls[1].settings, calls[1].command, {"--match_type"}, "pairs");
        } else {
            work.job.note("-- the last photos are not compared with the first: their names have blanks");
        }
    }
    for (ColmapCall& call : calls) {
        set_threads(work, call, {"--FeatureMatching.num_threads", "--SiftMatching.num_threads"});
        call.places.insert(call.places.end(), {"--database_path", work.at("matching.db")});
    }
    return calls;
}

// Finds what the photos share. Returns the basis of what follows.
std::string match_photos(Work& work, const std::string& before) {
    Progress* const progress = work.job.progress();
    const std::vector<ColmapCall> calls = matching_calls(work);
    const std::string basis = basis_of(before, calls);
    RunStage stage(work.at("matching.json"), basis);
    if (stage.done() && fs::exists(work.folder / "matching.db")) return basis;

    if (progress) progress->update(kFeaturesEnd, "Matching");
    const auto begin_anew = [&] {
        remove_database(work, "matching.db");
        std::error_code failure;
        fs::copy_file(work.folder / "features.db", work.folder / "matching.db", failure);
        if (failure)
            throw Error("'" + work.at("matching.db") + "' could not be written: " + failure.message() + ".");
        stage.begin();
    };
    // What has been compared is in the database, and COLMAP does not do it again.
    bool goes_on = stage.begun();
    if (!goes_on) begin_anew();
    size_t part = 0;
    const auto listen = [&](const std::string& line) {
        if (!progress || line.find("Feature") != std::string::npos) return;
        const CountInLine count = count_in(line);
        if (count.all == 0) return;
        const double done =
            static_cast<double>(part) + static_cast<double>(count.done) / static_cast<double>(count.all);
        progress->update(
            kFeaturesEnd + (kMatchingEnd - kFeaturesEnd) * done / static_cast<double>(calls.size()),
            "Matching");
        progress->count(count.done, count.all);
    };
    const OptionNames use_gpu = {"--FeatureMatching.use_gpu", "--SiftMatching.use_gpu"};
    while (part < calls.size()) {
        const ColmapEnd end = run_on_either(
            work, calls[part], use_gpu, [] {}, listen);
        if (end.end.well()) {
            part++;
            continue;
        }
        if (!goes_on) throw work.job.failure(calls[part], end);
        work.job.note("-- once more, from the beginning");
        goes_on = false;
        part = 0;
        begin_anew();
    }
    stage.finish();
    return basis;
}

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

// Finds the cameras' places.
void place_cameras(Work& work, const std::string& before) {
    Progress* const progress = work.job.progress();
    ColmapCall call{"mapper", {}, {}};
    set_threads(work, call, {"--Mapper.num_threads"});
    const fs::path part = work.folder / "models.part", models = work.folder / "models";
    call.places.insert(call.places.end(), {"--database_path", work.at("matching.db"), "--image_path",
                                           work.photos.path, "--output_path", utf8_of(part)});
    RunStage stage(work.at("models.json"), basis_of(before, {call}));
    if (stage.done() && fs::exists(work.sparse / "0" / "images.bin")) return;

    if (progress) progress->update(kMatchingEnd, "Cameras");
    stage.begin();
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
    const std::vector<Model> found = models_in(part, progress);
    if (found.empty() && (none || end.end.well())) throw none_registered(all, work.usual_features);
    if (!end.end.well()) throw work.job.failure(call, end);
    replace_folder(part, models);
    copy_model(found[0].folder.empty() ? models : models / found[0].folder.filename(), work.sparse);
    stage.finish();
}

ColmapRun tell(Work& work) {
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
    if (work.unreadable > 0)
        run.warnings.push_back(std::to_string(work.unreadable) +
                               " of the photos could not be read; open them, and save them again.");
    const std::vector<std::string> advice = advice_on(run, sizes);
    run.warnings.insert(run.warnings.end(), advice.begin(), advice.end());
    return run;
}

// Not what is somebody else's.
void require_own_folder(const fs::path& out, const std::string& photos) {
    std::error_code failure;
    if (fs::equivalent(out, path_of(photos), failure))
        throw Error("'" + utf8_of(out) +
                    "' is the folder of the photos itself; name another one to write to.");
    if (fs::exists(out / "colmap" / "lock", failure)) return;
    if (fs::is_directory(out / "colmap", failure) && fs::is_empty(out / "colmap", failure)) return;
    for (const char* name : {"colmap", "sparse", "cloud.ply", "photos.log"})
        if (fs::exists(out / name, failure))
            throw Error(
                "'" + utf8_of(out / name) +
                "' is there already, and is not from photos that were worked on here; it was left as it "
                "is. Name another folder to write to.");
}

}  // namespace

PhotoOrder parse_photo_order(const std::string& word) {
    if (word == "auto") return PhotoOrder::kAuto;
    if (word == "sequence") return PhotoOrder::kSequence;
    if (word == "exhaustive") return PhotoOrder::kExhaustive;
    throw Error("The photos' order is auto, sequence or exhaustive, not " + quote_word(word) + ".");
}

PhotoEffort parse_photo_effort(const std::string& word) {
    if (word == "quick") return PhotoEffort::kQuick;
    if (word == "normal") return PhotoEffort::kNormal;
    if (word == "best") return PhotoEffort::kBest;
    throw Error("The time for photos is quick, normal or best, not " + quote_word(word) + ".");
}

ColmapRun run_colmap(const std::string& folder, const std::string& out, const ColmapOptions& options,
                     Progress* progress) {
    if (progress) progress->update(0.0, "Photos");
    const PhotoFolder photos = list_photos(folder);
    if (photos.photos.size() < kLeastPhotos) throw too_few_photos(photos.photos.size(), folder);
    Colmap colmap = find_colmap(options.program, progress);
    std::error_code failure;
    const fs::path whole = fs::absolute(path_of(out), failure).lexically_normal();
    if (failure) throw Error("The folder '" + out + "' cannot be reached.");
    require_own_folder(whole, photos.path);
    make_folder(utf8_of(whole / "colmap"));
    FolderLock lock(utf8_of(whole / "colmap" / "lock"));
    ColmapJob job(std::move(colmap), utf8_of(whole / "photos.log"), lock, progress);
    Work work{job, photos, options, whole / "colmap", whole / "sparse", {}, 0, 0};
    const std::string found = find_features(work);
    const std::string matched = match_photos(work, found);
    place_cameras(work, matched);
    const ColmapRun run = tell(work);
    for (const std::string& warning : run.warnings)
        job.note("-- " + warning);
    return run;
}

}  // namespace treerec
