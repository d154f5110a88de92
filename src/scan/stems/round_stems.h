// Stems that stand among leaves, told by their round bark. Internal to scan/.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/vec.h"
#include "progress.h"

namespace treerec {

// A stem's axis and width at one height.
struct StemRing {
    double y = 0.0;     // metres
    DVec2 centre{0.0};  // x, z
    double radius = 0.0;
};

// From below; slices of the tree in which no bark shows have no ring.
using RoundStem = std::vector<StemRing>;

struct RoundStemSearch {
    size_t most = 4;       // stems
    double slice = 0.25;   // metres: a slice is no thicker
    double rough = 0.006;  // metres: how far the points lie off the bark, besides a share of its radius
    size_t seeds = 50;     // per stem and slice: points that circles are tried through
    size_t points = 200;   // per stem and slice: what is looked at of them, evenly
    double highest = 1.0;  // share of the height that is looked at
};

// Mobile scanners are out by a centimetre or two, and see a stem by few points: among many leaves, few of
// these few would be left if a thick slice were thinned as a thin one.
inline constexpr RoundStemSearch kRoughBark{.slice = 0.5, .rough = 0.015, .seeds = 150, .points = 500};

// Circles through the arcs of bark that a scanner sees between the leaves, one slice after another
// (as Olofsson et al. 2014, "Tree stem and height measurements using terrestrial laser scanning and the
// RANSAC algorithm"), and the chains of them that go up with little change (Viterbi). A chain is a stem where
// it begins in the lower part of the tree and is long enough: among leaves alone circles follow no line.
// The thickest first; none where no bark shows. points: metres, Y up, distinct, in canonical order.
std::vector<RoundStem> find_round_stems(const std::vector<Vec3>& points, const Progress* progress,
                                        const RoundStemSearch& search = {});

// By point: 1 for what lies on or in one of the stems.
std::vector<uint8_t> points_on_stems(const std::vector<Vec3>& points, const std::vector<RoundStem>& stems);

// Metres: how far the points lie off the stems' surfaces, the median of those no further off than `most`.
// Bark that is seen sharply has a small part of what blur or leaves give. 0 without points there.
double spread_on_stems(const std::vector<Vec3>& points, const std::vector<RoundStem>& stems, double most);

// By point: 1 for what lies beside the feet of the stems that are seen from the ground up: grass, shrubs.
std::vector<uint8_t> points_around_feet(const std::vector<Vec3>& points, const std::vector<RoundStem>& stems);

}  // namespace treerec
