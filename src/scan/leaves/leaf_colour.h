// Leaves that are told by their green. Internal to scan/.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/vec.h"
#include "scan/point_cloud.h"

namespace treerec {

// Two groups of excess greens.
struct GreenGroups {
    bool apart = false;   // whether they are leaves and the rest,
    bool tinted = false;  // and the light has bleached or dimmed their colours
    double middle = 0.0;  // between the groups' means
    double gap = 1.0;     // from mean to mean
    double share = 0.0;   // of the green one
};

// Excess green (2 g - r - b) / (r + g + b) (Woebbecke et al. 1995).
inline double excess_green(const Color8& c) {
    return (2 * c[1] - c[0] - c[2]) / std::max(1.0, static_cast<double>(c[0] + c[1] + c[2]));
}

// The same of the mean colour of each cell. colours: by point.
std::vector<float> excess_green(const std::vector<Color8>& colours,
                                const std::vector<uint32_t>& cell_of_point, size_t cells);

// By cell: the share of its points that have a label of 1.
std::vector<float> shares_of(const std::vector<uint8_t>& labels, const std::vector<uint32_t>& cell_of_point,
                             size_t cells);

// Parts the cells in two by Otsu's threshold (1979). They are leaves and the rest where one group is green
// and hardly any lies between the two; where light has bleached or dimmed the colours, as in photos against
// the sky, also where the narrow foot is of the rest, and the crown's top of the other, and that is at least
// tinted. weights: points by cell. points: metres, Y up, distinct, in canonical order.
GreenGroups part_greens(const std::vector<float>& green, const std::vector<uint32_t>& weights,
                        const std::vector<Vec3>& points, const std::vector<uint32_t>& cell_of_point);

// -1..1: from the rest's side of the gap to the green group's.
float greenness(double green, const GreenGroups& groups);

}  // namespace treerec
