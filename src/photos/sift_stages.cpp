#include "photos/sift_stages.h"

#include <algorithm>
#include <filesystem>

#include "error.h"
#include "file_bytes.h"
#include "photos/run_stage.h"

namespace treerec {

namespace {

namespace fs = std::filesystem;

constexpr size_t kClosing = 10;  // first and last photos of a sequence that are compared
constexpr const char* kUsualFeatures = "features in a usual photo: ";
constexpr const char* kBlock = "10";  // photos that are compared at once: what a kill may lose

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

std::vector<ColmapCall> matching_calls(ColmapWork& work) {
    std::vector<ColmapCall> calls;
    if (!work.in_sequence()) {
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
        work.set_threads(call, {"--FeatureMatching.num_threads", "--SiftMatching.num_threads"});
        call.places.insert(call.places.end(), {"--database_path", work.at("matching.db")});
    }
    return calls;
}

}  // namespace

std::string find_features(ColmapWork& work) {
    Progress* const progress = work.job.progress();
    const Effort effort = effort_of(work.options.effort);
    ColmapCall call{"feature_extractor", {}, {}};
    const bool one_camera = work.photos.one_size();
    if (one_camera) work.set_one_camera(call);
    work.job.set(call.settings, call.command,
                 {"--FeatureExtraction.max_image_size", "--SiftExtraction.max_image_size"},
                 std::to_string(effort.pixels));
    work.job.set(call.settings, call.command, {"--SiftExtraction.max_num_features"},
                 std::to_string(effort.features));
    work.set_threads(call, {"--FeatureExtraction.num_threads", "--SiftExtraction.num_threads"});
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
        work.remove_database("features.db");
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
    ColmapEnd end = work.run_on_either(call, use_gpu, begin_anew, listen);
    if (!end.end.well() && goes_on) {
        work.job.note("-- once more, from the beginning");
        std::erase(call.places, "--ImageReader.existing_camera_id");
        if (one_camera && call.places.back() == "1") call.places.pop_back();
        begin_anew();
        end = work.run_on_either(call, use_gpu, begin_anew, listen);
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

std::string match_photos(ColmapWork& work, const std::string& before) {
    Progress* const progress = work.job.progress();
    const std::vector<ColmapCall> calls = matching_calls(work);
    const std::string basis = basis_of(before, calls);
    RunStage stage(work.at("matching.json"), basis);
    if (stage.done() && fs::exists(work.folder / "matching.db")) return basis;

    if (progress) progress->update(kFeaturesEnd, "Matching");
    const auto begin_anew = [&] {
        work.remove_database("matching.db");
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
            kFeaturesEnd + (work.sift_end - kFeaturesEnd) * done / static_cast<double>(calls.size()),
            "Matching");
        progress->count(count.done, count.all);
    };
    const OptionNames use_gpu = {"--FeatureMatching.use_gpu", "--SiftMatching.use_gpu"};
    while (part < calls.size()) {
        const ColmapEnd end = work.run_on_either(
            calls[part], use_gpu, [] {}, listen);
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

}  // namespace treerec
