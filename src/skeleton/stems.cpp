#include "skeleton/stems.h"

#include <algorithm>

namespace treerec {

namespace {

constexpr double kStretch = 12.0;  // radii: so far down a measured stretch is continued
constexpr double kBentEnd = 4.0;   // radii: so near to the root, a circle is drawn towards it
constexpr double kSample = 6.0;    // radii: the length of stem that tells the direction

// first: the lowest station that may move.
void straighten(std::vector<Station>& line, size_t first) {
    size_t from = first;
    double down = 0.0;
    while (from < line.size() && !(line[from].measured && down > kBentEnd * line[from].radius)) {
        if (from + 1 < line.size()) down += glm::distance(line[from].position, line[from + 1].position);
        from++;
    }
    if (from >= line.size() || down > kStretch * line[from].radius) return;
    size_t to = from;
    while (to + 1 < line.size() && line[to + 1].measured &&
           glm::distance(line[from].position, line[to].position) < kSample * line[from].radius)
        to++;
    if (to == from) return;
    const DVec3 foot = line[from].position;
    const DVec3 up = normalized_or(line[to].position - foot, DVec3(0, 1, 0));
    double below = 0.0;
    for (size_t i = from; i-- > first;) {
        below = std::max(below, glm::dot(foot - line[i].position, up));
        line[i].position = foot - below * up;
        line[i].radius = line[from].radius;
    }
}

}  // namespace

void straighten_stems(const std::vector<Limb>& limbs, std::vector<std::vector<Station>>& axes) {
    bool several = false;
    for (const Limb& limb : limbs)
        several = several || (limb.parent == 0 && limb.attach == 0);
    if (!several) return;
    for (size_t l = 0; l < limbs.size(); l++)
        if (limbs[l].parent < 0 || (limbs[l].parent == 0 && limbs[l].attach == 0))
            straighten(axes[l], limbs[l].parent < 0 ? 1 : 0);
}

}  // namespace treerec
