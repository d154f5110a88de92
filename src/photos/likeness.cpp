#include "photos/likeness.h"

#include <cmath>
#include <cstdlib>

namespace treerec {

Likeness::Likeness(const LikenessOptions& options) : options_(options) {
    for (int v = -options.window; v <= options.window; v++)
        for (int u = -options.window; u <= options.window; u++)
            by_distance_.push_back(std::exp(-std::hypot(u, v) / options.distance));
    for (size_t i = 0; i < by_colour_.size(); i++)
        by_colour_[i] = std::exp(-static_cast<double>(i) / options.colour);
}

double Likeness::at(const RectifiedPair& pair, int x, int y, float disparity) const {
    const int window = options_.window;
    // Where the right picture's window begins, between two pixels of its rows.
    const double begin = static_cast<double>(static_cast<float>(x - window) - disparity);
    const int first = static_cast<int>(std::floor(begin));
    if (x < window || y < window || x + window >= pair.width || y + window >= pair.height || first < 0 ||
        first + 2 * window + 1 >= pair.width)
        return 0.0;
    const double part = begin - first;
    const auto pixel = [&](int at_x, int at_y) {
        return static_cast<size_t>(at_y) * static_cast<size_t>(pair.width) + static_cast<size_t>(at_x);
    };
    const auto& middle = pair.left.colours[pixel(x, y)];
    double all = 0.0, a = 0.0, b = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
    size_t i = 0;
    for (int v = y - window; v <= y + window; v++) {
        const size_t here = pixel(x - window, v), there = pixel(first, v);
        for (size_t u = 0; u <= static_cast<size_t>(2 * window); u++, i++) {
            const auto& colour = pair.left.colours[here + u];
            size_t unlike = 0;
            for (size_t k = 0; k < 3; k++)
                unlike += static_cast<size_t>(std::abs(colour[k] - middle[k]));
            const double weight = by_distance_[i] * by_colour_[unlike];
            const double left = pair.left.grey[here + u];
            const double right =
                (1.0 - part) * pair.right.grey[there + u] + part * pair.right.grey[there + u + 1];
            all += weight;
            a += weight * left;
            b += weight * right;
            aa += weight * left * left;
            bb += weight * right * right;
            ab += weight * left * right;
        }
    }
    a /= all, b /= all;
    const double spread_a = aa / all - a * a, spread_b = bb / all - b * b;
    const double least = options_.least_slope * options_.least_slope;
    if (spread_a < least || spread_b < least) return 0.0;
    return (ab / all - a * b) / std::sqrt(spread_a * spread_b);
}

}  // namespace treerec
