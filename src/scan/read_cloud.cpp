#include "scan/read_cloud.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "error.h"
#include "file_bytes.h"
#include "scan/readers.h"

namespace treerec {

namespace {

// Beyond these a coordinate is damage, not a place: in units of the file, from zero and from the median.
constexpr double kLargestCoordinate = 1e12;
constexpr double kLargestOffset = 1e9;

struct Magic {
    std::string_view bytes;
    const char* what;
};

constexpr Magic kForeign[] = {
    {"\xFF\xD8\xFF", "a JPEG picture, not a point cloud"},
    {"\x89PNG", "a PNG picture, not a point cloud"},
    {"GIF8", "a GIF picture, not a point cloud"},
    {"II*\0", "a TIFF picture, not a point cloud"},
    {"MM\0*", "a TIFF picture, not a point cloud"},
    {"RIFF", "a picture, a sound or a film, not a point cloud"},
    {"%PDF", "a PDF document, not a point cloud"},
    {"glTF", "a glTF model, not a point cloud"},
    {"BLENDER", "a Blender file, not a point cloud"},
    {"Kaydara FBX", "an FBX model, not a point cloud"},
    {"PK\x03\x04", "a ZIP archive; unpack it and open the point cloud in it"},
    {"\x1F\x8B", "compressed by gzip; unpack it first"},
    {"7z\xBC\xAF", "a 7-Zip archive; unpack it and open the point cloud in it"},
    {"ASTM-E57", "an E57 file, which is not read yet; convert it to LAS or PLY"},
    {"# .PCD", "a PCD file, which is not read yet; convert it to PLY"},
    {"VERSION .7", "a PCD file, which is not read yet; convert it to PLY"},
    {"VERSION 0.7", "a PCD file, which is not read yet; convert it to PLY"},
    {"CCB2", "a CloudCompare project; save the cloud as PLY or LAS there"},
    {"\x93NUMPY", "a NumPy array, which is not read; save it as text"},
    {"\x89HDF", "an HDF5 file, which is not read"},
    {"SQLite format 3", "a database (COLMAP's?), not a point cloud; export the model as PLY"},
    {"<", "a web page or XML document, not a point cloud"},
    {"{", "a JSON document (such as glTF), not a point cloud"},
    {"solid ", "an STL model, not a point cloud"},
    {"\xFF\xFE", "text in UTF-16; save it as UTF-8"},
    {"\xFE\xFF", "text in UTF-16; save it as UTF-8"},
};

// Text has no control characters but blanks and line ends.
bool looks_binary(std::string_view bytes) {
    for (const char c : bytes.substr(0, 65536)) {
        const unsigned char u = static_cast<unsigned char>(c);
        if ((u < 32 && c != '\n' && c != '\r' && c != '\t' && c != '\f' && c != '\v' && u != 26) || u == 127)
            return true;
    }
    return false;
}

RawCloud read_raw(const ReadJob& job) {
    const std::string_view bytes = job.bytes.view();
    if (bytes.empty()) job.fail("is empty.");
    if (bytes.starts_with("ply") && bytes.size() > 3 &&
        std::string_view("\n\r \t").find(bytes[3]) != bytes.npos)
        return read_ply(job);
    if (bytes.starts_with("LASF")) return read_las(job);
    for (const Magic& magic : kForeign)
        if (bytes.starts_with(magic.bytes)) job.fail(std::string("is ") + magic.what + ".");

    const std::string extension = extension_of(job.path);
    if (looks_binary(bytes)) {
        if (extension == "bin")
            job.fail("is a .bin file (COLMAP's?), which is not read; export the points as PLY from COLMAP.");
        job.fail("is not a point cloud that can be read: it is neither PLY, LAS nor text.");
    }
    if (extension == "ply") job.fail("is no PLY file: it does not begin with the line 'ply'.");
    if (extension == "las" || extension == "laz")
        job.fail("is no LAS file: it does not begin with the letters LASF.");
    if (extension == "obj") job.fail("is an OBJ model, not a point cloud; save its points as PLY.");
    if (extension == "ptx") job.fail("is a PTX scan, which is not read; save it as PTS or LAS.");
    return read_text(job);
}

bool usable(const DVec3& p, const DVec3& origin, double limit) {
    const DVec3 d = glm::abs(p - origin);
    return d.x <= limit && d.y <= limit && d.z <= limit;
}

// Order-independent: the middle value of each axis, rounded, over the points with usable coordinates.
// usable_count: gets how many those are.
DVec3 median_origin(const std::vector<DVec3>& positions, size_t& usable_count) {
    DVec3 origin(0.0);
    std::vector<double> values;
    values.reserve(positions.size());
    for (int axis = 0; axis < 3; axis++) {
        values.clear();
        for (const DVec3& p : positions)
            if (usable(p, DVec3(0.0), kLargestCoordinate)) values.push_back(p[axis]);
        if (values.empty()) break;
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        origin[axis] = std::round(*middle) + 0.0;
    }
    usable_count = values.size();
    return origin;
}

std::string of_points(size_t part, size_t whole) {
    return std::to_string(part) + " of " + std::to_string(whole) + " points ";
}

void convert_colors(const RawCloud& raw, PointCloud& cloud, ReadCloudReport& report) {
    float white = raw.color_white;
    float largest = 0.0F;
    float smallest = 0.0F;
    for (const Vec3& c : raw.colors) {
        for (int k = 0; k < 3; k++) {
            if (!std::isfinite(c[k])) continue;
            largest = std::max(largest, c[k]);
            smallest = std::min(smallest, c[k]);
        }
    }
    if (white == 0.0F) white = largest <= 1.0F ? 1.0F : largest <= 255.0F ? 255.0F : 65535.0F;
    if (largest > white || smallest < 0.0F) {
        report.warnings.emplace_back("The colours have values outside 0..255 and were left out.");
        return;
    }
    if (largest == 0.0F) return;  // a format with room for colours that nobody filled in
    const float factor = 255.0F / white;
    cloud.colors.resize(raw.colors.size());
    for (size_t i = 0; i < raw.colors.size(); i++) {
        for (int k = 0; k < 3; k++) {
            const float value = raw.colors[i][k] * factor + 0.5F;
            cloud.colors[i][static_cast<size_t>(k)] =
                value >= 0.0F ? static_cast<uint8_t>(std::min(value, 255.0F)) : uint8_t{0};
        }
    }
}

void convert_normals(const RawCloud& raw, PointCloud& cloud) {
    cloud.normals.resize(raw.normals.size());
    bool any = false;
    for (size_t i = 0; i < raw.normals.size(); i++) {
        const DVec3 n = is_finite(raw.normals[i]) ? normalized_or(raw.normals[i], DVec3(0.0)) : DVec3(0.0);
        cloud.normals[i] = n;
        any = any || n != DVec3(0.0);
    }
    if (!any) cloud.normals.clear();
}

PointCloud settle(const ReadJob& job, RawCloud&& raw) {
    const size_t count = raw.positions.size();
    if (count == 0) job.fail("holds no points.");
    size_t sound_count = 0;
    const DVec3 origin = median_origin(raw.positions, sound_count);
    if (sound_count == 0) job.fail("has no point with finite coordinates.");

    PointCloud cloud;
    cloud.frame.origin = origin;
    std::vector<uint8_t> keep(count);
    cloud.positions.resize(count);
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        const DVec3& p = raw.positions[i];
        keep[i] = usable(p, DVec3(0.0), kLargestCoordinate) && usable(p, origin, kLargestOffset);
        if (keep[i]) cloud.positions[i] = p - origin;
        kept += keep[i];
    }
    if (!raw.colors.empty()) convert_colors(raw, cloud, job.report);
    if (!raw.normals.empty()) convert_normals(raw, cloud);
    if (kept != count) {
        cloud.keep_only(keep);
        if (sound_count != count)
            job.report.warnings.push_back(of_points(count - sound_count, count) +
                                          "had no finite position and were left out.");
        if (sound_count != kept)
            job.report.warnings.push_back(of_points(sound_count - kept, count) +
                                          "were absurdly far away and were left out.");
    }
    if (cloud.empty()) job.fail("has no point with usable coordinates.");
    return cloud;
}

}  // namespace

std::vector<std::string> parse_columns(std::string_view text) {
    if (text.empty()) return {};
    std::vector<std::string> columns(1);
    for (const char c : text) {
        if (c == ',')
            columns.emplace_back();
        else if (c != ' ')
            columns.back() += c;
    }
    return columns;
}

PointCloud read_cloud(const std::string& path, const ReadCloudOptions& options, ReadCloudReport* report,
                      Progress* progress) {
    ReadCloudReport own_report;
    ReadCloudReport& the_report = report ? *report : own_report;
    the_report = {};
    try {
        FileBytes bytes = read_file(path);
        const ReadJob job{path, bytes, options, the_report, progress};
        job.step(0.1);
        RawCloud raw = read_raw(job);
        bytes = {};
        job.step(0.8);
        PointCloud cloud = settle(job, std::move(raw));
        job.step(1.0);
        return cloud;
    } catch (const std::bad_alloc&) {
        throw Error("'" + path + "' has too many points for this machine's memory; thin it first.");
    }
}

}  // namespace treerec
