// Cameras and photos of a COLMAP model (J. L. Schoenberger, "Output Format", COLMAP's documentation).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/vec.h"
#include "progress.h"

namespace treerec {

// COLMAP's camera models that are known here, by their numbers in its files.
enum class LensModel {
    kSimplePinhole = 0,
    kPinhole = 1,
    kSimpleRadial = 2,
    kRadial = 3,
    kOpenCv = 4,
    kOpenCvFisheye = 5,
    kFullOpenCv = 6,
    kSimpleRadialFisheye = 8,
    kRadialFisheye = 9,
};

struct Camera {
    LensModel model = LensModel::kPinhole;
    int width = 0;  // pixels
    int height = 0;
    std::array<double, 12> parameters{};  // in COLMAP's order

    // Where a point in the camera's coordinates (x right, y down, z ahead) falls, in pixels from the upper
    // left corner; nothing for one that is not in front of the camera, or so far to the side that the lens's
    // formula turns back.
    std::optional<DVec2> project(const DVec3& p) const;
    // What falls on a place of the picture, in pixels from the upper left corner: the way there as (x, y, 1),
    // in the camera's coordinates; nothing where the lens's formula does not lead there. To a thousandth of a
    // pixel and better.
    std::optional<DVec3> ray(const DVec2& pixel) const;
    // Pixels of the picture's middle for a step of 1 to the side at the distance 1; 0 where the lens's
    // formula gives none.
    double focal_length() const;
};

// A camera from numbers that may be any: its model's number, pixels, and as many parameters as it has or
// more. source: what sentences call their origin. Throws Error where they are none of a camera.
Camera checked_camera(int64_t model, int64_t width, int64_t height, std::span<const double> parameters,
                      const std::string& source);

struct Photo {
    std::string name;                                    // as COLMAP wrote it, with / between folders
    int camera = 0;                                      // index into PhotoModel::cameras
    std::array<double, 4> rotation{1.0, 0.0, 0.0, 0.0};  // quaternion w x y z, world to camera
    DVec3 translation{0.0};
    uint32_t number = 0;  // COLMAP's, by which its points name it

    DVec3 to_camera(const DVec3& world) const;
    // Turns directions of the world into the camera's: its rows are the camera's axes.
    DMat3 turn() const;
    // Where the camera stood, and which way it looked (a unit vector), in the world.
    DVec3 centre() const;
    DVec3 ahead() const;
};

struct PhotoModel {
    std::vector<Camera> cameras;
    std::vector<Photo> photos;  // by name
};

// To judge a result by photos that it was not made of, every n-th is held out, in the order of their names;
// every = 0 holds none out.
PhotoModel held_out(const PhotoModel& model, size_t every);
PhotoModel without_held_out(const PhotoModel& model, size_t every);

// Reads cameras.bin and images.bin, or else cameras.txt and images.txt, of a folder. Throws Error with a
// sentence where they are missing, damaged, or name a camera model that is not known here, or Cancelled.
PhotoModel read_photo_model(const std::string& folder, Progress* progress = nullptr);

// The same from the files' contents. folder: what sentences call it.
PhotoModel parse_photo_model(std::string_view cameras, std::string_view images, bool text,
                             const std::string& folder);

}  // namespace treerec
