#include "photos/cameras_tell.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "file_bytes.h"
#include "geometry/portable_math.h"
#include "geometry/quantile.h"

namespace treerec {

namespace {

constexpr size_t kCompared = 48;  // photos whose pairs give guesses of the sky
constexpr double kLevel = 0.174;  // sine of 10 degrees: how far hands tilt a camera sideways
constexpr double kUpright = 0.5;  // cosine: further up or down than 60 degrees, a picture has no upright side
constexpr double kAgreeing = 0.6;  // of the photos
constexpr double kApart = 0.1;     // sine between two level lines that still give their plane
constexpr double kTurned = 0.05;   // of the level lines' second direction: less, and they are one line
constexpr int kPowers = 200;
constexpr double kSignShare = 0.1;     // of the photos: so many that were stored upright tell the sign
constexpr double kAround = 0.02;       // least determinant of the lines of sight, as a share of 1
constexpr double kInFront = 0.8;       // of the cameras
constexpr double kNearCameras = 0.25;  // share of the cameras
constexpr double kReach = 0.85;        // of their distance from the subject
constexpr double kOutermost = 0.02;    // share of the points that says nothing of the scene's reach
constexpr double kOneSide = 120.0;     // degrees of the circle
constexpr double kOneWay = 30.0;       // degrees between two cameras, where there is no subject

// A camera's axes in the model's coordinates: right, down and ahead in the picture as it is stored.
struct Pose {
    DVec3 right{0.0};
    DVec3 down{0.0};
    DVec3 ahead{0.0};
    DVec3 centre{0.0};
};

// A photo's lines as one sky sees them.
struct Seen {
    DVec3 level{0.0};
    double down = 0.0;  // the sky's share of `down`; 0 for a picture that was stored lying
    bool agrees = false;
};

Pose pose_of(const Photo& photo) {
    const DMat3 back = glm::transpose(photo.turn());
    return {back[0], back[1], back[2], photo.centre()};
}

std::vector<Pose> poses_of(const PhotoModel& model) {
    std::vector<Pose> poses;
    for (const Photo& photo : model.photos) {
        const Pose pose = pose_of(photo);
        if (is_finite(pose.right) && is_finite(pose.down) && is_finite(pose.centre)) poses.push_back(pose);
    }
    return poses;
}

Seen see(const Pose& pose, const DVec3& sky) {
    const double across = glm::dot(pose.right, sky);
    const double down = glm::dot(pose.down, sky);
    if (std::abs(across) < kLevel && std::abs(down) > kUpright) return {pose.right, down, true};
    if (std::abs(down) < kLevel && std::abs(across) > kUpright) return {pose.down, 0.0, true};
    return {};
}

// How well the photos agree with a sky: their number, and, where that is equal, that of those that were
// stored upright, as most are.
size_t agreement(const std::vector<Pose>& poses, const DVec3& sky) {
    size_t sum = 0;
    for (const Pose& pose : poses) {
        const Seen seen = see(pose, sky);
        if (seen.agrees) sum += poses.size() + 1 + (seen.down != 0.0 ? 1 : 0);
    }
    return sum;
}

// The unit vector that is most nearly perpendicular to all of `lines`, on the side of `guess`; nothing where
// these are one line: photos that all look the same way, or straight down from a flight to and fro.
std::optional<DVec3> perpendicular_to(const std::vector<DVec3>& lines, const DVec3& guess) {
    DMat3 scatter(0.0);
    for (const DVec3& line : lines)
        scatter += glm::outerProduct(line, line) / static_cast<double>(lines.size());
    // Powers of (largest possible - scatter) leave its least direction, and those of scatter its largest.
    DVec3 least = guess;
    DVec3 most = any_perpendicular(guess);
    for (int step = 0; step < kPowers; step++) {
        least = normalized_or(least - scatter * least, guess);
        most = normalized_or(scatter * most, most);
    }
    const DVec3 second = normalized_or(glm::cross(least, most), DVec3(0.0));
    if (glm::dot(second, scatter * second) < kTurned) return std::nullopt;
    return least;
}

// Positive where more of the scene stands on this side of the cameras than on the other.
double stands_above(const std::vector<Pose>& poses, std::span<const DVec3> points, const DVec3& sky) {
    if (points.empty()) return 0.0;
    double cameras = 0.0;
    for (const Pose& pose : poses)
        cameras += glm::dot(pose.centre, sky) / static_cast<double>(poses.size());
    std::vector<double> heights;
    heights.reserve(points.size());
    for (const DVec3& p : points)
        heights.push_back(glm::dot(p, sky) - cameras);
    return quantile(heights, 1.0 - kOutermost) + quantile(heights, kOutermost);
}

}  // namespace

std::optional<DVec3> sky_of(const PhotoModel& model, std::span<const DVec3> points) {
    const std::vector<Pose> poses = poses_of(model);
    if (poses.empty()) return std::nullopt;
    DVec3 mean(0.0);
    for (const Pose& pose : poses)
        mean -= pose.down;
    DVec3 best = normalized_or(mean, DVec3(0.0, -1.0, 0.0));
    size_t agreed = agreement(poses, best);
    const auto consider = [&](const DVec3& one, const DVec3& other) {
        const DVec3 normal = glm::cross(one, other);
        if (glm::length(normal) < kApart) return;
        const DVec3 sky = glm::normalize(normal);
        const size_t agrees = agreement(poses, sky);
        if (agrees <= agreed) return;
        agreed = agrees;
        best = sky;
    };
    const size_t stride = (poses.size() + kCompared - 1) / kCompared;
    for (size_t i = 0; i < poses.size(); i += stride)
        for (size_t j = 0; j < i; j += stride) {
            consider(poses[i].right, poses[j].right);
            consider(poses[i].down, poses[j].down);
            consider(poses[i].right, poses[j].down);
            consider(poses[i].down, poses[j].right);
        }

    std::vector<DVec3> level;
    double downs = 0.0;
    size_t stored_upright = 0;
    for (const Pose& pose : poses) {
        const Seen seen = see(pose, best);
        if (!seen.agrees) continue;
        level.push_back(seen.level);
        downs += seen.down;
        stored_upright += seen.down != 0.0;
    }
    const auto share = [&](size_t count) {
        return static_cast<double>(count) / static_cast<double>(poses.size());
    };
    if (level.empty() || share(level.size()) < kAgreeing) return std::nullopt;
    const std::optional<DVec3> sky = perpendicular_to(level, best);
    if (!sky) return std::nullopt;
    const double side = share(stored_upright) > kSignShare ? -downs : stands_above(poses, points, *sky);
    return side < 0.0 ? -*sky : *sky;
}

std::optional<DVec3> subject_of(const PhotoModel& model) {
    const std::vector<Pose> poses = poses_of(model);
    if (poses.size() < 2) return std::nullopt;
    DMat3 sum(0.0);
    DVec3 wanted(0.0);
    for (const Pose& pose : poses) {
        const DMat3 across = DMat3(1.0) - glm::outerProduct(pose.ahead, pose.ahead);
        sum += across / static_cast<double>(poses.size());
        wanted += across * pose.centre / static_cast<double>(poses.size());
    }
    if (!(glm::determinant(sum) > kAround)) return std::nullopt;
    const DVec3 subject = glm::inverse(sum) * wanted;
    if (!is_finite(subject)) return std::nullopt;
    const auto in_front = std::count_if(poses.begin(), poses.end(), [&](const Pose& pose) {
        return glm::dot(subject - pose.centre, pose.ahead) > 0.0;
    });
    if (static_cast<double>(in_front) < kInFront * static_cast<double>(poses.size())) return std::nullopt;
    return subject;
}

std::vector<CameraAround> cameras_around(const PhotoModel& model, std::span<const DVec3> points) {
    std::vector<CameraAround> around;
    const std::optional<DVec3> subject = subject_of(model);
    const std::optional<DVec3> sky = sky_of(model, points);
    if (!subject || !sky) return around;
    const DVec3 east = any_perpendicular(*sky), north = glm::cross(*sky, east);
    for (const Photo& photo : model.photos) {
        const DVec3 centre = pose_of(photo).centre, from_it = centre - *subject;
        const double angle = glm::degrees(portable::atan2(glm::dot(from_it, north), glm::dot(from_it, east)));
        if (std::isfinite(angle))
            around.push_back(
                {photo.name, angle < 0.0 ? angle + 360.0 : angle, away_from_line(centre, *subject, *sky)});
    }
    std::sort(around.begin(), around.end(), [](const CameraAround& a, const CameraAround& b) {
        return a.degrees != b.degrees ? a.degrees < b.degrees : a.name < b.name;
    });
    return around;
}

std::optional<CircleGap> widest_gap_of(std::span<const CameraAround> cameras) {
    if (cameras.size() < 2) return std::nullopt;
    CircleGap widest;
    for (size_t i = 0; i < cameras.size(); i++) {
        const size_t next = (i + 1) % cameras.size();
        const double gap = cameras[next].degrees - cameras[i].degrees + (next == 0 ? 360.0 : 0.0);
        if (gap > widest.degrees) widest = {gap, cameras[i].name, cameras[next].name};
    }
    return widest;
}

std::optional<double> one_sided_arc(const PhotoModel& model, std::span<const DVec3> points) {
    const auto less_than = [](double arc, double least) {
        return arc < least ? std::optional(arc) : std::nullopt;
    };
    if (const std::optional<CircleGap> gap = widest_gap_of(cameras_around(model, points)))
        return less_than(360.0 - gap->degrees, kOneSide);
    if (points.empty() || model.photos.empty()) return std::nullopt;
    const std::optional<DVec3> subject = subject_of(model);
    DVec3 middle = subject.value_or(DVec3(0.0));
    for (int axis = 0; axis < 3 && !subject; axis++) {
        std::vector<double> places;
        places.reserve(points.size());
        for (const DVec3& p : points)
            places.push_back(p[axis]);
        middle[axis] = quantile(places, 0.5);
    }
    const std::vector<Pose> poses = poses_of(model);
    double widest = 0.0;
    for (size_t i = 0; i < poses.size(); i++)
        for (size_t j = 0; j < i; j++)
            widest = std::max(widest, degrees_between(poses[i].centre - middle, poses[j].centre - middle));
    return less_than(widest, subject ? kOneSide : kOneWay);
}

double degrees_between(const DVec3& a, const DVec3& b) {
    const double cosine = glm::dot(a, b) / (glm::length(a) * glm::length(b));
    return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / kPi;
}

double away_from_line(const DVec3& p, const DVec3& on_line, const DVec3& direction) {
    const DVec3 way = p - on_line;
    return glm::length(way - glm::dot(way, direction) * direction);
}

double subject_reach(const PhotoModel& model, const DVec3& subject, const DVec3& sky) {
    std::vector<double> away;
    for (const Pose& pose : poses_of(model)) {
        away.push_back(away_from_line(pose.centre, subject, sky));
    }
    return away.empty() ? 0.0 : kReach * quantile(away, kNearCameras);
}

std::vector<std::string> photo_models_beside(const std::string& cloud_path) {
    const std::filesystem::path own = path_of(cloud_path).parent_path();
    const std::filesystem::path sparse = "sparse";
    std::vector<std::string> found;
    for (const std::filesystem::path& folder :
         {own, own / sparse, own / sparse / "0", own / ".." / sparse, own / ".." / sparse / "0"}) {
        std::error_code failure;
        for (const char* ending : {".bin", ".txt"}) {
            if (!std::filesystem::is_regular_file(folder / (std::string("cameras") + ending), failure) ||
                !std::filesystem::is_regular_file(folder / (std::string("images") + ending), failure))
                continue;
            found.push_back(utf8_of(folder));
            break;
        }
    }
    return found;
}

}  // namespace treerec
