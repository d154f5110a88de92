#include "photos/outline_radii.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <optional>

#include "geometry/parallel.h"
#include "photos/affine_track.h"
#include "photos/grey_pyramid.h"
#include "photos/photo_picture.h"

namespace treerec {

namespace {

constexpr int kHalf = 72;  // steps of a profile to each side of the axis
constexpr int kSteps = 2 * kHalf + 1;
constexpr double kReach = 1.8;  // radii to each side
constexpr double kStep = kReach / kHalf;
constexpr double kLowest = 0.5, kHighest = 1.5;  // radii: where the edge may be
constexpr double kAlong = 0.75;                  // radii to each side, that a profile is the mean of
constexpr int kMostLines = 24;                   // that it is the mean of
constexpr double kMostPixels = 24.0;  // of a radius: of thicker wood a smaller picture is looked at
constexpr double kEdgePixels = 0.7;   // to each side, that a slope is told from
constexpr double kLeastSlope = 0.4;   // grey levels a pixel
constexpr double kMostFaced = 0.9;    // cosine between wood and the way that it is looked at
constexpr double kNearestEye = 3.0;   // radii from the axis: nearer by, an edge lies far from the wood's side
constexpr int kRounds = 3;
constexpr double kNear = 0.15;  // radii between where an edge should be and is
// Pixels, of the slopes about a sharp edge: the blur of ridges.cpp, 1.5 at half height, is a deviation of
// .64, and differences over 2 kEdgePixels add .40.
constexpr double kEdgeSigma = 0.8;
constexpr uint8_t kUsualSlope = 64;      // what a photo's usual slope is in its profile
constexpr double kLeastExplained = 0.6;  // share of the slopes' variance that an outline explains
constexpr double kLeastStep = 20.0;      // as kUsualSlope: how much an outline stands out
// Of photos that have nothing in common the mean stands out by up to 105 over the root of their number, as
// measured on 12 and 20 of a forest without the wood.
constexpr double kChanceStep = 150.0;
constexpr double kAxisPrior = 4.0;  // how many photos the axis as it was taken counts for

using Profile = std::array<uint8_t, kSteps>;

// What one photo shows of one place.
struct Seen {
    uint32_t place = 0;
    DVec3 side{0.0};      // a unit vector across the wood and the way it is looked at
    double pixels = 0.0;  // of the radius, in the picture that was looked at
    double wider = 1.0;  // how much further out than its radius a round thing's outline seems, for it is near
    Profile slopes{};
};

// The slopes across a place; false where the photo does not show it, or nothing but evenness.
bool look_across(const WoodPlace& place, const Photo& photo, const Camera& camera, const GreyPyramid& pyramid,
                 const OutlineOptions& options, Seen& seen) {
    const DVec3 eye = photo.centre();
    const DVec3 ahead = place.position - eye;
    const double distance = glm::length(ahead);
    if (!(place.radius > 0.0 && distance > kNearestEye * place.radius)) return false;
    const DVec3 look = ahead / distance;
    const double faced = glm::dot(look, place.way);
    if (std::abs(faced) > kMostFaced) return false;
    seen.side = glm::normalize(glm::cross(look, place.way));
    const double square = distance * distance * (1.0 - faced * faced);
    seen.wider = std::sqrt(square / (square - place.radius * place.radius));
    const auto at = [&](const DVec3& p) { return camera.project(photo.to_camera(p)); };
    const auto middle = at(place.position), beside = at(place.position + place.radius * seen.side);
    if (!middle || !beside) return false;
    double pixels = glm::distance(*middle, *beside) / pyramid.to_photo.x;
    if (!(pixels >= options.least_pixels)) return false;
    size_t level = 0;
    for (; pixels > kMostPixels && level + 1 < pyramid.levels.size(); level++)
        pixels *= 0.5;
    seen.pixels = pixels;
    const GreyPicture& picture = pyramid.levels[level];
    const double size = static_cast<double>(size_t{1} << level);
    std::array<double, kSteps> sum{};
    const int lines = std::clamp(static_cast<int>(2.0 * kAlong * pixels), 3, kMostLines);
    for (int k = 0; k < lines; k++) {
        const double along = kAlong * (2.0 * k / (lines - 1.0) - 1.0);
        const DVec3 centre = place.position + along * place.radius * place.way;
        const auto left = at(centre - kReach * place.radius * seen.side),
                   right = at(centre + kReach * place.radius * seen.side);
        if (!left || !right) return false;
        const DVec2 from = (*left / pyramid.to_photo - 0.5) / size,
                    to = (*right / pyramid.to_photo - 0.5) / size;
        if (!picture.has(from.x, from.y) || !picture.has(to.x, to.y)) return false;
        for (int i = 0; i < kSteps; i++) {
            const DVec2 p = glm::mix(from, to, static_cast<double>(i) / (kSteps - 1));
            sum[static_cast<size_t>(i)] +=
                static_cast<double>(picture.at(static_cast<float>(p.x), static_cast<float>(p.y)));
        }
    }
    const int apart = std::clamp(static_cast<int>(std::lround(kEdgePixels / pixels / kStep)), 1, kHalf / 4);
    std::array<double, kSteps> slopes{};
    double squares = 0.0;
    for (int i = apart; i + apart < kSteps; i++) {
        const double slope =
            std::abs(sum[static_cast<size_t>(i + apart)] - sum[static_cast<size_t>(i - apart)]) / lines /
            (2.0 * apart * kStep * pixels);
        slopes[static_cast<size_t>(i)] = slope;
        squares += slope * slope;
    }
    const double usual = std::sqrt(squares / kSteps);
    if (usual < kLeastSlope) return false;
    for (size_t i = 0; i < kSteps; i++)
        seen.slopes[i] = static_cast<uint8_t>(std::min(kUsualSlope * slopes[i] / usual, 255.0));
    return true;
}

double slope_at(const Profile& slopes, double u) {
    const double at = u / kStep + kHalf;
    if (!(at >= 0.0 && at < kSteps - 1)) return 0.0;
    const auto i = static_cast<size_t>(at);
    const double part = at - static_cast<double>(i);
    return (1.0 - part) * static_cast<double>(slopes[i]) + part * static_cast<double>(slopes[i + 1]);
}

// The steepest place within kNear of u; nothing where none is steeper than is usual.
std::optional<double> edge_near(const Profile& slopes, double u) {
    const int first = std::max(1, static_cast<int>(std::ceil((u - kNear) / kStep)) + kHalf),
              last = std::min(kSteps - 2, static_cast<int>(std::floor((u + kNear) / kStep)) + kHalf);
    int best = -1;
    for (int i = first; i <= last; i++) {
        const uint8_t slope = slopes[static_cast<size_t>(i)];
        if (slope > kUsualSlope && (best < 0 || slope > slopes[static_cast<size_t>(best)])) best = i;
    }
    if (best < 0) return {};
    const double a = slopes[static_cast<size_t>(best - 1)], b = slopes[static_cast<size_t>(best)],
                 c = slopes[static_cast<size_t>(best + 1)];
    const double bend = a - 2.0 * b + c;
    const double away = bend < 0.0 ? std::clamp(0.5 * (a - c) / bend, -0.5, 0.5) : 0.0;
    return (best + away - kHalf) * kStep;
}

constexpr int kCount = static_cast<int>((kHighest - kLowest) / kStep + 0.5) + 1;
using Slopes = std::array<double, kCount>;

struct Outline {
    double radius = 0.0;     // over what it was taken for; 0: there is none
    double explained = 0.0;  // share of the slopes' variance
    double step = 0.0;       // by how much the slopes at it and beyond differ from those inside
};

// What an outline at `radius` leaves unexplained: slopes that are even inside of it, even outside, and
// steeper at it. sigma: of the edge, in radii.
double misfit(const Slopes& slopes, double radius, double sigma, double& step) {
    std::array<std::array<double, 3>, kCount> rows{};
    for (int i = 0; i < kCount; i++) {
        const double off = (kLowest + i * kStep - radius) / sigma;
        const double inside = 0.5 * std::erfc(off / std::sqrt(2.0));
        rows[static_cast<size_t>(i)] = {inside, 1.0 - inside, std::exp(-0.5 * off * off)};
    }
    const auto solve = [&](int terms) {
        DMat3 normal(0.0);
        DVec3 right(0.0);
        for (size_t i = 0; i < kCount; i++)
            for (int j = 0; j < terms; j++) {
                right[j] += rows[i][static_cast<size_t>(j)] * slopes[i];
                for (int k = 0; k < terms; k++)
                    normal[k][j] += rows[i][static_cast<size_t>(j)] * rows[i][static_cast<size_t>(k)];
            }
        for (int j = 0; j < 3; j++)
            normal[j][j] += j < terms ? 1e-6 : 1.0;
        return glm::inverse(normal) * right;
    };
    DVec3 levels = solve(3);
    if (levels[2] < 0.0) levels = solve(2);
    step = std::abs(levels[0] - levels[1]) + levels[2];
    double sum = 0.0;
    for (size_t i = 0; i < kCount; i++) {
        const double off =
            slopes[i] - levels[0] * rows[i][0] - levels[1] * rows[i][1] - levels[2] * rows[i][2];
        sum += off * off;
    }
    return sum;
}

Outline fit_outline(const Slopes& slopes, double sigma) {
    double mean = 0.0, whole = 0.0;
    for (const double slope : slopes)
        mean += slope / kCount;
    for (const double slope : slopes)
        whole += (slope - mean) * (slope - mean);
    Outline best;
    if (!(whole > 0.0)) return best;
    std::array<double, kCount> left{};
    int at = 0;
    double step = 0.0;
    for (int i = 0; i < kCount; i++) {
        left[static_cast<size_t>(i)] = misfit(slopes, kLowest + i * kStep, sigma, step);
        if (left[static_cast<size_t>(i)] < left[static_cast<size_t>(at)]) at = i;
    }
    // At an end it may as well lie beyond.
    if (at == 0 || at == kCount - 1) return best;
    const double a = left[static_cast<size_t>(at - 1)], b = left[static_cast<size_t>(at)],
                 c = left[static_cast<size_t>(at + 1)], bend = a - 2.0 * b + c;
    best.radius = kLowest + kStep * (at + (bend > 0.0 ? std::clamp(0.5 * (a - c) / bend, -0.5, 0.5) : 0.0));
    misfit(slopes, best.radius, sigma, best.step);
    best.explained = 1.0 - b / whole;
    return best;
}

// The radius by what all photos show of one place, over what it was taken for.
std::optional<double> agreed(std::span<const Seen* const> seen, const DVec3& way) {
    const DVec3 x = any_perpendicular(way), y = glm::cross(way, x);
    const auto flat = [&](const Seen* view) {
        return DVec2(glm::dot(view->side, x), glm::dot(view->side, y));
    };
    double sigma = 0.0;
    for (const Seen* view : seen)
        sigma += kEdgeSigma / view->pixels / static_cast<double>(seen.size());
    DVec2 shift(0.0);
    Outline outline;
    for (int round = 0; round < kRounds; round++) {
        Slopes sums{};
        for (const Seen* view : seen) {
            const double middle = glm::dot(shift, flat(view));
            for (int i = 0; i < kCount; i++) {
                const double u = (kLowest + i * kStep) * view->wider;
                // Both edges or none: a post beside the trunk has one.
                sums[static_cast<size_t>(i)] +=
                    std::sqrt(slope_at(view->slopes, middle + u) * slope_at(view->slopes, middle - u)) /
                    static_cast<double>(seen.size());
            }
        }
        outline = fit_outline(sums, sigma);
        if (outline.radius == 0.0) return {};
        // The axis, by where each photo's edges are.
        DMat2 normal(kAxisPrior, 0.0, 0.0, kAxisPrior);
        DVec2 sum(0.0);
        for (const Seen* view : seen) {
            const DVec2 side = flat(view);
            const double middle = glm::dot(shift, side), u = outline.radius * view->wider;
            const auto right = edge_near(view->slopes, middle + u),
                       left = edge_near(view->slopes, middle - u);
            if (!right || !left) continue;
            normal += glm::outerProduct(side, side);
            sum += (0.5 * (*right + *left) - middle) * side;
        }
        shift += glm::inverse(normal) * sum;
    }
    const double least = std::max(kLeastStep, kChanceStep / std::sqrt(static_cast<double>(seen.size())));
    if (outline.explained < kLeastExplained || outline.step < least) return {};
    return outline.radius;
}

}  // namespace

std::vector<double> outline_radii(const PhotoModel& model, const std::string& folder,
                                  std::span<const WoodPlace> places, const OutlineOptions& options,
                                  Progress* progress) {
    std::vector<std::vector<Seen>> of_photo(model.photos.size());
    std::atomic<size_t> done = 0;
    parallel_for(model.photos.size(), 1, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; i++) {
            if (progress) progress->check();
            const Photo& photo = model.photos[i];
            const Camera& camera = model.cameras[static_cast<size_t>(photo.camera)];
            if (const auto picture = picture_of(photo, camera, folder)) {
                const GreyPyramid pyramid = pyramid_of(*picture, options.most_pixels);
                for (size_t k = 0; k < places.size(); k++) {
                    Seen seen;
                    if (!look_across(places[k], photo, camera, pyramid, options, seen)) continue;
                    seen.place = static_cast<uint32_t>(k);
                    of_photo[i].push_back(seen);
                }
            }
            if (progress)
                progress->update(static_cast<double>(++done) / static_cast<double>(model.photos.size()),
                                 "Outline");
        }
    });
    std::vector<std::vector<const Seen*>> of_place(places.size());
    for (const std::vector<Seen>& some : of_photo)
        for (const Seen& seen : some)
            of_place[seen.place].push_back(&seen);
    std::vector<double> radii(places.size(), 0.0);
    parallel_for(places.size(), 16, [&](size_t first, size_t last) {
        for (size_t k = first; k < last; k++)
            if (of_place[k].size() >= options.least_photos)
                if (const auto found = agreed(of_place[k], places[k].way))
                    radii[k] = *found * places[k].radius;
    });
    return radii;
}

}  // namespace treerec
