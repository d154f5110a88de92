#include "mesh/capsules.h"

#include "error.h"
#include "mesh/branch_pieces.h"

namespace treerec {

std::vector<Capsule> fit_capsules(const Tree& tree, const CapsuleOptions& options) {
    if (options.maximum < 1 || options.maximum > 10000) {
        throw Error("A tree takes between 1 and 10000 capsules.");
    }
    if (!(options.minimum_radius >= 0.0) || !(options.tolerance > 0.0)) {
        throw Error("Capsules need a minimum radius of 0 or more and a tolerance above 0.");
    }
    std::vector<Capsule> capsules;
    for (const BranchPiece& piece :
         part_branches(tree, options.maximum, options.minimum_radius, options.tolerance, false)) {
        capsules.push_back({piece.from, piece.to, piece.mean_radius, piece.node});
    }
    return capsules;
}

}  // namespace treerec
