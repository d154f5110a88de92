// Tracked corners beside OpenCV's: built where that is installed ('./dev test --long unit' installs it).
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "photos_warps.h"

namespace treerec {
namespace {

const test::Warp kAsItIs{"", DMat3(1.0)};

cv::Mat as_matrix(const GreyPicture& picture) {
    return cv::Mat(picture.height, picture.width, CV_8U, const_cast<uint8_t*>(picture.pixels.data())).clone();
}

double median_of(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values.empty() ? INFINITY : values[values.size() / 2];
}

TEST(PhotosOpenCv, TheSamePyramid) {
    const GreyPyramid ours = pyramid_of(test::draw_warped(kAsItIs, 7), 1000);
    cv::Mat theirs = as_matrix(ours.levels[0]);
    for (size_t level = 1; level < ours.levels.size(); level++) {
        cv::pyrDown(theirs, theirs);
        const cv::Mat same = as_matrix(ours.levels[level]);
        ASSERT_EQ(theirs.size(), same.size());
        // They mirror at the border.
        const cv::Rect inner(3, 3, same.cols - 6, same.rows - 6);
        EXPECT_LE(cv::norm(theirs(inner), same(inner), cv::NORM_INF), 2.0) << level;
    }
    // Smaller photos: means of what each pixel covers.
    cv::Mat small;
    cv::resize(as_matrix(ours.levels[0]), small, {333, 250}, 0, 0, cv::INTER_AREA);
    EXPECT_LE(cv::norm(small, as_matrix(grey_of(test::draw_warped(kAsItIs, 7), 333)), cv::NORM_INF), 1.0);
}

TEST(PhotosOpenCv, TheSameCorners) {
    const GreyPicture picture = grey_of(test::draw_warped(kAsItIs, 7), 1000);
    std::vector<cv::Point2f> theirs;
    cv::goodFeaturesToTrack(as_matrix(smoothed(picture)), theirs, 200, 0.001, 4.0, cv::noArray(), 7, true,
                            0.04);
    HarrisOptions options;
    options.most = 2000;
    const std::vector<Corner> ours = harris_corners(picture, options);
    size_t near = 0, inside = 0;
    for (const cv::Point2f& p : theirs) {
        const DVec2 place(p.x, p.y);
        if (place.x < 12 || place.y < 12 || place.x > picture.width - 13 || place.y > picture.height - 13)
            continue;
        inside++;
        for (const Corner& corner : ours)
            if (glm::distance(corner.place, place) < 2.0) {
                near++;
                break;
            }
    }
    ASSERT_GT(inside, 100u);
    EXPECT_GT(static_cast<double>(near), 0.9 * static_cast<double>(inside));
}

// The plain method is theirs; where it can't do it, neither can they.
TEST(PhotosOpenCv, ThePlainMethod) {
    const PhotoFeatures first = features_of(test::draw_warped(kAsItIs, 7), {});
    for (const auto& [warp, follows] :
         {std::pair{test::about_middle("moved", DMat3(1.0), {5.3, -4.1}), true},
          std::pair{test::about_middle("turned by 3", test::turned(3)), true},
          std::pair{test::about_middle("turned by 30", test::turned(30)), false}}) {
        const PhotoFeatures second = features_of(test::draw_warped(warp, 7), {});
        std::vector<cv::Point2f> from, to;
        for (const Corner& corner : first.corners)
            from.emplace_back(static_cast<float>(corner.place.x), static_cast<float>(corner.place.y));
        std::vector<uchar> state;
        std::vector<float> errors;
        const LucasKanadeOptions options;
        const int side = 2 * options.reach + 1;
        cv::calcOpticalFlowPyrLK(as_matrix(first.pyramid.levels[0]), as_matrix(second.pyramid.levels[0]),
                                 from, to, state, errors, {side, side},
                                 static_cast<int>(first.pyramid.levels.size()) - 1);
        std::vector<double> between, ours, theirs;
        for (const PointMatch& match : match_pair_plain(first, second).matches) {
            if (!state[match.corner]) continue;
            const DVec2 other(to[match.corner].x, to[match.corner].y);
            const DVec2 right = warp(first.corners[match.corner].place);
            between.push_back(glm::distance(match.place, other));
            ours.push_back(glm::distance(match.place, right));
            theirs.push_back(glm::distance(other, right));
        }
        ASSERT_GT(between.size(), 300u);
        if (follows) {
            EXPECT_LT(median_of(between), 0.05) << warp.name;
            EXPECT_LT(median_of(ours), median_of(theirs) + 0.02) << warp.name;
        } else {
            EXPECT_GT(median_of(ours), 5.0) << warp.name;
            EXPECT_GT(median_of(theirs), 5.0) << warp.name;
        }
    }
}

// The motion of one window by another way: Evangelidis and Psarakis, "Parametric image alignment using
// enhanced correlation coefficient maximization", 2008.
TEST(PhotosOpenCv, TheAffineMotionAndItsCorrelation) {
    const test::Warp warp = test::about_middle("", DMat3(1.05, 0.08, 0, -0.1, 0.97, 0, 0, 0, 1));
    const PhotoFeatures first = features_of(test::draw_warped(kAsItIs, 7), {});
    const PhotoFeatures second = features_of(test::draw_warped(warp, 7, 0.8, 20.0), {});
    const cv::Mat one = as_matrix(first.pyramid.levels[0]), other = as_matrix(second.pyramid.levels[0]);
    const int reach = MatchOptions{}.track.window.reach, side = 2 * reach + 1;
    std::vector<double> between, similarities;
    for (const PointMatch& match : match_pair(first, second).matches) {
        if (!match.kept || between.size() >= 60) continue;
        // A window whose middle is a whole pixel, which theirs has to be.
        const DVec2 place = glm::round(first.corners[match.corner].place);
        const auto ours = track_affine(first.pyramid, second.pyramid, place, {warp(place), DMat2(1.0)},
                                       {.window = {.reach = reach}, .levels = 1});
        if (!ours) continue;
        const cv::Rect window(static_cast<int>(place.x) - reach, static_cast<int>(place.y) - reach, side,
                              side);
        cv::Mat motion = (cv::Mat_<float>(2, 3) << 1, 0, 0, 0, 1, 0);
        motion.at<float>(0, 2) = static_cast<float>(warp(place).x - reach);
        motion.at<float>(1, 2) = static_cast<float>(warp(place).y - reach);
        double similarity = 0.0;
        try {
            similarity = cv::findTransformECC(one(window), other, motion, cv::MOTION_AFFINE,
                                              {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 100, 1e-6},
                                              cv::noArray(), 1);
        } catch (const cv::Exception&) {
            continue;
        }
        const DVec2 theirs(
            motion.at<float>(0, 0) * reach + motion.at<float>(0, 1) * reach + motion.at<float>(0, 2),
            motion.at<float>(1, 0) * reach + motion.at<float>(1, 1) * reach + motion.at<float>(1, 2));
        between.push_back(glm::distance(ours->motion.place, theirs));
        similarities.push_back(std::abs(ours->similarity - similarity));
    }
    ASSERT_GT(between.size(), 30u);
    EXPECT_LT(median_of(between), 0.03);
    EXPECT_LT(median_of(similarities), 0.005);
}

}  // namespace
}  // namespace treerec
