#include "synth/scan_view.h"

#include <algorithm>
#include <cmath>

#include "error.h"
#include "geometry/portable_math.h"

namespace treerec {

namespace {

constexpr size_t kMostBeams = 40'000'000;  // per station
constexpr int kOccluders = 600;            // at most, per station
constexpr double kRimShare = 0.4;          // of the beam's radius: so far beside a surface it still echoes
constexpr double kMixedGap = 0.03;         // metres between two surfaces that make two echoes
constexpr double kPulse = 1.0;             // metres: echoes farther apart are told from each other
constexpr double kGrazing = 0.25;          // range noise per beam radius and tangent of the incidence
constexpr double kSteepest = 5.0;          // that tangent's limit

struct Touch {
    double range = -1.0;  // below zero: none
    bool rim = false;
};

// Where a ray from `eye` along the unit direction enters the cone's side, or passes it within the beam's rim.
Touch touch_cone(const Surface& wood, const DVec3& eye, const DVec3& direction, const Beam& beam) {
    const DVec3 along = wood.to - wood.from;
    const double length = glm::length(along);
    const DVec3 axis = along / length;
    const double taper = (wood.to_radius - wood.from_radius) / length;
    // |q - (q.a) a| = r0 + taper (q.a) for q = eye + t direction - from.
    const DVec3 offset = eye - wood.from;
    const double offset_along = glm::dot(offset, axis);
    const double direction_along = glm::dot(direction, axis);
    const DVec3 offset_across = offset - offset_along * axis;
    const DVec3 direction_across = direction - direction_along * axis;
    const double start_radius = wood.from_radius + taper * offset_along;
    const double a =
        glm::dot(direction_across, direction_across) - taper * taper * direction_along * direction_along;
    const double b = glm::dot(offset_across, direction_across) - start_radius * taper * direction_along;
    const double c = glm::dot(offset_across, offset_across) - start_radius * start_radius;
    const double root = b * b - a * c;
    if (a <= 1e-15) return {};
    const double t = (-b - std::sqrt(std::max(0.0, root))) / a;
    const double at = offset_along + t * direction_along;
    if (t <= 0.0 || at < 0.0 || at > length) return {};
    if (root >= 0.0) return {t, false};
    const double gap = glm::length(offset_across + t * direction_across) - (wood.from_radius + taper * at);
    if (gap > kRimShare * beam.radius(t)) return {};
    return {t, true};
}

Touch touch_disc(const Surface& leaf, const DVec3& eye, const DVec3& direction, const Beam& beam) {
    const double facing = glm::dot(direction, leaf.to);
    if (std::abs(facing) < 1e-6) return {};
    const double t = glm::dot(leaf.from - eye, leaf.to) / facing;
    if (t <= 0.0) return {};
    const double gap = glm::distance(eye + t * direction, leaf.from) - leaf.from_radius;
    if (gap > kRimShare * beam.radius(t)) return {};
    return {t, gap > 0.0};
}

// The tangent of the angle between the beam and the surface's normal where it was hit.
double incidence(const Surface& surface, const DVec3& hit, const DVec3& direction) {
    DVec3 normal = surface.to;
    if (surface.shape == Shape::kCone) {
        const DVec3 axis = glm::normalize(surface.to - surface.from);
        const DVec3 out = hit - surface.from;
        normal = normalized_or(out - glm::dot(out, axis) * axis, -direction);
    }
    const double cosine = std::abs(glm::dot(normal, direction));
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    return sine < kSteepest * cosine ? sine / cosine : kSteepest;
}

}  // namespace

ScanView::ScanView(const DVec3& eye, const DVec3& towards, double step, const Beam& beam,
                   const Bounds& bounds)
    : eye_(eye), step_(step), beam_(beam) {
    forward_ = glm::normalize(DVec3(towards.x - eye.x, 0.0, towards.z - eye.z));
    right_ = glm::cross(forward_, DVec3(0.0, 1.0, 0.0));
    double low_azimuth = kPi, high_azimuth = -kPi;
    for (int corner = 0; corner < 8; corner++) {
        const DVec3 p(corner & 1 ? bounds.max.x : bounds.min.x, corner & 2 ? bounds.max.y : bounds.min.y,
                      corner & 4 ? bounds.max.z : bounds.min.z);
        const DVec2 angles = angles_to(p);
        low_azimuth = std::min(low_azimuth, angles.x);
        high_azimuth = std::max(high_azimuth, angles.x);
    }
    // The elevation is largest where the tree is nearest: bounded by the height over the least distance.
    const double near = std::max(0.5, glm::length(DVec2(towards.x - eye.x, towards.z - eye.z)) -
                                          0.5 * glm::length(DVec2(bounds.size().x, bounds.size().z)));
    const double high_elevation = portable::atan2(std::max(0.1, bounds.max.y - eye.y), near);
    const double low_elevation = portable::atan2(std::min(-0.1, bounds.min.y - eye.y), near);
    azimuth_ = low_azimuth - step;
    elevation_ = low_elevation - step;
    columns_ = static_cast<int>((high_azimuth - low_azimuth) / step) + 3;
    rows_ = static_cast<int>((high_elevation - low_elevation) / step) + 3;
    if (static_cast<size_t>(columns_) * static_cast<size_t>(rows_) > kMostBeams)
        throw Error("The virtual scan would need too many beams; ask for fewer points.");
    cells_.assign(static_cast<size_t>(columns_) * static_cast<size_t>(rows_), Cell());
}

void ScanView::draw(const Surface& surface, int32_t number) {
    // The angular box of the surface's bounding balls.
    double low_column = 1e9, high_column = -1e9, low_row = 1e9, high_row = -1e9;
    const auto include = [&](const DVec3& p, double surface_radius) {
        const DVec2 angles = angles_to(p);
        const double range = glm::distance(p, eye_);
        const double radius = surface_radius + kRimShare * beam_.radius(range);
        const double reach = portable::asin(radius / std::max(range, 1.01 * radius));
        // Meridians draw together towards the zenith.
        const double azimuth_reach =
            std::abs(angles.y) + reach < 1.5 ? reach / portable::cos(std::abs(angles.y) + reach) : kPi;
        low_column = std::min(low_column, angles.x - azimuth_reach);
        high_column = std::max(high_column, angles.x + azimuth_reach);
        low_row = std::min(low_row, angles.y - reach);
        high_row = std::max(high_row, angles.y + reach);
    };
    const bool cone = surface.shape == Shape::kCone;
    include(surface.from, surface.from_radius);
    if (cone) include(surface.to, surface.to_radius);
    const auto clamp_to = [](double value, int count) {
        return static_cast<int>(std::clamp(value, 0.0, count - 1.0));
    };
    const int first_column = clamp_to((low_column - azimuth_) / step_, columns_);
    const int last_column = clamp_to((high_column - azimuth_) / step_ + 1.0, columns_);
    const int first_row = clamp_to((low_row - elevation_) / step_, rows_);
    const int last_row = clamp_to((high_row - elevation_) / step_ + 1.0, rows_);
    for (int row = first_row; row <= last_row; row++)
        for (int column = first_column; column <= last_column; column++) {
            const DVec3 direction = direction_of(column, row);
            const Touch touch = cone ? touch_cone(surface, eye_, direction, beam_)
                                     : touch_disc(surface, eye_, direction, beam_);
            if (touch.range < 0.0) continue;
            Cell& cell = cells_[index(column, row)];
            Hit& hit = touch.rim ? cell.rim : cell.middle;
            const float range = static_cast<float>(touch.range);
            if (range < hit.range) hit = {range, number};
        }
}

void ScanView::occlude(double share, Random& random) {
    if (share <= 0.0) return;
    const size_t wanted = static_cast<size_t>((1.0 - share) * static_cast<double>(returns()));
    size_t left = returns();
    for (int i = 0; i < kOccluders && left > wanted; i++) {
        const double centre_column = random.uniform() * columns_;
        const double centre_row = random.uniform() * rows_;
        const double radius = glm::radians(random.uniform(0.6, 2.5)) / step_;
        for (int row = std::max(0, static_cast<int>(centre_row - radius));
             row < std::min<double>(rows_, centre_row + radius); row++)
            for (int column = std::max(0, static_cast<int>(centre_column - radius));
                 column < std::min<double>(columns_, centre_column + radius); column++) {
                const double dx = column - centre_column, dy = row - centre_row;
                Cell& cell = cells_[index(column, row)];
                if (cell.empty() || dx * dx + dy * dy > radius * radius) continue;
                cell = Cell();
                left--;
            }
    }
}

size_t ScanView::returns() const {
    return static_cast<size_t>(
        std::count_if(cells_.begin(), cells_.end(), [](const Cell& cell) { return !cell.empty(); }));
}

void ScanView::collect(const std::vector<Surface>& surfaces, double noise, double mixed, Random& random,
                       std::vector<ScanReturn>& out) const {
    for (int row = 0; row < rows_; row++)
        for (int column = 0; column < columns_; column++) {
            const Cell& cell = cells_[index(column, row)];
            if (cell.empty()) continue;
            const double dice = random.uniform();
            const double share = random.uniform();
            const double deviation = random.normal();
            const DVec3 direction = direction_of(column, row);
            Hit hit = cell.middle;
            double range = hit.range;
            bool between = false;
            if (cell.rim.range < cell.middle.range) {
                const double gap = static_cast<double>(cell.middle.range) - cell.rim.range;
                between = gap > kMixedGap && gap < kPulse && dice < mixed;
                // Otherwise the stronger echo counts, which is either one's.
                const bool nearer = cell.middle.range == kNothing || gap <= kMixedGap || share < 0.5;
                if (between || nearer) {
                    hit = cell.rim;
                    range = hit.range + (between ? share * gap : 0.0);
                }
            }
            const double tangent =
                incidence(surfaces[static_cast<size_t>(hit.surface)], eye_ + range * direction, direction);
            const double grazing = kGrazing * beam_.radius(range) * tangent;
            range += std::sqrt(noise * noise + grazing * grazing) * deviation;
            out.push_back({eye_ + range * direction, hit.surface, between});
        }
}

DVec2 ScanView::angles_to(const DVec3& p) const {
    const DVec3 d = p - eye_;
    const double ahead = glm::dot(d, forward_), aside = glm::dot(d, right_);
    return {portable::atan2(aside, ahead), portable::atan2(d.y, portable::hypot(ahead, aside))};
}

DVec3 ScanView::direction_of(int column, int row) const {
    const double azimuth = azimuth_ + column * step_, elevation = elevation_ + row * step_;
    return portable::cos(elevation) * (portable::cos(azimuth) * forward_ + portable::sin(azimuth) * right_) +
           DVec3(0.0, portable::sin(elevation), 0.0);
}

}  // namespace treerec
