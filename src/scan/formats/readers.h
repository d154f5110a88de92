// What the readers of the several formats share. Internal to scan/.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "file_bytes.h"
#include "geometry/vec.h"
#include "ply_header.h"
#include "scan/formats/read_cloud.h"

namespace treerec {

// What a column or property of a file means. kRoleOpacity: of a Gaussian splat; no name alone gives it.
// kRoleLabel: which points are leaf and which wood. kRoleRadius: of the wood that a point lies on.
enum Role : int8_t {
    kRoleX,
    kRoleY,
    kRoleZ,
    kRoleR,
    kRoleG,
    kRoleB,
    kRoleNx,
    kRoleNy,
    kRoleNz,
    kRoleOpacity,
    kRoleLabel,
    kRoleRadius,
    kRoleCount
};
inline constexpr int8_t kNoRole = -1;

// The roles of columns by their names in any spelling ("X", "coord. X", "Nx", "diffuse_red"). A role is given
// once; colours and normals only where all three components are there.
std::vector<int8_t> roles_from_names(const std::vector<std::string>& names);

// What the values of a column of labels mean, by its name: 1 is a leaf, 1 is wood, or the values tell.
enum class LabelMeaning { kLeaf, kWood, kEither };
LabelMeaning label_meaning(std::string_view name);
// Whether a column of that name holds labels by colour (PointLabels::by_colour).
bool is_label_by_colour(std::string_view name);
// A label that is a word: "leaf", "needles", "stem", … as these values; NaN for other words.
inline constexpr double kWoodWord = 1000.0;
inline constexpr double kLeafWord = 1001.0;
double label_of_word(std::string_view word);

bool has_role(const std::vector<int8_t>& roles, Role role);
// "x y z - r g b"
std::string describe_roles(const std::vector<int8_t>& roles);

// Points as the file has them, before origin and colour range are settled. colors, normals, opacities,
// labels, radii: empty or one each.
struct RawCloud {
    std::vector<DVec3> positions;
    std::vector<Vec3> colors;  // in the file's own range
    std::vector<Vec3> normals;
    std::vector<float> opacities;
    std::vector<float> labels;
    std::vector<float> radii;
    std::string label_column;  // the name of the labels' column
    ScanUnit unit;
    double spacing = 0.0;      // as PointCloud has it
    float color_white = 0.0F;  // the value of full brightness; 0: decide by the largest value

    size_t size() const { return positions.size(); }
    void reserve(size_t count, const std::vector<int8_t>& roles);
    // One row of values by role; whatever else there is than positions must have been said by `roles`.
    void add(const std::array<double, kRoleCount>& row, const std::vector<int8_t>& roles);
    void set(size_t index, const std::array<double, kRoleCount>& row) {
        positions[index] = DVec3(row[kRoleX], row[kRoleY], row[kRoleZ]);
        if (!colors.empty()) colors[index] = Vec3(row[kRoleR], row[kRoleG], row[kRoleB]);
        if (!normals.empty()) normals[index] = Vec3(row[kRoleNx], row[kRoleNy], row[kRoleNz]);
        if (!opacities.empty()) opacities[index] = static_cast<float>(row[kRoleOpacity]);
        if (!labels.empty()) labels[index] = static_cast<float>(row[kRoleLabel]);
        if (!radii.empty()) radii[index] = static_cast<float>(row[kRoleRadius]);
    }
    // Keeps the points whose keep[i] is not 0, in order. Returns how many were left out.
    size_t keep_only(const std::vector<uint8_t>& keep);
};

// A column of binary values: the first, and the bytes from one to the next.
struct ValueColumn {
    const char* first = nullptr;
    size_t stride = 0;
    PlyType type = PlyType::kFloat;
    bool swap = false;
};

// Copies `count` values to the points from `begin` on, to where `role` says. The cloud has room for them.
void decode_column(const ValueColumn& column, size_t count, int8_t role, size_t begin, RawCloud& raw);

struct ReadJob {
    const std::string& path;
    FileBytes& bytes;  // may be altered
    const ReadCloudOptions& options;
    ReadCloudReport& report;
    Progress* progress;

    // "'oak.ply' " + rest
    [[noreturn]] void fail(const std::string& rest) const;
    // fraction: 0..1 of the reading. Throws Cancelled.
    void step(double fraction) const;
    // parallel_for that steps from `begin` to `end` (fractions of the reading) as its chunks are done.
    void parallel(size_t count, size_t grain, double begin, double end,
                  const std::function<void(size_t, size_t)>& body) const;
};

// Makes room for `count` values, which start as zeros, in pieces: the system takes its time for fresh memory.
// Throws Cancelled.
template <typename T>
void make_room(const ReadJob& job, std::vector<T>& values, size_t count) {
    constexpr size_t kPiece = size_t{16} << 20;  // bytes: some milliseconds
    values.reserve(count);
    while (values.size() < count) {
        if (job.progress) job.progress->check();
        values.resize(std::min(count, values.size() + kPiece / sizeof(T)));
    }
}
// For `count` points with what `roles` tell.
void make_room(const ReadJob& job, RawCloud& raw, size_t count, const std::vector<int8_t>& roles);

// Where the reading of the file ends and the reading of its points begins and ends, as fractions.
inline constexpr double kFileRead = 0.2;
inline constexpr double kPointsRead = 0.8;

RawCloud read_ply(const ReadJob& job);
RawCloud read_text(const ReadJob& job);
RawCloud read_las(const ReadJob& job);
RawCloud read_pcd(const ReadJob& job);
RawCloud read_colmap(const ReadJob& job);

// Whether the bytes begin as a PCD file or COLMAP's points3D.bin does.
bool is_pcd(std::string_view bytes);
bool is_colmap(std::string_view bytes);

// What a file is that is none of ours, such as "a JPEG picture, not a point cloud"; empty where that is not
// known.
std::string foreign_kind(std::string_view bytes, const std::string& extension);

// Turns the first harmonics of splats into colours from 0 to 1 and leaves out those that are nearly
// transparent: Kerbl et al., "3D Gaussian Splatting for Real-Time Radiance Field Rendering", 2023, whose
// files hold the degree-0 coefficients and the logarithm of the opacity's odds.
void settle_splats(const ReadJob& job, RawCloud& raw);

// Reads a number as C would write it, with an optional '+', "nan" and "inf"; too large a number gives NaN.
// Advances p past it; false (and p unmoved) where there is none.
bool parse_number(const char*& p, const char* end, double& value);

}  // namespace treerec
