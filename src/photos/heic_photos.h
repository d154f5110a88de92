// HEIC photos, as phones save them, become JPEGs, with a program that is on this machine.
#pragma once

#include <string>
#include <vector>

#include "progress.h"

namespace treerec {

struct ReadablePhotos {
    std::string folder;                 // that COLMAP can read: the one that was given, or out/photos
    size_t converted = 0;               // photos in it that were HEIC
    std::vector<std::string> warnings;  // on those that could not be converted, and are left out
};

// Where a folder has HEIC, HEIF or AVIF photos without a JPEG of the same name beside them: makes out/photos
// of all its photos, these as JPEGs at their full size, the others as links to them, or copies. Needs one of
// heif-dec, heif-convert, sips and magick; without any, and without HEIC, the folder itself is the answer.
// What they say goes into out/photos.log; the photos are only read. Photos that are there from the same file
// are taken. Throws Error with a sentence (no folder, too few photos, none can be converted), or Cancelled.
ReadablePhotos readable_photos(const std::string& folder, const std::string& out,
                               Progress* progress = nullptr);

}  // namespace treerec
