#include "photos/bark_colours.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/parallel.h"
#include "geometry/point_tree.h"
#include "geometry/quantile.h"

namespace treerec {

namespace {

constexpr size_t kLeastBark = 50;    // points
constexpr size_t kAround = 24;       // points that are told together
constexpr double kOwnShare = 0.9;    // of the bark's points, whose angles are its own
constexpr double kLeastAngle = 0.1;  // radians from bark and sky: pictures' colours differ by less than that
constexpr double kMostOwn = 0.2;     // radians: bark of so many colours tells nothing

DVec3 colour_of(const Color8& c) {
    // Black has no colour.
    return DVec3(c[0], c[1], c[2]) + 1.0;
}

// The angle between a colour and the nearest of a * bark + b * sky with a, b >= 0.
double angle_from(const DVec3& colour, const DVec3& bark, const DVec3& sky) {
    const DVec3 c = glm::normalize(colour);
    const double bs = glm::dot(bark, sky), cb = glm::dot(c, bark), cs = glm::dot(c, sky),
                 square = 1.0 - bs * bs;
    double most = std::max(cb, cs);
    if (square > 1e-6) {
        const double a = (cb - bs * cs) / square, b = (cs - bs * cb) / square;
        if (a > 0.0 && b > 0.0) most = std::max(most, glm::length(a * bark + b * sky));
    }
    return std::acos(std::clamp(most, -1.0, 1.0));
}

}  // namespace

std::vector<uint8_t> unlike_bark(const PointCloud& cloud, std::span<const uint32_t> bark, const DVec3& sky,
                                 const Progress* progress) {
    if (!cloud.has_colors() || bark.size() < kLeastBark) return {};
    DVec3 own;
    for (int part = 0; part < 3; part++) {
        std::vector<double> values;
        for (const uint32_t i : bark)
            values.push_back(glm::normalize(colour_of(cloud.colors[i]))[part]);
        own[part] = quantile(values, 0.5);
    }
    own = glm::normalize(own);
    const DVec3 light = glm::normalize(sky == DVec3(0.0) ? DVec3(1.0) : sky);
    std::vector<float> angles(cloud.size());
    for (size_t i = 0; i < cloud.size(); i++)
        angles[i] = static_cast<float>(angle_from(colour_of(cloud.colors[i]), own, light));
    std::vector<float> of_bark;
    for (const uint32_t i : bark)
        of_bark.push_back(angles[i]);
    const double usual = static_cast<double>(quantile(of_bark, kOwnShare));
    if (usual > kMostOwn) return {};
    const double least = std::max(kLeastAngle, usual);
    const PointTree tree(cloud.positions, progress);
    std::vector<uint8_t> unlike(cloud.size(), 0);
    parallel_for(cloud.size(), 1024, [&](size_t first, size_t last) {
        if (progress) progress->check();
        std::array<uint32_t, kAround> index{};
        std::array<float, kAround> squared{};
        for (size_t i = first; i < last; i++) {
            const size_t count = tree.nearest(cloud.positions[i], kAround, index.data(), squared.data());
            size_t others = 0;
            for (size_t k = 0; k < count; k++)
                others += static_cast<double>(angles[index[k]]) > least;
            unlike[i] = 2 * others > count;
        }
    });
    return unlike;
}

}  // namespace treerec
