// Logarithm, exponential and power that are the same to the last bit on every platform; the standard
// library's are not.
#pragma once

#include <cmath>

namespace treerec {

// Of x > 0, finite; to 1e-15 of the larger of 1 and the result. 2 artanh((x - 1) / (x + 1)) as a series,
// after taking out powers of two.
inline double portable_log(double x) {
    int exponent = 0;
    double m = std::frexp(x, &exponent);
    if (m < 0.70710678118654752) {
        m *= 2.0;
        exponent--;
    }
    const double z = (m - 1.0) / (m + 1.0), square = z * z;
    double sum = 0.0;
    for (int k = 25; k >= 1; k -= 2)
        sum = 1.0 / k + square * sum;
    return 2.0 * z * sum + exponent * 0.69314718055994531;
}

// Of |x| up to some hundred; to 1e-14 of the result.
inline double portable_exp(double x) {
    // ln 2 in two parts, so that the rest keeps its digits.
    constexpr double kLog2 = 0.693147180369123816490, kLog2Rest = 1.90821492927058770002e-10;
    const double twos = std::floor(x * 1.4426950408889634 + 0.5);
    const double r = (x - twos * kLog2) - twos * kLog2Rest;
    double sum = 1.0;
    for (int k = 15; k >= 1; k--)
        sum = 1.0 + sum * r / k;
    return std::ldexp(sum, static_cast<int>(twos));
}

// base > 0.
inline double portable_power(double base, double exponent) {
    return portable_exp(exponent * portable_log(base));
}

}  // namespace treerec
