// Grown bark among the tubes.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "mesh/tube_builder.h"

namespace treerec::tubes {

namespace {

constexpr double kDepths = 0.25;  // of the light: what reaches the bottom of a hollow

}  // namespace

void Builder::take_grown() {
    covered.assign(list.branches.size(), 0.0);
    if (!options.grown) return;
    for (const GrownBark::Branch& grown : options.grown->branches) {
        if (!tree.contains(grown.first)) continue;
        const size_t branch = static_cast<size_t>(list.branch_of[grown.first]);
        covered[branch] = std::max(covered[branch], grown.until);
    }
}

// What lies below `until` is drawn by others.
bool Builder::cut_covered(size_t index, std::vector<AxisPoint>& points) const {
    if (covered[index] <= 0.0) return true;
    if (covered[index] >= points.back().along) return false;
    size_t hint = 0;
    const AxisPoint start = axis_at(points, covered[index], hint);
    points.erase(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(hint));
    points.front() = start;
    return points.size() >= 2;
}

// The bark's picture goes around each branch as it does around tubes, so a vertex may be needed twice: at
// the seam, and where two branches' pictures meet.
void Builder::add_grown(Mesh& mesh) const {
    const GrownBark& grown = *options.grown;
    std::vector<size_t> index_of;
    for (const GrownBark::Branch& branch : grown.branches)
        index_of.push_back(tree.contains(branch.first) ? static_cast<size_t>(list.branch_of[branch.first])
                                                       : 0);
    std::vector<std::vector<AxisPoint>> axes(list.branches.size());
    const auto axis_of = [&](size_t branch) -> const std::vector<AxisPoint>& {
        if (axes[branch].empty()) sample_axis(tree, list, list.branches[branch], 2.0 * least, axes[branch]);
        return axes[branch];
    };
    std::vector<bool> meets(grown.vertices.size(), false);
    for (size_t i = 0; i < grown.indices.size(); i += 3) {
        const uint32_t* const corner = &grown.indices[i];
        const int32_t a = grown.vertices[corner[0]].branch, b = grown.vertices[corner[1]].branch,
                      c = grown.vertices[corner[2]].branch;
        if (a == b && b == c) continue;
        for (int k = 0; k < 3; k++)
            meets[corner[k]] = true;
    }
    std::vector<uint32_t> known[4];  // by round and whether it is bare wood, by vertex
    for (std::vector<uint32_t>& one : known)
        one.assign(grown.vertices.size(), UINT32_MAX);
    const auto vertex_at = [&](uint32_t at, int round, bool wood) {
        uint32_t& entry = known[round + (wood ? 2 : 0)][at];
        if (entry != UINT32_MAX) return entry;
        entry = static_cast<uint32_t>(mesh.positions.size());
        const GrownBark::Vertex& vertex = grown.vertices[at];
        const size_t own = index_of[static_cast<size_t>(vertex.branch)];
        const std::vector<AxisPoint>& axis = axis_of(own);
        size_t hint = 0;
        const double along = std::max(static_cast<double>(vertex.along), 0.0);
        AxisPoint centre;
        if (axis.size() >= 2)
            centre = axis_at(axis, along, hint);
        else
            centre.position = DVec3(vertex.position);
        const double length = axis.size() >= 2 ? axis.back().along : 1.0;
        // It is as wide at all levels, where tubes stand for others.
        const double repeats = repeats_of(
            own, (wood ? kHeartwood : static_cast<double>(vertex.radius)) * std::max(widened[own], 1.0f));
        mesh.positions.push_back(vertex.position);
        mesh.normals.push_back(vertex.normal);
        mesh.uvs.push_back(
            {static_cast<float>((static_cast<double>(vertex.around) + round) * repeats), vertex.along});
        double light =
            light_at(tubes[own], axis.empty() ? 1.0 : axis.front().radius, centre.position, along, 1.0);
        if (wood && vertex.radius > 0.0f) {
            const double out = glm::distance(DVec3(vertex.position), centre.position) / vertex.radius;
            light *= glm::mix(kDepths, 1.0, std::clamp(out, 0.0, 1.0));
        }
        mesh.colors.push_back({static_cast<float>(crown.sway(centre.position)),
                               static_cast<float>(std::clamp(along / length, 0.0, 1.0)), phase_of(own),
                               static_cast<float>(light)});
        const DVec3 normal(vertex.normal);
        const DVec3 tangent = normalized_or(glm::cross(centre.direction, normal), any_perpendicular(normal));
        mesh.tangents.push_back(Vec4(Vec3(tangent), -1.0f));
        if (options.pivots) {
            const DVec3 pivot = axis.empty() ? centre.position : axis.front().position;
            mesh.custom0.push_back(Vec4(Vec3(pivot), static_cast<float>(list.branches[own].order)));
            mesh.radii.push_back(wood        ? static_cast<float>(kHeartwood)
                                 : meets[at] ? -vertex.radius
                                             : vertex.radius);
            mesh.wind.push_back(wind.codes(own, centre.way, DVec3(vertex.position) - centre.position));
        }
        return entry;
    };
    for (size_t i = 0; i < grown.indices.size(); i += 3) {
        const uint32_t* const corner = &grown.indices[i];
        float low = 2.0f, high = -2.0f;
        bool wood = false;  // Mizoguchi and Miyata 2014, 9: with one decayed corner
        for (int k = 0; k < 3; k++) {
            low = std::min(low, grown.vertices[corner[k]].around);
            high = std::max(high, grown.vertices[corner[k]].around);
            wood |= grown.vertices[corner[k]].decayed;
        }
        for (int k = 0; k < 3; k++) {
            const bool over = high - low > 0.5f && grown.vertices[corner[k]].around < 0.5f;
            mesh.indices.push_back(vertex_at(corner[k], over ? 1 : 0, wood));
        }
    }
}

}  // namespace treerec::tubes
