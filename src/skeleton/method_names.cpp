// The words by which files, the program and scripts name the ways to a skeleton.
#include <array>

#include "skeleton/skeleton.h"

namespace treerec {

namespace {

constexpr std::array<const char*, 3> kMethods = {"geodesic", "delaunay", "flood"};
constexpr std::array<const char*, 2> kSpanningTrees = {"paths", "minimum"};
constexpr std::array<const char*, 2> kFloods = {"ours", "paper"};

}  // namespace

SkeletonMethod parse_skeleton_method(const std::string& word) {
    for (size_t m = 0; m < kMethods.size(); m++)
        if (word == kMethods[m]) return static_cast<SkeletonMethod>(m);
    throw Error("There is no skeleton method " + quote_word(word) + "; take geodesic, delaunay or flood.");
}

const char* skeleton_method_name(SkeletonMethod method) {
    return kMethods[static_cast<size_t>(method)];
}

SpanningTreeKind parse_spanning_tree_kind(const std::string& word) {
    for (size_t k = 0; k < kSpanningTrees.size(); k++)
        if (word == kSpanningTrees[k]) return static_cast<SpanningTreeKind>(k);
    throw Error("There is no spanning tree " + quote_word(word) + "; take paths or minimum.");
}

const char* spanning_tree_kind_name(SpanningTreeKind kind) {
    return kSpanningTrees[static_cast<size_t>(kind)];
}

FloodKind parse_flood_kind(const std::string& word) {
    for (size_t k = 0; k < kFloods.size(); k++)
        if (word == kFloods[k]) return static_cast<FloodKind>(k);
    throw Error("There is no flood " + quote_word(word) + "; take ours or paper.");
}

const char* flood_kind_name(FloodKind kind) {
    return kFloods[static_cast<size_t>(kind)];
}

}  // namespace treerec
