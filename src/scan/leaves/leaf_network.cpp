#include "scan/leaves/leaf_network.h"

#include <algorithm>

#include "error.h"

namespace treerec {

namespace {

constexpr float kReach = 3.0F;

// Sums are taken in one order, so that all machines find the same.
template <size_t N>
void add_layer(const float* from, size_t count, const float* weights, std::array<float, N>& sums) {
    for (size_t i = 0; i < count; i++)
        for (size_t h = 0; h < N; h++)
            sums[h] += from[i] * weights[i * N + h];
    for (size_t h = 0; h < N; h++)
        sums[h] = std::max(sums[h] + weights[count * N + h], 0.0F);
}

}  // namespace

LeafNetwork::LeafNetwork(std::span<const float> weights, size_t inputs)
    : inputs_(inputs), weights_(weights.begin(), weights.end()) {
    if (weights.size() != weights_for(inputs))
        throw Error("The weights for leaves are " + std::to_string(weights.size()) + " numbers and not " +
                    std::to_string(weights_for(inputs)) + ".");
}

float LeafNetwork::logit(const float* values) const {
    const float* mean = weights_.data();
    const float* deviation = mean + inputs_;
    const float* first = deviation + inputs_;
    const float* second = first + (inputs_ + 1) * kFirst;
    const float* last = second + (kFirst + 1) * kSecond;
    std::array<float, kFirst> hidden{};
    std::array<float, kSecond> deeper{};
    for (size_t i = 0; i < inputs_; i++) {
        const float value = std::clamp((values[i] - mean[i]) / deviation[i], -kReach, kReach);
        for (size_t h = 0; h < kFirst; h++)
            hidden[h] += value * first[i * kFirst + h];
    }
    for (size_t h = 0; h < kFirst; h++)
        hidden[h] = std::max(hidden[h] + first[inputs_ * kFirst + h], 0.0F);
    add_layer(hidden.data(), kFirst, second, deeper);
    float sum = last[kSecond];
    for (size_t h = 0; h < kSecond; h++)
        sum += deeper[h] * last[h];
    return sum;
}

const LeafWeights& LeafWeights::fitted() {
    static const LeafWeights weights{{
#include "scan/leaves/leaf_point_weights.inc"
                                     },
                                     {
#include "scan/leaves/leaf_context_weights.inc"
                                     }};
    return weights;
}

}  // namespace treerec
