// What the readers of the several formats share. Internal to scan/.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "file_bytes.h"
#include "geometry/vec.h"
#include "scan/read_cloud.h"

namespace treerec {

// What a column or property of a file means.
enum Role : int8_t { kRoleX, kRoleY, kRoleZ, kRoleR, kRoleG, kRoleB, kRoleNx, kRoleNy, kRoleNz, kRoleCount };
inline constexpr int8_t kNoRole = -1;

// The roles of columns by their names in any spelling ("X", "coord. X", "Nx", "diffuse_red"). A role is given
// once; colours and normals only where all three components are there.
std::vector<int8_t> roles_from_names(const std::vector<std::string>& names);
bool has_role(const std::vector<int8_t>& roles, Role role);
// "x y z - r g b"
std::string describe_roles(const std::vector<int8_t>& roles);

// Points as the file has them, before origin and colour range are settled. colors, normals: empty or one
// each.
struct RawCloud {
    std::vector<DVec3> positions;
    std::vector<Vec3> colors;  // in the file's own range
    std::vector<Vec3> normals;
    float color_white = 0.0F;  // the value of full brightness; 0: decide by the largest value

    // One row of values by role.
    void add(const std::array<double, kRoleCount>& row, bool with_colors, bool with_normals) {
        positions.emplace_back(row[kRoleX], row[kRoleY], row[kRoleZ]);
        if (with_colors) colors.emplace_back(row[kRoleR], row[kRoleG], row[kRoleB]);
        if (with_normals) normals.emplace_back(row[kRoleNx], row[kRoleNy], row[kRoleNz]);
    }
};

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
};

RawCloud read_ply(const ReadJob& job);
RawCloud read_text(const ReadJob& job);
RawCloud read_las(const ReadJob& job);

// Reads a number as C would write it, with an optional '+', "nan" and "inf"; too large a number gives NaN.
// Advances p past it; false (and p unmoved) where there is none.
bool parse_number(const char*& p, const char* end, double& value);

}  // namespace treerec
