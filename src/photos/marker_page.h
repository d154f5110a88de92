// A page with a marker to print.
#pragma once

#include <string>

#include "mesh/image.h"

namespace treerec {

inline constexpr double kUsualMarkerSide = 0.15;  // metres: with a white cell all around it on A4
inline constexpr double kLeastMarkerSide = 0.02;
inline constexpr double kMostMarkerSide = 0.6;
inline constexpr int kMarkerPageDpi = 300;
inline constexpr double kMarkerLetters = 4.0;  // millimetres: how high the caption's letters are

// An upright page of ISO 216, with the marker in the middle and its size below it. It is A4 as far as that
// leaves 5 mm of white at the sides, as what printers can't print on; larger markers get the smallest page
// that has a cell of white around them.
struct MarkerPage {
    int id = 0;
    double side = kUsualMarkerSide;  // metres: of the black square
    int paper = 4;                   // of A4
    double width = 0.0;              // millimetres
    double height = 0.0;
    double left = 0.0;  // of the marker, from the page's corner
    double top = 0.0;
    double caption = 0.0;  // the base line of what stands below
};

// Throws Error for an id or a side that there is none of.
MarkerPage marker_page(int id, double side);

// "ArUco DICT_4X4_50, id 7. Side of the black square: 150 mm. Print at 100 %."
std::string marker_caption(const MarkerPage& page);

// An SVG in millimetres.
std::string marker_svg(const MarkerPage& page);

// Of a length on the page, in millimetres, at 300 dpi.
int marker_pixels(double millimetres);

// The page at 300 dpi, grey and without its caption, each of the marker's edges on the nearest pixel.
Image marker_picture(const MarkerPage& page);

}  // namespace treerec
