#include "foliage/near_wood.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/bounds.h"

namespace treerec {

namespace {

constexpr int64_t kCellsPerReach = 3;
constexpr double kSamplesPerReach = 8.0;
constexpr int64_t kMostPerAxis = 128;
constexpr double kThickPenalty = 2.0;
constexpr double kSlack = 1.0 + 1e-9;  // of squares of distances: rounding leaves nothing out

// From a place to the cell `number`, in cells along one axis.
double gap(double at, int64_t number) {
    const auto low = static_cast<double>(number);
    return std::max({low - at, at - (low + 1.0), 0.0});
}

}  // namespace

NearWood::NearWood(const Tree& tree, const BranchList& list, double reach, double slender, double least)
    : cell_(reach / static_cast<double>(kCellsPerReach)), reach_(reach), slender_(slender) {
    std::vector<WoodSample> samples;
    std::vector<AxisPoint> axis;
    Bounds bounds;
    for (size_t b = 0; b < list.branches.size(); b++) {
        sample_axis(tree, list, list.branches[b], least, axis);
        for (size_t i = 0; i < axis.size(); i++) {
            const double length = i > 0 ? axis[i].along - axis[i - 1].along : 0.0;
            const double pieces = std::max(1.0, std::ceil(kSamplesPerReach * length / reach));
            size_t hint = i > 0 ? i - 1 : 0;
            for (double k = 1.0; k < pieces; k += 1.0)
                samples.push_back(
                    {axis_at(axis, axis[i].along - length * k / pieces, hint), static_cast<uint32_t>(b)});
            samples.push_back({axis[i], static_cast<uint32_t>(b)});
        }
    }
    for (const WoodSample& s : samples)
        bounds.add(s.at.position);
    if (samples.empty()) return;
    low_ = bounds.min;
    const DVec3 size = bounds.size();
    cell_ = std::max(cell_, std::max({size.x, size.y, size.z}) / static_cast<double>(kMostPerAxis));
    size_t cells = 1;
    for (int axis_number = 0; axis_number < 3; axis_number++) {
        count_[axis_number] = static_cast<int64_t>(size[axis_number] / cell_) + 1;
        cells *= static_cast<size_t>(count_[axis_number]);
    }
    auto cell_of = [&](const WoodSample& s) {
        const DVec3 c = (s.at.position - low_) / cell_;
        return static_cast<size_t>((static_cast<int64_t>(c.x) * count_[1] + static_cast<int64_t>(c.y)) *
                                       count_[2] +
                                   static_cast<int64_t>(c.z));
    };
    begin_.assign(cells + 1, 0);
    for (const WoodSample& s : samples)
        begin_[cell_of(s) + 1]++;
    for (size_t c = 0; c < cells; c++)
        begin_[c + 1] += begin_[c];
    std::vector<uint32_t> fill(begin_.begin(), begin_.end() - 1);
    samples_.resize(samples.size());
    for (const WoodSample& s : samples)
        samples_[fill[cell_of(s)]++] = s;
}

const WoodSample* NearWood::nearest(const DVec3& p) const {
    if (samples_.empty()) return nullptr;
    const DVec3 at = (p - low_) / cell_;
    const WoodSample* best = nullptr;
    double best_distance = reach_;
    const int64_t rings = static_cast<int64_t>(std::ceil(reach_ / cell_));
    int64_t own[3];
    for (int axis = 0; axis < 3; axis++) {
        if (!(at[axis] > -1e6 && at[axis] < 1e6)) return nullptr;
        own[axis] = static_cast<int64_t>(std::floor(at[axis]));
    }
    // The squares of what is left to find, in metres and in cells.
    double most = best_distance * best_distance * kSlack;
    double most_cells = most / (cell_ * cell_) * kSlack + 1e-12;
    // Shell by shell: what lies in shell r is at least r - 1 cells away.
    for (int64_t ring = 0; ring <= rings; ring++) {
        if (best && best_distance < cell_ * static_cast<double>(ring - 1)) break;
        const int64_t x_first = std::max<int64_t>(own[0] - ring, 0);
        const int64_t x_last = std::min<int64_t>(own[0] + ring, count_[0] - 1);
        for (int64_t x = x_first; x <= x_last; x++) {
            const double across = gap(at.x, x) * gap(at.x, x);
            if (across > most_cells) continue;
            for (int64_t y = std::max<int64_t>(own[1] - ring, 0); y <= std::min(own[1] + ring, count_[1] - 1);
                 y++) {
                const double beside = across + gap(at.y, y) * gap(at.y, y);
                if (beside > most_cells) continue;
                const bool whole = std::abs(x - own[0]) == ring || std::abs(y - own[1]) == ring;
                const int64_t step = whole || ring == 0 ? 1 : 2 * ring;
                for (int64_t z = own[2] - ring; z <= own[2] + ring; z += step) {
                    if (z < 0 || z >= count_[2]) continue;
                    if (beside + gap(at.z, z) * gap(at.z, z) > most_cells) continue;
                    const auto cell = static_cast<size_t>((x * count_[1] + y) * count_[2] + z);
                    for (uint32_t i = begin_[cell]; i < begin_[cell + 1]; i++) {
                        const WoodSample& s = samples_[i];
                        const DVec3 off = s.at.position - p;
                        const double square = glm::dot(off, off);
                        if (square > most) continue;
                        const double distance =
                            std::sqrt(square) + kThickPenalty * std::max(0.0, s.at.radius - slender_);
                        if (distance > best_distance ||
                            (distance == best_distance && best && best->branch <= s.branch))
                            continue;
                        best = &s;
                        best_distance = distance;
                        most = distance * distance * kSlack;
                        most_cells = most / (cell_ * cell_) * kSlack + 1e-12;
                    }
                }
            }
        }
    }
    return best;
}

}  // namespace treerec
