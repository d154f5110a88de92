#include "geometry/circle_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace treerec {

namespace {

constexpr size_t kMostPoints = 128;  // looked at; of more, every so-manieth
constexpr size_t kScored = 32;       // points looked at per sample
constexpr int kSamples = 16;
constexpr int kFirstSamples = 8;      // when there is still nothing near a circle, there is none
constexpr float kHopeless = 0.35f;    // median residual over radius: not worth refining
constexpr float kGoodEnough = 0.02f;  // likewise: no better sample is looked for
constexpr int kRefinements = 6;
constexpr float kSettled = 1e-3f;           // step over radius
constexpr double kLeastDeterminant = 1e-6;  // over the diagonal's: with less, sums of floats are too coarse
constexpr float kOnCircle = 0.3f;           // residual over radius
constexpr float kWellInside = 0.7f;         // distance over radius
constexpr int kRingSteps = 6;
constexpr float kRingInside = 0.4f;
constexpr int kSectors = 16;
constexpr int kLeastFilled = 10;  // sectors: with fewer, a ring is open
constexpr float kTukey = 4.685f;  // 95 % efficiency for normal noise
constexpr float kMadToSigma = 1.4826f;
constexpr float kTanEighth = 0.41421356f;  // of 22.5 degrees
constexpr size_t kLanes = 4;               // points that go through the processor at a time
constexpr float kTiny = 1e-9f;             // metres
constexpr float kNowhere = 1e6f;           // metres: so far from a circle, a point has no weight

// The points, relative to their mean, in single precision: coordinates of a branch's section are a few
// decimetres, so this resolves a tenth of a micrometre, and four go through the processor at a time.
struct Section {
    size_t count = 0;
    DVec2 mean{0.0};
    alignas(16) std::array<float, kMostPoints> x;
    alignas(16) std::array<float, kMostPoints> y;
    alignas(16) std::array<float, kMostPoints> residual;

    explicit Section(std::span<const DVec2> points) {
        const size_t stride = (points.size() + kMostPoints - 1) / kMostPoints;
        for (size_t i = 0; i < points.size(); i += stride) {
            mean += points[i];
            count++;
        }
        mean /= static_cast<double>(count);
        for (size_t i = 0, n = 0; i < points.size(); i += stride, n++) {
            x[n] = static_cast<float>(points[i].x - mean.x);
            y[n] = static_cast<float>(points[i].y - mean.y);
        }
        for (size_t n = count; n % kLanes != 0; n++)
            x[n] = y[n] = kNowhere;
    }

    // Fills residual[0 .. end) with the distances of the points from the circle.
    void measure(float cx, float cy, float radius) {
        for (size_t i = 0; i < count; i++) {
            const float dx = x[i] - cx;
            const float dy = y[i] - cy;
            residual[i] = std::abs(std::sqrt(dx * dx + dy * dy) - radius);
        }
    }

    // Of the first `size` residuals; reorders them.
    float median(size_t size) {
        const auto middle = residual.begin() + static_cast<ptrdiff_t>(size / 2);
        std::nth_element(residual.begin(), middle, residual.begin() + static_cast<ptrdiff_t>(size));
        return *middle;
    }
};

// Fixed-size excerpt for scoring samples: a constant loop count lets the compiler use vector instructions.
struct Excerpt {
    alignas(16) std::array<float, kScored> x;
    alignas(16) std::array<float, kScored> y;

    explicit Excerpt(const Section& section) {
        for (size_t i = 0; i < kScored; i++) {
            const size_t from = i * section.count / kScored;
            x[i] = section.x[from];
            y[i] = section.y[from];
        }
    }

    // Whether the median residual is below `limit`, and then what it is. Most samples are worse than the best
    // one so far, and to see that takes counting alone.
    bool beats(float cx, float cy, float radius, float limit, float& median) const {
        const float inner = std::max(0.0f, radius - limit);
        const float outer = radius + limit;
        const float least = limit < radius ? inner * inner : -1.0f;
        const float most = outer * outer;
        int32_t below = 0;
        for (size_t i = 0; i < kScored; i++) {
            const float dx = x[i] - cx;
            const float dy = y[i] - cy;
            const float square = dx * dx + dy * dy;
            below += static_cast<int32_t>(square > least) & static_cast<int32_t>(square < most);
        }
        if (below <= static_cast<int32_t>(kScored / 2)) return false;
        std::array<float, kScored> residual;
        for (size_t i = 0; i < kScored; i++) {
            const float dx = x[i] - cx;
            const float dy = y[i] - cy;
            residual[i] = std::abs(std::sqrt(dx * dx + dy * dy) - radius);
        }
        std::nth_element(residual.begin(), residual.begin() + kScored / 2, residual.end());
        median = residual[kScored / 2];
        return true;
    }
};

struct Circle {
    float x = 0.0f;
    float y = 0.0f;
    float radius = 0.0f;
    float spread = 0.0f;
    // The radius' standard error over the points'.
    float error = std::numeric_limits<float>::max();
};

bool circle_through(const Section& s, size_t i, size_t j, size_t k, Circle& circle) {
    const float ux = s.x[j] - s.x[i];
    const float uy = s.y[j] - s.y[i];
    const float vx = s.x[k] - s.x[i];
    const float vy = s.y[k] - s.y[i];
    const float cross = ux * vy - uy * vx;
    const float uu = ux * ux + uy * uy;
    const float vv = vx * vx + vy * vy;
    if (!(std::abs(cross) > 1e-6f * (uu + vv))) return false;
    const float ox = (vy * uu - uy * vv) / (2.0f * cross);
    const float oy = (ux * vv - vx * uu) / (2.0f * cross);
    circle.x = s.x[i] + ox;
    circle.y = s.y[i] + oy;
    circle.radius = std::sqrt(ox * ox + oy * oy);
    return true;
}

// The best of some three-point circles.
bool sample_circles(const Section& section, float max_radius, Random& random, Circle& best) {
    const Excerpt excerpt(section);
    const uint32_t count = static_cast<uint32_t>(section.count);
    bool found = false;
    for (int sample = 0; sample < kSamples; sample++) {
        if (sample == kFirstSamples && !found) return false;
        const uint32_t i = random.below(count);
        const uint32_t j = random.below(count);
        const uint32_t k = random.below(count);
        if (i == j || j == k || i == k) continue;
        Circle trial;
        if (!circle_through(section, i, j, k, trial) || trial.radius > max_radius) continue;
        const float limit = found ? best.spread : kHopeless * trial.radius;
        if (!excerpt.beats(trial.x, trial.y, trial.radius, limit, trial.spread)) continue;
        best = trial;
        found = true;
        if (best.spread < kGoodEnough * best.radius) break;
    }
    return found;
}

// The sums of Gauss-Newton's normal equations, each in four parts: one for every fourth point.
struct Normal {
    using Four = float __attribute__((vector_size(16)));
    Four xx{}, xy{}, yy{}, x{}, y{}, w{}, rx{}, ry{}, r{};

    Normal(const Section& section, const Circle& circle, float scale) {
        alignas(16) std::array<float, kMostPoints> nx, ny, weight, residual;
        const size_t count = (section.count + kLanes - 1) / kLanes * kLanes;
        for (size_t i = 0; i < count; i++) {
            const float dx = section.x[i] - circle.x;
            const float dy = section.y[i] - circle.y;
            const float distance = std::sqrt(dx * dx + dy * dy);
            const float inverse = 1.0f / (distance + kTiny);
            nx[i] = dx * inverse;
            ny[i] = dy * inverse;
            residual[i] = distance - circle.radius;
            const float t = residual[i] * scale;
            const float near = 1.0f - t * t;
            const float inside = 0.5f * (near + std::abs(near));  // not below 0
            weight[i] = inside * inside;
        }
        for (size_t i = 0; i < count; i += kLanes) {
            const Four a = four_of(nx, i), b = four_of(ny, i), c = four_of(weight, i);
            const Four wa = c * a, wb = c * b, wr = c * four_of(residual, i);
            xx += wa * a;
            xy += wa * b;
            yy += wb * b;
            x += wa;
            y += wb;
            w += c;
            rx += wr * a;
            ry += wr * b;
            r += wr;
        }
    }

    static Four four_of(const std::array<float, kMostPoints>& values, size_t at) {
        Four four;
        std::memcpy(&four, &values[at], sizeof(four));
        return four;
    }
};

double sum_of(const Normal::Four& four) {
    return (static_cast<double>(four[0]) + four[1]) + (static_cast<double>(four[2]) + four[3]);
}

// Gauss-Newton on the geometric residuals with Tukey's weights.
void refine_circle(Section& section, float max_radius, Circle& circle) {
    const auto noise = [&](float spread) { return kMadToSigma * spread + 1e-6f * circle.radius + 1e-9f; };
    float sigma = noise(circle.spread);
    for (int round = 0; round < kRefinements; round++) {
        if (round == 1 || round == 3) {
            section.measure(circle.x, circle.y, circle.radius);
            sigma = noise(section.median(section.count));
        }
        const float scale = 1.0f / (kTukey * sigma);
        const Normal normal(section, circle, scale);
        const double xx = sum_of(normal.xx), xy = sum_of(normal.xy), yy = sum_of(normal.yy);
        const double x = sum_of(normal.x), y = sum_of(normal.y), w = sum_of(normal.w);
        const double rx = sum_of(normal.rx), ry = sum_of(normal.ry), r = sum_of(normal.r);
        // The symmetric 3x3 system by Cramer's rule.
        const double a = yy * w - y * y;
        const double b = x * y - xy * w;
        const double c = xy * y - yy * x;
        const double det = xx * a + xy * b + x * c;
        if (!(det > kLeastDeterminant * xx * yy * w)) return;
        circle.error = static_cast<float>(std::sqrt((xx * yy - xy * xy) / det));
        const double sx = (rx * a + ry * b + r * c) / det;
        const double sy = (rx * b + ry * (xx * w - x * x) + r * (x * xy - xx * y)) / det;
        const double sr = (rx * c + ry * (xy * x - xx * y) + r * (xx * yy - xy * xy)) / det;
        const float radius = circle.radius + static_cast<float>(sr);
        if (!(radius > 0.0f) || radius > max_radius) return;
        circle.x += static_cast<float>(sx);
        circle.y += static_cast<float>(sy);
        circle.radius = radius;
        if (sx * sx + sy * sy + sr * sr < kSettled * kSettled * radius * radius) return;
    }
}

// Of 16 equal sectors, without trigonometry: two signs, the greater coordinate, and the half of the octant.
int sector_of(float x, float y) {
    const float ax = std::abs(x);
    const float ay = std::abs(y);
    const bool steep = ay > ax;
    const bool outer = std::min(ax, ay) > kTanEighth * std::max(ax, ay);
    return (x < 0.0f ? 8 : 0) | (y < 0.0f ? 4 : 0) | (steep ? 2 : 0) | (outer ? 1 : 0);
}

}  // namespace

std::optional<CircleFit> fit_circle(std::span<const DVec2> points, double max_radius, Random random) {
    if (points.size() < 5) return std::nullopt;
    Section section(points);
    const float most = static_cast<float>(max_radius);
    Circle circle;
    if (!sample_circles(section, most, random, circle)) return std::nullopt;
    refine_circle(section, most, circle);

    CircleFit fit;
    fit.centre = section.mean + DVec2(circle.x, circle.y);
    fit.radius = circle.radius;
    std::array<bool, kSectors> hit{};
    size_t inside = 0;
    section.measure(circle.x, circle.y, circle.radius);
    for (size_t i = 0; i < section.count; i++) {
        const float dx = section.x[i] - circle.x;
        const float dy = section.y[i] - circle.y;
        if (section.residual[i] <= kOnCircle * circle.radius) hit[sector_of(dx, dy)] = true;
        if (dx * dx + dy * dy < kWellInside * kWellInside * circle.radius * circle.radius) inside++;
    }
    fit.spread = section.median(section.count);
    fit.error = static_cast<double>(kMadToSigma) * fit.spread * circle.error;
    fit.inside = static_cast<double>(inside) / static_cast<double>(section.count);
    fit.coverage = static_cast<double>(std::count(hit.begin(), hit.end(), true)) / kSectors;
    return fit;
}

std::optional<CircleFit> fit_ring(std::span<const DVec2> points) {
    if (points.size() < kSectors) return std::nullopt;
    Section section(points);
    std::array<float, kSectors> sum_x;
    std::array<float, kSectors> sum_y;
    std::array<float, kSectors> weight;
    std::array<int, kMostPoints> sectors;
    float cx = 0.0f;
    float cy = 0.0f;
    int filled = 0;
    for (int step = 0; step < kRingSteps; step++) {
        sum_x.fill(0.0f);
        sum_y.fill(0.0f);
        weight.fill(0.0f);
        for (size_t i = 0; i < section.count; i++)
            sectors[i] = sector_of(section.x[i] - cx, section.y[i] - cy);
        for (size_t i = 0; i < section.count; i++) {
            const int sector = sectors[i];
            sum_x[sector] += section.x[i];
            sum_y[sector] += section.y[i];
            weight[sector] += 1.0f;
        }
        float x = 0.0f;
        float y = 0.0f;
        filled = 0;
        for (int s = 0; s < kSectors; s++) {
            if (weight[s] == 0.0f) continue;
            x += sum_x[s] / weight[s];
            y += sum_y[s] / weight[s];
            filled++;
        }
        if (filled < kLeastFilled) return std::nullopt;
        x /= static_cast<float>(filled);
        y /= static_cast<float>(filled);
        const float moved = std::abs(x - cx) + std::abs(y - cy);
        cx = x;
        cy = y;
        if (moved < 1e-5f) break;
    }
    // Every direction counts once, however densely it was sampled.
    weight.fill(0.0f);
    sum_x.fill(0.0f);
    for (size_t i = 0; i < section.count; i++) {
        const float dx = section.x[i] - cx;
        const float dy = section.y[i] - cy;
        const int sector = sector_of(dx, dy);
        sum_x[sector] += std::sqrt(dx * dx + dy * dy);
        weight[sector] += 1.0f;
    }
    float square = 0.0f;
    filled = 0;
    for (int s = 0; s < kSectors; s++) {
        if (weight[s] == 0.0f) continue;
        const float distance = sum_x[s] / weight[s];
        square += distance * distance;
        filled++;
    }
    const float radius = std::sqrt(square / static_cast<float>(filled));
    size_t inside = 0;
    for (size_t i = 0; i < section.count; i++) {
        const float dx = section.x[i] - cx;
        const float dy = section.y[i] - cy;
        if (dx * dx + dy * dy < kRingInside * kRingInside * radius * radius) inside++;
    }
    section.measure(cx, cy, radius);
    CircleFit fit;
    fit.centre = section.mean + DVec2(cx, cy);
    fit.radius = radius;
    fit.spread = section.median(section.count);
    fit.inside = static_cast<double>(inside) / static_cast<double>(section.count);
    fit.coverage = static_cast<double>(filled) / kSectors;
    return fit;
}

}  // namespace treerec
