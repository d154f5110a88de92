#include "skeleton/cylinders/sections.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "geometry/capsule_tree.h"
#include "geometry/parallel.h"
#include "skeleton/cylinders/section_outline.h"
#include "tree/branches.h"
#include "tree/wood_segments.h"

namespace treerec {

namespace {

constexpr double kStout = 0.04;  // metres of radius: thinner wood is as thick as its noise is deep
constexpr double kFar = 2.2;     // radii from the axis: nothing there is bark
constexpr double kWindow = 1.0;  // radii to each side,
constexpr double kWidest = 2.0;  // and where nodes are farther apart
constexpr double kSame = 0.5;    // radii: nodes so near see the same
constexpr double kSteady = 0.5;  // section_steadiness()
constexpr size_t kPointsPerChunk = 4096;

// A point of the bark, seen from its branch.
struct Sample {
    int32_t branch = -1;
    double along = 0.0;  // metres, along the straight ways between nodes
    DVec2 offset{0.0};   // from the axis, over the radius
};

// A node to measure at.
struct Place {
    NodeId node;
    int32_t branch;
    double from;  // metres along
    double to;
};

class SectionMeasurer {
  public:
    SectionMeasurer(Tree& tree, const std::vector<Vec3>& points, const Progress& progress)
        : tree_(tree),
          points_(points),
          progress_(progress),
          list_(list_branches(tree)),
          along_(static_cast<size_t>(tree.id_end()), 0.0),
          same_as_(static_cast<size_t>(tree.id_end()), kNoNode) {}

    void run() {
        choose_places();
        if (places_.empty()) return;
        collect();
        std::vector<std::optional<SectionShape>> shapes(places_.size());
        parallel_for(places_.size(), 4, [&](size_t begin, size_t end) {
            progress_.check();
            std::vector<DVec2> offsets;
            for (size_t i = begin; i < end; i++)
                shapes[i] = measure(places_[i], offsets);
        });
        keep(shapes);
    }

  private:
    void choose_places() {
        for (size_t b = 0; b < list_.branches.size(); b++) {
            const Branch& branch = list_.branches[b];
            const std::span<const NodeId> nodes = list_.nodes_of(branch);
            NodeId before = branch.attach;
            for (const NodeId id : nodes) {
                if (before != kNoNode)
                    along_[id] = (before == branch.attach ? 0.0 : along_[before]) +
                                 glm::distance(tree_.node(id).position, tree_.node(before).position);
                before = id;
            }
            const Place* last = nullptr;
            for (size_t i = 0; i < nodes.size(); i++) {
                const double radius = tree_.node(nodes[i]).radius, at = along_[nodes[i]];
                if (radius < kStout) continue;
                if (last && at - along_[last->node] < kSame * radius) {
                    same_as_[nodes[i]] = last->node;
                    continue;
                }
                const double below = i > 0 ? at - along_[nodes[i - 1]] : 0.0;
                const double above = i + 1 < nodes.size() ? along_[nodes[i + 1]] - at : 0.0;
                const auto reach = [&](double gap) {
                    return std::clamp(0.5 * gap, kWindow * radius, kWidest * radius);
                };
                places_.push_back({nodes[i], static_cast<int32_t>(b), at - reach(below), at + reach(above)});
                last = &places_.back();
            }
        }
    }

    Sample sample_of(const DVec3& p, const CapsuleTree& wood) const {
        BarkHit hit;
        wood.find_bark(p, hit);
        const NodeId id = hit.child;
        const Node& node = tree_.node(id);
        if (node.radius < kStout) return {};
        const Node& lower = tree_.node(node.parent);
        const int32_t branch = list_.branch_of[id];
        const DVec3 way = node.position - lower.position;
        const double length = glm::length(way);
        if (!(length > 0.0)) return {};
        const DVec3 direction = way / length;
        const DVec3 from = p - lower.position;
        const double on = glm::dot(from, direction);
        const bool first = list_.branch_of[node.parent] != branch;
        // Beyond an end the distance says nothing of the outline; in a bend it does.
        if ((node.child_count == 0 && on > length) || (first && on < 0.0)) return {};
        const double share = std::clamp(on / length, 0.0, 1.0);
        const double radius = first ? node.radius : glm::mix(lower.radius, node.radius, share);
        const DVec3 out = from - direction * on;
        const DVec3 zero = section_zero(direction);
        return {branch, along_[id] - length * (1.0 - share),
                DVec2(glm::dot(out, zero), glm::dot(out, glm::cross(direction, zero))) / radius};
    }

    // All samples, by branch and along it.
    void collect() {
        std::vector<WoodSegment> all = wood_segments(tree_), stout;
        for (const WoodSegment& segment : all)
            if (segment.radius >= kStout) stout.push_back(segment);
        if (stout.empty()) return;
        const CapsuleTree stout_wood(std::move(stout)), wood(std::move(all));
        std::vector<Sample> found(points_.size());
        parallel_for(points_.size(), kPointsPerChunk, [&](size_t begin, size_t end) {
            progress_.check();
            for (size_t i = begin; i < end; i++) {
                const DVec3 p(points_[i]);
                BarkHit near;
                stout_wood.find_bark(p, near);
                if (near.error < (kFar - 1.0) * tree_.node(near.child).radius) found[i] = sample_of(p, wood);
            }
        });
        std::erase_if(found, [](const Sample& sample) { return sample.branch < 0; });
        std::sort(found.begin(), found.end(), [](const Sample& a, const Sample& b) {
            return std::tie(a.branch, a.along, a.offset.x, a.offset.y) <
                   std::tie(b.branch, b.along, b.offset.x, b.offset.y);
        });
        samples_ = std::move(found);
    }

    std::optional<SectionShape> measure(const Place& place, std::vector<DVec2>& offsets) const {
        const Node& node = tree_.node(place.node);
        if (node.parent != kNoNode &&
            section_steadiness(
                normalized_or(node.position - tree_.node(node.parent).position, DVec3(0, 1, 0))) < kSteady)
            return std::nullopt;
        const auto before = [](const Sample& sample, const std::pair<int32_t, double>& at) {
            return std::pair(sample.branch, sample.along) < at;
        };
        const auto begin =
            std::lower_bound(samples_.begin(), samples_.end(), std::pair(place.branch, place.from), before);
        const auto end = std::lower_bound(begin, samples_.end(), std::pair(place.branch, place.to), before);
        offsets.clear();
        for (auto sample = begin; sample != end; ++sample)
            offsets.push_back(sample->offset);
        return outline_of(offsets);
    }

    void keep(const std::vector<std::optional<SectionShape>>& shapes) {
        std::vector<SectionShape> measured;
        std::vector<size_t> number(shapes.size(), 0);
        for (size_t i = 0; i < shapes.size() && measured.size() < kMostSections; i++) {
            if (!shapes[i]) continue;
            measured.push_back(*shapes[i]);
            number[i] = measured.size();
        }
        const size_t before = tree_.add_sections(measured);
        for (size_t i = 0; i < shapes.size(); i++)
            if (number[i] > 0) tree_.set_section(places_[i].node, before + number[i]);
        for (NodeId id = 0; id < tree_.id_end(); id++)
            if (same_as_[id] != kNoNode) tree_.set_section(id, tree_.node(same_as_[id]).section);
    }

    Tree& tree_;
    const std::vector<Vec3>& points_;
    const Progress& progress_;
    const BranchList list_;
    std::vector<double> along_;    // by node, from where its branch begins
    std::vector<NodeId> same_as_;  // by node: whose section is its own
    std::vector<Place> places_;
    std::vector<Sample> samples_;
};

}  // namespace

void measure_sections(Tree& tree, const std::vector<Vec3>& points, const Progress& progress) {
    if (tree.size() < 2) return;
    SectionMeasurer(tree, points, progress).run();
}

}  // namespace treerec
