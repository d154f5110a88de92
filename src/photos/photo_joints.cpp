#include "photos/photo_joints.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "photos/pair_geometry.h"

namespace treerec {

namespace {

constexpr double kTolerance = 4.0;  // pixels: COLMAP's --TwoViewGeometry.max_error
// Of models that were right, neighbours' own geometry had 1.6 times as many matches at most, where leaves
// move; of a bent one 4 times.
constexpr double kTimes = 2.0;
constexpr size_t kSteps = 2;  // photos that are so far apart around the circle are neighbours
constexpr size_t kLeastMatches = 30;
constexpr double kWindow = 60.0;     // degrees: further around, a trunk shows other bark
constexpr size_t kLeastPoints = 30;  // COLMAP's --Mapper.abs_pose_min_num_inliers
constexpr size_t kLeastCameras = 4;

using NamePair = std::pair<std::string, std::string>;

NamePair in_order(const std::string& a, const std::string& b) {
    return a < b ? NamePair(a, b) : NamePair(b, a);
}

std::set<NamePair> neighbours_of(const PhotoModel& model, std::span<const CameraAround> around) {
    std::set<NamePair> pairs;
    for (size_t i = 0; i + 1 < model.photos.size(); i++)
        pairs.insert(in_order(model.photos[i].name, model.photos[i + 1].name));
    for (size_t i = 0; i < around.size(); i++)
        for (size_t step = 1; step <= kSteps; step++) {
            const std::string& next = around[(i + step) % around.size()].name;
            if (next != around[i].name) pairs.insert(in_order(around[i].name, next));
        }
    return pairs;
}

// Of the model, for ways (x, y, 1) in the cameras' own coordinates: other' E one = 0; all 0 for two cameras
// in one place.
DMat3 essential_of(const Photo& one, const Photo& other) {
    const DMat3 turn = other.turn() * glm::transpose(one.turn());
    const DVec3 shift = other.translation - turn * one.translation;
    const double length = glm::length(shift);
    if (!(length > 0.0)) return DMat3(0.0);
    const DVec3 t = shift / length;
    return DMat3(0.0, t.z, -t.y, -t.z, 0.0, t.x, t.y, -t.x, 0.0) * turn;
}

}  // namespace

std::vector<PhotoContradiction> contradictions_in(const PhotoModel& model,
                                                  std::span<const CameraAround> around,
                                                  std::span<const PhotoPlaceMatches> matches,
                                                  std::span<const std::string> names,
                                                  const Progress* progress) {
    const std::set<NamePair> neighbours = neighbours_of(model, around);
    std::map<std::string, const Photo*> photos;
    for (const Photo& photo : model.photos)
        photos[photo.name] = &photo;
    std::vector<PhotoContradiction> found;
    for (const PhotoPlaceMatches& pair : matches) {
        if (progress) progress->check();
        const std::string &name = names[pair.one], &other_name = names[pair.other];
        if (!neighbours.count(in_order(name, other_name))) continue;
        const auto one = photos.find(name), other = photos.find(other_name);
        if (one == photos.end() || other == photos.end()) continue;
        const Camera &lens = model.cameras[static_cast<size_t>(one->second->camera)],
                     &other_lens = model.cameras[static_cast<size_t>(other->second->camera)];
        std::vector<PlacePair> ways;
        for (const PlaceMatch& match : pair.matches) {
            const auto here = lens.ray(match.one), there = other_lens.ray(match.other);
            if (here && there) ways.push_back({DVec2(*here), DVec2(*there)});
        }
        const double focal = 0.5 * (lens.focal_length() + other_lens.focal_length());
        if (ways.size() < kLeastMatches || !(focal > 0.0)) continue;
        const double tolerance = kTolerance / focal;
        const DMat3 essential = essential_of(*one->second, *other->second);
        const auto fitting =
            static_cast<size_t>(std::count_if(ways.begin(), ways.end(), [&](const PlacePair& way) {
                return squared_sampson(essential, way) < tolerance * tolerance;
            }));
        const auto asked = static_cast<size_t>(std::ceil(kTimes * static_cast<double>(fitting)));
        if (asked > ways.size()) continue;
        const std::vector<uint8_t> agreeing = agreeing_on_geometry(ways,
                                                                   {.tolerance = tolerance,
                                                                    .least = std::max(asked, kLeastMatches),
                                                                    .least_share = 0.0,
                                                                    .calibrated = true},
                                                                   progress);
        const auto own = static_cast<size_t>(std::count(agreeing.begin(), agreeing.end(), uint8_t{1}));
        if (own > 0) found.push_back({name, other_name, ways.size(), fitting, own});
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.own - a.fitting > b.own - b.fitting; });
    return found;
}

std::vector<PhotoJoint> joints_around(const PhotoModel& model, std::span<const CameraAround> around,
                                      std::span<const SparsePoint> points, const Progress* progress) {
    const size_t count = around.size();
    if (count < kLeastCameras) return {};
    std::map<std::string, size_t> places;
    for (size_t i = 0; i < count; i++)
        places[around[i].name] = i;
    std::map<uint32_t, size_t> place_of;  // around, by COLMAP's number of a photo
    for (const Photo& photo : model.photos)
        if (const auto place = places.find(photo.name); place != places.end())
            place_of[photo.number] = place->second;
    std::vector<std::vector<size_t>> seeing;  // of each point that several of them see
    for (const SparsePoint& point : points) {
        std::vector<size_t> by;
        for (const uint32_t number : point.photos)
            if (const auto place = place_of.find(number); place != place_of.end())
                by.push_back(place->second);
        if (by.size() > 1) seeing.push_back(std::move(by));
    }
    if (seeing.empty()) return {};
    // Degrees from one direction on to another.
    const auto ahead = [](double from, double to) { return to < from ? to - from + 360.0 : to - from; };
    std::vector<PhotoJoint> joints;
    for (size_t i = 0; i < count; i++) {
        if (progress) progress->check();
        const CameraAround &from = around[i], &to = around[(i + 1) % count];
        std::vector<uint8_t> side(count, 0);
        for (size_t k = 0; k < count; k++) {
            if (ahead(to.degrees, around[k].degrees) <= kWindow) side[k] = 2;
            if (k != (i + 1) % count && ahead(around[k].degrees, from.degrees) <= kWindow) side[k] = 1;
        }
        PhotoJoint joint{from.name, to.name, ahead(from.degrees, to.degrees), 0};
        for (const std::vector<size_t>& by : seeing) {
            int sides = 0;
            for (const size_t k : by)
                sides |= side[k];
            joint.points += sides == 3;
        }
        joints.push_back(joint);
    }
    return joints;
}

std::vector<PhotoJoint> weak_joints(std::vector<PhotoJoint> joints) {
    std::stable_sort(joints.begin(), joints.end(),
                     [](const PhotoJoint& a, const PhotoJoint& b) { return a.points < b.points; });
    size_t weak = 0;
    while (weak < joints.size() && joints[weak].points + joints[0].points < 2 * kLeastPoints)
        weak++;
    if (weak < 2) return {};
    joints.resize(weak);
    return joints;
}

}  // namespace treerec
