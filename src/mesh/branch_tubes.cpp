#include "mesh/branch_tubes.h"

#include <algorithm>
#include <bit>
#include <memory>
#include <numeric>

#include "error.h"
#include "geometry/parallel.h"
#include "geometry/portable_math.h"
#include "geometry/random.h"
#include "mesh/parallel_transport.h"
#include "mesh/tube_builder.h"

namespace treerec {

namespace tubes {

namespace {

constexpr double kCollar = 0.35;            // how much wider a branch leaves its parent, over its radius
constexpr double kForkShare = 0.7;          // of its parent's radius: as wide a thick branch starts at most
constexpr double kForkTaper = 0.3;          // of its own radius: how much thinner a forking branch starts
constexpr double kRoundTipRadius = 0.006;   // metres; thinner tips are pointed
constexpr double kCutRadius = 0.025;        // metres; no branch ends by itself so thick: those are cut flat
constexpr double kTwigRadius = 0.012;       // metres; thinner tubes have a side less,
constexpr double kFineTwigRadius = 0.006;   // these two,
constexpr double kPointRadius = 0.004;      // and these run out in a point
constexpr double kHeightSlack = 1e-3;       // how far rings may leave out any bend, over the tree's height
constexpr double kTaperSlack = 0.06;        // how far they may leave out a change of the radius, over it,
constexpr double kTwigTaperSlack = 0.45;    // of a twig's likewise,
constexpr double kHeightTaperSlack = 2e-4;  // and over the tree's height
constexpr double kOutlineSlack = 0.03;      // and a change of the outline, over the radius, at level 0
constexpr size_t kMostLeftOut = 12;         // points of the axis between two rings, at level 0
constexpr int kCollarLevel = 1;             // the coarsest that has collars, on stouter branches:
constexpr double kLightCollars = 2.0;       // so many times as thick there
constexpr int kUnevenLevel = 1;             // the coarsest that shows that wood is not round,
constexpr double kUnevenRadius = 0.03;      // metres: and the thinnest that does
constexpr int kRootedSides = 16;            // coarser trunks have no roots
constexpr uint32_t kSidesPerRoot = 5;       // at level 0
constexpr size_t kFewBranches = 256;        // are built sooner than threads start
constexpr double kMostCoarser = 4.0;        // levels, where there would be too many triangles,
constexpr double kCoarserStep = 1.0 / 64;   // to so much of one

// How much rings leave out at level 0 of branches of such a radius in metres: the eye rests on the stout
// ones.
struct BendLimit {
    double least_radius;
    double bend;   // radians between two rings
    double slack;  // how far they may leave out a bend, over the radius
};
constexpr BendLimit kBendLimits[] = {
    {0.08, 0.13, 0.1}, {0.04, 0.2, 0.2}, {0.02, 0.35, 0.3}, {0.01, 0.6, 0.3}, {0.0, 0.44, 0.3}};

// Times kCollarRadius and kWebRadius.
double collar_share(int level) {
    return level == 0 ? 1.0 : kLightCollars;
}

// Tells trees apart, and is the same at all levels and wherever a tree stands in a game.
uint64_t foot_seed(const Tree& tree) {
    uint64_t seed = 0;
    const DVec3 origin = tree.frame().origin;
    for (const double value : {origin.x, origin.y, origin.z, tree.node(tree.root()).radius})
        seed = hash_seed(seed, std::bit_cast<uint64_t>(value + 0.0));
    return seed;
}

}  // namespace

uint32_t sides_of(double radius, const TubeOptions& options) {
    const double wanted = 2.0 * kPi * radius / std::max(options.side_length, 1e-6);
    const int most = std::max(options.maximum_sides, 3);
    const int less = (radius < kTwigRadius ? 1 : 0) + (radius < kFineTwigRadius ? 1 : 0);
    const int least = std::clamp(options.minimum_sides - less, 3, most);
    const int sides =
        static_cast<int>(std::clamp(wanted, static_cast<double>(least), static_cast<double>(most)));
    return static_cast<uint32_t>(std::max(3, sides >> std::clamp(options.level, 0, 8)));
}

// Radii near the parent: hidden at the start, widened where the branch comes out of the bark.
void Builder::add_collar(const Branch& branch, std::vector<AxisPoint>& points, Tube& tube) const {
    const Node& attach = tree.node(branch.attach);
    const double own = points.front().radius;
    tube.parent_radius = attach.radius;
    const double hidden = std::max(hidden_radius(branch.attach, std::max(own, attach.radius)), least);
    DVec3 parent_direction(0.0);
    if (attach.parent != kNoNode) parent_direction = attach.position - tree.node(attach.parent).position;
    parent_direction = normalized_or(parent_direction, DVec3(0.0, 1.0, 0.0));
    const double sine = glm::length(glm::cross(parent_direction, points.front().direction));
    const double length = points.back().along;
    tube.exit = std::min(attach.radius / std::max(sine, 0.3), 0.7 * length);
    // One that first goes its parent's way parts from it without a collar.
    const double follows = 1.0 - glm::smoothstep(0.3, 0.8, sine);
    if (options.level <= kCollarLevel && own >= kCollarRadius * collar_share(options.level) &&
        own < 0.98 * hidden) {
        // Rings at the bark, and two more where the collar has run out.
        size_t hint = 0;
        for (double along : {0.85 * tube.exit, tube.exit + 0.8 * own, tube.exit + 2.2 * own}) {
            if (along >= length) break;
            const AxisPoint point = axis_at(points, along, hint);
            const double gap = std::max(0.2 * own, 2.0 * least);
            if (along - points[hint].along < gap || points[hint + 1].along - along < gap) continue;
            points.insert(points.begin() + static_cast<std::ptrdiff_t>(hint) + 1, point);
        }
        for (AxisPoint& point : points) {
            const double past = std::max(point.along - 0.85 * tube.exit, 0.0) / (1.4 * own);
            if (past > 3.0) break;
            const double widened =
                point.radius * (1.0 + (1.0 - follows) * kCollar * portable::exp(-past * past));
            point.radius = std::min(widened, std::max(point.radius, hidden));
        }
    }
    // One about as thick as its parent, or that goes its way, starts well within it and grows over its first
    // metres: its bark comes out of the parent's gradually, not as the rim of a tube.
    double start = std::min(hidden, std::max(kForkShare * attach.radius, least));
    start = std::min(start, std::max(own * (1.0 - kForkTaper * follows), least));
    const double until = 2.0 * std::max({tube.exit, 0.5 * points[1].along, 2.0 * least});
    for (AxisPoint& point : points) {
        if (point.along >= until) break;
        if (point.radius > start) point.radius = start + (point.radius - start) * point.along / until;
    }
}

// As few rings as show the axis' bends and the radius' changes.
void Builder::pick_rings(const Branch& branch, const std::vector<AxisPoint>& points, const Tube& tube,
                         const std::vector<SectionPlace>& sections, std::vector<Ring>& out) const {
    const int level = std::clamp(options.level, 0, 8);
    // Of the wood itself: what comes out of a parent starts thinner.
    const double stoutness = std::max(points.front().radius, tree.node(list.nodes[branch.begin]).radius);
    const BendLimit& limits =
        *std::find_if(std::begin(kBendLimits), std::end(kBendLimits) - 1,
                      [&](const BendLimit& limit) { return stoutness >= limit.least_radius; });
    const double bend_limit = portable::cos(std::min(limits.bend * (1 << level), 1.2));
    const double change_limit = 0.4 * (1 + level);
    const double spacing_limit = std::max(0.5, 0.1 * branch.length) * (1 << level);
    const double closeness = 0.35 * (1 + level);
    const double slack = limits.slack * (1 << level);
    const size_t most_left_out = kMostLeftOut << level;
    const bool twig = stoutness < kCollarRadius;  // no light shows how evenly it thins
    const double taper = (twig ? kTwigTaperSlack : kTaperSlack) * (1 << level),
                 taper_slack = kHeightTaperSlack * crown.height * (1 << level);
    const double lead = section_lead(stoutness), outline_slack = kOutlineSlack * (1 << level);
    const double least_slack = kHeightSlack * crown.height * (1 << level);
    const auto add = [&](const AxisPoint& point) {
        out.push_back({point.position, point.direction, std::max(point.radius, least), point.along,
                       DVec3(0.0), point.way});
    };
    // Whether the straight way from one point to another passes by a point between.
    const auto misses = [&](size_t from, size_t to) {
        const DVec3 chord = points[to].position - points[from].position;
        const double square = glm::dot(chord, chord);
        for (size_t i = from + 1; i < to; i++) {
            const DVec3 offset = points[i].position - points[from].position;
            const double t = square > 0.0 ? std::clamp(glm::dot(offset, chord) / square, 0.0, 1.0) : 0.0;
            const DVec3 off = offset - chord * t;
            const double limit = std::max(slack * points[i].radius, least_slack);
            if (glm::dot(off, off) > limit * limit) return true;
            const double thick = glm::mix(points[from].radius, points[to].radius, t);
            if (std::abs(thick - points[i].radius) > std::max(taper * points[i].radius, taper_slack))
                return true;
        }
        return missed_outline(sections, points[from].along, points[to].along, lead) > outline_slack;
    };
    size_t last = 0;
    add(points[0]);
    while (last + 1 < points.size()) {
        const AxisPoint& from = points[last];
        size_t best = last + 1;
        const double gap = std::max(closeness * from.radius, 2.0 * least);
        const bool collar_begins = tube.exit > 0.0 && level <= kCollarLevel;
        for (size_t next = last + 1; next < points.size(); next++) {
            const AxisPoint& to = points[next];
            const bool near = points[best].along - from.along < gap;
            const bool far = to.along - from.along > spacing_limit || next - last > most_left_out;
            const bool bent = glm::dot(from.direction, to.direction) < bend_limit;
            const bool changed = !twig && std::abs(to.radius - from.radius) > change_limit * from.radius;
            if (!near && (far || bent || changed || misses(last, next))) break;
            best = next;
            const bool collar = collar_begins && to.radius >= kCollarRadius * collar_share(options.level) &&
                                to.along < tube.exit + 2.5 * to.radius;
            if (collar && to.along - from.along >= gap) break;
        }
        // A last ring right above another only makes slivers.
        if (best + 1 == points.size() && last > 0 &&
            points[best].along - from.along < std::max(0.15 * from.radius, least))
            out.pop_back();
        add(points[best]);
        last = best;
    }
}

void Builder::plan(size_t index, std::vector<AxisPoint>& points) {
    const Branch& branch = list.branches[index];
    Tube& tube = tubes[index];
    std::vector<Ring>& out = rings[index / kBranchesPerChunk];
    tube.first_ring = static_cast<uint32_t>(out.size());
    if (widened[index] == 0.0f || options.grown_alone) return;
    sample_axis(tree, list, branch, 2.0 * least, points);
    if (points.size() < 2) return;
    size_t nearest = 0;
    for (NodeId id : list.nodes_of(branch)) {
        const DVec3 position = tree.node(id).position;
        const auto distance = [&](size_t i) { return glm::distance(points[i].position, position); };
        while (nearest + 1 < points.size() && distance(nearest + 1) <= distance(nearest))
            nearest++;
        node_along[id] = static_cast<float>(points[nearest].along);
    }
    if (!cut_covered(index, points)) return;
    const bool begins = covered[index] <= 0.0;  // else it goes on from grown bark
    if (branch.attach != kNoNode && begins) {
        // A stub that ends within its parent is never seen.
        const double end = glm::distance(points.back().position, points.front().position);
        const double parent = tree.node(branch.attach).radius;
        if (branch.length + points.back().radius < 0.8 * hidden_radius(branch.attach, parent) && end < parent)
            return;
        add_collar(branch, points, tube);
    }
    const std::vector<SectionPlace> sections = sections_of(branch);
    pick_rings(branch, points, tube, sections, out);
    tube.rings = static_cast<uint32_t>(out.size()) - tube.first_ring;
    limit_tilt(out.data() + tube.first_ring, tube.rings);
    if (branch.attach != kNoNode && begins && options.level <= kCollarLevel) {
        const double own = tree.node(list.nodes[branch.begin]).radius;
        if (own >= kCollarRadius * collar_share(options.level))
            limit_slant(out.data() + tube.first_ring, tube.rings,
                        std::max(tube.exit + 3.0 * own, 2.0 * tube.exit));
    }
    double thickest = 0.0;
    for (size_t i = tube.first_ring; i < out.size(); i++)
        thickest = std::max(thickest, out[i].radius);
    tube.sides = sides_of(thickest, options);
    if (branch.attach == kNoNode && begins && tree.node(tree.root()).is_trunk())
        stand(points, sections, tube, out);
    tube.base_radius = points.front().radius;
    if (options.level <= kUnevenLevel && thickest >= kUnevenRadius) {
        const double round = std::max(
            branch.attach == kNoNode ? tube.flare.reach : tube.exit + 2.5 * thickest, covered[index]);
        tube.section =
            uneven_section(hash_seed(foot_seed(tree), static_cast<uint64_t>(list.nodes[branch.begin])),
                           thickest, round, out.back().along);
    }
    // From as far as coarser levels are seen, a thick end still shows.
    tube.cut = out.back().radius >= kCutRadius * (1 << std::clamp(options.level, 0, 8));
    tube.round_tip = tube.cut || (options.level == 0 && out.back().radius >= kRoundTipRadius);
    tube.base = branch.attach == kNoNode && tube.foot_rows == 0 && begins;
    tube.point = tube.rings > 1 && out.back().radius < kPointRadius;
    if (tube.point) out.back().radius = least;
    parallel_transport(out.data() + tube.first_ring, tube.rings, tube.flare.turn);
    if (tube.section.until > tube.section.from && !sections.empty())
        measure_section(tube.section, sections, out.data() + tube.first_ring, tube.rings, tube.foot_rows > 0);
}

// What was measured of its outlines, where it is to be seen.
std::vector<SectionPlace> Builder::sections_of(const Branch& branch) const {
    std::vector<SectionPlace> places;
    if (tree.sections().empty() || options.level > kUnevenLevel) return places;
    const std::span<const NodeId> nodes = list.nodes_of(branch);
    if (std::none_of(nodes.begin(), nodes.end(), [&](NodeId id) { return tree.node(id).section > 0; }))
        return places;
    for (const NodeId id : nodes)
        places.push_back({static_cast<double>(node_along[id]), tree.section_of(id)});
    return places;
}

// A standing trunk has a foot, and goes on below the ground.
void Builder::stand(const std::vector<AxisPoint>& points, const std::vector<SectionPlace>& sections,
                    Tube& tube, std::vector<Ring>& out) const {
    if (!stands(out.data() + tube.first_ring, tube.rings)) return;
    // Palms and poles have no roots to show.
    const bool roots = list.branches.size() > 1;
    tube.flare = plan_flare(points, foot_depth(crown.height), foot_seed(tree), roots);
    const double lead = section_lead(points.front().radius);
    hold_back_roots(tube.flare, outline_relief(sections, 0.5 * tube.flare.reach, lead));
    if (options.level > 1 || options.maximum_sides < kRootedSides) tube.flare = without_roots(tube.flare);
    tube.sides = std::max(tube.sides, (kSidesPerRoot * tube.flare.count) >> options.level);
    tube.foot_rows = lay_foot_rings(tube.flare, points, options.level, out, tube.first_ring);
    tube.rings = static_cast<uint32_t>(out.size()) - tube.first_ring;
    stretch_base(tube.flare, out.data() + tube.first_ring, tube.rings);
}

// Moves a tube's start into its parent's tube as it is drawn: rings are fewer than nodes, and cut corners.
void Builder::seat(size_t index) {
    const Branch& branch = list.branches[index];
    if (tubes[index].rings == 0 || branch.attach == kNoNode || covered[index] > 0.0) return;
    const size_t host = static_cast<size_t>(list.branch_of[branch.attach]);
    const Tube& parent = tubes[host];
    if (parent.rings < 2 || static_cast<double>(node_along[branch.attach]) < covered[host]) return;
    const Ring* begin = rings_of(host);
    const Ring* end = begin + parent.rings;
    const auto above = [&](double along) {
        const Ring* ring =
            std::upper_bound(begin, end, along, [](double a, const Ring& b) { return a < b.along; });
        return std::clamp(ring, begin + 1, end - 1);
    };
    const double along = node_along[branch.attach];
    const Ring* upper = above(along);
    const Ring* lower = upper - 1;
    const DVec3 chord = upper->centre - lower->centre;
    const DVec3 position = tree.node(branch.attach).position;
    const double t = std::clamp(
        glm::dot(position - lower->centre, chord) / std::max(glm::dot(chord, chord), 1e-60), 0.0, 1.0);
    double radius = lower->radius + (upper->radius - lower->radius) * t;
    const double reach = radius;
    for (double side : {along - reach, along + reach}) {
        const Ring* over = above(side);
        const Ring* under = over - 1;
        const double f =
            std::clamp((side - under->along) / std::max(over->along - under->along, 1e-30), 0.0, 1.0);
        radius = std::min(radius, under->radius + (over->radius - under->radius) * f);
    }
    tubes[index].host_ring = static_cast<uint32_t>(lower - begin);
    const double hidden = 0.92 * polygon_flat(parent.sides) * radius;
    Ring& start = rings[index / kBranchesPerChunk][tubes[index].first_ring];
    const DVec3 moved = lower->centre + chord * t - start.centre;
    // What lies within the parent goes along, or the tube would fold there.
    Ring* own = &start;
    for (size_t i = 0; i + 1 < tubes[index].rings && own[i].along < reach; i++)
        own[i].centre += moved * (1.0 - own[i].along / reach);
    tubes[index].parent_direction = normalized_or(chord, DVec3(0.0, 1.0, 0.0));
    start.radius = std::max(std::min(start.radius, hidden), least);
}

// Once all tubes are where they stay.
void Builder::join(size_t index) {
    const Branch& branch = list.branches[index];
    Tube& tube = tubes[index];
    if (options.level > kCollarLevel || tube.rings < 2 || branch.attach == kNoNode || covered[index] > 0.0)
        return;
    if (tree.node(list.nodes[branch.begin]).radius < kWebRadius * collar_share(options.level)) return;
    const size_t host = static_cast<size_t>(list.branch_of[branch.attach]);
    const double along = node_along[branch.attach];
    if (tubes[host].rings < 2 || along < covered[host]) return;
    // On a foot there is no prism to lie on.
    if (along < tubes[host].flare.reach + tree.node(list.nodes[branch.begin]).radius) return;
    std::vector<CollarVertex>& out = collars[index / kBranchesPerChunk];
    tube.first_collar = out.size();
    tube.collar = make_collar(shape_of(index), shape_of(host), tube.host_ring, options.level == 0, out);
}

void Builder::for_all(const Progress* progress, const std::function<void(size_t, size_t)>& body) const {
    const size_t count = tubes.size();
    parallel_for(count, count <= kFewBranches ? kFewBranches : kBranchesPerChunk,
                 [&](size_t begin, size_t end) {
                     if (progress) progress->check();
                     body(begin, end);
                 });
}

// Where the rings of all branches lie.
void Builder::lay_out(const Progress* progress) {
    // From near by, a twig that stood for others would look swollen; a few that are missing, nobody misses.
    if (options.level == 0)
        for (float& share : widened)
            share = std::min(share, 1.0f);
    for_all(progress, [&](size_t begin, size_t end) {
        std::vector<AxisPoint> points;
        for (size_t i = begin; i < end; i++)
            plan(i, points);
    });
    for (size_t i = 0; i < tubes.size(); i++)  // parents before children
        seat(i);
    if (options.level > 0)
        for (size_t i = 0; i < tubes.size(); i++)
            widen(i);
    for_all(progress, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++)
            join(i);
    });
}

size_t Builder::triangles() const {
    return std::accumulate(tubes.begin(), tubes.end(), size_t{0},
                           [](size_t sum, const Tube& tube) { return sum + tube.indices() / 3; });
}

// Of a tree that was laid out at a finer one: the least at which what still stands has no more triangles, or
// the coarsest.
double Builder::coarseness_of(size_t triangles, double finer, double coarser) const {
    while (coarser - finer > kCoarserStep) {
        const double between = 0.5 * (finer + coarser);
        const std::vector<float> shares = share_twigs(tree, list, crown, between);
        size_t count = 0;
        for (size_t i = 0; i < tubes.size(); i++)
            if (shares[i] > 0.0f) count += tubes[i].indices() / 3;
        (count > triangles ? finer : coarser) = between;
    }
    return coarser;
}

}  // namespace tubes

Mesh build_branch_tubes(const Tree& tree, const TubeOptions& options, const Progress* progress) {
    Mesh mesh;
    if (tree.size() < 2) return mesh;
    if (options.maximum_sides > 64) throw Error("A branch can have at most 64 sides.");
    double coarseness = options.twig_level < 0.0 ? options.level : options.twig_level;
    const double coarsest = coarseness + tubes::kMostCoarser;
    auto laid_out = std::make_unique<tubes::Builder>(tree, options, coarseness);
    if (!(laid_out->crown.coordinate < tubes::kLargestTree))
        throw Error("The tree reaches beyond 1000 km; check the scan's units.");
    laid_out->lay_out(progress);
    // Wider twigs may have more sides, so that it takes another time.
    while (options.most_triangles > 0 && laid_out->triangles() > options.most_triangles &&
           coarseness < coarsest) {
        coarseness = laid_out->coarseness_of(options.most_triangles, coarseness, coarsest);
        laid_out = std::make_unique<tubes::Builder>(tree, options, coarseness);
        laid_out->lay_out(progress);
    }
    tubes::Builder& builder = *laid_out;
    size_t vertices = 0, indices = 0;
    for (tubes::Tube& tube : builder.tubes) {
        tube.first_vertex = vertices;
        tube.first_index = indices;
        vertices += tube.vertices();
        indices += tube.indices();
    }
    if (vertices > UINT32_MAX) throw Error("The tree's bark has too many vertices; simplify the tree first.");
    mesh.positions.resize(vertices);
    mesh.normals.resize(vertices);
    mesh.uvs.resize(vertices);
    mesh.colors.resize(vertices);
    mesh.tangents.resize(vertices);
    if (options.pivots) {
        mesh.custom0.resize(vertices);
        mesh.radii.resize(vertices);
        mesh.wind.resize(vertices);
    }
    mesh.indices.resize(indices);
    builder.for_all(progress, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++)
            if (builder.tubes[i].rings > 0) builder.emit(i, mesh);
    });
    if (options.grown) builder.add_grown(mesh);
    return mesh;
}

}  // namespace treerec
