#include "sketch/twig_place.h"

#include "edit/graft/scion.h"

namespace treerec {

std::vector<std::optional<DVec3>> kept_places(const Tree& scion, const TwigPlace& place, const DVec3& joint,
                                              const CrownSections& crown, std::optional<double> margin) {
    const DMat3 axes = turn_about(place.way, place.spin) * turn_between(scion_direction(scion), place.way);
    std::vector<std::optional<DVec3>> places(static_cast<size_t>(scion.id_end()));
    for (const NodeId id : scion.depth_first()) {
        const Node& node = scion.node(id);
        if (node.parent == kNoNode) {
            places[static_cast<size_t>(id)] = joint;
            continue;
        }
        if (!places[static_cast<size_t>(node.parent)]) continue;
        const DVec3 at = joint + axes * (place.scale * node.position);
        if (!margin || crown.contains(at, *margin)) places[static_cast<size_t>(id)] = at;
    }
    return places;
}

double kept_wood(const Tree& scion, const TwigPlace& place, const DVec3& joint, const CrownSections& crown,
                 double margin) {
    const std::vector<std::optional<DVec3>> places = kept_places(scion, place, joint, crown, margin);
    double wood = 0.0;
    for (size_t id = 0; id < places.size(); id++) {
        if (!places[id]) continue;
        const NodeId parent = scion.node(static_cast<NodeId>(id)).parent;
        if (parent != kNoNode) wood += glm::length(*places[id] - *places[static_cast<size_t>(parent)]);
    }
    return wood;
}

}  // namespace treerec
