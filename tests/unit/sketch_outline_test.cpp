// Outlines: simple ones are told from others, and what is made of any lines is simple.
#include "sketch/outline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "cases.h"
#include "geometry/random.h"

namespace treerec {
namespace {

// Of points with small whole coordinates, so that all is exact.
bool touch(const DVec2& a, const DVec2& b, const DVec2& c, const DVec2& d) {
    const auto side = [](const DVec2& p, const DVec2& q, const DVec2& r) {
        const double s = cross(q - p, r - p);
        return s > 0.0 ? 1 : s < 0.0 ? -1 : 0;
    };
    const auto between = [&](const DVec2& p, const DVec2& q, const DVec2& r) {
        return side(p, q, r) == 0 && glm::dot(p - r, q - r) <= 0.0;
    };
    if (between(a, b, c) || between(a, b, d) || between(c, d, a) || between(c, d, b)) return true;
    return side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
}

// By the definition: neighbours share their common point alone, others nothing.
bool plainly_simple(const FlatLine& polygon) {
    const size_t n = polygon.size();
    for (size_t i = 0; i < n; i++) {
        const DVec2 a = polygon[i], b = polygon[(i + 1) % n], c = polygon[(i + 2) % n];
        if (a == b || (cross(b - a, c - b) == 0.0 && glm::dot(b - a, c - b) < 0.0)) return false;
        for (size_t k = 0; k < n; k++) {
            if (k == i || (k + 1) % n == i || (i + 1) % n == k) continue;
            if (touch(a, b, polygon[k], polygon[(k + 1) % n])) return false;
        }
    }
    return true;
}

TEST(SketchOutline, SimpleIsWhatTheDefinitionSays) {
    Random random(4);
    int simple = 0;
    for (int k = 0; k < test::cases(20000); k++) {
        FlatLine polygon;
        const uint32_t side = 3 + random.below(12);
        for (size_t n = 3 + random.below(7); n > 0; n--)
            polygon.emplace_back(random.below(side), random.below(side));
        ASSERT_EQ(is_simple(polygon), plainly_simple(polygon)) << k;
        if (plainly_simple(polygon)) simple++;
    }
    EXPECT_GT(simple, test::cases(20000) / 20);
}

// The lines wind around what is inside: within a cell or two of the border, and where parts hang together.
TEST(SketchOutline, UnionsOfCirclesAreTheirs) {
    Random random(5);
    for (int k = 0; k < test::cases(100); k++) {
        struct Disc {
            DVec2 middle;
            double radius;
        };
        std::vector<Disc> discs;
        std::vector<FlatLine> lines;
        DVec2 at(500.0);
        for (size_t n = 2 + random.below(5); n > 0; n--) {
            const Disc disc{at, random.uniform(60.0, 150.0)};
            FlatLine line;
            for (int i = 0; i < 80; i++) {
                const double angle = 2.0 * kPi * i / 80.0 * (n % 2 == 0 ? 1.0 : -1.0);
                line.push_back(disc.middle + disc.radius * DVec2(std::cos(angle), std::sin(angle)));
            }
            at += 0.9 * disc.radius * DVec2(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
            discs.push_back(disc);
            lines.push_back(line);
        }
        const MadeOutline made = make_outline(lines);
        ASSERT_TRUE(made.united);
        ASSERT_TRUE(is_simple(made.polygon));
        ASSERT_GT(polygon_area(made.polygon), 0.0);
        for (const DVec2& p : made.polygon) {
            // On the border of the union.
            double depth = -1e9;
            for (const Disc& disc : discs)
                depth = std::max(depth, disc.radius - glm::length(p - disc.middle));
            EXPECT_LT(std::abs(depth), 4.0) << k;
        }
        for (const Disc& disc : discs)
            EXPECT_TRUE(is_inside(made.polygon, disc.middle)) << k;
    }
}

TEST(SketchOutline, HullsGoAroundAll) {
    Random random(6);
    for (int k = 0; k < test::cases(300); k++) {
        FlatLine points;
        for (size_t n = 1 + random.below(30); n > 0; n--)
            points.emplace_back(random.uniform(0.0, 100.0),
                                random.below(3) == 0 ? 50.0 : random.uniform(0.0, 100.0));
        const FlatLine around = outline_around(points, 5.0);
        ASSERT_TRUE(is_simple(around));
        ASSERT_GT(polygon_area(around), 0.0);
        FlatLine closed = around;
        closed.push_back(around[0]);
        for (const DVec2& p : points) {
            EXPECT_TRUE(is_inside(around, p));
            EXPECT_GT(nearest_on_line(closed, p).distance, 4.9);
        }
    }
}

TEST(SketchOutline, ALineAroundNothingIsNone) {
    FlatLine straight;
    for (int i = 0; i < 100; i++)
        straight.emplace_back(3.0 * i, 2.0 * i);
    EXPECT_TRUE(make_outline({straight}).polygon.empty());
    EXPECT_TRUE(make_outline({}).polygon.empty());
}

}  // namespace
}  // namespace treerec
