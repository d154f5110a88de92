// LAZ through LASzip's C interface.
#include <algorithm>
#include <memory>

#include "file_bytes.h"
#include "scan/laszip_library.h"
#include "scan/read_las.h"

namespace treerec {

namespace {

constexpr uint64_t kBlock = 16384;
// What of a point of the formats 6 to 10 is unpacked: laszip_DECOMPRESS_SELECTIVE_ Z, FLAGS and RGB. The
// place on the ground is always.
constexpr uint32_t kParts = 0x1 | 0x4 | 0x100;

// An open file; closed and freed whatever happens.
class Reader {
  public:
    Reader(const LaszipLibrary& laszip, const ReadJob& job) : laszip_(laszip), job_(job) {
        if (laszip_.create(&reader_) != 0) job_.fail("cannot be unpacked: LASzip does not start.");
        int is_compressed = 0;
        if (laszip_.decompress_selective(reader_, kParts) != 0 ||
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
    const Reader reader(laszip, job);
    const LaszipPoint& point = reader.point();
    const bool rgb = header.rgb() != 0;
    RawCloud raw;
    std::vector<uint8_t> withheld;
    // A damaged header may promise anything; a point takes a byte or more, but for the very best compression.
    const size_t likely = static_cast<size_t>(std::min<uint64_t>(header.count, job.bytes.size));
    raw.positions.reserve(likely);
    if (rgb) raw.colors.reserve(likely);
    withheld.reserve(likely);
    for (uint64_t i = 0; i < header.count; i++) {
        if (i % kBlock == 0)
            job.step(kFileRead +
                     (kPointsRead - kFileRead) * static_cast<double>(i) / static_cast<double>(header.count));
        if (!reader.next())
            job.fail("is damaged or cut off: of its " + std::to_string(header.count) + " points " +
                     std::to_string(i) + " could be unpacked; copy it again.");
        raw.positions.push_back(DVec3(point.x, point.y, point.z) * header.scale + header.offset);
        if (rgb) raw.colors.emplace_back(point.rgb[0], point.rgb[1], point.rgb[2]);
        withheld.push_back(header.format < 6 ? (point.classification >> 7) & 1
                                             : (point.extended_flags >> 6) & 1);
    }
    settle_las(job, withheld, raw);
    return raw;
}

}  // namespace treerec
