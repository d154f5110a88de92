#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "error.h"
#include "geometry/portable_math.h"
#include "sketch/clean.h"
#include "sketch/drawn_trunk.h"
#include "sketch/outline.h"
#include "sketch/recognise.h"
#include "sketch/repair.h"
#include "sketch/strokes.h"

namespace treerec {

namespace {

constexpr double kSeenGap = 10.0;     // pixels between an outline's ends that are worth a word
constexpr double kNoMargin = 10.0;    // pixels that a line may be out of the crown before it is said
constexpr double kStandsOn = 0.04;    // of the outline's height: what goes farther down bears it
constexpr double kNearBranch = 25.0;  // pixels from the branch that a side branch grows from

class Understanding {
  public:
    Understanding(const Sketch& sketch, const RepairOptions& options)
        : sketch_(sketch), options_(options), scale_(kCanvasHeight / sketch.canvas.y) {}

    UnderstoodSketch run() {
        std::vector<FlatLine> lines;
        std::vector<StrokeRole> wanted;
        for (const Stroke& stroke : sketch_.strokes) {
            FlatLine line;
            for (const DVec2& p : stroke.points)
                line.emplace_back(p.x * scale_, (sketch_.canvas.y - p.y) * scale_);
            lines.push_back(std::move(line));
            wanted.push_back(stroke.role);
        }
        lines_ = clean_lines(lines);
        found_ = recognise(lines_, wanted);
        result_.strokes.resize(lines_.size());
        bool any = false;
        for (size_t i = 0; i < lines_.size(); i++) {
            reading(i).role = found_.roles[i];
            reading(i).fault = found_.faults[i];
            reading(i).left_out = !found_.faults[i].empty();
            if (reading(i).left_out) continue;
            any = true;
            const FlatBox box = line_box(lines_[i]);
            lowest_ = std::min(lowest_, box.low.y);
            highest_ = std::max(highest_, box.high.y);
        }
        if (!any)
            throw Error(lines_.empty()
                            ? "Nothing is drawn yet. Draw a trunk from the ground up, some branches "
                              "and the outline of the crown."
                            : "There are only dots in the drawing. Draw lines: a trunk from the "
                              "ground up, some branches and the outline of the crown.");
        read_outline();
        read_trunk();
        if (!drawn().outline.empty() && found_.branches.empty() &&
            reach_into_crown(drawn().trunk, drawn().outline))
            result_.remarks.emplace_back("The trunk ends below the crown; it was extended into it.");
        read_branches();
        if (drawn().outline.empty()) make_up_outline();
        say_what_leaves();
        for (size_t k = 0; k < drawn().branches.size(); k++)
            join(drawn().branches[k], k, drawn().trunk, branch_places_);
        for (size_t k = 0; k < drawn().side_branches.size(); k++)
            join(drawn().side_branches[k], k, drawn().branches[*drawn().side_branches[k].parent],
                 side_places_);
        return std::move(result_);
    }

  private:
    StrokeReading& reading(size_t stroke) { return result_.strokes[stroke]; }
    DrawnTree& drawn() { return result_.drawn; }

    void mark(size_t stroke, StrokeRepair repair) { reading(stroke).repairs.push_back(repair); }

    void leave_out(size_t stroke, const char* why) {
        reading(stroke).fault = why;
        reading(stroke).left_out = true;
        reading(stroke).role = StrokeRole::kAuto;
    }

    void read_outline() {
        if (found_.outlines.empty()) return;
        std::vector<FlatLine> parts;
        for (const size_t stroke : found_.outlines)
            parts.push_back(lines_[stroke]);
        const std::vector<FlatLine> rings = join_arcs(parts);
        const MadeOutline made = make_outline(rings);
        if (rings.size() == 1) outline_line_ = rings[0];
        if (made.polygon.empty()) {
            for (const size_t stroke : found_.outlines)
                leave_out(stroke, "This outline encloses nothing; draw it around the crown.");
            found_.outlines.clear();
            return;
        }
        drawn().outline = made.polygon;
        drawn().outline_stroke = found_.outlines[0];
        if (made.chord > kSeenGap) mark(found_.outlines[0], StrokeRepair::kClosed);
        if (made.united || parts.size() > 1)
            for (const size_t stroke : found_.outlines)
                mark(stroke, StrokeRepair::kUnited);
        if (made.hull)
            reading(found_.outlines[0]).fault =
                "This outline crosses itself or runs to and fro; the line around all of it was taken.";
    }

    void read_trunk() {
        DrawnLine& trunk = drawn().trunk;
        if (split_outline()) return;
        if (!found_.trunks.empty()) {
            const size_t first = *std::min_element(found_.trunks.begin(), found_.trunks.end());
            if (found_.trunks.size() == 2)
                trunk = middle_of_sides(lines_[found_.trunks[0]], lines_[found_.trunks[1]]);
            else if (found_.goes_around)
                trunk = middle_of_outline(lines_[first]);
            if (trunk.points.size() > 1) {
                for (const size_t stroke : found_.trunks)
                    mark(stroke, StrokeRepair::kTwoSides);
            } else {
                bool reversed = false;
                trunk = DrawnLine();
                trunk.points = upward(lines_[first], &reversed);
                if (reversed) mark(first, StrokeRepair::kReversed);
            }
            trunk.stroke = first;
            return;
        }
        if (drawn().outline.empty())
            throw Error(
                "Nothing in the drawing looks like a trunk or like a crown's outline. Draw a trunk "
                "from the ground up, or the outline of the crown.");
        trunk.stroke = found_.outlines[0];
        trunk.points = make_trunk(drawn().outline, trunk_place(), lowest_);
        result_.remarks.emplace_back("No trunk was drawn; a straight one was made.");
    }

    // Where the outline stands on the ground, it may go around the trunk, too. What was taken for the trunk
    // then is something beside it.
    bool split_outline() {
        if (outline_line_.empty() || drawn().outline.empty()) return false;
        const size_t outline = found_.outlines[0];
        const FlatBox around = line_box(outline_line_);
        const double ground = around.low.y;
        if (ground > lowest_ + 0.5 * (highest_ - lowest_)) return false;
        const auto split = split_lollipop(outline_line_, drawn().outline);
        if (!split) return false;
        const MadeOutline crown = make_outline({split->crown});
        if (crown.polygon.empty()) return false;
        const FlatBox box = line_box(crown.polygon);
        for (const size_t stroke : found_.trunks) {
            const FlatBox trunk = line_box(lines_[stroke]);
            const bool beside = trunk.high.x < box.low.x || trunk.low.x > box.high.x;
            const bool below = trunk.low.y < ground - kStandsOn * around.size().y && trunk.high.y > ground;
            const bool bears_it = !beside && trunk.low.y < box.low.y && (below || trunk.high.y > box.low.y);
            if (bears_it || sketch_.strokes[stroke].role == StrokeRole::kTrunk) return false;
        }
        drawn().outline = crown.polygon;
        drawn().trunk = split->trunk;
        drawn().trunk.stroke = outline;
        if (!split->trunk.radii.empty()) mark(outline, StrokeRepair::kTwoSides);
        result_.remarks.emplace_back("Trunk and crown were drawn in one stroke.");
        for (const size_t stroke : found_.trunks)
            reading(stroke).role = StrokeRole::kBranch;
        found_.branches.insert(found_.branches.end(), found_.trunks.begin(), found_.trunks.end());
        std::sort(found_.branches.begin(), found_.branches.end());
        found_.trunks.clear();
        return true;
    }

    // Where a trunk stands that was not drawn: among the branches' inner ends, or below the crown's middle.
    double trunk_place() {
        const FlatBox box = line_box(drawn().outline);
        const double middle = 0.5 * (box.low.x + box.high.x);
        std::vector<double> ends;
        for (const size_t stroke : found_.branches) {
            const double a = lines_[stroke].front().x, b = lines_[stroke].back().x;
            ends.push_back(std::abs(a - middle) < std::abs(b - middle) ? a : b);
        }
        if (ends.empty()) return middle;
        std::sort(ends.begin(), ends.end());
        return std::clamp(ends[ends.size() / 2], box.low.x + 0.25 * box.size().x,
                          box.high.x - 0.25 * box.size().x);
    }

    // A flat line about the trunk's base.
    bool is_ground(size_t stroke) const {
        const FlatBox box = line_box(lines_[stroke]);
        return sketch_.strokes[stroke].role == StrokeRole::kAuto && box.size().x > 4.0 * box.size().y &&
               box.high.y < result_.drawn.trunk.points[0].y + 0.06 * (highest_ - lowest_) &&
               box.high.y < lowest_ + 0.1 * (highest_ - lowest_);
    }

    void read_branches() {
        std::vector<std::pair<size_t, size_t>> sides;  // stroke, the one that it grows from
        std::vector<size_t> of_trunk;
        for (const size_t stroke : found_.branches) {
            if (is_ground(stroke)) {
                leave_out(stroke, "This looks like the ground and not like a branch.");
                continue;
            }
            const size_t parent = side_parent(stroke);
            if (parent == lines_.size())
                of_trunk.push_back(stroke);
            else
                sides.emplace_back(stroke, parent);
        }
        std::vector<size_t> place(lines_.size(), lines_.size());  // in branches, by stroke
        for (const size_t stroke : of_trunk)
            if (read_branch(stroke, drawn().trunk, std::nullopt)) place[stroke] = drawn_from_[stroke];
        for (const auto& [stroke, parent] : sides) {
            if (place[parent] == lines_.size() && reading(parent).left_out) {
                read_branch(stroke, drawn().trunk, std::nullopt);
                continue;
            }
            if (place[parent] == lines_.size()) {
                leave_out(
                    stroke,
                    "This grows from a branch of a branch; only branches of the trunk may have branches.");
                continue;
            }
            const DrawnLine from = drawn().branches[place[parent]];
            read_branch(stroke, from, place[parent]);
        }
    }

    // The branch that a stroke grows from: one of its ends is at that one's side, and none is near the trunk.
    // The number of strokes: none, it is the trunk.
    size_t side_parent(size_t stroke) {
        const FlatLine& line = lines_[stroke];
        const FlatLine& trunk = drawn().trunk.points;
        if (found_.branches.size() > 200) return lines_.size();
        const double length = line_length(line);
        const double to_trunk = std::min(nearest_on_line(trunk, line.front()).distance,
                                         nearest_on_line(trunk, line.back()).distance);
        if (to_trunk < std::max(kNearBranch, options_.gap_share * length)) return lines_.size();
        size_t best = lines_.size();
        double least = std::min(kNearBranch, 0.35 * to_trunk);
        for (const size_t other : found_.branches) {
            if (other == stroke) continue;
            const std::vector<double> arcs = line_arcs(lines_[other]);
            for (const DVec2& end : {line.front(), line.back()}) {
                const LinePlace place = nearest_on_line(lines_[other], end);
                // An end at the other's end may as well be where that one grows from this one.
                const double arc = arc_of(place, arcs);
                if (arc < 0.08 * arcs.back() || arc > 0.92 * arcs.back()) continue;
                if (place.distance < least) {
                    least = place.distance;
                    best = other;
                }
            }
        }
        return best;
    }

    // Whether it was not left out.
    bool read_branch(size_t stroke, const DrawnLine& from, std::optional<size_t> parent) {
        FlatLine line = lines_[stroke];
        if (is_reversed(line, from.points)) {
            std::reverse(line.begin(), line.end());
            mark(stroke, StrokeRepair::kReversed);
        }
        const double length = line_length(line);
        const MendedBranch mended = mend_branch(line, from, options_);
        StrokeReading& told = reading(stroke);
        if (sketch_.strokes[stroke].role == StrokeRole::kAuto &&
            mended.bridged > std::max(1.5 * length, 2.0 * kNearBranch)) {
            told.repairs.clear();
            leave_out(stroke, "This is short and begins far from the trunk; draw it from the trunk on.");
            return false;
        }
        for (const StrokeRepair repair : mended.repairs) {
            // Turned twice, it was drawn from the trunk after all.
            const auto turned = std::find(told.repairs.begin(), told.repairs.end(), StrokeRepair::kReversed);
            if (repair == StrokeRepair::kReversed && turned != told.repairs.end())
                told.repairs.erase(turned);
            else
                told.repairs.push_back(repair);
        }
        told.attach =
            DVec2(mended.attach.point.x / scale_, sketch_.canvas.y - mended.attach.point.y / scale_);
        if (mended.bridged > std::max(60.0, 0.3 * length))
            told.fault = "This branch begins far from the trunk; it was joined to it.";
        std::vector<DrawnLine>& lines = parent ? drawn().side_branches : drawn().branches;
        std::vector<LinePlace>& places = parent ? side_places_ : branch_places_;
        drawn_from_.resize(lines_.size());
        drawn_from_[stroke] = lines.size();
        for (const FlatLine* part : {&mended.line, &mended.other_side}) {
            DrawnLine branch;
            branch.points = *part;
            branch.points.erase(std::unique(branch.points.begin(), branch.points.end()), branch.points.end());
            if (branch.points.size() < 2) continue;
            branch.stroke = stroke;
            branch.parent = parent;
            lines.push_back(std::move(branch));
            places.push_back(mended.attach);
        }
        if (!mended.other_side.empty())
            told.fault = "This goes right through the trunk; it became two branches.";
        return true;
    }

    void make_up_outline() {
        const FlatLine& trunk = drawn().trunk.points;
        const FlatBox box = line_box(trunk);
        const double height = std::max(1.0, highest_ - lowest_);
        FlatLine around;
        double base = box.high.y;
        for (const std::vector<DrawnLine>* lines : {&drawn().branches, &drawn().side_branches})
            for (const DrawnLine& branch : *lines) {
                around.insert(around.end(), branch.points.begin(), branch.points.end());
                base = std::min(base, branch.points[0].y);
            }
        if (around.empty()) {
            // A crown as broad as most are, around the trunk's upper part.
            const DVec2 top = trunk.back(), middle = top - 0.3 * (top - trunk.front());
            const double tall = glm::length(top - trunk.front());
            for (int i = 0; i < 48; i++) {
                const SineCosine turn = portable_sine_cosine(2.0 * kPi * i / 48.0);
                around.push_back(middle + tall * DVec2(0.26 * turn.cosine, 0.3 * turn.sine));
            }
        }
        for (const DVec2& p : trunk)
            if (p.y >= base) around.push_back(p);
        drawn().outline = outline_around(around, std::max(5.0, 0.05 * height));
        result_.remarks.emplace_back("No outline of the crown was drawn; one was made around the branches.");
    }

    // Branches and trunks that leave a drawn crown.
    void say_what_leaves() {
        if (!drawn().outline_stroke) return;
        for (const std::vector<DrawnLine>* lines : {&drawn().branches, &drawn().side_branches})
            for (const DrawnLine& branch : *lines)
                if (line_leaves(branch.points) && reading(branch.stroke).fault.empty())
                    reading(branch.stroke).fault = "This branch leaves the crown; it stays as it was drawn.";
        const DrawnLine& trunk = drawn().trunk;
        const DVec2 top = trunk.points.back();
        if (found_.trunks.empty() || !leaves(top)) return;
        if (top.y > line_box(drawn().outline).low.y && reading(trunk.stroke).fault.empty())
            reading(trunk.stroke).fault = "The trunk leaves the crown; it stays as it was drawn.";
    }

    // Whether it ends outside, or comes out on its way; where it begins may be below the crown.
    bool line_leaves(const FlatLine& line) {
        if (leaves(line.back())) return true;
        if (crossings(line, closed_outline()).size() < 2) return false;
        bool inside = false;
        for (const DVec2& p : line) {
            if (is_inside(drawn().outline, p))
                inside = true;
            else if (inside && leaves(p))
                return true;
        }
        return false;
    }

    bool leaves(const DVec2& p) {
        return !is_inside(drawn().outline, p) && nearest_on_line(closed_outline(), p).distance > kNoMargin;
    }

    const FlatLine& closed_outline() {
        if (closed_outline_.empty()) {
            closed_outline_ = drawn().outline;
            closed_outline_.push_back(closed_outline_[0]);
        }
        return closed_outline_;
    }

    // Gives the line `from` a point where branch k begins, and both the same one. The places hold for the
    // line before it got any: what comes later is counted on.
    void join(DrawnLine& branch, size_t k, DrawnLine& from, std::vector<LinePlace>& places) {
        LinePlace at = nearest_on_line(from.points, places[k].point);
        FlatLine& line = from.points;
        for (const size_t end : {at.segment, at.segment + 1})
            if (end < line.size() && glm::length(line[end] - at.point) < 1e-3) {
                set_base(branch, line[end]);
                return;
            }
        if (!from.radii.empty()) {
            const double a = from.radii[at.segment], b = from.radii[at.segment + 1];
            from.radii.insert(from.radii.begin() + static_cast<ptrdiff_t>(at.segment) + 1,
                              a + at.along * (b - a));
        }
        line.insert(line.begin() + static_cast<ptrdiff_t>(at.segment) + 1, at.point);
        set_base(branch, at.point);
    }

    static void set_base(DrawnLine& branch, const DVec2& base) {
        while (branch.points.size() > 2 && glm::length(branch.points[1] - base) < 1e-3)
            branch.points.erase(branch.points.begin() + 1);
        branch.points[0] = base;
    }

    const Sketch& sketch_;
    const RepairOptions& options_;
    const double scale_;  // from the sketch's canvas to ours
    std::vector<FlatLine> lines_;
    Recognised found_;
    UnderstoodSketch result_;
    FlatLine closed_outline_;
    FlatLine outline_line_;           // as drawn, where it is one line
    std::vector<size_t> drawn_from_;  // by stroke: its place in branches or side branches
    std::vector<LinePlace> branch_places_, side_places_;
    double lowest_ = 1e300, highest_ = -1e300;
};

}  // namespace

UnderstoodSketch understand_sketch(const Sketch& sketch, const RepairOptions& options) {
    check_sketch(sketch);
    return Understanding(sketch, options).run();
}

UnderstoodSketch understand_sketch(const Sketch& sketch) {
    return understand_sketch(sketch, RepairOptions());
}

}  // namespace treerec
