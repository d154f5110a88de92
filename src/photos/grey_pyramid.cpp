#include "photos/grey_pyramid.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace treerec {

namespace {

constexpr int kMostLevels = 5;
constexpr int kLeastSide = 24;  // pixels

// Which pixels of a row one of a shorter row covers, and how much of the first and last.
struct Cover {
    int first = 0, last = 0;
    float first_share = 1.0F, last_share = 1.0F;
};

std::vector<Cover> covers_of(int from, int to) {
    std::vector<Cover> covers(static_cast<size_t>(to));
    const double step = static_cast<double>(from) / to;
    for (int i = 0; i < to; i++) {
        const double low = i * step, high = (i + 1) * step;
        Cover& cover = covers[static_cast<size_t>(i)];
        cover.first = std::clamp(static_cast<int>(low), 0, from - 1);
        cover.last = std::clamp(static_cast<int>(std::ceil(high)) - 1, cover.first, from - 1);
        cover.first_share = static_cast<float>(std::min(high, cover.first + 1.0) - low);
        cover.last_share = cover.last > cover.first ? static_cast<float>(high - cover.last) : 0.0F;
    }
    return covers;
}

template <typename Value>
float sum_of(const Cover& cover, const Value& value) {
    float sum = cover.first_share * value(cover.first);
    if (cover.last > cover.first) sum += cover.last_share * value(cover.last);
    for (int i = cover.first + 1; i < cover.last; i++)
        sum += value(i);
    return sum;
}

GreyPicture half_of(const GreyPicture& picture) {
    const GreyPicture smooth = smoothed(picture);
    GreyPicture half((picture.width + 1) / 2, (picture.height + 1) / 2);
    for (int y = 0; y < half.height; y++)
        for (int x = 0; x < half.width; x++)
            half.row(y)[x] = smooth.row(2 * y)[2 * x];
    return half;
}

}  // namespace

GreyPicture grey_of(const Image& picture, int most_pixels) {
    const int longer = std::max(picture.width, picture.height);
    const auto shrunk = [&](int side) {
        return longer <= most_pixels
                   ? side
                   : std::max(
                         1, static_cast<int>(std::lround(static_cast<double>(side) * most_pixels / longer)));
    };
    GreyPicture grey(shrunk(picture.width), shrunk(picture.height));
    const std::vector<Cover> across = covers_of(picture.width, grey.width),
                             down = covers_of(picture.height, grey.height);
    const float area = static_cast<float>(picture.width) / static_cast<float>(grey.width) *
                       (static_cast<float>(picture.height) / static_cast<float>(grey.height));
    const int channels = picture.channels;
    const auto luma = [&](int x, int y) {
        const uint8_t* p = picture.at(x, y);
        return channels < 3 ? static_cast<float>(p[0])
                            : 0.299F * static_cast<float>(p[0]) + 0.587F * static_cast<float>(p[1]) +
                                  0.114F * static_cast<float>(p[2]);
    };
    for (int y = 0; y < grey.height; y++)
        for (int x = 0; x < grey.width; x++) {
            const float sum = sum_of(down[static_cast<size_t>(y)], [&](int v) {
                return sum_of(across[static_cast<size_t>(x)], [&](int u) { return luma(u, v); });
            });
            grey.row(y)[x] = static_cast<uint8_t>(std::clamp(sum / area + 0.5F, 0.0F, 255.0F));
        }
    return grey;
}

GreyPicture smoothed(const GreyPicture& picture) {
    const int width = picture.width, height = picture.height;
    GreyPicture smooth(width, height);
    std::vector<int> rows(static_cast<size_t>(width) + 4);
    const auto inside = [&](int y) { return picture.row(std::clamp(y, 0, height - 1)); };
    for (int y = 0; y < height; y++) {
        const uint8_t *a = inside(y - 2), *b = inside(y - 1), *c = inside(y), *d = inside(y + 1),
                      *e = inside(y + 2);
        int* middle = rows.data() + 2;
        for (int x = 0; x < width; x++)
            middle[x] = a[x] + e[x] + 4 * (b[x] + d[x]) + 6 * c[x];
        middle[-1] = middle[-2] = middle[0];
        middle[width] = middle[width + 1] = middle[width - 1];
        uint8_t* out = smooth.row(y);
        for (int x = 0; x < width; x++)
            out[x] = static_cast<uint8_t>(
                (middle[x - 2] + middle[x + 2] + 4 * (middle[x - 1] + middle[x + 1]) + 6 * middle[x] + 128) >>
                8);
    }
    return smooth;
}

GreyPyramid pyramid_of(const Image& picture, int most_pixels) {
    GreyPyramid pyramid;
    pyramid.levels.push_back(grey_of(picture, most_pixels));
    const GreyPicture& whole = pyramid.levels[0];
    pyramid.to_photo = {static_cast<double>(picture.width) / whole.width,
                        static_cast<double>(picture.height) / whole.height};
    while (static_cast<int>(pyramid.levels.size()) < kMostLevels &&
           std::min(pyramid.levels.back().width, pyramid.levels.back().height) >= 2 * kLeastSide)
        pyramid.levels.push_back(half_of(pyramid.levels.back()));
    return pyramid;
}

}  // namespace treerec
