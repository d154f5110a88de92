// Corners tracked between pictures whose warp is known: turned by 5 to 40 degrees, sheared, larger and
// smaller by 1.3, from the side.
#include <gtest/gtest.h>

#include <atomic>

#include "geometry/parallel.h"
#include "photos/feature_tracks.h"
#include "photos/photo_pairs.h"
#include "photos_warps.h"

namespace treerec {
namespace {

using test::draw_warped;
using test::error_of;
using test::known_warps;
using test::Warp;
using test::WarpError;

const Warp kAsItIs{"", DMat3(1.0)};

PhotoFeatures seen(const Warp& warp, double gain = 1.0, double bias = 0.0) {
    return features_of(draw_warped(warp, 7, gain, bias), {});
}

TEST(PhotosAffineTrack, IsRightWhateverTheWarp) {
    const PhotoFeatures first = seen(kAsItIs);
    for (const Warp& warp : known_warps()) {
        const PhotoFeatures second = seen(warp);
        const WarpError error = error_of(warp, first, match_pair(first, second));
        EXPECT_LT(error.median, 0.05) << warp.name;
        EXPECT_LT(error.wrong, 0.01) << warp.name;
        EXPECT_GT(2 * error.matches, error.corners) << warp.name;
    }
}

TEST(PhotosAffineTrack, IsRightInOtherLight) {
    const Warp warp = test::about_middle("turned by 10", test::turned(10));
    const PhotoFeatures first = seen(kAsItIs), second = seen(warp, 0.6, 40.0);
    const WarpError error = error_of(warp, first, match_pair(first, second));
    EXPECT_LT(error.median, 0.1);
    EXPECT_LT(error.wrong, 0.01);
    EXPECT_GT(2 * error.matches, error.corners);
}

TEST(PhotosAffineTrack, FindsTheMotionItself) {
    const Warp warp = test::about_middle("", DMat3(1.1, 0.15, 0, -0.2, 0.95, 0, 0, 0, 1));
    const PhotoFeatures first = seen(kAsItIs), second = seen(warp);
    size_t found = 0;
    for (size_t i = 0; i < 50; i++) {
        const DVec2 place = first.corners[i].place;
        const auto track =
            track_affine(first.pyramid, second.pyramid, place, {warp(place) + DVec2(4, -3), DMat2(1.0)});
        if (!track || track->similarity < 0.95) continue;
        found++;
        EXPECT_LT(glm::distance(track->motion.place, warp(place)), 0.3);
        EXPECT_NEAR(track->motion.turn[0].x, 1.1, 0.05);
        EXPECT_NEAR(track->motion.turn[0].y, 0.15, 0.05);
        EXPECT_NEAR(track->motion.turn[1].x, -0.2, 0.05);
        EXPECT_NEAR(track->motion.turn[1].y, 0.95, 0.05);
    }
    EXPECT_GT(found, 20u);
}

// Where the plain method does, and where it does not.
TEST(PhotosLucasKanade, FollowsSmallMotionsAlone) {
    const PhotoFeatures first = seen(kAsItIs);
    const auto plain = [&](const Warp& warp) {
        return error_of(warp, first, match_pair_plain(first, seen(warp)));
    };
    const WarpError moved = plain(test::about_middle("", DMat3(1.0), {4.3, -2.6}));
    EXPECT_LT(moved.median, 0.05);
    EXPECT_LT(moved.wrong, 0.1);
    EXPECT_GT(plain(test::about_middle("", test::turned(20))).wrong, 0.5);
    EXPECT_GT(plain(test::about_middle("", test::turned(40))).wrong, 0.9);
    EXPECT_GT(plain(test::about_middle("", test::turned(0, 1.3))).wrong, 0.4);
    EXPECT_GT(plain(test::about_middle("", DMat3(1.0), {60.4, -11.7})).wrong, 0.5);
}

TEST(PhotosLucasKanade, NothingWhereNothingIsToBeSeen) {
    const GreyPyramid plain = pyramid_of(Image(200, 200, 1), 1000), one = pyramid_of(Image(1, 1, 1), 1000);
    const DVec2 middle(100.0);
    EXPECT_FALSE(track_lucas_kanade(plain, plain, middle, middle));
    EXPECT_FALSE(track_affine(plain, plain, middle, {middle, DMat2(1.0)}));
    EXPECT_FALSE(track_lucas_kanade(one, plain, {0, 0}, middle));
    EXPECT_FALSE(track_affine(one, plain, {0, 0}, {middle, DMat2(1.0)}));
    const PhotoFeatures picture = seen(kAsItIs);
    const DVec2 place = picture.corners[0].place;
    for (const double far : {-1e9, 1e9, static_cast<double>(NAN)}) {
        EXPECT_FALSE(track_lucas_kanade(picture.pyramid, picture.pyramid, place, DVec2(far)));
        EXPECT_FALSE(track_affine(picture.pyramid, picture.pyramid, place, {DVec2(far), DMat2(1.0)}));
    }
}

TEST(PhotosMatchPair, PhotosOfNothingHaveNoMatches) {
    const PhotoFeatures picture = seen(kAsItIs), black = features_of(Image(640, 480, 3), {}),
                        one = features_of(Image(1, 1, 3), {});
    for (const PhotoFeatures* a : {&picture, &black, &one})
        for (const PhotoFeatures* b : {&picture, &black, &one}) {
            if (a == &picture && b == &picture) continue;
            EXPECT_EQ(match_pair(*a, *b).kept(), 0u);
            // The plain method checks nothing, but has no corner to begin at.
            if (a != &picture) {
                EXPECT_EQ(match_pair_plain(*a, *b).kept(), 0u);
            }
        }
    // Other bark.
    EXPECT_LT(match_pair(picture, features_of(draw_warped(kAsItIs, 99), {})).kept(), 15u);
}

TEST(PhotosMatchPair, MediansLeaveAQuarterOrThreeQuarters) {
    std::vector<PointMatch> matches;
    Random random(5);
    for (uint32_t i = 0; i < 10000; i++)
        matches.push_back({i, DVec2(0.0), random.uniform(), random.uniform(), true});
    const auto left = [&](MedianFilter filter) {
        PairMatches copy;
        copy.matches = matches;
        filter_by_medians(copy.matches, filter);
        for (size_t i = 0; i < matches.size(); i++)
            EXPECT_EQ(copy.matches[i].corner, i);
        return static_cast<double>(copy.kept()) / 1e4;
    };
    EXPECT_EQ(left(MedianFilter::kNone), 1.0);
    EXPECT_NEAR(left(MedianFilter::kEither), 0.25, 0.02);
    EXPECT_NEAR(left(MedianFilter::kBoth), 0.75, 0.02);
    std::vector<PointMatch> none;
    filter_by_medians(none, MedianFilter::kBoth);
}

// The photos of a walk with a jump in their names, and one of something else.
std::vector<PhotoFeatures> walk() {
    std::vector<PhotoFeatures> photos;
    for (const double along : {0.0, 40.0, 80.0, 400.0, 440.0, 480.0, 120.0, 160.0})
        photos.push_back(seen(test::about_middle("", DMat3(1.0), {-along, 0.0})));
    return photos;
}

TEST(PhotosPairs, AreThoseThatLookAlike) {
    const std::vector<PhotoFeatures> photos = walk();
    PhotoPairOptions options;
    options.alike = 2;
    const auto pairs = choose_photo_pairs(photos, options);
    const auto has = [&](size_t i, size_t j) {
        return std::find(pairs.begin(), pairs.end(), std::pair(i, j)) != pairs.end();
    };
    EXPECT_TRUE(has(2, 6));
    EXPECT_FALSE(has(0, 4));
    EXPECT_FALSE(has(0, 5));
    for (size_t i = 0; i + 1 < photos.size(); i++)
        EXPECT_TRUE(has(i, i + 1));
    // In sequence, what is far apart by name is not asked.
    options.sequence = true;
    options.steps = 2;
    options.closing = 2;
    for (const auto& [i, j] : choose_photo_pairs(photos, options))
        EXPECT_TRUE(j - i <= 2 || (i < 2 && j >= 6)) << i << " " << j;
}

TEST(PhotosPairs, AreTheSameOnAnyNumberOfThreads) {
    const std::vector<PhotoFeatures> photos = walk();
    std::vector<std::pair<size_t, size_t>> first;
    for (const int threads : {1, 2, 5}) {
        set_thread_count(threads);
        const auto pairs = choose_photo_pairs(photos, {});
        if (threads == 1) first = pairs;
        EXPECT_EQ(pairs, first);
    }
    set_thread_count(0);
}

TEST(PhotosPairs, CanBeCancelled) {
    class Stop : public Progress {
      public:
        bool cancelled() const override { return true; }
    } stop;
    const std::vector<PhotoFeatures> photos = walk();
    EXPECT_THROW(choose_photo_pairs(photos, {}, &stop), Cancelled);
    EXPECT_THROW(match_pair(photos[0], photos[1], {}, &stop), Cancelled);
}

TEST(PhotosTracks, BecomeLongAndHaveOnePlaceInAPhoto) {
    // One point in photos 0 to 3, with half a pixel between what two pairs say of photo 1.
    std::vector<PhotoPlaceMatches> pairs = {{0, 1, {{{10, 10}, {20, 20}, 0.9}}},
                                            {1, 2, {{{20.5, 20}, {30, 30}, 0.9}}},
                                            {2, 3, {{{30, 30}, {40, 40}, 0.9}}}};
    TrackOptions options;
    options.least_shared = 1;
    FeatureTracks tracks = join_tracks(4, pairs, options);
    EXPECT_EQ(tracks.tracks, 1u);
    ASSERT_EQ(tracks.keypoints[1].size(), 1u);
    EXPECT_EQ(tracks.keypoints[1][0], DVec2(20.25, 20));
    EXPECT_EQ(tracks.pairs.size(), 6u);
    // A weaker match that would put another place of photo 0 into it goes.
    pairs.push_back({0, 3, {{{200, 200}, {40, 40}, 0.8}}});
    tracks = join_tracks(4, pairs, options);
    EXPECT_EQ(tracks.conflicts, 1u);
    EXPECT_EQ(tracks.tracks, 1u);
    EXPECT_EQ(tracks.keypoints[0].size(), 1u);
    // A stronger one stays, and the weakest of the others goes.
    pairs.back().matches[0].weight = 2.0;
    tracks = join_tracks(4, pairs, options);
    EXPECT_EQ(tracks.conflicts, 1u);
    EXPECT_EQ(tracks.tracks, 2u);
    // Photos that nobody compared need more in common.
    options.least_shared = 2;
    EXPECT_EQ(join_tracks(4, {pairs[0], pairs[1], pairs[2]}, options).pairs.size(), 3u);
    EXPECT_EQ(join_tracks(3, {}).tracks, 0u);
}

}  // namespace
}  // namespace treerec
