// What one draws: strokes on a canvas (Ma and Liu 2020, chapter 2).
//
// The canvas has pixels, x to the right and y down, as pictures have; one that is kCanvasHeight high has the
// pixels of the paper's thresholds, and every other is scaled to it before anything is measured.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geometry/vec.h"

namespace treerec {

struct TwigStock;

inline constexpr double kCanvasHeight = 1000.0;  // pixels
// What one drawing may have: bounds what a hostile file makes us do.
inline constexpr size_t kMostStrokes = 1000;
inline constexpr size_t kMostStrokePoints = 200000;  // of all strokes together

enum class StrokeRole : uint8_t {
    kAuto,     // recognised: the outline holds the highest point, the trunk the lowest, the rest are branches
    kOutline,  // of the crown
    kTrunk,    // two such strokes are its two sides
    kBranch,   // of the first order: it grows from the trunk
};
// "auto", "outline", "trunk", "branch".
const char* stroke_role_name(StrokeRole role);
// Throws Error for another name, listing these.
StrokeRole parse_stroke_role(const std::string& name);

struct Stroke {
    std::vector<DVec2> points;            // pixels of the canvas, as drawn; at least one
    std::vector<float> pressure;          // of a pen, 0..1 for each point; empty: none was told
    StrokeRole role = StrokeRole::kAuto;  // what the user says that it is
    // What is drawn by chance for a stroke hangs on this, so that another stroke before it changes nothing.
    // Distinct and above 0 within a sketch; 0: not given out yet (Sketch::number_strokes()).
    uint32_t id = 0;
};

// What belongs to the drawing itself: it is saved with it.
struct Sketch {
    DVec2 canvas{kCanvasHeight, kCanvasHeight};  // pixels, both above 0
    std::vector<Stroke> strokes;
    double height = 0.0;  // metres of the tree, from the trunk's base to the top; 0: the species' usual
    std::string species;  // sketch_species(); empty: maple
    // Twigs of one's own in place of the species', of which only leaves and bark are left, by any leaf
    // preset.
    std::shared_ptr<const TwigStock> twigs;
    uint64_t seed = 1;

    // Gives each stroke that has none an id that no other has; later of equal ones get a new one.
    void number_strokes();
};

// Throws Error, with a sentence, where a canvas or a point is not finite or absurdly large, a stroke has no
// point or pressures that are not its points', there are too many of either, or the height is not within
// 0 and 200 m.
void check_sketch(const Sketch& sketch);

// What was mended in a stroke (Ma and Liu 2020, 2.2 and figures 4 and 5), in the order in which it was.
enum class StrokeRepair : uint8_t {
    kReversed,  // it was drawn towards the trunk, or a trunk from its top down
    kClosed,    // an open outline, by its chord
    kUnited,    // outlines that cross
    kGap,       // it ended before the trunk
    kCrossing,  // it went through the trunk
    kHook,      // a hook or a loop at its tail
    kTwoSides,  // a trunk drawn with two lines
};
const char* stroke_repair_name(StrokeRepair repair);  // "reversed", "closed", "united", "gap", ...

// What became of one stroke.
struct StrokeReading {
    StrokeRole role = StrokeRole::kAuto;  // kAuto only where it was not understood
    std::vector<StrokeRepair> repairs;
    std::optional<DVec2> attach;  // where a branch meets the trunk, pixels of the sketch's own canvas
    // A sentence where it could not be understood and was left out, or is used but was not what one expects
    // (`left_out` says which); empty: all is well.
    std::string fault;
    bool left_out = false;
};

// A line along wood, from its tail (towards the trunk, or the ground) to its tip.
struct DrawnLine {
    std::vector<DVec2> points;  // at least two, none equal to the one before
    std::vector<double> radii;  // of the wood, at each point; empty: not drawn
    size_t stroke = 0;          // place in Sketch::strokes; of a trunk of two lines the first
    // Place in DrawnTree::branches of the one that it grows from (side branches alone have it).
    std::optional<size_t> parent;
};

// A sketch that has been understood and mended, still flat: pixels of a canvas that is kCanvasHeight high, x
// to the right, y UP from the bottom edge.
struct DrawnTree {
    // A simple polygon, counter-clockwise, its last point not its first again. Where no outline was drawn
    // (outline_stroke is nothing), one around what was.
    std::vector<DVec2> outline;
    std::optional<size_t> outline_stroke;
    DrawnLine trunk;  // from the ground up
    // points[0] is a point of the trunk's line; in the order of the strokes. A stroke right through the trunk
    // is two of them.
    std::vector<DrawnLine> branches;
    // Of the second order: points[0] is a point of the line of branches[*parent].
    std::vector<DrawnLine> side_branches;
};

struct UnderstoodSketch {
    DrawnTree drawn;
    std::vector<StrokeReading> strokes;  // as many as the sketch has
    std::vector<std::string> remarks;    // about the whole, such as that no outline was drawn
};

// Cleans, recognises and repairs (Ma and Liu 2020, 2.1 and 2.2). A stroke that makes no sense gets a fault
// and is left out; what can be guessed is. Throws Error, with a sentence that a user understands, where no
// tree can be made of it at all: nothing is drawn, or check_sketch() refuses it.
UnderstoodSketch understand_sketch(const Sketch& sketch);

}  // namespace treerec
