// Where a photo says that it was taken, and what is up in it: the EXIF record of a JPEG.
#pragma once

#include <istream>
#include <optional>
#include <string>

namespace treerec {

// On the WGS84 ellipsoid, as satellites tell it.
struct PhotoPlace {
    double latitude = 0.0;        // degrees, north of the equator, -90 to 90
    double longitude = 0.0;       // degrees, east of Greenwich, -180 to 180
    std::optional<double> error;  // metres: how far off the horizontal place may be, as the camera estimates

    bool operator==(const PhotoPlace&) const = default;
};

// Reads a JPEG's GPS record (Exif 2.32, 4.6.6, tags 1 to 4 and 31). Nothing where there is none, or it is
// damaged, out of range, or the place in the Gulf of Guinea that cameras without a fix write: 0, 0.
std::optional<PhotoPlace> read_photo_place(std::istream& jpeg);

// The same of a file; nothing for one that cannot be read.
std::optional<PhotoPlace> read_photo_place(const std::string& path);

// How a JPEG is to be turned and mirrored so that it is upright: 1 to 8 (Exif 2.32, 4.6.4, tag 274), 1 where
// it does not say or is damaged.
int read_photo_orientation(std::istream& jpeg);

}  // namespace treerec
