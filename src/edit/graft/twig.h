// A short side branch to graft onto (Chen 2025, algorithm 5).
#pragma once

#include <optional>

#include "tree/tree.h"

namespace treerec {

enum class TwigSide { kLeft, kRight };

struct TwigOptions {
    // Tree space, any length but zero; without it the twig goes to a side of the view.
    std::optional<DVec3> direction;
    // As seen along `view` (from the eye into the scene) with `up` upwards: square to the branch and to the
    // view, and somewhat onwards. Where the branch runs across the view so that its sides are up and down,
    // right is the right hand of one who walks along it, upside as seen.
    TwigSide side = TwigSide::kRight;
    DVec3 view{0.0, 0.0, -1.0};
    DVec3 up{0.0, 1.0, 0.0};
    // Where length or radius is 0: 0.6 of the way to the node's first child and 0.8 of the node's radius, as
    // algorithm 5 prints it, in place of what suits the host. A tip has no such length.
    bool as_printed = false;
    // Metres; 0 for what suits the host: 0.6 of the branch's segment there, and at least out of the bark by
    // twice the twig's thickness.
    double length = 0.0;
    // Metres, at most the host's; 0 for what suits it: 0.8 of a thin one's, a smaller share of a thick one's.
    double radius = 0.0;
};

// Adds one node as the last child of `node` and returns its id. Nothing else changes. Throws Error, before
// anything changes, for an unknown node, a direction or view of no length, a negative length or radius, or a
// tip's printed length.
NodeId make_twig(Tree& tree, NodeId node, const TwigOptions& options);

}  // namespace treerec
