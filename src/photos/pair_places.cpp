#include "photos/pair_places.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "photos/likeness.h"
#include "photos/refine_disparity.h"
#include "photos/semi_global.h"

namespace treerec {

namespace {

constexpr int kLeastDisparities = 4;  // fewer tell nothing apart
// Correlation: a pixel of a trunk has .9, one of the grass beside it .2; half way.
constexpr double kLeastAlike = 0.55;
// Of the larger pictures: what a matched pixel was out by, which is a part of it, twice as large.
constexpr RefineOptions kFine{.window = 3, .steps = 5, .most = 1.5F};

size_t pixel_of(const RectifiedPair& pair, int x, int y) {
    return static_cast<size_t>(y) * static_cast<size_t>(pair.width) + static_cast<size_t>(x);
}

// Where one pixel of one size of a pair is found in the other photo.
struct Match {
    const RectifiedPair* pair = nullptr;
    int x = 0, y = 0;
    float disparity = 0.0F;
};

PairPlace place_of(const Match& match) {
    const auto shift = static_cast<double>(match.disparity);
    return {match.pair->point_at(match.x, match.y, shift),
            0.5 * match.pair->focal * match.pair->baseline / (shift * shift),
            match.pair->left.colours[pixel_of(*match.pair, match.x, match.y)]};
}

// The same in the larger pictures, where they show it.
Match finer(const Match& match, const RectifiedPair& fine) {
    const double larger = fine.focal / match.pair->focal;
    const DVec2 place = (DVec2(match.x, match.y) + 0.5 - match.pair->centre) * larger + fine.centre;
    const int x = static_cast<int>(std::floor(place.x)), y = static_cast<int>(std::floor(place.y));
    if (x < 0 || y < 0 || x >= fine.width || y >= fine.height || !fine.left.inside[pixel_of(fine, x, y)])
        return match;
    const auto shift = static_cast<float>(larger * static_cast<double>(match.disparity));
    return {&fine, x, y, refine_disparity(fine, x, y, shift, kFine)};
}

}  // namespace

std::vector<PairPlace> places_of_pair(const PhotoSizes& one, const PhotoSizes& other, const PhotoSky& sky,
                                      double least, double most) {
    const auto pair = rectify(one.matched, other.matched);
    if (!pair) return {};
    const double lengths = pair->focal * pair->baseline;
    const int first = std::max(1, static_cast<int>(std::floor(lengths / most)));
    const int last = std::min(static_cast<int>(std::ceil(lengths / least)), first + kMostDisparities - 1);
    if (last - first < kLeastDisparities) return {};
    const std::vector<float> disparities = match_rectified(*pair, first, last);
    const bool has_fine = !one.fine.picture.pixels.empty() && !other.fine.picture.pixels.empty();
    const auto fine = has_fine ? rectify(one.fine, other.fine) : std::nullopt;
    const Likeness likeness;
    std::vector<PairPlace> places;
    for (int y = 0; y < pair->height; y++)
        for (int x = 0; x < pair->width; x++) {
            Match match{&*pair, x, y, disparities[pixel_of(*pair, x, y)]};
            if (std::isnan(match.disparity)) continue;
            if (fine) match = finer(match, *fine);
            const PairPlace seen = place_of(match);
            if (sky.shown_at(one.matched.photo->to_camera(seen.place)) == PhotoSky::Shown::kSky) continue;
            if (likeness.at(*match.pair, match.x, match.y, match.disparity) < kLeastAlike) continue;
            places.push_back(seen);
        }
    return places;
}

}  // namespace treerec
