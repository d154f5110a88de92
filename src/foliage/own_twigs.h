// How the thin wood of one tree grows: what its hidden twigs take from those that were seen.
#pragma once

#include "tree/tree.h"

namespace treerec {

struct OwnTwigs {
    double agreement = 0.6;    // cosine between a twig and the wood that it grows from
    double thinning = 0.8;     // its radius over that wood's
    double thinnest = 0.0015;  // metres, at its end
    double thickest = 0.006;   // metres, at its base
};

// The medians over the forks of wood of at most `slender` metres of radius that were seen (kGuessFlag marks
// what was not), and the thin tenth of its tips; within what twigs of any species have. As above, times
// `scale` where they are lengths, where the tree has too few of them. O(nodes log nodes).
OwnTwigs measure_twigs(const Tree& tree, double slender, double scale);

}  // namespace treerec
