#include "scan/cleaning/clean_cloud.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "geometry/parallel.h"
#include "scan/cleaning/clean_steps.h"
#include "scan/cleaning/samples.h"
#include "scan/stems/separate_trees.h"

namespace treerec {

namespace {

constexpr size_t kBlock = size_t{1} << 20;  // points between two looks at the progress
// What is said where more than this share of the points goes.
constexpr double kRemarkable = 0.02;

// The samples still in the cloud, and how the steps take some away.
class Cleaning {
  public:
    Cleaning(PointCloud& cloud, CleanReport& report, const Progress* progress)
        : cloud_(cloud),
          report_(report),
          samples_(take_samples(cloud.positions, samples_for(cloud.positions, progress), progress)) {
        weights_.resize(samples_.points.size());
        for (size_t i = 0; i < samples_.of_point.size(); i++) {
            if (progress && i % kBlock == 0) progress->check();
            weights_[samples_.of_point[i]]++;
        }
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

    const std::array<Range, 3>& ranges() const { return samples_.ranges; }

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

    // Leaves out what stands flat. Says so in the report.
    void take_walls(const Progress* progress) {
        std::vector<DVec2> walls;
        const std::vector<uint8_t> goes = find_walls(points(), walls, progress);
        if (walls.empty()) return;
        take("Walls", goes);
        std::array<char, 200> text;
        std::snprintf(
            text.data(), text.size(),
            "%zu points lie on %s, %.1f m long and %.1f m high, and were left out. If they are part "
            "of the tree, leave out the cleaning of the ground.",
            report_.steps.back().removed, walls.size() == 1 ? "a wall" : "walls, the widest", walls[0].x,
            walls[0].y);
        report_.warnings.emplace_back(text.data());
    }

    // Finds out which trees there are, and which is wanted. Says so in the report.
    Separation tell_apart(const Ground& ground, double spacing, const PickOptions& options,
                          const Progress* progress) {
        const std::vector<Vec3> left = points();
        Separation separation = separate_trees(left, ground, spacing, progress);
        std::vector<uint32_t> weights;
        for (const uint32_t s : alive_)
            weights.push_back(weights_[s]);
        report_.pick = choose_tree(separation, left, weights, cloud_.frame, options, report_.warnings);
        return separation;
    }

    // Leaves one tree of several.
    void take_others(const Separation& separation) {
        if (report_.pick.trees.empty()) return;
        size_t removed = 0;
        size_t kept = 0;
        for (size_t i = 0; i < alive_.size(); i++) {
            if (separation.of_point[i] == report_.pick.taken)
                alive_[kept++] = alive_[i];
            else
                removed += weights_[alive_[i]];
        }
        alive_.resize(kept);
        report_.steps.push_back({"Other trees", removed});
    }

    // Into labels by sample.
    void label_trees(const Separation& separation, std::vector<uint32_t>& of_sample) const {
        for (size_t i = 0; i < alive_.size(); i++)
            of_sample[alive_[i]] = report_.pick.trees.empty() ? 0 : separation.of_point[i];
    }

    // However many these are: a meadow is nearly all ground.
    void take_ground(const std::vector<uint8_t>& lies, std::vector<uint32_t>& of_sample) {
        std::vector<uint32_t> stands;
        for (size_t i = 0; i < alive_.size(); i++) {
            if (lies[i])
                of_sample[alive_[i]] = kOnGround;
            else
                stands.push_back(alive_[i]);
        }
        alive_.swap(stands);
    }

    size_t sample_count() const { return samples_.points.size(); }
    bool empty() const { return alive_.empty(); }

    // By point of the cloud.
    std::vector<uint32_t> labels(const std::vector<uint32_t>& of_sample) const {
        std::vector<uint32_t> of_point;
        of_point.reserve(samples_.of_point.size());
        for (const uint32_t s : samples_.of_point)
            of_point.push_back(of_sample[s]);
        return of_point;
    }

    // What lies in the ground's layer, below its surface.
    std::vector<uint8_t> below(const Ground& ground) const {
        std::vector<uint8_t> lies;
        for (const Vec3& p : points()) {
            const double above = ground.above(p);
            lies.push_back(above < ground.surface && above >= -ground.tolerance);
        }
        return lies;
    }

    // Leaves out what lies below the ground's surface at the foot. Counted as ground.
    void take_below(const Ground& ground) {
        if (!ground.found) return;
        const std::vector<uint8_t> goes = below(ground);
        std::vector<uint32_t> kept;
        size_t removed = 0;
        for (size_t i = 0; i < alive_.size(); i++) {
            if (goes[i])
                removed += weights_[alive_[i]];
            else
                kept.push_back(alive_[i]);
        }
        if (kept.empty()) return;
        alive_.swap(kept);
        for (CleanStep& step : report_.steps)
            if (step.name == "Ground") step.removed += removed;
    }

    // Leaves out what stands beside the tree that is wanted.
    void take_beside(const Ground& ground, const DVec3& place, const Progress* progress) {
        const std::vector<uint8_t> goes =
            find_beside(points(), ground, cloud_.frame.to_tree(place), progress);
        if (std::find(goes.begin(), goes.end(), uint8_t{1}) != goes.end()) take("Beside the tree", goes);
    }

    void apply(const Progress* progress) {
        std::vector<uint8_t> sample_stays(samples_.points.size());
        for (const uint32_t s : alive_)
            sample_stays[s] = 1;
        std::vector<uint8_t> keep(cloud_.size());
        for (size_t i = 0; i < keep.size(); i++) {
            if (progress && i % kBlock == 0) progress->check();
            keep[i] = sample_stays[samples_.of_point[i]];
        }
        if (progress) progress->check();
        cloud_.keep_only(keep);
    }

  private:
    PointCloud& cloud_;
    CleanReport& report_;
    Samples samples_;
    std::vector<uint32_t> weights_;  // points of the cloud by sample
    std::vector<uint32_t> alive_;
};

void take_outliers(Cleaning& cleaning, const CleanOptions& options, double& spacing,
                   const Progress* progress) {
    if (options.remove_outliers || options.remove_fragments || options.pick.enabled) {
        const std::vector<uint8_t> outliers =
            find_outliers(cleaning.points(), cleaning.ranges(), options.neighbours,
                          options.outlier_deviations, spacing, progress);
        if (options.remove_outliers) cleaning.take("Outliers", outliers);
    }
}

// What is left out before the trees are told apart. spacing: as from find_outliers().
Ground take_what_is_no_tree(Cleaning& cleaning, const CleanOptions& options, double& spacing,
                            const Progress* progress) {
    take_outliers(cleaning, options, spacing, progress);
    // Before the fragments, which the ground would hold together.
    Ground ground;
    if (options.remove_ground) {
        cleaning.take("Ground", find_ground(cleaning.points(), ground, progress));
        cleaning.take_walls(progress);
    }
    return ground;
}

}  // namespace

CleanReport clean_cloud(PointCloud& cloud, const CleanOptions& options, Progress* progress) {
    CleanReport report;
    auto step = [&](double fraction) {
        if (!progress) return;
        progress->check();
        progress->update(fraction, "Cleaning");
    };
    if (cloud.empty()) throw Error("The cloud has no points.");
    step(0.0);
    if (options.remove_extreme_colors && cloud.has_colors()) clean_colors(cloud, options, report, progress);
    step(0.1);
    Cleaning cleaning(cloud, report, progress);
    step(0.3);
    double spacing = 0.0;
    const Ground ground = take_what_is_no_tree(cleaning, options, spacing, progress);
    step(0.7);
    if (options.pick.enabled)
        cleaning.take_others(cleaning.tell_apart(ground, spacing, options.pick, progress));
    if (options.pick.position) cleaning.take_beside(ground, *options.pick.position, progress);
    // Not before: it holds the stems of a clump together.
    cleaning.take_below(ground);
    step(0.85);
    if (options.remove_fragments) {
        const double share = cleaning.take("Fragments", find_fragments(cleaning.points(), spacing, progress));
        if (share > kRemarkable)
            report.warnings.push_back(
                std::to_string(std::lround(100.0 * share)) +
                " % of the points stand well apart from the rest and were left out. If "
                "they are part of the tree, leave out the cleaning of fragments; if they "
                "are a tree of their own, give each tree a file of its own.");
    }
    step(0.9);
    cleaning.apply(progress);
    step(1.0);
    return report;
}

std::vector<uint32_t> label_trees(PointCloud cloud, const CleanOptions& options, PickReport& report,
                                  Progress* progress) {
    if (cloud.empty()) throw Error("The cloud has no points.");
    CleanReport cleaned;
    Cleaning cleaning(cloud, cleaned, progress);
    double spacing = 0.0;
    const Ground ground = take_what_is_no_tree(cleaning, options, spacing, progress);
    const Separation separation = cleaning.tell_apart(ground, spacing, options.pick, progress);
    report = cleaned.pick;
    std::vector<uint32_t> of_sample(cleaning.sample_count(), kNoTree);
    cleaning.label_trees(separation, of_sample);
    return cleaning.labels(of_sample);
}

std::vector<uint32_t> label_plot(PointCloud cloud, const CleanOptions& options, PickReport& report,
                                 Progress* progress) {
    if (cloud.empty()) throw Error("The cloud has no points.");
    CleanReport cleaned;
    Cleaning cleaning(cloud, cleaned, progress);
    double spacing = 0.0;
    take_outliers(cleaning, options, spacing, progress);
    std::vector<uint32_t> of_sample(cleaning.sample_count(), kNoTree);
    Ground ground;
    cleaning.take_ground(find_ground(cleaning.points(), ground, progress), of_sample);
    if (!cleaning.empty()) {
        cleaning.take_walls(progress);
        cleaning.label_trees(cleaning.tell_apart(ground, spacing, options.pick, progress), of_sample);
        if (ground.found) cleaning.take_ground(cleaning.below(ground), of_sample);
    }
    report = cleaned.pick;
    return cleaning.labels(of_sample);
}

}  // namespace treerec
