// LAS 1.0-1.4, point formats 0-10: ASPRS, "LAS Specification 1.4 - R15", sections 2.4 and 2.6.
#include "scan/formats/read_las.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace treerec {

namespace {

template <typename T>
T little(const char* p) {
    return load_value<T>(p, std::endian::native != std::endian::little);
}

struct PointFormat {
    size_t size;  // of a record, without extra bytes
    size_t rgb;   // offset of the colours in it; 0: none
};

constexpr PointFormat kFormats[] = {{20, 0}, {28, 0},  {26, 20}, {34, 28}, {57, 0}, {63, 28},
                                    {30, 0}, {36, 30}, {38, 30}, {59, 0},  {67, 30}};
constexpr size_t kBlock = 65536;
constexpr bool kSwap = std::endian::native != std::endian::little;
constexpr std::array<uint8_t, 2> kNoiseClasses{7, 18};  // low and high noise
// Of the byte 104, these two bits say that the points are compressed.
constexpr int kCompressedBits = 0xC0;

LasHeader read_header(const ReadJob& job) {
    const std::string_view bytes = job.bytes.view();
    const char* begin = bytes.data();
    if (bytes.size() < 227) job.fail("is a LAS file cut off within its header; copy it again.");
    const int major = static_cast<unsigned char>(begin[24]);
    const int minor = static_cast<unsigned char>(begin[25]);
    LasHeader header;
    header.version = std::to_string(major) + "." + std::to_string(minor);
    if (major != 1 || minor > 4)
        job.fail("is of LAS version " + header.version + "; versions 1.0 to 1.4 are read.");
    const int format_byte = static_cast<unsigned char>(begin[104]);
    header.compressed = (format_byte & kCompressedBits) != 0;
    header.format = format_byte & ~kCompressedBits;
    if (header.format > 10)
        job.fail("has LAS point format " + std::to_string(header.format) + "; formats 0 to 10 are read.");

    header.data = little<uint32_t>(begin + 96);
    header.stride = little<uint16_t>(begin + 105);
    header.count = little<uint32_t>(begin + 107);
    if (minor >= 4) {
        if (bytes.size() < 375) job.fail("is a LAS file cut off within its header; copy it again.");
        if (const uint64_t long_count = little<uint64_t>(begin + 247)) header.count = long_count;
    }
    for (int k = 0; k < 3; k++) {
        header.scale[k] = little<double>(begin + 131 + 8 * k);
        header.offset[k] = little<double>(begin + 155 + 8 * k);
    }
    if (!is_finite(header.scale) || !is_finite(header.offset) || header.scale.x == 0.0 ||
        header.scale.y == 0.0 || header.scale.z == 0.0)
        job.fail("has a damaged LAS header: its scale or offset is not a usable number.");
    if (header.stride < kFormats[header.format].size || header.data < 227)
        job.fail("has a damaged LAS header: the size or place of its points is impossible.");
    if (header.count == 0) job.fail("holds no points.");
    return header;
}

// Brings z to the unit of x and y; says what the file says.
void settle_units(const ReadJob& job, LasHeader& header) {
    const std::string_view bytes = job.bytes.view();
    const LasUnits units = las_units(bytes);
    header.unit = units.unit;
    if (units.degrees) {
        // A system that the coordinates do not fit is a mistake of whoever wrote its name.
        double most = 0.0, widest = 0.0;
        for (size_t at = 179; at < 179 + 32; at += 16) {
            const double high = little<double>(bytes.data() + at),
                         low = little<double>(bytes.data() + at + 8);
            most = std::max({most, std::abs(high), std::abs(low)});
            widest = std::max(widest, high - low);
        }
        constexpr double kWidestTree = 0.01;  // degrees: a kilometre
        if (most <= 360.0 && widest < kWidestTree)
            job.fail(
                "has its coordinates in degrees of longitude and latitude; convert it to a map in metres "
                "(such as UTM) first.");
    }
    if (!units.name.empty()) job.report.format += ", in " + units.name;
    if (units.height_factor == 1.0) return;
    header.scale.z *= units.height_factor;
    header.offset.z *= units.height_factor;
    job.report.warnings.push_back("The file has its heights in " + units.height_name + ", but all else in " +
                                  units.name + "; the heights were converted.");
}

// The extra bytes that say what is leaf: as the columns of text do.
void find_label(const ReadJob& job, LasHeader& header) {
    const std::vector<LasExtraField> fields = las_extra_fields(job.bytes.view());
    std::vector<std::string> names;
    for (const LasExtraField& field : fields)
        names.push_back(field.name);
    const std::vector<int8_t> roles = roles_from_names(names);
    for (size_t i = 0; i < fields.size(); i++) {
        const bool fits =
            fields[i].offset + size_of(fields[i].type) <= header.stride - kFormats[header.format].size;
        if (roles[i] == kRoleLabel && fits) header.label = fields[i];
    }
}

uint8_t class_of(const char* record, int format) {
    return static_cast<uint8_t>(format < 6 ? record[15] & 0x1F : record[16]);
}

// Flagged as to be treated as deleted.
bool is_withheld(const char* record, int format) {
    return (static_cast<unsigned char>(record[15]) & (format < 6 ? 0x80 : 0x04)) != 0;
}

}  // namespace

size_t LasHeader::rgb() const {
    return kFormats[format].rgb;
}

size_t LasHeader::extra() const {
    return kFormats[format].size;
}

LasClasses::LasClasses(const ReadCloudOptions& options) {
    if (!options.classes) {
        for (const uint8_t noise : kNoiseClasses)
            verdicts_[noise] = LasPoint::kNoise;
        return;
    }
    verdicts_.fill(LasPoint::kUnwanted);
    for (const uint8_t wanted : *options.classes)
        verdicts_[wanted] = LasPoint::kKept;
}

void settle_las(const ReadJob& job, const LasHeader& header, const LasPoints& points, RawCloud& raw) {
    const size_t count = raw.size();
    std::array<size_t, 4> counts{};
    for (const LasPoint verdict : points.verdicts)
        counts[static_cast<size_t>(verdict)]++;
    const auto number = [&](LasPoint verdict) { return counts[static_cast<size_t>(verdict)]; };
    if (number(LasPoint::kWithheld) == count)
        job.fail("holds no points but such as are flagged as withheld, that is, deleted.");
    if (number(LasPoint::kKept) == 0 && job.options.classes)
        job.fail("holds no points of the classes that were asked for; leave out --classes.");
    if (number(LasPoint::kKept) == 0)
        job.fail("holds no points but noise (classes 7 and 18); --classes all reads these too.");
    if (!header.label) {
        raw.labels.assign(points.classes.begin(), points.classes.end());
        raw.label_column = "classification";
    }
    if (number(LasPoint::kKept) != count) {
        std::vector<uint8_t> keep(count);
        for (size_t i = 0; i < count; i++)
            keep[i] = points.verdicts[i] == LasPoint::kKept;
        raw.keep_only(keep);
        const auto say = [&](LasPoint verdict, const char* what) {
            if (number(verdict) > 0)
                job.report.warnings.push_back(std::to_string(number(verdict)) + " of " +
                                              std::to_string(count) + " points are " + what +
                                              " and were left out.");
        };
        say(LasPoint::kWithheld, "flagged as withheld");
        say(LasPoint::kNoise, "of the classes 7 or 18, noise,");
        say(LasPoint::kUnwanted, "of classes that were not asked for");
    }
    // Without two classes there is nothing to tell.
    if (!header.label && std::all_of(raw.labels.begin(), raw.labels.end(),
                                     [&](float label) { return label == raw.labels.front(); }))
        raw.labels = {};
    raw.unit = header.unit;
    // The specification wants 16-bit colours, but many programs write 8-bit ones.
    float largest = 0.0F;
    for (const Vec3& c : raw.colors)
        largest = std::max({largest, c.r, c.g, c.b});
    raw.color_white = largest <= 255.0F ? 255.0F : 65535.0F;
}

RawCloud read_las(const ReadJob& job) {
    LasHeader header = read_header(job);
    job.report.format = (header.compressed ? "LAZ " : "LAS ") + header.version + ", point format " +
                        std::to_string(header.format);
    settle_units(job, header);
    find_label(job, header);
    if (header.compressed) return read_laz(job, header);
    const std::string_view bytes = job.bytes.view();
    const uint64_t found = header.data >= bytes.size() ? 0 : (bytes.size() - header.data) / header.stride;
    if (found < header.count)
        job.fail("is cut off: its header promises " + std::to_string(header.count) +
                 " points, but it holds " + std::to_string(found) + "; copy it again.");

    const size_t count = static_cast<size_t>(header.count);
    const size_t rgb = header.rgb();
    RawCloud raw;
    make_room(job, raw.positions, count);
    if (rgb) make_room(job, raw.colors, count);
    if (header.label) make_room(job, raw.labels, count);
    const LasClasses classes(job.options);
    LasPoints points{std::vector<LasPoint>(count), std::vector<uint8_t>(count)};
    job.parallel(count, kBlock, kFileRead, kPointsRead, [&](size_t begin, size_t end) {
        const char* record = bytes.data() + header.data + begin * header.stride;
        for (size_t i = begin; i < end; i++, record += header.stride) {
            const DVec3 steps(little<int32_t>(record), little<int32_t>(record + 4),
                              little<int32_t>(record + 8));
            raw.positions[i] = steps * header.scale + header.offset;
            points.classes[i] = class_of(record, header.format);
            points.verdicts[i] = classes.judge(points.classes[i], is_withheld(record, header.format));
            if (rgb)
                raw.colors[i] = Vec3(little<uint16_t>(record + rgb), little<uint16_t>(record + rgb + 2),
                                     little<uint16_t>(record + rgb + 4));
        }
        if (header.label)
            decode_column(
                {bytes.data() + header.data + begin * header.stride + header.extra() + header.label->offset,
                 header.stride, header.label->type, kSwap},
                end - begin, kRoleLabel, begin, raw);
    });
    if (header.label) raw.label_column = header.label->name;
    settle_las(job, header, points, raw);
    return raw;
}

}  // namespace treerec
