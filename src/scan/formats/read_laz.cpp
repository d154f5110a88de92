// LAZ through LASzip's C interface.
#include <algorithm>
#include <bit>
#include <limits>
#include <memory>

#include "file_bytes.h"
#include "scan/formats/laszip_library.h"
#include "scan/formats/read_las.h"

namespace treerec {

namespace {

constexpr uint64_t kBlock = 16384;
// What of a point of the formats 6 to 10 is unpacked: laszip_DECOMPRESS_SELECTIVE_ Z, CLASSIFICATION, FLAGS
// and RGB, and EXTRA_BYTES where there is a label in them. The place on the ground is always.
constexpr uint32_t kParts = 0x1 | 0x2 | 0x4 | 0x100;
constexpr uint32_t kExtraParts = 0xFFFF0000;

// An open file; closed and freed whatever happens.
class Reader {
  public:
    Reader(const LaszipLibrary& laszip, const ReadJob& job, uint32_t parts) : laszip_(laszip), job_(job) {
        if (laszip_.create(&reader_) != 0) job_.fail("cannot be unpacked: LASzip does not start.");
        int is_compressed = 0;
        if (laszip_.decompress_selective(reader_, parts) != 0 ||
            laszip_.open_reader(reader_, job_.path.c_str(), &is_compressed) != 0) {
            const std::string why = error();
            laszip_.destroy(reader_);
            job_.fail("cannot be unpacked: LASzip says '" + why + "'.");
        }
    }
    ~Reader() {
        laszip_.close_reader(reader_);
        laszip_.destroy(reader_);
    }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    const LaszipPoint& point() const {
        LaszipPoint* point = nullptr;
        if (laszip_.get_point_pointer(reader_, &point) != 0 || !point)
            job_.fail("cannot be unpacked: LASzip says '" + error() + "'.");
        return *point;
    }
    bool next() const { return laszip_.read_point(reader_) == 0; }
    std::string error() const {
        char* text = nullptr;
        laszip_.get_error(reader_, &text);
        return text ? text : "nothing";
    }

  private:
    const LaszipLibrary& laszip_;
    const ReadJob& job_;
    void* reader_ = nullptr;
};

// What LASzip takes for granted: that its own record and the table of its chunks are where the header says.
// (LASzip 3 frees memory that it never had when a file ends within its records.) The record: M. Isenburg,
// "LASzip", 2013, section 3.
void require_sound_records(const ReadJob& job, const LasHeader& header) {
    constexpr size_t kRecordHeader = 54;
    constexpr uint16_t kLaszipRecord = 22204;
    constexpr bool kSwap = std::endian::native != std::endian::little;
    const std::string_view bytes = job.bytes.view();
    const char* begin = bytes.data();
    const auto damaged = [&] { job.fail("is damaged or cut off within its LAZ header; copy it again."); };
    size_t at = load_value<uint16_t>(begin + 94, kSwap);
    if (at < 227 || header.data > bytes.size() || at > header.data) damaged();
    bool found = false;
    for (uint32_t i = load_value<uint32_t>(begin + 100, kSwap); i > 0; i--) {
        if (header.data - at < kRecordHeader) damaged();
        const size_t length = load_value<uint16_t>(begin + at + 20, kSwap);
        if (header.data - at - kRecordHeader < length) damaged();
        const char* record = begin + at + kRecordHeader;
        if (load_value<uint16_t>(begin + at + 18, kSwap) == kLaszipRecord &&
            bytes.substr(at + 2).starts_with("laszip encoded")) {
            if (found || length < 34) damaged();
            found = true;
            const size_t items = load_value<uint16_t>(record + 32, kSwap);
            size_t size = 0;
            if (length != 34 + 6 * items) damaged();
            for (size_t item = 0; item < items; item++)
                size += load_value<uint16_t>(record + 36 + 6 * item, kSwap);
            if (size != header.stride) damaged();
        }
        at += kRecordHeader + length;
    }
    if (!found || bytes.size() - header.data < 8) damaged();
    int64_t table = load_value<int64_t>(begin + header.data, kSwap);
    // A writer that could not go back put it at the very end.
    if (table == -1) table = load_value<int64_t>(begin + bytes.size() - 8, kSwap);
    if (table < static_cast<int64_t>(header.data) + 8 || table > static_cast<int64_t>(bytes.size()) - 8)
        job.fail("is cut off or damaged: the table of its LAZ chunks is not in it; copy it again.");
}

float extra_value(const LaszipPoint& point, const LasExtraField& field) {
    constexpr bool kSwap = std::endian::native != std::endian::little;
    const size_t end = field.offset + size_of(field.type);
    if (!point.extra_bytes || point.extra_count < 0 || static_cast<size_t>(point.extra_count) < end)
        return std::numeric_limits<float>::quiet_NaN();
    return static_cast<float>(
        load_ply_value(reinterpret_cast<const char*>(point.extra_bytes) + field.offset, field.type, kSwap));
}

const LaszipLibrary& library_for(const ReadJob& job) {
    try {
        return laszip_library();
    } catch (const Error& error) {
        job.fail(std::string("is LAZ-compressed, and ") + error.what());
    }
}

}  // namespace

RawCloud read_laz(const ReadJob& job, const LasHeader& header) {
    const LaszipLibrary& laszip = library_for(job);
    require_sound_records(job, header);
    const Reader reader(laszip, job, header.label ? kParts | kExtraParts : kParts);
    const LaszipPoint& point = reader.point();
    const bool rgb = header.rgb() != 0;
    RawCloud raw;
    LasPoints points;
    const LasClasses classes(job.options);
    // A damaged header may promise anything; a point takes a byte or more, but for the very best compression.
    const size_t likely = static_cast<size_t>(std::min<uint64_t>(header.count, job.bytes.size));
    raw.positions.reserve(likely);
    if (rgb) raw.colors.reserve(likely);
    points.verdicts.reserve(likely);
    points.classes.reserve(likely);
    if (header.label) raw.labels.reserve(likely);
    for (uint64_t i = 0; i < header.count; i++) {
        if (i % kBlock == 0)
            job.step(kFileRead +
                     (kPointsRead - kFileRead) * static_cast<double>(i) / static_cast<double>(header.count));
        if (!reader.next())
            job.fail("is damaged or cut off: of its " + std::to_string(header.count) + " points " +
                     std::to_string(i) + " could be unpacked; copy it again.");
        raw.positions.push_back(DVec3(point.x, point.y, point.z) * header.scale + header.offset);
        if (rgb) raw.colors.emplace_back(point.rgb[0], point.rgb[1], point.rgb[2]);
        const bool old = header.format < 6;
        const bool withheld = old ? (point.classification >> 7) & 1 : (point.extended_flags >> 6) & 1;
        points.classes.push_back(
            static_cast<uint8_t>(old ? point.classification & 0x1F : point.extended_classification));
        points.verdicts.push_back(classes.judge(points.classes.back(), withheld));
        if (header.label) raw.labels.push_back(extra_value(point, *header.label));
    }
    if (header.label) raw.label_column = header.label->name;
    settle_las(job, header, points, raw);
    return raw;
}

}  // namespace treerec
