#include "skeleton/branches/stems.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/portable_math.h"

namespace treerec {

namespace {

constexpr double kStretch = 12.0;     // radii: so far down a measured stretch is continued
constexpr double kBentEnd = 4.0;      // radii: so near to the root, a circle is drawn towards it
constexpr double kSample = 6.0;       // radii: the length of stem that tells the direction
constexpr double kBaseStretch = 6.0;  // radii: so far down a branch's measured stretch is continued
constexpr double kBaseSkip = 1.0;     // radii: so long, the first circles are still bent
constexpr double kBaseFar = 2.5;      // and at most so long, if they
constexpr double kBaseBend = 0.3;     // radii bend away
constexpr double kBaseSample = 5.0;   // radii: the length of branch that tells the direction
constexpr double kLeastSample = 1.5;  // radii
constexpr double kBaseMove = 4.0;     // radii that a station may move
constexpr double kAround = 4.0;       // parent's radii to each side, where the fork may be
constexpr double kMiss = 0.8;         // radii by which the line may miss the parent's axis

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
    const DVec3 base = line[from].position;
    const DVec3 up = normalized_or(line[to].position - base, DVec3(0, 1, 0));
    double below = 0.0;
    for (size_t i = from; i-- > first;) {
        below = std::max(below, glm::dot(base - line[i].position, up));
        line[i].position = base - below * up;
        line[i].radius = line[from].radius;
    }
}

// Where the line from `base` along `back` comes nearest to the parent's axis.
struct Meeting {
    int32_t station = -1;
    double miss = 0.0;  // metres
    double way = 0.0;   // metres from `base`
};

Meeting meet(const DVec3& base, const DVec3& back, const std::vector<Station>& parent, int32_t attach) {
    const double reach = kAround * parent[attach].radius;
    const int32_t last = static_cast<int32_t>(parent.size()) - 1;
    Meeting best;
    auto look = [&](int32_t j) {
        const DVec3 offset = parent[j].position - base;
        const double way = std::max(0.0, glm::dot(offset, back));
        const double miss = glm::length(offset - way * back);
        if (best.station < 0 || miss < best.miss) best = {j, miss, way};
    };
    look(attach);
    double arc = 0.0;
    for (int32_t j = attach; j > 0 && !parent[j].bridged; j--) {
        arc += glm::distance(parent[j].position, parent[j - 1].position);
        if (arc > reach) break;
        look(j - 1);
    }
    arc = 0.0;
    for (int32_t j = attach; j < last && !parent[j + 1].bridged; j++) {
        arc += glm::distance(parent[j].position, parent[j + 1].position);
        if (arc > reach) break;
        look(j + 1);
    }
    return best;
}

// Lays the first stations of a branch on the line of its first measured stretch.
void straighten_base(SkeletonBranch& branch, std::vector<Station>& line,
                     const std::vector<SkeletonBranch>& branches,
                     const std::vector<std::vector<Station>>& axes) {
    const size_t count = line.size();
    size_t first = 0;
    double arc = 0.0;  // from the base
    auto step = [&](size_t i) { return glm::distance(line[i].position, line[i + 1].position); };
    while (first + 1 < count && !(line[first].measured && line[first + 1].measured)) {
        if (line[first].bridged) return;
        arc += step(first++);
    }
    if (first + 1 >= count || arc > kBaseStretch * line[first].radius) return;
    // The measured stretch that begins so many radii further out, as the stations of both its ends.
    const auto stretch = [&](double skip) {
        size_t from = first;
        for (double way = 0.0; from + 1 < count && line[from + 1].measured && !line[from + 1].bridged &&
                               way + step(from) <= skip * line[first].radius;)
            way += step(from++);
        size_t to = from;
        while (to + 1 < count && line[to + 1].measured && !line[to + 1].bridged &&
               glm::distance(line[from].position, line[to].position) < kBaseSample * line[from].radius)
            to++;
        return std::pair{from, to};
    };
    const auto is_long = [&](size_t from, size_t to) {
        return glm::distance(line[from].position, line[to].position) >= kLeastSample * line[from].radius;
    };
    auto [from, to] = stretch(kBaseSkip);
    // Where the first circles bend away from what follows, they are partly the parent's bark.
    const auto [far, far_to] = stretch(kBaseFar);
    if (far > from && is_long(far, far_to)) {
        const DVec3 along = normalized_or(line[far_to].position - line[far].position, DVec3(0, 1, 0));
        const DVec3 offset = line[first].position - line[far].position;
        if (glm::length(offset - glm::dot(offset, along) * along) > kBaseBend * line[far].radius) {
            from = far;
            to = far_to;
        }
    }
    if (!is_long(from, to)) return;
    const double radius = line[from].radius;
    const DVec3 base = line[from].position;
    const DVec3 back = normalized_or(base - line[to].position, DVec3(0, -1, 0));
    int32_t origin = branch.parent;
    Meeting meeting = meet(base, back, axes[origin], branch.attach);
    const auto misses = [&] {
        return meeting.miss > kMiss * std::max(axes[origin][meeting.station].radius, radius) ||
               meeting.way <= 0.0;
    };
    // Of branches that leave a fork together, one may hang on another's base.
    while (misses() && meeting.station == 0 && branches[origin].parent >= 0) {
        meeting = meet(base, back, axes[branches[origin].parent], branches[origin].attach);
        origin = branches[origin].parent;
    }
    if (misses()) return;
    const std::vector<Station>& parent = axes[origin];
    const double bark = parent[meeting.station].radius;
    // To where the line goes into the parent's bark.
    const double sine = std::sqrt(std::max(
        0.01,
        1.0 - portable::pow(
                  glm::dot(back,
                           normalized_or(
                               parent[std::min(parent.size() - 1, static_cast<size_t>(meeting.station) + 1)]
                                       .position -
                                   parent[std::max(0, meeting.station - 1)].position,
                               DVec3(0, 1, 0))),
                  2.0)));
    const double end = std::max(0.0, meeting.way - bark / sine);
    std::vector<DVec3> place(from);
    double way = 0.0;
    for (size_t i = from; i-- > 0;) {
        way = std::max(way, std::min(glm::dot(line[i].position - base, back), end));
        place[i] = base + way * back;
        if (glm::distance(place[i], line[i].position) > kBaseMove * radius) return;
    }
    if (from == 0) return;
    if (end > way) place[0] = base + end * back;
    for (size_t i = 0; i < from; i++)
        line[i].position = place[i];
    branch.parent = origin;
    branch.attach = meeting.station;
}

}  // namespace

void straighten_stems(const std::vector<SkeletonBranch>& branches, std::vector<std::vector<Station>>& axes) {
    bool several = false;
    for (const SkeletonBranch& branch : branches)
        several = several || (branch.parent == 0 && branch.attach == 0);
    if (!several) return;
    for (size_t l = 0; l < branches.size(); l++)
        if (branches[l].parent < 0 || (branches[l].parent == 0 && branches[l].attach == 0))
            straighten(axes[l], branches[l].parent < 0 ? 1 : 0);
}

void straighten_bases(std::vector<SkeletonBranch>& branches, std::vector<std::vector<Station>>& axes) {
    for (size_t l = 0; l < branches.size(); l++)
        if (branches[l].parent > 0 || (branches[l].parent == 0 && branches[l].attach > 0))
            straighten_base(branches[l], axes[l], branches, axes);
}

}  // namespace treerec
