// SVG drawings as sketches.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "drawn_sketch.h"
#include "geometry/random.h"
#include "sketch/read_sketch.h"
#include "sketch_sentences.h"

namespace treerec {
namespace {

using test::expect_says;
using test::Polyline;
using test::svg_fault;

// The lines of a drawing whose canvas is 1000 pixels high.
std::vector<Polyline> lines_of(const std::string& body) {
    std::vector<Polyline> lines;
    for (const Stroke& stroke : parse_sketch_svg("<svg viewBox='0 0 1000 1000'>" + body + "</svg>").strokes)
        lines.push_back(stroke.points);
    return lines;
}

std::vector<Polyline> path(const std::string& data) {
    return lines_of("<path d='" + data + "'/>");
}

using Lines = std::vector<Polyline>;

TEST(SketchSvg, StraightCommandsAreExact) {
    const Lines square = {{{10, 20}, {110, 20}, {110, 120}, {10, 120}, {10, 20}}};
    EXPECT_EQ(path("M10 20L110 20L110 120L10 120Z"), square);
    EXPECT_EQ(path("m10,20 l100,0 0,100 -100,0 z"), square);
    EXPECT_EQ(path("M10 20 110 20V120H10z"), square);
    EXPECT_EQ(path("M10 20h100v100h-100V20"), square);
    EXPECT_EQ(path("m10 20 1e2.0 0+100-100 0z"), square);
    EXPECT_EQ(path("M 1.5.5 L2-3 z"), (Lines{{{1.5, 0.5}, {2, -3}, {1.5, 0.5}}}));
    // Several parts; after Z from where the part began; moves that draw nothing.
    EXPECT_EQ(path("M1 2L3 4M5 6M7 8l1 1zl2 0"),
              (Lines{{{1, 2}, {3, 4}}, {{7, 8}, {8, 9}, {7, 8}}, {{7, 8}, {9, 8}}}));
    EXPECT_EQ(lines_of("<polyline points='1,2 3,4, 5 6'/>"), (Lines{{{1, 2}, {3, 4}, {5, 6}}}));
    EXPECT_EQ(lines_of("<polygon points='1,2 3,4 5,6'/>"), (Lines{{{1, 2}, {3, 4}, {5, 6}, {1, 2}}}));
    EXPECT_EQ(lines_of("<line x1='1' y1='2' x2='30px' y2='4'/>"), (Lines{{{1, 2}, {30, 4}}}));
}

// How far a curve, given as a function of 0 to 1, is from the lines, and they from it.
template <typename Curve>
double off_curve(const Polyline& line, const Curve& curve) {
    double worst = 0.0;
    Polyline fine;
    for (int i = 0; i <= 2000; i++) {
        fine.push_back(curve(i / 2000.0));
        worst = std::max(worst, test::distance_to(fine.back(), line));
    }
    for (const DVec2& p : line)
        worst = std::max(worst, test::distance_to(p, fine));
    return worst;
}

DVec2 cubic(const DVec2& a, const DVec2& b, const DVec2& c, const DVec2& d, double t) {
    const double s = 1.0 - t;
    return s * s * s * a + 3.0 * s * s * t * b + 3.0 * s * t * t * c + t * t * t * d;
}

TEST(SketchSvg, CurvesAreWithinAQuarterPixel) {
    Random random(4);
    const auto any = [&] {
        return DVec2(std::floor(random.uniform(0.0, 1000.0)), std::floor(random.uniform(0.0, 1000.0)));
    };
    const auto text = [](const DVec2& p) {
        return std::to_string(int(p.x)) + "," + std::to_string(int(p.y)) + " ";
    };
    for (int i = 0; i < 100; i++) {
        const DVec2 a = any(), b = any(), c = any(), d = any(), e = any(), f = any();
        const auto first = [&](double t) { return cubic(a, b, c, d, t); };
        const auto both = [&](double t) {
            return t < 0.5 ? first(2.0 * t) : cubic(d, 2.0 * d - c, e, f, 2.0 * t - 1.0);
        };
        EXPECT_LT(off_curve(path("M" + text(a) + "C" + text(b) + text(c) + text(d))[0], first), 0.26);
        EXPECT_LT(
            off_curve(path("M" + text(a) + "C" + text(b) + text(c) + text(d) + "S" + text(e) + text(f))[0],
                      both),
            0.26);
        EXPECT_LT(off_curve(path("M" + text(a) + "c" + text(b - a) + text(c - a) + text(d - a) + "s" +
                                 text(e - d) + text(f - d))[0],
                            both),
                  0.26);
        const auto quadratic = [](const DVec2& p, const DVec2& q, const DVec2& r, double t) {
            return (1.0 - t) * (1.0 - t) * p + 2.0 * t * (1.0 - t) * q + t * t * r;
        };
        const auto waves = [&](double t) {
            return t < 0.5 ? quadratic(a, b, c, 2.0 * t) : quadratic(c, 2.0 * c - b, d, 2.0 * t - 1.0);
        };
        EXPECT_LT(off_curve(path("M" + text(a) + "Q" + text(b) + text(c) + "T" + text(d))[0], waves), 0.26);
        EXPECT_LT(
            off_curve(path("M" + text(a) + "q" + text(b - a) + text(c - a) + "t" + text(d - c))[0], waves),
            0.26);
    }
    // Without a curve before, S and T bend as if their control were where they begin.
    EXPECT_LT(off_curve(path("M0 0S100 0 100 100")[0],
                        [](double t) {
                            return cubic({0, 0}, {0, 0}, {100, 0}, {100, 100}, t);
                        }),
              0.26);
    EXPECT_LT(test::apart(path("M0 0L50 0T100 0")[0], {{0, 0}, {100, 0}}), 1e-9);
    // No more points than they need.
    EXPECT_LT(path("M0 0C0 500 500 1000 1000 1000")[0].size(), 60U);
    EXPECT_EQ(path("M0 0C10 10 20 20 30 30")[0].size(), 2U);
}

TEST(SketchSvg, ArcsAreOnTheirEllipse) {
    Random random(5);
    for (int i = 0; i < 200; i++) {
        const DVec2 radii(std::floor(random.uniform(50.0, 400.0)), std::floor(random.uniform(50.0, 400.0)));
        const double turn = std::floor(random.uniform(-180.0, 180.0)), angle = turn * kPi / 180.0;
        const double from = random.uniform(0.0, 2.0 * kPi);
        double sweep = random.uniform(-6.0, 6.0);
        if (std::abs(std::abs(sweep) - kPi) < 0.05) sweep = 1.0;
        const auto at = [&](double t) {
            const double u = radii.x * std::cos(from + t * sweep), v = radii.y * std::sin(from + t * sweep);
            return DVec2(500.0 + std::cos(angle) * u - std::sin(angle) * v,
                         500.0 + std::sin(angle) * u + std::cos(angle) * v);
        };
        char data[200];
        std::snprintf(data, sizeof data, "M%.9f %.9fA%g %g %g %d%d%.9f %.9f", at(0.0).x, at(0.0).y, radii.x,
                      radii.y, turn, std::abs(sweep) > kPi ? 1 : 0, sweep > 0.0 ? 1 : 0, at(1.0).x,
                      at(1.0).y);
        EXPECT_LT(off_curve(path(data)[0], at), 0.27) << data;
    }
    // Too small for their ends: as large as need be. Without radii: a line.
    EXPECT_LT(off_curve(path("M100 500a1 1 0 0 1 200 0")[0],
                        [](double t) {
                            return DVec2(200 - 100 * std::cos(kPi * t), 500 - 100 * std::sin(kPi * t));
                        }),
              0.26);
    EXPECT_EQ(path("M1 2A0 5 0 0 1 7 8"), (Lines{{{1, 2}, {7, 8}}}));
    const Lines ellipse = lines_of("<ellipse cx='500' cy='400' rx='300' ry='200'/>");
    ASSERT_EQ(ellipse.size(), 1U);
    EXPECT_EQ(ellipse[0].front(), ellipse[0].back());
    EXPECT_LT(off_curve(ellipse[0],
                        [](double t) {
                            return DVec2(500 + 300 * std::cos(2 * kPi * t),
                                         400 + 200 * std::sin(2 * kPi * t));
                        }),
              0.26);
}

TEST(SketchSvg, TransformsNest) {
    const auto at = [](const std::string& body) {
        const Lines lines = lines_of(body);
        return lines.empty() ? Polyline{{-1, -1}, {-1, -1}} : lines[0];
    };
    const auto near = [](const Polyline& line, const DVec2& a, const DVec2& b) {
        EXPECT_LT(glm::length(line.front() - a), 1e-9) << line.front().x << " " << line.front().y;
        EXPECT_LT(glm::length(line.back() - b), 1e-9) << line.back().x << " " << line.back().y;
    };
    const std::string line = "M10 20L30 40";
    near(at("<path transform='translate(5)' d='" + line + "'/>"), {15, 20}, {35, 40});
    near(at("<path transform='translate(5,-6)' d='" + line + "'/>"), {15, 14}, {35, 34});
    near(at("<path transform='scale(2)' d='" + line + "'/>"), {20, 40}, {60, 80});
    near(at("<path transform='scale(2 3)' d='" + line + "'/>"), {20, 60}, {60, 120});
    near(at("<path transform='rotate(90)' d='" + line + "'/>"), {-20, 10}, {-40, 30});
    near(at("<path transform='rotate(90, 10, 20)' d='" + line + "'/>"), {10, 20}, {-10, 40});
    near(at("<path transform='skewX(45)' d='" + line + "'/>"), {30, 20}, {70, 40});
    near(at("<path transform='skewY(45)' d='" + line + "'/>"), {10, 30}, {30, 70});
    near(at("<path transform='matrix(1 2 3 4 5 6)' d='" + line + "'/>"), {75, 106}, {155, 226});
    near(at("<path transform='translate(100 0), scale(2)' d='" + line + "'/>"), {120, 40}, {160, 80});
    near(at("<g transform='translate(100 0)'><g><path transform='scale(2)' d='" + line + "'/></g></g>"),
         {120, 40}, {160, 80});
    near(at("<svg x='3' y='4'><path d='" + line + "'/></svg>"), {13, 24}, {33, 44});
    // A curve keeps its quarter of a pixel however it is scaled.
    const Polyline curve = at("<g transform='scale(1000)'><path d='M0 0Q.5 1 1 0'/></g>");
    EXPECT_LT(off_curve(curve, [](double t) { return DVec2(1000 * t, 2000 * t * (1 - t)); }), 0.26);
    expect_says(svg_fault("<svg><path transform='turn(3)' d='M0 0L1 1'/></svg>"), "'turn(3)'");
    expect_says(svg_fault("<svg><path transform='scale(1 2 3)' d='M0 0L1 1'/></svg>"), "transform");
}

TEST(SketchSvg, CanvasIsItsViewBox) {
    const std::string line = "<line x1='10' y1='20' x2='30' y2='40'/>";
    const Sketch box =
        parse_sketch_svg("<svg viewBox='-10,-20 400 800' width='5cm' height='5cm'>" + line + "</svg>");
    EXPECT_EQ(box.canvas, DVec2(400, 800));
    EXPECT_EQ(box.strokes[0].points[0], DVec2(20, 40));
    const Sketch sized = parse_sketch_svg("<svg width='2in' height='254mm'>" + line + "</svg>");
    EXPECT_EQ(sized.canvas.x, 192.0);
    EXPECT_NEAR(sized.canvas.y, 960.0, 1e-9);
    EXPECT_EQ(sized.strokes[0].points[0], DVec2(10, 20));
    // Without a size: around what is drawn.
    const Sketch none =
        parse_sketch_svg("<svg width='100%' height='100%'><path d='M100 100Q300 300 500 100'/></svg>");
    EXPECT_NEAR(none.canvas.x, 440.0, 1e-9);
    EXPECT_NEAR(none.canvas.y, 140.0, 0.1);
    EXPECT_EQ(none.strokes[0].points[0], DVec2(20, 20));
    EXPECT_GT(none.strokes[0].points.size(), 8U);
    expect_says(svg_fault("<svg viewBox='0 0 10'>" + line + "</svg>"), "viewBox");
    expect_says(svg_fault("<svg viewBox='0 0 1 1000'>" + line + "</svg>"), "canvas");
}

TEST(SketchSvg, NamesTellRoles) {
    const auto role = [](const std::string& body) {
        return parse_sketch_svg("<svg viewBox='0 0 1000 1000'>" + body + "</svg>").strokes.at(0).role;
    };
    const std::string d = " d='M1 1L9 9'/>";
    EXPECT_EQ(role("<path" + d), StrokeRole::kAuto);
    EXPECT_EQ(role("<path id='trunk'" + d), StrokeRole::kTrunk);
    EXPECT_EQ(role("<path id='Trunk_2'" + d), StrokeRole::kTrunk);
    EXPECT_EQ(role("<path class='thick outline'" + d), StrokeRole::kOutline);
    EXPECT_EQ(role("<path id='path7' inkscape:label='Branch 3'" + d), StrokeRole::kBranch);
    EXPECT_EQ(role("<path id='outlined'" + d), StrokeRole::kAuto);
    EXPECT_EQ(role("<g id='branches'><path id='path3'" + d + "</g>"), StrokeRole::kBranch);
    EXPECT_EQ(role("<g id='branches'><path id='trunk'" + d + "</g>"), StrokeRole::kTrunk);
}

TEST(SketchSvg, ShowsWhatShows) {
    const std::string shown = "<path d='M1 1L9 9'/>";
    EXPECT_EQ(lines_of("<!-- " + shown + " --><![CDATA[" + shown + "]]>" + shown).size(), 1U);
    for (const char* hidden :
         {"<g display='none'>", "<g style='fill:red; display : none'>", "<g visibility='hidden'>", "<defs>",
          "<symbol>", "<clipPath>", "<mask>", "<g style='visibility:collapse'>"}) {
        const std::string group = hidden, end = "</" + group.substr(1, group.find_first_of(" >") - 1) + ">";
        EXPECT_EQ(lines_of(group + "<g>" + shown + "</g>" + end + shown).size(), 1U) << hidden;
    }
    EXPECT_EQ(lines_of("<g visibility='hidden'><path visibility='visible' d='M1 1L9 9'/></g>").size(), 1U);
    EXPECT_EQ(lines_of("<path style='display:none' d='M1 1L9 9'/>" + shown).size(), 1U);
    // What programs write around it.
    const Sketch sketch = parse_sketch_svg(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!DOCTYPE svg PUBLIC \"-//W3C//DTD SVG 1.1//EN\" "
        "\"x.dtd\" [\n"
        "<!ENTITY ns \"http://ns.adobe.com/>\">]>\n"
        "<svg:svg xmlns:svg='http://www.w3.org/2000/svg' width=\"100\" height=\"100\" xmlns='&ns;'>"
        "<metadata><rdf:RDF/></metadata><svg:g id='a &lt;b&gt; &#x74;runk'>\n<svg:path\n d = \"M1 1\n L9 "
        "9\"\n/></svg:g>"
        "<text>a < b</text></svg:svg>");
    ASSERT_EQ(sketch.strokes.size(), 1U);
    EXPECT_EQ(sketch.strokes[0].role, StrokeRole::kTrunk);
}

TEST(SketchSvg, ThatIsNoneGetsASentence) {
    expect_says(svg_fault(""), "no SVG");
    expect_says(svg_fault("<html><body/></html>"), "<html>");
    expect_says(svg_fault("<svg/>"), "shows no lines");
    expect_says(svg_fault("<svg><text>tree</text></svg>"), "shows no lines");
    expect_says(svg_fault("<svg><path d='M1 1L9 9'/>"), "ends too early");
    expect_says(svg_fault("<svg><path d='M1 1L9 9'"), "damaged");
    expect_says(svg_fault("<svg>\n<path d='M1 1L9 9/></svg>"), "line 2");
    expect_says(svg_fault("<svg><path d=M1/></svg>"), "quotes");
    expect_says(svg_fault("<svg><!-- </svg>"), "comment");
    expect_says(svg_fault("<!DOCTYPE svg [ <svg></svg>"), "document type");
    expect_says(svg_fault("<svg><path d='M1 1L9 9X3'/></svg>"), "character 9");
    expect_says(svg_fault("<svg><path d='L9 9'/></svg>"), "character 1");
    expect_says(svg_fault("<svg><path d='M1 1L9'/></svg>"), "path");
    expect_says(svg_fault("<svg><path d='M1 1z5 5'/></svg>"), "path");
    expect_says(svg_fault("<svg><path d='M1 1Lnan inf'/></svg>"), "path");
    expect_says(svg_fault("<svg><path d='M1 1A5 5 0 2 1 9 9'/></svg>"), "path");
    expect_says(svg_fault("<svg><polyline points='1 2 3'/></svg>"), "polyline");
    expect_says(svg_fault("<svg><line x1='a' y1='1' x2='3'/></svg>"), "x1");
    expect_says(svg_fault("<svg viewBox='0 0 9 9'><path d='M1 1L1e300 1e300'/></svg>"),
                "away from the canvas");
    expect_says(svg_fault("<svg><path transform='scale(1e300)' d='M1 1L1e300 9'/></svg>"), "canvas");
    std::string deep, many = "<svg>", long_path = "<svg viewBox='0 0 9 9'><path d='M0 0";
    for (int i = 0; i < 100000; i++)
        deep += "<g>";
    expect_says(svg_fault("<svg>" + deep), "1000 deep");
    for (int i = 0; i < 1001; i++)
        many += "<path d='M1 1L9 9'/>";
    expect_says(svg_fault(many + "</svg>"), "more than 1000 lines");
    for (int i = 0; i < 200001; i++)
        long_path += "l1 1 -1-1";
    expect_says(svg_fault(long_path + "'/></svg>"), "200000 points");
    std::string curves = "<svg viewBox='0 0 9 9'><path d='M0 0";
    for (int i = 0; i < 1000; i++)
        curves += "Q1e5 1e9 9 9";
    expect_says(svg_fault(curves + "'/></svg>"), "200000 points");
    expect_says(svg_fault(std::string((64U << 20U) + 1, '<')), "64 MiB");
}

}  // namespace
}  // namespace treerec
