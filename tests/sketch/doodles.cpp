#include "doodles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "geometry/portable_math.h"
#include "geometry/random.h"

namespace treerec::test {

namespace {

using Line = std::vector<DVec2>;

DVec2 around(double angle) {
    return {portable::sin(angle), -portable::cos(angle)};
}

// Draws in a unit square, y down; the ground is at about .95.
class Scribbler {
  public:
    explicit Scribbler(uint64_t seed) : random_(seed, 31) {}

    Doodle run() {
        struct Kind {
            const char* name;
            uint32_t weight;
            bool tree_like, has_outline;
            void (Scribbler::*draw)();
        };
        static const std::array<Kind, 12> kKinds = {{
            {"round", 18, true, true, &Scribbler::round_tree},
            {"cloud", 18, true, true, &Scribbler::cloud_tree},
            {"zigzag", 6, true, true, &Scribbler::zigzag_tree},
            {"triangle", 6, true, true, &Scribbler::triangle_tree},
            {"fir", 12, true, true, &Scribbler::fir},
            {"bare", 12, true, false, &Scribbler::bare_tree},
            {"one stroke", 8, true, true, &Scribbler::one_stroke_tree},
            {"scribble", 6, true, false, &Scribbler::scribbled_tree},
            {"spiral", 4, true, false, &Scribbler::spiral_tree},
            {"arcs", 4, true, true, &Scribbler::tree_of_arcs},
            {"palm", 4, true, false, &Scribbler::palm},
            {"no tree", 16, false, false, &Scribbler::no_tree},
        }};
        uint32_t all = 0;
        for (const Kind& kind : kKinds)
            all += kind.weight;
        uint32_t drawn = random_.below(all);
        const Kind* kind = kKinds.data();
        while (drawn >= kind->weight)
            drawn -= (kind++)->weight;
        doodle_.kind = kind->name;
        doodle_.tree_like = kind->tree_like;
        doodle_.has_outline = kind->has_outline;
        (this->*kind->draw)();
        if (kind->tree_like && chance(0.45)) add_beside();
        spoil();
        place();
        return std::move(doodle_);
    }

  private:
    bool chance(double share) { return random_.uniform() < share; }
    double from(double low, double high) { return random_.uniform(low, high); }

    void add(Line line) { lines_.push_back(std::move(line)); }

    // A straight line as a hand draws it.
    Line stroke(const DVec2& a, const DVec2& b, double bend = 0.03) {
        Line line;
        const double bow = from(-bend, bend);
        const DVec2 way = b - a, side(-way.y, way.x);
        for (int i = 0; i <= 24; i++) {
            const double t = i / 24.0;
            line.push_back(a + way * t + side * (bow * 4.0 * t * (1.0 - t)));
        }
        return line;
    }

    static void append(Line& line, const Line& more) { line.insert(line.end(), more.begin(), more.end()); }

    void go_to(Line& line, const DVec2& p, double bend) {
        append(line, line.empty() ? Line{p} : stroke(line.back(), p, bend));
    }

    // Around, from a chance place, with a gap or an overshoot at its end; bumps stand out by `bump`.
    Line ring(const DVec2& middle, const DVec2& radii, int bumps = 0, double bump = 0.0) {
        const double begin = from(0.0, 2.0 * kPi);
        const double turn = 2.0 * kPi * (chance(0.3) ? from(0.88, 0.97) : from(0.985, 1.08));
        const double drift = from(-0.03, 0.03), squash = from(-0.06, 0.06), phase = from(0.0, 6.0);
        const int steps = 180;
        Line line;
        for (int i = 0; i <= steps; i++) {
            const double angle = begin + turn * i / steps;
            double out = 1.0 + drift * i / steps + squash * portable::sin(2.0 * angle + phase);
            if (bumps > 0) out *= 1.0 + bump * (std::abs(portable::sin(0.5 * bumps * angle)) - 0.6);
            line.push_back(middle + radii * out * around(angle));
        }
        return line;
    }

    void crown_at(const DVec2& middle, const DVec2& radii) {
        crown_middle_ = middle;
        crown_radii_ = radii;
        doodle_.crown_low = middle - radii;
        doodle_.crown_high = middle + radii;
    }

    // From the crown down to the ground: a line, two of them, a box, or one line around three sides.
    void trunk(double top) {
        const double x = crown_middle_.x + from(-0.04, 0.04);
        const double ground = std::min(0.97, crown_middle_.y + crown_radii_.y + from(0.18, 0.35));
        doodle_.stem_base = DVec2(x, ground);
        const double half = from(0.02, 0.055), flare = from(0.0, 0.03);
        const double up = top + from(-0.05, 0.02);
        const uint32_t way = random_.below(10);
        if (way < 3) {
            add(stroke({x, ground}, {x + from(-0.02, 0.02), chance(0.4) ? crown_middle_.y : up}));
        } else if (way < 7) {
            add(stroke({x - half - flare, ground}, {x - half, up}));
            add(stroke({x + half + flare, ground + from(-0.01, 0.01)}, {x + half, up + from(-0.02, 0.02)}));
        } else if (way < 9) {
            // Three sides in one stroke, open above.
            Line line = stroke({x - half, up}, {x - half - flare, ground}, 0.02);
            append(line, stroke(line.back(), {x + half + flare, ground}, 0.02));
            append(line, stroke(line.back(), {x + half, up}, 0.02));
            add(line);
        } else {
            add(box({x - half, ground}, {x + half, up}));
        }
        if (chance(0.15)) roots(x, ground);
    }

    Line box(const DVec2& low, const DVec2& high) {
        Line line = stroke({low.x, high.y}, low, 0.01);
        for (const DVec2& to : {DVec2(high.x, low.y), high, DVec2(low.x, high.y)})
            append(line, stroke(line.back(), to, 0.01));
        return line;
    }

    void roots(double x, double ground) {
        for (const double side : {-1.0, 1.0})
            add(stroke({x + side * 0.03, ground}, {x + side * from(0.08, 0.14), ground + 0.02}, 0.15));
    }

    void branches_within() {
        const double base = crown_middle_.y + 0.4 * crown_radii_.y;
        const uint32_t count = 2 + random_.below(4);
        for (uint32_t i = 0; i < count; i++) {
            const double side = i % 2 == 0 ? 1.0 : -1.0;
            const DVec2 a(crown_middle_.x + from(-0.01, 0.01), base - 0.08 * i * crown_radii_.y / 0.3);
            add(stroke(a, crown_middle_ + crown_radii_ * 0.65 * around(side * from(0.4, 1.3)), 0.08));
        }
    }

    void round_tree() { rounded_tree(0); }
    void cloud_tree() { rounded_tree(5 + static_cast<int>(random_.below(8))); }

    void rounded_tree(int bumps) {
        crown_at({0.5 + from(-0.05, 0.05), from(0.3, 0.38)}, {from(0.18, 0.35), from(0.18, 0.29)});
        add(ring(crown_middle_, crown_radii_, bumps, from(0.12, 0.4)));
        trunk(crown_middle_.y + (bumps > 0 ? 0.9 : 1.0) * crown_radii_.y);
        if (chance(0.25)) branches_within();
    }

    void zigzag_tree() {
        crown_at({0.5, from(0.3, 0.38)}, {from(0.2, 0.34), from(0.2, 0.28)});
        const int teeth = 9 + static_cast<int>(random_.below(10));
        Line line;
        for (int i = 0; i <= 2 * teeth; i++) {
            const double out = i % 2 == 0 ? 1.0 : from(0.72, 0.86);
            const DVec2 p = crown_middle_ + crown_radii_ * out * around(kPi + kPi * i / teeth);
            go_to(line, p, 0.02);
        }
        add(line);
        trunk(crown_middle_.y + 0.9 * crown_radii_.y);
    }

    void triangle_tree() {
        crown_at({0.5, from(0.36, 0.42)}, {from(0.18, 0.3), from(0.26, 0.34)});
        const DVec2 left(doodle_.crown_low.x, doodle_.crown_high.y);
        Line line = stroke(left, {0.5, doodle_.crown_low.y}, 0.02);
        append(line, stroke(line.back(), doodle_.crown_high, 0.02));
        append(line, stroke(line.back(), left + DVec2(from(-0.02, 0.04), from(-0.02, 0.02)), 0.02));
        add(line);
        trunk(doodle_.crown_high.y);
    }

    // Stacked triangles: closed ones above each other, or one outline around all of them.
    void fir() {
        const uint32_t count = 2 + random_.below(3);
        const double top = from(0.05, 0.1), bottom = from(0.72, 0.82), half = from(0.2, 0.3);
        crown_at({0.5, 0.5 * (top + bottom)}, {half, 0.5 * (bottom - top)});
        const double step = (bottom - top) / count;
        const auto half_at = [&](uint32_t k) { return half * (0.5 + 0.5 * (k + 1) / count); };
        if (chance(0.5)) {
            for (uint32_t k = 0; k < count; k++) {
                const double high = top + step * k - (k > 0 ? 0.35 * step : 0.0), low = top + step * (k + 1);
                Line line = stroke({0.5, high}, {0.5 - half_at(k), low}, 0.03);
                append(line, stroke(line.back(), {0.5 + half_at(k), low + from(-0.01, 0.01)}, 0.03));
                append(line, stroke(line.back(), {0.5 + from(-0.01, 0.01), high}, 0.03));
                add(line);
            }
        } else {
            Line line = {{0.5, top}};
            for (uint32_t k = 0; k < count; k++) {
                append(line, stroke(line.back(), {0.5 + half_at(k), top + step * (k + 1)}, 0.03));
                if (k + 1 < count)
                    append(line, stroke(line.back(), {0.5 + 0.45 * half_at(k), top + step * (k + 0.95)}));
            }
            append(line, stroke(line.back(), {0.5 - half_at(count - 1), bottom}, 0.03));
            for (uint32_t k = count; k-- > 0;) {
                append(line, stroke(line.back(), {0.5 - (k > 0 ? 0.45 * half_at(k - 1) : 0.0),
                                                  top + step * (k > 0 ? k - 0.05 : 0.0)}));
                if (k > 0) append(line, stroke(line.back(), {0.5 - half_at(k - 1), top + step * k}));
            }
            add(line);
        }
        trunk(bottom);
    }

    void fork(const DVec2& base, double angle, double length, int depth) {
        const DVec2 tip = base + length * around(angle);
        add(stroke(base, tip, 0.06));
        reach_.push_back(tip);
        if (depth < deepest_) reach_.push_back(base);
        if (depth == 0) return;
        const int count = 2 + static_cast<int>(random_.below(2));
        for (int i = 0; i < count; i++) {
            const double spread = from(0.35, 0.75) * (i % 2 == 0 ? 1.0 : -1.0);
            const DVec2 at = i < 2 ? tip : base + (tip - base) * from(0.5, 0.9);
            fork(at, angle + spread, length * from(0.6, 0.8), depth - 1);
        }
    }

    void bare_tree() {
        const DVec2 ground(0.5, from(0.9, 0.97));
        if (chance(0.35)) {
            // A stem with twigs on both sides.
            const double top = from(0.08, 0.2);
            add(stroke(ground, {0.5 + from(-0.03, 0.03), top}, 0.03));
            reach_.push_back({0.5, top});
            const uint32_t count = 4 + random_.below(6);
            for (uint32_t i = 0; i < count; i++) {
                const double share = 0.35 + 0.55 * i / count, side = i % 2 == 0 ? 1.0 : -1.0;
                const DVec2 base(0.5, ground.y + (top - ground.y) * share);
                const DVec2 tip = base + from(0.14, 0.26) * (1.2 - share) * around(side * from(0.6, 1.2));
                add(stroke(base, tip, 0.06));
                reach_.insert(reach_.end(), {base, tip});
            }
        } else {
            deepest_ = 1 + static_cast<int>(random_.below(2));
            fork(ground, from(-0.08, 0.08), from(0.26, 0.36), deepest_);
        }
        DVec2 low = reach_[0], high = reach_[0];
        for (const DVec2& p : reach_) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        crown_at(0.5 * (low + high), 0.5 * (high - low));
        doodle_.stem_base = ground;
    }

    // Up the trunk, around the crown and down again, or down the same line.
    void one_stroke_tree() {
        crown_at({0.5, from(0.3, 0.38)}, {from(0.18, 0.32), from(0.18, 0.28)});
        const double ground = from(0.85, 0.97), half = chance(0.3) ? 0.0 : from(0.02, 0.05);
        doodle_.stem_base = DVec2(0.5, ground);
        const double open = half > 0.0 ? portable::atan2(half, crown_radii_.x) : 0.02;
        const int bumps = chance(0.5) ? 6 + static_cast<int>(random_.below(6)) : 0;
        Line crown;
        for (int i = 0; i <= 160; i++) {
            const double angle = kPi + open + (2.0 * kPi - 2.0 * open) * i / 160;
            const double out =
                bumps == 0 ? 1.0 : 1.0 + 0.2 * (std::abs(portable::sin(0.5 * bumps * angle)) - 0.6);
            crown.push_back(crown_middle_ + crown_radii_ * out * around(angle));
        }
        Line line = stroke({0.5 - half - 0.01, ground}, crown.front(), 0.01);
        append(line, crown);
        if (half > 0.0) append(line, stroke(line.back(), {0.5 + half + 0.01, ground}, 0.01));
        add(line);
    }

    // A crown that is filled to and fro, with a line around it or without one.
    void scribbled_tree() {
        crown_at({0.5, from(0.3, 0.36)}, {from(0.2, 0.3), from(0.2, 0.26)});
        if (chance(0.6)) add(ring(crown_middle_, crown_radii_));
        Line line;
        const int rows = 8 + static_cast<int>(random_.below(20));
        for (int i = 0; i <= rows; i++) {
            const double y = -0.95 + 1.9 * i / rows;
            const double x = std::sqrt(1.0 - y * y) * from(0.8, 1.0) * (i % 2 == 0 ? 1.0 : -1.0);
            const DVec2 p = crown_middle_ + crown_radii_ * DVec2(x, y);
            go_to(line, p, 0.03);
        }
        add(line);
        trunk(crown_middle_.y + crown_radii_.y);
    }

    void spiral_tree() {
        crown_at({0.5, from(0.3, 0.36)}, {from(0.2, 0.3), from(0.2, 0.26)});
        Line line;
        const double turns = from(2.0, 5.0);
        for (int i = 0; i <= 240; i++)
            line.push_back(crown_middle_ +
                           crown_radii_ * (i / 240.0) * around(2.0 * kPi * turns * i / 240.0));
        add(line);
        trunk(crown_middle_.y + crown_radii_.y);
    }

    // A cloud of arcs, each its own stroke.
    void tree_of_arcs() {
        crown_at({0.5, from(0.3, 0.38)}, {from(0.22, 0.34), from(0.2, 0.28)});
        const int count = 4 + static_cast<int>(random_.below(5));
        for (int k = 0; k < count; k++) {
            const double begin = 2.0 * kPi * k / count, end = 2.0 * kPi * (k + 1) / count;
            const DVec2 a = crown_middle_ + crown_radii_ * 0.85 * around(begin - 0.05);
            const DVec2 b = crown_middle_ + crown_radii_ * 0.85 * around(end + 0.05);
            const DVec2 out = crown_radii_ * 0.3 * around(0.5 * (begin + end));
            Line line;
            for (int i = 0; i <= 24; i++)
                line.push_back(a + (b - a) * (i / 24.0) + out * portable::sin(kPi * i / 24.0));
            add(line);
        }
        trunk(crown_middle_.y + 0.9 * crown_radii_.y);
    }

    void palm() {
        const DVec2 ground(from(0.4, 0.6), 0.95), top(0.5 + from(-0.08, 0.08), from(0.28, 0.36));
        Line stem = stroke(ground, top, 0.1);
        add(stem);
        for (DVec2& p : stem)
            p += DVec2(0.05 - 0.02 * (ground.y - p.y), 0.0);
        if (chance(0.4)) add(stem);
        DVec2 low = top, high = top;
        const uint32_t count = 4 + random_.below(4);
        for (uint32_t i = 0; i < count; i++) {
            const double angle = -1.9 + 3.8 * i / (count - 1);
            const DVec2 tip = top + from(0.2, 0.3) * around(angle) + DVec2(0.0, 0.06);
            Line line;
            for (int k = 0; k <= 20; k++)
                line.push_back(top + (tip - top) * (k / 20.0) -
                               DVec2(0.0, 0.08 * portable::sin(kPi * k / 20.0)));
            add(line);
            low = glm::min(low, tip);
            high = glm::max(high, tip);
        }
        crown_at(0.5 * (low + high), 0.5 * (high - low));
        doodle_.stem_base = ground;
    }

    // What stands around and on a tree.
    void add_beside() {
        const double ground = doodle_.stem_base.y;
        if (chance(0.4))
            add(stroke({from(0.02, 0.2), ground + 0.01}, {from(0.8, 0.98), ground + 0.01}, 0.02));
        if (chance(0.25)) {
            const uint32_t apples = 2 + random_.below(5);
            for (uint32_t i = 0; i < apples; i++)
                add(ring(crown_middle_ + crown_radii_ * from(0.1, 0.6) * around(from(0.0, 6.28)),
                         DVec2(from(0.012, 0.03))));
        }
        if (chance(0.15))
            add(ring({doodle_.stem_base.x, ground - from(0.06, 0.12)}, {0.012, from(0.012, 0.025)}));
        if (chance(0.2)) {
            Line grass;
            for (int i = 0; i <= 12; i++)
                grass.push_back({0.1 + 0.8 * i / 12.0, ground + (i % 2 == 0 ? 0.02 : -0.02)});
            add(grass);
        }
        if (chance(0.15)) {
            add(ring({0.92, 0.07}, DVec2(0.05)));
            for (int i = 0; i < 5; i++)
                add(stroke(DVec2(0.92, 0.07) + 0.06 * around(1.2 * i),
                           DVec2(0.92, 0.07) + 0.08 * around(1.2 * i)));
        }
        if (chance(0.15)) letters({0.02, from(0.5, 0.8)}, 0.05);
        if (chance(0.15)) add({DVec2(from(0.1, 0.9), from(0.1, 0.9))});
    }
    void letters(const DVec2& place, double size) {
        add({place, place + DVec2(size, 0.0)});
        add(stroke(place + DVec2(0.5 * size, 0.0), place + DVec2(0.5 * size, size)));
        add(stroke(place + DVec2(1.2 * size, 0.4 * size), place + DVec2(1.2 * size, size)));
        add(ring(place + DVec2(2.0 * size, 0.7 * size), DVec2(0.3 * size)));
    }

    void no_tree() {
        const uint32_t kind = random_.below(6);
        const uint32_t count = 1 + random_.below(12);
        for (uint32_t i = 0; i < count; i++) {
            const DVec2 a(random_.uniform(), random_.uniform()), b(random_.uniform(), random_.uniform());
            switch (kind) {
                case 0:  // dots
                    add(Line(1 + random_.below(5), a));
                    break;
                case 1:
                    letters(a * 0.8, from(0.03, 0.15));
                    break;
                case 2: {  // a scrawl
                    Line line = {a};
                    const uint32_t points = 2 + random_.below(400);
                    for (uint32_t k = 0; k < points; k++)
                        line.push_back(line.back() + from(0.0, 0.05) * around(from(0.0, 6.28)));
                    add(line);
                    break;
                }
                case 3:  // bubbles
                    add(ring(a, DVec2(from(0.01, 0.4), from(0.01, 0.4))));
                    break;
                case 4:  // a grid, all crossing
                    add(i % 2 == 0 ? stroke({0.05 * i, 0.0}, {0.05 * i, 1.0}, 0.0)
                                   : stroke({0.0, 0.05 * i}, {1.0, 0.05 * i}, 0.0));
                    break;
                default:
                    add(stroke(a, b, 0.4));
            }
        }
    }

    // By the hand and by what recorded it.
    void spoil() {
        const bool torn = chance(0.12), shuffled = chance(0.4), turned = chance(0.3);
        const double shake = chance(0.6) ? from(0.0, 0.004) : 0.0;
        std::vector<Line> all;
        for (const Line& line : lines_) {
            if (torn && line.size() > 60 && chance(0.5)) {
                const size_t at = line.size() / 3 + random_.below(static_cast<uint32_t>(line.size() / 3));
                all.emplace_back(line.begin(), line.begin() + static_cast<ptrdiff_t>(at) + 1);
                all.emplace_back(line.begin() + static_cast<ptrdiff_t>(at), line.end());
            } else {
                all.push_back(line);
            }
        }
        lines_ = std::move(all);
        for (Line& line : lines_) {
            if (turned && chance(0.5)) std::reverse(line.begin(), line.end());
            for (DVec2& p : line)
                p += shake * DVec2(random_.normal(), random_.normal());
        }
        for (size_t i = lines_.size(); shuffled && i-- > 1;)
            std::swap(lines_[i], lines_[random_.below(static_cast<uint32_t>(i + 1))]);
        const uint32_t sampling = random_.below(10);
        for (Line& line : lines_) {
            Line sampled;
            for (size_t i = 0; i < line.size(); i++) {
                if (sampling < 3 && i % 5 != 0 && i + 1 != line.size()) continue;  // few
                sampled.push_back(line[i]);
                if (sampling == 3) sampled.push_back(line[i]);  // twice each
                if (sampling == 4 && i + 1 < line.size())
                    for (int k = 1; k < 20; k++)  // thousands
                        sampled.push_back(line[i] + (line[i + 1] - line[i]) * (k / 20.0));
            }
            line = std::move(sampled);
        }
    }

    // On canvases of all sizes, in a part of it or beyond it.
    void place() {
        constexpr std::array<double, 7> kSizes = {1000.0, 1000.0, 256.0, 600.0, 40.0, 4000.0, 50000.0};
        const double size = kSizes[random_.below(kSizes.size())];
        const double wide = chance(0.3) ? from(0.6, 2.0) : 1.0;
        Sketch& sketch = doodle_.sketch;
        sketch.canvas = DVec2(size * wide, size);
        const double scale = chance(0.3) ? from(0.15, 0.6) : from(0.8, 1.0);
        DVec2 corner = (DVec2(wide, 1.0) - scale) * 0.5;
        if (chance(0.3)) corner = DVec2(from(0.0, wide), from(0.0, 1.0)) - DVec2(0.5 * scale);
        const bool whole = chance(0.25) && size * scale > 200.0;  // pixels
        const auto placed = [&](const DVec2& p) { return (corner + p * scale) * size; };
        for (const Line& line : lines_) {
            Stroke stroke;
            for (const DVec2& p : line)
                stroke.points.push_back(whole ? glm::floor(placed(p)) : placed(p));
            sketch.strokes.push_back(std::move(stroke));
        }
        sketch.seed = 1 + random_.below(1000);
        constexpr std::array<const char*, 5> kSpecies = {"", "ginkgo", "magnolia", "maple", "poplar"};
        sketch.species = kSpecies[random_.below(kSpecies.size())];
        sketch.height = chance(0.5) ? 0.0 : from(1.0, 40.0);
        sketch.number_strokes();
        doodle_.crown_low = placed(doodle_.crown_low);
        doodle_.crown_high = placed(doodle_.crown_high);
        doodle_.stem_base = placed(doodle_.stem_base);
    }

    Random random_;
    Doodle doodle_;
    std::vector<Line> lines_;
    DVec2 crown_middle_{0.0}, crown_radii_{0.0};
    std::vector<DVec2> reach_;
    int deepest_ = 0;
};

}  // namespace
Doodle scribbled_doodle(uint64_t seed) {
    return Scribbler(seed).run();
}

}  // namespace treerec::test
