// Clouds and files for the tests of scan/.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "error.h"
#include "geometry/random.h"
#include "scan/cleaning/clean_cloud.h"
#include "scan/formats/read_cloud.h"
#include "scan/point_cloud.h"

#ifdef _WIN32
#include <process.h>
#define getpid _getpid
#else
#include <unistd.h>
#endif

namespace treerec::scan_test {

// A folder that goes away with its files.
class Folder {
  public:
    Folder() {
        static std::atomic<int> next{0};
        path_ = std::filesystem::temp_directory_path() /
                ("treerec_scan_" + std::to_string(getpid()) + "_" + std::to_string(next++));
        std::filesystem::create_directories(path_);
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    std::string file(const std::string& name) const { return (path_ / name).string(); }
    std::string write(const std::string& name, const std::string& bytes) const {
        std::ofstream(file(name), std::ios::binary) << bytes;
        return file(name);
    }

  private:
    std::filesystem::path path_;
};

inline std::string bytes_of(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

inline PointCloud read_text_of(const std::string& text, const std::string& name = "cloud.xyz",
                               ReadCloudReport* report = nullptr, const ReadCloudOptions& options = {}) {
    const Folder folder;
    return read_cloud(folder.write(name, text), options, report);
}

// The sentence that reading gives, or nothing if it succeeds.
inline std::string error_of(const std::string& bytes, const std::string& name) {
    const Folder folder;
    const std::string path = folder.write(name, bytes);
    try {
        read_cloud(path);
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

inline DVec3 scan_point(const PointCloud& cloud, size_t i) {
    return cloud.frame.to_scan(DVec3(cloud.positions[i]));
}

inline void expect_point(const PointCloud& cloud, size_t i, const DVec3& expected, double tolerance = 1e-5) {
    const DVec3 p = scan_point(cloud, i);
    EXPECT_LE(glm::length(p - expected), tolerance) << p.x << " " << p.y << " " << p.z;
}

// Points in a box of `size` around `centre`, in scan axes.
inline PointCloud random_cloud(uint64_t seed, size_t count, const DVec3& centre, double size, bool colors,
                               bool normals) {
    Random random(seed);
    PointCloud cloud;
    cloud.frame.origin = glm::round(centre);
    for (size_t i = 0; i < count; i++) {
        const DVec3 p(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
        cloud.positions.emplace_back(p);
        if (colors)
            cloud.colors.push_back({static_cast<uint8_t>(random.below(256)),
                                    static_cast<uint8_t>(random.below(256)),
                                    static_cast<uint8_t>(random.below(256))});
        if (normals) cloud.normals.emplace_back(random.direction());
    }
    return cloud;
}

inline void shuffle(PointCloud& cloud, uint64_t seed) {
    Random random(seed);
    for (size_t i = cloud.size(); i > 1; i--) {
        const size_t k = random.below(static_cast<uint32_t>(i));
        std::swap(cloud.positions[i - 1], cloud.positions[k]);
        if (cloud.has_colors()) std::swap(cloud.colors[i - 1], cloud.colors[k]);
        if (cloud.has_normals()) std::swap(cloud.normals[i - 1], cloud.normals[k]);
    }
}

inline void add_cylinder(std::vector<Vec3>& points, Random& random, const DVec3& from, const DVec3& to,
                         double r0, double r1, size_t count) {
    const DVec3 along = glm::normalize(to - from);
    const DVec3 u = any_perpendicular(along);
    const DVec3 v = glm::cross(along, u);
    for (size_t i = 0; i < count; i++) {
        const double t = random.uniform();
        const double angle = random.uniform(0.0, 2.0 * kPi);
        const double r = r0 + (r1 - r0) * t;
        points.emplace_back(from + t * (to - from) + r * (std::cos(angle) * u + std::sin(angle) * v));
    }
}

// A leafless tree 10 m high, Y up, foot at the origin: a stem with 12 branches that each bear twigs. About
// 20000 points.
inline std::vector<Vec3> tree_points(uint64_t seed) {
    Random random(seed);
    std::vector<Vec3> points;
    add_cylinder(points, random, {0, 0, 0}, {0.2, 10, 0.1}, 0.25, 0.03, 8000);
    for (int i = 0; i < 12; i++) {
        const double h = 2.5 + 0.5 * i;
        const double angle = 2.4 * i;
        const DVec3 foot(0.02 * h, h, 0.01 * h);
        const double length = 3.0 - 0.18 * i;
        const DVec3 tip = foot + length * glm::normalize(DVec3(std::cos(angle), 0.7, std::sin(angle)));
        add_cylinder(points, random, foot, tip, 0.06, 0.015, 700);
        for (int k = 1; k <= 3; k++) {
            const DVec3 at = foot + (tip - foot) * (0.25 * k);
            add_cylinder(points, random, at, at + 0.7 * glm::normalize(random.direction() + DVec3(0, 1, 0)),
                         0.015, 0.005, 120);
        }
    }
    return points;
}

// Where the real scans are, or an empty text.
inline std::string scans_folder() {
    const char* folder = std::getenv("TREEREC_SCANS");
    if (!folder || !std::filesystem::is_directory(std::string(folder) + "/clouds")) return {};
    return std::string(folder) + "/clouds/";
}

// A real scan with Z up and in metres, as it lies in scans_folder().
inline PointCloud upright_scan(const std::string& file) {
    PointCloud cloud = read_cloud(scans_folder() + file);
    OrientOptions upright;
    upright.up = UpAxis::kZ;
    upright.metres_per_unit = 1.0;
    orient_cloud(cloud, upright);
    return cloud;
}

}  // namespace treerec::scan_test
