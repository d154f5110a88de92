// The photos in a folder, without their pixels.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace treerec {

// Of which a tree can be made.
inline constexpr size_t kLeastPhotos = 8;

struct PhotoFile {
    std::string name;  // in the folder, UTF-8
    uint64_t bytes = 0;
    int64_t written = 0;  // in the file system's own count
    int width = 0;        // pixels, as stored; 0 where the kind of file does not tell it here
    int height = 0;
};

struct PhotoFolder {
    std::string path;               // absolute
    std::vector<PhotoFile> photos;  // JPEG, PNG, TIFF, BMP: what COLMAP reads, by name
    std::vector<std::string> warnings;

    // Whether one camera may have taken them all.
    bool one_size() const;
};

// By their endings: what COLMAP reads, and films.
bool is_photo_name(const std::string& name);
bool is_film_name(const std::string& name);

// Throws Error where the folder is none, or has no photos: with a word on pictures of phones that have to
// be converted.
PhotoFolder list_photos(const std::string& folder);

}  // namespace treerec
