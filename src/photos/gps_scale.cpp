#include "photos/gps_scale.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <complex>
#include <map>
#include <optional>
#include <utility>

#include "file_bytes.h"
#include "geometry/portable_math.h"
#include "geometry/quantile.h"
#include "photos/cameras_tell.h"

namespace treerec {

namespace {

// The WGS84 ellipsoid (NGA.STND.0036): half its long axis in metres, and its flattening.
constexpr double kAxis = 6378137.0;
constexpr double kFlattening = 1.0 / 298.257223563;
constexpr double kUsualError = 3.0;  // metres: of a phone under an open sky, in each direction
constexpr double kLeastError = 0.01;
constexpr double kMostTold = 1000.0;
constexpr double kMedianLength = 1.1774;  // of a vector of two normal numbers of deviation 1
constexpr double kHuber = 2.0;            // deviations from where on a fix weighs less
constexpr double kTukey = 4.685;          // and from where on nothing: 95 % as sure as least squares
constexpr int kRounds = 40;

using Plane = std::complex<double>;

struct Fix {
    Plane camera;        // from above, in the model's unit
    Plane place;         // metres
    double error = 0.0;  // metres
    double weight = 1.0;
};

// The library's own differs in the last bit from system to system.
double length_of(const Plane& v) {
    return std::sqrt(std::norm(v));
}

double radians(double degrees) {
    return degrees * (kPi / 180.0);
}

// Straight up from a place on the ellipsoid.
DVec3 up_at(const PhotoPlace& place) {
    const double latitude = radians(place.latitude), longitude = radians(place.longitude);
    const double level = portable::cos(latitude);
    return {level * portable::cos(longitude), level * portable::sin(longitude), portable::sin(latitude)};
}

// A place at the ellipsoid's height, in metres from the earth's middle. Altitudes are vague, and would change
// lengths by a part in 6000 for each kilometre.
DVec3 on_earth(const PhotoPlace& place) {
    constexpr double kSquared = kFlattening * (2.0 - kFlattening);
    const DVec3 up = up_at(place);
    const double across = kAxis / std::sqrt(1.0 - kSquared * up.z * up.z);
    return {across * up.x, across * up.y, across * (1.0 - kSquared) * up.z};
}

// Seen from above; right-handed, whichever way it is turned.
struct Above {
    DVec3 side{0.0};
    DVec3 other{0.0};
    DVec3 middle{0.0};

    Above(const DVec3& up, const DVec3& around)
        : side(any_perpendicular(up)), other(glm::cross(up, side)), middle(around) {}
    Plane operator()(const DVec3& p) const {
        return {glm::dot(p - middle, side), glm::dot(p - middle, other)};
    }
};

std::vector<Fix> fixes_of(std::span<const PlacedCamera> cameras, const DVec3& sky) {
    struct Shared {
        DVec3 cameras{0.0};
        double count = 0.0;
        PhotoPlace place;
    };
    std::map<std::pair<double, double>, Shared> shared;
    DVec3 up(0.0);
    for (const PlacedCamera& camera : cameras) {
        if (!is_finite(camera.centre)) continue;
        Shared& fix = shared[{camera.place.latitude, camera.place.longitude}];
        if (fix.count == 0.0) up += up_at(camera.place);
        if (fix.count == 0.0 || camera.place.error.value_or(0.0) > fix.place.error.value_or(0.0))
            fix.place = camera.place;
        fix.cameras += camera.centre;
        fix.count += 1.0;
    }
    std::vector<Fix> fixes;
    if (shared.empty()) return fixes;
    const PhotoPlace& first = shared.begin()->second.place;
    const Above earth(normalized_or(up, up_at(first)), on_earth(first));
    const Above model(sky, shared.begin()->second.cameras / shared.begin()->second.count);
    for (const auto& [ignored, fix] : shared)
        fixes.push_back({model(fix.cameras / fix.count), earth(on_earth(fix.place)),
                         std::clamp(fix.place.error.value_or(kUsualError), kLeastError, kMostTold)});
    return fixes;
}

// A turn and a scale, about two middles.
struct Fit {
    Plane by{0.0};
    Plane camera{0.0};
    Plane place{0.0};
    double spread = 0.0;  // of the cameras: the sum of their squares by what a fix is off

    // How far a fix is from where it would be, as a share of what it may be off.
    double off(const Fix& fix) const {
        return length_of(fix.place - place - by * (fix.camera - camera)) / fix.error;
    }
};

// Of least squares; nothing where the cameras stand in one place.
std::optional<Fit> fit_all(const std::vector<Fix>& fixes) {
    Fit fit;
    double sum = 0.0, size = 0.0;
    for (const Fix& fix : fixes) {
        const double weight = fix.weight / (fix.error * fix.error);
        sum += weight;
        fit.camera += weight * fix.camera;
        fit.place += weight * fix.place;
        size = std::max(size, length_of(fix.camera));
    }
    if (!(sum > 0.0)) return {};
    fit.camera /= sum;
    fit.place /= sum;
    for (const Fix& fix : fixes) {
        const double weight = fix.weight / (fix.error * fix.error);
        fit.by += weight * (fix.place - fit.place) * std::conj(fix.camera - fit.camera);
        fit.spread += weight * std::norm(fix.camera - fit.camera);
    }
    if (!(fit.spread > 1e-12 * sum * size * size)) return {};
    fit.by /= fit.spread;
    return fit;
}

// "7.4", "0.62": enough of a length to read.
std::string length_text(double metres) {
    char text[32];
    return {
        text,
        std::to_chars(text, text + sizeof text, metres, std::chars_format::fixed, metres < 1.0 ? 2 : 1).ptr};
}

}  // namespace

GpsScale fit_gps_scale(std::span<const PlacedCamera> cameras, const DVec3& sky) {
    std::vector<Fix> fixes = fixes_of(cameras, sky);
    GpsScale scale;
    scale.photos = cameras.size();
    scale.fixes = fixes.size();
    std::optional<Fit> fit = fit_all(fixes);
    if (!fit || fixes.size() < 3) return scale;
    const double count = static_cast<double>(fixes.size());
    // Huber's sum has a single least value, and from there Tukey's weights leave out what is far off.
    for (int round = 0; round < 2 * kRounds && fit; round++) {
        std::vector<double> offs;
        for (const Fix& fix : fixes)
            offs.push_back(fit->off(fix));
        const double usual =
            std::max(1.0, quantile(offs, 0.5) / kMedianLength * std::sqrt(count / (count - 2.0)));
        for (Fix& fix : fixes) {
            const double off = fit->off(fix) / usual, share = 1.0 - off * off / (kTukey * kTukey);
            fix.weight = round < kRounds ? kHuber / std::max(off, kHuber) : share > 0.0 ? share * share : 0.0;
        }
        fit = fit_all(fixes);
    }
    if (!fit) return scale;
    double weights = 0.0, squares = 0.0;
    for (const Fix& fix : fixes) {
        weights += fix.weight;
        squares += fix.weight * fit->off(fix) * fit->off(fix);
        scale.kept += fix.weight > 0.5;
    }
    if (weights < 3.0) return scale;
    // Of 2 numbers for each fix, less the 4 that were fitted; no fix is surer than it says.
    const double factor = std::max(1.0, squares / (2.0 * weights - 4.0));
    const double metres = length_of(fit->by), error = std::sqrt(factor / fit->spread);
    if (!(metres > 0.0) || !std::isfinite(metres) || !std::isfinite(error / metres)) return scale;
    scale.metres_per_unit = metres;
    scale.relative_error = error / metres;
    return scale;
}

GpsScale ask_gps(const PhotoModel& model, const std::string& folder, std::span<const DVec3> points,
                 const Progress* progress) {
    std::vector<PlacedCamera> cameras;
    for (const Photo& photo : model.photos) {
        if (progress) progress->check();
        const std::optional<PhotoPlace> place =
            read_photo_place(utf8_of(path_of(folder) / path_of(photo.name)));
        if (place) cameras.push_back({photo.centre(), *place});
    }
    GpsScale none;
    none.photos = cameras.size();
    if (cameras.empty()) return none;
    const std::optional<DVec3> sky = sky_of(model, points);
    none.level = sky.has_value();
    return sky ? fit_gps_scale(cameras, *sky) : none;
}

std::string gps_sentence(const GpsScale& scale, double height) {
    if (scale.usable())
        return "The size comes from the photos' GPS: " + length_text(height) + " m high, give or take " +
               length_text(height * scale.relative_error) +
               " m. The tree's height or one known length is better.";
    if (!scale.level)
        return "The photos' GPS does not tell the size, since the photos do not tell which way is up.";
    if (scale.fixes < GpsScale::kLeastFixes)
        return "The photos' GPS does not tell the size: of different places that they say they were taken "
               "at, " +
               std::to_string(GpsScale::kLeastFixes) + " are needed, and there are " +
               std::to_string(scale.fixes) + ".";
    return "The photos' GPS does not tell the size: it is too vague for a circle as small as theirs, or its "
           "places do not agree with the photos.";
}

}  // namespace treerec
