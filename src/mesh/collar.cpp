#include "mesh/collar.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/portable_math.h"
#include "mesh/polygon.h"

namespace treerec {

namespace {

constexpr size_t kMostRings = 24;    // that the branch may need to come out of the bark
constexpr double kUp = 0.9;          // how far the web reaches up the branch, over its radius,
constexpr double kDown = 0.8;        // and down onto the parent's bark,
constexpr double kLengthwise = 0.6;  // and more than that along the parent's axis, as its fibres do
constexpr double kMostDown = 0.45;   // of the parent's radius
constexpr double kSteepest = 2.5;    // how much longer the web is where the branch leaves flat
constexpr double kSink = 0.01;       // of the parent's radius: how deep the base lies in its bark
constexpr double kLeastUp = 0.25;    // of the branch's radius; shorter webs are none
constexpr double kMostOfBranch = 0.6;
constexpr double kThickRadius = 0.02;  // metres: from here on the web has a row more

// A place beside a tube.
struct BarkPlace {
    DVec3 centre;    // on the axis
    DVec3 radial;    // unit, from there
    DVec3 side;      // unit, the way in which corners follow each other
    DVec3 normal;    // of the bark, smooth
    double corner;   // 0 .. sides
    double surface;  // metres from the axis to the prism's face
    double height;   // metres above that
    double along;
    double radius;
    double shown;  // the radius that the bark's picture goes around by
    bool beyond;   // past either end
};

// Between which two rings p lies, and where between them.
struct Between {
    size_t span;
    double t;
    bool beyond;
};

Between find_span(const TubeShape& tube, const DVec3& p, size_t span) {
    span = std::min(span, tube.count - 2);
    int way = 0;
    while (true) {
        const Ring &low = tube.rings[span], &high = tube.rings[span + 1];
        const double above = glm::dot(p - low.centre, low.normal);
        const double below = glm::dot(high.centre - p, high.normal);
        if (above < 0.0 && below >= 0.0 && span > 0 && way <= 0) {
            span--;
            way = -1;
            continue;
        }
        if (below < 0.0 && above >= 0.0 && span + 2 < tube.count && way >= 0) {
            span++;
            way = 1;
            continue;
        }
        const double sum = std::max(above, 0.0) + std::max(below, 0.0);
        return {span, sum > 0.0 ? std::max(above, 0.0) / sum : 0.5,
                (above < 0.0 && span == 0) || (below < 0.0 && span + 2 == tube.count)};
    }
}

BarkPlace locate(const TubeShape& tube, const DVec3& p, size_t& hint);

// As if the tube were round where nothing else was measured: quick, and right to a few hundredths of its
// radius.
double rough_height(const TubeShape& tube, const DVec3& p, size_t& hint) {
    if (tube.section->is_measured()) {
        const BarkPlace place = locate(tube, p, hint);
        return place.beyond ? HUGE_VAL : place.height;
    }
    const Between at = find_span(tube, p, hint);
    hint = at.span;
    if (at.beyond) return HUGE_VAL;
    const Ring &low = tube.rings[at.span], &high = tube.rings[at.span + 1];
    const double flat = 0.5 + 0.5 * polygon_flat(tube.sides);
    return glm::distance(p, glm::mix(low.centre, high.centre, at.t)) -
           flat * (low.radius + (high.radius - low.radius) * at.t);
}

BarkPlace locate(const TubeShape& tube, const DVec3& p, size_t& hint) {
    const Between at = find_span(tube, p, hint);
    hint = at.span;
    const Ring &low = tube.rings[at.span], &high = tube.rings[at.span + 1];
    BarkPlace place;
    place.beyond = at.beyond;
    place.centre = glm::mix(low.centre, high.centre, at.t);
    place.radius = low.radius + (high.radius - low.radius) * at.t;
    place.shown = place.radius * (low.stretch + (high.stretch - low.stretch) * at.t);
    place.along = low.along + (high.along - low.along) * at.t;
    const DVec3 axis = normalized_or(glm::mix(low.normal, high.normal, at.t), low.normal);
    const DVec3 mixed = glm::mix(low.x, high.x, at.t);
    const DVec3 x = normalized_or(mixed - axis * glm::dot(mixed, axis), low.x);
    const DVec3 y = glm::cross(axis, x);
    const DVec3 from = p - place.centre;
    const double a = glm::dot(from, x), b = glm::dot(from, y);
    const double out = portable::hypot(a, b);
    const double c = out > 0.0 ? a / out : 1.0, s = out > 0.0 ? b / out : 0.0;
    place.radial = x * c + y * s;
    place.side = y * c - x * s;
    const double step = 2.0 * kPi / tube.sides;
    double angle = portable::atan2(s, c);
    if (angle < 0.0) angle += 2.0 * kPi;
    place.corner = std::min(angle / step, static_cast<double>(tube.sides));
    const double within = angle - step * std::floor(place.corner);
    const auto corner = [&](double index) {
        const double turned = index * step;
        return glm::mix(low.radius * tube.section->factor(low.along, turned),
                        high.radius * tube.section->factor(high.along, turned), at.t);
    };
    // The straight side between two corners.
    const double one = corner(std::floor(place.corner)), other = corner(std::floor(place.corner) + 1.0);
    place.surface = one * other * portable::sin(step) /
                    (one * portable::sin(within) + other * portable::sin(step - within));
    place.height = out - place.surface;
    const double slope = ring_slope(tube.rings, tube.count, at.span) * (1.0 - at.t) +
                         ring_slope(tube.rings, tube.count, at.span + 1) * at.t;
    const double factor = tube.section->factor(place.along, angle);
    const double rise = slope * factor + place.radius * tube.section->rise(place.along, angle);
    place.normal = glm::normalize(place.radial - axis * rise -
                                  place.side * (tube.section->turn(place.along, angle) / factor));
    return place;
}

// One line of a branch's tube, from corner to corner, and where it comes out of the parent's bark.
struct Generator {
    DVec3 crossing, top, base;
    DVec3 way;            // unit, up the branch at the crossing
    double exit;          // metres along
    double end;           // metres along: where the web ends
    BarkPlace at;         // the base's
    size_t span;          // of the host, where that is
    DVec3 outward, side;  // of the branch, at the end of the web
    DVec3 bark;           // the parent's normal at the crossing,
    double host_radius;   // and its radius there
};

class CollarMaker {
  public:
    CollarMaker(const TubeShape& branch, const TubeShape& host, size_t host_span, bool fine)
        : branch_(branch), host_(host), span_(host_span), fine_(fine), circle_(polygon(branch.sides)) {}

    Collar make(std::vector<CollarVertex>& out) {
        for (uint32_t j = 0; j < branch_.sides; j++)
            if (!find_exit(j)) return {};
        if (!reach_up()) return {};
        for (uint32_t j = 0; j < branch_.sides; j++)
            if (!set_base(j)) return {};
        if (!hide_base()) return {};
        find_middle();
        return write(out);
    }

  private:
    DVec3 radial(size_t ring, uint32_t corner) const {
        const Ring& r = branch_.rings[ring];
        return r.x * circle_[corner].x + r.y() * circle_[corner].y;
    }
    DVec3 corner(size_t ring, uint32_t index) const {
        return branch_.rings[ring].centre + radial(ring, index) * branch_.rings[ring].radius;
    }
    // The ring below `along` (never the last).
    size_t below(double along) const {
        size_t ring = 0;
        while (ring + 2 < branch_.count && branch_.rings[ring + 1].along <= along)
            ring++;
        return ring;
    }
    double share_of(size_t ring, double along) const {
        const Ring &low = branch_.rings[ring], &high = branch_.rings[ring + 1];
        return std::clamp((along - low.along) / std::max(high.along - low.along, 1e-30), 0.0, 1.0);
    }
    double radius_at(double along) const {
        const size_t ring = below(along);
        const double t = share_of(ring, along);
        return branch_.rings[ring].radius * (1.0 - t) + branch_.rings[ring + 1].radius * t;
    }
    // The radius that the bark's picture goes around by.
    double shown_at(double along) const {
        const size_t ring = below(along);
        const Ring &low = branch_.rings[ring], &high = branch_.rings[ring + 1];
        const double t = share_of(ring, along);
        return low.radius * low.stretch * (1.0 - t) + high.radius * high.stretch * t;
    }
    DVec3 point_at(uint32_t index, double along) const {
        const size_t ring = below(along);
        return glm::mix(corner(ring, index), corner(ring + 1, index), share_of(ring, along));
    }
    DVec3 outward_at(uint32_t index, double along) const {
        const size_t ring = below(along);
        const double t = share_of(ring, along);
        const auto at = [&](size_t i) {
            return radial(i, index) - branch_.rings[i].normal * ring_slope(branch_.rings, branch_.count, i);
        };
        return normalized_or(glm::mix(at(ring), at(ring + 1), t), radial(ring, index));
    }
    DVec3 side_at(uint32_t index, double along) const {
        const size_t ring = below(along);
        const Ring& r = branch_.rings[share_of(ring, along) < 0.5 ? ring : ring + 1];
        return r.y() * circle_[index].x - r.x * circle_[index].y;
    }

    bool find_exit(uint32_t index);
    bool reach_up();
    bool set_base(uint32_t index);
    bool hide_base();
    void find_middle();
    void web(uint32_t index, double share, double row_radius, CollarVertex& vertex) const;
    void dress_as_host(CollarVertex& vertex, const BarkPlace& at) const;
    Collar write(std::vector<CollarVertex>& out) const;

    const TubeShape branch_;
    const TubeShape host_;
    size_t span_;
    const bool fine_;
    double middle_ = 0.0;  // of the host's corners: where the branch's axis comes out
    const DVec2* const circle_;
    std::array<Generator, kMostSides> lines_;
};

bool CollarMaker::find_exit(uint32_t index) {
    size_t hint = span_;
    DVec3 inside = corner(0, index);
    double low = rough_height(host_, inside, hint);
    if (!(low < 0.0)) return false;
    for (size_t ring = 1; ring < std::min(branch_.count, kMostRings); ring++) {
        const DVec3 next = corner(ring, index);
        double high = rough_height(host_, next, hint);
        if (high == HUGE_VAL) return false;
        if (high <= 0.0) {
            low = high;
            inside = next;
            continue;
        }
        // By false position, halving the weight of an end that stays (the Illinois rule).
        double a = 0.0, b = 1.0, t = 0.0;
        int kept = 0;
        for (int i = 0; i < 4; i++) {
            t = (a * high - b * low) / (high - low);
            const double there = rough_height(host_, glm::mix(inside, next, t), hint);
            if (there == HUGE_VAL) return false;
            if (there > 0.0) {
                b = t;
                high = there;
                if (kept == 1) low *= 0.5;
                kept = 1;
            } else {
                a = t;
                low = there;
                if (kept == -1) high *= 0.5;
                kept = -1;
            }
        }
        Generator& line = lines_[index];
        line.crossing = glm::mix(inside, next, t);
        line.way = normalized_or(next - inside, branch_.rings[ring].normal);
        const Ring &before = branch_.rings[ring - 1], &after = branch_.rings[ring];
        line.exit = before.along + (after.along - before.along) * t;
        const Between at = find_span(host_, line.crossing, hint);
        const Ring &under = host_.rings[at.span], &over = host_.rings[at.span + 1];
        line.host_radius = under.radius + (over.radius - under.radius) * at.t;
        const DVec3 centre = glm::mix(under.centre, over.centre, at.t);
        const double slope = (over.radius - under.radius) / std::max(over.along - under.along, 1e-30);
        const DVec3 radial = normalized_or(line.crossing - centre, under.x);
        line.bark = normalized_or(radial - under.normal * std::clamp(slope, -1.0, 1.0), radial);
        return true;
    }
    return false;
}

bool CollarMaker::reach_up() {
    const double length = branch_.rings[branch_.count - 1].along;
    for (uint32_t j = 0; j < branch_.sides; j++) {
        Generator& line = lines_[j];
        const double own = radius_at(line.exit);
        const double steep = std::max(glm::dot(line.way, line.bark), 0.0);
        const double wanted = kUp * own * std::min(0.5 + 0.35 / std::max(steep, 0.05), kSteepest);
        const double up = std::min(wanted, kMostOfBranch * length - line.exit);
        if (up < kLeastUp * own) return false;
        line.end = line.exit + up;
        line.top = point_at(j, line.end);
        line.outward = outward_at(j, line.end);
        line.side = side_at(j, line.end);
    }
    return true;
}

bool CollarMaker::set_base(uint32_t index) {
    Generator& line = lines_[index];
    const double own = radius_at(line.exit);
    const DVec3 axis = host_.rings[std::min(span_, host_.count - 2)].normal;
    DVec3 away = outward_at(index, line.exit);
    away -= line.bark * glm::dot(away, line.bark);
    const double length = glm::length(away);
    if (length < 0.05) return false;
    away /= length;
    size_t hint = span_;
    double down = kDown * own * (1.0 + kLengthwise * std::abs(glm::dot(away, axis)));
    down = std::min(down, kMostDown * line.host_radius);
    for (int attempt = 0; attempt < 3; attempt++, down *= 0.5) {
        line.at = locate(host_, line.crossing + away * down, hint);
        if (line.at.beyond) continue;
        line.span = hint;
        line.base = line.at.centre + line.at.radial * (line.at.surface - kSink * line.at.radius);
        return true;
    }
    return false;
}

// Where the parent bends, the straight way between two corners may leave its bark: they go deeper then.
bool CollarMaker::hide_base() {
    for (int pass = 0; pass < 4; pass++) {
        bool hidden = true;
        for (uint32_t j = 0; j < branch_.sides; j++) {
            Generator &one = lines_[j], &other = lines_[(j + 1) % branch_.sides];
            if (one.span == other.span) continue;  // one frustum is convex
            size_t hint = span_;
            const BarkPlace between = locate(host_, 0.5 * (one.base + other.base), hint);
            if (between.beyond) return false;
            const double above = between.height + 0.2 * kSink * between.radius;
            if (above <= 0.0) continue;
            hidden = false;
            for (Generator* line : {&one, &other})
                line->base -= line->at.radial * (above + 0.5 * kSink * between.radius);
        }
        if (hidden) return true;
    }
    return false;
}

void CollarMaker::find_middle() {
    DVec3 sum(0.0);
    for (uint32_t j = 0; j < branch_.sides; j++)
        sum += lines_[j].crossing;
    size_t hint = span_;
    middle_ = locate(host_, sum / static_cast<double>(branch_.sides), hint).corner;
}

// On the curve from the base over the crossing to the top, tangent to both barks; share: 0 .. 1 along it.
void CollarMaker::web(uint32_t index, double share, double row_radius, CollarVertex& vertex) const {
    const Generator& line = lines_[index];
    const double a = (1.0 - share) * (1.0 - share), b = 2.0 * share * (1.0 - share), c = share * share;
    vertex.position = line.base * a + line.crossing * b + line.top * c;
    const DVec3& own = line.outward;
    DVec3 normal = line.at.normal * (1.0 - share) + own * share;
    if (share > 0.0 && share < 1.0) {
        const DVec3 way = normalized_or(
            (line.crossing - line.base) * (1.0 - share) + (line.top - line.crossing) * share, DVec3(0.0));
        normal -= way * glm::dot(normal, way);
    }
    vertex.normal = normalized_or(normal, own);
    const DVec3& side = line.side;
    vertex.tangent = normalized_or(side - vertex.normal * glm::dot(side, vertex.normal), side);
    vertex.around = static_cast<double>(index) / branch_.sides;
    const double up = glm::distance(vertex.position, line.top);
    vertex.v = line.end - up;
    vertex.along = std::max(vertex.v, 0.0);
    vertex.radius = row_radius;
    vertex.own = share;
    vertex.host_centre = line.at.centre;
    vertex.host_along = line.at.along;
}

// The parent's picture, where it would be if the parent's bark went on up to there.
void CollarMaker::dress_as_host(CollarVertex& vertex, const BarkPlace& at) const {
    vertex.tangent = normalized_or(at.side - vertex.normal * glm::dot(at.side, vertex.normal), at.side);
    // Not across the parent's seam: on either side of it the picture goes on from the branch's middle.
    const double rounds = at.corner / host_.sides;
    vertex.around = rounds + std::round(middle_ / host_.sides - rounds);
    vertex.radius = at.shown;
    vertex.v = at.along;
}

Collar CollarMaker::write(std::vector<CollarVertex>& out) const {
    double first = HUGE_VAL, last = 0.0, own = 0.0, shown = 0.0;
    for (uint32_t j = 0; j < branch_.sides; j++) {
        const Generator& line = lines_[j];
        first = std::min(first, line.end);
        last = std::max(last, line.end);
        own += radius_at(line.end) / branch_.sides;
        shown += shown_at(line.end) / branch_.sides;
    }
    const double gap = 0.25 * own;
    Collar collar;
    while (collar.next_ring < branch_.count && branch_.rings[collar.next_ring].along < last + gap)
        collar.next_ring++;
    if (collar.next_ring == branch_.count) return {};
    const double until = branch_.rings[collar.next_ring].along;
    // Rings that the web's slant top has taken the place of, slant too.
    uint32_t slant = 0;
    for (size_t i = 0; i < collar.next_ring; i++)
        slant += branch_.rings[i].along > first + gap && branch_.rings[i].along < until - gap;
    slant = std::min(slant, fine_ ? 3u : 1u);
    const uint32_t sides = branch_.sides, stride = sides + 1;
    const bool thick = fine_ && own > kThickRadius;
    const size_t room = out.size() + size_t{stride} * ((thick ? 5 : 4) + slant);
    if (out.capacity() < room) out.reserve(std::max(room, 2 * out.capacity()));
    // The next row; its last column is the first one, a round further.
    const auto row = [&](bool as_host, const auto& put) {
        const size_t first = out.size();
        out.resize(first + stride);
        for (uint32_t j = 0; j < sides; j++)
            put(j, out[first + j]);
        out.back() = out[first];
        if (!as_host) out.back().around = 1.0;
        collar.rows++;
    };
    // As wide as it becomes, the picture does not become: it would wind about the branch.
    const auto web_row = [&](double share) {
        row(false, [&](uint32_t j, CollarVertex& vertex) { web(j, share, shown, vertex); });
    };
    row(true, [&](uint32_t j, CollarVertex& vertex) {
        web(j, 0.0, shown, vertex);
        dress_as_host(vertex, lines_[j].at);
    });
    web_row(thick ? 1.0 / 3.0 : 0.5);  // where the picture changes
    size_t hint = span_;
    row(true, [&](uint32_t j, CollarVertex& vertex) {
        vertex = out[out.size() - 2 * stride + j];
        dress_as_host(vertex, locate(host_, vertex.position, hint));
    });
    if (thick) web_row(2.0 / 3.0);
    web_row(1.0);
    for (uint32_t i = 1; i <= slant; i++) {
        const double share = static_cast<double>(i) / (slant + 1);
        double radius = 0.0;
        for (uint32_t j = 0; j < sides; j++)
            radius += shown_at(lines_[j].end + (until - lines_[j].end) * share) / sides;
        row(false, [&](uint32_t j, CollarVertex& vertex) {
            const double along = lines_[j].end + (until - lines_[j].end) * share;
            web(j, 1.0, radius, vertex);
            vertex.position = point_at(j, along);
            vertex.normal = outward_at(j, along);
            const DVec3 side = side_at(j, along);
            vertex.tangent =
                normalized_or(side - vertex.normal * glm::dot(side, vertex.normal), vertex.tangent);
            vertex.v = vertex.along = along;
        });
    }
    return collar;
}

}  // namespace

Collar make_collar(const TubeShape& branch, const TubeShape& host, size_t host_span, bool fine,
                   std::vector<CollarVertex>& out) {
    if (branch.count < 2 || host.count < 2) return {};
    return CollarMaker(branch, host, host_span, fine).make(out);
}

}  // namespace treerec
