// Where photos show the sky, and what can't be there because they do.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "photos/colmap_model.h"
#include "photos/grey_pyramid.h"
#include "photos/rectify.h"
#include "progress.h"

namespace treerec {

// Where a photo shows the sky.
struct PhotoSky {
    enum class Shown { kOutside, kSomething, kSky };

    const Photo* photo = nullptr;
    const Camera* camera = nullptr;
    double scale = 1.0;  // the mask's pixels in one of the camera's
    int width = 0;       // of the mask
    int height = 0;
    std::vector<uint8_t> mask;  // 1 for the sky, rows from the top; empty where no sky is sure
    DVec3 colour{0.0};          // of the sky in the mean, 0 to 255; zeros where there is none

    // What the photo shows where a point is, given in the camera's coordinates.
    Shown shown_at(const DVec3& in_camera) const;
};

// The sky of a photo, but for what has something else within `margin` pixels. It is what looks like the even,
// light areas above the horizon do, as a polynomial of second degree over the picture tells it: the holes in
// a crown, too. sky: the way up in the model.
PhotoSky sky_in(const LoadedPhoto& photo, const DVec3& sky, int margin);

// The same of a model's photo in `folder`, which is made smaller to `most_pixels` of its longer side. Nothing
// where picture_of() has none.
std::optional<PhotoSky> read_sky(const Photo& photo, const Camera& camera, const std::string& folder,
                                 const DVec3& sky, int most_pixels, int margin);

struct CarveOptions {
    int most_pixels = 1600;      // of the longer side: larger photos are made smaller
    int margin = 2;              // pixels that a point may be off
    double least_beside = 0.35;  // share of the photos that have to show it beside thin wood
    double most_sky = 0.25;      // share of the photos which a point is in that may show the sky there
    size_t least_photos = 3;     // that have to show it
};

// The photos' sky, from which it can be told what is not there.
class SkyCarver {
  public:
    // Reads the photos; those that can't be read show none. Nothing is carved where sky_of() knows nothing.
    // Throws Cancelled.
    SkyCarver(const PhotoModel& model, std::span<const DVec3> sparse, const std::string& folder,
              const CarveOptions& options = {}, Progress* progress = nullptr);

    // Whether too many photos show the sky where a point of the model would be. Wood and leaves never do.
    bool is_sky(const DVec3& p) const;

    // Whether enough photos show the sky right beside wood that passes there: then it is thin. A furrow of a
    // trunk has it there at the outline alone. way: along
    // it, a unit vector; radius: in the model's unit.
    bool is_before_sky(const DVec3& p, const DVec3& way, double radius) const;

    // The sky's colour in most photos, 0 to 255; zeros where no photo shows it.
    DVec3 colour() const;

  private:
    std::vector<PhotoSky> views_;
    CarveOptions options_;
};

}  // namespace treerec
