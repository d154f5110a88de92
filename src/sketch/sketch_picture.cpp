#include "sketch/sketch_picture.h"

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>
#include <utility>

#include "error.h"
#include "photos/exif.h"
#include "photos/photo_picture.h"
#include "sketch/line_mask.h"
#include "sketch/sketch_fault.h"
#include "sketch/trace_lines.h"

namespace treerec {

namespace {

constexpr double kMostPixels = 100e6;
constexpr int kLargeEnough = 2000;     // pixels: a larger picture is read at a half, a third, ..
constexpr double kThickestLine = 0.2;  // of the picture's height
constexpr double kSpacing = 4.0;       // pixels between points, of a canvas that is kCanvasHeight high

// Upright, as a viewer shows it: Exif 2.32, 4.6.4, tag 274.
Image upright(Image picture, int orientation) {
    if (orientation <= 1) return picture;
    const bool swapped = orientation >= 5;
    Image turned(swapped ? picture.height : picture.width, swapped ? picture.width : picture.height,
                 picture.channels);
    const int right = picture.width - 1, bottom = picture.height - 1;
    for (int y = 0; y < turned.height; y++)
        for (int x = 0; x < turned.width; x++) {
            const int u = swapped ? y : x, v = swapped ? x : y;
            const bool from_right =
                orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
            const bool from_bottom =
                orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
            std::copy_n(picture.at(from_right ? right - u : u, from_bottom ? bottom - v : v),
                        picture.channels, turned.at(x, y));
        }
    return turned;
}

Image decoded(std::string_view bytes, const std::string& who) {
    const std::optional<std::array<int, 2>> size = picture_size(bytes);
    if (size && static_cast<double>((*size)[0]) * (*size)[1] > kMostPixels)
        throw Error(who + " has " + std::to_string((*size)[0]) + " x " + std::to_string((*size)[1]) +
                    " pixels; save it with at most 100 million, 2000 a side are plenty.");
    std::optional<Image> picture = size ? decode_picture(bytes, 4) : std::nullopt;
    if (!picture || picture->pixels.empty())
        throw Error(who +
                    " is a picture that is damaged, or of a kind that can't be read here; save it as PNG.");
    std::istringstream stream{std::string(bytes.substr(0, size_t{1} << 18U))};
    return upright(std::move(*picture), read_photo_orientation(stream));
}

}  // namespace

Sketch parse_sketch_picture(std::string_view bytes, const std::string& who) {
    return sketch_of_picture(decoded(bytes, who), who);
}

Sketch sketch_of_picture(const Image& picture, const std::string& who) {
    const int times = std::max(1, std::max(picture.width, picture.height) / kLargeEnough);
    const Image small = reduced(picture, times);
    LineMask mask = ink_of(small, who);
    const double width = line_width(mask, depths_of(mask));
    clean_mask(mask, width);
    const std::vector<float> depths = depths_of(mask);
    if (2.0 * static_cast<double>(*std::max_element(depths.begin(), depths.end())) >
        kThickestLine * small.height)
        throw Error(who +
                    " has filled areas; draw the crown's outline, the trunk and the branches as lines.");
    thin_mask(mask);
    Sketch sketch;
    sketch.canvas = DVec2(picture.width, picture.height);
    const double spacing = std::max(1.0, kSpacing * small.height / kCanvasHeight);
    for (TracedLine& line : trace_lines(mask, depths, spacing, speck_size(mask, width), who)) {
        Stroke stroke;
        stroke.points = std::move(line.points);
        for (DVec2& p : stroke.points)
            p *= times;
        sketch.strokes.push_back(std::move(stroke));
    }
    if (sketch.strokes.empty()) throw Error(who + " shows no lines, only specks.");
    if (sketch.strokes.size() > kMostStrokes)
        throw Error(who + " shows " + std::to_string(sketch.strokes.size()) +
                    " lines; a tree is drawn with a few. Draw a few dark lines on light paper.");
    const std::string fault = sketch_fault(sketch);
    if (!fault.empty()) throw Error(who + fault);
    sketch.number_strokes();
    return sketch;
}

}  // namespace treerec
