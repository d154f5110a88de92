// Sets of nodes, by what they are and where they are.
//
//     all   leaves   forks   common   trunk   measured   inferred   guesses
//     12   root   12@x:y:z:..                one node (edit/commands/address.h)
//     below:12                               the node and all that grows from it
//     branch:12                              the nodes of its branch (tree/branches.h)
//     path:12                                from the root to the node
//     order:2   order:1..3   order:2..       of their branch, the trunk 0
//     depth:..9   radius:..0.01   height:2..5   nodes from the root; metres; metres above the root
//     box:x:y:z:x:y:z   sphere:x:y:z:r       two corners; centre and radius
//     side:x:y:z:nx:ny:nz                    beyond the plane through a place, where its normal points
//
// A list of nodes alone is kept as the branches that it names whole, "below:" their lowest nodes: on another
// reconstruction of the scan these have other nodes, and more or fewer of them.
//
// '!' before one takes all others, '&' joins what is in both, ',' what is in either:
// "order:2..&radius:..0.01,12". Places and lengths are metres of tree space, but for those of addresses.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "edit/commands/region.h"
#include "tree/tree.h"

namespace treerec {

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

// All of these give ids in depth-first order, and are linear in the nodes.
std::vector<NodeId> select_by_kind(const Tree& tree, NodeKind kind);
std::vector<NodeId> select_by_order(const Tree& tree, int least, int most);
// Least and most count in.
std::vector<NodeId> select_by_radius(const Tree& tree, double least, double most);
std::vector<NodeId> select_inside(const Tree& tree, const Region& region);
// Throws Error for an unknown node.
std::vector<NodeId> select_branch(const Tree& tree, NodeId id);
std::vector<NodeId> select_path(const Tree& tree, NodeId id);

struct SelectOptions {
    double tolerance = 0.0;  // of addresses (find_node())
    // The frame in which places and lengths were written; null: the tree's own.
    const ScanFrame* written_in = nullptr;
    // Of what ',' joins, that which is not there is left out, as long as anything is.
    bool keep_going = false;
};

struct Selection {
    std::vector<NodeId> ids;  // in depth-first order
    std::string text;         // as a log keeps it: in the tree's frame, nodes by address
    size_t named = 0;         // what ',' joined
    size_t missing = 0;       // and how much of it was left out
};

// Throws CommandError (column within the text) for what is no selection, Misfit for a node that is not there.
Selection select(const Tree& tree, std::string_view text, const SelectOptions& options = {});

}  // namespace treerec
