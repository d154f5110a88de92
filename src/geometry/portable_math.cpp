#include "geometry/portable_math.h"

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <numbers>

namespace treerec::portable {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kHalfPi = std::numbers::pi / 2.0;
// ln 2 in two parts: a whole number of the first one is exact.
constexpr double kLn2 = 6.93147180369123816490e-01, kLn2Rest = 1.90821492927058770002e-10;

// 1 / n; a division takes as long as the rest of a series.
constexpr std::array<double, 24> kInverse = [] {
    std::array<double, 24> inverse{};
    for (int n = 1; n < 24; n++)
        inverse[static_cast<size_t>(n)] = 1.0 / n;
    return inverse;
}();

// Of 0..1, without special cases.
double small_atan(double x) {
    // atan x = 2 atan(x / (1 + sqrt(1 + x^2))), twice: then the series ends soon.
    x = x / (1.0 + std::sqrt(1.0 + x * x));
    x = x / (1.0 + std::sqrt(1.0 + x * x));
    const double y = x * x;
    double sum = kInverse[23];
    for (size_t n = 23; n > 1; n -= 2)
        sum = kInverse[n - 2] - y * sum;
    return 4.0 * x * sum;
}

// x to a whole power, by squaring.
double whole_pow(double x, unsigned power) {
    double result = 1.0;
    for (; power; power >>= 1, x *= x)
        if (power & 1u) result *= x;
    return result;
}

}  // namespace

double atan(double x) {
    const double size = std::abs(x);
    if (!(size > 0.0)) return x;  // also -0 and what is no number
    return std::copysign(size <= 1.0 ? small_atan(size) : kHalfPi - small_atan(1.0 / size), x);
}

double atan2(double y, double x) {
    if (std::isnan(x) || std::isnan(y)) return x + y;
    const double up = std::abs(y), along = std::abs(x);
    double angle = 0.0;  // in the first quarter
    if (up == along)
        angle = up == 0.0 ? 0.0 : kHalfPi / 2.0;
    else if (up < along)
        angle = small_atan(up / along);
    else
        angle = kHalfPi - small_atan(along / up);
    return std::copysign(std::signbit(x) ? std::numbers::pi - angle : angle, y);
}

double asin(double x) {
    return atan2(x, std::sqrt((1.0 - x) * (1.0 + x)));
}

double acos(double x) {
    return atan2(std::sqrt((1.0 - x) * (1.0 + x)), x);
}

double exp(double x) {
    if (std::isnan(x)) return x;
    if (x > 709.8) return kInfinity;
    if (x < -745.2) return 0.0;
    const double twos = std::floor(x / (kLn2 + kLn2Rest) + 0.5);
    const double rest = (x - twos * kLn2) - twos * kLn2Rest;  // up to 0.35
    double sum = 1.0;
    for (size_t n = 14; n >= 1; n--)
        sum = 1.0 + rest * sum * kInverse[n];
    const auto power = static_cast<int64_t>(twos);
    // A power of two that is a normal number is its exponent's bits.
    if (std::abs(power) < 1020) return sum * std::bit_cast<double>(static_cast<uint64_t>(1023 + power) << 52);
    return std::ldexp(sum, static_cast<int>(power));
}

double log(double x) {
    if (x == 0.0) return -kInfinity;
    if (x < 0.0) return std::numeric_limits<double>::quiet_NaN();
    if (!(x < kInfinity)) return x;
    int twos = 0;
    double part = std::frexp(x, &twos);
    if (part < std::numbers::sqrt2 / 2.0) {
        part *= 2.0;
        twos--;
    }
    // ln m = 2 artanh s with s = (m - 1) / (m + 1), up to 0.172.
    const double s = (part - 1.0) / (part + 1.0);
    const double y = s * s;
    double sum = kInverse[23];
    for (size_t n = 23; n > 3; n -= 2)
        sum = kInverse[n - 2] + y * sum;
    // 2 s + 2 s y sum, the larger part last.
    return twos * kLn2 + (2.0 * s + (2.0 * s * y * sum + twos * kLn2Rest));
}

double log2(double x) {
    if (!(x > 0.0 && x < kInfinity)) return log(x);
    int twos = 0;
    const double part = std::frexp(x, &twos);
    return part == 0.5 ? twos - 1.0 : log(x) / std::numbers::ln2;
}

double log10(double x) {
    const double power = log(x) / std::numbers::ln10;
    // Powers of ten come out whole, for they are asked how many digits a number has.
    const double whole = std::floor(power + 0.5);
    return std::abs(whole) <= 22.0 && pow(10.0, whole) == x ? whole : power;
}

double pow(double x, double y) {
    if (y == 0.0 || x == 1.0) return 1.0;
    if (std::isnan(x) || std::isnan(y)) return x + y;
    const bool whole = std::floor(y) == y;
    if (whole && std::abs(y) <= 1024.0) {
        const auto power = static_cast<unsigned>(std::abs(y));
        if (y > 0.0) return whole_pow(x, power);
        const double below = whole_pow(x, power);
        // Beyond the largest number its inverse may still be one.
        if (std::isfinite(below) || std::isinf(x)) return 1.0 / below;
        return whole_pow(1.0 / x, power);
    }
    if (y == 0.5 && x > 0.0) return std::sqrt(x);
    const double size = std::abs(x);
    const bool odd = whole && std::isfinite(y) && std::fmod(y, 2.0) != 0.0;
    if (x < 0.0 && !whole && size < kInfinity) return std::numeric_limits<double>::quiet_NaN();
    if (size == 1.0) return odd && x < 0.0 ? -1.0 : 1.0;  // also to an infinite power
    const double result = exp(y * log(size));
    return odd && std::signbit(x) ? -result : result;
}

double cbrt(double x) {
    const double size = std::abs(x);
    if (!(size > 0.0) || size == kInfinity) return x;
    double root = exp(log(size) / 3.0);
    root -= (root - size / (root * root)) / 3.0;
    return std::copysign(root, x);
}

}  // namespace treerec::portable
