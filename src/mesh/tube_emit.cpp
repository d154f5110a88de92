// Tubes to vertices.
#include <algorithm>

#include "geometry/portable_math.h"
#include "mesh/polygon.h"
#include "mesh/tube_builder.h"

namespace treerec::tubes {

namespace {

constexpr double kCrease = 0.2;  // of the light: how much darker it is halfway up a collar

}  // namespace

// How much of the sky the bark sees (COLOR.a). shade: 0 .. 1, how much of the place lies in the crease
// between the branch and its parent.
double Builder::light_at(const Tube& tube, double start_radius, const DVec3& centre, double along,
                         double shade) const {
    double light = 0.45 + 0.55 * crown.openness(centre);
    if (centre.y < crown.centre.y - crown.radii.y) light = 0.95;
    if (tube.parent_radius > 0.0) {
        const double t = std::clamp((along - tube.exit) / (1.5 * tube.parent_radius), 0.0, 1.0);
        return light * (1.0 - 0.4 * (1.0 - t) * shade);
    }
    return light * (0.75 + 0.25 * std::clamp(along / (4.0 * start_radius), 0.0, 1.0));
}

// How often the bark's picture goes around where the branch is so thick.
double Builder::repeats_of(size_t index, double radius) const {
    const double width = std::max(options.bark_width, 1e-6);
    // As the shader finds them from the radius: that of the wood, however wide it is drawn.
    if (!options.whole_repeats) return 2.0 * kPi * radius / (width * std::max(widened[index], 1.0f));
    // Grown bark and the tube that goes on from it have one number.
    const double thick = covered[index] > 0.0 ? tree.node(list.nodes[list.branches[index].begin]).radius
                                              : rings_of(index)[1].radius;
    return std::max(1.0, std::round(2.0 * kPi * thick / width));
}

Vec2 Builder::wind_at(size_t index, double along, const DVec3& place) const {
    const Ring* const run = rings_of(index);
    const Ring* const end = run + tubes[index].rings;
    const Ring* upper =
        std::upper_bound(run, end, along, [](double a, const Ring& r) { return a < r.along; });
    upper = std::clamp(upper, run + 1, end - 1);
    const Ring& lower = upper[-1];
    const double t =
        std::clamp((along - lower.along) / std::max(upper->along - lower.along, 1e-30), 0.0, 1.0);
    const DVec3 centre = lower.centre + (upper->centre - lower.centre) * t;
    return wind.codes(index, lower.way + (upper->way - lower.way) * t, place - centre);
}

void Builder::emit(size_t index, Mesh& mesh) const {
    const Branch& branch = list.branches[index];
    const Tube& tube = tubes[index];
    const Ring* const run = rings_of(index);
    const uint32_t sides = tube.sides, stride = sides + 1;
    const size_t count = tube.rings;
    const Ring& last_ring = run[count - 1];
    const double length = last_ring.along;
    const double repeats = repeats_of(index, last_ring.radius);
    const float phase = phase_of(index);
    const Vec4 custom0(Vec3(run[0].centre), static_cast<float>(branch.order));
    const DVec2* const circle = polygon(sides);
    const double per_side = 1.0 / sides;
    size_t vertex = tube.first_vertex;
    Vec2 code{0.0f};  // the wind's, of the vertex that is put next
    const auto put = [&](const DVec3& position, const DVec3& normal, const DVec3& tangent, double around,
                         double repeats, double v, double radius, const Vec4& color) {
        mesh.positions[vertex] = Vec3(position);
        mesh.normals[vertex] = Vec3(normal);
        mesh.uvs[vertex] = {static_cast<float>(around * repeats), static_cast<float>(v)};
        mesh.colors[vertex] = color;
        mesh.tangents[vertex] = Vec4(Vec3(tangent), -1.0f);
        if (options.pivots) {
            mesh.custom0[vertex] = custom0;
            mesh.radii[vertex] = static_cast<float>(radius / widened[index]);
            mesh.wind[vertex] = code;
        }
        vertex++;
    };
    const auto color_at = [&](const DVec3& centre, double along, double light, float of_phase) {
        return Vec4(static_cast<float>(crown.sway(centre)), static_cast<float>(std::min(along / length, 1.0)),
                    of_phase, static_cast<float>(light));
    };
    const CollarVertex* const collar = collars[index / kBranchesPerChunk].data() + tube.first_collar;
    const size_t host = static_cast<size_t>(std::max(branch.parent, 0));
    const float host_phase = tube.collar.rows > 0 ? phase_of(host) : 0.0f;
    // What all rows of a column share, and what two rows at one place do.
    double bark_light[kMostSides];
    Vec2 codes[kMostSides];
    Vec4 shades[kMostSides];
    for (uint32_t row = 0; row < tube.collar.rows; row++) {
        const bool ground = row == 0, as_host = ground || row == 2;
        // Where the branch's picture meets its parent's: the bark's shader blends them.
        const double sign = row == 1 || row == 2 ? -1.0 : 1.0;
        const CollarVertex* const corners = collar + row * stride;
        for (uint32_t j = 0; j < stride; j++) {
            const CollarVertex& from = corners[j];
            const uint32_t column = j < sides ? j : 0;
            if (row != 2 && j < sides) {
                if (ground)
                    bark_light[j] = light_at(tubes[host], rings_of(host)[0].radius, from.host_centre,
                                             from.host_along, 1.0);
                const double own = light_at(tube, run[0].radius, from.position, from.along, 1.0);
                const double crease = 1.0 - kCrease * 4.0 * from.own * (1.0 - from.own);
                const double light = (bark_light[j] + (own - bark_light[j]) * from.own) * crease;
                // The base moves as the bark that it stands on.
                codes[j] = ground ? wind_at(host, from.host_along, from.position)
                                  : wind_at(index, from.along, from.position);
                shades[j] = color_at(from.position, ground ? 0.0 : std::max(from.along, 1e-4 * length), light,
                                     ground ? host_phase : phase);
            }
            code = codes[column];
            put(from.position, from.normal, from.tangent, from.around,
                repeats_of(as_host ? host : index, from.radius), from.v, sign * from.radius, shades[column]);
        }
    }
    // Where a branch comes out, its normals lean to those of its parent's bark, so that light finds no edge.
    const auto blend_at = [&](const Ring& ring) {
        if (tube.parent_radius <= 0.0 || options.level > 0 || tube.collar.rows > 0 ||
            run[1].radius < kCollarRadius)
            return 0.0;
        const double past = (ring.along - tube.exit) / (1.5 * run[1].radius);
        return 0.9 * (1.0 - glm::smoothstep(-0.2, 1.0, past));
    };
    for (size_t i = tube.collar.next_ring; i < count - (tube.point ? 1 : 0); i++) {
        const Ring& ring = run[i];
        const DVec3 y = ring.y();
        const double slope = ring_slope(run, count, i);
        const double scale = 1.0 / std::sqrt(1.0 + slope * slope);
        const Vec4 color = color_at(ring.centre, ring.along,
                                    light_at(tube, run[0].radius, ring.centre, ring.along, 1.0), phase);
        const bool flares = tube.flare.amount > 0.0 && ring.along < tube.flare.reach;
        const double shown = ring.radius * ring.stretch;
        const double ring_repeats = repeats_of(index, shown);
        const double blend = i == 0 ? 0.0 : blend_at(ring);
        const bool free = wind.is_free(index, ring.way);
        code = wind.codes(index, ring.way);
        for (uint32_t j = 0; j < stride; j++) {
            const DVec3 radial = ring.x * circle[j].x + y * circle[j].y;
            DVec3 tangent = (y * circle[j].x - ring.x * circle[j].y);
            DVec3 outward = (radial - ring.normal * slope) * scale;
            double radius = ring.radius;
            if (flares) {
                const FlareAt flare = flare_at(tube.flare, ring, 2.0 * kPi * (j % sides) / sides);
                radius = flare.radius;
                outward = normalized_or(radial - ring.normal * flare.slope -
                                            (y * circle[j].x - ring.x * circle[j].y) * flare.turn,
                                        radial);
                tangent = normalized_or(tangent - outward * glm::dot(outward, tangent), tangent);
            }
            DVec3 position = ring.centre + radial * radius;
            double v = ring.along;
            if (i == 0 && tube.ground) {
                // Along the trunk to the level cut.
                const double down = (position.y - *tube.ground) / ring.normal.y;
                position -= ring.normal * down;
                v -= down;
            }
            Vec4 corner_color = color;
            if (blend > 0.0) {
                const DVec3 from = position - run[0].centre;
                const DVec3 bark = from - tube.parent_direction * glm::dot(from, tube.parent_direction);
                const DVec3 away = normalized_or(bark, outward);
                // What looks away from the parent's axis lies in no crease.
                const double shade = 1.0 - glm::smoothstep(0.0, 0.8, glm::dot(radial, away));
                corner_color = color_at(ring.centre, ring.along,
                                        light_at(tube, run[0].radius, ring.centre, ring.along, shade), phase);
                outward = normalized_or(outward + away * blend, outward);
                tangent = normalized_or(tangent - outward * glm::dot(outward, tangent), tangent);
            }
            if (!free) code = wind.codes(index, ring.way, position - ring.centre);
            put(position, outward, tangent, per_side * j, ring_repeats, v, shown, corner_color);
        }
    }
    // The tip: a dome, or a point as high as the tip is wide.
    code = wind.codes(index, last_ring.way);
    const DVec3 normal = last_ring.normal, x = last_ring.x, y = last_ring.y();
    const Vec4 color = color_at(last_ring.centre, length,
                                light_at(tube, run[0].radius, last_ring.centre, length, 1.0), phase);
    if (tube.round_tip) {
        for (uint32_t j = 0; j < stride; j++) {
            const DVec3 radial = x * circle[j].x + y * circle[j].y;
            const DVec3 around = y * circle[j].x - x * circle[j].y;
            if (tube.cut) {
                put(last_ring.centre + (radial * 0.97 + normal * 0.015) * last_ring.radius, normal, around,
                    per_side * j, repeats_of(index, kHeartwood), length, kHeartwood, color);
            } else {
                put(last_ring.centre + (radial * 0.76 + normal * 0.62) * last_ring.radius,
                    radial * 0.7746 + normal * 0.6325, around, per_side * j, repeats,
                    length + 0.66 * last_ring.radius, last_ring.radius, color);
            }
        }
    }
    if (tube.base) {
        const DVec3 down = -run[0].normal;
        const Vec4 dim =
            color_at(run[0].centre, 0.0, light_at(tube, run[0].radius, run[0].centre, 0.0, 1.0), phase);
        for (uint32_t j = 0; j < stride; j++) {
            const DVec3 radial = run[0].x * circle[j].x + run[0].y() * circle[j].y;
            put(run[0].centre + radial * run[0].radius, down, run[0].x, per_side * j,
                repeats_of(index, kHeartwood), 0.0, kHeartwood, dim);
        }
        put(run[0].centre, down, run[0].x, 0.5, repeats_of(index, kHeartwood), -run[0].radius, kHeartwood,
            dim);
    }
    const DVec3 apex = last_ring.centre + normal * ((tube.cut ? 0.02 : 0.98) * last_ring.radius);
    const double shown = tube.cut ? kHeartwood : last_ring.radius;
    for (uint32_t j = 0; j < sides; j++) {
        const DVec2 between = 0.5 * (circle[j] + circle[j + 1]);
        const DVec3 tangent = glm::normalize(y * between.x - x * between.y);
        // A drawn-out point is lit like the wood below it.
        const DVec3 outward = tube.point ? glm::normalize(x * between.x + y * between.y) : normal;
        put(apex, outward, tangent, per_side * (j + 0.5), repeats_of(index, shown),
            length + (tube.cut ? 1.0 : 1.2) * last_ring.radius, shown, color);
    }
    size_t at = tube.first_index;
    const uint32_t base = static_cast<uint32_t>(tube.first_vertex);
    const uint32_t rows = static_cast<uint32_t>(tube.rows());
    const uint32_t apexes = base + rows * stride + static_cast<uint32_t>(tube.caps());
    const uint32_t first_row = tube.collar.rows ? 1 : 0;
    const auto join_rows = [&](uint32_t low, uint32_t high) {
        for (uint32_t j = 0; j < sides; j++) {
            const uint32_t a = base + low * stride + j, b = a + 1, c = base + high * stride + j, d = c + 1;
            for (uint32_t corner : {a, b, d, a, d, c})
                mesh.indices[at++] = corner;
        }
    };
    if (first_row) {
        join_rows(0, 2);
        join_rows(1, 3);
    }
    for (uint32_t row = first_row ? 3 : 0; row + 1 < rows; row++)
        join_rows(row, row + 1);
    for (uint32_t j = 0; j < sides; j++) {
        const uint32_t a = base + (rows - 1) * stride + j;
        for (uint32_t corner : {a, a + 1, apexes + j})
            mesh.indices[at++] = corner;
    }
    for (uint32_t j = 1; tube.plug && j + 1 < sides; j++)
        for (const uint32_t corner : {base, base + j + 1, base + j})
            mesh.indices[at++] = corner;
    for (uint32_t j = 0; tube.base && j < sides; j++) {
        const uint32_t a = base + rows * stride + j;
        for (uint32_t corner : {a + 1, a, base + rows * stride + stride})
            mesh.indices[at++] = corner;
    }
}

}  // namespace treerec::tubes
