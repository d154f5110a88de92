// Sine and cosine that are the same to the last bit on every platform; the standard library's are not. See
// geometry/portable_math.h for the other functions.
#pragma once

#include <cmath>
#include <numbers>

namespace treerec {

struct SineCosine {
    double sine = 0.0;
    double cosine = 1.0;
};

// Of `radians`, to 1e-15; beyond a million the digits that a double lacks are missing here too, and what is
// no number or infinite gives no numbers. Taylor series about the nearest quarter turn, from additions and
// multiplications alone (the build forbids fused ones).
inline SineCosine portable_sine_cosine(double radians) {
    // pi/2 in two parts, so that the rest keeps its digits.
    constexpr double kQuarter = 1.5707963267341256, kQuarterRest = 6.077100506506192e-11;
    if (std::abs(radians) > 1e6) radians = std::fmod(radians, 2.0 * std::numbers::pi);
    const double quarters = std::floor(radians * (1.0 / 1.5707963267948966) + 0.5);
    const double x = (radians - quarters * kQuarter) - quarters * kQuarterRest;
    const double y = x * x;
    // Both series side by side: two divisions take as long as one, and none waits for another. The constants
    // are whole, so the order of their products is no matter.
    using Both = double __attribute__((vector_size(16)));
    const Both squares{y, y};
    const auto next = [&](double n, const Both& sum) {
        return 1.0 - squares / Both{n * (n + 1.0), n * (n - 1.0)} * sum;
    };
    Both sums{1.0, 1.0};
    sums = next(18.0, sums);
    sums = next(16.0, sums);
    sums = next(14.0, sums);
    sums = next(12.0, sums);
    sums = next(10.0, sums);
    sums = next(8.0, sums);
    sums = next(6.0, sums);
    sums = next(4.0, sums);
    sums = next(2.0, sums);
    const double s = x * sums[0], c = sums[1];
    const double turn = quarters - 4.0 * std::floor(quarters * 0.25);
    if (turn == 1.0) return {c, -s};
    if (turn == 2.0) return {-s, -c};
    if (turn == 3.0) return {-c, s};
    return {s, c};
}

}  // namespace treerec
