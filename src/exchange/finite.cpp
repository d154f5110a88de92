#include "exchange/finite.h"

#include <atomic>
#include <cmath>

#include "error.h"
#include "geometry/parallel.h"

namespace treerec {

namespace {

constexpr double kLargest = 1e6;  // metres
constexpr size_t kGrain = 65536;

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
