#include "exchange/finite.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "error.h"
#include "geometry/parallel.h"

namespace treerec {

namespace {

constexpr double kLargest = 1e6;    // metres
constexpr double kSmallest = 1e-9;  // metres, of a tree: an L-string writes no smaller steps
constexpr size_t kGrain = 65536;
// Of the tree's reach: by how much its coordinates may be rounded.
constexpr double kLargestRounding = 0.01;

// Of an array of vectors of floats.
template <typename Array>
bool all_finite(const Array& values) {
    constexpr int kLength = Array::value_type::length();
    std::atomic<bool> finite{true};
    parallel_for(values.size(), kGrain, [&](size_t begin, size_t end) {
        // A sum is no number where a part of it is none; parts that are cannot overflow as doubles.
        double sum = 0.0;
        for (size_t i = begin; i < end; i++)
            for (int k = 0; k < kLength; k++)
                sum += static_cast<double>(values[i][k]) * 0.0;
        if (sum != 0.0) finite = false;
    });
    return finite;
}

}  // namespace

void require_sound_measures(const Tree& tree, const std::string& path) {
    const ScanFrame& frame = tree.frame();
    for (NodeId id = 0; id < tree.id_end(); id++) {
        if (!tree.contains(id)) continue;
        const Node& node = tree.node(id);
        const DVec3 &p = node.position, scan = frame.to_scan(p);
        if (std::abs(p.x) <= kLargest && std::abs(p.y) <= kLargest && std::abs(p.z) <= kLargest &&
            node.radius <= kLargest && is_finite(scan) && std::isfinite(frame.length_to_scan(node.radius)))
            continue;
        throw Error("'" + path +
                    "' was not written: the tree reaches beyond 1000 km; check the scan's units.");
    }
}

void require_readable(const Tree& tree, const std::string& path, bool places) {
    require_sound_measures(tree, path);
    const auto refuse = [&](const std::string& reason) {
        throw Error("'" + path + "' was not written: " + reason);
    };
    const auto largest_of = [](const DVec3& v) {
        return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    };
    const ScanFrame& frame = tree.frame();
    if (!(frame.metres_per_unit > kSmallestUnit && frame.metres_per_unit < kLargestUnit))
        refuse("the scan's unit is none that a tree can have; check its scale.");
    if (tree.size() < 2) refuse("the tree is a single node; a skeleton has two or more.");
    const DVec3 root = tree.node(tree.root()).position, origin = frame.to_scan(root);
    double place = largest_of(origin), offset = 0.0, reach = 0.0;
    for (NodeId id = 0; id < tree.id_end(); id++) {
        if (!tree.contains(id)) continue;
        const Node& node = tree.node(id);
        const DVec3 scan = frame.to_scan(node.position);
        place = std::max(place, largest_of(scan));
        offset = std::max({offset, largest_of(scan - origin), frame.length_to_scan(node.radius)});
        reach = std::max(reach, largest_of(node.position - root));
    }
    if (reach == 0.0) refuse("the tree has no wood: all its nodes lie at one place.");
    if (reach < kSmallest) refuse("the tree is smaller than a nanometre; check the scan's unit.");
    if (place > kLargestCoordinate)
        refuse("the tree lies beyond 1e12 units of the scan, where no scan is; check its origin and unit.");
    if (!places) return;
    if (offset > kLargestOffset)
        refuse("the tree reaches beyond 1e9 units of the scan, as no tree does; check the scan's unit.");
    if (place * std::numeric_limits<double>::epsilon() * frame.metres_per_unit > kLargestRounding * reach)
        refuse(
            "the tree is so far from the scan's zero that its nodes cannot be told apart there; check "
            "its origin and unit.");
}

void require_finite(const Mesh& mesh, const std::string& path) {
    if (all_finite(mesh.positions) && all_finite(mesh.normals) && all_finite(mesh.tangents) &&
        all_finite(mesh.uvs))
        return;
    throw Error(
        "'" + path +
        "' was not written: the tree's measures lead to numbers that no model can hold; check its radii "
        "and the scan's units.");
}

}  // namespace treerec
