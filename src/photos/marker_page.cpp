#include "photos/marker_page.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "error.h"
#include "photos/marker_code.h"

namespace treerec {

namespace {

constexpr double kInch = 25.4;   // millimetres
constexpr double kMargin = 5.0;  // millimetres that printers leave white
constexpr double kBelow = 12.0;  // millimetres from the marker to the caption
constexpr struct {
    int paper;
    double width, height;
} kPapers[] = {{4, 210, 297}, {3, 297, 420}, {2, 420, 594}, {1, 594, 841}, {0, 841, 1189}};

std::string number(double value) {
    char text[32];
    const double rounded = std::round(1e4 * value) / 1e4;
    return {text, std::to_chars(text, text + sizeof text, rounded).ptr};
}

void fill(Image& picture, int left, int top, int right, int bottom) {
    for (int y = std::max(0, top); y < std::min(bottom, picture.height); y++)
        for (int x = std::max(0, left); x < std::min(right, picture.width); x++)
            *picture.at(x, y) = 0;
}

}  // namespace

MarkerPage marker_page(int id, double side) {
    if (id < 0 || id >= kMarkerCount)
        throw Error("A marker's id is 0 to " + std::to_string(kMarkerCount - 1) + ", not " +
                    std::to_string(id) + ".");
    if (!(side >= kLeastMarkerSide && side <= kMostMarkerSide))
        throw Error("A marker's side is from " + number(1000.0 * kLeastMarkerSide) + " to " +
                    number(1000.0 * kMostMarkerSide) + " mm.");
    MarkerPage page;
    page.id = id;
    page.side = side;
    const double length = 1000.0 * side;
    for (const auto& paper : kPapers) {
        const double white = paper.paper == 4 ? kMargin : length / kMarkerCells;
        page.paper = paper.paper;
        page.width = paper.width;
        page.height = paper.height;
        if (length + 2.0 * white <= paper.width + 1e-9) break;
    }
    page.left = 0.5 * (page.width - length);
    page.top = 0.5 * (page.height - length) - kMarkerLetters;
    page.caption = page.top + length + std::max(kBelow, length / kMarkerCells) + kMarkerLetters;
    return page;
}

std::string marker_caption(const MarkerPage& page) {
    return "ArUco DICT_4X4_50, id " + std::to_string(page.id) +
           ". Side of the black square: " + number(1000.0 * page.side) + " mm. Print at 100 %.";
}

std::string marker_svg(const MarkerPage& page) {
    const std::string width = number(page.width), height = number(page.height);
    const double length = 1000.0 * page.side, cell = length / kMarkerCells;
    std::string svg =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
        "width=\"" +
        width + "mm\" height=\"" + height + "mm\" viewBox=\"0 0 " + width + " " + height +
        "\">\n<rect width=\"" + width + "\" height=\"" + height + "\" fill=\"#fff\"/>\n";
    // One outline with holes: between rectangles that touch, a viewer may draw hairs.
    svg += "<path fill=\"#000\" fill-rule=\"evenodd\" d=\"M" + number(page.left) + " " + number(page.top) +
           "h" + number(length) + "v" + number(length) + "h" + number(-length) + "z";
    for (int y = 1; y <= kMarkerBits; y++)
        for (int x = 1; x <= kMarkerBits; x++) {
            if (!is_white_cell(page.id, x, y)) continue;
            svg += "M" + number(page.left + x * cell) + " " + number(page.top + y * cell) + "h" +
                   number(cell) + "v" + number(cell) + "h" + number(-cell) + "z";
        }
    svg += "\"/>\n<text x=\"" + number(0.5 * page.width) + "\" y=\"" + number(page.caption) +
           "\" font-family=\"sans-serif\" font-size=\"" + number(kMarkerLetters) +
           "\" text-anchor=\"middle\">" + marker_caption(page) + "</text>\n</svg>\n";
    return svg;
}

int marker_pixels(double millimetres) {
    return static_cast<int>(std::lround(millimetres / kInch * kMarkerPageDpi));
}

Image marker_picture(const MarkerPage& page) {
    const auto pixel = marker_pixels;
    Image picture(pixel(page.width), pixel(page.height), 1);
    std::fill(picture.pixels.begin(), picture.pixels.end(), uint8_t{255});
    const double cell = 1000.0 * page.side / kMarkerCells;
    for (int y = 0; y < kMarkerCells; y++)
        for (int x = 0; x < kMarkerCells; x++)
            if (!is_white_cell(page.id, x, y))
                fill(picture, pixel(page.left + x * cell), pixel(page.top + y * cell),
                     pixel(page.left + (x + 1) * cell), pixel(page.top + (y + 1) * cell));
    return picture;
}

}  // namespace treerec
