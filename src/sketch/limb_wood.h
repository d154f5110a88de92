// The wood of a drawn limb: its radii and twigs, as this tree's own limbs have them.
#pragma once

#include <string>
#include <vector>

#include "sketch/limb.h"
#include "sketch/limb_statistics.h"

namespace treerec {

// Sets the radii along the axis: the base radius of a limb of that length, `stouter` times, at most .8 of the
// host's (Chen 2025, algorithm 5), and the limbs' own profile.
void set_limb_radii(std::vector<LimbPlace>& axis, const RadiusLaw& law, double stouter, double host_radius);

// What grows on the axis.
struct TwigOnLimb {
    double along = 0.0;      // metres from the limb's base
    double angle = 0.0;      // radians off the limb's direction there
    double azimuth = 0.0;    // radians about it, from the side that is up (frame_about())
    NodeId child = kNoNode;  // the lowest node of the twig of this tree that it is a copy of
    double scale = 1.0;
};

// The first at a place where kindred limbs have theirs; internodes and angles are even quantiles of the
// kindred limbs', the internodes in an order drawn by chance, the angles in the order of the twigs that they
// are copied to; azimuths follow one kindred limb, or its mirror image. Each is a copy of a twig that stands
// at about that share of a kindred limb. Empty where the tree has no such twig.
std::vector<TwigOnLimb> draw_twigs(const LimbStatistics& statistics, int32_t order,
                                   const std::vector<LimbPlace>& axis, uint64_t seed);

// The whole limb as a scion of the host (edit/graft/scion.h): an axis with a node every `step` metres and
// where twigs leave, guessed segments flagged.
Tree limb_scion(const Tree& tree, NodeId host, const std::vector<LimbPlace>& axis,
                const std::vector<TwigOnLimb>& twigs, double step);

// The edit that puts exactly this wood onto the host.
std::string graft_command(NodeId host, const Tree& scion, const Progress* progress = nullptr);

}  // namespace treerec
