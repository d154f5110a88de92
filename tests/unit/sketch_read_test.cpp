// Sketches as files: our JSON, and what is none.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "cases.h"
#include "drawn_sketch.h"
#include "error.h"
#include "file_bytes.h"
#include "geometry/random.h"
#include "sketch/read_sketch.h"
#include "sketch_sentences.h"

namespace treerec {
namespace {

using test::expect_says;
using test::json_fault;
using test::Polyline;
using test::sentence_of;
using test::svg_fault;

Sketch random_sketch(Random& random) {
    Sketch sketch;
    const auto any = [&] {
        switch (random.below(4)) {
            case 0:
                return std::floor(random.uniform(-500.0, 1500.0));
            case 1:
                return random.uniform(-1e4, 1e4);
            case 2:
                return random.uniform(0.0, 1e-300);
            default:
                return random.uniform(0.0, 1000.0);
        }
    };
    sketch.canvas = {random.uniform(200.0, 3000.0), random.uniform(200.0, 3000.0)};
    sketch.height = random.below(2) == 0 ? 0.0 : random.uniform(0.0, 200.0);
    sketch.species = std::vector<std::string>{"", "maple", "\"\\ \n\t\x01", "楓"}[random.below(4)];
    sketch.seed = uint64_t{random.next()} << 32U | random.next();
    const uint32_t count = random.below(12);
    for (uint32_t i = 0; i < count; i++) {
        Stroke stroke;
        const uint32_t points = 1 + random.below(60);
        for (uint32_t k = 0; k < points; k++)
            stroke.points.emplace_back(any(), any());
        if (random.below(2) == 0)
            for (uint32_t k = 0; k < points; k++)
                stroke.pressure.push_back(static_cast<float>(random.uniform()));
        stroke.role = static_cast<StrokeRole>(random.below(4));
        stroke.id = random.below(3) == 0 ? 0 : random.below(3) == 0 ? random.next() : random.below(8);
        sketch.strokes.push_back(std::move(stroke));
    }
    sketch.number_strokes();
    return sketch;
}

void expect_same(const Sketch& a, const Sketch& b) {
    EXPECT_EQ(a.canvas, b.canvas);
    EXPECT_EQ(a.height, b.height);
    EXPECT_EQ(a.species, b.species);
    EXPECT_EQ(a.seed, b.seed);
    ASSERT_EQ(a.strokes.size(), b.strokes.size());
    for (size_t i = 0; i < a.strokes.size(); i++) {
        EXPECT_EQ(a.strokes[i].points, b.strokes[i].points);
        EXPECT_EQ(a.strokes[i].pressure, b.strokes[i].pressure);
        EXPECT_EQ(a.strokes[i].role, b.strokes[i].role);
        EXPECT_EQ(a.strokes[i].id, b.strokes[i].id);
    }
}

TEST(SketchRead, JsonReadsBackToTheLastBit) {
    Random random(1);
    for (int i = 0; i < test::cases(1000); i++) {
        const Sketch sketch = random_sketch(random);
        const std::string text = sketch_json(sketch);
        const Sketch read = parse_sketch_json(text);
        expect_same(sketch, read);
        EXPECT_EQ(sketch_json(read), text);
        if (HasFailure()) return;
    }
}

TEST(SketchRead, JsonMayLeaveOutAllButStrokes) {
    const Sketch sketch = parse_sketch_json(
        R"({"strokes": [{"points": [[1, 2]]}, {"points": [[3, 4], [5, 6]], "role": "trunk"}],
                              "version": 1, "format": "treerec sketch", "unknown": {"a": []}})");
    ASSERT_EQ(sketch.strokes.size(), 2U);
    EXPECT_EQ(sketch.canvas, DVec2(1000.0, 1000.0));
    EXPECT_EQ(sketch.strokes[0].id, 1U);
    EXPECT_EQ(sketch.strokes[1].id, 2U);
    EXPECT_EQ(sketch.strokes[1].role, StrokeRole::kTrunk);
    EXPECT_EQ(sketch.strokes[1].points[1], DVec2(5.0, 6.0));
    EXPECT_TRUE(
        parse_sketch_json(R"({"format": "treerec sketch", "version": 1, "strokes": []})").strokes.empty());
}

std::string with_strokes(const std::string& strokes) {
    return R"({"format": "treerec sketch", "version": 1, "strokes": [)" + strokes + "]}";
}

std::string repeated(const std::string& part, size_t times) {
    std::string all;
    for (size_t i = 0; i < times; i++)
        all += (i > 0 ? "," : "") + part;
    return all;
}

TEST(SketchRead, JsonThatIsNoSketchGetsASentence) {
    expect_says(json_fault("{\"format\":\n \"treerec"), "line 2");
    expect_says(json_fault(""), "cannot be read as JSON");
    expect_says(json_fault("[1, 2]"), "no sketch");
    expect_says(json_fault("{}"), "no sketch");
    expect_says(json_fault(R"({"format": "other", "version": 1})"), "'other'");
    expect_says(json_fault(R"({"format": 3, "version": 1})"), "no sketch");
    expect_says(json_fault(R"({"format": "treerec sketch"})"), "version");
    expect_says(json_fault(R"({"format": "treerec sketch", "version": "1"})"), "version");
    expect_says(json_fault(R"({"format": "treerec sketch", "version": 2, "strokes": []})"), "newer version");
    expect_says(json_fault(R"({"format": "treerec sketch", "version": 1})"), "'strokes'");
    expect_says(json_fault(R"({"format": "treerec sketch", "version": 1, "strokes": [], "canvas": [0, 5]})"),
                "canvas");
    expect_says(
        json_fault(R"({"format": "treerec sketch", "version": 1, "strokes": [], "canvas": [9, 5000]})"),
        "canvas");
    expect_says(json_fault(R"({"format": "treerec sketch", "version": 1, "strokes": [], "canvas": 5})"),
                "'canvas'");
    expect_says(json_fault(R"({"format": "treerec sketch", "version": 1, "strokes": [], "height": -1})"),
                "200 metres");
    expect_says(json_fault(R"({"format": "treerec sketch", "version": 1, "strokes": [], "height": "1"})"),
                "'height'");
    expect_says(json_fault(R"({"format": "treerec sketch", "version": 1, "strokes": [], "seed": -1})"),
                "'seed'");
    expect_says(json_fault(R"({"format": "treerec sketch", "version": 1, "strokes": [], "species": 1})"),
                "'species'");
    expect_says(json_fault(with_strokes("7")), "number 1");
    expect_says(json_fault(with_strokes("{}")), "no points");
    expect_says(json_fault(with_strokes(R"({"points": [[1, 2]]}, {"points": []})")),
                "number 2, that has no points");
    expect_says(json_fault(with_strokes(R"({"points": [[1, 2], [1]]})")), "point 2 is not [x, y]");
    expect_says(json_fault(with_strokes(R"({"points": [[1, null]]})")), "point 1 is not [x, y]");
    expect_says(json_fault(with_strokes(R"({"points": [[1, 1e999]]})")), "too large");
    expect_says(json_fault(with_strokes(R"({"points": [[1, 1e9]]})")), "away from the canvas");
    expect_says(json_fault(with_strokes(R"({"points": [[1, NaN]]})")), "cannot be read as JSON");
    expect_says(json_fault(with_strokes(R"({"points": [[1, 2]], "pressure": [1, 1]})")),
                "2 pressures for 1 points");
    expect_says(json_fault(with_strokes(R"({"points": [[1, 2]], "pressure": [1.5]})")), "0 to 1");
    expect_says(json_fault(with_strokes(R"({"points": [[1, 2]], "pressure": ["a"]})")), "no number");
    expect_says(json_fault(with_strokes(R"({"points": [[1, 2]], "role": "root"})")), "'root'");
    expect_says(json_fault(with_strokes(R"({"points": [[1, 2]], "id": -4})")), "'id'");
    expect_says(json_fault(with_strokes(R"({"points": [[1, 2]], "id": 4294967296})")), "'id'");
    expect_says(json_fault(with_strokes(repeated(R"({"points": [[1, 2]]})", kMostStrokes + 1))),
                "1001 strokes");
    expect_says(json_fault(with_strokes("{\"points\": [" + repeated("[1,2]", kMostStrokePoints + 1) + "]}")),
                "200001 points");
    EXPECT_EQ(json_fault(with_strokes(repeated(R"({"points": [[1, 2]]})", kMostStrokes))), "");
    expect_says(json_fault(std::string(17U << 20U, ' ')), "16 MiB");
    expect_says(json_fault(with_strokes(std::string(1000000, '[') + std::string(1000000, ']'))), "no sketch");
    expect_says(json_fault(std::string(1000000, '[')), "JSON");
}

TEST(SketchRead, NumbersAreDistinctAndStay) {
    Sketch sketch;
    for (const uint32_t id : {0U, 4U, 4U, 4294967295U, 0U, 1U})
        sketch.strokes.push_back({{{1.0, 2.0}}, {}, StrokeRole::kAuto, id});
    sketch.number_strokes();
    std::vector<uint32_t> ids;
    for (const Stroke& stroke : sketch.strokes)
        ids.push_back(stroke.id);
    EXPECT_EQ(ids, (std::vector<uint32_t>{2, 4, 3, 4294967295U, 5, 1}));
    sketch.strokes.erase(sketch.strokes.begin() + 3);
    sketch.strokes.push_back({{{1.0, 2.0}}, {}, StrokeRole::kAuto, 0});
    sketch.number_strokes();
    EXPECT_EQ(sketch.strokes.back().id, 6U);
}

TEST(SketchRead, NamesOfRolesAndRepairs) {
    for (const StrokeRole role :
         {StrokeRole::kAuto, StrokeRole::kOutline, StrokeRole::kTrunk, StrokeRole::kBranch})
        EXPECT_EQ(parse_stroke_role(stroke_role_name(role)), role);
    EXPECT_THROW(parse_stroke_role("Trunk"), Error);
    EXPECT_STREQ(stroke_repair_name(StrokeRepair::kReversed), "reversed");
    EXPECT_STREQ(stroke_repair_name(StrokeRepair::kHook), "hook");
    EXPECT_STREQ(stroke_repair_name(StrokeRepair::kTwoSides), "two_sides");
}

TEST(SketchRead, ChecksWhatIsNotFinite) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Sketch sketch;
    check_sketch(sketch);
    for (const double bad : {nan, -nan, double{INFINITY}, -1.0, 0.0}) {
        Sketch other = sketch;
        other.canvas.y = bad;
        EXPECT_THROW(check_sketch(other), Error) << bad;
        EXPECT_THROW(sketch_json(other), Error) << bad;
    }
    sketch.strokes.push_back({{{nan, 1.0}}, {}, StrokeRole::kAuto, 1});
    EXPECT_THROW(check_sketch(sketch), Error);
    sketch.strokes[0].points[0].x = 1.0;
    sketch.strokes[0].pressure = {std::numeric_limits<float>::quiet_NaN()};
    EXPECT_THROW(check_sketch(sketch), Error);
    sketch.strokes[0].pressure.clear();
    sketch.height = nan;
    EXPECT_THROW(check_sketch(sketch), Error);
}

// Damaged anywhere, it is read or gets a sentence.
TEST(SketchRead, DamagedTextIsNoHarm) {
    Random random(6);
    const std::string json = sketch_json(random_sketch(random));
    const std::string svg =
        "<svg viewBox='0 0 99 99'><!-- a --><g transform='rotate(30 1 2) skewX(4)' id='trunk'>"
        "<path d='M1 2L3 4H5V6C1 2 3 4 5 6S7 8 9 10Q1 2 3 4T5 6a5 6 7 1 0 9 9z'/></g>"
        "<polygon points='1,2 3,4 5,6'/><circle cx='4' r='5'/><![CDATA[ ]]>&amp;</svg>";
    for (int i = 0; i < test::cases(20000); i++) {
        std::string text = i % 2 == 0 ? json : svg;
        const uint32_t edits = 1 + random.below(4);
        for (uint32_t k = 0; k < edits && !text.empty(); k++) {
            const uint32_t at = random.below(static_cast<uint32_t>(text.size()));
            switch (random.below(4)) {
                case 0:
                    text[at] = static_cast<char>(random.below(256));
                    break;
                case 1:
                    text.erase(at, 1 + random.below(8));
                    break;
                case 2:
                    text.insert(at, text.substr(random.below(static_cast<uint32_t>(text.size())),
                                                1 + random.below(9)));
                    break;
                default:
                    text[at] = "0123456789.-eE<>/[]{}\"'"[random.below(23)];
            }
        }
        const std::string sentence = i % 2 == 0 ? json_fault(text) : svg_fault(text);
        ASSERT_TRUE(sentence.empty() || (sentence.starts_with("'s.") && sentence.ends_with("."))) << sentence;
        for (const char c : sentence)
            ASSERT_TRUE(c >= ' ' && c <= '~') << sentence;
    }
}

class SketchFile : public testing::Test {
  protected:
    SketchFile() {
        folder_ = std::filesystem::temp_directory_path() / ("treerec sketch " + std::to_string(::getpid()));
        std::filesystem::create_directories(folder_);
    }
    ~SketchFile() override { std::filesystem::remove_all(folder_); }

    std::string write(const std::string& name, const std::string& bytes) const {
        const std::string path = utf8_of(folder_ / name);
        write_file(path, bytes);
        return path;
    }
    std::string fault(const std::string& name, const std::string& bytes) const {
        const std::string path = write(name, bytes);
        const std::string sentence = sentence_of([&] { read_sketch(path); });
        EXPECT_TRUE(sentence.starts_with("'" + path + "'")) << sentence;
        return sentence;
    }

    std::filesystem::path folder_;
};

TEST_F(SketchFile, IsWhatIsInIt) {
    Random random(2);
    const Sketch sketch = random_sketch(random);
    expect_same(read_sketch(write("a.svg", "\xEF\xBB\xBF \n" + sketch_json(sketch))), sketch);
    EXPECT_EQ(read_sketch(write("b.json", "<svg><path d='M1 1L9 9'/></svg>")).strokes.size(), 1U);
    const std::vector<Polyline> lines = {{{10, 90}, {50, 20}, {90, 80}}};
    const Sketch drawn = read_sketch(write("c", test::png_of(test::paint(100, 100, lines, {}))));
    ASSERT_EQ(drawn.strokes.size(), 1U);
    EXPECT_EQ(drawn.strokes[0].id, 1U);
    EXPECT_LT(test::apart(drawn.strokes[0].points, lines[0]), 1.0);
}

TEST_F(SketchFile, OrGetsASentence) {
    EXPECT_NE(sentence_of([&] { read_sketch(utf8_of(folder_ / "none.svg")); }).find("does not exist"),
              std::string::npos);
    const auto expect = [&](const std::string& bytes, const std::string& part) {
        EXPECT_NE(fault("x.png", bytes).find(part), std::string::npos);
    };
    using namespace std::string_literals;
    expect("", "is empty");
    expect(" \n", "is empty");
    expect("hello", "no sketch");
    expect("RIFF\x10\0\0\0WEBPVP8 "s, "save it as PNG");
    expect("GIF89a", "save it as PNG");
    expect("\0\0\0\x18"s + "ftypheic", "save it as PNG");
    expect("\x1F\x8B\x08", "SVGZ");
    expect("\xFF\xFE<\0s\0"s, "UTF-16");
    expect("\x89PNG\r\n\x1A\n", "damaged");
    expect("\xFF\xD8\xFF\xE0", "damaged");
    expect("{\"a\": 1}", "no sketch");
    expect("<svg", "damaged");
}

}  // namespace
}  // namespace treerec
