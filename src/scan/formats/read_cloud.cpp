#include "scan/formats/read_cloud.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <new>

#include "error.h"
#include "file_bytes.h"
#include "geometry/parallel.h"
#include "scan/formats/coordinate_steps.h"
#include "scan/formats/readers.h"

namespace treerec {

namespace {

// Beyond these a coordinate is damage, not a place: in units of the file, from zero and from the median.
constexpr double kLargestCoordinate = 1e12;
constexpr double kLargestOffset = 1e9;

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
    if (is_ply(bytes)) return read_ply(job);
    if (bytes.starts_with("LASF")) return read_las(job);
    if (is_pcd(bytes)) return read_pcd(job);
    if (is_colmap(bytes)) return read_colmap(job);
    const std::string extension = extension_of(job.path);
    const std::string foreign = foreign_kind(bytes, extension);
    if (!foreign.empty()) job.fail("is " + foreign + ".");
    if (looks_binary(bytes)) {
        if (extension == "bin")
            job.fail("is a .bin file, but not COLMAP's points3D.bin, or a damaged one; choose points3D.bin.");
        job.fail(
            "is not a point cloud that can be read: it is neither PLY, LAS, LAZ, PCD, COLMAP's nor text.");
    }
    if (extension == "ply") job.fail("is no PLY file: it does not begin with the line 'ply'.");
    if (extension == "las" || extension == "laz")
        job.fail("is no LAS file: it does not begin with the letters LASF.");
    if (extension == "pcd") job.fail("is no PCD file: it has no header with FIELDS and DATA.");
    return read_text(job);
}

inline bool usable(const DVec3& p, const DVec3& origin, double limit) {
    // Not so for NaN. Without branches: nearly all points are usable.
    return static_cast<int>(std::abs(p.x - origin.x) <= limit) &
           static_cast<int>(std::abs(p.y - origin.y) <= limit) &
           static_cast<int>(std::abs(p.z - origin.z) <= limit);
}

constexpr size_t kGrain = 1 << 16;  // points per chunk: a millisecond of work

// Between which values of an axis its middle is looked for, and what was found there.
struct Bracket {
    double low = -kLargestCoordinate;
    double high = kLargestCoordinate;
    size_t below = 0;
    std::vector<double> inside;
};

// Counts the usable points and gathers what lies in the brackets.
size_t fill_brackets(const ReadJob& job, const std::vector<DVec3>& positions,
                     std::array<Bracket, 3>& brackets) {
    struct Part {
        size_t usable_count = 0;
        std::array<size_t, 3> below{};
        std::array<std::vector<double>, 3> inside;
    };
    std::vector<Part> parts((positions.size() + kGrain - 1) / kGrain);
    job.parallel(positions.size(), kGrain, kPointsRead, 0.85, [&](size_t begin, size_t end) {
        Part& part = parts[begin / kGrain];
        for (size_t i = begin; i < end; i++) {
            const DVec3& p = positions[i];
            if (!usable(p, DVec3(0.0), kLargestCoordinate)) continue;
            part.usable_count++;
            for (size_t axis = 0; axis < 3; axis++) {
                const double value = p[static_cast<int>(axis)];
                part.below[axis] += value < brackets[axis].low;
                if (value >= brackets[axis].low && value <= brackets[axis].high)
                    part.inside[axis].push_back(value);
            }
        }
    });
    size_t usable_count = 0;
    for (const Part& part : parts) {
        usable_count += part.usable_count;
        for (size_t axis = 0; axis < 3; axis++) {
            brackets[axis].below += part.below[axis];
            brackets[axis].inside.insert(brackets[axis].inside.end(), part.inside[axis].begin(),
                                         part.inside[axis].end());
        }
    }
    return usable_count;
}

// The median of each axis, rounded to whole units, over the points with usable coordinates; exact, and so
// independent of the points' order. Only what lies between two quantiles of a sample is sorted out (R. Floyd,
// R. Rivest, "Expected time bounds for selection", 1975). usable_count: gets how many points those are.
DVec3 median_origin(const ReadJob& job, const std::vector<DVec3>& positions, size_t& usable_count) {
    constexpr size_t kSample = 16384;
    const size_t stride = positions.size() / kSample + 1;
    std::array<Bracket, 3> brackets;
    for (int axis = 0; stride > 1 && axis < 3; axis++) {
        std::vector<double> values;
        for (size_t i = 0; i < positions.size(); i += stride)
            if (usable(positions[i], DVec3(0.0), kLargestCoordinate)) values.push_back(positions[i][axis]);
        std::sort(values.begin(), values.end());
        if (values.empty()) continue;
        brackets[static_cast<size_t>(axis)].low = values[values.size() * 48 / 100];
        brackets[static_cast<size_t>(axis)].high = values[values.size() * 52 / 100];
    }
    for (;;) {
        usable_count = fill_brackets(job, positions, brackets);
        DVec3 origin(0.0);
        if (usable_count == 0) return origin;
        const size_t rank = usable_count / 2;
        bool found = true;
        for (size_t axis = 0; axis < 3; axis++) {
            Bracket& bracket = brackets[axis];
            if (rank >= bracket.below && rank < bracket.below + bracket.inside.size()) {
                const auto middle =
                    bracket.inside.begin() + static_cast<std::ptrdiff_t>(rank - bracket.below);
                std::nth_element(bracket.inside.begin(), middle, bracket.inside.end());
                origin[static_cast<int>(axis)] = std::round(*middle) + 0.0;
                bracket.below = 0;
                bracket.inside.clear();
            } else {
                // The sample misled: all of them then.
                bracket = {};
                found = false;
            }
        }
        if (found) return origin;
    }
}

std::string of_points(size_t part, size_t whole) {
    return std::to_string(part) + " of " + std::to_string(whole) + " points ";
}

void convert_colors(const ReadJob& job, const RawCloud& raw, PointCloud& cloud) {
    const size_t count = raw.colors.size();
    std::vector<std::array<float, 2>> ranges((count + kGrain - 1) / kGrain);
    job.parallel(count, kGrain, 0.9, 0.92, [&](size_t begin, size_t end) {
        std::array<float, 2>& range = ranges[begin / kGrain];
        for (size_t i = begin; i < end; i++) {
            for (int k = 0; k < 3; k++) {
                if (!std::isfinite(raw.colors[i][k])) continue;
                range[0] = std::min(range[0], raw.colors[i][k]);
                range[1] = std::max(range[1], raw.colors[i][k]);
            }
        }
    });
    float smallest = 0.0F;
    float largest = 0.0F;
    for (const std::array<float, 2>& range : ranges) {
        smallest = std::min(smallest, range[0]);
        largest = std::max(largest, range[1]);
    }
    float white = raw.color_white;
    if (white == 0.0F) white = largest <= 1.0F ? 1.0F : largest <= 255.0F ? 255.0F : 65535.0F;
    if (largest > white || smallest < 0.0F) {
        job.report.warnings.emplace_back("The colours have values outside 0..255 and were left out.");
        return;
    }
    if (largest == 0.0F) return;  // a format with room for colours that nobody filled in
    const float factor = 255.0F / white;
    make_room(job, cloud.colors, count);
    job.parallel(count, kGrain, 0.92, 0.95, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++) {
            for (int k = 0; k < 3; k++) {
                const float value = raw.colors[i][k] * factor + 0.5F;
                cloud.colors[i][static_cast<size_t>(k)] =
                    value >= 0.0F ? static_cast<uint8_t>(std::min(value, 255.0F)) : uint8_t{0};
            }
        }
    });
}

void convert_normals(const ReadJob& job, const RawCloud& raw, PointCloud& cloud) {
    make_room(job, cloud.normals, raw.normals.size());
    std::atomic<bool> any{false};
    job.parallel(raw.normals.size(), kGrain, 0.95, 1.0, [&](size_t begin, size_t end) {
        bool found = false;
        for (size_t i = begin; i < end; i++) {
            const DVec3 n =
                is_finite(raw.normals[i]) ? normalized_or(raw.normals[i], DVec3(0.0)) : DVec3(0.0);
            cloud.normals[i] = n;
            found = found || n != DVec3(0.0);
        }
        if (found) any = true;
    });
    if (!any) cloud.normals.clear();
}

// Those that are none count as unknown; where all are, there are none.
void convert_radii(const RawCloud& raw, PointCloud& cloud) {
    bool any = false;
    for (const float radius : raw.radii)
        any = any || (std::isfinite(radius) && radius > 0.0F);
    if (!any) return;
    cloud.radii = raw.radii;
    for (float& radius : cloud.radii)
        if (!std::isfinite(radius) || radius < 0.0F) radius = 0.0F;
}

// Labels that are all whole numbers up to 255, or all words, or 0 and 1 with what lies between; others are
// none.
void convert_labels(const RawCloud& raw, PointCloud& cloud) {
    LabelMeaning meaning = label_meaning(raw.label_column);
    size_t words = 0, wholes = 0, shares = 0, numbers = 0;
    for (const float label : raw.labels) {
        if (!std::isfinite(label)) continue;
        numbers++;
        words += label == static_cast<float>(kLeafWord) || label == static_cast<float>(kWoodWord);
        wholes += label >= 0.0F && label <= 255.0F && label == std::floor(label);
        shares += label >= 0.0F && label <= 1.0F;
    }
    if (numbers == 0) return;
    const bool in_words = words == numbers;
    // "foliage" may be 1 and 2.
    if (meaning != LabelMeaning::kEither && shares != numbers) meaning = LabelMeaning::kEither;
    if (!in_words && (meaning == LabelMeaning::kEither ? wholes : shares) != numbers) return;
    cloud.labels.column = raw.label_column;
    cloud.labels.by_colour = is_label_by_colour(raw.label_column);
    cloud.labels.leaf_is_one = in_words || meaning != LabelMeaning::kEither;
    cloud.labels.values.reserve(raw.labels.size());
    for (const float label : raw.labels) {
        float value = std::isfinite(label) ? label : 0.0F;
        if (in_words)
            value = label == static_cast<float>(kLeafWord) ? 1.0F : 0.0F;
        else if (meaning != LabelMeaning::kEither)
            value = (value >= 0.5F) == (meaning == LabelMeaning::kLeaf) ? 1.0F : 0.0F;
        cloud.labels.values.push_back(static_cast<uint8_t>(value));
    }
}

// Rounding has left nothing of a tree.
void refuse_coarse_steps(const ReadJob& job, const RawCloud& raw, const std::vector<uint8_t>& keep) {
    const std::optional<CoordinateSteps> found = find_coarse_steps(raw.positions, keep);
    if (!found) return;
    char step[32];
    const std::to_chars_result end =
        std::to_chars(step, step + sizeof step, found->step, std::chars_format::general, 6);
    // Maps are in metres unless they say otherwise.
    const bool metres = raw.unit.metres == 0.0 || raw.unit.metres == 1.0;
    job.fail(
        "shows no tree: its coordinates come in steps of " + std::string(step, end.ptr) +
        (metres ? " m" : " units") + " along " + "xyz"[found->axis] + ", since they were rounded " +
        (found->as_floats ? "to 32-bit numbers" : "to a few digits") +
        " far from zero. Shift the cloud towards zero before saving it (or save it in double precision), "
        "and read that.");
}

PointCloud settle(const ReadJob& job, RawCloud&& raw) {
    const size_t count = raw.positions.size();
    if (count == 0) job.fail("holds no points.");
    size_t sound_count = 0;
    const DVec3 origin = median_origin(job, raw.positions, sound_count);
    if (sound_count == 0) job.fail("has no point with finite coordinates.");

    PointCloud cloud;
    cloud.frame.origin = origin;
    std::vector<uint8_t> keep(count);
    make_room(job, cloud.positions, count);
    std::atomic<size_t> kept{0};
    job.parallel(count, kGrain, 0.85, 0.9, [&](size_t begin, size_t end) {
        size_t own = 0;
        for (size_t i = begin; i < end; i++) {
            const DVec3& p = raw.positions[i];
            keep[i] = usable(p, DVec3(0.0), kLargestCoordinate) && usable(p, origin, kLargestOffset);
            if (keep[i]) cloud.positions[i] = p - origin;
            own += keep[i];
        }
        kept += own;
    });
    refuse_coarse_steps(job, raw, keep);
    raw.positions = {};
    cloud.unit = raw.unit;
    cloud.spacing = raw.spacing;
    convert_labels(raw, cloud);
    raw.labels = {};
    convert_radii(raw, cloud);
    raw.radii = {};
    if (!raw.colors.empty()) convert_colors(job, raw, cloud);
    raw.colors = {};
    if (!raw.normals.empty()) convert_normals(job, raw, cloud);
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

PointCloud read_all(const std::string& path, FileBytes&& bytes, const ReadCloudOptions& options,
                    ReadCloudReport& report, Progress* progress) {
    const ReadJob job{path, bytes, options, report, progress};
    job.step(kFileRead);
    RawCloud raw = read_raw(job);
    bytes = {};
    if (!options.columns.empty() && !report.format.starts_with("text"))
        report.warnings.push_back("The names of the columns were ignored: the file is " + report.format +
                                  ", which says itself what its columns are.");
    job.step(kPointsRead);
    PointCloud cloud = settle(job, std::move(raw));
    job.step(1.0);
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

std::optional<std::vector<uint8_t>> parse_classes(std::string_view text) {
    if (text.empty()) return std::nullopt;
    std::array<bool, 256> wanted{};
    if (text == "all") wanted.fill(true);
    for (std::string_view rest = text == "all" ? "" : text; !rest.empty();) {
        const std::string_view part = rest.substr(0, rest.find(','));
        rest.remove_prefix(std::min(rest.size(), part.size() + 1));
        unsigned first = 0, last = 0;
        const char* const end = part.data() + part.size();
        std::from_chars_result read = std::from_chars(part.data(), end, first);
        last = first;
        if (read.ec == std::errc() && read.ptr != end && *read.ptr == '-')
            read = std::from_chars(read.ptr + 1, end, last);
        if (read.ec != std::errc() || read.ptr != end || first > last || last > 255)
            throw Error("The classes of points are numbers from 0 to 255, as in 4,5 or 2-5, or 'all', not " +
                        quote_word(text) + ".");
        for (unsigned i = first; i <= last; i++)
            wanted[i] = true;
    }
    std::vector<uint8_t> classes;
    for (size_t i = 0; i < wanted.size(); i++)
        if (wanted[i]) classes.push_back(static_cast<uint8_t>(i));
    return classes;
}

std::string cloud_file_of(const std::string& path) {
    namespace fs = std::filesystem;
    const fs::path folder = path_of(path);
    std::error_code failure;
    if (!fs::is_directory(folder, failure)) return path;
    for (const fs::path& model : {folder, folder / "sparse", folder / "sparse" / "0", folder / "0"})
        for (const char* points : {"points3D.bin", "points3D.txt"}) {
            if (!fs::is_regular_file(model / points, failure)) continue;
            for (const char* dense : {"fused.ply", "cloud.ply"})
                if (model != folder && fs::is_regular_file(folder / dense, failure))
                    return utf8_of(folder / dense);
            return utf8_of(model / points);
        }
    return path;
}

PointCloud read_cloud(const std::string& asked, const ReadCloudOptions& options, ReadCloudReport* report,
                      Progress* progress) {
    const std::string path = cloud_file_of(asked);
    ReadCloudReport own_report;
    ReadCloudReport& the_report = report ? *report : own_report;
    the_report = {};
    try {
        SubProgress reading(progress, 0.0, kFileRead);
        return read_all(path, read_file(path, &reading), options, the_report, progress);
    } catch (const std::bad_alloc&) {
        throw Error("'" + path + "' has too many points for this machine's memory; thin it first.");
    }
}

PointCloud cloud_of_places(const std::string& name, std::vector<DVec3> places, std::vector<Vec3> colors,
                           float white, ReadCloudReport* report, Progress* progress) {
    ReadCloudReport own_report;
    ReadCloudReport& the_report = report ? *report : own_report;
    the_report = {"places in memory", {}};
    FileBytes none;
    const ReadCloudOptions options;
    RawCloud raw;
    raw.positions = std::move(places);
    raw.colors = std::move(colors);
    raw.color_white = white;
    return settle({name, none, options, the_report, progress}, std::move(raw));
}

PointCloud read_cloud_bytes(const std::string& name, std::string_view bytes, const ReadCloudOptions& options,
                            ReadCloudReport* report) {
    FileBytes copy;
    copy.data = std::make_unique_for_overwrite<char[]>(bytes.size() + 1);
    copy.size = bytes.size();
    std::copy(bytes.begin(), bytes.end(), copy.data.get());
    copy.data[copy.size] = '\0';
    ReadCloudReport own_report;
    ReadCloudReport& the_report = report ? *report : own_report;
    the_report = {};
    return read_all(name, std::move(copy), options, the_report, nullptr);
}

}  // namespace treerec
