#include "scan/stems/round_stems.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "geometry/parallel.h"
#include "geometry/portable_math.h"
#include "geometry/quantile.h"
#include "geometry/random.h"

namespace treerec {

namespace {

// As shares of the tree's height.
constexpr double kSlice = 0.0125;       // thickness of a slice,
constexpr double kLeastSlice = 0.05;    // in metres at least
constexpr double kWidest = 1.0 / 30.0;  // radius: trees are 25 to 100 times as high as thick
constexpr double kThinnest = 1.0 / 500.0;
constexpr double kLatestStart = 0.4;
constexpr double kShortest = 0.12;
// The search for circles.
constexpr size_t kFewest = 12;  // points of a slice
constexpr int kTrials = 16;     // circles per point that they are tried through
constexpr size_t kKept = 2;     // circles of a slice, per stem
constexpr size_t kSeedsPerCheck = 256;
constexpr double kRow = 4.0;       // times the widest stem's radius: the depth of a row
constexpr double kCorners = 1.42;  // a circle about a square reaches so much further than it
constexpr int kSectors = 24;
constexpr int kLeastSectors = 6;        // a quarter of the bark is seen
constexpr double kMostInside = 0.15;    // of the points on the bark: a scanner sees none within wood
constexpr double kLeastContrast = 1.0;  // points on the bark, over those as far again outside
constexpr double kRoughShare = 0.06;  // of its radius: that points lie off the circle, besides the roughness
// The chains.
constexpr size_t kMissing = 4;        // slices in a row that may show no circle
constexpr double kMissed = 0.12;      // what each of them costs; a slice's circle brings its coverage
constexpr double kDrift = 0.25;       // sideways per metre up,
constexpr double kDriftShare = 0.25;  // and of the radius
constexpr double kThinner = 0.75, kThicker = 1.15;  // from ring to ring upwards
constexpr double kThickerAgain = 1.3;  // than it was below: from there on, circles go through leaves
constexpr size_t kFewestRings = 8;
constexpr double kLeastFilled = 0.5;  // of a stem's slices
// What grows around their feet: as shares of the height,
constexpr double kLowFoot = 0.05;    // where the lowest ring is of a stem that is seen from the ground up,
constexpr double kLowGrowth = 0.03;  // and how far it reaches up
constexpr double kFlare = 3.0;       // times the radius: as wide a stem's own foot is at most
constexpr double kBark = 0.015;      // metres: what lies so far outside is of the stem,
constexpr double kBarkShare = 0.12;  // and of its radius

struct Circle {
    DVec2 centre{0.0};
    double radius = 0.0;
    double coverage = 0.0;  // share of the sectors with bark
};

struct Slice {
    double y = 0.0;
    std::vector<Circle> circles;
};

double tolerance(double radius, double rough) {
    return rough + kRoughShare * radius;
}

bool circle_through(const DVec2& a, const DVec2& b, const DVec2& c, Circle& circle) {
    const DVec2 p = b - a, q = c - a;
    const double turn = 2.0 * (p.x * q.y - p.y * q.x);
    const double pp = glm::dot(p, p), qq = glm::dot(q, q);
    if (std::abs(turn) < 1e-3 * std::max(pp, qq)) return false;
    const DVec2 offset((q.y * pp - p.y * qq) / turn, (p.x * qq - q.x * pp) / turn);
    circle.centre = a + offset;
    circle.radius = glm::length(offset);
    return true;
}

// A slice's points where a wood is deep: in rows along x, so that few of them are looked at.
class Rows {
  public:
    // points: by rising x, which each row keeps. depth: of a row, metres.
    Rows(const std::vector<DVec2>& points, double depth) : depth_(depth) {
        low_ = points.front().y;
        double high = low_;
        for (const DVec2& p : points) {
            low_ = std::min(low_, p.y);
            high = std::max(high, p.y);
        }
        rows_.resize(static_cast<size_t>(std::min((high - low_) / depth_, kMostRows - 1.0)) + 1);
        for (const DVec2& p : points)
            rows_[row_at(p.y)].push_back(p);
    }

    // Calls body(points) for each row that reaches into the square about `centre`: those no further off along
    // x, by rising x.
    template <typename Body>
    void visit(const DVec2& centre, double reach, const Body& body) const {
        const auto less = [](const DVec2& p, double at) { return p.x < at; };
        for (size_t r = row_at(centre.y - reach); r <= row_at(centre.y + reach); r++) {
            const auto begin = std::lower_bound(rows_[r].begin(), rows_[r].end(), centre.x - reach, less);
            body(std::span(begin, std::lower_bound(begin, rows_[r].end(), centre.x + reach, less)));
        }
    }

    // The points no further than `reach` from the centre, in the order of the slice.
    void find(const DVec2& centre, double reach, std::vector<DVec2>& out) const {
        out.clear();
        visit(centre, reach, [&](std::span<const DVec2> row) {
            const auto before = static_cast<ptrdiff_t>(out.size());
            for (const DVec2& p : row) {
                const DVec2 d = p - centre;
                if (glm::dot(d, d) < reach * reach) out.push_back(p);
            }
            std::inplace_merge(
                out.begin(), out.begin() + before, out.end(),
                [](const DVec2& a, const DVec2& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
        });
    }

  private:
    static constexpr double kMostRows = 4096.0;

    size_t row_at(double y) const {
        const double row = (y - low_) / depth_;
        return row > 0.0 ? std::min(static_cast<size_t>(std::min(row, kMostRows)), rows_.size() - 1) : 0;
    }

    double depth_, low_;
    std::vector<std::vector<DVec2>> rows_;
};

double reach_of(const Circle& circle) {
    return 2.0 * circle.radius + 0.1;
}

// Whether bark is on the circle and nothing within; sets its coverage.
bool is_bark(const Rows& points, double rough, Circle& circle) {
    const double off = tolerance(circle.radius, rough);
    const auto square_of = [](double distance) { return distance > 0.0 ? distance * distance : 0.0; };
    const double inner = square_of(circle.radius - 2.0 * off), outer = square_of(circle.radius + 3.0 * off);
    const double low = square_of(circle.radius - off), high = square_of(circle.radius + off);
    // Most circles fail at these counts, and quickly.
    uint32_t on = 0, inside = 0, outside = 0;
    points.visit(circle.centre, reach_of(circle), [&](std::span<const DVec2> row) {
        for (const DVec2& p : row) {
            const DVec2 d = p - circle.centre;
            const double square = glm::dot(d, d);
            on += static_cast<uint32_t>(square >= low) & static_cast<uint32_t>(square <= high);
            inside += static_cast<uint32_t>(square < inner);
            outside += static_cast<uint32_t>(square > high) & static_cast<uint32_t>(square <= outer);
        }
    });
    if (on < kFewest || static_cast<double>(inside) > kMostInside * static_cast<double>(on)) return false;
    if (static_cast<double>(on) < kLeastContrast * static_cast<double>(outside)) return false;
    std::array<uint32_t, kSectors> sectors{};
    points.visit(circle.centre, reach_of(circle), [&](std::span<const DVec2> row) {
        for (const DVec2& p : row) {
            const DVec2 d = p - circle.centre;
            const double square = glm::dot(d, d);
            if (square < low || square > high || square == 0.0) continue;
            // Around a square instead of the circle: no sine is needed to count sectors.
            const double share = d.y / (std::abs(d.x) + std::abs(d.y));
            const double turn = (d.x >= 0.0 ? 1.0 + share : 3.0 - share) * 0.25 * kSectors;
            sectors[static_cast<size_t>(turn) % kSectors]++;
        }
    });
    // A sector counts where it holds a fair part of what one would, were the points spread evenly.
    const double fair = 0.25 * static_cast<double>(on) / kSectors;
    const auto covered = std::count_if(sectors.begin(), sectors.end(), [&](uint32_t n) { return n > fair; });
    circle.coverage = static_cast<double>(covered) / kSectors;
    return covered >= kLeastSectors;
}

// Least squares through the points on it (Kasa 1976).
void refine(std::span<const DVec2> points, double rough, Circle& circle) {
    for (int round = 0; round < 3; round++) {
        const double off = 1.5 * tolerance(circle.radius, rough);
        double n = 0.0, xx = 0.0, xy = 0.0, yy = 0.0, xs = 0.0, ys = 0.0, s = 0.0, x = 0.0, y = 0.0;
        for (const DVec2& p : points) {
            const DVec2 d = p - circle.centre;
            const double square = glm::dot(d, d);
            if (std::abs(std::sqrt(square) - circle.radius) > off) continue;
            n += 1.0, x += d.x, y += d.y, s += square;
            xx += d.x * d.x, xy += d.x * d.y, yy += d.y * d.y, xs += d.x * square, ys += d.y * square;
        }
        if (n < static_cast<double>(kFewest)) return;
        x /= n, y /= n, s /= n;
        xx = xx / n - x * x, xy = xy / n - x * y, yy = yy / n - y * y, xs = xs / n - x * s,
        ys = ys / n - y * s;
        const double area = xx * yy - xy * xy;
        if (!(area > 1e-12 * (xx + yy) * (xx + yy))) return;
        const DVec2 centre(0.5 * (xs * yy - ys * xy) / area, 0.5 * (ys * xx - xs * xy) / area);
        const double square = s - 2.0 * (centre.x * x + centre.y * y) + glm::dot(centre, centre);
        if (!(square > 0.0) || !(glm::length(centre) < circle.radius)) return;
        circle.centre += centre;
        circle.radius = std::sqrt(square);
    }
}

// By rising x. points: of a slice, likewise.
std::vector<Circle> find_circles(const std::vector<DVec2>& points, double thinnest, double widest,
                                 const RoundStemSearch& search, Random random, const Progress* progress) {
    std::vector<Circle> found;
    if (points.size() < kFewest) return found;
    const Rows rows(points, kRow * widest);
    const double range = portable::log(widest / thinnest);
    std::vector<DVec2> close;
    for (size_t seed = 0; seed < search.seeds * search.most; seed++) {
        if (progress && seed % kSeedsPerCheck == 0) progress->check();
        const DVec2 a = points[random.below(static_cast<uint32_t>(points.size()))];
        const double size = thinnest * portable::exp(random.uniform() * range);
        rows.find(a, 1.5 * size, close);
        if (close.size() < kFewest) continue;
        for (int trial = 0; trial < kTrials; trial++) {
            const auto count = static_cast<uint32_t>(close.size());
            const DVec2 b = close[random.below(count)], c = close[random.below(count)];
            Circle circle;
            if (!circle_through(a, b, c, circle) || circle.radius < thinnest ||
                circle.radius > std::min(widest, 1.2 * size))
                continue;
            // Most circles through leaves are known by one point more.
            const DVec2& d = close[random.below(count)];
            if (std::abs(glm::distance(d, circle.centre) - circle.radius) >
                tolerance(circle.radius, search.rough))
                continue;
            if (is_bark(rows, search.rough, circle)) found.push_back(circle);
        }
    }
    for (Circle& circle : found) {
        rows.find(circle.centre, kCorners * reach_of(circle), close);
        refine(close, search.rough, circle);
        if (circle.radius < thinnest || circle.radius > widest || !is_bark(rows, search.rough, circle))
            circle.coverage = 0.0;
    }
    std::erase_if(found, [](const Circle& c) { return c.coverage == 0.0; });
    std::stable_sort(found.begin(), found.end(),
                     [](const Circle& a, const Circle& b) { return a.coverage > b.coverage; });
    std::vector<Circle> kept;
    for (const Circle& circle : found) {
        const bool same = std::any_of(kept.begin(), kept.end(), [&](const Circle& other) {
            return glm::distance(circle.centre, other.centre) + std::abs(circle.radius - other.radius) <
                   0.3 * other.radius;
        });
        if (!same) kept.push_back(circle);
        if (kept.size() == kKept * search.most) break;
    }
    std::sort(kept.begin(), kept.end(), [](const Circle& a, const Circle& b) {
        return a.centre.x < b.centre.x || (a.centre.x == b.centre.x && a.centre.y < b.centre.y);
    });
    return kept;
}

// How far from each other the centres of a stem's circles may lie.
double most_drift(double radius, double rise) {
    return kDrift * rise + kDriftShare * radius;
}

// What it costs to go from one circle to another further up; nothing where no stem does.
std::optional<double> step_cost(const Circle& low, const Circle& high, double rise) {
    const double drift = glm::distance(low.centre, high.centre) / most_drift(low.radius, rise);
    const double growth = high.radius / low.radius;
    if (drift > 1.0 || growth < kThinner || growth > kThicker) return std::nullopt;
    return 0.1 * drift;
}

struct Chain {
    std::vector<std::pair<size_t, size_t>> rings;  // slice and circle, from below
    double score = 0.0;
};

// The chain of the largest score that begins low.
Chain best_chain(const std::vector<Slice>& slices, size_t latest) {
    struct State {
        double score = 0.0;
        ptrdiff_t slice = -1;  // that it comes from
        size_t circle = 0;
    };
    std::vector<std::vector<State>> states(slices.size());
    Chain best;
    std::pair<size_t, size_t> end;
    for (size_t i = 0; i < slices.size(); i++) {
        states[i].resize(slices[i].circles.size());
        for (size_t k = 0; k < slices[i].circles.size(); k++) {
            const Circle& circle = slices[i].circles[k];
            State& state = states[i][k];
            state.score = i <= latest ? 0.0 : -std::numeric_limits<double>::infinity();
            for (size_t j = i > kMissing + 1 ? i - kMissing - 1 : 0; j < i; j++) {
                const std::vector<Circle>& lower = slices[j].circles;
                const double rise = slices[i].y - slices[j].y;
                // A stem is hardly thicker below than kThinner says.
                const double reach = most_drift(circle.radius / kThinner, rise);
                auto l = std::lower_bound(lower.begin(), lower.end(), circle.centre.x - reach,
                                          [](const Circle& c, double x) { return c.centre.x < x; });
                for (; l != lower.end() && l->centre.x <= circle.centre.x + reach; ++l) {
                    const auto cost = step_cost(*l, circle, rise);
                    if (!cost) continue;
                    const auto at = static_cast<size_t>(l - lower.begin());
                    const double score =
                        states[j][at].score - *cost - kMissed * static_cast<double>(i - j - 1);
                    if (score > state.score) state = {score, static_cast<ptrdiff_t>(j), at};
                }
            }
            state.score += circle.coverage;
            if (state.score > best.score) {
                best.score = state.score;
                end = {i, k};
            }
        }
    }
    if (best.score <= 0.0) return best;
    for (auto at = end;;) {
        best.rings.push_back(at);
        const State& state = states[at.first][at.second];
        if (state.slice < 0) break;
        at = {static_cast<size_t>(state.slice), state.circle};
    }
    std::reverse(best.rings.begin(), best.rings.end());
    return best;
}

// The middle of its own and its neighbours' rings.
RoundStem smoothed(const RoundStem& stem) {
    RoundStem smooth = stem;
    for (size_t i = 1; i + 1 < stem.size(); i++) {
        const auto middle = [&](auto value) {
            std::array<double, 3> values{value(stem[i - 1]), value(stem[i]), value(stem[i + 1])};
            std::sort(values.begin(), values.end());
            return values[1];
        };
        smooth[i].centre = {middle([](const StemRing& r) { return r.centre.x; }),
                            middle([](const StemRing& r) { return r.centre.y; })};
        smooth[i].radius = middle([](const StemRing& r) { return r.radius; });
    }
    return smooth;
}

// Calls body(point, distance from the axis, radius there) for all points as high as a stem is seen.
template <typename Body>
void for_points_beside(const std::vector<Vec3>& points, const std::vector<RoundStem>& stems,
                       const Body& body) {
    for (const RoundStem& stem : stems) {
        const double end = 0.5 * (stem[1].y - stem[0].y);
        for (size_t i = 0; i < points.size(); i++) {
            const double y = points[i].y;
            if (y < stem.front().y - end || y > stem.back().y + end) continue;
            const auto above = std::lower_bound(stem.begin() + 1, stem.end() - 1, y,
                                                [](const StemRing& ring, double at) { return ring.y < at; });
            const StemRing &b = *above, &a = above[-1];
            const double t = std::clamp((y - a.y) / (b.y - a.y), 0.0, 1.0);
            const DVec2 centre = a.centre + (b.centre - a.centre) * t;
            body(i, glm::distance(DVec2(points[i].x, points[i].z), centre),
                 a.radius + (b.radius - a.radius) * t);
        }
    }
}

}  // namespace

std::vector<RoundStem> find_round_stems(const std::vector<Vec3>& points, const Progress* progress,
                                        const RoundStemSearch& search) {
    std::vector<RoundStem> stems;
    std::vector<float> heights;
    heights.reserve(points.size());
    for (const Vec3& p : points)
        heights.push_back(p.y);
    if (heights.empty()) return stems;
    const double low = quantile(heights, 0.001), high = quantile(heights, 0.999);
    const double height = high - low;
    if (!(height > 0.0)) return stems;
    const double thickness = std::clamp(kSlice * height, kLeastSlice, search.slice);
    const auto count = static_cast<size_t>(height / thickness) + 1;
    if (count > 4096) return stems;
    std::vector<std::vector<DVec2>> members(count);
    for (const Vec3& p : points) {
        const double slice = (p.y - low) / thickness;
        if (slice >= 0.0 && slice < static_cast<double>(count))
            members[static_cast<size_t>(slice)].emplace_back(p.x, p.z);
    }
    std::vector<Slice> slices(count);
    parallel_for(count, 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++) {
            if (progress) progress->check();
            slices[i].y = low + (static_cast<double>(i) + 0.5) * thickness;
            if (slices[i].y > low + search.highest * height) continue;
            std::vector<DVec2>& own = members[i];
            // Evenly from all sides: the points are in the order of cells.
            const size_t every = own.size() / (search.points * search.most) + 1;
            for (size_t k = 0; k * every < own.size(); k++)
                own[k] = own[k * every];
            own.resize((own.size() + every - 1) / every);
            std::sort(own.begin(), own.end(),
                      [](const DVec2& a, const DVec2& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
            slices[i].circles =
                find_circles(own, kThinnest * height, kWidest * height, search, Random(1, i), progress);
        }
    });
    const auto latest = static_cast<size_t>(kLatestStart * static_cast<double>(count));
    const size_t least =
        std::max(kFewestRings, static_cast<size_t>(kLeastFilled * kShortest * height / thickness));
    while (stems.size() < search.most) {
        if (progress) progress->check();
        const Chain chain = best_chain(slices, latest);
        if (chain.rings.size() < least) break;
        RoundStem stem;
        for (const auto& [slice, circle] : chain.rings) {
            const Circle& ring = slices[slice].circles[circle];
            stem.push_back({slices[slice].y, ring.centre, ring.radius});
        }
        // None of what lies on it is another one's.
        for (const StemRing& ring : stem) {
            Slice& slice = slices[static_cast<size_t>((ring.y - low) / thickness)];
            std::erase_if(slice.circles, [&](const Circle& c) {
                return glm::distance(c.centre, ring.centre) < c.radius + ring.radius;
            });
        }
        const double span = (stem.back().y - stem.front().y) / thickness + 1.0;
        if (span * thickness < kShortest * height || static_cast<double>(stem.size()) < kLeastFilled * span)
            continue;
        stem = smoothed(stem);
        double least_radius = stem.front().radius;
        const auto end = std::find_if(stem.begin(), stem.end(), [&](const StemRing& ring) {
            least_radius = std::min(least_radius, ring.radius);
            return ring.radius > kThickerAgain * least_radius;
        });
        stem.erase(end, stem.end());
        if (stem.size() >= least) stems.push_back(std::move(stem));
    }
    std::stable_sort(stems.begin(), stems.end(), [](const RoundStem& a, const RoundStem& b) {
        return a.front().radius > b.front().radius;
    });
    return stems;
}

std::vector<uint8_t> points_on_stems(const std::vector<Vec3>& points, const std::vector<RoundStem>& stems) {
    std::vector<uint8_t> on(points.size(), 0);
    for_points_beside(points, stems, [&](size_t i, double distance, double radius) {
        if (distance < radius * (1.0 + kBarkShare) + kBark) on[i] = 1;
    });
    return on;
}

double spread_on_stems(const std::vector<Vec3>& points, const std::vector<RoundStem>& stems, double most) {
    std::vector<float> off;
    for_points_beside(points, stems, [&](size_t, double distance, double radius) {
        const double away = std::abs(distance - radius);
        if (away <= most) off.push_back(static_cast<float>(away));
    });
    return off.empty() ? 0.0 : quantile(off, 0.5);
}

std::vector<uint8_t> points_around_feet(const std::vector<Vec3>& points,
                                        const std::vector<RoundStem>& stems) {
    std::vector<uint8_t> around(points.size(), 0);
    if (points.empty() || stems.empty()) return around;
    std::vector<float> heights;
    for (const Vec3& p : points)
        heights.push_back(p.y);
    const double low = quantile(heights, 0.001), height = quantile(heights, 0.999) - low;
    double ground = std::numeric_limits<double>::max();
    for (const RoundStem& stem : stems)
        ground = std::min(ground, stem.front().y);
    if (ground > low + kLowFoot * height) return around;
    for (size_t i = 0; i < points.size(); i++) {
        if (points[i].y > ground + kLowGrowth * height) continue;
        const DVec2 at(points[i].x, points[i].z);
        around[i] = std::none_of(stems.begin(), stems.end(), [&](const RoundStem& stem) {
            return glm::distance(at, stem.front().centre) < kFlare * stem.front().radius;
        });
    }
    return around;
}

}  // namespace treerec
