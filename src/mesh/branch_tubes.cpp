#include "mesh/branch_tubes.h"

#include <algorithm>
#include <optional>

#include "error.h"
#include "foliage/branch_axis.h"
#include "foliage/crown.h"
#include "geometry/parallel.h"
#include "mesh/tube_rings.h"
#include "tree/branches.h"

namespace treerec {

namespace {

constexpr double kLargestTree = 1e6;       // metres from the origin
constexpr double kLeastShare = 1e-5;       // of the coordinates: thinner wood would vanish in floats
constexpr double kCollar = 0.35;           // how much wider a branch leaves its parent, over its radius
constexpr double kCollarRadius = 0.012;    // metres; thinner branches get no collar of their own
constexpr double kForkShare = 0.7;         // of its parent's radius: as wide a thick branch starts at most
constexpr double kForkTaper = 0.3;         // of its own radius: how much thinner a forking branch starts
constexpr double kRoundTipRadius = 0.006;  // metres; thinner tips are pointed
constexpr double kTwigRadius = 0.008;      // metres; thinner tubes have a side less,
constexpr double kFineTwigRadius = 0.004;  // these two, and run out in a point
constexpr double kAxisSlack = 0.3;         // how far rings may leave out a bend, over the radius,
constexpr double kHeightSlack = 1e-3;      // and over the tree's height
constexpr size_t kMostLeftOut = 12;        // points of the axis between two rings
constexpr size_t kBranchesPerChunk = 32;   // of parallel work

// Radians between rings at level 0, of branches of such a radius in metres: the eye rests on the stout ones.
struct BendLimit {
    double least_radius;
    double bend;
};
constexpr BendLimit kBendLimits[] = {{0.02, 0.35}, {0.01, 0.7}, {0.0, 1.2}};

// How one branch becomes a tube: where its rings lie in its chunk, and its vertices and indices in the mesh.
struct Tube {
    uint32_t first_ring = 0;
    uint32_t rings = 0;  // 0: not drawn
    uint32_t sides = 0;
    bool round_tip = false;
    bool point = false;           // the last ring is only the apex
    double exit = 0.0;            // metres along, where it leaves its parent's bark; 0 for the trunk
    double parent_radius = 0.0;   // metres, 0 for the trunk
    DVec3 parent_direction{0.0};  // unit, of the parent where the tube starts
    std::optional<double> foot;   // y of a standing trunk's level cut
    size_t first_vertex = 0;
    size_t first_index = 0;

    size_t all_rings() const { return rings + (round_tip ? 1u : 0u) - (point ? 1u : 0u); }
    size_t vertices() const { return rings ? all_rings() * (sides + 1) + sides : 0; }
    size_t indices() const { return rings ? (all_rings() - 1) * sides * 6 + sides * 3 : 0; }
};

uint32_t sides_of(double radius, const TubeOptions& options) {
    const double wanted = 2.0 * kPi * radius / std::max(options.side_length, 1e-6);
    const int most = std::max(options.maximum_sides, 3);
    const int less = (radius < kTwigRadius ? 1 : 0) + (radius < kFineTwigRadius ? 1 : 0);
    const int least = std::clamp(options.minimum_sides - less, 3, most);
    const int sides =
        static_cast<int>(std::clamp(wanted, static_cast<double>(least), static_cast<double>(most)));
    return static_cast<uint32_t>(std::max(3, sides >> std::clamp(options.level, 0, 8)));
}

// Everything that the tubes of one tree share.
struct Builder {
    const Tree& tree;
    const TubeOptions& options;
    const BranchList list;
    const Crown crown;
    const double least;                    // metres: the smallest radius and half the smallest ring distance
    std::vector<Tube> tubes;               // by branch
    std::vector<std::vector<Ring>> rings;  // by chunk of branches
    std::vector<uint8_t> drawn;            // by branch: not too thin, or bearing one that is not
    std::vector<float> node_along;         // by node id: metres along its branch's axis

    Builder(const Tree& t, const TubeOptions& o)
        : tree(t),
          options(o),
          list(list_branches(t)),
          crown(measure_crown(t)),
          least(kLeastShare * crown.coordinate),
          tubes(list.branches.size()),
          rings((list.branches.size() + kBranchesPerChunk - 1) / kBranchesPerChunk),
          drawn(list.branches.size(), 0),
          node_along(static_cast<size_t>(t.id_end()), 0.0f) {
        for (size_t i = list.branches.size(); i-- > 0;) {
            if (!drawn[i] && too_thin(list.branches[i])) continue;
            drawn[i] = 1;
            if (list.branches[i].parent >= 0) drawn[static_cast<size_t>(list.branches[i].parent)] = 1;
        }
    }

    const Ring* rings_of(size_t branch) const {
        return rings[branch / kBranchesPerChunk].data() + tubes[branch].first_ring;
    }

    // The largest radius that a ring about `attach` may have and still hide in its parent's tube: the parent
    // is a prism, and thins towards its next node.
    double hidden_radius(NodeId attach, double reach) const {
        const Node& node = tree.node(attach);
        double radius = node.radius;
        const Branch& parent = list.branches[list.branch_of[attach]];
        for (NodeId child : tree.children(attach)) {
            if (list.branch_of[child] != list.branch_of[attach]) continue;
            const double distance = glm::distance(tree.node(child).position, node.position);
            const double t = distance > reach ? reach / distance : 1.0;
            radius = std::min(radius, radius + (tree.node(child).radius - radius) * t);
        }
        const double thickest = tree.node(list.nodes[parent.begin]).radius;
        return 0.92 * std::cos(kPi / sides_of(thickest, options)) * radius;
    }

    void plan(size_t index, std::vector<AxisPoint>& points);
    void seat(size_t index);
    void add_collar(const Branch& branch, std::vector<AxisPoint>& points, Tube& tube) const;
    void pick_rings(const Branch& branch, const std::vector<AxisPoint>& points, const Tube& tube,
                    std::vector<Ring>& out) const;
    void emit(size_t index, Mesh& mesh) const;
    bool too_thin(const Branch& branch) const;
};

// Far away, thin and short branches are less than a pixel.
bool Builder::too_thin(const Branch& branch) const {
    if (options.level <= 0 || branch.attach == kNoNode) return false;
    const double scale = crown.height * std::ldexp(1.0, std::min(options.level, 16));
    const Node& first = tree.node(list.nodes[branch.begin]);
    return first.radius < 0.0002 * scale || branch.length < 0.005 * scale;
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
    if (options.level == 0 && own >= kCollarRadius && own < 0.98 * hidden) {
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
            const double widened = point.radius * (1.0 + (1.0 - follows) * kCollar * std::exp(-past * past));
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
                         std::vector<Ring>& out) const {
    const int level = std::clamp(options.level, 0, 8);
    // Of the wood itself: what comes out of a parent starts thinner.
    const double stoutness = std::max(points.front().radius, tree.node(list.nodes[branch.begin]).radius);
    const double bend_per_ring =
        std::find_if(std::begin(kBendLimits), std::end(kBendLimits) - 1, [&](const BendLimit& limit) {
            return stoutness >= limit.least_radius;
        })->bend;
    const double bend_limit = std::cos(std::min(bend_per_ring * (1 + level), 1.2));
    const double change_limit = 0.4 * (1 + level);
    const double spacing_limit = std::max(0.5, 0.1 * branch.length) * (1 << level);
    const double closeness = 0.35 * (1 + level);
    const double slack = kAxisSlack * (1 << level);
    const double least_slack = kHeightSlack * crown.height * (1 << level);
    const auto add = [&](const AxisPoint& point) {
        out.push_back({point.position, point.direction, std::max(point.radius, least), point.along});
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
        }
        return false;
    };
    size_t last = 0;
    add(points[0]);
    while (last + 1 < points.size()) {
        const AxisPoint& from = points[last];
        size_t best = last + 1;
        const double gap = std::max(closeness * from.radius, 2.0 * least);
        const bool collar_begins = tube.exit > 0.0 && level == 0;
        for (size_t next = last + 1; next < points.size(); next++) {
            const AxisPoint& to = points[next];
            const bool near = points[best].along - from.along < gap;
            const bool far = to.along - from.along > spacing_limit || next - last > kMostLeftOut;
            const bool bent = glm::dot(from.direction, to.direction) < bend_limit;
            const bool changed = std::abs(to.radius - from.radius) > change_limit * from.radius;
            if (!near && (far || bent || changed || misses(last, next))) break;
            best = next;
            const bool collar =
                collar_begins && to.radius >= kCollarRadius && to.along < tube.exit + 2.5 * to.radius;
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
    if (!drawn[index]) return;
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
    if (branch.attach != kNoNode) {
        // A stub that ends within its parent is never seen.
        const double end = glm::distance(points.back().position, points.front().position);
        const double parent = tree.node(branch.attach).radius;
        if (branch.length + points.back().radius < 0.8 * hidden_radius(branch.attach, parent) && end < parent)
            return;
        add_collar(branch, points, tube);
    }
    pick_rings(branch, points, tube, out);
    tube.rings = static_cast<uint32_t>(out.size()) - tube.first_ring;
    limit_tilt(out.data() + tube.first_ring, tube.rings);
    double thickest = 0.0;
    for (size_t i = tube.first_ring; i < out.size(); i++)
        thickest = std::max(thickest, out[i].radius);
    if (branch.attach == kNoNode && tree.node(tree.root()).is_trunk())
        tube.foot = cut_level(out.data() + tube.first_ring, tube.rings);
    tube.sides = sides_of(thickest, options);
    tube.round_tip = options.level == 0 && out.back().radius >= kRoundTipRadius;
    tube.point = tube.rings > 1 && out.back().radius < kFineTwigRadius;
    if (tube.point) out.back().radius = least;
}

// Moves a tube's start into its parent's tube as it is drawn: rings are fewer than nodes, and cut corners.
void Builder::seat(size_t index) {
    const Branch& branch = list.branches[index];
    if (tubes[index].rings == 0 || branch.attach == kNoNode) return;
    const size_t host = static_cast<size_t>(list.branch_of[branch.attach]);
    const Tube& parent = tubes[host];
    if (parent.rings < 2) return;
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
    const double hidden = 0.92 * std::cos(kPi / parent.sides) * radius;
    Ring& start = rings[index / kBranchesPerChunk][tubes[index].first_ring];
    start.centre = lower->centre + chord * t;
    tubes[index].parent_direction = normalized_or(chord, DVec3(0.0, 1.0, 0.0));
    start.radius = std::max(std::min(start.radius, hidden), least);
}

void Builder::emit(size_t index, Mesh& mesh) const {
    const Branch& branch = list.branches[index];
    const Tube& tube = tubes[index];
    const Ring* const run = rings_of(index);
    const uint32_t sides = tube.sides;
    const size_t count = tube.rings;
    const Ring& last_ring = run[count - 1];
    const double length = last_ring.along;
    const double repeats =
        std::max(1.0, std::round(2.0 * kPi * run[1].radius / std::max(options.bark_width, 1e-6)));
    const float phase = static_cast<float>(branch_phase(list.nodes[branch.end - 1]));
    const Vec4 custom0(Vec3(run[0].centre), static_cast<float>(branch.order));
    DVec2 circle[65];
    for (uint32_t j = 0; j <= sides; j++) {
        const double angle = 2.0 * kPi * (j % sides) / sides;
        circle[j] = {std::cos(angle), std::sin(angle)};
    }
    size_t vertex = tube.first_vertex;
    const auto put = [&](const DVec3& position, const DVec3& normal, const DVec3& tangent, double u, double v,
                         double radius, const Vec4& color) {
        mesh.positions[vertex] = Vec3(position);
        mesh.normals[vertex] = Vec3(normal);
        mesh.uvs[vertex] = {static_cast<float>(u), static_cast<float>(v)};
        mesh.colors[vertex] = color;
        mesh.tangents[vertex] = Vec4(Vec3(tangent), -1.0f);
        if (options.pivots) {
            mesh.custom0[vertex] = custom0;
            mesh.radii[vertex] = static_cast<float>(radius);
        }
        vertex++;
    };
    // shade: 0 .. 1, how much of the ring's vertex lies in the crease between the branch and its parent.
    const auto color_at = [&](const DVec3& centre, double along, double shade) {
        double light = 0.45 + 0.55 * crown.openness(centre);
        if (centre.y < crown.centre.y - crown.radii.y) light = 0.95;
        if (tube.parent_radius > 0.0) {
            const double t = std::clamp((along - tube.exit) / (1.5 * tube.parent_radius), 0.0, 1.0);
            light *= 1.0 - 0.4 * (1.0 - t) * shade;
        } else {
            light *= 0.75 + 0.25 * std::clamp(along / (4.0 * run[0].radius), 0.0, 1.0);
        }
        return Vec4(static_cast<float>(crown.sway(centre)), static_cast<float>(std::min(along / length, 1.0)),
                    phase, static_cast<float>(light));
    };
    // Where a branch comes out, its normals lean to those of its parent's bark, so that light finds no edge.
    const auto blend_at = [&](const Ring& ring) {
        if (tube.parent_radius <= 0.0 || options.level > 0 || run[1].radius < kCollarRadius) return 0.0;
        const double past = (ring.along - tube.exit) / (1.5 * run[1].radius);
        return 0.9 * (1.0 - glm::smoothstep(-0.2, 1.0, past));
    };
    DVec3 normal = run[0].normal;
    DVec3 x = any_perpendicular(normal);
    for (size_t i = 0; i < count - (tube.point ? 1 : 0); i++) {
        const Ring& ring = run[i];
        // Parallel transport: the smallest turn that takes the last ring's normal to this one's.
        const double turn = 1.0 + glm::dot(normal, ring.normal);
        if (turn > 1e-9) x -= (normal + ring.normal) * (glm::dot(x, ring.normal) / turn);
        normal = ring.normal;
        x = normalized_or(x - normal * glm::dot(x, normal), any_perpendicular(normal));
        const DVec3 y = glm::cross(normal, x);
        const Ring& before = run[i > 0 ? i - 1 : 0];
        const Ring& after = run[std::min(i + 1, count - 1)];
        const double slope = std::clamp(
            (after.radius - before.radius) / std::max(after.along - before.along, 1e-30), -1.0, 1.0);
        const double scale = 1.0 / std::sqrt(1.0 + slope * slope);
        const Vec4 color = color_at(ring.centre, ring.along, 1.0);
        const double blend = i == 0 ? 0.0 : blend_at(ring);
        for (uint32_t j = 0; j <= sides; j++) {
            const DVec3 radial = x * circle[j].x + y * circle[j].y;
            DVec3 position = ring.centre + radial * ring.radius;
            double v = ring.along;
            if (i == 0 && tube.foot) {
                // Along the trunk to the level cut.
                const double down = (position.y - *tube.foot) / normal.y;
                position -= normal * down;
                v -= down;
            }
            DVec3 tangent = y * circle[j].x - x * circle[j].y;
            DVec3 outward = (radial - normal * slope) * scale;
            Vec4 corner_color = color;
            if (blend > 0.0) {
                const DVec3 from = position - run[0].centre;
                const DVec3 bark = from - tube.parent_direction * glm::dot(from, tube.parent_direction);
                const DVec3 away = normalized_or(bark, outward);
                // What looks away from the parent's axis lies in no crease.
                const double shade = 1.0 - glm::smoothstep(0.0, 0.8, glm::dot(radial, away));
                corner_color = color_at(ring.centre, ring.along, shade);
                outward = normalized_or(outward + away * blend, outward);
                tangent = normalized_or(tangent - outward * glm::dot(outward, tangent), tangent);
            }
            put(position, outward, tangent, repeats * j / sides, v, ring.radius, corner_color);
        }
    }
    // The tip: a dome, or a point as high as the tip is wide.
    const DVec3 y = glm::cross(normal, x);
    const Vec4 color = color_at(last_ring.centre, length, 1.0);
    if (tube.round_tip) {
        for (uint32_t j = 0; j <= sides; j++) {
            const DVec3 radial = x * circle[j].x + y * circle[j].y;
            put(last_ring.centre + (radial * 0.76 + normal * 0.62) * last_ring.radius,
                radial * 0.7746 + normal * 0.6325, y * circle[j].x - x * circle[j].y, repeats * j / sides,
                length + 0.66 * last_ring.radius, last_ring.radius, color);
        }
    }
    const DVec3 apex = last_ring.centre + normal * (0.98 * last_ring.radius);
    for (uint32_t j = 0; j < sides; j++) {
        const DVec2 between = 0.5 * (circle[j] + circle[j + 1]);
        const DVec3 tangent = glm::normalize(y * between.x - x * between.y);
        // A drawn-out point is lit like the wood below it.
        const DVec3 outward = tube.point ? glm::normalize(x * between.x + y * between.y) : normal;
        put(apex, outward, tangent, repeats * (j + 0.5) / sides, length + 1.2 * last_ring.radius,
            last_ring.radius, color);
    }
    size_t at = tube.first_index;
    const uint32_t base = static_cast<uint32_t>(tube.first_vertex), stride = sides + 1;
    const uint32_t spans = static_cast<uint32_t>(tube.all_rings()) - 1;
    for (uint32_t i = 0; i < spans; i++) {
        for (uint32_t j = 0; j < sides; j++) {
            const uint32_t a = base + i * stride + j, b = a + 1, c = a + stride, d = c + 1;
            for (uint32_t corner : {a, b, d, a, d, c})
                mesh.indices[at++] = corner;
        }
    }
    for (uint32_t j = 0; j < sides; j++) {
        const uint32_t a = base + spans * stride + j;
        for (uint32_t corner : {a, a + 1, base + (spans + 1) * stride + j})
            mesh.indices[at++] = corner;
    }
}

}  // namespace

Mesh build_branch_tubes(const Tree& tree, const TubeOptions& options, const Progress* progress) {
    Mesh mesh;
    if (tree.size() < 2) return mesh;
    if (options.maximum_sides > 64) throw Error("A branch can have at most 64 sides.");
    Builder builder(tree, options);
    if (!(builder.crown.coordinate < kLargestTree))
        throw Error("The tree reaches beyond 1000 km; check the scan's units.");
    const size_t branches = builder.tubes.size();
    parallel_for(branches, kBranchesPerChunk, [&](size_t begin, size_t end) {
        if (progress) progress->check();
        std::vector<AxisPoint> points;
        for (size_t i = begin; i < end; i++)
            builder.plan(i, points);
    });
    for (size_t i = 0; i < branches; i++)  // parents before children
        builder.seat(i);
    size_t vertices = 0, indices = 0;
    for (Tube& tube : builder.tubes) {
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
    }
    mesh.indices.resize(indices);
    parallel_for(branches, kBranchesPerChunk, [&](size_t begin, size_t end) {
        if (progress) progress->check();
        for (size_t i = begin; i < end; i++)
            if (builder.tubes[i].rings > 0) builder.emit(i, mesh);
    });
    return mesh;
}

}  // namespace treerec
