// How well a tree explains its scan, and how near it comes to a reference skeleton.
#pragma once

#include <cstddef>
#include <vector>

#include "progress.h"
#include "scan/point_cloud.h"
#include "tree/tree.h"

namespace treerec {

// Every segment counts as a cylinder of its child's radius, as tree files mean it.
//
// A point's error is the smallest |distance to the axis - radius| over all segments: how far it lies from the
// nearest bark. Millimetres.
struct ScanScore {
    size_t points = 0;  // looked at
    double median_mm = 0.0;
    double mean_mm = 0.0;
    double p95_mm = 0.0;
    double explained_2cm = 0.0;        // share of the points within 2 cm
    double explained_2cm_noise = 0.0;  // share within 2 cm + the scan's noise
};

// One threshold of the comparison with a reference skeleton: shares of samples, 1 mm apart.
struct Agreement {
    double threshold = 0.0;  // see SkeletonScore
    double precision = 0.0;  // of the tree's wood that lies within the threshold of the reference's axis
    double recall = 0.0;     // of the reference's wood that lies within it of the tree's axis
    double f = 0.0;          // 2 PR / (P + R)
};

// The reference's wood between two thicknesses, where the tree meets it (SkeletonScore::match).
struct RadiusAgreement {
    double from_radius = 0.0;  // metres, of the reference
    double to_radius = 0.0;
    double length = 0.0;  // metres of the reference that the tree meets
    double error = 0.0;   // median relative error of the tree's radius there; 0 where there is no such wood
    double error_abs = 0.0;  // and of its absolute value
};

// Lengths and volumes: cylinders; relative errors are (tree - reference) / reference.
struct SkeletonScore {
    std::vector<Agreement> by_radius;    // thresholds 0, .25, .5, .75, 1 x the reference's radius there
    std::vector<Agreement> by_distance;  // thresholds 0, 1, .. 5 cm (in metres)
    // Within the larger of 1 cm and the radius of the wood that was met; its threshold is 1 cm.
    Agreement match;
    double chamfer_mm = 0.0;  // mean of the two mean distances from axis to axis
    double length = 0.0;      // metres
    double reference_length = 0.0;
    double length_error = 0.0;
    double volume = 0.0;  // cubic metres
    double reference_volume = 0.0;
    double volume_error = 0.0;
    // Over the reference's samples that the tree meets within the larger of 1 cm and the radius there: the
    // median of the relative error of the radius, signed and absolute.
    double radius_error = 0.0;
    double radius_error_abs = 0.0;
    // The same by the reference's radius: up to 5 mm, 1 cm, 2.5 cm, 5 cm, and beyond.
    std::vector<RadiusAgreement> radius_by_thickness;
};

// About so many of the points (some thousand at least), chosen by their places alone; all where there are no
// more.
std::vector<Vec3> sample_points(const std::vector<Vec3>& points, size_t about);

// cloud and tree may lie in different frames; the tree's says what a metre is. `noise`: the scan's range
// noise in metres. about: roughly how many points to look at, chosen by their places alone; 0 is all. Throws
// Error for a tree without wood or an empty cloud. O(points log segments).
ScanScore score_scan(const Tree& tree, const PointCloud& cloud, double noise = 0.0,
                     Progress* progress = nullptr, size_t about = 0);

// Both are compared in scan coordinates, in metres. A distance under a micrometre counts as none. Throws
// Error if one has no wood, or is longer than 20 km (a wrong unit). step: metres between the samples.
SkeletonScore score_skeleton(const Tree& tree, const Tree& reference, Progress* progress = nullptr,
                             double step = 0.001);

}  // namespace treerec
