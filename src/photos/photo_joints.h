// Whether the photos of a model hold together, without a truth to compare it with: whether neighbours' own
// matches fit their places, and how many points join the parts of the circle.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "photos/cameras_tell.h"
#include "photos/colmap_model.h"
#include "photos/feature_tracks.h"
#include "photos/sparse_points.h"
#include "progress.h"

namespace treerec {

// Two neighbours whose matches fit other places better than those that the model has for them.
struct PhotoContradiction {
    std::string one;
    std::string other;
    size_t shared = 0;   // matches that COLMAP verified
    size_t fitting = 0;  // of these, to the model
    size_t own = 0;      // of these, to an essential matrix of their own
};

// Two neighbours around the circle, and how many points photos on both sides of them see.
struct PhotoJoint {
    std::string from;
    std::string to;
    double degrees = 0.0;  // between them
    size_t points = 0;
};

struct PhotoJoints {
    std::vector<PhotoContradiction> contradictions;  // the worst one first
    std::vector<PhotoJoint> weak;                    // weak_joints(), the weakest first
};

// Neighbours around what was photographed, or by name, at least twice as many of whose matches agree on an
// essential matrix of their own (photos/pair_geometry.h) as on the model's, both to within four pixels, as
// COLMAP asks of its pairs. Photos that are not beside each other are not asked: what they have in common is
// often a mistake that the model rightly leaves out. names: of the photos that `matches` counts. Throws
// Cancelled.
std::vector<PhotoContradiction> contradictions_in(const PhotoModel& model,
                                                  std::span<const CameraAround> around,
                                                  std::span<const PhotoPlaceMatches> matches,
                                                  std::span<const std::string> names,
                                                  const Progress* progress = nullptr);

// Between each of the cameras around and the next one: the points that a photo within 60 degrees before and
// one within 60 degrees after see. Empty for fewer than four cameras, or where the points don't tell which
// photos see them.
std::vector<PhotoJoint> joints_around(const PhotoModel& model, std::span<const CameraAround> around,
                                      std::span<const SparsePoint> points,
                                      const Progress* progress = nullptr);

// Where the circle may be bent: a ring has to give way in two places for its parts to turn against each
// other, so the weakest joint, and those that have with it fewer than 60 points together: COLMAP by itself
// asks 30 of one photo. One weak joint in a ring that is closed elsewhere is none. The weakest one first.
std::vector<PhotoJoint> weak_joints(std::vector<PhotoJoint> joints);

}  // namespace treerec
