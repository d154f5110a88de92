// The wood of a drawn branch: its radii and twigs, as this tree's own branches have them.
#pragma once

#include <string>
#include <vector>

#include "sketch/branch_statistics.h"
#include "sketch/sketch_branch.h"

namespace treerec {

// Sets the radii along the axis: the base radius of a branch of that length, `stouter` times, at most .8 of
// the host's (Chen 2025, algorithm 5), and the branches' own profile.
void set_branch_radii(std::vector<BranchPlace>& axis, const RadiusLaw& law, double stouter,
                      double host_radius);

// What grows on the axis.
struct TwigOnBranch {
    double along = 0.0;      // metres from the branch's base
    double angle = 0.0;      // radians off the branch's direction there
    double azimuth = 0.0;    // radians about it, from the side that is up (frame_about())
    NodeId child = kNoNode;  // the lowest node of the twig of this tree that it is a copy of
    double scale = 1.0;
};

// The first at a place where kindred branches have theirs; internodes and angles are even quantiles of the
// kindred branches', the internodes in an order drawn by chance, the angles in the order of the twigs that
// they are copied to; azimuths follow one kindred branch, or its mirror image. Each is a copy of a twig that
// stands at about that share of a kindred branch. Empty where the tree has no such twig.
std::vector<TwigOnBranch> draw_twigs(const BranchStatistics& statistics, int32_t order,
                                     const std::vector<BranchPlace>& axis, uint64_t seed);

// The whole branch as a scion of the host (edit/graft/scion.h): an axis with a node every `step` metres and
// where twigs leave, guessed segments flagged.
Tree branch_scion(const Tree& tree, NodeId host, const std::vector<BranchPlace>& axis,
                  const std::vector<TwigOnBranch>& twigs, double step);

// The edit that puts exactly this wood onto the host.
std::string graft_command(NodeId host, const Tree& scion, const Progress* progress = nullptr);

}  // namespace treerec
