// A logistic rule on how cells lie, as a table. Internal to scan/.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "scan/leaves/leaf_cells.h"

namespace treerec {

struct Term {
    float mean;
    float deviation;
    float weight;  // of the standardised value; the sum is the logit of being leaf at even odds
};
// By scale: linearity, planarity, scatter, occupied, crowd.
using ShapeTerms = std::array<std::array<Term, 5>, kShapeScales>;

inline float value_of(float value, const Term& term) {
    constexpr float kReach = 3.0F;  // standard deviations: what lies further out says no more
    return term.weight * std::clamp((value - term.mean) / term.deviation, -kReach, kReach);
}

// shapes: kShapeScales of them.
inline float sum_of_terms(const CellShape* shapes, const ShapeTerms& all) {
    float sum = 0.0F;
    for (size_t s = 0; s < kShapeScales; s++) {
        const std::array<Term, 5>& terms = all[s];
        sum += value_of(shapes[s].linearity, terms[0]) + value_of(shapes[s].planarity, terms[1]) +
               value_of(shapes[s].scatter, terms[2]) + value_of(shapes[s].occupied / 26.0F, terms[3]) +
               value_of(shapes[s].crowd, terms[4]);
    }
    return sum;
}

}  // namespace treerec
