#include "messy_sketches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "geometry/portable_math.h"
#include "geometry/random.h"
#include "sketch/clean.h"
#include "sketch/flat_line.h"
#include "synth/grow.h"
#include "tree/branches.h"

namespace treerec::test {

namespace {

DVec2 turned(const DVec2& v, double radians) {
    const SineCosine turn = portable_sine_cosine(radians);
    return {turn.cosine * v.x - turn.sine * v.y, turn.sine * v.x + turn.cosine * v.y};
}

// The strokes as they are meant: pixels of a canvas 1,000 high, y up.
struct Drawing {
    FlatLine trunk;
    double radius = 0.0;             // at its base, where it is drawn with two lines
    std::vector<FlatLine> branches;  // from the trunk
    std::vector<FlatLine> sides;     // from branches
    FlatLine outline;                // closed
};

FlatLine cut_from(const FlatLine& line, double arc) {
    const std::vector<double> arcs = line_arcs(line);
    FlatLine rest = {point_at(line, arcs, arc)};
    for (size_t i = 0; i < line.size(); i++)
        if (arcs[i] > arc + 1e-9) rest.push_back(line[i]);
    return rest;
}

// As a hand draws it, without turns of a few pixels (Chaikin 1974, "An algorithm for high speed curve
// generation"); the ends stay.
FlatLine rounded(FlatLine line) {
    const DVec2 end = line.back();
    line = thin_line(line, 15.0);
    if (line.size() > 2 && glm::length(end - line[line.size() - 2]) < 15.0) line.erase(line.end() - 2);
    for (int round = 0; round < 3; round++) {
        FlatLine finer = {line.front()};
        for (size_t i = 0; i + 1 < line.size(); i++) {
            finer.push_back(0.75 * line[i] + 0.25 * line[i + 1]);
            finer.push_back(0.25 * line[i] + 0.75 * line[i + 1]);
        }
        finer.push_back(line.back());
        line = finer;
    }
    return line;
}

bool is_drawable(const FlatLine& branch, const FlatLine& trunk) {
    const double length = line_length(branch);
    if (length < 70.0 || glm::length(branch.back() - branch.front()) < 0.75 * length) return false;
    if (!crossings(cut_from(branch, 4.0), trunk).empty()) return false;
    // Not along the trunk, nor before it.
    return nearest_on_line(trunk, branch.back()).distance > 30.0 &&
           nearest_on_line(trunk, point_at(branch, line_arcs(branch), 0.5 * length)).distance > 0.15 * length;
}

FlatLine outline_of(const FlatLine& points, double floor, Random& random) {
    constexpr int kSectors = 40;
    const FlatBox box = line_box(points);
    const DVec2 middle = 0.5 * (box.low + box.high);
    std::array<double, kSectors> far{};
    for (const DVec2& p : points) {
        const double angle = portable::atan2(p.y - middle.y, p.x - middle.x);
        const int sector = static_cast<int>(std::floor((angle / (2.0 * kPi) + 1.0) * kSectors)) % kSectors;
        for (const int near : {kSectors - 1, 0, 1}) {
            double& most = far[static_cast<size_t>((sector + near) % kSectors)];
            most = std::max(most, glm::length(p - middle) * (near == 0 ? 1.0 : 0.96));
        }
    }
    const double margin = random.uniform(10.0, 25.0);
    FlatLine outline;
    const int first = static_cast<int>(random.below(kSectors));
    for (int k = 0; k < 4 * kSectors; k++) {
        const double at = first + k / 4.0;
        const size_t a = static_cast<size_t>(at) % kSectors, b = (a + 1) % kSectors;
        const double t = at - std::floor(at), ease = t * t * (3.0 - 2.0 * t);
        const SineCosine turn = portable_sine_cosine(2.0 * kPi * (at + 0.5) / kSectors);
        DVec2 p = middle + (far[a] + ease * (far[b] - far[a]) + margin) * DVec2(turn.cosine, turn.sine);
        p.y = std::max(p.y, floor + 0.02 * (p.y - floor));
        outline.push_back(p);
    }
    return outline;
}

Drawing draw_tree(uint64_t seed, Random& random) {
    constexpr std::array kHabits = {Habit::kBroadleaf, Habit::kConifer, Habit::kBirch,
                                    Habit::kForked,    Habit::kLeaning, Habit::kButtressed};
    GrowOptions grow;
    grow.habit = kHabits[random.below(kHabits.size())];
    grow.seed = seed;
    const Tree tree = grow_tree(grow);
    const SineCosine side = portable_sine_cosine(random.uniform(0.0, 2.0 * kPi));
    const auto flat = [&](NodeId id) {
        const DVec3 p = tree.node(id).position;
        return DVec2(side.cosine * p.x + side.sine * p.z, p.y);
    };
    FlatLine all;
    for (const NodeId id : tree.depth_first())
        all.push_back(flat(id));
    const FlatBox box = line_box(all);
    const double scale = 860.0 / std::max(box.size().y, box.size().x);
    const auto pixel = [&](const DVec2& p) {
        return DVec2(500.0 + scale * (p.x - 0.5 * (box.low.x + box.high.x)),
                     60.0 + scale * (p.y - box.low.y));
    };
    const BranchList list = list_branches(tree);
    Drawing drawing;
    for (const NodeId id : list.nodes_of(list.branches[0]))
        drawing.trunk.push_back(pixel(flat(id)));
    drawing.trunk = rounded(drawing.trunk);
    std::vector<FlatLine> choice;
    for (const Branch& branch : list.branches) {
        if (branch.order != 1) continue;
        FlatLine line = {pixel(flat(branch.attach))};
        for (const NodeId id : list.nodes_of(branch))
            line.push_back(pixel(flat(id)));
        // The trunk was rounded, too.
        line[0] = nearest_on_line(drawing.trunk, line[0]).point;
        line = rounded(line);
        if (is_drawable(line, drawing.trunk)) choice.push_back(std::move(line));
    }
    std::sort(choice.begin(), choice.end(),
              [](const FlatLine& a, const FlatLine& b) { return line_length(a) > line_length(b); });
    const size_t most = 3 + random.below(6);
    for (const FlatLine& line : choice) {
        if (drawing.branches.size() == most) break;
        bool apart = true;
        for (const FlatLine& other : drawing.branches)
            apart = apart && glm::length(other[0] - line[0]) > 12.0 &&
                    glm::length(other.back() - line.back()) > 30.0;
        if (apart) drawing.branches.push_back(line);
    }
    if (random.below(6) == 0) drawing.radius = random.uniform(8.0, 20.0);
    if (random.below(5) == 0 && !drawing.branches.empty()) {
        const FlatLine& from = drawing.branches[random.below(static_cast<uint32_t>(drawing.branches.size()))];
        const std::vector<double> arcs = line_arcs(from);
        const double at = arcs.back() * random.uniform(0.4, 0.7);
        const DVec2 base = point_at(from, arcs, at);
        const DVec2 along = unit_or(point_at(from, arcs, at + 15.0) - base, DVec2(0.0, 1.0));
        const double hand = random.below(2) == 0 ? 1.0 : -1.0;
        FlatLine side = {base};
        for (int k = 0; k < 10; k++)
            side.push_back(side.back() + 0.05 * arcs.back() * turned(along, hand * (0.9 - 0.04 * k)));
        if (nearest_on_line(drawing.trunk, base).distance > 70.0 &&
            crossings(cut_from(side, 1.0), from).empty() &&
            nearest_on_line(drawing.trunk, side.back()).distance > 70.0)
            drawing.sides.push_back(side);
    }
    double base = drawing.trunk.back().y;
    for (const FlatLine& line : drawing.branches)
        for (const DVec2& p : line)
            base = std::min(base, p.y);
    FlatLine crown = drawing.trunk;
    for (const FlatLine& line : drawing.branches)
        crown.insert(crown.end(), line.begin(), line.end());
    for (const FlatLine& line : drawing.sides)
        crown.insert(crown.end(), line.begin(), line.end());
    for (const DVec2& p : all)
        crown.push_back(pixel(p));
    std::erase_if(crown, [&](const DVec2& p) { return p.y < base; });
    drawing.outline = outline_of(crown, drawing.trunk[0].y + 15.0, random);
    // It pokes out of the crown.
    if (random.below(8) == 0)
        drawing.trunk.push_back(
            DVec2(drawing.trunk.back().x,
                  std::max(drawing.trunk.back().y, line_box(drawing.outline).high.y) + 25.0));
    return drawing;
}

double trunk_radius(const Drawing& drawing, const DVec2& p) {
    const double stem_base = drawing.trunk.front().y, top = drawing.trunk.back().y;
    return drawing.radius * (1.0 - 0.75 * (p.y - stem_base) / std::max(1.0, top - stem_base));
}

FlatLine spoilt(FlatLine line, Mess mess, Random& random) {
    const double length = line_length(line);
    const std::vector<double> arcs = line_arcs(line);
    const DVec2 out = unit_or(point_at(line, arcs, std::min(20.0, 0.2 * length)) - line[0], DVec2(1.0, 0.0));
    if (mess == Mess::kGap || mess == Mess::kHookGap)
        line = cut_from(line, std::min(30.0, length * random.uniform(0.03, 0.11)));
    if (mess == Mess::kCrossing || mess == Mess::kLoopCrossing) {
        const double over = std::min(40.0, length * random.uniform(0.05, 0.18));
        line.insert(line.begin(), line[0] - over * turned(out, random.uniform(-0.15, 0.15)));
    }
    const double hand = random.below(2) == 0 ? 1.0 : -1.0;
    if (mess == Mess::kHook || mess == Mess::kHookGap)
        line.insert(line.begin(),
                    line[0] + random.uniform(8.0, 24.0) * turned(out, hand * random.uniform(0.2, 1.0)));
    if (mess == Mess::kLoop || mess == Mess::kLoopCrossing) {
        const double radius = random.uniform(4.0, 11.0);
        const DVec2 middle = line[0] + radius * turned(out, hand * random.uniform(1.2, 2.4));
        const DVec2 from = line[0] - middle;
        const double whole = random.uniform(0.85, 1.15) * 2.0 * kPi;
        FlatLine loop;
        for (int k = 0; k < 24; k++)
            loop.push_back(middle + turned(from, hand * whole * (k - 24) / 24.0));
        line.insert(line.begin(), loop.begin(), loop.end());
    }
    return line;
}

// The line as a pen leaves points of it: slowly at its ends, evenly shaken.
FlatLine penned(const FlatLine& line, bool shaken, Random& random) {
    const std::vector<double> arcs = line_arcs(line);
    const bool slow = random.below(4) == 0;
    const double speed = slow ? random.uniform(0.4, 1.5) : random.uniform(3.0, 12.0);
    const double noise = slow ? random.uniform(0.1, 0.5) : random.uniform(0.3, 1.2);
    FlatLine points;
    for (double arc = 0.0; arc < arcs.back();) {
        points.push_back(point_at(line, arcs, arc));
        const double end = std::min(arc, arcs.back() - arc);
        arc += speed * std::clamp(end / 25.0, 0.3, 1.0) * random.uniform(0.8, 1.2);
    }
    points.push_back(line.back());
    for (DVec2& p : points) {
        const DVec2 off(random.normal(), random.normal());
        if (shaken) p += noise * off;
    }
    return points;
}

}  // namespace

const char* mess_name(Mess mess) {
    constexpr std::array kNames = {"none", "gap", "crossing", "hook", "loop", "hook, gap", "loop, crossing"};
    return kNames.at(static_cast<size_t>(mess));
}

MessySketch messy_sketch(uint64_t seed, const MessOptions& options) {
    Random random(seed, 28);
    const Drawing drawing = draw_tree(seed, random);
    constexpr std::array<DVec2, 4> kCanvases = {DVec2(1000.0, 1000.0), DVec2(1920.0, 1080.0),
                                                DVec2(600.0, 800.0), DVec2(2000.0, 2500.0)};
    MessySketch messy;
    messy.sketch.canvas = kCanvases[random.below(kCanvases.size())];
    messy.sketch.seed = seed;
    const double scale = messy.sketch.canvas.y / kCanvasHeight;
    const auto down = [&](const DVec2& p) { return DVec2(p.x * scale, messy.sketch.canvas.y - p.y * scale); };
    const bool whole_pixels = random.below(2) == 0;
    const auto add = [&](const FlatLine& line, const StrokeTruth& truth) {
        Stroke stroke;
        for (const DVec2& p : penned(line, options.shaken, random)) {
            const DVec2 at = down(p);
            stroke.points.push_back(options.shaken && whole_pixels ? glm::floor(at + 0.5) : at);
        }
        messy.truth.push_back(truth);
        if (random.below(5) < 2 && options.shuffled) {
            messy.truth.back().reversed = true;
            std::reverse(stroke.points.begin(), stroke.points.end());
        }
        stroke.id = static_cast<uint32_t>(messy.sketch.strokes.size()) + 1;
        messy.sketch.strokes.push_back(std::move(stroke));
    };
    for (const double hand : {-1.0, 1.0}) {
        if (drawing.radius == 0.0 && hand > 0.0) continue;
        FlatLine side = drawing.trunk;
        for (DVec2& p : side)
            p.x += hand * (drawing.radius == 0.0 ? 0.0 : trunk_radius(drawing, p));
        add(side, {StrokeRole::kTrunk, std::nullopt, Mess::kNone, false});
    }
    for (const FlatLine& side : drawing.sides)
        add(side, {StrokeRole::kBranch, down(side[0]), Mess::kNone, false});
    for (const FlatLine& branch : drawing.branches) {
        constexpr std::array<int, 20> kShares = {0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 4, 4, 5, 6, 6};
        const Mess mess = static_cast<Mess>(kShares[random.below(kShares.size())]);
        StrokeTruth truth{StrokeRole::kBranch, down(branch[0]), options.broken ? mess : Mess::kNone, false};
        // It is drawn from the trunk's side.
        add(spoilt(cut_from(branch, trunk_radius(drawing, branch[0])), truth.mess, random), truth);
    }
    if (random.below(8) != 0) {
        FlatLine outline = drawing.outline;
        // It stays open, or runs past its beginning.
        const int off = static_cast<int>(random.below(9)) - 4;
        if (off < 0) outline.resize(outline.size() - static_cast<size_t>(-off));
        for (int k = 0; k <= off; k++)
            outline.push_back(drawing.outline[static_cast<size_t>(k)] + DVec2(3.0 * k, 2.0 * k - 4.0));
        add(outline, {StrokeRole::kOutline, std::nullopt, Mess::kNone, false});
    }
    for (size_t i = messy.truth.size(); options.shuffled && i > 1; i--) {
        const size_t k = random.below(static_cast<uint32_t>(i));
        std::swap(messy.truth[i - 1], messy.truth[k]);
        std::swap(messy.sketch.strokes[i - 1], messy.sketch.strokes[k]);
    }
    return messy;
}

}  // namespace treerec::test
