#include "photos/harris.h"

#include <algorithm>
#include <cmath>

namespace treerec {

namespace {

constexpr int kParts = 8;  // along the longer side

class Field {
  public:
    Field(int width, int height)
        : width_(width), values_(static_cast<size_t>(width) * static_cast<size_t>(height), 0.0F) {}
    float* row(int y) { return values_.data() + static_cast<size_t>(y) * static_cast<size_t>(width_); }
    const float* row(int y) const {
        return values_.data() + static_cast<size_t>(y) * static_cast<size_t>(width_);
    }

  private:
    int width_;
    std::vector<float> values_;
};

// Two steps of the binomial 1 4 6 4 1: a Gaussian of 1.4 pixels. The borders are left as they are.
void smooth_field(Field& field, int width, int height) {
    Field across(width, height);
    for (int step = 0; step < 2; step++) {
        for (int y = 0; y < height; y++) {
            const float* in = field.row(y);
            float* out = across.row(y);
            for (int x = 2; x < width - 2; x++)
                out[x] = (in[x - 2] + in[x + 2] + 4.0F * (in[x - 1] + in[x + 1]) + 6.0F * in[x]) / 16.0F;
        }
        for (int y = 2; y < height - 2; y++) {
            const float *a = across.row(y - 2), *b = across.row(y - 1), *c = across.row(y),
                        *d = across.row(y + 1), *e = across.row(y + 2);
            float* out = field.row(y);
            for (int x = 2; x < width - 2; x++)
                out[x] = (a[x] + e[x] + 4.0F * (b[x] + d[x]) + 6.0F * c[x]) / 16.0F;
        }
    }
}

Field response_of(const GreyPicture& picture, double k) {
    const int width = picture.width, height = picture.height;
    Field xx(width, height), yy(width, height), xy(width, height);
    const GreyPicture smooth = smoothed(picture);
    for (int y = 1; y < height - 1; y++) {
        const uint8_t *up = smooth.row(y - 1), *here = smooth.row(y), *down = smooth.row(y + 1);
        float *a = xx.row(y), *b = yy.row(y), *c = xy.row(y);
        for (int x = 1; x < width - 1; x++) {
            // Scharr's derivative, in grey levels per pixel.
            const auto dx = static_cast<float>(3 * (up[x + 1] - up[x - 1] + down[x + 1] - down[x - 1]) +
                                               10 * (here[x + 1] - here[x - 1])) /
                            32.0F;
            const auto dy = static_cast<float>(3 * (down[x - 1] - up[x - 1] + down[x + 1] - up[x + 1]) +
                                               10 * (down[x] - up[x])) /
                            32.0F;
            a[x] = dx * dx;
            b[x] = dy * dy;
            c[x] = dx * dy;
        }
    }
    for (Field* field : {&xx, &yy, &xy})
        smooth_field(*field, width, height);
    const auto share = static_cast<float>(k);
    for (int y = 0; y < height; y++) {
        float *a = xx.row(y), *b = yy.row(y), *c = xy.row(y);
        for (int x = 0; x < width; x++)
            a[x] = a[x] * b[x] - c[x] * c[x] - share * (a[x] + b[x]) * (a[x] + b[x]);
    }
    return xx;
}

// Where the parabola through three values is highest, from the middle one.
double summit(float before, float here, float after) {
    const double bend =
        static_cast<double>(before) - 2.0 * static_cast<double>(here) + static_cast<double>(after);
    if (!(bend < 0.0)) return 0.0;
    return std::clamp(0.5 * (static_cast<double>(before) - static_cast<double>(after)) / bend, -0.5, 0.5);
}

// Whether none within `apart` is higher; of equals the first one is.
bool is_highest(const Field& response, int x, int y, int apart) {
    const float here = response.row(y)[x];
    for (int v = y - apart; v <= y + apart; v++) {
        const float* row = response.row(v);
        for (int u = x - apart; u <= x + apart; u++)
            if (row[u] > here || (row[u] == here && (v < y || (v == y && u < x)))) return false;
    }
    return true;
}

}  // namespace

std::vector<Corner> harris_corners(const GreyPicture& picture, const HarrisOptions& options) {
    const int width = picture.width, height = picture.height;
    const int border = std::max(options.border, options.apart + 4);
    if (width <= 2 * border || height <= 2 * border) return {};
    const Field response = response_of(picture, options.k);
    const int longer = std::max(width, height);
    const int across = std::max(1, width * kParts / longer), down = std::max(1, height * kParts / longer);
    std::vector<std::vector<Corner>> parts(static_cast<size_t>(across * down));
    for (int y = border; y < height - border; y++) {
        const float* row = response.row(y);
        for (int x = border; x < width - border; x++) {
            if (!(static_cast<double>(row[x]) >= options.least) || !is_highest(response, x, y, options.apart))
                continue;
            const DVec2 place(x + summit(row[x - 1], row[x], row[x + 1]),
                              y + summit(response.row(y - 1)[x], row[x], response.row(y + 1)[x]));
            const int part = y * down / height * across + x * across / width;
            parts[static_cast<size_t>(part)].push_back({place, static_cast<double>(row[x])});
        }
    }
    const auto stronger = [](const Corner& a, const Corner& b) { return a.response > b.response; };
    for (std::vector<Corner>& part : parts)
        std::stable_sort(part.begin(), part.end(), stronger);
    // In turns the next strongest one of each part.
    std::vector<Corner> corners;
    for (size_t turn = 0, before = 1; corners.size() < options.most && before > 0; turn++) {
        before = 0;
        for (const std::vector<Corner>& part : parts)
            if (turn < part.size()) {
                before++;
                corners.push_back(part[turn]);
            }
    }
    if (corners.size() > options.most) corners.resize(options.most);
    std::stable_sort(corners.begin(), corners.end(), stronger);
    return corners;
}

}  // namespace treerec
