// Markers beside OpenCV's: built where that is installed ('./dev test --long unit' installs it).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "cases.h"
#include "drawn_marker.h"
#include "photos/find_markers.h"

// Until OpenCV 4.6 among its extra modules, from 4.7 on in one of its own.
#if __has_include(<opencv2/objdetect/aruco_detector.hpp>)
#include <opencv2/objdetect/aruco_detector.hpp>
#elif __has_include(<opencv2/aruco.hpp>)
#include <opencv2/aruco.hpp>
#define TREEREC_OLD_ARUCO
#else
#define TREEREC_NO_ARUCO
#endif

#ifndef TREEREC_NO_ARUCO

namespace treerec {
namespace {

#ifdef TREEREC_OLD_ARUCO
const cv::aruco::Dictionary& codes() {
    static const cv::Ptr<cv::aruco::Dictionary> known =
        cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50);
    return *known;
}
#else
const cv::aruco::Dictionary& codes() {
    static const cv::aruco::Dictionary known = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50);
    return known;
}
#endif

std::vector<FoundMarker> their_markers(const GreyPicture& picture) {
    const cv::Mat matrix =
        cv::Mat(picture.height, picture.width, CV_8U, const_cast<uint8_t*>(picture.pixels.data())).clone();
    std::vector<std::vector<cv::Point2f>> corners;
    std::vector<int> ids;
#ifdef TREEREC_OLD_ARUCO
    const cv::Ptr<cv::aruco::DetectorParameters> parameters = cv::aruco::DetectorParameters::create();
    parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
    cv::aruco::detectMarkers(matrix, cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50), corners, ids,
                             parameters);
#else
    cv::aruco::DetectorParameters parameters;
    parameters.cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
    cv::aruco::ArucoDetector(codes(), parameters).detectMarkers(matrix, corners, ids);
#endif
    std::vector<FoundMarker> markers;
    for (size_t i = 0; i < ids.size(); i++) {
        FoundMarker marker;
        marker.id = ids[i];
        for (size_t k = 0; k < 4; k++)
            marker.corners[k] = DVec2(corners[i][k].x, corners[i][k].y) + 0.5;
        markers.push_back(marker);
    }
    return markers;
}

// The same codes, and which corner is the first.
TEST(MarkersOpenCv, TheSameDictionary) {
    ASSERT_EQ(codes().bytesList.rows, kMarkerCount);
    EXPECT_EQ(codes().markerSize, kMarkerBits);
    EXPECT_EQ(codes().maxCorrectionBits, 1);
    for (int id = 0; id < kMarkerCount; id++) {
        // Two bytes for each turn.
        const uint8_t* bytes = codes().bytesList.ptr<uint8_t>(id);
        EXPECT_EQ(bytes[0] << 8 | bytes[1], marker_code(id)) << id;
    }
}

// As many are found, and their corners are nearer to where they are.
TEST(MarkersOpenCv, NoFewerAndNoFartherOff) {
    Random random(17);
    size_t ours = 0, theirs = 0, both = 0;
    std::vector<double> our_misses, their_misses, apart;
    for (int i = 0; i < test::cases(120); i++) {
        test::MarkerLook look;
        look.side = std::array{30.0, 45.0, 80.0}[static_cast<size_t>(i) % 3];
        look.tilt = random.uniform(0.0, 60.0);
        look.blur = random.uniform(0.0, 1.0);
        look.falling_light = random.uniform(0.0, 0.3);
        const test::DrawnMarker drawn = test::draw_marker(look, random);
        const auto of = [&](const std::vector<FoundMarker>& markers) -> const FoundMarker* {
            const auto found = std::find_if(markers.begin(), markers.end(),
                                            [&](const FoundMarker& marker) { return marker.id == drawn.id; });
            return found == markers.end() ? nullptr : &*found;
        };
        const std::vector<FoundMarker> found = find_markers(drawn.picture),
                                       other = their_markers(drawn.picture);
        const FoundMarker *one = of(found), *two = of(other);
        ours += one != nullptr;
        theirs += two != nullptr;
        both += one && two;
        for (size_t k = 0; k < 4; k++) {
            if (one) our_misses.push_back(glm::distance(one->corners[k], drawn.corners[k]));
            if (two) their_misses.push_back(glm::distance(two->corners[k], drawn.corners[k]));
            if (one && two) apart.push_back(glm::distance(one->corners[k], two->corners[k]));
        }
    }
    EXPECT_GE(ours, theirs);
    EXPECT_GT(both, ours / 2);
    const auto median = [](std::vector<double>& values) {
        std::sort(values.begin(), values.end());
        return values.empty() ? INFINITY : values[values.size() / 2];
    };
    EXPECT_LT(median(our_misses), median(their_misses));
    EXPECT_LT(median(apart), 0.8);
}

}  // namespace
}  // namespace treerec

#endif
