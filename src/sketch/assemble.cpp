#include "sketch/assemble.h"

#include <algorithm>

#include "sketch/twig_place.h"

namespace treerec {

namespace {

// A twig's radius at the joint over its branch's, at most, as of what is grafted (edit/graft/graft.h).
constexpr double kJoint = 0.8;
constexpr double kSame = 1e-6;      // metres along a branch that are one place
constexpr double kFinest = 0.0004;  // metres of radius: the thinnest wood of a twig

struct Stop {
    double along;
    NodeId node = kNoNode;
};

// The places on each branch that need a node, in order.
std::vector<std::vector<Stop>> stops_of(const Filling& filling) {
    std::vector<std::vector<Stop>> stops(filling.axes.size());
    for (size_t i = 0; i < filling.axes.size(); i++) {
        const FilledAxis& own = filling.axes[i];
        double along = 0.0;
        for (size_t k = 0; k < own.axis.points.size(); k++) {
            if (k > 0) along += glm::length(own.axis.points[k] - own.axis.points[k - 1]);
            stops[i].push_back({along});
        }
        if (own.parent >= 0) stops[static_cast<size_t>(own.parent)].push_back({own.axis.along});
    }
    for (const TwigPlace& twig : filling.twigs)
        stops[twig.axis].push_back({twig.along});
    for (std::vector<Stop>& axis : stops) {
        std::sort(axis.begin(), axis.end(), [](const Stop& a, const Stop& b) { return a.along < b.along; });
        const auto same = [](const Stop& a, const Stop& b) { return b.along - a.along < kSame; };
        axis.erase(std::unique(axis.begin(), axis.end(), same), axis.end());
    }
    return stops;
}

NodeId node_at(const std::vector<Stop>& stops, double along) {
    const auto after = std::lower_bound(stops.begin(), stops.end(), along,
                                        [](const Stop& stop, double value) { return stop.along < value; });
    if (after == stops.end()) return stops.back().node;
    if (after == stops.begin()) return after->node;
    const auto before = after - 1;
    return along - before->along < after->along - along ? before->node : after->node;
}

}  // namespace

AssembledTree assemble_tree(const Filling& filling, const SketchSpecies& species, const CrownSections& crown,
                            std::optional<double> margin, const Progress* progress) {
    AssembledTree out;
    std::vector<std::vector<Stop>> stops = stops_of(filling);
    const auto remember = [&](int32_t stroke) { out.stroke_of_node.push_back(stroke); };
    for (size_t i = 0; i < filling.axes.size(); i++) {
        const FilledAxis& own = filling.axes[i];
        const uint8_t flags = i == 0 ? kTrunkFlag : 0;
        NodeId last = kNoNode;
        if (i > 0) {
            last = node_at(stops[static_cast<size_t>(std::max(own.parent, 0))], own.axis.along);
            stops[i][0].node = last;
        }
        for (size_t k = i > 0 ? 1 : 0; k < stops[i].size(); k++) {
            const double along = stops[i][k].along;
            const DVec3 at = place_along(own.axis.points, along);
            const double radius = value_along(own.axis.points, own.axis.radii, along);
            last = last == kNoNode ? out.tree.add_root(at, radius, flags)
                                   : out.tree.add_child(last, at, radius, flags);
            stops[i][k].node = last;
            remember(own.axis.stroke);
        }
    }
    std::vector<NodeId> moved;
    for (const TwigPlace& place : filling.twigs) {
        if (progress) progress->check();
        const Tree& scion = species.twigs[place.twig].scion;
        const NodeId joint = node_at(stops[place.axis], place.along);
        const std::vector<std::optional<DVec3>> kept =
            kept_places(scion, place, out.tree.node(joint).position, crown, margin);
        const double own = scion.node(scion.root()).radius * place.scale;
        const double thin = std::min(1.0, kJoint * out.tree.node(joint).radius / own);
        moved.assign(kept.size(), kNoNode);
        for (const NodeId id : scion.depth_first()) {
            const auto index = static_cast<size_t>(id);
            const Node& node = scion.node(id);
            if (node.parent == kNoNode) {
                moved[index] = joint;
            } else if (kept[index]) {
                const NodeId parent = moved[static_cast<size_t>(node.parent)];
                const double radius = std::min(std::max(node.radius * place.scale * thin, kFinest),
                                               out.tree.node(parent).radius);
                moved[index] = out.tree.add_child(parent, *kept[index], radius);
                remember(-1);
            }
        }
    }
    return out;
}

}  // namespace treerec
