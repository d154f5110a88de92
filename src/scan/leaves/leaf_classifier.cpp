#include "scan/leaves/leaf_classifier.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/parallel.h"
#include "geometry/portable_math.h"

namespace treerec {

namespace {

constexpr size_t kGrain = 256;
constexpr size_t kMost = 64;
constexpr std::array<size_t, kNearScales> kNearest{8, 16, 32, kMost};
// Of how far the nearest reach: so near to a line a point is on it. Few points reach less far, and their
// noise counts more.
constexpr std::array<float, kNearScales> kOnLine{0.15F, 0.12F, 0.06F, 0.04F};
constexpr float kNearLine = 0.1F;  // of the widest once more: thin branches are not that straight
constexpr float kOnContextLine = 0.12F;
constexpr float kFarEnough = 0.35F;  // of that reach: points that may tell a line's direction
constexpr int kWayBack = 4;          // steps to the ground that give a cell's direction
constexpr float kMostLogit = 20.0F;

// Points around one, one coordinate after the other, so that a line's are found many at a time.
struct Around {
    std::array<float, kMost> x{}, y{}, z{}, square{};
    std::array<float, kMost> weight{};  // how much each counts

    Vec3 at(size_t i) const { return {x[i], y[i], z[i]}; }
};

struct Line {
    float score = -1.0F;
    float span = 0.0F;    // of twice the reach
    float weight = 0.0F;  // of the points on it
    float mean = 0.0F;
    Vec3 along{0.0F, 1.0F, 0.0F};
};

// The lines through the point and one of `count` others with most of them on it, better where they lie to
// both sides; one for each of `widths` (of the reach). mean: of that weight, over all lines looked at. Of
// many points every second one is a direction enough.
template <size_t N>
std::array<Line, N> straightest(const Around& around, size_t count, float reach,
                                const std::array<float, N>& widths) {
    std::array<float, N> widest{}, sums{};
    for (size_t n = 0; n < N; n++)
        widest[n] = (widths[n] * reach) * (widths[n] * reach);
    const auto all = static_cast<float>(count);
    std::array<Line, N> best;
    float lines = 0.0F;
    const size_t step = count > 16 ? 2 : 1;
    std::array<float, kMost> t{}, off{};
    for (size_t j = count; j-- > 0;) {
        if (j % step != 0) continue;
        const float length = std::sqrt(around.square[j]);
        // The others are nearer still.
        if (length < kFarEnough * reach || !(length > 0.0F)) break;
        const Vec3 u = around.at(j) / length;
        for (size_t i = 0; i < count; i++) {
            t[i] = around.x[i] * u.x + around.y[i] * u.y + around.z[i] * u.z;
            off[i] = around.square[i] - t[i] * t[i];
        }
        lines += 1.0F;
        for (size_t n = 0; n < N; n++) {
            float weight = 0.0F, low = 0.0F, high = 0.0F;
            for (size_t i = 0; i < count; i++) {
                const float on = off[i] <= widest[n] ? 1.0F : 0.0F;
                weight += on * around.weight[i];
                low = std::min(low, on * t[i]);
                high = std::max(high, on * t[i]);
            }
            sums[n] += weight;
            const float score = weight / all * (0.5F + std::min(high, -low) / reach);
            if (score > best[n].score) best[n] = {score, (high - low) / (2.0F * reach), weight, 0.0F, u};
        }
    }
    for (size_t n = 0; n < N; n++)
        best[n].mean = lines > 0.0F ? sums[n] / lines : 0.0F;
    return best;
}

// The direction in which the path from the ground reaches a cell.
Vec3 heading_of(uint32_t cell, const Cells& cells, const CellPaths& paths) {
    uint32_t from = cell;
    for (int k = 0; k < kWayBack; k++)
        from = paths.parent[from];
    const Vec3 way = cells.centres[cell] - cells.centres[from];
    const float length = glm::length(way);
    return length > 0.0F ? way / length : Vec3(0.0F, 1.0F, 0.0F);
}

// The straightest line's score, span, the mean over all lines and its points as shares of all, how it lies to
// the path to the ground and to what is upright.
void line_inputs(const Line& line, size_t count, const Vec3& heading, float* inputs) {
    const float number = std::max(static_cast<float>(count), 1.0F);
    inputs[0] = line.score;
    inputs[1] = line.span;
    inputs[2] = line.mean / number;
    inputs[3] = line.weight / number;
    inputs[4] = std::abs(glm::dot(line.along, heading));
    inputs[5] = std::abs(line.along.y);
}

// Linearity, planarity and scatter of the nearest points and the point itself; the share of their variance
// along the path to the ground; ln of how far they reach, in cells; how far their mean lies from the point,
// of their reach.
void near_inputs(const Around& around, size_t count, float cell, const Vec3& heading, float* inputs) {
    const float reach = count > 0 ? std::sqrt(around.square[count - 1]) : 0.0F;
    const float share = 1.0F / static_cast<float>(count + 1);
    Vec3 mean(0.0F);
    for (size_t k = 0; k < count; k++)
        mean += share * around.at(k);
    std::array<float, 6> c{};
    add_product(c, -mean, share);
    for (size_t k = 0; k < count; k++)
        add_product(c, around.at(k) - mean, share);
    const Vec3 s = deviations(c);
    const float first = std::max(s.x, 1e-9F);
    const float along =
        c[0] * heading.x * heading.x + c[3] * heading.y * heading.y + c[5] * heading.z * heading.z +
        2.0F * (c[1] * heading.x * heading.y + c[2] * heading.x * heading.z + c[4] * heading.y * heading.z);
    inputs[0] = (s.x - s.y) / first;
    inputs[1] = (s.y - s.z) / first;
    inputs[2] = s.z / first;
    inputs[3] = along / (c[0] + c[3] + c[5] + 1e-12F);
    inputs[4] = portable::log(reach / cell + 1e-3F);
    inputs[5] = glm::length(mean) / (reach + 1e-9F);
}

float chance(float logit) {
    return 1.0F / (1.0F + portable::exp(-std::clamp(logit, -kMostLogit, kMostLogit)));
}

}  // namespace

void cell_inputs(const CellShape* shapes, const CellPath& path, float* inputs) {
    size_t at = 0;
    for (int s = 0; s < kShapeScales; s++) {
        if (s + 1 < kShapeScales) {
            inputs[at++] = shapes[s].linearity;
            inputs[at++] = shapes[s].planarity;
        }
        inputs[at++] = shapes[s].scatter;
        inputs[at++] = shapes[s].occupied / 26.0F;
        inputs[at++] = shapes[s].crowd;
    }
    for (const float value : {path.height, path.mass, path.chain, path.chain_mass, path.straight_short,
                              path.straight_long, path.gap, path.bush_8, path.bush_16, path.bush_32})
        inputs[at++] = value;
}

LeafClassifier::LeafClassifier(const std::vector<Vec3>& points, const Cells& cells, const CellShapes& shapes,
                               const CellPaths& paths, const Progress& progress)
    : points_(points), cells_(cells), paths_(paths), shapes_(shapes), progress_(progress), tree_(points) {}

std::vector<float> LeafClassifier::run(const LeafNetwork& network, const std::vector<float>& inputs) const {
    std::vector<float> logits(points_.size());
    parallel_for(points_.size(), kGrain, [&](size_t begin, size_t end) {
        progress_.check();
        for (size_t i = begin; i < end; i++)
            logits[i] = network.logit(&inputs[i * network.inputs()]);
    });
    return logits;
}

std::vector<float> LeafClassifier::point_inputs() const {
    const auto cell = static_cast<float>(cells_.size);
    std::vector<float> inputs(points_.size() * kPointInputs);
    parallel_for(points_.size(), kGrain, [&](size_t begin, size_t end) {
        progress_.check();
        std::array<uint32_t, kMost + 1> found{};
        std::array<float, kMost + 1> squares{};
        Around around;
        around.weight.fill(1.0F);
        for (size_t i = begin; i < end; i++) {
            float* at = &inputs[i * kPointInputs];
            const uint32_t v = cells_.of_point[i];
            cell_inputs(&shapes_[v * kShapeScales], paths_.paths[v], at);
            at += kCellInputs;
            const Vec3 heading = heading_of(v, cells_, paths_);
            const size_t others = tree_.nearest(points_[i], kMost + 1, found.data(), squares.data()) - 1;
            for (size_t k = 0; k < others; k++) {
                const Vec3 d = points_[found[k + 1]] - points_[i];
                around.x[k] = d.x;
                around.y[k] = d.y;
                around.z[k] = d.z;
                around.square[k] = glm::dot(d, d);
            }
            for (size_t s = 0; s < kNearScales; s++, at += kShapeInputs)
                near_inputs(around, std::min(kNearest[s], others), cell, heading, at);
            for (size_t s = 0; s < kNearScales; s++) {
                const size_t count = std::min(kNearest[s], others);
                const float reach = count > 0 ? std::sqrt(around.square[count - 1]) : 0.0F;
                const auto lines = straightest<2>(around, count, reach, {kOnLine[s], kNearLine});
                line_inputs(lines[0], count, heading, at);
                at += kLineInputs;
                if (s + 1 < kNearScales) continue;
                line_inputs(lines[1], count, heading, at);
            }
        }
    });
    return inputs;
}

std::vector<float> LeafClassifier::context_inputs(const std::vector<float>& logits) const {
    const size_t cells = cells_.count();
    std::vector<float> mean(cells, 0.0F), number(cells, 0.0F);
    std::vector<float> wood(points_.size());
    for (size_t i = 0; i < points_.size(); i++) {
        mean[cells_.of_point[i]] += logits[i];
        number[cells_.of_point[i]] += 1.0F;
        wood[i] = chance(-logits[i]);
    }
    for (size_t v = 0; v < cells; v++)
        mean[v] /= std::max(number[v], 1.0F);

    // Of what hangs on a cell: the mean, and along the most woody of its paths, what is near counting more.
    constexpr float kFade = 0.8F;
    std::vector<float> beyond = mean, mass(cells, 1.0F), woody(cells, kMostLogit);
    for (auto v = paths_.order.rbegin(); v != paths_.order.rend(); ++v) {
        const uint32_t p = paths_.parent[*v];
        const float own = woody[*v] < kMostLogit ? kFade * woody[*v] + (1.0F - kFade) * mean[*v] : mean[*v];
        if (p == *v) continue;
        beyond[p] += beyond[*v];
        mass[p] += mass[*v];
        woody[p] = std::min(woody[p], own);
    }

    std::vector<float> inputs(points_.size() * kContextInputs);
    parallel_for(points_.size(), kGrain, [&](size_t begin, size_t end) {
        progress_.check();
        std::array<uint32_t, kLooked + 1> found{};
        std::array<float, kLooked + 1> squares{};
        Around around;
        for (size_t i = begin; i < end; i++) {
            float* at = &inputs[i * kContextInputs];
            const uint32_t v = cells_.of_point[i];
            const size_t others = tree_.nearest(points_[i], kLooked + 1, found.data(), squares.data()) - 1;
            float near = 0.0F, square = 0.0F, least = logits[i];
            *at++ = logits[i];
            for (size_t k = 0; k < others; k++) {
                const uint32_t q = found[k + 1];
                const Vec3 d = points_[q] - points_[i];
                around.x[k] = d.x;
                around.y[k] = d.y;
                around.z[k] = d.z;
                around.square[k] = glm::dot(d, d);
                around.weight[k] = wood[q];
                near += logits[q];
                square += logits[q] * logits[q];
                if (k < 16) least = std::min(least, logits[q]);
                if (k == 3 || k == 7 || k == 15 || k == 31) *at++ = near / static_cast<float>(k + 1);
            }
            // A cloud of fewer points than that has no leaves to tell.
            at = &inputs[i * kContextInputs + 5];
            const float count = std::max(static_cast<float>(others), 1.0F);
            *at++ = least;
            *at++ = std::sqrt(std::max(0.0F, square / count - near * near / (count * count)));
            const float reach = others > 0 ? std::sqrt(around.square[others - 1]) : 0.0F;
            const Line line = straightest<1>(around, others, reach, {kOnContextLine})[0];
            float on = 0.0F, on_logit = 0.0F;
            for (size_t k = 0; k < others; k++) {
                const float t = glm::dot(around.at(k), line.along);
                if (around.square[k] - t * t > (kOnContextLine * reach) * (kOnContextLine * reach)) continue;
                on += 1.0F;
                on_logit += logits[found[k + 1]];
            }
            *at++ = line.score;
            *at++ = on_logit / std::max(on, 1.0F);
            *at++ = line.weight / count;
            *at++ = on / count;
            *at++ = line.mean / count;
            *at++ = mean[v];
            float path = 0.0F;
            uint32_t u = v;
            for (int k = 1; k <= 64; k++) {
                u = paths_.parent[u];
                path += mean[u];
                if ((k & (k - 1)) == 0 && k > 1) *at++ = path / static_cast<float>(k);
            }
            *at++ = beyond[v] / mass[v];
            *at++ = woody[v] < kMostLogit ? woody[v] : mean[v];
        }
    });
    return inputs;
}

std::vector<float> LeafClassifier::logits(const LeafWeights& weights) const {
    const LeafNetwork point(weights.point, kPointInputs), context(weights.context, kContextInputs);
    return run(context, context_inputs(run(point, point_inputs())));
}

}  // namespace treerec
