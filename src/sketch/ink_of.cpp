#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "error.h"
#include "sketch/line_mask.h"

namespace treerec {

namespace {

constexpr int kLeastContrast = 30;  // grey levels between paper and ink
constexpr double kMostInk = 0.4;    // of all pixels
constexpr int kPapersAcross = 8;    // places at which the paper's colour is looked for
constexpr int kSmallestPaper = 64;  // pixels

constexpr double kCommon = 0.4;  // of all pixels: so many of nearly one colour are paper

using Levels = std::array<uint8_t, 3>;

// The colour of the paper: the one that most of the picture has, where there is one. Else the medians of
// cells, which even a thick line does not fill, and between their middles what lies between: a shadow over a
// photographed sheet is paper so.
class Paper {
  public:
    explicit Paper(const Image& picture) {
        if (const std::optional<Levels> colour = common_colour(picture)) {
            cell_ = across_ = down_ = 1;
            medians_.push_back(*colour);
            return;
        }
        cell_ = std::max(kSmallestPaper,
                         (std::max(picture.width, picture.height) + kPapersAcross - 1) / kPapersAcross);
        across_ = std::max(1, (picture.width + cell_ / 2) / cell_);
        down_ = std::max(1, (picture.height + cell_ / 2) / cell_);
        for (int v = 0; v < down_; v++)
            for (int u = 0; u < across_; u++)
                medians_.push_back(median(picture, u, v));
    }

    // The greatest difference of a channel from the paper's at a pixel's place.
    int difference(const uint8_t* pixel, int x, int y) const {
        const auto at = [](int along, int cell, int count, int& first, int& share) {
            const int place = std::clamp(2 * along + 1 - cell, 0, 2 * cell * (count - 1));
            first = std::min(place / (2 * cell), std::max(0, count - 2));
            share = place - 2 * cell * first;
        };
        int u = 0, v = 0, s = 0, t = 0;
        at(x, cell_, across_, u, s);
        at(y, cell_, down_, v, t);
        const int right = std::min(u + 1, across_ - 1), below = std::min(v + 1, down_ - 1);
        const int64_t whole = 2 * int64_t{cell_};
        int most = 0;
        for (size_t k = 0; k < 3; k++) {
            const auto level = [&](int i, int j) {
                return int64_t{medians_[static_cast<size_t>(j) * static_cast<size_t>(across_) +
                                        static_cast<size_t>(i)][k]};
            };
            const int64_t sum = (whole - t) * ((whole - s) * level(u, v) + s * level(right, v)) +
                                t * ((whole - s) * level(u, below) + s * level(right, below));
            most = std::max(most, std::abs(static_cast<int>(sum / (whole * whole)) - int{pixel[k]}));
        }
        return most;
    }

  private:
    static std::optional<Levels> common_colour(const Image& picture) {
        constexpr unsigned kShift = 3, kBits = 8 - kShift;
        std::vector<size_t> counts(size_t{1} << 3 * kBits, 0);
        const auto bin_of = [&](const uint8_t* pixel) {
            return size_t{pixel[0]} >> kShift << 2 * kBits | size_t{pixel[1]} >> kShift << kBits |
                   size_t{pixel[2]} >> kShift;
        };
        for (size_t i = 0; i < picture.pixels.size(); i += 4)
            counts[bin_of(&picture.pixels[i])]++;
        const auto most = std::max_element(counts.begin(), counts.end());
        if (static_cast<double>(*most) < kCommon * static_cast<double>(picture.pixels.size() / 4)) return {};
        const auto bin = static_cast<size_t>(most - counts.begin());
        std::array<size_t, 3> sums{};
        for (size_t i = 0; i < picture.pixels.size(); i += 4)
            if (bin_of(&picture.pixels[i]) == bin)
                for (size_t k = 0; k < 3; k++)
                    sums[k] += picture.pixels[i + k];
        Levels mean{};
        for (size_t k = 0; k < 3; k++)
            mean[k] = static_cast<uint8_t>(sums[k] / *most);
        return mean;
    }

    Levels median(const Image& picture, int u, int v) const {
        const int left = u * cell_, top = v * cell_;
        // The last ones take what is left over.
        const int right = u + 1 == across_ ? picture.width : left + cell_;
        const int bottom = v + 1 == down_ ? picture.height : top + cell_;
        std::array<std::array<int, 256>, 3> counts{};
        for (int y = top; y < bottom; y++)
            for (int x = left; x < right; x++)
                for (size_t k = 0; k < 3; k++)
                    counts[k][picture.at(x, y)[k]]++;
        Levels levels{};
        const int half = (right - left) * (bottom - top) / 2;
        for (size_t k = 0; k < 3; k++) {
            int below = 0, level = 0;
            while ((below += counts[k][static_cast<size_t>(level)]) <= half)
                level++;
            levels[k] = static_cast<uint8_t>(level);
        }
        return levels;
    }

    int cell_ = 0, across_ = 0, down_ = 0;
    std::vector<Levels> medians_;
};

// On white, where it is not opaque.
Image on_white(const Image& picture) {
    Image flat = picture;
    for (size_t i = 0; i < flat.pixels.size(); i += 4)
        for (size_t k = 0; k < 3; k++) {
            const int alpha = flat.pixels[i + 3];
            flat.pixels[i + k] =
                static_cast<uint8_t>((flat.pixels[i + k] * alpha + 255 * (255 - alpha) + 127) / 255);
        }
    return flat;
}

std::vector<uint8_t> differences(const Image& picture) {
    const size_t count = picture.pixels.size() / 4;
    std::vector<uint8_t> levels(count);
    size_t clear = 0;
    for (size_t i = 0; i < count; i++) {
        levels[i] = picture.pixels[4 * i + 3];
        clear += levels[i] < 128 ? 1 : 0;
    }
    if (2 * clear > count) return levels;
    const Image flat = on_white(picture);
    const Paper paper(flat);
    for (int y = 0; y < flat.height; y++)
        for (int x = 0; x < flat.width; x++)
            levels[static_cast<size_t>(y) * static_cast<size_t>(flat.width) + static_cast<size_t>(x)] =
                static_cast<uint8_t>(paper.difference(flat.at(x, y), x, y));
    return levels;
}

// The level that splits them best: N. Otsu 1979, 'A threshold selection method from gray-level histograms'.
// Levels up to it are paper. contrast: gets how far the means of both sides are from one another.
int otsu_threshold(const std::vector<uint8_t>& levels, double& contrast) {
    std::array<double, 256> counts{};
    for (const uint8_t level : levels)
        counts[level] += 1.0;
    double all = 0.0;
    for (size_t i = 0; i < counts.size(); i++)
        all += counts[i] * static_cast<double>(i);
    const double count = static_cast<double>(levels.size());
    double below = 0.0, sum = 0.0, best = -1.0;
    size_t threshold = 0;
    contrast = 0.0;
    for (size_t i = 0; i + 1 < counts.size(); i++) {
        below += counts[i];
        sum += counts[i] * static_cast<double>(i);
        if (below == 0.0 || below == count) continue;
        const double apart = (all - sum) / (count - below) - sum / below;
        const double between = below * (count - below) * apart * apart;
        if (between <= best) continue;
        best = between;
        threshold = i;
        contrast = apart;
    }
    // Between the two levels that are there, where a drawing has just two.
    size_t next = threshold + 1;
    while (next < 255 && counts[next] == 0.0)
        next++;
    return static_cast<int>((threshold + next - 1) / 2);
}

}  // namespace

LineMask ink_of(const Image& picture, const std::string& who) {
    const std::vector<uint8_t> levels = differences(picture);
    double contrast = 0.0;
    const int threshold = otsu_threshold(levels, contrast);
    if (contrast < kLeastContrast)
        throw Error(who +
                    " shows no drawing: all of it has nearly one color. Draw dark lines on light paper.");
    LineMask mask(picture.width, picture.height);
    size_t inked = 0;
    for (size_t i = 0; i < levels.size(); i++) {
        mask.ink[i] = levels[i] > threshold ? 1 : 0;
        inked += mask.ink[i];
    }
    if (static_cast<double>(inked) > kMostInk * static_cast<double>(levels.size()))
        throw Error(who +
                    " is no drawing of lines: too much of it differs from its paper. Draw dark lines on "
                    "light paper.");
    return mask;
}

}  // namespace treerec
