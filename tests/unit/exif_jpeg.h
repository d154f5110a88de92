// JPEGs that say where they were taken.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "photos/exif.h"

namespace treerec::test {

// An EXIF record as a file of TIFF, of either order of bytes.
class ExifWriter {
  public:
    explicit ExifWriter(bool big) : big_(big) {}

    std::string write(const PhotoPlace& place) const {
        struct Field {
            uint32_t tag, type, count;
            std::string value;
        };
        std::vector<Field> fields = {{1, 2, 2, place.latitude < 0.0 ? "S" : "N"},
                                     {2, 5, 3, angle(place.latitude)},
                                     {3, 2, 2, place.longitude < 0.0 ? "W" : "E"},
                                     {4, 5, 3, angle(place.longitude)}};
        if (place.error) fields.push_back({31, 5, 1, fraction(*place.error, 1000)});
        constexpr uint32_t kRecord = 26;
        std::string bytes = (big_ ? "MM" : "II") + number(42, 2) + number(8, 4) + number(1, 2) +
                            number(0x8825, 2) + number(4, 2) + number(1, 4) + number(kRecord, 4) +
                            number(0, 4);
        bytes += number(static_cast<uint32_t>(fields.size()), 2);
        const auto end = static_cast<uint32_t>(kRecord + 2 + 12 * fields.size() + 4);
        std::string beyond;
        for (const Field& field : fields) {
            bytes += number(field.tag, 2) + number(field.type, 2) + number(field.count, 4);
            if (field.value.size() > 4) {
                bytes += number(end + static_cast<uint32_t>(beyond.size()), 4);
                beyond += field.value;
            } else {
                bytes += field.value + std::string(4 - field.value.size(), '\0');
            }
        }
        return bytes + number(0, 4) + beyond;
    }

    std::string number(uint32_t value, int size) const {
        std::string bytes;
        for (int i = 0; i < size; i++)
            bytes += static_cast<char>(value >> 8 * (big_ ? size - 1 - i : i) & 255);
        return bytes;
    }
    std::string fraction(double value, uint32_t under) const {
        return number(static_cast<uint32_t>(std::lround(value * under)), 4) + number(under, 4);
    }

  private:
    // To 10^-7 degrees, a centimetre.
    std::string angle(double degrees) const {
        return fraction(std::abs(degrees), 10000000) + fraction(0.0, 1) + fraction(0.0, 1);
    }

    bool big_;
};

// In front of all that follows a JPEG's first two bytes.
inline std::string with_exif(const std::string& jpeg, const std::string& tiff) {
    const std::string record = std::string("Exif\0\0", 6) + tiff;
    const size_t size = record.size() + 2;
    return jpeg.substr(0, 2) + "\xFF\xE1" + static_cast<char>(size >> 8U) + static_cast<char>(size & 255U) +
           record + jpeg.substr(2);
}

inline std::optional<PhotoPlace> place_in_jpeg(const std::string& bytes) {
    std::istringstream jpeg(bytes);
    return read_photo_place(jpeg);
}

}  // namespace treerec::test
