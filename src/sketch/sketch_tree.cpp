#include <algorithm>
#include <cmath>
#include <optional>

#include "error.h"
#include "sketch/assemble.h"
#include "sketch/crown_leaves.h"
#include "sketch/fill.h"
#include "sketch/lift.h"
#include "sketch/sketch.h"
#include "sketch/species.h"
#include "sketch/twig_stock.h"
#include "sketch/unseen.h"

namespace treerec {

namespace {

constexpr double kThickest = 0.2;  // of a tree's height: a trunk's radius at the base
constexpr double kMostDensity = 4.0;

void check_options(const SketchOptions& options, double height) {
    if (!(options.density >= 0.0 && options.density <= kMostDensity))
        throw Error("The density of twigs must be from 0 to 4.");
    if (!(options.trunk_radius >= 0.0 && options.trunk_radius <= kThickest * height))
        throw Error("The trunk's radius must be from 0 to a fifth of the tree's height.");
}

double highest_of(const DrawnTree& drawn) {
    double top = drawn.trunk.points[0].y;
    for (const DVec2& p : drawn.outline)
        top = std::max(top, p.y);
    for (const DVec2& p : drawn.trunk.points)
        top = std::max(top, p.y);
    for (const DrawnLine& branch : drawn.branches)
        for (const DVec2& p : branch.points)
            top = std::max(top, p.y);
    return top;
}

}  // namespace

SketchedTree sketch_tree(const Sketch& given, const SketchOptions& options, const Progress* progress) {
    Sketch sketch = given;
    sketch.number_strokes();
    const std::string named = sketch.species.empty() ? "maple" : sketch.species;
    SketchSpecies species = sketch.twigs ? species_of(*sketch.twigs, named) : sketch_species(named);
    if (options.leaves) species.leaves = *options.leaves;
    const double height = sketch.height > 0.0 ? sketch.height : species.height;
    check_options(options, height);
    SketchedTree out;
    out.understood = understand_sketch(sketch);
    out.remarks = out.understood.remarks;
    out.species = species.name;
    const DrawnTree& drawn = out.understood.drawn;

    const DVec2 stem_base = drawn.trunk.points[0];
    const double pixels = highest_of(drawn) - stem_base.y;
    if (!(pixels > 1.0))
        throw Error("Nothing is drawn above the trunk's base; draw the tree from the ground up.");
    const CanvasPlace place{stem_base, height / pixels};
    const double shown = sketch.canvas.y / kCanvasHeight;
    out.stem_base = DVec2(stem_base.x, kCanvasHeight - stem_base.y) * shown;
    out.scale = place.scale / shown;

    std::vector<DVec2> outline;
    for (const DVec2& p : drawn.outline)
        outline.push_back(place.metres(p));
    const bool printed = options.depth == SketchDepth::kPaper;
    const CrownSections crown(outline, printed);
    out.crown_base = crown.bottom();
    std::optional<WoodTaper> taper;
    if (species.taper) taper = species.taper->at_height(height);
    SketchAxes axes = lift(drawn, sketch, place, crown, options, taper, out.remarks);
    if (!printed) {
        extend_trunk(axes, crown, sketch.seed);
        add_unseen_branches(axes, crown, sketch.seed);
    }
    if (progress) progress->check();
    const Filling filling =
        fill_crown(axes, crown, species, height, place.scale, sketch.seed, options, progress);
    // As printed, twigs keep their lengths, which are those of grown trees.
    if (printed && filling.bare > filling.twigs.size())
        out.remarks.push_back(
            "At " + std::to_string(filling.bare) + " of " +
            std::to_string(filling.bare + filling.twigs.size()) +
            " places the species' twigs are too long for the crown: make the tree taller, or "
            "take the true depth.");
    std::optional<double> margin;
    if (!printed) margin = leaf_margin(crown, species.leaves, height);
    AssembledTree assembled = assemble_tree(filling, species, crown, margin, progress);
    out.tree = std::move(assembled.tree);
    out.stroke_of_node = std::move(assembled.stroke_of_node);
    if (!printed) fill_with_leaves(out.tree);
    return out;
}

}  // namespace treerec
