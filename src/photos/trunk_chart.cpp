#include "photos/trunk_chart.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/portable_math.h"
#include "geometry/quantile.h"
#include "tree/branches.h"

namespace treerec {

namespace {

constexpr double kFlare = 1.3;     // of the stem's radius: wider is the base
constexpr double kBranch = 0.4;    // of the stem's radius: as thick ends the clear part
constexpr double kThinnest = 0.5;  // of the stem's radius
constexpr double kBase = 0.08;     // of the way up to the branch: grass, and earth that was splashed up
constexpr double kRounds = 1.25;

struct Section {
    DVec3 centre;
    double radius;
    double along;  // from the root
};

std::vector<NodeId> trunk_nodes(const Tree& tree) {
    const std::vector<double> lengths = subtree_lengths(tree);
    std::vector<NodeId> stem;
    for (NodeId id = tree.root(); id != kNoNode; id = main_child(tree, id, lengths))
        stem.push_back(id);
    return stem;
}

// Up to the first branch.
std::vector<Section> clear_sections(const Tree& tree, const std::vector<NodeId>& stem) {
    std::vector<Section> sections;
    double along = 0.0;
    for (size_t i = 0; i < stem.size(); i++) {
        const Node& node = tree.node(stem[i]);
        if (i > 0) along += glm::length(node.position - tree.node(stem[i - 1]).position);
        if (sections.empty() || along > sections.back().along)
            sections.push_back({node.position, node.radius, along});
        bool forks = false;
        for (const NodeId child : tree.children(stem[i]))
            forks = forks || ((i + 1 == stem.size() || child != stem[i + 1]) &&
                              tree.node(child).radius >= kBranch * node.radius);
        if (forks && i > 0) break;
    }
    return sections;
}

Section between(const std::vector<Section>& sections, double along) {
    for (size_t i = 1; i < sections.size(); i++)
        if (along <= sections[i].along || i + 1 == sections.size()) {
            const Section &lower = sections[i - 1], &upper = sections[i];
            const double t = (along - lower.along) / (upper.along - lower.along);
            return {glm::mix(lower.centre, upper.centre, t), lower.radius + t * (upper.radius - lower.radius),
                    along};
        }
    return sections.back();
}

}  // namespace

double TrunkChart::mean_radius() const {
    double sum = 0.0;
    for (const ChartRing& ring : rings_)
        sum += ring.radius;
    return rings_.empty() ? 0.0 : sum / static_cast<double>(rings_.size());
}

std::optional<TrunkChart::Spot> TrunkChart::at(double around, double along) const {
    if (rings_.size() < 2 || !(along >= 0.0 && along <= length())) return {};
    // They are evenly apart.
    const double step = length() / static_cast<double>(rings_.size() - 1);
    const size_t i = std::min(static_cast<size_t>(along / step), rings_.size() - 2);
    const ChartRing &lower = rings_[i], &upper = rings_[i + 1];
    const double t = std::clamp((along - lower.along) / step, 0.0, 1.0);
    const double radius = lower.radius + t * (upper.radius - lower.radius);
    const double angle = around / radius;
    if (std::abs(angle) > kRounds * std::numbers::pi) return {};
    const double cosine = portable::cos(angle), sine = portable::sin(angle);
    const DVec3 out = glm::normalize(cosine * glm::mix(lower.side, upper.side, t) +
                                     sine * glm::mix(lower.other, upper.other, t));
    return Spot{glm::mix(lower.centre, upper.centre, t) + radius * out,
                glm::normalize(out - lower.slope * lower.ahead)};
}

double TrunkChart::beside(const DVec3& place) const {
    double least = std::numeric_limits<double>::max(), beside = least;
    for (const ChartRing& ring : rings_) {
        const DVec3 off = place - ring.centre;
        const double ahead = glm::dot(off, ring.ahead);
        if (std::abs(ahead) >= least) continue;
        least = std::abs(ahead);
        beside = glm::length(off - ahead * ring.ahead) - ring.radius;
    }
    return beside;
}

TrunkChart chart_trunk(const Tree& tree, double longest) {
    TrunkChart chart;
    if (tree.empty()) return chart;
    chart.stem_ = trunk_nodes(tree);
    std::vector<Section> sections = clear_sections(tree, chart.stem_);
    if (sections.size() < 2) return chart;
    const double top = sections.back().along;
    std::vector<double> radii;
    constexpr int kSamples = 64;
    for (int i = 0; i <= kSamples; i++)
        radii.push_back(between(sections, top * i / kSamples).radius);
    std::vector<double> sorted = radii;
    const double usual = quantile(sorted, 0.5);
    double from = kBase * top, to = top;
    // The branch's own widening of the stem begins below it.
    if (to > 4.0 * usual) to -= usual;
    for (int i = 0; i <= kSamples / 2; i++)
        if (radii[static_cast<size_t>(i)] > kFlare * usual) from = std::max(from, top * (i + 1) / kSamples);
    for (int i = kSamples / 2; i <= kSamples; i++)
        if (radii[static_cast<size_t>(i)] < kThinnest * usual) {
            to = std::min(to, top * i / kSamples);
            break;
        }
    to = std::min(to, from + longest);
    if (!(to > from)) return chart;
    // As many rings as the stem is half a radius high; their radii are those of a stem that is smooth.
    const int count = std::clamp(static_cast<int>((to - from) / (0.25 * usual)), 2, 400);
    for (int i = 0; i <= count; i++) {
        const double along = from + (to - from) * i / count;
        ChartRing ring;
        double weights = 0.0, radius = 0.0;
        DVec3 centre(0.0);
        for (int k = -2; k <= 2; k++) {
            const Section near = between(sections, std::clamp(along + 0.25 * usual * k, 0.0, top));
            const double weight = 3.0 - std::abs(k);
            weights += weight;
            radius += weight * near.radius;
            centre += weight * near.centre;
        }
        ring.centre = centre / weights;
        ring.radius = radius / weights;
        ring.along = along - from;
        chart.rings_.push_back(ring);
        chart.half_width_ = std::max(chart.half_width_, kRounds * std::numbers::pi * ring.radius);
    }
    DVec3 side(1.0, 0.0, 0.0);
    for (size_t i = 0; i < chart.rings_.size(); i++) {
        ChartRing& ring = chart.rings_[i];
        const ChartRing& before = chart.rings_[i > 0 ? i - 1 : 0];
        const ChartRing& after = chart.rings_[std::min(i + 1, chart.rings_.size() - 1)];
        const DVec3 way = after.centre - before.centre;
        ring.ahead = glm::dot(way, way) > 0.0 ? glm::normalize(way) : DVec3(0.0, 1.0, 0.0);
        if (i == 0 && std::abs(ring.ahead.x) > 0.9) side = DVec3(0.0, 0.0, 1.0);
        side = glm::normalize(side - glm::dot(side, ring.ahead) * ring.ahead);
        ring.side = side;
        ring.other = glm::cross(ring.ahead, side);
        ring.slope = (after.radius - before.radius) / (after.along - before.along);
    }
    return chart;
}

}  // namespace treerec
