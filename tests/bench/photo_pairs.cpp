// How many of the tracked places are right, by what a model of the same photos says, and on drawn pictures.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "../unit/photos_warps.h"
#include "bench.h"
#include "file_bytes.h"
#include "geometry/parallel.h"
#include "photos/cameras_tell.h"
#include "photos/colmap_model.h"
#include "photos/match_pair.h"
#include "photos/photo_picture.h"
#include "photos/sparse_points.h"

namespace treerec::bench {

namespace {

constexpr double kRight = 2.0;  // pixels from where the other photo's ray passes
constexpr double kBins[] = {0.0, 3.0, 8.0, 14.0, 20.0, 30.0, 45.0};
constexpr size_t kMostPairs = 16;  // of a bin

// The ray of a pixel, z 1, by turning the lens's formula around.
DVec2 ray_of(const Camera& camera, const DVec2& pixel) {
    const double focal = camera.focal_length();
    const DVec2 middle = *camera.project({0.0, 0.0, 1.0});
    DVec2 p = (pixel - middle) / focal;
    for (int i = 0; i < 20; i++)
        if (const auto falls = camera.project({p.x, p.y, 1.0})) p += (pixel - *falls) / focal;
    return p;
}

// How far a place is from the line on which the other photo's pixel may be seen, in undistorted pixels.
double off_line(const PhotoModel& model, const Photo& one, const DVec2& a, const Photo& other,
                const DVec2& b) {
    const Camera &from = model.cameras[static_cast<size_t>(one.camera)],
                 &to = model.cameras[static_cast<size_t>(other.camera)];
    const DVec3 way = glm::transpose(one.turn()) * DVec3(ray_of(from, a), 1.0);
    const DVec3 pole = other.to_camera(one.centre()), along = other.turn() * way;
    const DVec3 line = glm::cross(pole, along);
    const DVec3 seen(ray_of(to, b), 1.0);
    const double across = std::sqrt(line.x * line.x + line.y * line.y);
    return across > 0.0 ? to.focal_length() * std::abs(glm::dot(line, seen)) / across : INFINITY;
}

struct Counts {
    size_t pairs = 0, matches = 0, right = 0;
    double seconds = 0.0;

    void tell(bool time) const {
        const double all = static_cast<double>(std::max<size_t>(pairs, 1));
        std::printf(" %.0f | %.2f |", static_cast<double>(matches) / all,
                    matches ? static_cast<double>(right) / static_cast<double>(matches) : 0.0);
        if (time) std::printf(" %.0f |", 1000.0 * seconds / all);
    }
};

}  // namespace

void bench_warps() {
    std::printf(
        "| warp | plain: matches | median px | wrong %% | improved: matches | median px | wrong %% |\n"
        "|---|---|---|---|---|---|---|\n");
    const PhotoFeatures first = features_of(test::draw_warped({"", DMat3(1.0)}, 7), {});
    for (const test::Warp& warp : test::known_warps()) {
        const PhotoFeatures second = features_of(test::draw_warped(warp, 7), {});
        const test::WarpError plain = test::error_of(warp, first, match_pair_plain(first, second));
        const test::WarpError improved = test::error_of(warp, first, match_pair(first, second));
        std::printf("| %s | %zu | %.2f | %.1f | %zu | %.3f | %.1f |\n", warp.name.c_str(), plain.matches,
                    plain.median, 100.0 * plain.wrong, improved.matches, improved.median,
                    100.0 * improved.wrong);
    }
}

void bench_pairs(const std::string& folder, const std::string& model_folder) {
    const PhotoModel model = read_photo_model(model_folder);
    std::vector<DVec3> points;
    for (const SparsePoint& point : read_sparse_points(model_folder))
        points.push_back(point.position);
    DVec3 middle(0.0);
    if (const auto subject = subject_of(model)) {
        middle = *subject;
    } else {
        for (const DVec3& p : points)
            middle += p / static_cast<double>(points.size());
    }
    FeatureOptions options;
    std::vector<PhotoFeatures> features(model.photos.size());
    parallel_for(features.size(), 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++)
            features[i] =
                features_of(read_photo(utf8_of(path_of(folder) / path_of(model.photos[i].name))), options);
    });
    struct Pair {
        size_t one, other;
    };
    constexpr size_t kCount = std::size(kBins) - 1;
    std::vector<std::vector<Pair>> bins(kCount);
    for (size_t i = 0; i < features.size(); i++)
        for (size_t j = i + 1; j < features.size(); j++) {
            const DVec3 a = glm::normalize(model.photos[i].centre() - middle),
                        b = glm::normalize(model.photos[j].centre() - middle);
            const double degrees = std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)) * 180.0 / kPi;
            for (size_t k = 0; k < kCount; k++)
                if (degrees >= kBins[k] && degrees < kBins[k + 1]) bins[k].push_back({i, j});
        }
    std::printf(
        "| degrees | pairs | plain: matches | right | ms | improved: matches | right | ms "
        "| both strict medians: matches | right | no medians: matches | right |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (size_t k = 0; k < kCount; k++) {
        // Spread over the bin.
        std::vector<Pair> pairs;
        const size_t count = std::min(kMostPairs, bins[k].size());
        for (size_t i = 0; i < count; i++)
            pairs.push_back(bins[k][i * bins[k].size() / count]);
        std::vector<std::array<Counts, 4>> all(pairs.size());
        parallel_for(pairs.size(), 1, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; i++) {
                const PhotoFeatures &one = features[pairs[i].one], &other = features[pairs[i].other];
                const auto note = [&](Counts& counts, const PairMatches& found, double seconds) {
                    counts.pairs++;
                    counts.seconds += seconds;
                    for (const PointMatch& match : found.matches) {
                        if (!match.kept) continue;
                        counts.matches++;
                        counts.right += off_line(model, model.photos[pairs[i].one],
                                                 one.pyramid.in_photo(one.corners[match.corner].place),
                                                 model.photos[pairs[i].other],
                                                 other.pyramid.in_photo(match.place)) <= kRight;
                    }
                };
                const auto start = std::chrono::steady_clock::now();
                const PairMatches plain = match_pair_plain(one, other);
                const auto between = std::chrono::steady_clock::now();
                MatchOptions matching;
                matching.medians = MedianFilter::kNone;
                PairMatches none = match_pair(one, other, matching);
                const auto end_time = std::chrono::steady_clock::now();
                const double first = std::chrono::duration<double>(between - start).count(),
                             second = std::chrono::duration<double>(end_time - between).count();
                PairMatches both = none, either = none;
                filter_by_medians(both.matches, MedianFilter::kBoth);
                filter_by_medians(either.matches, MedianFilter::kEither);
                note(all[i][0], plain, first);
                note(all[i][1], both, second);
                note(all[i][2], either, second);
                note(all[i][3], none, second);
            }
        });
        std::array<Counts, 4> sums;
        for (const auto& one : all)
            for (size_t m = 0; m < 4; m++) {
                sums[m].pairs += one[m].pairs;
                sums[m].matches += one[m].matches;
                sums[m].right += one[m].right;
                sums[m].seconds += one[m].seconds;
            }
        std::printf("| %.0f to %.0f | %zu |", kBins[k], kBins[k + 1], pairs.size());
        for (size_t m = 0; m < 4; m++)
            sums[m].tell(m < 2);
        std::printf("\n");
        std::fflush(stdout);
    }
}

}  // namespace treerec::bench
