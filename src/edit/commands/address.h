// How a command names nodes: by id, and by place, so that it finds them again on a tree that was
// reconstructed anew from the same scan.
//
//     123                          the node with this id
//     root                         the root
//     @x:y:z                       the node nearest to this place
//     123@x:y:z:dx:dy:dz:r         as a log writes it: the node 123 if it is still there, else the wood
//     nearest
//                                  to the place that runs in this direction and is about this thick
//
// Places, directions and radii of addresses are in the scan's own coordinates, axes and units.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "error.h"
#include "tree/tree.h"

namespace treerec {

// The command is sound, but there is nothing on this tree that it speaks of.
class Misfit : public Error {
  public:
    explicit Misfit(const std::string& sentence) : Error(sentence) {}
};

// tolerance: metres that the wood may lie away from where it was; 0: a hundredth of the tree's height, or the
// node's diameter if that is more. Linear in the nodes, but for an id that still fits. Throws Misfit where no
// node fits, and Error for what is no address.
NodeId find_node(const Tree& tree, std::string_view address, double tolerance = 0.0);

// Where a node was that a command names by place.
struct NamedPlace {
    DVec3 place{0.0};      // tree space
    DVec3 direction{0.0};  // in which the wood ran, unit; zero: not told
    double radius = 0.0;   // metres; 0: not told
};
// Those of a command of a log, on this tree or any other of the same scan.
std::vector<NamedPlace> places_named(const ScanFrame& frame, std::string_view command);

// The address as a log keeps it; places to a tenth of a millimetre. Precondition: tree.contains(id).
std::string address_of(const Tree& tree, NodeId id);

}  // namespace treerec
