// Sine, logarithm and the like that are the same to the last bit on every platform; the standard library's
// are not, not even on two processors of one system. From additions, multiplications, divisions and roots,
// which IEEE 754 rounds in one way alone (the build forbids fused ones). Special cases as in <cmath>.
#pragma once

#include <cmath>

#include "geometry/portable_trig.h"

namespace treerec::portable {

// All angles in radians. Errors: a few units in the last place; those of pow() grow with the result's
// exponent, to some hundred.
inline double sin(double x) {
    return portable_sine_cosine(x).sine;
}
inline double cos(double x) {
    return portable_sine_cosine(x).cosine;
}
inline double tan(double x) {
    const SineCosine by = portable_sine_cosine(x);
    return by.sine / by.cosine;
}
double atan(double x);
double atan2(double y, double x);
double asin(double x);
double acos(double x);
double exp(double x);
double log(double x);
double log2(double x);
double log10(double x);
double pow(double x, double y);
double cbrt(double x);
inline double hypot(double x, double y) {
    return std::sqrt(x * x + y * y);
}

// Of floats: rounded from the above.
inline float sin(float x) {
    return static_cast<float>(sin(static_cast<double>(x)));
}
inline float cos(float x) {
    return static_cast<float>(cos(static_cast<double>(x)));
}
inline float log(float x) {
    return static_cast<float>(log(static_cast<double>(x)));
}
inline float log1p(float x) {
    const double wide = x;
    return static_cast<float>(std::abs(wide) < 1e-5 ? wide * (1.0 - 0.5 * wide) : log(1.0 + wide));
}
inline float hypot(float x, float y) {
    return static_cast<float>(hypot(static_cast<double>(x), static_cast<double>(y)));
}

}  // namespace treerec::portable
