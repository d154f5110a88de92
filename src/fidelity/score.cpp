#include "fidelity/score.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "error.h"
#include "geometry/capsule_tree.h"
#include "geometry/morton.h"
#include "geometry/parallel.h"
#include "geometry/quantile.h"
#include "geometry/random.h"
#include "tree/wood_segments.h"

namespace treerec {

namespace {

constexpr double kSame = 1e-6;            // metres: what rounding may part
constexpr double kLongestWood = 20000.0;  // metres
constexpr double kExplained = 0.02;       // metres
constexpr double kMatch = 0.01;           // metres
constexpr size_t kChunk = 1024;
// Metres: where one class of thickness ends and the next begins.
constexpr std::array<double, 4> kThicknesses = {0.005, 0.01, 0.025, 0.05};

// The tree's segments in the tree space of another frame, in its metres.
std::vector<WoodSegment> segments_in(const Tree& tree, const ScanFrame& frame) {
    std::vector<WoodSegment> segments = wood_segments(tree);
    if (segments.empty()) throw Error("The tree has no wood: it needs at least two nodes.");
    if (tree.frame() == frame) return segments;
    const double scale = frame.metres_per_unit / tree.frame().metres_per_unit;
    for (WoodSegment& segment : segments) {
        segment.from = frame.to_tree(tree.frame().to_scan(segment.from));
        segment.to = frame.to_tree(tree.frame().to_scan(segment.to));
        segment.radius *= scale;
    }
    return segments;
}

double total_length(const std::vector<WoodSegment>& segments) {
    double sum = 0.0;
    for (const WoodSegment& segment : segments)
        sum += glm::distance(segment.from, segment.to);
    return sum;
}

double total_volume(const std::vector<WoodSegment>& segments) {
    double sum = 0.0;
    for (const WoodSegment& segment : segments)
        sum += kPi * segment.radius * segment.radius * glm::distance(segment.from, segment.to);
    return sum;
}

struct Sample {
    double distance;      // to the other skeleton's axis
    double radius;        // of the sampled segment
    double other_radius;  // of the segment it met
};

// Samples every segment about every `step` metres, in the middle of equal parts, against the other's axes.
std::vector<Sample> sample_against(const std::vector<WoodSegment>& segments, const CapsuleTree& other,
                                   double step, Progress* progress, const char* stage) {
    std::vector<size_t> first(segments.size() + 1, 0);
    for (size_t i = 0; i < segments.size(); i++) {
        const double parts = std::ceil(glm::distance(segments[i].from, segments[i].to) / step);
        first[i + 1] = first[i] + static_cast<size_t>(std::max(1.0, parts));
    }
    std::vector<Sample> samples(first.back());
    if (progress) progress->update(0.0, stage);
    parallel_for(segments.size(), 64, [&](size_t begin, size_t end) {
        if (progress) progress->check();
        int32_t hint = -1;
        for (size_t i = begin; i < end; i++) {
            const size_t parts = first[i + 1] - first[i];
            for (size_t k = 0; k < parts; k++) {
                const double t = (static_cast<double>(k) + 0.5) / static_cast<double>(parts);
                const DVec3 p = glm::mix(segments[i].from, segments[i].to, t);
                const CapsuleTree::Hit hit = other.nearest_axis(p, hint);
                hint = hit.segment;
                samples[first[i] + k] = {hit.distance, segments[i].radius, other.segment(hit.segment).radius};
            }
        }
    });
    return samples;
}

double mean_distance(const std::vector<Sample>& samples) {
    double sum = 0.0;
    for (const Sample& sample : samples)
        sum += sample.distance;
    return sum / static_cast<double>(samples.size());
}

template <typename Limit>
double share_within(const std::vector<Sample>& samples, Limit limit) {
    size_t within = 0;
    for (const Sample& sample : samples)
        within += sample.distance <= limit(sample) + kSame;
    return static_cast<double>(within) / static_cast<double>(samples.size());
}

Agreement agreement(double threshold, double precision, double recall) {
    const double sum = precision + recall;
    return {threshold, precision, recall, sum > 0.0 ? 2.0 * precision * recall / sum : 0.0};
}

}  // namespace

std::vector<Vec3> sample_points(const std::vector<Vec3>& points, size_t about) {
    if (points.size() <= about) return points;
    const double share = static_cast<double>(about) / static_cast<double>(points.size());
    const auto limit = static_cast<uint64_t>(share * 0x1p63) * 2;
    std::vector<Vec3> chosen;
    chosen.reserve(about + about / 4);
    for (const Vec3& p : points) {
        const uint64_t x = std::bit_cast<uint32_t>(p.x), y = std::bit_cast<uint32_t>(p.y);
        if (hash_seed(x << 32 | y, std::bit_cast<uint32_t>(p.z)) < limit) chosen.push_back(p);
    }
    if (chosen.empty()) chosen = points;
    return chosen;
}

ScanScore score_scan(const Tree& tree, const PointCloud& cloud, double noise, Progress* progress,
                     size_t about) {
    if (cloud.empty()) throw Error("The point cloud is empty; there is nothing to score against.");
    const CapsuleTree wood(segments_in(tree, tree.frame()));
    const bool same_frame = tree.frame() == cloud.frame;
    const bool whole = about == 0 || about >= cloud.size();
    const std::vector<Vec3> sample = whole ? std::vector<Vec3>() : sample_points(cloud.positions, about);
    const std::vector<Vec3>& chosen = whole ? cloud.positions : sample;
    std::vector<double> errors(chosen.size());
    if (progress) progress->update(0.0, "Scoring");
    // What a point is near to, the next one is near to as well.
    const std::vector<KeyedIndex> order = morton_order(chosen, progress);
    parallel_for(chosen.size(), kChunk, [&](size_t begin, size_t end) {
        if (progress) progress->check();
        int32_t hint = -1;
        for (size_t i = begin; i < end; i++) {
            const DVec3 p(chosen[order[i].index]);
            errors[i] =
                wood.surface_distance(same_frame ? p : tree.frame().to_tree(cloud.frame.to_scan(p)), hint);
        }
    });
    // Sorted, so that the sum does not depend on the order of the points.
    std::sort(errors.begin(), errors.end());
    ScanScore score;
    score.points = errors.size();
    const double count = static_cast<double>(errors.size());
    const auto at = [&](double share) {
        const double position = share * (count - 1.0);
        const size_t below = static_cast<size_t>(position);
        const size_t above = std::min(below + 1, errors.size() - 1);
        return errors[below] + (errors[above] - errors[below]) * (position - static_cast<double>(below));
    };
    const auto share_below = [&](double limit) {
        return static_cast<double>(std::lower_bound(errors.begin(), errors.end(), limit) - errors.begin()) /
               count;
    };
    score.median_mm = 1000.0 * at(0.5);
    score.mean_mm = 1000.0 * std::accumulate(errors.begin(), errors.end(), 0.0) / count;
    score.p95_mm = 1000.0 * at(0.95);
    score.explained_2cm = share_below(kExplained);
    score.explained_2cm_noise = share_below(kExplained + noise);
    if (progress) progress->update(1.0, "Scoring");
    return score;
}

SkeletonScore score_skeleton(const Tree& tree, const Tree& reference, Progress* progress, double step) {
    if (!(step > 0.0)) throw Error("The samples of a skeleton must lie some way apart.");
    const std::vector<WoodSegment> reference_wood = segments_in(reference, reference.frame());
    const std::vector<WoodSegment> wood = segments_in(tree, reference.frame());
    SkeletonScore score;
    score.length = total_length(wood);
    score.reference_length = total_length(reference_wood);
    score.volume = total_volume(wood);
    score.reference_volume = total_volume(reference_wood);
    for (double length : {score.length, score.reference_length}) {
        if (!(length > 0.0)) throw Error("A tree whose nodes all lie in one place cannot be scored.");
        if (!(length < kLongestWood))
            throw Error("A tree with more than 20 km of wood cannot be scored; is its unit metres?");
    }
    score.length_error = score.length / score.reference_length - 1.0;
    score.volume_error = score.volume / score.reference_volume - 1.0;

    SubProgress first(progress, 0.0, 0.5);
    SubProgress second(progress, 0.5, 1.0);
    const std::vector<Sample> found =
        sample_against(wood, CapsuleTree(reference_wood), step, &first, "Scoring");
    const std::vector<Sample> wanted =
        sample_against(reference_wood, CapsuleTree(wood), step, &second, "Scoring");
    for (int quarter = 0; quarter <= 4; quarter++) {
        const double factor = 0.25 * quarter;
        score.by_radius.push_back(
            agreement(factor, share_within(found, [&](const Sample& s) { return factor * s.other_radius; }),
                      share_within(wanted, [&](const Sample& s) { return factor * s.radius; })));
    }
    for (int centimetres = 0; centimetres <= 5; centimetres++) {
        const double limit = 0.01 * centimetres;
        const auto constant = [&](const Sample&) { return limit; };
        score.by_distance.push_back(
            agreement(limit, share_within(found, constant), share_within(wanted, constant)));
    }
    score.chamfer_mm = 500.0 * (mean_distance(found) + mean_distance(wanted));

    const auto near = [](const Sample& s) { return std::max(kMatch, s.other_radius); };
    score.match = agreement(kMatch, share_within(found, near), share_within(wanted, near));

    const double sample_length = score.reference_length / static_cast<double>(wanted.size());
    const auto errors_between = [&](double from, double to) {
        std::vector<double> errors;
        for (const Sample& sample : wanted)
            if (sample.radius > from && sample.radius <= to &&
                sample.distance <= std::max(kMatch, sample.radius))
                errors.push_back(sample.other_radius / sample.radius - 1.0);
        RadiusAgreement result{from, to, sample_length * static_cast<double>(errors.size()), 0.0, 0.0};
        if (errors.empty()) return result;
        result.error = quantile(errors, 0.5);
        for (double& error : errors)
            error = std::abs(error);
        result.error_abs = quantile(errors, 0.5);
        return result;
    };
    constexpr double kAnyRadius = std::numeric_limits<double>::infinity();
    const RadiusAgreement all = errors_between(0.0, kAnyRadius);
    score.radius_error = all.error;
    score.radius_error_abs = all.error_abs;
    for (size_t i = 0; i <= kThicknesses.size(); i++)
        score.radius_by_thickness.push_back(errors_between(
            i > 0 ? kThicknesses[i - 1] : 0.0, i < kThicknesses.size() ? kThicknesses[i] : kAnyRadius));
    if (progress) progress->update(1.0, "Scoring");
    return score;
}

}  // namespace treerec
