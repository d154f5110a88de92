#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <utility>

#include "error.h"
#include "file_bytes.h"
#include "geometry/bounds.h"
#include "geometry/portable_math.h"
#include "ply_header.h"
#include "scan/formats/read_cloud.h"

namespace treerec {

namespace {

// A buffer of known size, filled front to back with little-endian values.
class ByteWriter {
  public:
    explicit ByteWriter(size_t size) : bytes_(size, '\0') {}

    template <typename T>
    void put(T value) {
        char raw[sizeof(T)];
        std::memcpy(raw, &value, sizeof(T));
        if constexpr (std::endian::native == std::endian::big) std::reverse(raw, raw + sizeof(T));
        std::memcpy(bytes_.data() + at_, raw, sizeof(T));
        at_ += sizeof(T);
    }
    void put_text(std::string_view text) {
        std::memcpy(bytes_.data() + at_, text.data(), text.size());
        at_ += text.size();
    }
    void skip(size_t count) { at_ += count; }
    std::string take() { return std::move(bytes_); }

  private:
    std::string bytes_;
    size_t at_ = 0;
};

DVec3 scan_position(const PointCloud& cloud, size_t i) {
    return cloud.frame.to_scan(DVec3(cloud.positions[i]));
}

Bounds scan_bounds(const PointCloud& cloud) {
    Bounds bounds;
    for (size_t i = 0; i < cloud.size(); i++)
        bounds.add(scan_position(cloud, i));
    return bounds;
}

// The decimals that keep what the cloud's floats resolve: about 1e-8 of its extent.
int decimals_for(const Bounds& bounds) {
    const DVec3 size = bounds.size();
    const double extent = std::max({size.x, size.y, size.z});
    if (!(extent > 0.0)) return 6;
    return std::clamp(static_cast<int>(std::ceil(8.0 - portable::log10(extent))), 0, 15);
}

// Of a column that a reader takes for labels again (label_meaning()).
std::string label_name(const PointLabels& labels) {
    if (labels.by_colour) return "leaf_by_colour";
    if (labels.leaf_is_one) return "leaf";
    std::string name;
    for (const char c : labels.column)
        if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_') name += c;
    return name.empty() ? "label" : name;
}

// Now and then, of many points.
void check_at(size_t i, const Progress* progress) {
    if (progress && i % 65536 == 0) progress->check();
}

std::string to_ply(const PointCloud& cloud, std::string_view comment, const Progress* progress) {
    std::string header = "ply\nformat binary_little_endian 1.0\n";
    if (!comment.empty()) header.append("comment ").append(comment).append("\n");
    if (cloud.spacing > 0.0) {
        char number[32];
        const std::to_chars_result end = std::to_chars(number, number + sizeof number, cloud.spacing);
        header += std::string(kSpacingComment).append(number, end.ptr) + '\n';
    }
    header += "element vertex " + std::to_string(cloud.size()) +
              "\nproperty double x\nproperty double y\nproperty double z\n";
    if (cloud.has_normals()) header += "property float nx\nproperty float ny\nproperty float nz\n";
    if (cloud.has_colors()) header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    if (!cloud.labels.empty()) header.append("property uchar ").append(label_name(cloud.labels)).append("\n");
    if (!cloud.radii.empty()) header += "property float wood_radius\n";
    header += "end_header\n";
    const size_t stride = 24U + (cloud.has_normals() ? 12U : 0U) + (cloud.has_colors() ? 3U : 0U) +
                          (cloud.labels.empty() ? 0U : 1U) + (cloud.radii.empty() ? 0U : 4U);
    ByteWriter writer(header.size() + stride * cloud.size());
    writer.put_text(header);
    for (size_t i = 0; i < cloud.size(); i++) {
        check_at(i, progress);
        const DVec3 p = scan_position(cloud, i);
        for (int k = 0; k < 3; k++)
            writer.put(p[k]);
        if (cloud.has_normals()) {
            const DVec3 n = cloud.frame.turn_to_scan(DVec3(cloud.normals[i]));
            for (int k = 0; k < 3; k++)
                writer.put(static_cast<float>(n[k]));
        }
        if (cloud.has_colors())
            for (const uint8_t channel : cloud.colors[i])
                writer.put(channel);
        if (!cloud.labels.empty()) writer.put(cloud.labels.values[i]);
        if (!cloud.radii.empty())
            writer.put(static_cast<float>(static_cast<double>(cloud.radii[i]) / cloud.frame.metres_per_unit));
    }
    return writer.take();
}

std::string to_text(const PointCloud& cloud, const Progress* progress) {
    std::string text;
    // Bare x y z needs no header, and many programs trip over one.
    if (cloud.has_colors() || cloud.has_normals() || !cloud.labels.empty()) {
        text = "//X Y Z";
        if (cloud.has_colors()) text += " R G B";
        if (cloud.has_normals()) text += " Nx Ny Nz";
        if (!cloud.labels.empty()) text.append(" ").append(label_name(cloud.labels));
        text += '\n';
    }
    const int decimals = decimals_for(scan_bounds(cloud));
    char number[400];
    auto put = [&](double value, int places, char after) {
        const std::to_chars_result result =
            std::to_chars(number, number + sizeof(number), value, std::chars_format::fixed, places);
        text.append(number, static_cast<size_t>(result.ptr - number));
        text += after;
    };
    text.reserve(text.size() + cloud.size() * 48);
    for (size_t i = 0; i < cloud.size(); i++) {
        check_at(i, progress);
        const DVec3 p = scan_position(cloud, i);
        for (int k = 0; k < 3; k++)
            put(p[k], decimals, ' ');
        if (cloud.has_colors())
            for (const uint8_t channel : cloud.colors[i])
                put(channel, 0, ' ');
        if (cloud.has_normals()) {
            const DVec3 n = cloud.frame.turn_to_scan(DVec3(cloud.normals[i]));
            for (int k = 0; k < 3; k++)
                put(n[k], 7, ' ');
        }
        if (!cloud.labels.empty()) put(cloud.labels.values[i], 0, ' ');
        text.back() = '\n';
    }
    return text;
}

// LAS 1.2, point format 0 or 2: ASPRS, "LAS Specification, version 1.2", 2008.
std::string to_las(const PointCloud& cloud, const Progress* progress) {
    constexpr size_t kHeader = 227;
    if (cloud.size() > 0xFFFFFFFFU) throw Error("LAS 1.2 holds no more than 4294967295 points; write PLY.");
    const size_t stride = cloud.has_colors() ? 26 : 20;
    const Bounds bounds = scan_bounds(cloud);
    const DVec3 offset = glm::round(bounds.centre());
    const DVec3 reach = glm::max(bounds.max - offset, offset - bounds.min);
    const double largest = std::max({reach.x, reach.y, reach.z, 1e-3});
    const double scale = portable::pow(10.0, std::ceil(portable::log10(largest / 2147483647.0)));

    ByteWriter writer(kHeader + stride * cloud.size());
    writer.put_text("LASF");
    writer.skip(20);
    writer.put(uint8_t{1});
    writer.put(uint8_t{2});
    writer.skip(32);
    writer.put_text("Godot tree reconstruction");
    writer.skip(32 - 25 + 4);
    writer.put(static_cast<uint16_t>(kHeader));
    writer.put(static_cast<uint32_t>(kHeader));
    writer.skip(4);
    writer.put(static_cast<uint8_t>(cloud.has_colors() ? 2 : 0));
    writer.put(static_cast<uint16_t>(stride));
    writer.put(static_cast<uint32_t>(cloud.size()));
    writer.put(static_cast<uint32_t>(cloud.size()));  // all are first returns
    writer.skip(16);
    for (int k = 0; k < 3; k++)
        writer.put(scale);
    for (int k = 0; k < 3; k++)
        writer.put(offset[k]);
    for (int k = 0; k < 3; k++) {
        writer.put(bounds.max[k]);
        writer.put(bounds.min[k]);
    }
    for (size_t i = 0; i < cloud.size(); i++) {
        check_at(i, progress);
        const DVec3 steps = glm::round((scan_position(cloud, i) - offset) / scale);
        for (int k = 0; k < 3; k++)
            writer.put(static_cast<int32_t>(std::clamp(steps[k], -2147483647.0, 2147483647.0)));
        writer.skip(2);
        writer.put(uint8_t{0x09});  // return 1 of 1
        writer.skip(5);
        if (cloud.has_colors())
            for (const uint8_t channel : cloud.colors[i])
                writer.put(static_cast<uint16_t>(channel * 257));
    }
    return writer.take();
}

constexpr const char* kKinds = "use the extension .ply, .las, .xyz, .txt or .asc.";

bool is_text(const std::string& extension) {
    return extension == "xyz" || extension == "txt" || extension == "asc";
}

}  // namespace

void require_cloud_extension(const std::string& path) {
    const std::string extension = extension_of(path);
    if (extension != "ply" && extension != "las" && !is_text(extension))
        throw Error("'" + path + "' is no name for a point cloud: " + kKinds);
}

void write_cloud(const std::string& path, const PointCloud& cloud, std::string_view comment,
                 const Progress* progress) {
    if (cloud.empty()) throw Error("'" + path + "' was not written: the cloud has no points.");
    const auto finite = [&](const Vec3& v) { return is_finite(DVec3(v)); };
    if (!std::all_of(cloud.positions.begin(), cloud.positions.end(), finite) ||
        !std::all_of(cloud.normals.begin(), cloud.normals.end(), finite) ||
        !is_finite(cloud.frame.to_scan(DVec3(cloud.positions[0]))))
        throw Error("'" + path + "' was not written: a point of the cloud has no place, or no normal.");
    const std::string extension = extension_of(path);
    if (extension == "ply") {
        write_file(path, to_ply(cloud, comment, progress), progress);
    } else if (extension == "las") {
        write_file(path, to_las(cloud, progress), progress);
    } else if (is_text(extension)) {
        write_file(path, to_text(cloud, progress), progress);
    } else {
        throw Error("'" + path + "' was not written: " + kKinds);
    }
}

}  // namespace treerec
