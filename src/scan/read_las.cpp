// LAS 1.0-1.4, point formats 0-10: ASPRS, "LAS Specification 1.4 - R15", sections 2.4 and 2.6.
#include "scan/read_las.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>

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

}  // namespace

size_t LasHeader::rgb() const {
    return kFormats[format].rgb;
}

bool is_withheld(const char* record, int format) {
    return (static_cast<unsigned char>(record[15]) & (format < 6 ? 0x80 : 0x04)) != 0;
}

void settle_las(const ReadJob& job, const std::vector<uint8_t>& withheld, RawCloud& raw) {
    const size_t count = raw.size();
    const size_t out = std::accumulate(withheld.begin(), withheld.end(), size_t{0});
    if (out == count) job.fail("holds no points but such as are flagged as withheld, that is, deleted.");
    if (out > 0) {
        std::vector<uint8_t> keep(count);
        for (size_t i = 0; i < count; i++)
            keep[i] = !withheld[i];
        raw.keep_only(keep);
        job.report.warnings.push_back(std::to_string(out) + " of " + std::to_string(count) +
                                      " points are flagged as withheld and were left out.");
    }
    // The specification wants 16-bit colours, but many programs write 8-bit ones.
    float largest = 0.0F;
    for (const Vec3& c : raw.colors)
        largest = std::max({largest, c.r, c.g, c.b});
    raw.color_white = largest <= 255.0F ? 255.0F : 65535.0F;
}

RawCloud read_las(const ReadJob& job) {
    const LasHeader header = read_header(job);
    job.report.format = (header.compressed ? "LAZ " : "LAS ") + header.version + ", point format " +
                        std::to_string(header.format);
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
    std::vector<uint8_t> withheld(count);
    job.parallel(count, kBlock, kFileRead, kPointsRead, [&](size_t begin, size_t end) {
        const char* record = bytes.data() + header.data + begin * header.stride;
        for (size_t i = begin; i < end; i++, record += header.stride) {
            const DVec3 steps(little<int32_t>(record), little<int32_t>(record + 4),
                              little<int32_t>(record + 8));
            raw.positions[i] = steps * header.scale + header.offset;
            withheld[i] = is_withheld(record, header.format);
            if (rgb)
                raw.colors[i] = Vec3(little<uint16_t>(record + rgb), little<uint16_t>(record + rgb + 2),
                                     little<uint16_t>(record + rgb + 4));
        }
    });
    settle_las(job, withheld, raw);
    return raw;
}

}  // namespace treerec
