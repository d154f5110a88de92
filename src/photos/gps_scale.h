// How long a model's unit is, from where its photos say that they were taken.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "geometry/vec.h"
#include "photos/colmap_model.h"
#include "photos/exif.h"
#include "progress.h"

namespace treerec {

struct PlacedCamera {
    DVec3 centre{0.0};  // in the model's coordinates
    PhotoPlace place;
};

struct GpsScale {
    // Two unknowns of place, one of direction and one of scale are fitted to two numbers of each fix; with
    // fewer than six, one bad fix can't be told from the others.
    static constexpr size_t kLeastFixes = 6;
    // At .15, one tree in three would be wrong by more than that, about what a guess by eye is; less sure,
    // and the size had better be told to be unknown.
    static constexpr double kMostError = 0.15;

    size_t photos = 0;             // that say where they were taken
    bool level = true;             // whether the way up is known
    size_t fixes = 0;              // different places among these
    size_t kept = 0;               // fixes that agree with the others
    double metres_per_unit = 0.0;  // 0 where nothing is known of it
    double relative_error = 0.0;   // one standard deviation of it, as a share of it

    bool usable() const {
        return kept >= kLeastFixes && metres_per_unit > 0.0 && relative_error <= kMostError;
    }
};

// Fits the cameras, seen from above, to their fixes by a turn, a shift and a scale, in metres on the plane
// that touches the WGS84 ellipsoid there. Photos with the same fix count once, by the mean of their cameras:
// a phone repeats its last fix. Fixes that do not agree with the others weigh little or nothing (Huber's
// weights, then Tukey's). A fix is taken to be off by what its camera estimates, else by 3 m, in both
// directions, or by more where the fit shows that. sky: the way up in the model's coordinates, a unit vector.
GpsScale fit_gps_scale(std::span<const PlacedCamera> cameras, const DVec3& sky);

// The same for a model's photos, which lie in `folder`. points: of the scene, as for sky_of(), which has to
// know the way up. Throws Cancelled.
GpsScale ask_gps(const PhotoModel& model, const std::string& folder, std::span<const DVec3> points,
                 const Progress* progress = nullptr);

// "The size comes from the photos' GPS: …", or why it does not. height: of the tree, metres; `scale` has at
// least one photo.
std::string gps_sentence(const GpsScale& scale, double height);

}  // namespace treerec
