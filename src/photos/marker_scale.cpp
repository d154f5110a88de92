#include "photos/marker_scale.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "photos/cameras_tell.h"
#include "photos/marker_outlines.h"

namespace treerec {

namespace {

constexpr double kMostOff = 0.0025;  // of a picture's longer side, a corner may be beside where it should be
constexpr double kLeastOff = 1.5;    // pixels
constexpr size_t kMostPairs = 2000;  // of photos that are tried

// A photo's corners as lines of sight.
struct Sight {
    const Photo* photo = nullptr;
    const Camera* camera = nullptr;
    std::array<DVec2, 4> corners{};
    std::array<DVec3, 4> rays{};  // unit vectors in the model
    DVec3 centre{0.0};
};

using Square = std::array<DVec3, 4>;

std::optional<Sight> sight_of(const PhotoModel& model, size_t index, const FoundMarker& marker) {
    Sight sight;
    sight.photo = &model.photos[index];
    sight.camera = &model.cameras[static_cast<size_t>(sight.photo->camera)];
    sight.corners = marker.corners;
    sight.centre = sight.photo->centre();
    const DMat3 to_world = glm::transpose(sight.photo->turn());
    for (size_t k = 0; k < 4; k++) {
        const std::optional<DVec3> ray = sight.camera->ray(marker.corners[k]);
        if (!ray) return {};
        sight.rays[k] = glm::normalize(to_world * *ray);
    }
    return sight;
}

// The places nearest to the lines of sight. A pixel is a wider step farther away: weighed by that, from the
// second round on, it is the pixels' squares that are least.
bool intersect(std::span<const Sight* const> sights, Square& square) {
    for (size_t k = 0; k < 4; k++) {
        DVec3 place(0.0);
        for (int round = 0; round < 3; round++) {
            DMat3 left(0.0);
            DVec3 right(0.0);
            for (const Sight* sight : sights) {
                const DVec3& ray = sight->rays[k];
                double weight = sight->camera->focal_length() * sight->camera->focal_length();
                if (round > 0) {
                    const DVec3 way = place - sight->centre;
                    weight /= std::max(glm::dot(way, way), 1e-300);
                }
                const DMat3 across = (DMat3(1.0) - glm::outerProduct(ray, ray)) * weight;
                left += across;
                right += across * sight->centre;
            }
            const double size = left[0][0] + left[1][1] + left[2][2];
            if (!(std::abs(glm::determinant(left)) > 1e-9 * size * size * size)) return false;
            place = glm::inverse(left) * right;
        }
        if (!is_finite(place)) return false;
        square[k] = place;
    }
    return true;
}

// The farthest that a corner is from where it should be, by how far it may be.
double off_by(const Sight& sight, const Square& square) {
    double most = 0.0;
    for (size_t k = 0; k < 4; k++) {
        const auto at = sight.camera->project(sight.photo->to_camera(square[k]));
        if (!at) return INFINITY;
        most = std::max(most, glm::distance(*at, sight.corners[k]));
    }
    return most / std::max(kLeastOff, kMostOff * std::max(sight.camera->width, sight.camera->height));
}

double angle_between(const Sight& a, const Sight& b, const DVec3& place) {
    return degrees_between(place - a.centre, place - b.centre);
}

std::vector<const Sight*> agreeing(const std::vector<Sight>& sights, const Square& square, double& sum) {
    std::vector<const Sight*> kept;
    sum = 0.0;
    for (const Sight& sight : sights)
        if (const double off = off_by(sight, square); off <= 1.0) {
            kept.push_back(&sight);
            sum += off;
        }
    return kept;
}

// Of all pairs of photos, the one that most others agree with.
std::vector<const Sight*> largest_agreement(const std::vector<Sight>& sights) {
    std::vector<const Sight*> best;
    double best_sum = INFINITY;
    const size_t pairs = sights.size() * (sights.size() - 1) / 2;
    const size_t step = pairs / kMostPairs + 1;
    size_t count = 0;
    for (size_t j = 1; j < sights.size(); j++)
        for (size_t i = 0; i < j; i++) {
            if (count++ % step != 0) continue;
            const std::array<const Sight*, 2> pair = {&sights[i], &sights[j]};
            Square square;
            if (!intersect(pair, square)) continue;
            if (angle_between(sights[i], sights[j], square[0]) < 0.5 * MarkerScale::kLeastParallax) continue;
            double sum = 0.0;
            std::vector<const Sight*> kept = agreeing(sights, square, sum);
            if (kept.size() < best.size() || (kept.size() == best.size() && !(sum < best_sum))) continue;
            best = std::move(kept);
            best_sum = sum;
        }
    return best;
}

void measure_sides(MeasuredMarker& marker) {
    std::array<double, 6> lengths{};
    double sum = 0.0;
    for (size_t k = 0; k < 4; k++) {
        lengths[k] = glm::distance(marker.corners[k], marker.corners[(k + 1) % 4]);
        sum += lengths[k];
    }
    for (const size_t k : {0, 1})
        lengths[4 + k] = glm::distance(marker.corners[k], marker.corners[k + 2]) / std::sqrt(2.0);
    marker.side = 0.25 * sum;
    double squares = 0.0;
    for (const double length : lengths)
        squares += (length - marker.side) * (length - marker.side);
    marker.bent = 0.5 *
                  glm::length(marker.corners[0] + marker.corners[2] - marker.corners[1] - marker.corners[3]) /
                  marker.side;
    marker.uneven = std::sqrt(squares / static_cast<double>(lengths.size())) / marker.side;
}

std::string percent(double share) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, 100.0 * share, std::chars_format::fixed,
                                share < 0.095 ? 1 : 0)
                      .ptr};
}

MeasuredMarker measure(int id, const std::vector<Sight>& sights) {
    MeasuredMarker marker;
    marker.id = id;
    marker.photos = sights.size();
    if (sights.size() < MarkerScale::kLeastPhotos) {
        marker.why_not = "The marker " + std::to_string(id) +
                         " tells no size: it is in one photo alone, and two are needed at least.";
        return marker;
    }
    std::vector<const Sight*> kept = largest_agreement(sights);
    double sum = 0.0;
    // Once more with all that agree, as these have it together.
    for (int round = 0; round < 2 && kept.size() >= MarkerScale::kLeastPhotos; round++) {
        if (!intersect(kept, marker.corners))
            kept.clear();
        else if (round == 0)
            kept = agreeing(sights, marker.corners, sum);
    }
    marker.kept = kept.size();
    for (size_t j = 1; j < kept.size(); j++)
        for (size_t i = 0; i < j; i++)
            marker.parallax = std::max(marker.parallax, angle_between(*kept[i], *kept[j], marker.corners[0]));
    if (kept.size() < MarkerScale::kLeastPhotos) {
        marker.why_not = "The marker " + std::to_string(id) +
                         " tells no size: the photos that show it do not agree on where it is, or were taken "
                         "from one side. It must not move, and no other one may be like it.";
        return marker;
    }
    measure_sides(marker);
    if (marker.parallax < MarkerScale::kLeastParallax)
        marker.why_not = "The marker " + std::to_string(id) +
                         " tells no size: the photos that show it were taken from too near to each other. "
                         "Take more of them, from both sides.";
    else if (!(std::max(marker.uneven, marker.bent) <= MarkerScale::kMostUneven))
        marker.why_not = "The marker " + std::to_string(id) +
                         " tells no size: in the photos it is no square. It has to lie flat, and to stay "
                         "where it is.";
    return marker;
}

// The median of the sides by photos, and how far they are spread.
void join(MarkerScale& scale) {
    std::vector<const MeasuredMarker*> usable;
    double all = 0.0;
    for (const MeasuredMarker& marker : scale.markers)
        if (marker.usable()) {
            usable.push_back(&marker);
            all += static_cast<double>(marker.kept);
        }
    if (usable.empty()) return;
    std::stable_sort(usable.begin(), usable.end(),
                     [](const auto* a, const auto* b) { return a->side < b->side; });
    double below = 0.0;
    const MeasuredMarker* middle = usable.back();
    for (const MeasuredMarker* marker : usable) {
        below += static_cast<double>(marker->kept);
        if (below < 0.5 * all) continue;
        middle = marker;
        break;
    }
    scale.units_per_side = middle->side;
    double squares = 0.0;
    for (const MeasuredMarker* marker : usable) {
        const double off = marker->side / middle->side - 1.0;
        squares += static_cast<double>(marker->kept) * (off * off + marker->uneven * marker->uneven);
    }
    scale.spread = std::sqrt(squares / all);
}

}  // namespace

MarkerScale measure_markers(const PhotoModel& model, std::span<const PhotoMarkers> seen, double side) {
    MarkerScale scale;
    scale.told_side = side;
    std::map<int, std::vector<Sight>> sights;
    for (const PhotoMarkers& photo : seen) {
        scale.photos += !photo.markers.empty();
        std::map<int, size_t> times;
        for (const FoundMarker& marker : photo.markers)
            times[marker.id]++;
        for (const FoundMarker& marker : photo.markers) {
            std::vector<Sight>& of_id = sights[marker.id];
            // Of two alike it is not known which is which.
            if (times[marker.id] > 1) continue;
            if (const std::optional<Sight> sight = sight_of(model, photo.photo, marker))
                of_id.push_back(*sight);
        }
    }
    for (const auto& [id, of_id] : sights)
        scale.markers.push_back(measure(id, of_id));
    std::erase_if(scale.markers, [](const MeasuredMarker& marker) { return marker.photos == 0; });
    join(scale);
    return scale;
}

std::string marker_sentence(const MarkerScale& scale, bool told) {
    std::string ids;
    size_t usable = 0, photos = 0;
    for (const MeasuredMarker& marker : scale.markers)
        if (marker.usable()) {
            ids += (usable++ == 0 ? "" : ", ") + std::to_string(marker.id);
            photos = std::max(photos, marker.kept);
        }
    if (scale.told_side > 0.0) {
        if (usable > 0) return {};
        if (scale.markers.empty())
            return scale.unreadable > 0
                       ? "No photo shows a marker whose size was told, and " +
                             std::to_string(scale.unreadable) + " of them could not be looked at for one."
                       : "No photo shows a marker whose size was told. It is one of ArUco's DICT_4X4_50, and "
                         "two photos or more must show all of it, at least 24 pixels wide, with white around "
                         "it.";
        // What is said of the one that is seen most.
        const auto most = std::max_element(
            scale.markers.begin(), scale.markers.end(),
            [](const MeasuredMarker& a, const MeasuredMarker& b) { return a.photos < b.photos; });
        return most->why_not;
    }
    if (usable == 0 || told) return {};
    return "A printed marker (id " + ids + ") is in " + std::to_string(photos) +
           " photos: with the side of its black square (--marker) the tree gets its size by it.";
}

std::string disagreement(const std::string& one, double scale, const std::string& other, double other_scale) {
    constexpr double kMost = 0.05;
    if (!(scale > 0.0) || !(other_scale > 0.0)) return {};
    const double by = scale / other_scale - 1.0;
    if (std::abs(by) <= kMost) return {};
    const std::string percents = percent(std::abs(by));
    return by > 0.0 ? "By " + one + ", the tree is " + percents + " % higher than by " + other +
                          "; the former was taken."
                    : "By " + one + ", the tree is " + percents + " % lower than by " + other +
                          "; the former was taken.";
}

}  // namespace treerec
