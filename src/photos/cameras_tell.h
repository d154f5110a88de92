// What the places and directions of a model's cameras tell of the scene, before any point is looked at.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geometry/vec.h"
#include "photos/colmap_model.h"

namespace treerec {

// The way to the sky, a unit vector in the model's coordinates. People hold a camera level: the pictures'
// rows, or the columns of those that were taken upright and stored lying, are all perpendicular to it.
// points: of the scene; where all pictures were stored lying, the sky is where more of it stands above the
// cameras than below. Nothing where the pictures do not agree, or all look one way, as in a flight.
std::optional<DVec3> sky_of(const PhotoModel& model, std::span<const DVec3> points);

// The place that the photos were taken of: nearest to all lines of sight, in the model's coordinates. Nothing
// where these are nearly parallel, or where it is not before most cameras, as from the middle of a room.
std::optional<DVec3> subject_of(const PhotoModel& model);

// Where a photo was taken from, seen from above.
struct CameraAround {
    std::string name;      // of the photo
    double degrees = 0.0;  // around what was photographed, 0 to 360, from a direction that means nothing
    double away = 0.0;     // from the upright line through it, in the model's unit
};

// The cameras in their order around what was photographed. Empty where subject_of() or sky_of() knows
// nothing. points: as there.
std::vector<CameraAround> cameras_around(const PhotoModel& model, std::span<const DVec3> points);

// Where the photos' circle around what they were taken of is widest open.
struct CircleGap {
    double degrees = 0.0;  // between two neighbours
    std::string from;      // the photos on both sides
    std::string to;
};

// cameras: in their order around. Nothing for fewer than two.
std::optional<CircleGap> widest_gap_of(std::span<const CameraAround> cameras);

// Degrees, where photos look at a scene from one side: a wall or a piece of bark looks no different to them
// from a tree. That is where they go around less than a third of the circle; where they have no subject, as
// in a flight, where no two of them see the middle of the points from directions 30 degrees apart. Nothing
// where they go further around. points: of the scene.
std::optional<double> one_sided_arc(const PhotoModel& model, std::span<const DVec3> points);

// Degrees between two directions, of any length.
double degrees_between(const DVec3& a, const DVec3& b);

// How far a point is from a line. direction: a unit vector.
double away_from_line(const DVec3& p, const DVec3& on_line, const DVec3& direction);

// How far from the upright line through the subject a point may be that belongs to it, in the model's unit:
// nearer than nearly all cameras are. sky: a unit vector.
double subject_reach(const PhotoModel& model, const DVec3& subject, const DVec3& sky);

// The folders in which COLMAP, and what follows its habits, leaves the model of a cloud: the cloud's own,
// sparse/ and sparse/0/ in it and beside it. Those of them with both files of cameras, the nearest first.
std::vector<std::string> photo_models_beside(const std::string& cloud_path);

}  // namespace treerec
