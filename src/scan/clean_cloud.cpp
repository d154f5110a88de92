#include "scan/clean_cloud.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>

#include "geometry/parallel.h"
#include "scan/clean_steps.h"
#include "scan/samples.h"

namespace treerec {

namespace {

constexpr size_t kMostSamples = 400000;
constexpr int kMostNeighbours = 64;
// Fragments that are a larger share of the points than this may be a tree.
constexpr double kRemarkable = 0.2;
// A point's neighbour distance must be this many times that of its neighbours.
constexpr double kLocalContrast = 2.5;

struct KdPoints {
    const std::vector<Vec3>& points;

    size_t kdtree_get_point_count() const { return points.size(); }
    float kdtree_get_pt(size_t index, size_t axis) const { return points[index][static_cast<int>(axis)]; }
    template <typename Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};

using KdTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, KdPoints>, KdPoints, 3, uint32_t>;

bool has_real_colors(const PointCloud& cloud) {
    for (const Color8& c : cloud.colors)
        if (c != cloud.colors.front()) return true;
    return false;
}

std::vector<uint8_t> find_extreme_colors(const PointCloud& cloud, const CleanOptions& options) {
    std::vector<uint8_t> goes(cloud.size());
    for (size_t i = 0; i < cloud.size(); i++) {
        const Color8& c = cloud.colors[i];
        const auto [low, high] = std::minmax({c[0], c[1], c[2]});
        goes[i] = low >= options.white_above || high <= options.black_below;
    }
    return goes;
}

// The samples still in the cloud, and how the steps take some away.
class Cleaning {
  public:
    Cleaning(PointCloud& cloud, CleanReport& report, const Progress* progress)
        : cloud_(cloud), report_(report), samples_(take_samples(cloud.positions, kMostSamples, progress)) {
        weights_.resize(samples_.points.size());
        for (const uint32_t s : samples_.of_point)
            weights_[s]++;
        alive_.resize(samples_.points.size());
        for (size_t i = 0; i < alive_.size(); i++)
            alive_[i] = static_cast<uint32_t>(i);
    }

    std::vector<Vec3> points() const {
        std::vector<Vec3> points;
        points.reserve(alive_.size());
        for (const uint32_t s : alive_)
            points.push_back(samples_.points[s]);
        return points;
    }

    // goes: by index into points(). Returns the share of the points that were taken.
    double take(const char* name, const std::vector<uint8_t>& goes) {
        size_t removed = 0;
        size_t all = 0;
        for (size_t i = 0; i < alive_.size(); i++) {
            all += weights_[alive_[i]];
            removed += goes[i] ? weights_[alive_[i]] : 0;
        }
        if (removed * 10 > all * 9) {
            report_.warnings.push_back("The cleaning step '" + std::string(name) + "' would have taken " +
                                       std::to_string(removed) + " of " + std::to_string(all) +
                                       " points and was left out.");
            removed = 0;
        } else {
            size_t kept = 0;
            for (size_t i = 0; i < alive_.size(); i++)
                if (!goes[i]) alive_[kept++] = alive_[i];
            alive_.resize(kept);
        }
        report_.steps.push_back({name, removed});
        return all > 0 ? static_cast<double>(removed) / static_cast<double>(all) : 0.0;
    }

    void apply() {
        std::vector<uint8_t> sample_stays(samples_.points.size());
        for (const uint32_t s : alive_)
            sample_stays[s] = 1;
        std::vector<uint8_t> keep(cloud_.size());
        for (size_t i = 0; i < keep.size(); i++)
            keep[i] = sample_stays[samples_.of_point[i]];
        cloud_.keep_only(keep);
    }

  private:
    PointCloud& cloud_;
    CleanReport& report_;
    Samples samples_;
    std::vector<uint32_t> weights_;  // points of the cloud by sample
    std::vector<uint32_t> alive_;
};

void clean_colors(PointCloud& cloud, const CleanOptions& options, CleanReport& report) {
    size_t removed = 0;
    if (has_real_colors(cloud)) {
        std::vector<uint8_t> goes = find_extreme_colors(cloud, options);
        removed = static_cast<size_t>(std::count(goes.begin(), goes.end(), uint8_t{1}));
        // Noise against the sky is a part of the points; half of them would be the way the cloud is painted.
        if (removed * 2 > cloud.size()) {
            report.warnings.push_back("More than half of the points are near white or near black (" +
                                      std::to_string(removed) + "); they were kept.");
            removed = 0;
        } else {
            for (uint8_t& flag : goes)
                flag = !flag;
            cloud.keep_only(goes);
        }
    }
    report.steps.push_back({"Extreme colours", removed});
}

}  // namespace

std::vector<uint8_t> find_outliers(const std::vector<Vec3>& points, int k, double deviations, double& spacing,
                                   const Progress* progress) {
    std::vector<uint8_t> goes(points.size());
    spacing = 0.0;
    const size_t neighbours = static_cast<size_t>(std::clamp(k, 1, kMostNeighbours));
    if (points.size() <= neighbours + 1) return goes;

    const KdPoints kd_points{points};
    const KdTree tree(3, kd_points, nanoflann::KDTreeSingleIndexAdaptorParams(16));
    std::vector<double> distance(points.size());
    std::vector<uint32_t> nearest(points.size() * neighbours);
    parallel_for(points.size(), 4096, [&](size_t begin, size_t end) {
        if (progress) progress->check();
        std::array<uint32_t, kMostNeighbours + 1> found{};
        std::array<float, kMostNeighbours + 1> squares{};
        for (size_t i = begin; i < end; i++) {
            // The first one found is the point itself, as all points are distinct.
            tree.knnSearch(&points[i].x, neighbours + 1, found.data(), squares.data());
            double sum = 0.0;
            for (size_t n = 0; n < neighbours; n++) {
                sum += std::sqrt(squares[n + 1]);
                nearest[i * neighbours + n] = found[n + 1];
            }
            distance[i] = sum / static_cast<double>(neighbours);
        }
    });

    std::vector<double> values = distance;
    spacing = quantile(values, 0.95);
    const double median = quantile(values, 0.5);
    for (double& v : values)
        v = std::abs(v - median);
    const double limit = median + deviations * 1.4826 * quantile(values, 0.5);
    std::vector<double> around(neighbours);
    for (size_t i = 0; i < points.size(); i++) {
        if (distance[i] <= limit) continue;
        for (size_t n = 0; n < neighbours; n++)
            around[n] = distance[nearest[i * neighbours + n]];
        goes[i] = distance[i] > kLocalContrast * quantile(around, 0.5);
    }
    return goes;
}

std::vector<uint8_t> find_fragments(const std::vector<Vec3>& points, double spacing) {
    std::vector<uint8_t> goes(points.size());
    if (points.size() < 10) return goes;
    const std::array<Range, 3> ranges = robust_ranges(points);
    const double extent = std::max({ranges[0].size(), ranges[1].size(), ranges[2].size()});
    if (!(extent > 0.0)) return goes;
    const std::vector<uint32_t> label = connected_components(points, std::max(0.03 * extent, 3.0 * spacing));

    const size_t count = *std::max_element(label.begin(), label.end()) + size_t{1};
    if (count == 1) return goes;
    std::vector<size_t> size(count);
    for (const uint32_t l : label)
        size[l]++;
    const size_t largest = static_cast<size_t>(std::max_element(size.begin(), size.end()) - size.begin());

    // A part with a share of the points is one of the tree's unless it stands well apart: a stem below a gap,
    // a limb seen from one side.
    const size_t substantial = std::max<size_t>(5, points.size() / 200);
    const double near = 0.25 * extent;
    std::vector<Vec3> main;
    for (size_t i = 0; i < points.size(); i++)
        if (label[i] == largest) main.push_back(points[i]);
    const KdPoints kd_points{main};
    const KdTree tree(3, kd_points, nanoflann::KDTreeSingleIndexAdaptorParams(16));
    std::vector<double> gap(count, std::numeric_limits<double>::max());
    for (size_t i = 0; i < points.size(); i++) {
        if (label[i] == largest || size[label[i]] < substantial) continue;
        uint32_t found = 0;
        float square = 0.0F;
        tree.knnSearch(&points[i].x, 1, &found, &square);
        gap[label[i]] = std::min<double>(gap[label[i]], std::sqrt(square));
    }
    for (size_t i = 0; i < points.size(); i++)
        goes[i] = label[i] != largest && gap[label[i]] > near;
    return goes;
}

CleanReport clean_cloud(PointCloud& cloud, const CleanOptions& options, Progress* progress) {
    CleanReport report;
    auto step = [&](double fraction) {
        if (!progress) return;
        progress->check();
        progress->update(fraction, "Cleaning");
    };
    if (cloud.empty()) throw Error("The cloud has no points.");
    step(0.0);
    if (options.remove_extreme_colors && cloud.has_colors()) clean_colors(cloud, options, report);
    step(0.1);
    Cleaning cleaning(cloud, report, progress);
    step(0.3);
    double spacing = 0.0;
    if (options.remove_outliers || options.remove_fragments) {
        const std::vector<uint8_t> outliers = find_outliers(cleaning.points(), options.neighbours,
                                                            options.outlier_deviations, spacing, progress);
        if (options.remove_outliers) cleaning.take("Outliers", outliers);
    }
    step(0.7);
    // Before the fragments, which the ground would hold together.
    if (options.remove_ground) cleaning.take("Ground", find_ground(cleaning.points()));
    step(0.8);
    if (options.remove_fragments) {
        const double share = cleaning.take("Fragments", find_fragments(cleaning.points(), spacing));
        if (share > kRemarkable)
            report.warnings.push_back(std::to_string(std::lround(100.0 * share)) +
                                      " % of the points stand well apart from the rest and were left out. If "
                                      "they are a tree of their own, give each tree a file of its own.");
    }
    step(0.9);
    cleaning.apply();
    step(1.0);
    return report;
}

}  // namespace treerec
