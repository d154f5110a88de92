#include "scan/leaves/leaf_colour.h"

#include <algorithm>
#include <array>

#include "geometry/quantile.h"
#include "scan/stems/tree_heights.h"

namespace treerec {

namespace {

constexpr int kColourBins = 64;
constexpr double kLeastSeparation = 0.8;  // between the groups, of the whole variance
constexpr double kLeastGreen = 0.08;      // mean excess green of the green group
constexpr double kLeastGap = 0.1;         // between the groups' means
constexpr double kLeastShare = 0.05;

// Where foot and top confirm it: of the orchard's foot 0 to 4 % are of the green group, of its top all; of
// the feet of scans without leaves 26 % or more.
constexpr double kLeastTint = 0.03;   // mean excess green of the green group
constexpr double kMostOfFoot = 0.12;  // is green,
constexpr double kLeastOfTop = 0.7;   // and of the top
constexpr double kTop = 0.7;          // of the height: from there on
constexpr size_t kFewest = 50;        // points of each
// Nine tenths of a bare foot's points lie within 0.056 of the height from their middle, those of trees with
// boughs to the ground within 0.17 and more.
constexpr double kWidestFoot = 0.09;
constexpr double kNarrow = 0.9;

// Whether the foot is as narrow as stems and not green, and the top is green.
bool rises_from_wood(const std::vector<float>& green, double middle, const std::vector<Vec3>& points,
                     const std::vector<uint32_t>& cell_of_point) {
    const TreeHeights heights(points);
    std::vector<Vec2> foot;
    double foot_greens = 0.0, top = 0.0, top_greens = 0.0;
    for (size_t i = 0; i < points.size(); i++) {
        const double is_green = green[cell_of_point[i]] > middle ? 1.0 : 0.0;
        if (heights.at_foot(points[i])) {
            foot.emplace_back(points[i].x, points[i].z);
            foot_greens += is_green;
        } else if (heights.of(points[i]) > kTop) {
            top++;
            top_greens += is_green;
        }
    }
    if (foot.size() < kFewest || top < kFewest) return false;
    if (foot_greens > kMostOfFoot * static_cast<double>(foot.size()) || top_greens < kLeastOfTop * top)
        return false;
    std::vector<float> values;
    Vec2 centre;
    for (int axis = 0; axis < 2; axis++) {
        values.clear();
        for (const Vec2& p : foot)
            values.push_back(p[axis]);
        centre[axis] = quantile(values, 0.5);
    }
    values.clear();
    for (const Vec2& p : foot)
        values.push_back(glm::distance(p, centre));
    return quantile(values, kNarrow) < kWidestFoot * heights.metres();
}

}  // namespace

std::vector<float> excess_green(const std::vector<Color8>& colours,
                                const std::vector<uint32_t>& cell_of_point, size_t cells) {
    // Summed over whole numbers, so that order is no matter.
    std::vector<std::array<uint64_t, 3>> sums(cells);
    for (size_t i = 0; i < colours.size(); i++)
        for (size_t c = 0; c < 3; c++)
            sums[cell_of_point[i]][c] += colours[i][c];
    std::vector<float> green(cells);
    for (size_t v = 0; v < cells; v++) {
        const double r = static_cast<double>(sums[v][0]), g = static_cast<double>(sums[v][1]),
                     b = static_cast<double>(sums[v][2]);
        green[v] = static_cast<float>((2.0 * g - r - b) / std::max(r + g + b, 1.0));
    }
    return green;
}

std::vector<float> shares_of(const std::vector<uint8_t>& labels, const std::vector<uint32_t>& cell_of_point,
                             size_t cells) {
    std::vector<uint32_t> points(cells, 0), labelled(cells, 0);
    for (size_t i = 0; i < labels.size(); i++) {
        points[cell_of_point[i]]++;
        labelled[cell_of_point[i]] += labels[i] == 1;
    }
    std::vector<float> shares(cells, 0.0F);
    for (size_t v = 0; v < cells; v++)
        if (points[v] > 0) shares[v] = static_cast<float>(labelled[v]) / static_cast<float>(points[v]);
    return shares;
}

GreenGroups part_greens(const std::vector<float>& green, const std::vector<uint32_t>& weights,
                        const std::vector<Vec3>& points, const std::vector<uint32_t>& cell_of_point) {
    std::array<double, kColourBins> histogram{};
    double all = 0.0;
    for (size_t v = 0; v < green.size(); v++) {
        const double at = (std::clamp(green[v], -1.0F, 1.0F) + 1.0) * 0.5 * (kColourBins - 1);
        histogram[static_cast<size_t>(at + 0.5)] += weights[v];
        all += weights[v];
    }
    auto value = [](int bin) { return 2.0 * bin / (kColourBins - 1) - 1.0; };
    double mean = 0.0, square = 0.0;
    for (int b = 0; b < kColourBins; b++) {
        mean += histogram[static_cast<size_t>(b)] * value(b) / all;
        square += histogram[static_cast<size_t>(b)] * value(b) * value(b) / all;
    }
    const double variance = square - mean * mean;
    GreenGroups best;
    double most = 0.0, weight = 0.0, sum = 0.0, greens = 0.0;
    for (int b = 0; b + 1 < kColourBins; b++) {
        weight += histogram[static_cast<size_t>(b)] / all;
        sum += histogram[static_cast<size_t>(b)] * value(b) / all;
        if (weight <= 0.0 || weight >= 1.0) continue;
        const double between = (mean * weight - sum) * (mean * weight - sum) / (weight * (1.0 - weight));
        if (between <= most) continue;
        most = between;
        const double low = sum / weight;
        greens = (mean - sum) / (1.0 - weight);
        best = {false, false, 0.5 * (low + greens), greens - low, 1.0 - weight};
    }
    if (!(best.gap > kLeastGap && best.share > kLeastShare)) return best;
    best.apart = most > kLeastSeparation * variance && greens > kLeastGreen;
    if (best.apart) return best;
    best.tinted = greens > kLeastTint && rises_from_wood(green, best.middle, points, cell_of_point);
    best.apart = best.tinted;
    return best;
}

float greenness(double green, const GreenGroups& groups) {
    return static_cast<float>(std::clamp((green - groups.middle) / groups.gap, -1.0, 1.0));
}

}  // namespace treerec
