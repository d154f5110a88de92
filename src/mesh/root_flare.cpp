#include "mesh/root_flare.h"

#include <algorithm>
#include <cmath>

#include "geometry/portable_math.h"
#include "geometry/random.h"
#include "mesh/polygon.h"

namespace treerec {

namespace {

// A trunk's foot is a prior, as tree forms are described (Mattheck 1998, "Design in Nature": root flare and
// buttresses): it begins half a diameter to one diameter up, and four to seven roots run out and under.
constexpr double kWider = 1.26;       // the base's radius over that of the trunk above it, as trunks stand,
constexpr double kYoungWider = 1.2;   // and as young stems do
constexpr double kReach = 2.6;        // radii up the trunk, but
constexpr double kMostReach = 1.4;    // metres at most
constexpr double kMostOfTrunk = 0.3;  // of its length
constexpr double kLookUp = 3.0;       // radii: where the trunk above is measured
constexpr double kThinStem = 0.015;   // metres of radius: thinner stems are round,
constexpr double kYoungStem = 0.06;   // up to here they bulge softly,
constexpr double kStoutStem = 0.16;   // and from here on they have all of their roots
// How far a bulge or a root stands out on the ground, over the radius, from the least to the most.
constexpr double kLeastBulge = 0.04, kMostBulge = 0.16;
constexpr double kLeastRoot = 0.3, kMostRoot = 1.1;
constexpr double kLeastWidth = 0.21, kMostWidth = 0.28;  // of the angle between two roots
constexpr double kUnder = 0.5;  // how much further a root goes out below the ground, over its out
constexpr double kSpread = 0.25,
                 kSpreadDepth = 0.7;  // and at least, in radii: young stems' roots begin there
constexpr double kSlender = 0.1;      // how much less of the angle a root takes that stands out by a radius
constexpr double kBare = 0.3;         // radii below the ground, to where it is as wide as on it,
constexpr double kSlim = 1.3;         // and how much deeper it is half as wide: slopes lay that bare
constexpr double kMostBare = 0.35;    // such a radius is at most this of the depth
constexpr double kLeastEnd = 1.8, kMostEnd = 4.5;  // radii below the ground, where a root is cut off
constexpr double kCut = 0.48;                      // of its width: what is left where it is cut
constexpr double kBaseHeight = 3.0;                // radii: how far up a trunk widens into its roots
constexpr double kHollow = 0.45;                   // of the light: what is lost between two roots
constexpr double kDepthShare = 0.1;                // of the tree's height
constexpr double kLeastDepth = 0.6;                // metres,
constexpr double kMostDepth = 2.0;
constexpr double kMostOfHeight = 0.5;
// Of an outline from narrowest to widest, over the radius: what leaves all roots to be drawn, and what is
// roots itself. Some of each stays: harmonics blunt what is sharp.
constexpr double kFluted = 0.4, kButtressed = 1.2;
constexpr double kYield = 0.8;
constexpr size_t kOutline = 96;   // corners that it is measured by,
constexpr size_t kSamples = 360;  // and between roots on the ground

// Heights of rings over the reach, from the top, and depths below the ground over the radius.
constexpr double kFineHeights[] = {0.8, 0.6, 0.44, 0.3, 0.18, 0.08, 0.0};
constexpr double kFineDepths[] = {0.12, 0.35, 0.8, 1.5, 2.5, 4.0};
constexpr double kCoarseHeights[] = {0.55, 0.25, 0.0};
constexpr double kCoarseDepths[] = {0.25, 1.2};

double wrapped(double angle) {
    return angle - 2.0 * kPi * std::round(angle / (2.0 * kPi));
}

// 0 at a flare's top, 1 on the ground, more below it.
double descent(double reach, double along) {
    return std::max(1.0 - along / reach, 0.0);
}

// How far a root stands out of the trunk there, over what it does on the ground: its back leaves the trunk
// smoothly, and dives the steeper the deeper it is.
double root_out(double down) {
    if (down <= 1.0) return down * down;
    return 1.0 + kUnder * (1.0 - portable::exp(-2.0 / kUnder * (down - 1.0)));
}

double bent_angle(const SurfaceRoot& root, double along) {
    const double out = root_out(descent(root.reach, along));
    return root.angle + root.bend * out;
}

double widened(const RootFlare& flare, double along) {
    const double down = std::min(descent(flare.reach, along), 1.0);
    return 1.0 + flare.amount * down * down;
}

// What of a trunk's width is left so deep below the ground, and of a root there: what hangs under a tree that
// stands nowhere looks like a taproot and roots that were cut off.
double taproot(const RootFlare& flare, double depth) {
    const double unit = std::min(flare.radius, kMostBare * flare.depth);
    const double past = depth - kBare * unit;
    if (past <= 0.0) return 1.0;
    const double left = std::max(1.0 - past / (flare.depth - kBare * unit), 0.0);
    const double slimmer = past / (kSlim * unit);
    return kCut + (1.0 - kCut) * left / (1.0 + slimmer * std::sqrt(slimmer));
}

double root_left(const RootFlare& flare, const SurfaceRoot& root, double depth) {
    const double end = std::min(root.end, 0.9 * flare.depth);
    return 1.0 - glm::smoothstep(0.15 * end, end, depth);
}

// The foot's radius at an angle, over the ring's.
double foot_factor(const RootFlare& flare, double along, double angle) {
    double factor = widened(flare, along) * taproot(flare, -along);
    for (uint32_t i = 0; i < flare.count; i++) {
        const SurfaceRoot& root = flare.roots[i];
        const double down = descent(root.reach, along);
        if (down <= 0.0) continue;
        const double left = root_left(flare, root, -along);
        if (left <= 0.0) continue;
        const double under = kSpread * glm::smoothstep(0.0, kSpreadDepth * flare.radius, -along);
        const double out = (root.out * root_out(down) + under) * left;
        // A root is about as wide far out as near: it takes less of the angle there.
        const double width = root.width * (1.0 + 1.2 * std::max(1.0 - down, 0.0)) / (1.0 + kSlender * out);
        const double off = wrapped(angle - bent_angle(root, along)) / width;
        factor += out * portable::exp(-0.5 * off * off);
    }
    return factor;
}

// From young stems to those that have all of their roots: 0 .. 1. radius: metres.
double stoutness(double radius) {
    return glm::smoothstep(kYoungStem, kStoutStem, radius);
}

void grow_roots(RootFlare& flare, double radius, uint64_t seed) {
    if (radius <= kThinStem) return;
    const double stout = stoutness(radius);
    const double least = glm::mix(kLeastBulge, kLeastRoot, stout),
                 most = glm::mix(kMostBulge, kMostRoot, stout);
    Random random(seed, 31);
    const uint32_t count = 4 + random.below(kMostRoots - 3);
    flare.count = count;
    flare.turn = random.uniform(0.0, 2.0 * kPi);
    const double spacing = 2.0 * kPi / count;
    for (uint32_t i = 0; i < count; i++) {
        SurfaceRoot& root = flare.roots[i];
        root.angle = i > 0 ? spacing * (i + random.uniform(-0.22, 0.22)) : 0.0;
        root.bend = random.uniform(-0.22, 0.22);
        // Of roots, the longest are the stoutest.
        const double share = random.uniform(0.0, 1.0);
        root.out = glm::mix(least, most, share);
        root.width = spacing * glm::mix(kLeastWidth, kMostWidth, share);
        root.reach = flare.reach * random.uniform(0.6, 1.0);
        root.end = radius * random.uniform(kLeastEnd, kMostEnd);
    }
}

// Between which angles columns lie on the ground: the backs of roots have a column each, and the outline
// between two is shared by its length.
struct Columns {
    std::vector<uint32_t> root;   // by column: the root before it,
    std::vector<double> between;  // and where from there to the next one: 0 .. 1
};

Columns spread_columns(const RootFlare& flare, uint32_t sides) {
    // By root: the outline's length to the next one.
    std::vector<std::vector<double>> lengths(flare.count);
    std::vector<double> start(flare.count + 1, 0.0);
    for (uint32_t i = 0; i < flare.count; i++) {
        const double from = bent_angle(flare.roots[i], 0.0);
        const double whole = wrapped(bent_angle(flare.roots[(i + 1) % flare.count], 0.0) - from);
        const double gap = whole > 0.0 ? whole : whole + 2.0 * kPi;
        std::vector<double>& sum = lengths[i];
        sum.push_back(0.0);
        DVec2 last(0.0);
        for (size_t k = 0; k <= kSamples / flare.count; k++) {
            const double angle =
                from + gap * static_cast<double>(k) / static_cast<double>(kSamples / flare.count);
            const double radius = foot_factor(flare, 0.0, angle);
            const DVec2 at(radius * portable::cos(angle), radius * portable::sin(angle));
            if (k > 0) sum.push_back(sum.back() + glm::distance(at, last));
            last = at;
        }
        start[i + 1] = start[i] + sum.back();
    }
    Columns columns;
    columns.root.resize(sides);
    columns.between.resize(sides);
    const double per_side = start[flare.count] / sides;
    for (uint32_t i = 0; i < flare.count; i++) {
        const auto column_of = [&](uint32_t root) {
            return static_cast<uint32_t>(std::round(start[root] / per_side));
        };
        const uint32_t begin = column_of(i), end = i + 1 == flare.count ? sides : column_of(i + 1);
        const std::vector<double>& sum = lengths[i];
        for (uint32_t j = begin; j < end; j++) {
            const double wanted = sum.back() * (j - begin) / (end - begin);
            const size_t over =
                static_cast<size_t>(std::upper_bound(sum.begin(), sum.end() - 1, wanted) - sum.begin());
            const double step = std::max(sum[over] - sum[over - 1], 1e-30);
            columns.root[j] = i;
            columns.between[j] =
                (static_cast<double>(over - 1) + std::clamp((wanted - sum[over - 1]) / step, 0.0, 1.0)) /
                static_cast<double>(sum.size() - 1);
        }
    }
    return columns;
}

// Where a column is at that height: even above the flare, and gathered at the roots on the ground.
double column_angle(const RootFlare& flare, const Columns& columns, uint32_t column, uint32_t sides,
                    double along) {
    const double even = 2.0 * kPi * column / sides;
    if (flare.count == 0) return even;
    const uint32_t i = columns.root[column], next = (i + 1) % flare.count;
    const double from = bent_angle(flare.roots[i], along);
    double gap = wrapped(bent_angle(flare.roots[next], along) - from);
    if (gap <= 0.0) gap += 2.0 * kPi;
    const double gathered = from + gap * columns.between[column];
    const double share = glm::smoothstep(0.0, 0.7, descent(flare.reach, along));
    return even + share * wrapped(gathered - even);
}

}  // namespace

double foot_depth(double height) {
    return std::min(std::clamp(kDepthShare * height, kLeastDepth, kMostDepth), kMostOfHeight * height);
}

RootFlare plan_flare(const std::vector<AxisPoint>& points, double depth, uint64_t seed, bool roots) {
    RootFlare flare;
    size_t hint = 0;
    const double base = points.front().radius;
    const double up = kLookUp * base;
    const double length = points.back().along;
    const double above = axis_at(points, std::min(up, 0.5 * length), hint).radius;
    // What it is at the base already, and must stay.
    const double wider = glm::mix(kYoungWider, kWider, stoutness(above));
    flare.amount = std::clamp(wider * above / base - 1.0, 0.0, wider - 1.0);
    flare.reach = std::min({kReach * above, kMostReach, kMostOfTrunk * length});
    flare.depth = depth;
    flare.radius = base;
    if (roots && up <= 0.5 * length) grow_roots(flare, above, seed);
    return flare;
}

void hold_back_roots(RootFlare& flare, double relief) {
    const double kept = 1.0 - kYield * glm::smoothstep(kFluted, kButtressed, relief);
    for (uint32_t i = 0; i < flare.count; i++)
        flare.roots[i].out *= kept;
}

RootFlare without_roots(RootFlare flare) {
    for (uint32_t i = 0; i < flare.count; i++) {
        const SurfaceRoot& root = flare.roots[i];
        // The mean of a bell over a round.
        flare.amount += root.out * root.width / (1.0 + kSlender * root.out) / std::sqrt(2.0 * kPi);
    }
    flare.count = 0;
    return flare;
}

size_t lay_foot_rings(const RootFlare& flare, const std::vector<AxisPoint>& points, int level,
                      std::vector<Ring>& rings, size_t first) {
    size_t above = first;
    while (above + 1 < rings.size() && rings[above].along < 1.05 * flare.reach)
        above++;
    size_t hint = 0;
    const AxisPoint top = axis_at(points, flare.reach, hint);
    std::vector<Ring> foot;
    const auto add = [&](double along, const DVec3& centre, double radius, double way) {
        // Level on the ground, so that rows of wide roots do not cross where the trunk leans.
        const double level = glm::smoothstep(0.0, 1.0, descent(flare.reach, along));
        const DVec3 up(0.0, 1.0, 0.0);
        foot.push_back(
            {centre, normalized_or(glm::mix(top.direction, up, level), up), radius, along, DVec3(0.0), way});
    };
    const auto add_below = [&](double depth) {
        add(-depth, points[0].position - DVec3(0.0, depth, 0.0), points[0].radius, 0.0);
    };
    const auto add_above = [&](double share) {
        const AxisPoint at = axis_at(points, share * flare.reach, hint);
        add(at.along, at.position, at.radius, at.way);
    };
    add_below(flare.depth);
    const auto lay = [&](const auto& heights, const auto& depths) {
        for (size_t i = std::size(depths); i-- > 0;)
            if (const double depth = depths[i] * points[0].radius; depth < 0.9 * flare.depth)
                add_below(depth);
        for (size_t i = std::size(heights); i-- > 0;)
            add_above(heights[i]);
    };
    hint = 0;
    if (level == 0)
        lay(kFineHeights, kFineDepths);
    else if (level == 1)
        lay(kCoarseHeights, kCoarseDepths);
    else
        add_above(0.0);
    add_above(1.0);
    rings.erase(rings.begin() + static_cast<std::ptrdiff_t>(first),
                rings.begin() + static_cast<std::ptrdiff_t>(above));
    rings.insert(rings.begin() + static_cast<std::ptrdiff_t>(first), foot.begin(), foot.end());
    return foot.size() - 1;
}

std::vector<FootVertex> shape_foot(const RootFlare& flare, const Ring* rings, size_t rows, uint32_t sides,
                                   const UnevenSection& section) {
    const Columns columns = flare.count > 0 ? spread_columns(flare, sides) : Columns();
    const size_t stride = sides + 1;
    // The ring above the foot is among them for what is measured between rows.
    std::vector<FootVertex> out((rows + 1) * stride);
    for (size_t row = 0; row <= rows; row++) {
        const Ring& ring = rings[row];
        const DVec3 y = ring.y();
        const double mean = widened(flare, ring.along);
        for (uint32_t j = 0; j < sides; j++) {
            const double angle = column_angle(flare, columns, j, sides, ring.along);
            const double factor = foot_factor(flare, ring.along, angle);
            const DVec3 radial = ring.x * portable::cos(angle) + y * portable::sin(angle);
            FootVertex& vertex = out[row * stride + j];
            vertex.position =
                ring.centre + radial * (ring.radius * factor * section.factor(ring.along, angle));
            vertex.normal = radial;
            vertex.light = factor - mean;  // how far it stands out
        }
        double farthest = 0.0;
        for (uint32_t j = 0; j < sides; j++)
            farthest = std::max(farthest, out[row * stride + j].light);
        for (uint32_t j = 0; j < sides; j++) {
            double& light = out[row * stride + j].light;
            light = 1.0 - kHollow * std::max(0.0, 1.0 - light / std::max(farthest, 1e-9)) * farthest /
                              (0.6 + farthest);
        }
        out[row * stride + sides] = out[row * stride];
    }
    for (size_t j = 0; j < stride; j++) {
        out[rows * stride + j].v = rings[rows].along;
        for (size_t row = rows; row-- > 0;)
            out[row * stride + j].v =
                out[(row + 1) * stride + j].v -
                glm::distance(out[row * stride + j].position, out[(row + 1) * stride + j].position);
    }
    for (size_t row = 0; row <= rows; row++) {
        for (uint32_t j = 0; j < sides; j++) {
            FootVertex& vertex = out[row * stride + j];
            const DVec3 along = out[std::min(row + 1, rows) * stride + j].position -
                                out[(row > 0 ? row - 1 : 0) * stride + j].position;
            const DVec3 around = out[row * stride + (j + 1) % sides].position -
                                 out[row * stride + (j + sides - 1) % sides].position;
            vertex.normal = normalized_or(glm::cross(around, along), vertex.normal);
            vertex.tangent = normalized_or(around - vertex.normal * glm::dot(around, vertex.normal), around);
        }
        FootVertex& seam = out[row * stride + sides];
        seam.normal = out[row * stride].normal;
        seam.tangent = out[row * stride].tangent;
    }
    return out;
}

void stretch_base(const RootFlare& flare, Ring* rings, size_t count) {
    for (size_t i = 0; i < count && rings[i].along < flare.reach; i++) {
        double around = 0.0;
        DVec2 last(0.0);
        for (size_t k = 0; k <= kOutline; k++) {
            const double angle = 2.0 * kPi * static_cast<double>(k) / kOutline;
            const double factor = foot_factor(flare, rings[i].along, angle);
            const DVec2 at(factor * portable::cos(angle), factor * portable::sin(angle));
            if (k > 0) around += glm::distance(at, last);
            last = at;
        }
        rings[i].stretch = around / (2.0 * kPi);
    }
    limit_slant(rings, count, std::max(kBaseHeight * flare.radius, flare.reach));
}

}  // namespace treerec
