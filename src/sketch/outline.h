// A crown's outline out of what was drawn: closed, united, simple.
#pragma once

#include <vector>

#include "sketch/flat_line.h"

namespace treerec {

struct MadeOutline {
    FlatLine polygon;     // simple, counter-clockwise; empty: what was drawn encloses nothing
    double chord = 0.0;   // pixels between the ends of the first line, before it was closed
    bool united = false;  // there were several, or it crossed itself
    bool hull = false;    // it encloses too little of what it goes around (hatching): its convex hull
};

// Whether no two sides cross or touch but neighbours at their common point.
bool is_simple(const FlatLine& polygon);

// Each line is closed by its chord. One that only runs past its own beginning is cut where it crosses itself.
// If the polygon is simple then, it is exact; otherwise the union of all that the lines wind around, with its
// holes filled, is drawn into a raster of 600 by 600 cells at most, none smaller than 2 pixels, and the
// border of its largest part is followed, which is off by less than a cell.
MadeOutline make_outline(const std::vector<FlatLine>& lines);

// Open lines whose ends lie together become one, such as a left and a right half.
std::vector<FlatLine> join_arcs(std::vector<FlatLine> lines);

// Where none was drawn: around the points, `margin` pixels farther out than their convex hull. At least one
// point; margin > 0.
FlatLine outline_around(const FlatLine& points, double margin);

}  // namespace treerec
