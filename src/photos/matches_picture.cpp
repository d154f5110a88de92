#include "photos/matches_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "error.h"
#include "exchange/material_textures.h"
#include "file_bytes.h"
#include "photos/colmap_work.h"
#include "photos/photo_folder.h"
#include "photos/photo_picture.h"

namespace treerec {

namespace {

constexpr int kMostPixels = 1000;  // of one photo's longer side in the picture
constexpr int kGap = 8;            // pixels between the photos
constexpr double kDim = 0.25;      // how much of a dropped match's line is seen

using Colour = std::array<uint8_t, 3>;

// Of the rainbow, 0 to 1.
Colour rainbow(double at) {
    Colour colour;
    for (size_t k = 0; k < 3; k++) {
        const double phase = 6.0 * at - 2.0 * static_cast<double>(k),
                     turn = phase - 6.0 * std::floor(phase / 6.0);
        colour[k] = static_cast<uint8_t>(255.0 * std::clamp(std::abs(turn - 3.0) - 1.0, 0.0, 1.0));
    }
    return colour;
}

class Canvas {
  public:
    explicit Canvas(Image& image) : image_(image) {}

    void paste(const GreyPicture& picture, int left, int top, double scale) {
        const int width = static_cast<int>(picture.width * scale),
                  height = static_cast<int>(picture.height * scale);
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) {
                const int u = std::min(static_cast<int>((x + 0.5) / scale), picture.width - 1);
                const int v = std::min(static_cast<int>((y + 0.5) / scale), picture.height - 1);
                for (int k = 0; k < 3; k++)
                    image_.at(left + x, top + y)[k] = picture.row(v)[u];
            }
    }
    void line(const DVec2& from, const DVec2& to, const Colour& colour, double share) {
        const int steps = std::max(
            1, static_cast<int>(std::ceil(std::max(std::abs(to.x - from.x), std::abs(to.y - from.y)))));
        for (int i = 0; i <= steps; i++) {
            const DVec2 p = from + (to - from) * (static_cast<double>(i) / steps);
            dot(static_cast<int>(p.x), static_cast<int>(p.y), colour, share);
        }
    }
    void mark(const DVec2& at, const Colour& colour) {
        for (int y = -1; y <= 1; y++)
            for (int x = -1; x <= 1; x++)
                dot(static_cast<int>(at.x) + x, static_cast<int>(at.y) + y, colour, 1.0);
    }

  private:
    void dot(int x, int y, const Colour& colour, double share) {
        if (x < 0 || y < 0 || x >= image_.width || y >= image_.height) return;
        for (size_t k = 0; k < 3; k++) {
            uint8_t& value = image_.at(x, y)[k];
            value = static_cast<uint8_t>((1.0 - share) * value + share * colour[k]);
        }
    }

    Image& image_;
};

}  // namespace

Image draw_matches(const PhotoFeatures& one, const PhotoFeatures& other, const PairMatches& plain,
                   const PairMatches& improved) {
    const GreyPicture &left = one.pyramid.levels[0], &right = other.pyramid.levels[0];
    const int longest = std::max({left.width, left.height, right.width, right.height});
    const double scale = std::min(1.0, static_cast<double>(kMostPixels) / longest);
    const auto scaled = [&](int side) { return std::max(1, static_cast<int>(side * scale)); };
    const int height = std::max(scaled(left.height), scaled(right.height));
    const int beside = scaled(left.width) + kGap;
    Image image(beside + scaled(right.width), 2 * height + kGap, 3);
    std::fill(image.pixels.begin(), image.pixels.end(), uint8_t{255});
    Canvas canvas(image);
    for (const PairMatches* found : {&plain, &improved}) {
        const int top = found == &plain ? 0 : height + kGap;
        canvas.paste(left, 0, top, scale);
        canvas.paste(right, beside, top, scale);
        for (const bool kept : {false, true})
            for (const PointMatch& match : found->matches) {
                if (match.kept != kept) continue;
                const DVec2 place = one.corners[match.corner].place;
                const DVec2 from = scale * place + DVec2(0.0, top),
                            to = scale * match.place + DVec2(beside, top);
                const Colour colour = rainbow(place.y / left.height);
                canvas.line(from, to, colour, kept ? 0.8 : kDim);
                if (!kept) continue;
                canvas.mark(from, colour);
                canvas.mark(to, colour);
            }
    }
    return image;
}

ShownMatches show_matches(const std::string& folder, const std::string& out, const std::string& names,
                          PhotoEffort effort, const Progress* progress) {
    const PhotoFolder photos = list_photos(folder);
    // Names may have commas themselves.
    const PhotoFile *first = nullptr, *second = nullptr;
    for (const PhotoFile& one : photos.photos)
        for (const PhotoFile& other : photos.photos)
            if (names == one.name + "," + other.name) {
                first = &one;
                second = &other;
            }
    if (!first)
        throw Error("There are no two photos " + quote_word(names) + " in '" + folder +
                    "'; name two of them with a comma between: A.jpg,B.jpg.");
    FeatureOptions options;
    options.most_pixels = effort_of(effort).pixels;
    options.harris.most = static_cast<size_t>(effort_of(effort).features);
    const auto features = [&](const PhotoFile& photo) {
        if (progress) progress->check();
        return features_of(read_photo(utf8_of(path_of(photos.path) / path_of(photo.name))), options);
    };
    const PhotoFeatures one = features(*first), other = features(*second);
    const PairMatches plain = match_pair_plain(one, other), improved = match_pair(one, other, {}, progress);
    ShownMatches shown;
    shown.plain = plain.matches.size();
    shown.improved = improved.kept();
    shown.dropped = improved.matches.size() - shown.improved;
    make_folder(out);
    shown.path = utf8_of(path_of(out) /
                         path_of("matches_" + stem_of(first->name) + "_" + stem_of(second->name) + ".png"));
    write_png(shown.path, draw_matches(one, other, plain, improved));
    return shown;
}

}  // namespace treerec
