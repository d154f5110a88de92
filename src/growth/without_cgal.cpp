// In place of the rest of this room, where CGAL is left out.
#include "error.h"
#include "growth/grow_bark.h"
#include "growth/places.h"

namespace treerec {

GrownTree grow_bark(const Tree&, const GrowthRecipe&, const GrowBarkOptions&, Progress*) {
    throw Error("This build was made without CGAL and can't grow bark; get one that has it.");
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
Mesh BarkPlaces::lift(const GrowthFeature&, double) const {
    return {};
}

}  // namespace treerec
