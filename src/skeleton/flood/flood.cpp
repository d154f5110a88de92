#include "skeleton/flood/flood.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "geometry/groups.h"
#include "skeleton/flood/flood_fit.h"

namespace treerec {

namespace {

constexpr size_t kGrain = 8192;     // voxels between two looks at the cancel flag
constexpr double kAsLong = 1.0;     // radii that a neighbourhood must be long: else no line fits it
constexpr int kMostShells = 60;     // of one neighbourhood
constexpr size_t kFrontShells = 3;  // what hangs together in the last ones is one direction
constexpr double kOneCylinder =
    1.3;                             // radii from the common line: what lies farther apart is no one cylinder
constexpr double kAlike = 0.35;      // relative difference of the distances from it
constexpr size_t kMostMerged = 12;   // of the largest fronts that are compared
constexpr double kLobe = 1.5;        // radii from every line, and two voxels: a lobe that is a branch
constexpr size_t kLobeShells = 3;    // that it must be long
constexpr double kRingVoxels = 0.7;  // of radius: a smaller ring is too coarse to be seen
constexpr double kWidestRing = 2.5;  // times the mean distance
constexpr double kThickVoxels = 2.5;  // of radius: thick enough to tell a surface from a solid
constexpr size_t kThickPoints = 40;   // of one neighbourhood,
constexpr size_t kToldPoints = 300;   // of all that are thick enough: fewer tell nothing
constexpr double kInner = 0.45;  // of the mean distance: a solid has 9 % of its points within, a surface none
constexpr double kHollowShare = 0.02;
constexpr double kSolidShare = 0.045;
constexpr double kSolidReach = 1.75;  // mean distances: 1.5, and what the piece is slanted
constexpr double kSolidRadius = 1.5;  // mean distances

// A node whose neighbourhood is growing.
struct Growing {
    int32_t node = 0;
    std::vector<uint32_t> before;  // voxels of the parent's, that the flood starts from
    std::vector<uint32_t> voxels;
    std::vector<int32_t> from;    // by voxel: the one that it was reached from, as an index into `voxels`
    std::vector<uint32_t> shell;  // where each begins
    bool done = false;
    DVec3 sum{0.0};  // of the points less the node's position
    double count = 0.0;
};

// A part of a neighbourhood.
struct Part {
    std::vector<uint32_t> voxels;
    std::vector<uint32_t> front;  // the voxels that the flood goes on from
    LineFit fit;
};

class Flood {
  public:
    Flood(const FloodGrid& grid, const std::vector<Vec3>& points, const FloodOptions& options,
          Progress& progress)
        : grid_(grid), points_(points), options_(options), progress_(progress), local_(grid.size()) {
        result_.owner.assign(grid.size(), -1);
    }

    FloodResult run(const DVec3& root, const std::vector<uint32_t>& seeds) {
        FloodNode first;
        first.position = root;
        result_.nodes.push_back(first);
        Growing start;
        for (const uint32_t v : seeds)
            claim(start, v, -1);
        std::vector<Growing> generation;
        generation.push_back(std::move(start));
        while (!generation.empty()) {
            while (!generation.empty())
                generation = next_generation(generation);
            generation = over_the_gaps();
        }
        tell_kind();
        return std::move(result_);
    }

  private:
    const DVec3& place_of(const Growing& growing) const { return result_.nodes[growing.node].position; }

    bool claim(Growing& growing, uint32_t v, int32_t from) {
        if (result_.owner[v] >= 0) return false;
        result_.owner[v] = growing.node;
        local_[v] = static_cast<uint32_t>(growing.voxels.size());
        growing.voxels.push_back(v);
        growing.from.push_back(from);
        const double held = static_cast<double>(grid_.cells.in_cell(v).size());
        growing.sum += held * (DVec3(grid_.means[v]) - place_of(growing));
        growing.count += held;
        if (++claimed_ % kGrain == 0) {
            progress_.check();
            progress_.update(static_cast<double>(claimed_) / static_cast<double>(grid_.size()), "Flooding");
        }
        return true;
    }

    // Whether u is one of its voxels: what led to the node has its number too.
    bool holds(const Growing& growing, uint32_t u) const {
        return result_.owner[u] == growing.node && local_[u] < growing.voxels.size() &&
               growing.voxels[local_[u]] == u;
    }

    // One shell (algorithm 4, lines 3 to 9).
    void grow(Growing& growing) {
        const size_t before = growing.voxels.size();
        const auto spread = [&](uint32_t v, int32_t from) {
            for (uint32_t e = grid_.graph.begin[v]; e < grid_.graph.begin[v + 1]; e++)
                if (grid_.bridge[e] == 0) claim(growing, grid_.graph.neighbour[e], from);
        };
        if (before == 0) {
            for (const uint32_t v : growing.before)
                spread(v, -1);
        } else if (!growing.shell.empty()) {
            for (size_t i = growing.shell.back(); i < before; i++)
                spread(growing.voxels[i], static_cast<int32_t>(i));
        }
        // The first shell of a root or beyond a gap is what was claimed for it.
        const bool given = growing.shell.empty() && before > 0;
        const size_t added = given ? before : growing.voxels.size() - before;
        if (added == 0) {
            growing.done = true;
            return;
        }
        growing.shell.push_back(static_cast<uint32_t>(given ? 0 : before));
        const double old = given ? 0.0 : static_cast<double>(before);
        if (static_cast<double>(added) >= options_.threshold * old && growing.shell.size() < kMostShells)
            return;
        growing.done = growing.shell.size() >= kMostShells || is_long(growing);
    }

    // Against the wood that led here: what spreads into a crown gets no longer than wide.
    bool is_long(const Growing& growing) const {
        return 2.0 * glm::length(growing.sum / growing.count) >= kAsLong * result_.nodes[growing.node].radius;
    }

    // All nodes of a generation grow side by side, so that none floods into another's wood (5.2).
    std::vector<Growing> next_generation(std::vector<Growing>& generation) {
        for (bool growing = true; growing;) {
            growing = false;
            for (Growing& node : generation) {
                if (node.done) continue;
                grow(node);
                growing = true;
            }
        }
        std::vector<Growing> next;
        for (Growing& node : generation)
            split(node, next);
        return next;
    }

    // The parts of the neighbourhood that lead to what hangs together in the last shells; last, the lobes
    // that end before. lead: how many of the former.
    std::vector<Part> parts_of(const Growing& growing, size_t& lead) {
        const uint32_t n = static_cast<uint32_t>(growing.voxels.size());
        const size_t shells = growing.shell.size();
        const uint32_t front = growing.shell[shells > kFrontShells ? shells - kFrontShells : 0];
        Groups groups(n);
        const auto join_within = [&](auto joins) {
            for (uint32_t i = 0; i < n; i++) {
                if (!joins(i)) continue;
                const uint32_t v = growing.voxels[i];
                for (uint32_t e = grid_.graph.begin[v]; e < grid_.graph.begin[v + 1]; e++) {
                    const uint32_t u = grid_.graph.neighbour[e];
                    if (grid_.bridge[e] == 0 && holds(growing, u) && joins(local_[u]))
                        groups.join(i, local_[u]);
                }
            }
        };
        join_within([&](uint32_t i) { return i >= front; });
        // What led to a front is its part; where several fronts follow, the part of the most voxels.
        std::vector<int32_t> label(n, -1);
        std::vector<uint32_t> behind(n, 0);
        std::vector<uint32_t> most(n, 0);
        for (uint32_t i = n; i-- > 0;) {
            if (i >= front) label[i] = static_cast<int32_t>(groups.find(i));
            if (label[i] < 0) continue;
            behind[i]++;
            const int32_t from = growing.from[i];
            if (from < 0 || from >= static_cast<int32_t>(front)) continue;
            behind[from] += behind[i];
            if (behind[i] >= most[from]) {
                most[from] = behind[i];
                label[from] = label[i];
            }
        }
        join_within([&](uint32_t i) { return label[i] < 0; });
        std::vector<int32_t> part_at(n, -1);
        std::vector<Part> parts;
        const auto put = [&](uint32_t i, uint32_t name) {
            if (part_at[name] < 0) {
                part_at[name] = static_cast<int32_t>(parts.size());
                parts.emplace_back();
            }
            Part& part = parts[part_at[name]];
            part.voxels.push_back(growing.voxels[i]);
            if (i >= front) part.front.push_back(growing.voxels[i]);
        };
        for (uint32_t i = front; i < n; i++)
            put(i, static_cast<uint32_t>(label[i]));
        for (uint32_t i = 0; i < front; i++)
            if (label[i] >= 0) put(i, static_cast<uint32_t>(label[i]));
        lead = parts.size();
        for (uint32_t i = 0; i < front; i++)
            if (label[i] < 0) put(i, groups.find(i));
        return parts;
    }

    LineFit fit(const Growing& growing, const std::vector<uint32_t>& voxels) const {
        return fit_line(grid_, points_, place_of(growing), voxels);
    }

    // Whether two fronts lie on one cylinder around a common line: what a gap in the bark parted.
    bool on_one_cylinder(const Growing& growing, const Part& a, const Part& b, double radius) const {
        if (radius < grid_.cells.layout.cell) return false;
        std::vector<uint32_t> both = a.voxels;
        both.insert(both.end(), b.voxels.begin(), b.voxels.end());
        const LineFit common = fit(growing, both);
        const Ring ring_a = ring_around(grid_, points_, place_of(growing), common.direction, a.front);
        const Ring ring_b = ring_around(grid_, points_, place_of(growing), common.direction, b.front);
        const double most = std::max(ring_a.mean, ring_b.mean);
        return most <= kOneCylinder * radius && std::abs(ring_a.mean - ring_b.mean) <= kAlike * most &&
               std::max(ring_a.deviation, ring_b.deviation) <= kAlike * most;
    }

    void merge_fronts(const Growing& growing, std::vector<Part>& parts, size_t& lead) const {
        if (lead < 2) return;
        std::stable_sort(parts.begin(), parts.begin() + static_cast<ptrdiff_t>(lead),
                         [](const Part& a, const Part& b) { return a.voxels.size() > b.voxels.size(); });
        double radius = result_.nodes[growing.node].radius;
        if (growing.node == 0) radius = fit(growing, growing.voxels).radius;
        for (size_t a = 0; a < std::min(lead, kMostMerged); a++)
            for (size_t b = a + 1; b < std::min(lead, kMostMerged);) {
                if (!on_one_cylinder(growing, parts[a], parts[b], radius)) {
                    b++;
                    continue;
                }
                Part& into = parts[a];
                into.voxels.insert(into.voxels.end(), parts[b].voxels.begin(), parts[b].voxels.end());
                into.front.insert(into.front.end(), parts[b].front.begin(), parts[b].front.end());
                parts.erase(parts.begin() + static_cast<ptrdiff_t>(b));
                lead--;
            }
    }

    // A lobe of bark goes to the part whose surface is nearest; one that stands out far enough is a twig.
    void place_lobes(const Growing& growing, std::vector<Part>& parts, size_t lead) const {
        const DVec3& node = place_of(growing);
        const double voxel = grid_.cells.layout.cell;
        std::vector<Part> kept(std::make_move_iterator(parts.begin()),
                               std::make_move_iterator(parts.begin() + static_cast<ptrdiff_t>(lead)));
        for (size_t l = lead; l < parts.size(); l++) {
            size_t nearest = 0;
            double least = std::numeric_limits<double>::max();
            bool stands_out = parts[l].voxels.size() >= kLobeShells;
            double reach = std::numeric_limits<double>::max();
            for (size_t p = 0; p < lead; p++) {
                const Ring ring = ring_around(grid_, points_, node, kept[p].fit.direction, parts[l].voxels);
                const double radius = kept[p].fit.radius;
                if (std::abs(ring.mean - radius) < least) {
                    least = std::abs(ring.mean - radius);
                    nearest = p;
                }
                reach = std::min(reach, ring.farthest - kLobe * radius);
            }
            stands_out = stands_out && reach >= static_cast<double>(kLobeShells) * voxel;
            if (stands_out || lead == 0) {
                kept.push_back(std::move(parts[l]));
                kept.back().fit = fit(growing, kept.back().voxels);
            } else {
                std::vector<uint32_t>& into = kept[nearest].voxels;
                into.insert(into.end(), parts[l].voxels.begin(), parts[l].voxels.end());
            }
        }
        parts = std::move(kept);
    }

    // Chooses the directions of a grown neighbourhood and makes the children (algorithms 5 to 7).
    void split(Growing& growing, std::vector<Growing>& next) {
        if (growing.voxels.empty()) return;
        progress_.check();
        size_t lead = 0;
        std::vector<Part> parts = parts_of(growing, lead);
        merge_fronts(growing, parts, lead);
        for (size_t p = 0; p < lead; p++)
            parts[p].fit = fit(growing, parts[p].voxels);
        if (lead < parts.size()) place_lobes(growing, parts, lead);
        const FloodNode& at = result_.nodes[growing.node];
        FloodStep step{growing.node, at.parent, at.generation, at.position, {}, {}};
        const size_t largest = static_cast<size_t>(
            std::max_element(parts.begin(), parts.end(),
                             [](const Part& a, const Part& b) { return a.fit.points < b.fit.points; }) -
            parts.begin());
        for (size_t p = 0; p < parts.size(); p++) {
            Part& part = parts[p];
            size_t held = 0;
            for (const uint32_t v : part.voxels)
                held += grid_.cells.in_cell(v).size();
            FloodDirection found{part.fit.direction, part.fit.length, part.fit.radius,
                                 static_cast<double>(held) / growing.count, -1};
            if ((p == largest || found.share >= options_.least_share) && part.fit.length > 0.0) {
                found.child = static_cast<int32_t>(result_.nodes.size());
                add_child(growing, part, parts.size() == 1, next);
            }
            step.directions.push_back(found);
        }
        if (!options_.keep_steps) return;
        for (const uint32_t v : growing.voxels)
            step.voxels.emplace_back(grid_.centre(v));
        result_.steps.push_back(std::move(step));
    }

    void add_child(const Growing& growing, Part& part, bool alone, std::vector<Growing>& next) {
        FloodNode child;
        child.parent = growing.node;
        child.generation = result_.nodes[growing.node].generation + 1;
        child.radius = part.fit.radius;
        child.scatter = part.fit.deviation;
        place_end(growing, part, alone, child);
        child.points = static_cast<uint32_t>(part.fit.points);
        const int32_t id = static_cast<int32_t>(result_.nodes.size());
        for (const uint32_t v : part.voxels)
            result_.owner[v] = id;
        result_.nodes.push_back(child);
        if (part.front.empty()) return;
        Growing more;
        more.node = id;
        more.before = std::move(part.front);
        next.push_back(std::move(more));
    }

    DVec3 middle_of(std::span<const uint32_t> voxels) const {
        DVec3 middle(0.0);
        double held = 0.0;
        for (const uint32_t v : voxels) {
            const double count = static_cast<double>(grid_.cells.in_cell(v).size());
            middle += count * DVec3(grid_.means[v]);
            held += count;
        }
        return middle / held;
    }

    // At the end of the way. A line through a node beside the axis of stout wood swings over to the other
    // side of it. There the axis runs from the middle of the first voxels to that of the last ones, whatever
    // the node, and the circle across it tells the rest.
    void place_end(const Growing& growing, const Part& part, bool alone, FloodNode& child) {
        const DVec3& node = place_of(growing);
        child.position = node + part.fit.length * part.fit.direction;
        if (child.radius <= kRingVoxels * grid_.cells.layout.cell || part.front.empty() ||
            part.front.size() == part.voxels.size())
            return;
        const DVec3 last = middle_of(part.front);
        const DVec3 first = middle_of(std::span(part.voxels).subspan(part.front.size()));
        const DVec3 along = normalized_or(last - first, part.fit.direction);
        DVec3 end = last + glm::dot(child.position - last, along) * along;
        child.measured = surround(grid_, points_, along, part.front, kWidestRing * child.radius,
                                  options_.seed, end, child.radius);
        child.position = child.measured ? end : 0.5 * (child.position + end);
        if (alone) look_inside(part.front, last, along);
    }

    // A piece of wood that is thick enough votes for what the points are, by how many lie deep in it.
    void look_inside(const std::vector<uint32_t>& voxels, const DVec3& middle, const DVec3& along) {
        size_t held = 0;
        for (const uint32_t v : voxels)
            held += grid_.cells.in_cell(v).size();
        Ring ring = ring_around(grid_, points_, middle, along, voxels);
        if (held < kThickPoints || ring.mean < kThickVoxels * grid_.cells.layout.cell) return;
        ring = ring_around(grid_, points_, middle, along, voxels, kInner * ring.mean);
        const double inside = static_cast<double>(ring.within) / static_cast<double>(held);
        if (inside < kHollowShare) surface_points_ += held;
        // Twigs that run side by side reach farther out than a solid of the same mean.
        if (inside >= kSolidShare && ring.farthest <= kSolidReach * ring.mean) solid_points_ += held;
    }

    // Where the flood came to an end, the parts beyond the gaps begin.
    std::vector<Growing> over_the_gaps() {
        progress_.check();
        std::vector<Growing> generation;
        for (uint32_t v = 0; v < grid_.size(); v++) {
            if (result_.owner[v] < 0) continue;
            for (uint32_t e = grid_.graph.begin[v]; e < grid_.graph.begin[v + 1]; e++) {
                const uint32_t u = grid_.graph.neighbour[e];
                if (grid_.bridge[e] == 0 || result_.owner[u] >= 0 ||
                    grid_.graph.length[e] > options_.longest_gap)
                    continue;
                FloodNode landing;
                landing.parent = result_.owner[v];
                landing.generation = result_.nodes[landing.parent].generation + 1;
                landing.position = DVec3(grid_.means[u]);
                landing.bridged = true;
                Growing start;
                start.node = static_cast<int32_t>(result_.nodes.size());
                result_.nodes.push_back(landing);
                claim(start, u, -1);
                generation.push_back(std::move(start));
            }
        }
        return generation;
    }

    // A solid's points are two thirds of the radius from the axis, on average.
    void tell_kind() {
        result_.kind_told = surface_points_ + solid_points_ >= kToldPoints;
        if (!result_.kind_told || solid_points_ <= surface_points_) return;
        result_.kind = CloudKind::kSolid;
        for (FloodNode& node : result_.nodes)
            node.radius *= kSolidRadius;
        for (FloodStep& step : result_.steps)
            for (FloodDirection& direction : step.directions)
                direction.radius *= kSolidRadius;
    }

    const FloodGrid& grid_;
    const std::vector<Vec3>& points_;
    const FloodOptions& options_;
    Progress& progress_;
    std::vector<uint32_t> local_;  // by voxel: its index in its neighbourhood
    size_t claimed_ = 0;
    size_t surface_points_ = 0;
    size_t solid_points_ = 0;
    FloodResult result_;
};

}  // namespace

FloodResult flood(const FloodGrid& grid, const std::vector<Vec3>& points, const DVec3& root,
                  const std::vector<uint32_t>& seeds, const FloodOptions& options, Progress& progress) {
    return Flood(grid, points, options, progress).run(root, seeds);
}

}  // namespace treerec
