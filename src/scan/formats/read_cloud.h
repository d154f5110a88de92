// Reads and writes point-cloud files: PLY (Gaussian splats among them), text (.xyz .txt .asc .pts .csv), LAS
// 1.0-1.4, LAZ where LASzip is installed, PCD, COLMAP's points3D (.bin and .txt).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "progress.h"
#include "scan/point_cloud.h"

namespace treerec {

struct ReadCloudOptions {
    // Text files only: the columns' names in order, such as {"x","y","z","r","g","b"}; "-" skips one. Empty:
    // detect.
    std::vector<std::string> columns;
    // LAS and LAZ only: the classes of points that are read. None: all but noise (7 and 18).
    std::optional<std::vector<uint8_t>> classes = std::nullopt;

    bool operator==(const ReadCloudOptions&) const = default;
};

// "x, y, z, r, -" as columns; none for an empty text.
std::vector<std::string> parse_columns(std::string_view text);

// "2,4-6" or "all" as classes; none for an empty text. Throws Error for what is no such list.
std::optional<std::vector<uint8_t>> parse_classes(std::string_view text);

// What the reader had to decide or leave out, as sentences for the user ("3 of 4000 points had no finite
// position.").
struct ReadCloudReport {
    // "PLY binary little endian", "text, 6 columns: x y z r g b", "LAS 1.2, point format 3", "PCD binary"
    std::string format;
    std::vector<std::string> warnings;
};

// The file to read for `path`. Of a folder of COLMAP's: the dense cloud that lies beside the model
// (fused.ply, or cloud.ply of 'treerec photos'), or else the points of the model in it, in sparse/ or in
// sparse/0/. Else the path itself.
std::string cloud_file_of(const std::string& path);

// Reads the cloud at `path` (UTF-8), or in this folder. The format is sniffed from the contents first, the
// extension second. The frame's origin is the median of each axis, rounded to whole units, and independent of
// the points' order; scale 1, axes as in the file. Left out and counted in a warning: points without finite
// coordinates, LAS points flagged as withheld or of classes that are not read, splats with an opacity below
// 10 %. The cloud's unit is what a LAS file says; its labels are what a column called foliage, leaf, wood,
// classification, label or the like says of leaves. A file that is cut off is an Error wherever that can be
// known. Throws Error with a sentence (missing, empty, truncated, not a point cloud, no finite point,
// coordinates in degrees or rounded to steps too coarse for a tree, …).
PointCloud read_cloud(const std::string& path, const ReadCloudOptions& options = {},
                      ReadCloudReport* report = nullptr, Progress* progress = nullptr);

// The same for the bytes of a file called `name` in memory. LAZ is read from the file of that name, since
// LASzip wants one.
PointCloud read_cloud_bytes(const std::string& name, std::string_view bytes,
                            const ReadCloudOptions& options = {}, ReadCloudReport* report = nullptr);

// The cloud that a file of these places would be read as. colors: none, or one per place; white: their full
// brightness, 0: by the largest of them, as in files that don't say. name: what sentences about it begin
// with, in quotes. Throws Error, or Cancelled.
PointCloud cloud_of_places(const std::string& name, std::vector<DVec3> places, std::vector<Vec3> colors = {},
                           float white = 0.0F, ReadCloudReport* report = nullptr,
                           Progress* progress = nullptr);

// Writes by extension: .ply (binary little endian, doubles), .xyz/.txt/.asc (text; with a header line where
// there is more than places), .las (1.2; without normals and labels). Only PLY has the points' radii, and the
// cloud's spacing and `comment`, one line without its end, in its header. Labels become a column "leaf" (or
// "leaf_by_colour") where 1 is one, else one of their own name. Scan coordinates, axes and units, to 1e-8 of
// the cloud's extent. Writes beside and renames. Throws Error, or Cancelled.
void write_cloud(const std::string& path, const PointCloud& cloud, std::string_view comment = {},
                 const Progress* progress = nullptr);

// Throws Error if write_cloud() knows no such extension: to be asked before the long work.
void require_cloud_extension(const std::string& path);

}  // namespace treerec
