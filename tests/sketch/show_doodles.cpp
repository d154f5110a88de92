// Doodles beside what is made of them, to be looked at:
//
//     show_doodles SHEET.png [FIRST [COUNT]]     what each stroke was taken for; beside it the wood and the
//     crown show_doodles FOLDER/ [FIRST [COUNT]]       as sketches, for tests/captures/sketches.gd
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "doodles.h"
#include "error.h"
#include "exchange/material_textures.h"
#include "mesh/image.h"
#include "sketch/read_sketch.h"
#include "sketch/sketch.h"

namespace treerec::test {

namespace {

constexpr double kSize = 200.0;  // pixels of a drawing on the sheet
constexpr int kColumns = 4;

using Colour = std::array<uint8_t, 3>;

Colour ink_of(StrokeRole role) {
    switch (role) {
        case StrokeRole::kOutline:
            return {40, 140, 40};
        case StrokeRole::kTrunk:
            return {120, 70, 30};
        case StrokeRole::kBranch:
            return {220, 140, 40};
        default:
            return {230, 30, 30};
    }
}

void draw(Image& sheet, const DVec2& a, const DVec2& b, double width, const Colour& ink) {
    const double length = glm::length(b - a);
    const int steps = 1 + static_cast<int>(2.0 * std::min(length, 4000.0));
    for (int i = 0; i <= steps; i++) {
        const DVec2 p = a + (b - a) * (static_cast<double>(i) / steps);
        const double reach = std::max(0.5 * width, 0.5);
        for (double y = std::floor(p.y - reach + 0.5); y <= p.y + reach - 0.5; y += 1.0)
            for (double x = std::floor(p.x - reach + 0.5); x <= p.x + reach - 0.5; x += 1.0)
                if (x >= 0.0 && y >= 0.0 && x < sheet.width && y < sheet.height)
                    std::copy(ink.begin(), ink.end(), sheet.at(static_cast<int>(x), static_cast<int>(y)));
    }
}

void draw(Image& sheet, const std::vector<DVec2>& line, double width, const Colour& ink) {
    for (size_t i = 0; i + 1 < line.size(); i++)
        draw(sheet, line[i], line[i + 1], width, ink);
    if (line.size() == 1) draw(sheet, line[0], line[0], 2.0 * width, ink);
}

void draw_doodle(Image& sheet, const DVec2& corner, const Doodle& doodle, uint64_t seed) {
    const Sketch& sketch = doodle.sketch;
    // Around all strokes.
    DVec2 low(1e300), high(-1e300);
    for (const Stroke& stroke : sketch.strokes)
        for (const DVec2& p : stroke.points) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    const DVec2 size = high - low;
    const double scale = 0.9 * kSize / std::max(std::max(size.x, size.y), 1e-6);
    const auto at = [&](const DVec2& p, double right) {
        return corner + (p - 0.5 * (low + high)) * scale + DVec2(0.5 * kSize + right, 0.5 * kSize);
    };
    SketchedTree made;
    std::string refused;
    try {
        made = sketch_tree(sketch, {});
        std::printf("%llu %s: %zu nodes\n", static_cast<unsigned long long>(seed), doodle.kind,
                    made.tree.size());
    } catch (const Error& error) {
        refused = error.what();
        std::printf("%llu %s: %s\n", static_cast<unsigned long long>(seed), doodle.kind, error.what());
    }
    for (size_t i = 0; i < sketch.strokes.size(); i++) {
        std::vector<DVec2> line;
        for (const DVec2& p : sketch.strokes[i].points)
            line.push_back(at(p, 0.0));
        draw(sheet, line, 2.0, ink_of(refused.empty() ? made.understood.strokes[i].role : StrokeRole::kAuto));
    }
    if (!refused.empty()) return;
    std::vector<DVec2> outline;
    const double pixel = sketch.canvas.y / kCanvasHeight;
    for (const DVec2& p : made.understood.drawn.outline)
        outline.push_back(at(DVec2(p.x, kCanvasHeight - p.y) * pixel, kSize));
    outline.push_back(outline[0]);
    const auto seen = [&](const DVec3& p) {
        return at(DVec2(made.stem_base.x + p.x / made.scale, made.stem_base.y - p.y / made.scale), kSize);
    };
    for (const bool twigs : {true, false})
        for (const NodeId id : made.tree.depth_first()) {
            const Node& node = made.tree.node(id);
            if (node.parent == kNoNode) continue;
            if ((made.stroke_of_node[static_cast<size_t>(id)] < 0) != twigs) continue;
            draw(sheet, seen(made.tree.node(node.parent).position), seen(node.position),
                 2.0 * node.radius / made.scale * scale, twigs ? Colour{120, 180, 110} : Colour{90, 55, 30});
        }
    draw(sheet, outline, 1.0, {60, 60, 230});
}

int show(const std::string& target, uint64_t first, uint64_t count) {
    const bool folder = target.ends_with('/');
    const auto rows = static_cast<int>((count + kColumns - 1) / kColumns);
    Image sheet(folder ? 1 : static_cast<int>(2.0 * kSize) * kColumns,
                folder ? 1 : static_cast<int>(kSize) * rows, 3);
    std::fill(sheet.pixels.begin(), sheet.pixels.end(), uint8_t{255});
    for (uint64_t i = 0; i < count; i++) {
        const Doodle doodle = scribbled_doodle(first + i);
        if (folder) {
            std::ofstream file(target + std::to_string(first + i) + ".json");
            if (!(file << sketch_json(doodle.sketch))) return 1;
            continue;
        }
        draw_doodle(
            sheet,
            DVec2(2.0 * kSize * static_cast<double>(i % kColumns), kSize * static_cast<double>(i / kColumns)),
            doodle, first + i);
    }
    if (folder) return 0;
    const std::vector<uint8_t> bytes = encode_png(sheet);
    std::ofstream file(target, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return file ? 0 : 1;
}

}  // namespace

}  // namespace treerec::test

int main(int count, char** words) {
    if (count < 2) {
        std::fprintf(stderr, "usage: show_doodles SHEET.png|FOLDER/ [FIRST [COUNT]]\n");
        return 2;
    }
    const auto number = [&](int word, uint64_t usual) {
        return word < count ? std::strtoull(words[word], nullptr, 10) : usual;
    };
    if (treerec::test::show(words[1], number(2, 1), std::min<uint64_t>(number(3, 24), 1000)) == 0) return 0;
    std::fprintf(stderr, "%s could not be written.\n", words[1]);
    return 1;
}
