#include "photos/subject_stem.h"

#include <algorithm>
#include <array>

#include "geometry/circle_fit.h"
#include "geometry/quantile.h"

namespace treerec {

namespace {

constexpr size_t kSlices = 24;
constexpr double kOutermost = 0.005;  // share of the points, at either end, that sets no height
constexpr size_t kLeastPoints = 40;   // of a slice
// Of the cloud's half width: what stands around is no stem, unless nothing does.
constexpr double kWidest[] = {0.5, 1.5};
constexpr double kMostRough = 0.1;  // of the radius: the median distance from the circle
constexpr double kLeastCoverage = 0.5;
constexpr double kMostWider = 1.8;      // than the stem usually is: feet widen
constexpr double kMostAside = 0.6;      // of the radius, from the axis of the others
constexpr double kFromSubject = 2.0;    // radii that the axis may pass beside what the cameras aim at
constexpr double kLeastSections = 0.6;  // of the slices
constexpr double kUpperPart = 0.4;      // of the height: benches and fences stand lower
constexpr double kBeside = 0.3;         // of the radius
constexpr double kMostBeside = 0.2;     // of the points there
constexpr size_t kTop = 3;              // slices at the top, one of which shows the stem still
constexpr double kTopWide = 0.4;        // of the usual radius: a top is thinner

// Among the points that are nearer to the subject than `widest` of the cloud's half width.
std::optional<SubjectStem> find_within(std::span<const DVec3> points, const DVec3& subject, const DVec3& sky,
                                       double widest, Progress* progress) {
    if (points.size() < kSlices * kLeastPoints) return {};
    SubjectStem stem;
    stem.subject = subject;
    stem.sky = sky;
    stem.side = any_perpendicular(sky);
    stem.other = glm::cross(sky, stem.side);
    std::vector<double> heights, aways;
    for (const DVec3& p : points) {
        heights.push_back(glm::dot(p - subject, sky));
        aways.push_back(std::abs(glm::dot(p - subject, stem.side)));
    }
    std::vector<double> sorted = heights;
    const double low = quantile(sorted, kOutermost), high = quantile(sorted, 1.0 - kOutermost);
    const double width = quantile(aways, 1.0 - kOutermost);
    if (!(high > low)) return {};
    stem.low = low;
    stem.high = high;
    std::vector<std::vector<DVec2>> slices(kSlices);
    for (size_t i = 0; i < points.size(); i++) {
        const double at = (heights[i] - low) / (high - low) * static_cast<double>(kSlices);
        const DVec2 place(glm::dot(points[i] - subject, stem.side),
                          glm::dot(points[i] - subject, stem.other));
        if (at >= 0.0 && at < static_cast<double>(kSlices) && glm::length(place) < widest * width)
            slices[static_cast<size_t>(at)].push_back(place);
    }
    std::array<std::optional<CircleFit>, kSlices> rings;
    std::vector<double> radii, xs, ys;
    for (size_t s = 0; s < kSlices; s++) {
        if (progress) progress->check();
        if (slices[s].size() < kLeastPoints) continue;
        const auto ring = fit_circle(slices[s], widest * width, Random(s));
        if (!ring || ring->spread > kMostRough * ring->radius || ring->coverage < kLeastCoverage) continue;
        rings[s] = ring;
        radii.push_back(ring->radius);
        xs.push_back(ring->centre.x);
        ys.push_back(ring->centre.y);
    }
    if (radii.empty()) return {};
    const double radius = quantile(radii, 0.5);
    const DVec2 axis(quantile(xs, 0.5), quantile(ys, 0.5));
    if (glm::length(axis) > kFromSubject * radius) return {};
    bool at_top = false;
    for (size_t s = 0; s < kSlices; s++) {
        const auto& ring = rings[s];
        if (!ring || ring->radius > kMostWider * radius || ring->radius * kMostWider < radius) continue;
        // A stem may lean: from the one below, or where there is none yet, from the middle.
        const DVec2 before = stem.rings.empty() ? axis : stem.rings.back().centre;
        if (glm::distance(before, ring->centre) > kMostAside * radius) continue;
        stem.rings.push_back(
            {low + (static_cast<double>(s) + 0.5) / static_cast<double>(kSlices) * (high - low), ring->centre,
             ring->radius});
        at_top = at_top || (s + kTop >= kSlices && ring->radius > kTopWide * radius);
    }
    if (!at_top || static_cast<double>(stem.rings.size()) < kLeastSections * static_cast<double>(kSlices))
        return {};
    // What hangs in the air around its upper part are its own branches.
    size_t above = 0, beside = 0;
    for (size_t i = 0; i < points.size(); i++) {
        if (heights[i] < high - kUpperPart * (high - low)) continue;
        above++;
        beside += !stem.has(points[i], kBeside);
    }
    if (static_cast<double>(beside) > kMostBeside * static_cast<double>(above)) return {};
    return stem;
}

}  // namespace

bool SubjectStem::has(const DVec3& p, double slack) const {
    const DVec3 way = p - subject;
    const double height = glm::dot(way, sky);
    const DVec2 at(glm::dot(way, side), glm::dot(way, other));
    const auto above = std::find_if(rings.begin(), rings.end(),
                                    [&](const SubjectRing& ring) { return ring.height > height; });
    SubjectRing here;
    if (above == rings.begin()) {
        here = rings.front();
    } else if (above == rings.end()) {
        here = rings.back();
    } else {
        const SubjectRing& below = *(above - 1);
        const double t = (height - below.height) / (above->height - below.height);
        here.centre = glm::mix(below.centre, above->centre, t);
        here.radius = std::max(below.radius, above->radius);
    }
    return height > low - slack * here.radius && height < high + slack * here.radius &&
           glm::distance(at, here.centre) < (1.0 + slack) * here.radius;
}

std::optional<SubjectStem> find_subject_stem(std::span<const DVec3> points, const DVec3& subject,
                                             const DVec3& sky, Progress* progress) {
    for (const double widest : kWidest)
        if (auto stem = find_within(points, subject, sky, widest, progress)) return stem;
    return {};
}

}  // namespace treerec
