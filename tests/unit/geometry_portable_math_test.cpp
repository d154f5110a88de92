#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "geometry/portable_math.h"
#include "geometry/random.h"

namespace treerec {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const double kNone = std::numeric_limits<double>::quiet_NaN();

// The same number, the same kind of zero, or both none.
void expect_same(double got, double wanted, const char* what) {
    if (std::isnan(wanted)) {
        EXPECT_TRUE(std::isnan(got)) << what << ": " << got;
        return;
    }
    EXPECT_EQ(got, wanted) << what;
    EXPECT_EQ(std::signbit(got), std::signbit(wanted)) << what;
}

// Within `units` of the last place.
void expect_close(double got, double wanted, double units, const char* what, double x, double y = 0.0) {
    const double unit = std::nextafter(std::abs(wanted), kInfinity) - std::abs(wanted);
    EXPECT_LE(std::abs(got - wanted), units * unit) << what << " of " << x << ", " << y;
}

TEST(PortableMath, IsTheStandardLibrarysToSomeUnitsInTheLastPlace) {
    Random random(5);
    for (int i = 0; i < 20000; i++) {
        const double one = random.uniform(-1.0, 1.0);
        const double any = random.uniform(-50.0, 50.0);
        const double wide = std::exp(random.uniform(-40.0, 40.0));
        expect_close(portable::asin(one), std::asin(one), 6, "asin", one);
        expect_close(portable::acos(one), std::acos(one), 6, "acos", one);
        expect_close(portable::atan(any), std::atan(any), 6, "atan", any);
        expect_close(portable::atan(wide), std::atan(wide), 6, "atan", wide);
        expect_close(portable::atan2(any, one), std::atan2(any, one), 6, "atan2", any, one);
        expect_close(portable::atan2(one, any), std::atan2(one, any), 6, "atan2", one, any);
        expect_close(portable::exp(any), std::exp(any), 4, "exp", any);
        // Down to what has no exponent of its own left.
        const double small = -14.8 * std::abs(any), large = 14.1 * std::abs(any);
        expect_close(portable::exp(small), std::exp(small), 4, "exp", small);
        expect_close(portable::exp(large), std::exp(large), 4, "exp", large);
        expect_close(portable::log(wide), std::log(wide), 4, "log", wide);
        expect_close(portable::log(1.0 + 0.01 * one), std::log(1.0 + 0.01 * one), 4, "log", 1.0 + 0.01 * one);
        expect_close(portable::log2(wide), std::log2(wide), 6, "log2", wide);
        expect_close(portable::log10(wide), std::log10(wide), 6, "log10", wide);
        expect_close(portable::cbrt(any), std::cbrt(any), 4, "cbrt", any);
        expect_close(portable::hypot(any, wide), std::hypot(any, wide), 4, "hypot", any, wide);
        // An error of the logarithm counts as often as the result has twos.
        expect_close(portable::pow(wide, one), std::pow(wide, one), 80, "pow", wide, one);
        expect_close(portable::pow(std::abs(one), 0.42), std::pow(std::abs(one), 0.42), 10, "pow", one, 0.42);
        const double turn = random.uniform(-900.0, 900.0);
        EXPECT_NEAR(portable::sin(turn), std::sin(turn), 4e-16) << turn;
        EXPECT_NEAR(portable::cos(turn), std::cos(turn), 4e-16) << turn;
        const double far = random.uniform(-1e9, 1e9);
        EXPECT_NEAR(portable::sin(far), std::sin(far), 1e-7) << far;
        const auto f = static_cast<float>(wide);
        EXPECT_FLOAT_EQ(portable::log1p(f), std::log1p(f));
        EXPECT_FLOAT_EQ(portable::log(f), std::log(f));
        EXPECT_FLOAT_EQ(portable::hypot(f, 2.0f), std::hypot(f, 2.0f));
        EXPECT_FLOAT_EQ(portable::sin(0.01f * static_cast<float>(any)),
                        std::sin(0.01f * static_cast<float>(any)));
    }
}

TEST(PortableMath, HasTheStandardLibrarysSpecialCases) {
    const double odd[] = {0.0, -0.0, 1.0,       -1.0,       0.5,   -0.5,  2.0,   -2.0,
                          3.0, -3.0, kInfinity, -kInfinity, kNone, 1e300, -1e300};
    for (const double x : odd) {
        if (std::abs(x) != 0.5 && std::abs(x) < 1.5) {
            EXPECT_NEAR(portable::asin(x), std::asin(x), 1e-15);
            EXPECT_NEAR(portable::acos(x), std::acos(x), 1e-15);
        }
        if (std::abs(x) > 1.0 && !std::isnan(x)) {
            EXPECT_TRUE(std::isnan(portable::asin(x)));
            EXPECT_TRUE(std::isnan(portable::acos(x)));
        }
        for (const double y : odd) {
            SCOPED_TRACE(testing::Message() << x << ", " << y);
            const double angle = std::atan2(x, y), power = std::pow(x, y);
            if (std::isnan(angle))
                EXPECT_TRUE(std::isnan(portable::atan2(x, y)));
            else
                EXPECT_NEAR(portable::atan2(x, y), angle, 1e-15);
            EXPECT_EQ(std::signbit(portable::atan2(x, y)), std::signbit(angle));
            if (std::isfinite(power) && power != 0.0)
                EXPECT_NEAR(portable::pow(x, y) / power, 1.0, 1e-12);
            else
                expect_same(portable::pow(x, y), power, "pow");
        }
    }
    for (const double x : {kInfinity, -kInfinity, kNone, 0.0, 1000.0, -1000.0})
        expect_same(portable::exp(x), std::exp(x), "exp");
    for (const double x : {kInfinity, -kInfinity, kNone, 0.0, 1.0, -1.0})
        expect_same(portable::log(x), std::log(x), "log");
    for (const double x : {kInfinity, -kInfinity, kNone, 0.0, -0.0}) {
        expect_same(portable::cbrt(x), std::cbrt(x), "cbrt");
        expect_same(portable::atan(x), x == 0.0 || std::isnan(x) ? x : std::copysign(std::atan(kInfinity), x),
                    "atan");
    }
    for (const double x : {kInfinity, -kInfinity, kNone}) {
        EXPECT_TRUE(std::isnan(portable::sin(x)));
        EXPECT_TRUE(std::isnan(portable::cos(x)));
    }
    EXPECT_LE(std::abs(portable::sin(1e300)), 1.0);
}

TEST(PortableMath, PowersOfTenAndTwoAreWhole) {
    double ten = 1.0;
    for (int power = 0; power <= 22; power++, ten *= 10.0) {
        EXPECT_EQ(portable::pow(10.0, power), ten);
        EXPECT_EQ(portable::log10(ten), power);
        EXPECT_EQ(portable::pow(10.0, -power), 1.0 / ten);
        EXPECT_EQ(portable::log10(1.0 / ten), -power);
    }
    for (int power = -1000; power <= 1000; power += 7)
        EXPECT_EQ(portable::log2(std::ldexp(1.0, power)), power);
}

// Their bits, found once: another platform, compiler or option that changes them changes every tree.
TEST(PortableMath, HasTheseBits) {
    const auto all = [] {
        Random random(11);
        uint64_t bits = 0;
        const auto add = [&](double value) {
            bits = (bits ^ std::bit_cast<uint64_t>(value)) * 0x9E3779B97F4A7C15ull;
            bits ^= bits >> 29;
        };
        for (int i = 0; i < 1000; i++) {
            const double x = random.uniform(-9.0, 9.0), y = random.uniform(0.0, 5.0);
            add(portable::sin(x)), add(portable::cos(x)), add(portable::tan(x)), add(portable::atan2(x, y));
            add(portable::asin(x / 9.0)), add(portable::acos(x / 9.0)), add(portable::exp(x)),
                add(portable::log(y));
            add(portable::log10(y)), add(portable::pow(y, x)), add(portable::cbrt(x)),
                add(portable::hypot(x, y));
            add(random.normal());
        }
        return bits;
    }();
    EXPECT_EQ(all, 0x29dceec4b5cf1822ull) << std::hex << all;
}

}  // namespace
}  // namespace treerec
