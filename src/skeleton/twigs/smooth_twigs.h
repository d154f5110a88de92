// Twigs as smooth as wood grows.
#pragma once

#include "tree/tree.h"

namespace treerec {

// Each branch becomes the cubic smoothing spline of its nodes (Reinsch 1967), which is what is likeliest
// where headings drift as a random walk along the wood (Wahba 1978). Thin twigs, whose nodes noise puts to
// this side and that, lose their elbows; nodes whose radius was measured, stout wood and the ends of gaps
// stay, and branches go on from where their parents have come to lie. Last of all that finds wood: what tells
// twigs from leaves weighs how straight they were found. factor: what makes the tree as large as usual
// (scan/usual_size.h).
void smooth_twigs(Tree& tree, double factor = 1.0);

}  // namespace treerec
