#include "scan/scale.h"

#include <charconv>
#include <cmath>

#include "error.h"
#include "geometry/portable_math.h"
#include "scan/robust.h"

namespace treerec {

namespace {

constexpr double kShortestTree = 0.3;  // metres
constexpr double kTallestTree = 120.0;
constexpr double kTypicalTree = 10.0;
constexpr double kFoot = 0.3048;
constexpr double kTallestInKilometres = 0.06;  // higher ones are rather models without a scale

// Four digits.
std::string short_number(double value) {
    char text[32];
    const bool whole = value >= 1000.0 && value < 1e15;
    const std::to_chars_result end =
        whole ? std::to_chars(text, text + sizeof(text), value, std::chars_format::fixed, 0)
              : std::to_chars(text, text + sizeof(text), value, std::chars_format::general, 4);
    return {text, end.ptr};
}

struct Unit {
    std::string name;
    double metres;
};

// Metres if that makes a tree of it, else the unit that does and comes closest to a typical one; where none
// does, the scan has no scale, and a power of ten makes it about as high as a typical tree. Maps are in
// metres or feet.
Unit guess_unit(double height, bool on_map) {
    const auto is_tree = [&](double metres) {
        return height * metres >= kShortestTree && height * metres <= kTallestTree;
    };
    const auto error = [&](double metres) { return std::abs(portable::log(height * metres / kTypicalTree)); };
    if (is_tree(1.0) || !(height > 0.0)) return {"metres", 1.0};
    if (on_map && is_tree(kFoot)) return {"feet", kFoot};
    Unit best{"", 0.0};
    if (height <= kTallestInKilometres && is_tree(1000.0)) return {"kilometres", 1000.0};
    for (const Unit& unit : {Unit{"centimetres", 0.01}, Unit{"millimetres", 0.001}, Unit{"feet", kFoot}})
        if (is_tree(unit.metres) && (best.metres == 0.0 || error(unit.metres) < error(best.metres)))
            best = unit;
    if (best.metres > 0.0) return best;
    const double metres = portable::pow(10.0, std::round(portable::log10(kTypicalTree / height)));
    return {short_number(metres) + " m each", metres};
}

bool is_length(double metres) {
    return std::isfinite(metres) && metres > 0.0;
}

// The scale that the user gives, or 0.
double given_scale(double height, const OrientOptions& options) {
    if (options.metres_per_unit.has_value() + options.known_height.has_value() +
            options.known_length.has_value() >
        1)
        throw Error("Set the scale by one thing only: metres per unit, the tree's height, or one length.");
    if (options.metres_per_unit) {
        if (!is_length(*options.metres_per_unit))
            throw Error("The scale must be a positive number of metres per unit.");
        return *options.metres_per_unit;
    }
    if (options.known_height) {
        if (!is_length(*options.known_height))
            throw Error("The tree's known height must be a positive number of metres.");
        if (!(height > 0.0)) throw Error("A cloud without any height cannot be scaled to a known height.");
        return *options.known_height / height;
    }
    if (options.known_length) {
        const KnownLength& known = *options.known_length;
        const double units = glm::distance(known.from, known.to);
        if (!is_length(known.metres)) throw Error("The known length must be a positive number of metres.");
        if (!is_length(units))
            throw Error("The two ends of the known length must be different points of the scan.");
        return known.metres / units;
    }
    return 0.0;
}

}  // namespace

void set_scale(double height, bool on_map, const ScanUnit& told, const OrientOptions& options,
               OrientReport& report) {
    report.metres_per_unit = given_scale(height, options);
    if (report.metres_per_unit == 0.0 && told.metres > 0.0) {
        report.metres_per_unit = told.metres;
        report.scale_guessed = told.assumed;
        if (!told.doubt.empty()) report.warnings.push_back(told.doubt);
    } else if (report.metres_per_unit == 0.0) {
        const Unit unit = guess_unit(height, on_map);
        report.metres_per_unit = unit.metres;
        report.scale_guessed = true;
        report.scale_unknown = unit.name.ends_with(" each") || report.photos > 0;
        if (unit.metres != 1.0) {
            report.warnings.push_back("The cloud is " + short_number(height) +
                                      " units high; they were taken for " + unit.name +
                                      ". Set the scale or one known length by hand if that is wrong.");
        } else if (report.photos > 0) {
            report.warnings.push_back(
                "The cloud was made of photos, which have no scale of their own; its units were taken for "
                "metres, which makes it " +
                short_number(height) +
                " m high. If that is wrong, give the tree's height or one known length.");
        } else if (report.up_detected && report.up != UpAxis::kZ) {
            // Photos give no size; what photogrammetry writes is near 1 or as the user set it.
            report.scale_unknown = true;
            report.warnings.push_back(
                "A cloud with " + std::string(up_axis_name(report.up)) +
                " up comes from photos as a rule, and those have no scale of their own; its units were taken "
                "for metres, which makes it " +
                short_number(height) +
                " m high. If that is wrong, give the tree's height or one known length.");
        }
    }
    const double metres = height * report.metres_per_unit;
    if (metres > 0.0 && (metres < kShortestTree || metres > kTallestTree))
        report.warnings.push_back("The cloud is " + short_number(metres) +
                                  " m high, which is odd for a tree; check the scale and the up axis.");
}

void settle_height(PointCloud& cloud, const OrientOptions& options, OrientReport& report) {
    if (!options.known_height || cloud.empty()) return;
    const Range range = robust_ranges(cloud.positions)[1];
    if (!(range.size() > 0.0)) return;
    const double factor = *options.known_height / range.size();
    for (Vec3& p : cloud.positions)
        p = Vec3(DVec3(p) * factor);
    for (float& radius : cloud.radii)
        radius *= static_cast<float>(factor);
    cloud.frame.metres_per_unit *= factor;
    report.metres_per_unit = cloud.frame.metres_per_unit;
}

}  // namespace treerec
