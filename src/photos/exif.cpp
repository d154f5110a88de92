#include "photos/exif.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>

#include "file_bytes.h"
#include "photos/jpeg_segments.h"

namespace treerec {

namespace {

constexpr std::string_view kExif("Exif\0\0", 6);

enum Tag : uint32_t {
    kOrientation = 0x0112,
    kGpsRecord = 0x8825,
    kLatitudeRef = 1,
    kLatitude = 2,
    kLongitudeRef = 3,
    kLongitude = 4,
    kError = 31,
};

enum Type : uint32_t { kShort = 3, kLong = 4, kRational = 5 };

// One value of a record: its type, how many there are, and where.
struct Entry {
    uint32_t type = 0;
    uint32_t count = 0;
    size_t at = 0;
};

// A TIFF file, of which all places are checked before they are read.
class Tiff {
  public:
    explicit Tiff(std::string_view bytes) : bytes_(bytes) {}

    // Whether it begins as one.
    bool begins() {
        if (bytes_.size() < 8) return false;
        big_ = bytes_.starts_with("MM");
        return (big_ || bytes_.starts_with("II")) && whole(2, 2) == 42U;
    }
    // The bytes there as a number; nothing beyond the end.
    std::optional<uint32_t> whole(size_t at, size_t count) const {
        if (at > bytes_.size() || count > bytes_.size() - at) return {};
        uint32_t value = 0;
        for (size_t i = 0; i < count; i++) {
            const auto byte = static_cast<unsigned char>(bytes_[at + (big_ ? i : count - 1 - i)]);
            value = value << 8U | byte;
        }
        return value;
    }
    // Looks a tag up in the record that begins there.
    std::optional<Entry> find(size_t record, uint32_t tag) const {
        const std::optional<uint32_t> count = whole(record, 2);
        if (!count) return {};
        for (size_t i = 0; i < *count; i++) {
            const size_t at = record + 2 + 12 * i;
            const std::optional<uint32_t> own = whole(at, 2), last = whole(at + 8, 4);
            if (!own || !last) return {};
            if (*own != tag) continue;
            Entry entry{whole(at + 2, 2).value_or(0), whole(at + 4, 4).value_or(0), at + 8};
            const uint64_t size = entry.type == kRational ? 8 : entry.type == kLong ? 4 : 1;
            if (size * entry.count > 4) entry.at = *last;
            return entry;
        }
        return {};
    }
    // One of the fractions of an entry. empty: what 0/0 means, as some write it for what they do not know.
    std::optional<double> fraction(const Entry& entry, uint32_t index,
                                   std::optional<double> empty = {}) const {
        if (entry.type != kRational || index >= entry.count) return {};
        const size_t at = entry.at + size_t{8} * index;
        const std::optional<uint32_t> over = whole(at, 4), under = whole(at + 4, 4);
        if (!over || !under) return {};
        if (*under == 0) return *over == 0 ? empty : std::nullopt;
        return static_cast<double>(*over) / *under;
    }
    char letter(const std::optional<Entry>& entry) const {
        if (!entry || entry->count < 1) return '\0';
        return static_cast<char>(whole(entry->at, 1).value_or(0));
    }

  private:
    std::string_view bytes_;
    bool big_ = false;
};

// Degrees, minutes and seconds as degrees, up to `most`; negative where the letter is `negative`.
std::optional<double> angle(const Tiff& tiff, size_t record, uint32_t tag, uint32_t ref,
                            std::string_view letters, double most) {
    const std::optional<Entry> entry = tiff.find(record, tag);
    const char letter = tiff.letter(tiff.find(record, ref));
    if (!entry || letter == '\0' || letters.find(letter) == std::string_view::npos) return {};
    double degrees = 0.0, unit = 1.0;
    for (uint32_t i = 0; i < 3 && (i == 0 || i < entry->count); i++) {
        const std::optional<double> part =
            tiff.fraction(*entry, i, i > 0 ? std::optional(0.0) : std::nullopt);
        if (!part) return {};
        degrees += *part / unit;
        unit *= 60.0;
    }
    if (!(degrees <= most)) return {};
    return letter == letters[1] ? -degrees : degrees;
}

std::optional<PhotoPlace> place_in(std::string_view bytes) {
    Tiff tiff(bytes);
    if (!tiff.begins()) return {};
    const std::optional<Entry> pointer = tiff.find(tiff.whole(4, 4).value_or(0), kGpsRecord);
    if (!pointer || pointer->type != kLong) return {};
    const std::optional<uint32_t> record = tiff.whole(pointer->at, 4);
    if (!record) return {};
    const std::optional<double> latitude = angle(tiff, *record, kLatitude, kLatitudeRef, "NS", 90.0),
                                longitude = angle(tiff, *record, kLongitude, kLongitudeRef, "EW", 180.0);
    if (!latitude || !longitude || (*latitude == 0.0 && *longitude == 0.0)) return {};
    PhotoPlace place;
    place.latitude = *latitude;
    place.longitude = *longitude;
    if (const std::optional<Entry> entry = tiff.find(*record, kError)) {
        const std::optional<double> error = tiff.fraction(*entry, 0);
        if (error && *error > 0.0) place.error = error;
    }
    return place;
}

// The EXIF record of a JPEG, empty where there is none.
std::string exif_record(std::istream& jpeg) {
    std::string record;
    each_jpeg_segment(jpeg, [&](int marker, size_t size) {
        if (marker != 0xE1) return true;
        std::string segment(size, '\0');
        jpeg.read(segment.data(), static_cast<std::streamsize>(size));
        segment.resize(static_cast<size_t>(jpeg.gcount()));
        if (!segment.starts_with(kExif)) return true;
        record = segment.substr(kExif.size());
        return false;
    });
    return record;
}

}  // namespace

std::optional<PhotoPlace> read_photo_place(std::istream& jpeg) {
    return place_in(exif_record(jpeg));
}

std::optional<PhotoPlace> read_photo_place(const std::string& path) {
    std::ifstream in(path_of(path), std::ios::binary);
    return read_photo_place(in);
}

int read_photo_orientation(std::istream& jpeg) {
    const std::string record = exif_record(jpeg);
    Tiff tiff(record);
    if (!tiff.begins()) return 1;
    const std::optional<Entry> entry = tiff.find(tiff.whole(4, 4).value_or(0), kOrientation);
    if (!entry || entry->type != kShort || entry->count != 1) return 1;
    const uint32_t told = tiff.whole(entry->at, 2).value_or(1);
    return told >= 1 && told <= 8 ? static_cast<int>(told) : 1;
}

}  // namespace treerec
