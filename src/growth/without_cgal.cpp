// In place of the rest of this room, where CGAL is left out.
#include "error.h"
#include "growth/grow_bark.h"

namespace treerec {

GrownTree grow_bark(const Tree&, const GrowthRecipe&, const GrowBarkOptions&, Progress*) {
    throw Error("This build was made without CGAL and can't grow bark; get one that has it.");
}

}  // namespace treerec
