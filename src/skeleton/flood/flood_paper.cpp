#include "skeleton/flood/flood_paper.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "error.h"
#include "geometry/bounds.h"
#include "geometry/cell_grid.h"
#include "geometry/random.h"

namespace treerec {

namespace {

constexpr int kFewest = 2;      // voxels along an axis
constexpr int kMost = 1 << 20;  // as the keys hold
constexpr size_t kDirections = 26;
constexpr double kInside = 0.5;    // voxels: so far within the last one is the far end of an axis
constexpr size_t kGrain = 4096;    // voxels between two looks at the cancel flag
constexpr double kMostFill = 4.0;  // random points for one of the cloud

std::array<DVec3, kDirections> all_directions() {
    std::array<DVec3, kDirections> directions{};
    size_t at = 0;
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++)
            for (int z = -1; z <= 1; z++)
                if (x != 0 || y != 0 || z != 0) directions[at++] = glm::normalize(DVec3(x, y, z));
    return directions;
}

// From metres to voxels, each axis by itself.
struct Stretch {
    DVec3 low{0.0};
    DVec3 factor{1.0};
    double end = 0.0;

    Stretch(const std::vector<Vec3>& points, int dimension) : end(dimension - kInside) {
        Bounds bounds;
        for (const Vec3& p : points)
            bounds.add(DVec3(p));
        low = bounds.min;
        const DVec3 size = bounds.size();
        for (int a = 0; a < 3; a++)
            factor[a] = size[a] > 0.0 ? dimension / size[a] : 1.0;
    }

    DVec3 operator()(const DVec3& p) const { return glm::min((p - low) * factor, DVec3(end)); }
    DVec3 back(const DVec3& p) const { return p / factor + low; }
};

std::vector<Vec3> stretched(const std::vector<Vec3>& points, const Stretch& stretch) {
    std::vector<Vec3> out;
    out.reserve(points.size());
    for (const Vec3& p : points)
        out.emplace_back(stretch(DVec3(p)));
    return out;
}

// The neighbourhood of a node while it grows.
struct Neighbourhood {
    int32_t node = 0;
    uint64_t start = 0;  // key of the node's own voxel
    std::vector<uint32_t> voxels;
    size_t shell = 0;  // where the last one begins
    bool begun = false;
    bool done = false;
};

class PaperFlooder {
  public:
    PaperFlooder(const std::vector<Vec3>& points, const PaperFloodOptions& options, Progress& progress)
        : points_(points),
          options_(options),
          progress_(progress),
          stretch_(points, options.dimension),
          cells_(stretched(points, stretch_), CellLayout{DVec3(0.0), 1.0}, &progress),
          directions_(all_directions()) {
        found_.flooded.owner.assign(cells_.size(), -1);
    }

    PaperFlood run(const DVec3& root) {
        FloodNode first;
        first.position = root;
        found_.flooded.nodes.push_back(first);
        std::vector<Neighbourhood> generation{begin_at(0)};
        while (!generation.empty()) {
            flood(generation);
            std::vector<Neighbourhood> next;
            for (const Neighbourhood& around : generation)
                branch(around, next);
            generation = std::move(next);
        }
        found_.reached = static_cast<double>(reached_) / static_cast<double>(points_.size());
        return std::move(found_);
    }

  private:
    const DVec3& place(const Neighbourhood& around) const {
        return found_.flooded.nodes[around.node].position;
    }

    Neighbourhood begin_at(int32_t node) const {
        Neighbourhood around;
        around.node = node;
        around.start = cells_.layout.key(Vec3(stretch_(found_.flooded.nodes[node].position)));
        return around;
    }

    // The valid voxels of the 27 around a key.
    void spread(uint64_t key, Neighbourhood& around) {
        for (int y = -1; y <= 1; y++)
            for (int x = -1; x <= 1; x++) {
                const uint64_t middle = key + (static_cast<uint64_t>(static_cast<int64_t>(y)) << 42) +
                                        (static_cast<uint64_t>(static_cast<int64_t>(x)) << 21);
                const auto [first, last] = cells_.cells_between(middle - 1, middle + 1);
                for (size_t v = first; v < last; v++) {
                    if (found_.flooded.owner[v] >= 0) continue;
                    found_.flooded.owner[v] = around.node;
                    around.voxels.push_back(static_cast<uint32_t>(v));
                    if (++claimed_ % kGrain == 0) tell();
                }
            }
    }

    void tell() {
        progress_.check();
        progress_.update(static_cast<double>(claimed_) / static_cast<double>(cells_.size()), "Flooding");
    }

    // One call of algorithm 4's recursion for all nodes of a generation, again and again.
    void flood(std::vector<Neighbourhood>& generation) {
        for (bool growing = true; growing;) {
            growing = false;
            for (Neighbourhood& around : generation) {
                if (around.done) continue;
                growing = true;
                const size_t held = around.voxels.size();
                if (!around.begun) {
                    around.begun = true;
                    spread(around.start, around);
                } else {
                    for (size_t i = around.shell; i < held; i++)
                        spread(cells_.keys[around.voxels[i]], around);
                }
                around.shell = held;
                // The node's own voxel is what there was at first.
                const double before = static_cast<double>(std::max<size_t>(held, 1));
                const double added = static_cast<double>(around.voxels.size() - held);
                around.done = added <= options_.threshold * before;
            }
        }
    }

    size_t direction_of(const DVec3& offset) const {
        size_t best = 0;
        for (size_t d = 1; d < kDirections; d++)
            if (glm::dot(offset, directions_[d]) > glm::dot(offset, directions_[best])) best = d;
        return best;
    }

    DVec3 middle_of(uint32_t voxel) const {
        const uint64_t key = cells_.keys[voxel];
        constexpr uint64_t kMask = (uint64_t{1} << CellLayout::kBits) - 1;
        return DVec3(static_cast<double>(key >> 21 & kMask), static_cast<double>(key >> 42 & kMask),
                     static_cast<double>(key & kMask)) -
               0.5;
    }

    void branch(const Neighbourhood& around, std::vector<Neighbourhood>& next) {
        if (around.voxels.empty()) return;
        progress_.check();
        const FloodNode at = found_.flooded.nodes[around.node];
        std::array<std::vector<uint32_t>, kDirections> points;
        size_t held = 0;
        const DVec3 from = stretch_(at.position);
        for (const uint32_t v : around.voxels) {
            const auto in = cells_.in_cell(v);
            std::vector<uint32_t>& into = points[direction_of(middle_of(v) - from)];
            into.insert(into.end(), in.begin(), in.end());
            held += in.size();
        }
        reached_ += held;
        FloodStep step{around.node, at.parent, at.generation, at.position, {}, {}};
        for (const std::vector<uint32_t>& own : points) {
            if (own.empty()) continue;
            FloodDirection found = fit(own, at.position);
            found.share = static_cast<double>(own.size()) / static_cast<double>(held);
            if (found.share >= options_.least_density && found.length > 0.0) {
                FloodNode child;
                child.parent = around.node;
                child.generation = at.generation + 1;
                child.position = at.position + found.length * found.direction;
                child.radius = found.radius;
                child.points = static_cast<uint32_t>(own.size());
                found.child = static_cast<int32_t>(found_.flooded.nodes.size());
                found_.flooded.nodes.push_back(child);
                next.push_back(begin_at(found.child));
            }
            step.directions.push_back(found);
        }
        if (!options_.keep_steps) return;
        for (const uint32_t v : around.voxels)
            step.voxels.emplace_back(stretch_.back(middle_of(v)));
        found_.flooded.steps.push_back(std::move(step));
    }

    // Of the equations t_i d = p_i - x0 the least-squares solution is along sum t_i (p_i - x0) (5.3).
    FloodDirection fit(const std::vector<uint32_t>& own, const DVec3& node) const {
        FloodDirection found;
        DVec3 sum(0.0);
        for (const uint32_t i : own) {
            const DVec3 offset = DVec3(points_[i]) - node;
            sum += glm::length(offset) * offset;
        }
        found.direction = normalized_or(sum, found.direction);
        double along = 0.0;
        double off = 0.0;
        for (const uint32_t i : own) {
            const DVec3 offset = DVec3(points_[i]) - node;
            const double t = glm::dot(offset, found.direction);
            along += t;
            off += glm::length(offset - t * found.direction);
        }
        found.length = 2.0 * along / static_cast<double>(own.size());
        found.radius = 2.0 * off / static_cast<double>(own.size());
        return found;
    }

    const std::vector<Vec3>& points_;
    const PaperFloodOptions& options_;
    Progress& progress_;
    const Stretch stretch_;
    const CellGrid cells_;
    const std::array<DVec3, kDirections> directions_;
    PaperFlood found_;
    size_t claimed_ = 0;  // voxels
    size_t reached_ = 0;  // points
};

struct Frustum {
    DVec3 from;
    DVec3 to;
    double radius_from;
    double radius_to;

    double volume() const {
        return kPi / 3.0 * glm::distance(from, to) *
               (radius_from * radius_from + radius_from * radius_to + radius_to * radius_to);
    }
};

}  // namespace

PaperFlood flood_as_printed(const std::vector<Vec3>& points, const DVec3& root,
                            const PaperFloodOptions& options, Progress& progress) {
    if (options.dimension < kFewest || options.dimension > kMost)
        throw Error("The printed flood needs between " + std::to_string(kFewest) + " and " +
                    std::to_string(kMost) + " voxels along an axis, not " +
                    std::to_string(options.dimension) + ".");
    return PaperFlooder(points, options, progress).run(root);
}

std::vector<Vec3> filled_solid(const std::vector<Vec3>& points, const Tree& tree, double spacing,
                               double voxel, uint64_t seed) {
    std::vector<Frustum> wood;
    double volume = 0.0;
    for (const NodeId id : tree.depth_first()) {
        const Node& node = tree.node(id);
        // What is thinner than a voxel is solid as it is.
        if (node.parent == kNoNode || 2.0 * node.radius < voxel) continue;
        const Node& parent = tree.node(node.parent);
        // A side branch leaves its parent as thick as it is itself.
        wood.push_back(
            {parent.position, node.position, std::min(parent.radius, 2.0 * node.radius), node.radius});
        volume += wood.back().volume();
    }
    std::vector<Vec3> filled = points;
    if (volume <= 0.0) return filled;
    const double density =
        std::min(1.0 / (voxel * spacing * spacing), kMostFill * static_cast<double>(points.size()) / volume);
    double owed = 0.0;
    for (size_t s = 0; s < wood.size(); s++) {
        const Frustum& piece = wood[s];
        Random random(seed, s);
        const DVec3 along = normalized_or(piece.to - piece.from, DVec3(0.0, 1.0, 0.0));
        const DVec3 u = any_perpendicular(along);
        const DVec3 v = glm::cross(along, u);
        const double widest = std::max(piece.radius_from, piece.radius_to);
        for (owed += density * piece.volume(); owed >= 1.0;) {
            const double t = random.uniform();
            const double r = piece.radius_from + t * (piece.radius_to - piece.radius_from);
            // As much more often as there is more wood.
            if (random.uniform() * widest * widest > r * r) continue;
            const double angle = 2.0 * kPi * random.uniform();
            const double off = r * std::sqrt(random.uniform());
            filled.emplace_back(piece.from + t * (piece.to - piece.from) +
                                off * (portable::cos(angle) * u + portable::sin(angle) * v));
            owed -= 1.0;
        }
    }
    return filled;
}

}  // namespace treerec
