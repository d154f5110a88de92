// Tubes to vertices.
#include <algorithm>

#include "geometry/portable_math.h"
#include "mesh/polygon.h"
#include "mesh/tube_builder.h"

namespace treerec::tubes {

namespace {

constexpr double kCrease = 0.2;  // of the light: how much darker it is halfway up a collar

// Puts the vertices of one tube into the mesh, row after row, and then its faces.
class Emitter {
  public:
    Emitter(const Builder& builder, size_t index, Mesh& mesh)
        : b_(builder),
          index_(index),
          mesh_(mesh),
          branch_(b_.list.branches[index]),
          tube_(b_.tubes[index]),
          run_(b_.rings_of(index)),
          last_(run_[tube_.rings - 1]),
          sides_(tube_.sides),
          stride_(tube_.sides + 1),
          circle_(polygon(tube_.sides)),
          phase_(b_.phase_of(index)),
          custom0_(Vec3(run_[0].centre), static_cast<float>(branch_.order)),
          vertex_(tube_.first_vertex) {}

    void put_collar();
    void put_rings();
    void put_tip();
    void put_base();
    void put_apexes();
    void join() const;

  private:
    double length() const { return last_.along; }

    void put(const DVec3& position, const DVec3& normal, const DVec3& tangent, double around, double repeats,
             double v, double radius, const Vec4& color) {
        mesh_.positions[vertex_] = Vec3(position);
        mesh_.normals[vertex_] = Vec3(normal);
        mesh_.uvs[vertex_] = {static_cast<float>(around * repeats), static_cast<float>(v)};
        mesh_.colors[vertex_] = color;
        mesh_.tangents[vertex_] = Vec4(Vec3(tangent), -1.0f);
        if (b_.options.pivots) {
            mesh_.custom0[vertex_] = custom0_;
            mesh_.radii[vertex_] = static_cast<float>(radius / b_.widened[index_]);
            mesh_.wind[vertex_] = code_;
        }
        vertex_++;
    }

    // A corner of the face across a ring, or its middle: share 0 or 1.
    void put_cut(const Ring& ring, const DVec3& normal, const DVec2& corner, double share,
                 const Vec4& color) {
        const double wood = ring.radius / b_.widened[index_];
        const DVec3 radial = ring.x * corner.x + ring.y() * corner.y;
        put(ring.centre + radial * (share * ring.radius), normal, ring.x, 0.0, 0.0, 0.0, ring.radius, color);
        mesh_.uvs[vertex_ - 1] = Vec2(corner * (share * wood) - DVec2(0.0, kCutMark));
    }

    Vec4 color_at(const DVec3& centre, double along, double light, float of_phase) const {
        return Vec4(static_cast<float>(b_.crown.sway(centre)),
                    static_cast<float>(std::min(along / length(), 1.0)), of_phase, static_cast<float>(light));
    }

    double light_at(const DVec3& centre, double along, double shade = 1.0) const {
        return b_.light_at(tube_, run_[0].radius, centre, along, shade);
    }

    // How far normals lean to those of the parent's bark where a branch comes out of it, so that light finds
    // no edge: 0 .. 1.
    double blend_at(const Ring& ring) const {
        if (tube_.parent_radius <= 0.0 || b_.options.level > 0 || tube_.collar.rows > 0 ||
            run_[1].radius < kCollarRadius)
            return 0.0;
        const double past = (ring.along - tube_.exit) / (1.5 * run_[1].radius);
        return 0.9 * (1.0 - glm::smoothstep(-0.2, 1.0, past));
    }

    void put_foot();
    void put_ring(size_t i);

    const Builder& b_;
    const size_t index_;  // of the branch
    Mesh& mesh_;
    const Branch& branch_;
    const Tube& tube_;
    const Ring* const run_;
    const Ring& last_;
    const uint32_t sides_, stride_;
    const DVec2* const circle_;
    const float phase_;
    const Vec4 custom0_;
    size_t vertex_;    // that is put next,
    Vec2 code_{0.0f};  // and its wind code
};

void Emitter::put_collar() {
    const CollarVertex* const collar = b_.collars[index_ / kBranchesPerChunk].data() + tube_.first_collar;
    const size_t host = static_cast<size_t>(std::max(branch_.parent, 0));
    const float host_phase = tube_.collar.rows > 0 ? b_.phase_of(host) : 0.0f;
    // What all rows of a column share, and what two rows at one place do.
    double bark_light[kMostSides];
    Vec2 codes[kMostSides];
    Vec4 shades[kMostSides];
    for (uint32_t row = 0; row < tube_.collar.rows; row++) {
        const bool lowest = row == 0, as_host = lowest || row == 2;
        // Where the branch's picture meets its parent's: the bark's shader blends them.
        const double sign = row == 1 || row == 2 ? -1.0 : 1.0;
        const CollarVertex* const corners = collar + row * stride_;
        for (uint32_t j = 0; j < stride_; j++) {
            const CollarVertex& from = corners[j];
            const uint32_t column = j < sides_ ? j : 0;
            if (row != 2 && j < sides_) {
                if (lowest)
                    bark_light[j] = b_.light_at(b_.tubes[host], b_.rings_of(host)[0].radius, from.host_centre,
                                                from.host_along, 1.0);
                const double own = light_at(from.position, from.along);
                const double crease = 1.0 - kCrease * 4.0 * from.own * (1.0 - from.own);
                const double light = (bark_light[j] + (own - bark_light[j]) * from.own) * crease;
                // The base moves as the bark that it stands on.
                codes[j] = lowest ? b_.wind_at(host, from.host_along, from.position)
                                  : b_.wind_at(index_, from.along, from.position);
                shades[j] = color_at(from.position, lowest ? 0.0 : std::max(from.along, 1e-4 * length()),
                                     light, lowest ? host_phase : phase_);
            }
            code_ = codes[column];
            put(from.position, from.normal, from.tangent, from.around,
                b_.repeats_of(as_host ? host : index_, from.radius), from.v, sign * from.radius,
                shades[column]);
        }
    }
}

void Emitter::put_rings() {
    put_foot();
    for (size_t i = std::max<size_t>(tube_.collar.next_ring, tube_.foot_rows);
         i < tube_.rings - (tube_.point ? 1 : 0); i++)
        put_ring(i);
}

void Emitter::put_foot() {
    if (tube_.foot_rows == 0) return;
    const std::vector<FootVertex> foot =
        shape_foot(tube_.flare, run_, tube_.foot_rows, sides_, tube_.section);
    const double per_side = 1.0 / sides_;
    for (size_t i = 0; i < tube_.foot_rows; i++) {
        const Ring& ring = run_[i];
        const double shown = ring.radius * ring.stretch;
        const double light = light_at(ring.centre, ring.along);
        // The cut's alone are at the branch's very start.
        const double along = i == 0 ? 0.0 : std::max(ring.along, 1e-4 * length());
        code_ = b_.wind.codes(index_, ring.way);
        for (uint32_t j = 0; j < stride_; j++) {
            const FootVertex& vertex = foot[i * stride_ + j];
            if (!b_.wind.is_free(index_, ring.way))
                code_ = b_.wind.codes(index_, ring.way, vertex.position - ring.centre);
            put(vertex.position, vertex.normal, vertex.tangent, per_side * j, b_.repeats_of(index_, shown),
                vertex.v, shown, color_at(ring.centre, along, light * vertex.light, phase_));
        }
    }
}

void Emitter::put_ring(size_t i) {
    const Ring& ring = run_[i];
    const DVec3 y = ring.y();
    const double slope = ring_slope(run_, tube_.rings, i);
    const Vec4 color = color_at(ring.centre, ring.along, light_at(ring.centre, ring.along), phase_);
    const double shown = ring.radius * ring.stretch;
    const double ring_repeats = b_.repeats_of(index_, shown);
    const double blend = i == 0 ? 0.0 : blend_at(ring);
    const bool free = b_.wind.is_free(index_, ring.way);
    const double per_side = 1.0 / sides_;
    code_ = b_.wind.codes(index_, ring.way);
    for (uint32_t j = 0; j < stride_; j++) {
        const DVec3 radial = ring.x * circle_[j].x + y * circle_[j].y;
        DVec3 tangent = (y * circle_[j].x - ring.x * circle_[j].y);
        const double angle = 2.0 * kPi * (j % sides_) / sides_;
        const double factor = tube_.section.factor(ring.along, angle);
        const DVec3 position = ring.centre + radial * (ring.radius * factor);
        const double rise = slope * factor + ring.radius * tube_.section.rise(ring.along, angle);
        DVec3 outward =
            radial - ring.normal * rise - tangent * (tube_.section.turn(ring.along, angle) / factor);
        outward = normalized_or(outward, radial);
        tangent = normalized_or(tangent - outward * glm::dot(outward, tangent), tangent);
        Vec4 corner_color = color;
        if (blend > 0.0) {
            const DVec3 from = position - run_[0].centre;
            const DVec3 bark = from - tube_.parent_direction * glm::dot(from, tube_.parent_direction);
            const DVec3 away = normalized_or(bark, outward);
            // What looks away from the parent's axis lies in no crease.
            const double shade = 1.0 - glm::smoothstep(0.0, 0.8, glm::dot(radial, away));
            corner_color =
                color_at(ring.centre, ring.along, light_at(ring.centre, ring.along, shade), phase_);
            outward = normalized_or(outward + away * blend, outward);
            tangent = normalized_or(tangent - outward * glm::dot(outward, tangent), tangent);
        }
        if (!free) code_ = b_.wind.codes(index_, ring.way, position - ring.centre);
        put(position, outward, tangent, per_side * j, ring_repeats, ring.along, shown, corner_color);
    }
}

// A dome or a cut face; nothing where the tip is a point.
void Emitter::put_tip() {
    code_ = b_.wind.codes(index_, last_.way);
    if (!tube_.round_tip) return;
    const DVec3 normal = last_.normal, x = last_.x, y = last_.y();
    const double repeats = b_.repeats_of(index_, last_.radius);
    const double per_side = 1.0 / sides_;
    const Vec4 color = color_at(last_.centre, length(), light_at(last_.centre, length()), phase_);
    for (uint32_t j = 0; j < stride_; j++) {
        if (tube_.cut) {
            put_cut(last_, normal, circle_[j], 1.0, color);
            continue;
        }
        const DVec3 radial = x * circle_[j].x + y * circle_[j].y;
        const DVec3 around = y * circle_[j].x - x * circle_[j].y;
        put(last_.centre + (radial * 0.76 + normal * 0.62) * last_.radius, radial * 0.7746 + normal * 0.6325,
            around, per_side * j, repeats, length() + 0.66 * last_.radius, last_.radius, color);
    }
}

void Emitter::put_base() {
    if (!tube_.base) return;
    const Ring& first = run_[0];
    const DVec3 down = -first.normal;
    const Vec4 dim = color_at(first.centre, 0.0, light_at(first.centre, 0.0), phase_);
    for (uint32_t j = 0; j < stride_; j++)
        put_cut(first, down, circle_[j], 1.0, dim);
    put_cut(first, down, circle_[0], 0.0, dim);
}

// The end of the tip, once for each side: as high as the tip is wide, or level where it is cut.
void Emitter::put_apexes() {
    const DVec3 normal = last_.normal, x = last_.x, y = last_.y();
    const double per_side = 1.0 / sides_;
    const Vec4 color = color_at(last_.centre, length(), light_at(last_.centre, length()), phase_);
    const DVec3 apex = last_.centre + normal * (0.98 * last_.radius);
    for (uint32_t j = 0; j < sides_; j++) {
        if (tube_.cut) {
            put_cut(last_, normal, circle_[j], 0.0, color);
            continue;
        }
        const DVec2 between = 0.5 * (circle_[j] + circle_[j + 1]);
        const DVec3 tangent = glm::normalize(y * between.x - x * between.y);
        // A drawn-out point is lit like the wood below it.
        const DVec3 outward = tube_.point ? glm::normalize(x * between.x + y * between.y) : normal;
        put(apex, outward, tangent, per_side * (j + 0.5), b_.repeats_of(index_, last_.radius),
            length() + 1.2 * last_.radius, last_.radius, color);
    }
}

void Emitter::join() const {
    size_t at = tube_.first_index;
    const uint32_t base = static_cast<uint32_t>(tube_.first_vertex);
    const uint32_t rows = static_cast<uint32_t>(tube_.rows());
    const uint32_t apexes = base + rows * stride_ + static_cast<uint32_t>(tube_.caps());
    const uint32_t first_row = tube_.collar.rows ? 1 : 0;
    const auto join_rows = [&](uint32_t low, uint32_t high) {
        for (uint32_t j = 0; j < sides_; j++) {
            const uint32_t a = base + low * stride_ + j, b = a + 1, c = base + high * stride_ + j, d = c + 1;
            for (uint32_t corner : {a, b, d, a, d, c})
                mesh_.indices[at++] = corner;
        }
    };
    if (first_row) {
        join_rows(0, 2);
        join_rows(1, 3);
    }
    const uint32_t bark_rows = rows - (tube_.cut ? 1 : 0);
    for (uint32_t row = first_row ? 3 : 0; row + 1 < bark_rows; row++)
        join_rows(row, row + 1);
    for (uint32_t j = 0; j < sides_; j++) {
        const uint32_t a = base + (rows - 1) * stride_ + j;
        for (uint32_t corner : {a, a + 1, apexes + j})
            mesh_.indices[at++] = corner;
    }
    for (uint32_t j = 1; tube_.plug && j + 1 < sides_; j++)
        for (const uint32_t corner : {base, base + j + 1, base + j})
            mesh_.indices[at++] = corner;
    for (uint32_t j = 0; tube_.base && j < sides_; j++) {
        const uint32_t a = base + rows * stride_ + j;
        for (uint32_t corner : {a + 1, a, base + rows * stride_ + stride_})
            mesh_.indices[at++] = corner;
    }
}

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
    Emitter emitter(*this, index, mesh);
    emitter.put_collar();
    emitter.put_rings();
    emitter.put_tip();
    emitter.put_base();
    emitter.put_apexes();
    emitter.join();
}

}  // namespace treerec::tubes
