#include "photos/marker_page.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "error.h"
#include "photos/marker_code.h"

namespace treerec {

namespace {

constexpr double kInch = 25.4;    // millimetres
constexpr double kMargin = 5.0;   // millimetres that printers leave white
constexpr double kLetters = 4.0;  // millimetres: how high the caption's letters are
constexpr double kBelow = 12.0;   // millimetres from the marker to the caption
constexpr struct {
    int paper;
    double width, height;
} kPapers[] = {{4, 210, 297}, {3, 297, 420}, {2, 420, 594}, {1, 594, 841}, {0, 841, 1189}};

// Letters of 5 by 7 dots, a row in the lower five bits, for what the caption has in capitals.
struct Letter {
    char letter;
    uint8_t rows[7];
};
constexpr Letter kDots[] = {{'0', {14, 17, 19, 21, 25, 17, 14}}, {'1', {4, 12, 4, 4, 4, 4, 14}},
                            {'2', {14, 17, 1, 2, 4, 8, 31}},     {'3', {31, 2, 4, 2, 1, 17, 14}},
                            {'4', {2, 6, 10, 18, 31, 2, 2}},     {'5', {31, 16, 30, 1, 1, 17, 14}},
                            {'6', {6, 8, 16, 30, 17, 17, 14}},   {'7', {31, 1, 2, 4, 8, 8, 8}},
                            {'8', {14, 17, 17, 14, 17, 17, 14}}, {'9', {14, 17, 17, 15, 1, 2, 12}},
                            {'A', {14, 17, 17, 31, 17, 17, 17}}, {'B', {30, 17, 17, 30, 17, 17, 30}},
                            {'C', {14, 17, 16, 16, 16, 17, 14}}, {'D', {30, 17, 17, 17, 17, 17, 30}},
                            {'E', {31, 16, 16, 30, 16, 16, 31}}, {'F', {31, 16, 16, 30, 16, 16, 16}},
                            {'H', {17, 17, 17, 31, 17, 17, 17}}, {'I', {14, 4, 4, 4, 4, 4, 14}},
                            {'K', {17, 18, 20, 24, 20, 18, 17}}, {'L', {16, 16, 16, 16, 16, 16, 31}},
                            {'M', {17, 27, 21, 21, 17, 17, 17}}, {'N', {17, 25, 21, 19, 17, 17, 17}},
                            {'O', {14, 17, 17, 17, 17, 17, 14}}, {'P', {30, 17, 17, 30, 16, 16, 16}},
                            {'Q', {14, 17, 17, 17, 21, 18, 13}}, {'R', {30, 17, 17, 30, 20, 18, 17}},
                            {'S', {15, 16, 16, 14, 1, 1, 30}},   {'T', {31, 4, 4, 4, 4, 4, 4}},
                            {'U', {17, 17, 17, 17, 17, 17, 14}}, {'X', {17, 17, 10, 4, 10, 17, 17}},
                            {'_', {0, 0, 0, 0, 0, 0, 31}},       {'.', {0, 0, 0, 0, 0, 12, 12}},
                            {',', {0, 0, 0, 0, 12, 4, 8}},       {':', {0, 12, 12, 0, 12, 12, 0}},
                            {'%', {24, 25, 2, 4, 8, 19, 3}}};

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

// Of dots that are so many pixels wide, in the middle of the page.
void write_dots(Image& picture, const std::string& text, int dot, int base) {
    int x = picture.width / 2 - static_cast<int>(text.size()) * 6 * dot / 2;
    for (const char letter : text) {
        const char capital = letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
        for (const Letter& dots : kDots) {
            if (dots.letter != capital) continue;
            for (int v = 0; v < 7; v++)
                for (int u = 0; u < 5; u++)
                    if (dots.rows[v] >> (4 - u) & 1)
                        fill(picture, x + u * dot, base + (v - 7) * dot, x + (u + 1) * dot,
                             base + (v - 6) * dot);
        }
        x += 6 * dot;
    }
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
    page.top = 0.5 * (page.height - length) - kLetters;
    page.caption = page.top + length + std::max(kBelow, length / kMarkerCells) + kLetters;
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
           "\" font-family=\"sans-serif\" font-size=\"" + number(kLetters) + "\" text-anchor=\"middle\">" +
           marker_caption(page) + "</text>\n</svg>\n";
    return svg;
}

Image marker_picture(const MarkerPage& page) {
    const auto pixel = [](double millimetres) {
        return static_cast<int>(std::lround(millimetres / kInch * kMarkerPageDpi));
    };
    Image picture(pixel(page.width), pixel(page.height), 1);
    std::fill(picture.pixels.begin(), picture.pixels.end(), uint8_t{255});
    const double cell = 1000.0 * page.side / kMarkerCells;
    for (int y = 0; y < kMarkerCells; y++)
        for (int x = 0; x < kMarkerCells; x++)
            if (!is_white_cell(page.id, x, y))
                fill(picture, pixel(page.left + x * cell), pixel(page.top + y * cell),
                     pixel(page.left + (x + 1) * cell), pixel(page.top + (y + 1) * cell));
    const std::string caption = marker_caption(page);
    const int room = picture.width * 9 / 10 / (6 * static_cast<int>(caption.size()));
    write_dots(picture, caption, std::clamp(pixel(kLetters / 7.0), 1, std::max(1, room)),
               pixel(page.caption));
    return picture;
}

}  // namespace treerec
