// In place of the rest of this room, where CGAL is left out.
#include "error.h"
#include "growth/bark_fit.h"
#include "growth/grow_bark.h"
#include "growth/lumps.h"

namespace treerec {

namespace {

constexpr char kNoCgal[] = "This build was made without CGAL and can't grow bark; get one that has it.";

}  // namespace

GrownTree grow_bark(const Tree&, const GrowthRecipe&, const GrowBarkOptions&, Progress*) {
    throw Error(kNoCgal);
}

GrowthProposal propose_growth(const Tree&, const PointCloud&, const GrowthRecipe&, Progress*) {
    throw Error(kNoCgal);
}

BarkFit measure_bark_fit(const Tree&, const GrowthRecipe&, const GrownBark&, const PointCloud&, Progress*) {
    throw Error(kNoCgal);
}

}  // namespace treerec
