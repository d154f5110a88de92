// What is in front must not grow into what is behind it: photos/likeness.h, on pictures that are drawn.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/random.h"
#include "photos/likeness.h"
#include "photos/refine_disparity.h"

namespace treerec {
namespace {

constexpr int kOutline = 60;     // the left picture's column where bark ends and grass begins
constexpr float kShift = 12.5F;  // of the bark, pixels

// Smooth noise of one dimension less than a texture needs, for each row.
class Rows {
  public:
    Rows(uint64_t seed, double wave) : wave_(wave) {
        Random random(seed);
        for (double& phase : phases_)
            phase = random.uniform() * 6.28;
    }
    // -1..1
    double at(double x, int y) const {
        double sum = 0.0;
        for (size_t i = 0; i < phases_.size(); i++)
            sum +=
                std::sin(x * (0.5 + 0.37 * static_cast<double>(i)) / wave_ + phases_[i] * (1.0 + 0.61 * y));
        return sum / static_cast<double>(phases_.size());
    }

  private:
    double wave_;
    std::array<double, 5> phases_{};
};

struct Look {
    double gain = 1.0;  // of the right picture
    double level = 0.0;
    double contrast = 60.0;
    double wave = 1.2;  // how smooth the bark is
};

// Bark to the left of an outline, shifted between the pictures, and grass to the right, which the other
// picture shows otherwise.
RectifiedPair bark_before_grass(const Look& look = {}) {
    RectifiedPair pair;
    pair.width = 140;
    pair.height = 40;
    const Rows bark(1, look.wave), grass(2, 1.0), other_grass(3, 1.0);
    for (RectifiedView* view : {&pair.left, &pair.right}) {
        const bool right = view == &pair.right;
        const double shift = right ? static_cast<double>(kShift) : 0.0;
        for (int y = 0; y < pair.height; y++)
            for (int x = 0; x < pair.width; x++) {
                const bool is_bark = x + shift < kOutline;
                const double texture = is_bark ? bark.at(x + shift, y)
                                       : right ? other_grass.at(x, y)
                                               : grass.at(x, y);
                double grey = (is_bark ? 90.0 : 120.0) + look.contrast * 0.6 * texture;
                if (right) grey = look.gain * grey + look.level;
                const auto value = static_cast<uint8_t>(std::lround(std::clamp(grey, 0.0, 255.0)));
                view->grey.push_back(value);
                view->inside.push_back(1);
                const auto blue = static_cast<uint8_t>(is_bark ? value : value / 3);
                view->colours.push_back({value, value, blue});
            }
    }
    return pair;
}

// The share of the rows in which a column is at least so alike.
double share_alike(const RectifiedPair& pair, int x, double least) {
    const Likeness likeness;
    int alike = 0, all = 0;
    for (int y = 6; y < pair.height - 6; y++, all++)
        alike += likeness.at(pair, x, y, kShift) >= least;
    return static_cast<double>(alike) / all;
}

TEST(Likeness, EndsAtAnOutline) {
    const RectifiedPair pair = bark_before_grass();
    for (int x = 30; x < kOutline - 1; x++)
        EXPECT_GT(share_alike(pair, x, 0.6), 0.95) << x;
    // Grass that is right beside, and has the bark's disparity from it.
    for (int x = kOutline + 1; x < kOutline + 8; x++)
        EXPECT_LT(share_alike(pair, x, 0.6), 0.15) << x;
}

TEST(Likeness, DoesNotMindAnotherExposure) {
    for (const Look& look : {Look{.gain = 0.6, .level = 20.0}, Look{.gain = 1.3, .level = -30.0}})
        EXPECT_GT(share_alike(bark_before_grass(look), 40, 0.9), 0.95) << look.gain;
}

TEST(Likeness, KnowsNothingOfWhatIsFlatOrOutside) {
    const Likeness likeness;
    const RectifiedPair flat = bark_before_grass({.contrast = 0.0});
    EXPECT_EQ(likeness.at(flat, 40, 20, kShift), 0.0);
    const RectifiedPair pair = bark_before_grass();
    for (const auto& [x, y] : {std::pair{3, 20}, {136, 20}, {60, 3}, {60, 36}, {15, 20}})
        EXPECT_EQ(likeness.at(pair, x, y, kShift), 0.0) << x << " " << y;
    EXPECT_EQ(likeness.at(pair, 100, 20, -60.0F), 0.0);
}

TEST(RefineDisparity, FindsAPartOfAPixelAndKeepsWhatItCanNotMend) {
    const RectifiedPair pair = bark_before_grass({.wave = 3.0});
    std::vector<float> off;
    for (int y = 6; y < pair.height - 6; y++)
        for (int x = 30; x < kOutline - 5; x++)
            off.push_back(std::abs(
                refine_disparity(pair, x, y, kShift + 0.7F, {.window = 3, .steps = 5, .most = 1.5F}) -
                kShift));
    std::sort(off.begin(), off.end());
    EXPECT_LT(off[off.size() / 2], 0.05F);
    EXPECT_LT(off[off.size() * 9 / 10], 0.15F);
    EXPECT_EQ(refine_disparity(pair, 1, 20, 5.0F), 5.0F);
    EXPECT_EQ(refine_disparity(bark_before_grass({.contrast = 0.0}), 40, 20, 5.0F), 5.0F);
}

}  // namespace
}  // namespace treerec
