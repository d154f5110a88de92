#include "skeleton/radii.h"

#include <algorithm>
#include <cmath>

namespace treerec {

namespace {

constexpr double kThinnest = 0.001;      // metres
constexpr double kTipAllowance = 0.003;  // metres: an unmeasured twig's tip
constexpr double kSlenderness = 0.02;    // unmeasured radius over the distance to the tip, at most
constexpr double kSoftWeight = 0.05;     // of an unmeasured station beside a measured one
constexpr int kMedianWindow = 4;         // stations to each side

struct Block {
    double value;
    double weight;
    size_t count;
};

// Weighted least squares fit of a sequence that never rises.
std::vector<double> falling_fit(const std::vector<double>& values, const std::vector<double>& weights) {
    std::vector<Block> blocks;
    for (size_t i = 0; i < values.size(); i++) {
        Block block{values[i], weights[i], 1};
        while (!blocks.empty() && blocks.back().value < block.value) {
            const Block& last = blocks.back();
            const double weight = last.weight + block.weight;
            block.value = (last.value * last.weight + block.value * block.weight) / weight;
            block.weight = weight;
            block.count += last.count;
            blocks.pop_back();
        }
        blocks.push_back(block);
    }
    std::vector<double> fitted;
    fitted.reserve(values.size());
    for (const Block& block : blocks)
        fitted.insert(fitted.end(), block.count, block.value);
    return fitted;
}

// Each radius becomes the median of those of its own kind (measured or not) around it.
void running_median(std::vector<Station>& stations) {
    std::vector<double> radius(stations.size());
    std::vector<double> near;
    const int count = static_cast<int>(stations.size());
    for (int i = 0; i < count; i++) {
        near.clear();
        for (int j = std::max(0, i - kMedianWindow); j <= std::min(count - 1, i + kMedianWindow); j++)
            if (stations[j].measured == stations[i].measured && stations[j].radius > 0.0)
                near.push_back(stations[j].radius);
        radius[i] = 0.0;
        if (near.empty()) continue;
        std::sort(near.begin(), near.end());
        radius[i] = 0.5 * (near[near.size() / 2] + near[(near.size() - 1) / 2]);
    }
    for (int i = 0; i < count; i++)
        stations[i].radius = radius[i];
}

}  // namespace

void infer_radii(std::vector<std::vector<Station>>& axes, const std::vector<Limb>& limbs) {
    std::vector<double> values;
    std::vector<double> weights;
    for (size_t l = 0; l < axes.size(); l++) {
        std::vector<Station>& stations = axes[l];
        running_median(stations);
        double limit = std::numeric_limits<double>::max();
        if (limbs[l].parent >= 0) limit = axes[limbs[l].parent][limbs[l].attach].radius;

        double to_tip = 0.0;
        values.assign(stations.size(), 0.0);
        weights.assign(stations.size(), 1.0);
        for (size_t i = stations.size(); i-- > 0;) {
            const Station& station = stations[i];
            if (station.measured) {
                values[i] = station.radius;
            } else {
                const double most = kTipAllowance + kSlenderness * to_tip;
                values[i] = station.radius > 0.0 ? std::min(station.radius, most) : most;
                weights[i] = kSoftWeight;
            }
            if (i > 0) to_tip += glm::distance(station.position, stations[i - 1].position);
        }
        const std::vector<double> fitted = falling_fit(values, weights);
        for (size_t i = 0; i < stations.size(); i++) {
            limit = std::max(kThinnest, std::min(limit, fitted[i]));
            stations[i].radius = limit;
        }
    }
}

}  // namespace treerec
