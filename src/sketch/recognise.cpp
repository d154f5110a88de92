#include "sketch/recognise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sketch/clean.h"

namespace treerec {

namespace {

constexpr double kLeastLength = 6.0;  // pixels: shorter is a dot
// A line goes around something where its ends are nearer together than this share of its length, ...
constexpr double kRingChord = 0.7, kArchChord = 0.92, kClosedChord = 0.35;
// ... and its convex hull is no sliver: 4 pi area / perimeter^2, which is 1 of a circle.
constexpr double kRingRoundness = 0.3;
constexpr double kSlenderChord = 0.1, kSlenderRoundness = 0.12;
constexpr double kLeastCrown = 0.1;  // of the whole drawing's hull, in area
constexpr double kSmallRing = 0.12;  // of the drawing's height: an apple, a hole or a sun
// Strokes that go around the crown together: none bends less, and two meet within so much of both lengths.
constexpr double kStraight = 0.92, kMeet = 0.06, kChainRoundness = 0.5;
constexpr size_t kMostArcs = 40;
constexpr double kLeastRing = 0.02;                         // of the whole drawing's hull: less is a sun
constexpr double kGroundZone = 0.06, kStemBaseZone = 0.12;  // of the drawing's height, above its lowest point

struct Shape {
    double length = 0.0;
    double chord = 0.0;  // between its ends
    double area = 0.0;   // of its convex hull
    double roundness = 0.0;
    FlatBox box;
    bool is_dot = true;

    bool is_ring(double most_chord) const {
        return !is_dot && chord < most_chord * length && roundness > kRingRoundness;
    }
};

Shape shape_of(const FlatLine& line) {
    Shape shape;
    shape.length = line_length(line);
    shape.box = line_box(line);
    shape.is_dot = line.size() < 2 || shape.length < kLeastLength;
    if (shape.is_dot) return shape;
    shape.chord = glm::length(line.back() - line.front());
    FlatLine hull = flat_hull(line);
    if (hull.size() < 3) return shape;
    shape.area = polygon_area(hull);
    hull.push_back(hull[0]);
    const double around = line_length(hull);
    shape.roundness = 4.0 * kPi * shape.area / (around * around);
    return shape;
}

class Recogniser {
  public:
    Recogniser(std::span<const FlatLine> lines, std::span<const StrokeRole> wanted)
        : lines_(lines), wanted_(wanted) {
        FlatLine all;
        for (const FlatLine& line : lines) {
            shapes_.push_back(shape_of(line));
            if (!shapes_.back().is_dot) all.insert(all.end(), line.begin(), line.end());
        }
        whole_ = shape_of(all);
        found_.roles.assign(lines.size(), StrokeRole::kAuto);
        found_.faults.resize(lines.size());
    }

    Recognised run() {
        for (size_t i = 0; i < lines_.size(); i++)
            if (shapes_[i].is_dot) leave_out(i, "This is only a dot; draw a line.");
        leave_out_small_rings();
        find_outline();
        find_trunk();
        add_outlines();
        for (size_t i = 0; i < lines_.size(); i++) {
            if (!is_open(i)) continue;
            if (wanted_[i] == StrokeRole::kBranch || !is_other_outline(i)) give(i, StrokeRole::kBranch);
        }
        std::stable_sort(found_.outlines.begin(), found_.outlines.end(),
                         [&](size_t a, size_t b) { return shapes_[a].area > shapes_[b].area; });
        return std::move(found_);
    }

  private:
    // Not decided upon yet.
    bool is_open(size_t i) const { return found_.roles[i] == StrokeRole::kAuto && found_.faults[i].empty(); }
    bool is_free(size_t i) const { return is_open(i) && wanted_[i] == StrokeRole::kAuto; }

    void give(size_t i, StrokeRole role) {
        found_.roles[i] = role;
        if (role == StrokeRole::kOutline) found_.outlines.push_back(i);
        if (role == StrokeRole::kTrunk) found_.trunks.push_back(i);
        if (role == StrokeRole::kBranch) found_.branches.push_back(i);
    }

    void leave_out(size_t i, const char* why) { found_.faults[i] = why; }

    // The share of the other lines' points above the ring's lowest point that lie within its hull; 1 where
    // there are none.
    double share_within(size_t ring) const {
        const FlatLine hull = flat_hull(lines_[ring]);
        size_t within = 0, above = 0;
        for (size_t i = 0; i < lines_.size(); i++) {
            if (i == ring || shapes_[i].is_dot) continue;
            // A few of each line tell as much as all.
            const size_t step = std::max<size_t>(1, lines_[i].size() / 16);
            for (size_t k = 0; k < lines_[i].size(); k += step) {
                if (lines_[i][k].y < shapes_[ring].box.low.y) continue;
                above++;
                if (is_inside(hull, lines_[i][k])) within++;
            }
        }
        return above == 0 ? 1.0 : static_cast<double>(within) / static_cast<double>(above);
    }

    void find_outline() {
        for (size_t i = 0; i < lines_.size(); i++)
            if (wanted_[i] == StrokeRole::kOutline && is_open(i)) give(i, StrokeRole::kOutline);
        if (!found_.outlines.empty()) return;
        if (find_arcs() || find_chain()) return;
        size_t highest = lines_.size(), best = lines_.size();
        for (size_t i = 0; i < lines_.size(); i++)
            if (!shapes_[i].is_dot &&
                (highest == lines_.size() || shapes_[i].box.high.y > shapes_[highest].box.high.y))
                highest = i;
        size_t tried = 0;
        for (size_t i = 0; i < lines_.size(); i++) {
            if (!is_free(i)) continue;
            if (!shapes_[i].is_ring(i == highest ? kArchChord : kRingChord) && !is_slender_crown(i)) continue;
            if (best < lines_.size() && shapes_[i].area <= shapes_[best].area) continue;
            const bool closed = shapes_[i].chord < kClosedChord * shapes_[i].length;
            // Hostile drawings have a thousand rings.
            if ((closed && shapes_[i].area > 0.5 * kLeastCrown * whole_.area) || stands_alone(i) ||
                (shapes_[i].area > kLeastRing * whole_.area && tried++ < 50 && share_within(i) >= 0.5))
                best = i;
        }
        if (best < lines_.size() && !goes_around_trunk(best)) give(best, StrokeRole::kOutline);
    }

    // As a cypress has: closed, up to the top, and off the ground.
    bool is_slender_crown(size_t i) const {
        const FlatBox& box = shapes_[i].box;
        const double height = whole_.box.size().y;
        return !shapes_[i].is_dot && shapes_[i].chord < kSlenderChord * shapes_[i].length &&
               shapes_[i].roundness > kSlenderRoundness && box.high.y > whole_.box.high.y - 0.1 * height &&
               box.low.y > whole_.box.low.y + 0.1 * height;
    }

    bool stands_alone(size_t i) const {
        for (size_t k = 0; k < lines_.size(); k++)
            if (k != i && !shapes_[k].is_dot) return false;
        return true;
    }

    // Whether this closed line is rather a trunk's outline: slender, and upright.
    bool goes_around_trunk(size_t i) const {
        const DVec2 size = shapes_[i].box.size();
        return shapes_[i].length > 1.6 * size.y && shapes_[i].chord < 0.5 * shapes_[i].length &&
               shapes_[i].area < 0.35 * size.y * size.y && shapes_[i].area > 2.0 * size.y &&
               shapes_[i].box.low.y < whole_.box.low.y + kGroundZone * whole_.box.size().y &&
               (stands_alone(i) ? false
                                : shapes_[i].box.high.y < whole_.box.high.y - 0.2 * whole_.box.size().y);
    }

    // An outline of two arcs, such as the left and the right half: the ends of one lie at those of the other.
    bool find_arcs() {
        std::vector<size_t> arcs;
        for (size_t i = 0; i < lines_.size(); i++)
            if (is_free(i) && !stands_around(i) && shapes_[i].chord > kClosedChord * shapes_[i].length &&
                shapes_[i].is_ring(kArchChord) && shapes_[i].area > 0.5 * kLeastCrown * whole_.area)
                arcs.push_back(i);
        if (arcs.size() > 40) return false;
        double largest = 0.0;
        std::array<size_t, 2> best{};
        for (size_t m = 0; m < arcs.size(); m++)
            for (size_t n = m + 1; n < arcs.size(); n++) {
                const FlatLine &a = lines_[arcs[m]], &b = lines_[arcs[n]];
                const double near = 0.12 * (shapes_[arcs[m]].length + shapes_[arcs[n]].length);
                const double one =
                    std::max(glm::length(a.back() - b.front()), glm::length(b.back() - a.front()));
                const double other =
                    std::max(glm::length(a.back() - b.back()), glm::length(a.front() - b.front()));
                if (std::min(one, other) > near) continue;
                FlatLine both = a;
                both.insert(both.end(), b.begin(), b.end());
                const Shape joint = shape_of(both);
                if (joint.area >
                    std::max(largest, 1.25 * std::max(shapes_[arcs[m]].area, shapes_[arcs[n]].area))) {
                    largest = joint.area;
                    best = {arcs[m], arcs[n]};
                }
            }
        if (largest < kLeastCrown * whole_.area || largest == 0.0) return false;
        give(best[0], StrokeRole::kOutline);
        give(best[1], StrokeRole::kOutline);
        return true;
    }

    // An outline of several arcs, end to end: bumps of a cloud, each a stroke of its own, or a torn line.
    bool find_chain() {
        std::vector<size_t> arcs;
        double largest = 0.0;
        for (size_t i = 0; i < lines_.size(); i++) {
            if (!is_free(i) || shapes_[i].is_dot) continue;
            largest = std::max(largest, shapes_[i].area);
            if (!stands_around(i) && shapes_[i].chord > 0.5 * kClosedChord * shapes_[i].length &&
                shapes_[i].chord < kStraight * shapes_[i].length)
                arcs.push_back(i);
        }
        if (arcs.size() < 2 || arcs.size() > kMostArcs) return false;
        // It must be more than any stroke of them is by itself.
        const double least_area = std::max(1.15 * largest, 0.5 * kLeastCrown * whole_.area);
        double most = 0.0;
        std::vector<size_t> best;
        for (const size_t start : arcs) {
            FlatLine chain = lines_[start];
            std::vector<size_t> members = {start};
            double length = shapes_[start].length;
            while (true) {
                const DVec2 end = chain.back();
                // Closed, unless another stroke begins nearer.
                double least = members.size() > 1 ? glm::length(chain.front() - end) : 1e300;
                size_t next = lines_.size();
                bool turned = false;
                for (const size_t i : arcs) {
                    if (std::find(members.begin(), members.end(), i) != members.end()) continue;
                    const double near = kMeet * (shapes_[members.back()].length + shapes_[i].length);
                    for (const bool back : {false, true}) {
                        const double away = glm::length((back ? lines_[i].back() : lines_[i].front()) - end);
                        if (away > near || away >= least) continue;
                        least = away;
                        next = i;
                        turned = back;
                    }
                }
                if (next == lines_.size()) break;
                members.push_back(next);
                length += shapes_[next].length;
                if (turned)
                    chain.insert(chain.end(), lines_[next].rbegin(), lines_[next].rend());
                else
                    chain.insert(chain.end(), lines_[next].begin(), lines_[next].end());
            }
            const Shape joint = shape_of(chain);
            if (members.size() < 2 || joint.chord > 0.5 * kClosedChord * length ||
                joint.roundness < kChainRoundness || joint.area < least_area)
                continue;
            // Without what hangs on it, as a trunk's sides.
            if (joint.area * joint.roundness <= most) continue;
            most = joint.area * joint.roundness;
            best = members;
        }
        for (const size_t i : best)
            give(i, StrokeRole::kOutline);
        return !best.empty();
    }

    // How many ends of other lines lie near this one, at most 4.
    int touches(size_t i) const {
        const double near = std::max(8.0, 0.03 * whole_.box.size().y);
        int count = 0;
        for (size_t k = 0; k < lines_.size() && count < 4; k++) {
            if (k == i || shapes_[k].is_dot || found_.roles[k] == StrokeRole::kOutline) continue;
            if (std::min(nearest_on_line(lines_[i], lines_[k].front()).distance,
                         nearest_on_line(lines_[i], lines_[k].back()).distance) < near)
                count++;
        }
        return count;
    }

    void find_trunk() {
        std::vector<size_t> told;
        for (size_t i = 0; i < lines_.size(); i++)
            if (wanted_[i] == StrokeRole::kTrunk && is_open(i)) told.push_back(i);
        std::stable_sort(told.begin(), told.end(),
                         [&](size_t a, size_t b) { return shapes_[a].length > shapes_[b].length; });
        for (size_t k = 0; k < told.size(); k++) {
            if (k < 2)
                give(told[k], StrokeRole::kTrunk);
            else
                leave_out(told[k], "A trunk has one line, or two for its sides; this is a further one.");
        }
        if (told.size() == 2 && !are_sides(told[0], told[1], true)) {
            found_.trunks.pop_back();
            found_.roles[told[1]] = StrokeRole::kAuto;
            leave_out(told[1], "A tree has one trunk; this line does not stand beside the other one.");
        }
        if (told.size() > 1) return;
        size_t trunk = told.empty() ? best_trunk() : told[0];
        if (trunk == lines_.size()) return;
        if (told.empty()) give(trunk, StrokeRole::kTrunk);
        found_.goes_around = is_around(trunk);
        if (found_.goes_around) return;
        size_t other = lines_.size();
        for (size_t i = 0; i < lines_.size(); i++)
            if (is_free(i) && are_sides(trunk, i, false) &&
                (other == lines_.size() || shapes_[i].length > shapes_[other].length))
                other = i;
        if (other < lines_.size()) give(other, StrokeRole::kTrunk);
    }

    bool is_around(size_t i) const {
        const double height = shapes_[i].box.size().y;
        return shapes_[i].length > 1.6 * height && shapes_[i].chord < 0.5 * shapes_[i].length &&
               shapes_[i].area < 1.2 * height * height && shapes_[i].area > 3.0 * height;
    }

    // Whether it is apart from the outline, as are letters beside the tree, a hill and the like: no trunk,
    // however low, where there is another.
    bool is_apart(size_t i) const {
        if (found_.outlines.empty()) return false;
        FlatBox crown = shapes_[found_.outlines[0]].box;
        for (const size_t outline : found_.outlines) {
            crown.low = glm::min(crown.low, shapes_[outline].box.low);
            crown.high = glm::max(crown.high, shapes_[outline].box.high);
        }
        const DVec2 size = crown.size();
        const FlatBox& box = shapes_[i].box;
        return box.high.y < crown.low.y - 0.25 * size.y || box.high.x < crown.low.x - 0.1 * size.x ||
               box.low.x > crown.high.x + 0.1 * size.x;
    }

    // A trunk's three sides are no arc of a crown.
    bool stands_around(size_t i) const {
        return is_around(i) && shapes_[i].box.low.y < whole_.box.low.y + kStemBaseZone * whole_.box.size().y;
    }

    // lines_.size(): none stands.
    size_t best_trunk() const {
        double lowest = 0.0;
        bool any = false, all = true;
        for (size_t i = 0; i < lines_.size() && all; i++)
            all = !is_free(i) || is_apart(i);
        for (size_t i = 0; i < lines_.size(); i++) {
            if (!is_free(i) || (!all && is_apart(i))) continue;
            lowest = any ? std::min(lowest, shapes_[i].box.low.y) : shapes_[i].box.low.y;
            any = true;
        }
        size_t best = lines_.size();
        double most = 0.0;
        int tried = 0;
        for (size_t i = 0; any && i < lines_.size(); i++) {
            if (!is_free(i) || shapes_[i].box.low.y > lowest + kGroundZone * whole_.box.size().y ||
                (!all && is_apart(i)))
                continue;
            if (tried++ > 50) break;
            const int touched = touches(i);
            const double upright = shapes_[i].box.size().y;
            if (upright < 0.5 * shapes_[i].chord && touched == 0) continue;
            if (upright < 0.25 * shapes_[i].chord) continue;
            const double score = upright * (1.0 + 0.25 * touched);
            if (score > most) {
                most = score;
                best = i;
            }
        }
        return best;
    }

    double lowest_of_crown() const {
        double lowest = found_.outlines.empty() ? -1e300 : 1e300;
        for (const size_t outline : found_.outlines)
            lowest = std::min(lowest, shapes_[outline].box.low.y);
        return lowest;
    }

    // Whether both lines stand side by side from the ground up. told: the user says that both are the
    // trunk's.
    bool are_sides(size_t a, size_t b, bool told) const {
        const FlatBox &one = shapes_[a].box, &other = shapes_[b].box;
        const double low = std::max(one.low.y, other.low.y), high = std::min(one.high.y, other.high.y);
        const double tall = std::max(one.size().y, other.size().y), common = high - low;
        if (common < (told ? 0.3 : 0.4) * tall || common <= 0.0) return false;
        if (!told && low - std::min(one.low.y, other.low.y) > kStemBaseZone * whole_.box.size().y)
            return false;
        if (one.size().x > 0.8 * one.size().y || other.size().x > 0.8 * other.size().y) return false;
        // Between them at eight heights; they neither cross nor part.
        double stem_base = 0.0;
        for (int k = 0; k < 8; k++) {
            const double y = low + (0.05 + 0.9 * k / 7.0) * common;
            const double between = x_at(lines_[b], y) - x_at(lines_[a], y);
            if (k == 0) stem_base = between;
            if (std::abs(between) < (told ? 1.0 : 3.0) || between * stem_base < 0.0) return false;
            if (std::abs(between) > (told ? 2.5 : 1.5) * std::abs(stem_base) + 4.0) return false;
        }
        // Both of them below a crown, and alone there, are a stout, short trunk.
        const bool stout = told || (high < lowest_of_crown() + 0.2 * common && common > 0.8 * tall);
        return std::abs(stem_base) < (stout ? 1.0 : 0.5) * common;
    }

    // The mean of where a line crosses this height.
    static double x_at(const FlatLine& line, double y) {
        double sum = 0.0;
        int count = 0;
        for (size_t i = 0; i + 1 < line.size(); i++) {
            const DVec2 a = line[i], b = line[i + 1];
            if ((a.y <= y) == (b.y <= y)) continue;
            sum += a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
            count++;
        }
        return count == 0 ? line[0].x : sum / count;
    }

    // Rings that cross the outline, or one that does, are parts of it: a fir's are a chain.
    void add_outlines() {
        if (found_.outlines.empty()) return;
        const double least = 0.02 * shapes_[found_.outlines[0]].area;
        for (size_t k = 0; k < found_.outlines.size() && k < 50; k++) {
            const FlatLine& outline = lines_[found_.outlines[k]];
            for (size_t i = 0; i < lines_.size(); i++) {
                if (!is_free(i) || !shapes_[i].is_ring(0.5) || shapes_[i].area < least) continue;
                if (!crossings(lines_[i], outline).empty() ||
                    !crossings({lines_[i].back(), lines_[i].front()}, outline).empty())
                    give(i, StrokeRole::kOutline);
            }
        }
    }

    // A ring apart from the outline: left out.
    bool is_other_outline(size_t i) {
        if (found_.outlines.empty() || !shapes_[i].is_ring(0.5)) return false;
        if (shapes_[i].chord > 0.2 * shapes_[i].length) return false;
        leave_out(i, is_inside(lines_[found_.outlines[0]], lines_[i][0])
                         ? "This lies within the crown's outline and changes nothing of it."
                         : "A tree has one crown, and this is a second outline; let it cross the first one.");
        return true;
    }

    // Apples, and a hole in the trunk.
    void leave_out_small_rings() {
        const double most = kSmallRing * whole_.box.size().y;
        bool other = false;
        for (size_t i = 0; i < lines_.size() && !other; i++) {
            const DVec2 size = shapes_[i].box.size();
            other = is_open(i) && (!shapes_[i].is_ring(kClosedChord) || std::max(size.x, size.y) > most);
        }
        for (size_t i = 0; i < lines_.size() && other; i++) {
            const DVec2 size = shapes_[i].box.size();
            if (is_free(i) && shapes_[i].is_ring(kClosedChord) && std::max(size.x, size.y) < most)
                leave_out(
                    i,
                    "This is a small ring, as of an apple, a hole or a sun; it changes nothing of the tree.");
        }
    }

    std::span<const FlatLine> lines_;
    std::span<const StrokeRole> wanted_;
    std::vector<Shape> shapes_;
    Shape whole_;
    Recognised found_;
};

}  // namespace

Recognised recognise(std::span<const FlatLine> lines, std::span<const StrokeRole> wanted) {
    return Recogniser(lines, wanted).run();
}

}  // namespace treerec
