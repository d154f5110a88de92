// Outlines of a branch's wood that a scan shows. Internal to growth/.
#pragma once

#include <vector>

#include "growth/bark_map.h"
#include "progress.h"

namespace treerec::growth {

struct FittedSection {
    double along = 0.0;          // metres of the axis
    std::vector<double> shares;  // of its radius there, in equal directions from 0 of a round on
};

struct SectionFit {
    std::vector<FittedSection> sections;  // lowest first, evenly apart; empty: round wood is as good
    // By how much nearer than round wood they are to cells that they were not fitted to, on average: 0..1.
    double gain = 0.0;
};

// How far shapes are to be alike along the branch.
enum class Along : uint8_t {
    kLong,   // flutes and buttresses: what is as short as a lump stays out
    kShort,  // whatever is not smaller than the directions are apart
};

// Penalised least squares on a grid of shares (Eilers and Marx 2003), robust (Huber 1964, then Tukey's
// biweight), first of circles off the axis and then of what is left; how smooth is told by cross-validation.
// Where nothing is known they lean to the circle and to what is above and below. Nothing is found where the
// cross-validation tells that round wood is as near. longest: T_s, metres. Throws Cancelled.
SectionFit fit_sections(const BarkMap& map, double longest, Along along, const Progress* progress);

// Those that the others do not tell, to a tolerance in shares.
std::vector<FittedSection> thinned(std::vector<FittedSection> sections, double tolerance);

// Metres beyond the axis's radius at each of the map's cells.
std::vector<double> heights_of(const BarkMap& map, const std::vector<FittedSection>& sections);

}  // namespace treerec::growth
