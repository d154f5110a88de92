#include "photos/track_stages.h"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <filesystem>
#include <utility>

#include "error.h"
#include "file_bytes.h"
#include "geometry/parallel.h"
#include "geometry/quantile.h"
#include "photos/count_done.h"
#include "photos/feature_tracks.h"
#include "photos/match_pair.h"
#include "photos/pair_files.h"
#include "photos/photo_pairs.h"
#include "photos/photo_picture.h"
#include "photos/run_stage.h"
#include "photos/sift_matches.h"

namespace treerec {

namespace {

namespace fs = std::filesystem;

using Pair = std::pair<size_t, size_t>;

constexpr const char* kMethod = "tracked corners 2";  // another number where other matches come out
constexpr size_t kChunk = 16;                         // pairs of a file: what a kill may lose
constexpr double kImporting = 0.1;                    // of the matching: COLMAP's part of it
constexpr double kSame = 1.0;                         // pixels of the pictures that are tracked
constexpr const char* kUsualCorners = "corners in a usual photo: ";

// Those of photos that can't be read have no corners.
std::vector<PhotoFeatures> corners_of(ColmapWork& work, double begin, double end) {
    Progress* const progress = work.job.progress();
    const Effort effort = effort_of(work.options.effort);
    FeatureOptions options;
    options.most_pixels = effort.pixels;
    options.harris.most = static_cast<size_t>(effort.features);
    const std::vector<PhotoFile>& photos = work.photos.photos;
    std::vector<PhotoFeatures> features(photos.size());
    std::atomic<size_t> unreadable = 0;
    CountDone counter(progress, begin, end, "Features", photos.size());
    parallel_for(photos.size(), 1, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; i++) {
            if (progress) progress->check();
            Image picture(1, 1, 1);
            try {
                picture = read_photo(utf8_of(path_of(work.photos.path) / path_of(photos[i].name)));
            } catch (const Error&) {
                unreadable++;
            }
            features[i] = features_of(picture, options);
            counter.add(1);
        }
    });
    work.unreadable = std::max<size_t>(work.unreadable, unreadable);
    return features;
}

PhotoPlaceMatches kept_matches(const std::vector<PhotoFeatures>& features, const Pair& pair,
                               const Progress* progress) {
    const PhotoFeatures &one = features[pair.first], &other = features[pair.second];
    PhotoPlaceMatches result{pair.first, pair.second, {}};
    for (const PointMatch& match : match_pair(one, other, {}, progress).matches)
        if (match.kept)
            result.matches.push_back({one.pyramid.in_photo(one.corners[match.corner].place),
                                      other.pyramid.in_photo(match.place), match.similarity});
    return result;
}

struct Tracked {
    std::vector<PhotoPlaceMatches> pairs;
    double pixel = 1.0;  // the photos' pixels in one of the tracked pictures', at most
};

std::string pixel_note(double pixel, size_t usual) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, pixel).ptr;
    return kUsualCorners + std::to_string(usual) + ", pixel: " + std::string(text, end);
}

double pixel_in(const std::string& note) {
    const size_t at = note.find("pixel: ");
    double pixel = 1.0;
    if (at != std::string::npos) std::from_chars(note.data() + at + 7, note.data() + note.size(), pixel);
    return pixel;
}

// The matches of a chunk's file; nothing where there is none, or it is damaged.
std::optional<std::vector<PhotoPlaceMatches>> read_chunk(const std::string& path,
                                                         const std::vector<Pair>& pairs) {
    std::error_code failure;
    if (!fs::is_regular_file(path_of(path), failure)) return {};
    return parse_pairs(read_file(path).view(), pairs);
}

// All that is tracked, from files where they are there.
Tracked track_pairs(ColmapWork& work, const std::string& basis, double begin, double end) {
    Progress* const progress = work.job.progress();
    const fs::path folder = work.folder / "tracks";
    const std::string whole_path = utf8_of(folder / "all.bin");
    RunStage stage(work.at("tracks.json"), basis);
    Tracked tracked;
    std::error_code failure;
    if (stage.done() && fs::is_regular_file(path_of(whole_path), failure)) {
        const FileBytes bytes = read_file(whole_path);
        if (auto found = parse_all_pairs(bytes.view(), work.photos.photos.size())) {
            tracked.pairs = std::move(*found);
            tracked.pixel = pixel_in(stage.note());
            if (work.usual_features == 0) work.usual_features = number_after(stage.note(), kUsualCorners);
            return tracked;
        }
    }
    if (!stage.begun() || stage.done()) {
        fs::remove_all(folder, failure);
        stage.begin();
    }
    make_folder(utf8_of(folder));
    const double corners_end = begin + 0.1 * (end - begin);
    const std::vector<PhotoFeatures> features = corners_of(work, begin, corners_end);
    std::vector<size_t> counts;
    for (const PhotoFeatures& one : features) {
        counts.push_back(one.corners.size());
        tracked.pixel = std::max({tracked.pixel, one.pyramid.to_photo.x, one.pyramid.to_photo.y});
    }
    const size_t usual = quantile(counts, 0.5);
    if (work.usual_features == 0) work.usual_features = usual;
    PhotoPairOptions choosing;
    choosing.sequence = work.in_sequence();
    if (progress) progress->update(corners_end, "Matching");
    const std::vector<Pair> pairs = choose_photo_pairs(features, choosing, progress);
    work.job.note("-- " + std::to_string(usual) + " corners in a usual photo, " +
                  std::to_string(pairs.size()) + " pairs to track");
    CountDone counter(progress, corners_end, end, "Matching", pairs.size());
    size_t again = 0;
    for (size_t first = 0; first < pairs.size(); first += kChunk) {
        const std::vector<Pair> chunk(
            pairs.begin() + static_cast<ptrdiff_t>(first),
            pairs.begin() + static_cast<ptrdiff_t>(std::min(first + kChunk, pairs.size())));
        const std::string path = utf8_of(folder / (std::to_string(first) + ".bin"));
        auto found = read_chunk(path, chunk);
        if (found) {
            again += chunk.size();
            counter.add(chunk.size());
        } else {
            found.emplace(chunk.size());
            parallel_for(chunk.size(), 1, [&](size_t from, size_t to) {
                for (size_t k = from; k < to; k++) {
                    (*found)[k] = kept_matches(features, chunk[k], progress);
                    counter.add(1);
                }
            });
            write_file(path, pairs_as_bytes(*found));
        }
        for (PhotoPlaceMatches& pair : *found)
            tracked.pairs.push_back(std::move(pair));
    }
    if (again > 0) work.job.note("-- " + std::to_string(again) + " pairs were tracked before");
    write_file(whole_path, pairs_as_bytes(tracked.pairs));
    for (size_t first = 0; first < pairs.size(); first += kChunk)
        fs::remove(folder / (std::to_string(first) + ".bin"), failure);
    stage.finish(pixel_note(tracked.pixel, usual));
    return tracked;
}

void append(std::string& text, double value) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, value, std::chars_format::fixed, 3).ptr;
    text.append(digits, end);
}

// A text file of keypoints for each photo that has some, in COLMAP's format: x, y, scale, orientation and a
// descriptor, which nobody asks for.
void write_keypoints(const ColmapWork& work, const fs::path& folder, const FeatureTracks& tracks) {
    std::string rest = " 1 0";
    for (int i = 0; i < 128; i++)
        rest += " 0";
    rest += "\n";
    for (size_t i = 0; i < tracks.keypoints.size(); i++) {
        if (tracks.keypoints[i].empty()) continue;
        std::string text = std::to_string(tracks.keypoints[i].size()) + " 128\n";
        text.reserve(text.size() + tracks.keypoints[i].size() * (rest.size() + 24));
        for (const DVec2& place : tracks.keypoints[i]) {
            append(text, place.x);
            text += ' ';
            append(text, place.y);
            text += rest;
        }
        write_file(utf8_of(folder / path_of(work.photos.photos[i].name + ".txt")), text);
    }
}

std::string matches_text(const ColmapWork& work, const FeatureTracks& tracks) {
    std::string text;
    for (const KeypointMatches& pair : tracks.pairs) {
        text += work.photos.photos[pair.one].name + " " + work.photos.photos[pair.other].name + "\n";
        for (const auto& [one, other] : pair.keypoints)
            text += std::to_string(one) + " " + std::to_string(other) + "\n";
        text += "\n";
    }
    return text;
}

std::vector<ColmapCall> importing_calls(const ColmapWork& work, const std::string& part) {
    ColmapCall features{"feature_importer", {}, {}}, matches{"matches_importer", {}, {}};
    if (work.photos.one_size()) work.set_one_camera(features);
    features.places = {"--database_path",   part,
                       "--image_path",      work.photos.path,
                       "--image_list_path", work.at("tracked.txt"),
                       "--import_path",     work.at("keypoints")};
    work.job.set(matches.settings, matches.command, {"--match_type"}, "raw");
    matches.places = {"--database_path", part, "--match_list_path", work.at("matches.txt")};
    work.set_threads(matches, {"--FeatureMatching.num_threads", "--SiftMatching.num_threads"});
    return {features, matches};
}

}  // namespace

bool names_can_be_paired(const PhotoFolder& photos) {
    return std::all_of(photos.photos.begin(), photos.photos.end(), [](const PhotoFile& photo) {
        return photo.name.find_first_of(" \t") == std::string::npos;
    });
}

std::string track_photos(ColmapWork& work, const std::string& before) {
    Progress* const progress = work.job.progress();
    const Effort effort = effort_of(work.options.effort);
    const std::string tracking = std::string(kMethod) + (work.in_sequence() ? ", in sequence, " : ", ") +
                                 std::to_string(effort.pixels) + " pixels, " +
                                 std::to_string(effort.features) + " corners\n" + photos_as_text(work.photos);
    const std::vector<ColmapCall> calls = importing_calls(work, work.at(kTracksDatabase));
    const std::string basis =
        basis_of("COLMAP " + work.job.colmap().version() + "\n" + tracking + "\n" + before, calls);
    RunStage stage(work.at("importing.json"), basis);
    if (stage.done() && fs::exists(work.folder / kTracksDatabase)) {
        if (work.usual_features == 0) work.usual_features = number_after(stage.note(), kUsualCorners);
        return basis;
    }

    const double begin = before.empty() ? 0.0 : work.sift_end,
                 tracked_end = kMatchingEnd - kImporting * (kMatchingEnd - begin);
    Tracked tracked = track_pairs(work, tracking, begin, tracked_end);
    std::vector<PhotoPlaceMatches> pairs;
    if (!before.empty()) pairs = read_sift_matches(work.at("matching.db"), work.photos);
    pairs.insert(pairs.end(), std::make_move_iterator(tracked.pairs.begin()),
                 std::make_move_iterator(tracked.pairs.end()));
    TrackOptions joining;
    joining.same = kSame * tracked.pixel;
    // What SIFT has wrong would become wrong pairs.
    if (!before.empty()) joining.least_shared = SIZE_MAX;
    const FeatureTracks tracks = join_tracks(work.photos.photos.size(), pairs, joining);
    work.job.note("-- " + std::to_string(tracks.tracks) + " tracks in " +
                  std::to_string(tracks.pairs.size()) + " pairs of photos; " +
                  std::to_string(tracks.conflicts) + " matches contradicted others");
    if (progress) progress->update(tracked_end, "Matching");

    stage.begin();
    std::error_code failure;
    const fs::path keypoints = work.folder / "keypoints";
    fs::remove_all(keypoints, failure);
    make_folder(utf8_of(keypoints));
    write_keypoints(work, keypoints, tracks);
    write_file(work.at("matches.txt"), matches_text(work, tracks));
    std::string names;
    for (const PhotoFile& photo : work.photos.photos)
        names += photo.name + "\n";
    write_file(work.at("tracked.txt"), names);
    const auto listen = [](const std::string&) {};
    const auto begin_anew = [&] { work.remove_database(kTracksDatabase); };
    begin_anew();
    ColmapEnd end = work.job.run(calls[0], listen);
    if (!end.end.well()) throw work.job.failure(calls[0], end);
    // COLMAP verifies them on the processor; that it has a card is no matter here.
    const OptionNames use_gpu = {"--FeatureMatching.use_gpu", "--SiftMatching.use_gpu"};
    ColmapCall matching = calls[1];
    work.job.set(matching.places, matching.command, use_gpu, "0");
    end = work.job.run(matching, listen);
    if (!end.end.well()) throw work.job.failure(matching, end);
    fs::remove_all(keypoints, failure);
    stage.finish(kUsualCorners + std::to_string(work.usual_features));
    return basis;
}

}  // namespace treerec
