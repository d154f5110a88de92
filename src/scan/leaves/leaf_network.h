// A small perceptron, whose weights tests/bench/fit_leaves.py finds. Internal to scan/.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace treerec {

// Two hidden layers of rectified units on standardised inputs; the result is a logit. What lies further out
// than three standard deviations says no more.
class LeafNetwork {
  public:
    static constexpr size_t kFirst = 32, kSecond = 16;  // units
    static constexpr size_t weights_for(size_t inputs) {
        return 2 * inputs + (inputs + 1) * kFirst + (kFirst + 1) * kSecond + kSecond + 1;
    }

    // weights: means and deviations of the inputs, then the layers', those of one input after another, each
    // with its biases behind. Throws Error where there are not as many as these inputs want.
    LeafNetwork(std::span<const float> weights, size_t inputs);

    size_t inputs() const { return inputs_; }
    float logit(const float* values) const;

  private:
    size_t inputs_;
    std::vector<float> weights_;
};

// The weights of both networks (leaf_classifier.h), one after the other.
struct LeafWeights {
    std::vector<float> point, context;

    static const LeafWeights& fitted();
};

}  // namespace treerec
