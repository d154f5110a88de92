// The photos in a folder, without their pixels.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
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
    std::vector<PhotoFile> heics;   // what it doesn't, without those that have a JPEG of the same name beside
    std::vector<std::string> warnings;

    // Whether one camera may have taken them all.
    bool one_size() const;
};

// By their endings: what COLMAP reads, what phones save instead (HEIC, HEIF, AVIF), and films.
bool is_photo_name(const std::string& name);
bool is_heic_name(const std::string& name);
bool is_film_name(const std::string& name);

// In pixels, as a JPEG's or PNG's head says; zeros where it says nothing, or the file is another.
std::pair<int, int> size_of_picture(const std::string& path);

// Throws Error where the folder is none, or has no photos at all.
PhotoFolder list_all_photos(const std::string& folder);

// For those that COLMAP reads: where there is none, Error with a word on pictures of phones that have to be
// converted; where there are both, that is a warning.
PhotoFolder list_photos(const std::string& folder);

}  // namespace treerec
