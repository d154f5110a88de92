// In place of the rest of this room, where CGAL is left out.
#include "error.h"
#include "growth/bark_fit.h"
#include "growth/grow_bark.h"
#include "growth/lumps.h"
#include "growth/places.h"

namespace treerec {

namespace {

[[noreturn]] void refuse() {
    throw Error("This build was made without CGAL and can't grow bark; get one that has it.");
}

}  // namespace

GrownTree grow_bark(const Tree&, const GrowthRecipe&, const GrowBarkOptions&, Progress*) {
    refuse();
}

LevelError measure_level(const GrownBark&, double) {
    refuse();
}

GrowthProposal propose_growth(const Tree&, const PointCloud&, const GrowthRecipe&, Progress*) {
    refuse();
}

BarkFit measure_bark_fit(const Tree&, const GrowthRecipe&, const GrownBark&, const PointCloud&, Progress*) {
    refuse();
}

// Nowhere does bark grow.
struct BarkPlaces::Data {};
BarkPlaces::BarkPlaces(const Tree&, double, double) {}
BarkPlaces::~BarkPlaces() = default;
BarkPlaces::BarkPlaces(BarkPlaces&&) noexcept = default;
BarkPlaces& BarkPlaces::operator=(BarkPlaces&&) noexcept = default;
std::optional<BarkPlace> BarkPlaces::pick(const DVec3&, const DVec3&) const {
    return std::nullopt;
}
std::optional<BarkPlace> BarkPlaces::find(const GrowthPlace&) const {
    return std::nullopt;
}
Mesh BarkPlaces::mouth(const GrowthFeature&) const {
    return {};
}
Mesh BarkPlaces::lift(const GrowthFeature&, double) const {
    return {};
}

}  // namespace treerec
