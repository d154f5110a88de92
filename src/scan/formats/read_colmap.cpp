// COLMAP's sparse points, points3D.bin: J. L. Schönberger, "Output Format", COLMAP's documentation. (The text
// form, points3D.txt, is an ordinary text cloud whose header names its columns.)
#include <bit>
#include <cmath>

#include "scan/formats/readers.h"

namespace treerec {

namespace {

constexpr bool kSwap = std::endian::native != std::endian::little;
constexpr size_t kCountSize = 8;
// Id, position, colour, reprojection error and the length of the track, whose entries follow.
constexpr size_t kPointSize = 8 + 24 + 3 + 8 + 8;
constexpr size_t kTrackEntrySize = 8;

uint64_t track_length(const char* point) {
    return load_value<uint64_t>(point + kPointSize - 8, kSwap);
}

// The bytes of the point at `at`, or 0 where the file ends within it.
size_t size_at(std::string_view bytes, size_t at) {
    if (bytes.size() - at < kPointSize) return 0;
    const uint64_t length = track_length(bytes.data() + at);
    if (length > (bytes.size() - at - kPointSize) / kTrackEntrySize) return 0;
    return kPointSize + static_cast<size_t>(length) * kTrackEntrySize;
}

}  // namespace

bool is_colmap(std::string_view bytes) {
    constexpr uint64_t kSample = 16;
    if (bytes.size() < kCountSize + kPointSize) return false;
    const uint64_t count = load_value<uint64_t>(bytes.data(), kSwap);
    if (count == 0 || count > (uint64_t{1} << 40)) return false;
    size_t at = kCountSize;
    for (uint64_t i = 0; i < std::min(count, kSample); i++) {
        // Cut off after a sound point, it is still one of them.
        if (bytes.size() - at < kPointSize) return i > 0;
        const char* point = bytes.data() + at;
        if (load_value<uint64_t>(point, kSwap) > (uint64_t{1} << 48)) return false;
        for (size_t k = 0; k < 3; k++)
            if (!(std::abs(load_value<double>(point + 8 + 8 * k, kSwap)) < 1e12)) return false;
        const double error = load_value<double>(point + 35, kSwap);
        // No point is seen more often than there are pictures.
        if (!(error >= -1.0 && error < 1e6) || track_length(point) > 10000000) return false;
        const size_t size = size_at(bytes, at);
        if (size == 0) return i > 0;
        at += size;
    }
    return true;
}

RawCloud read_colmap(const ReadJob& job) {
    const std::string_view bytes = job.bytes.view();
    const uint64_t count = load_value<uint64_t>(bytes.data(), kSwap);
    job.report.format = "COLMAP points3D.bin";
    RawCloud raw;
    raw.color_white = 255.0F;
    const size_t likely = static_cast<size_t>(std::min<uint64_t>(count, bytes.size() / kPointSize));
    raw.positions.reserve(likely);
    raw.colors.reserve(likely);
    size_t at = kCountSize;
    for (uint64_t i = 0; i < count; i++) {
        if (i % 16384 == 0)
            job.step(kFileRead +
                     (kPointsRead - kFileRead) * static_cast<double>(i) / static_cast<double>(count));
        const size_t size = size_at(bytes, at);
        if (size == 0)
            job.fail("is cut off: it promises " + std::to_string(count) + " points, but holds " +
                     std::to_string(i) + "; copy it again.");
        const char* point = bytes.data() + at;
        raw.positions.emplace_back(load_value<double>(point + 8, kSwap),
                                   load_value<double>(point + 16, kSwap),
                                   load_value<double>(point + 24, kSwap));
        raw.colors.emplace_back(load_value<uint8_t>(point + 32, kSwap),
                                load_value<uint8_t>(point + 33, kSwap),
                                load_value<uint8_t>(point + 34, kSwap));
        at += size;
    }
    return raw;
}

}  // namespace treerec
