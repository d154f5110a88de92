// LAS 1.0-1.4, point formats 0-10: ASPRS, "LAS Specification 1.4 - R15", sections 2.4 and 2.6.
#include <algorithm>
#include <bit>
#include <cstring>

#include "scan/readers.h"

namespace treerec {

namespace {

template <typename T>
T little(const char* p) {
    T value;
    if constexpr (std::endian::native == std::endian::little) {
        std::memcpy(&value, p, sizeof(T));
    } else {
        char turned[sizeof(T)];
        for (size_t i = 0; i < sizeof(T); i++)
            turned[i] = p[sizeof(T) - 1 - i];
        std::memcpy(&value, turned, sizeof(T));
    }
    return value;
}

struct PointFormat {
    size_t size;  // of a record, without extra bytes
    size_t rgb;   // offset of the colours in it; 0: none
};

constexpr PointFormat kFormats[] = {{20, 0}, {28, 0},  {26, 20}, {34, 28}, {57, 0}, {63, 28},
                                    {30, 0}, {36, 30}, {38, 30}, {59, 0},  {67, 30}};
constexpr size_t kBlock = 65536;

}  // namespace

RawCloud read_las(const ReadJob& job) {
    const std::string_view bytes = job.bytes.view();
    const char* header = bytes.data();
    if (bytes.size() < 227) job.fail("is a LAS file cut off within its header; copy it again.");
    const int major = static_cast<unsigned char>(header[24]);
    const int minor = static_cast<unsigned char>(header[25]);
    const std::string version = std::to_string(major) + "." + std::to_string(minor);
    if (major != 1 || minor > 4) job.fail("is of LAS version " + version + "; versions 1.0 to 1.4 are read.");
    const int format_byte = static_cast<unsigned char>(header[104]);
    if (format_byte & 0xC0) job.fail("is LAZ-compressed; unpack it to .las first.");
    if (format_byte > 10)
        job.fail("has LAS point format " + std::to_string(format_byte) + "; formats 0 to 10 are read.");
    const PointFormat& format = kFormats[format_byte];

    const size_t data = little<uint32_t>(header + 96);
    const size_t stride = little<uint16_t>(header + 105);
    uint64_t count = little<uint32_t>(header + 107);
    if (minor >= 4) {
        if (bytes.size() < 375) job.fail("is a LAS file cut off within its header; copy it again.");
        if (const uint64_t long_count = little<uint64_t>(header + 247)) count = long_count;
    }
    const DVec3 scale(little<double>(header + 131), little<double>(header + 139),
                      little<double>(header + 147));
    const DVec3 offset(little<double>(header + 155), little<double>(header + 163),
                       little<double>(header + 171));
    if (!is_finite(scale) || !is_finite(offset) || scale.x == 0.0 || scale.y == 0.0 || scale.z == 0.0)
        job.fail("has a damaged LAS header: its scale or offset is not a usable number.");
    if (stride < format.size || data < 227)
        job.fail("has a damaged LAS header: the size or place of its points is impossible.");
    const uint64_t found = data >= bytes.size() ? 0 : (bytes.size() - data) / stride;
    if (found < count)
        job.fail("is cut off: its header promises " + std::to_string(count) + " points, but it holds " +
                 std::to_string(found) + "; copy it again.");
    if (count == 0) job.fail("holds no points.");
    job.report.format = "LAS " + version + ", point format " + std::to_string(format_byte);

    RawCloud raw;
    raw.positions.resize(count);
    if (format.rgb) raw.colors.resize(count);
    for (size_t begin = 0; begin < count; begin += kBlock) {
        const size_t end = std::min<size_t>(count, begin + kBlock);
        const char* record = bytes.data() + data + begin * stride;
        for (size_t i = begin; i < end; i++, record += stride) {
            raw.positions[i] =
                DVec3(little<int32_t>(record), little<int32_t>(record + 4), little<int32_t>(record + 8)) *
                    scale +
                offset;
            if (format.rgb) {
                const char* rgb = record + format.rgb;
                raw.colors[i] =
                    Vec3(little<uint16_t>(rgb), little<uint16_t>(rgb + 2), little<uint16_t>(rgb + 4));
            }
        }
        job.step(0.1 + 0.7 * static_cast<double>(end) / static_cast<double>(count));
    }
    // The specification wants 16-bit colours, but many programs write 8-bit ones.
    float largest = 0.0F;
    for (const Vec3& c : raw.colors)
        largest = std::max({largest, c.r, c.g, c.b});
    raw.color_white = largest <= 255.0F ? 255.0F : 65535.0F;
    return raw;
}

}  // namespace treerec
