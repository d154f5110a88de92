// A film of a walk around a tree becomes photos, with the program ffmpeg.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "progress.h"

namespace treerec {

// The film that `input` means: itself, where it is a file; the one in it, where it is a folder with fewer
// than kLeastPhotos photos. Nothing where it is a folder of photos. Throws Error for one with several films
// and too few photos.
std::optional<std::string> film_of(const std::string& input);

struct FilmPhotos {
    std::string folder;  // out/frames, in the order of the walk by name
    size_t photos = 0;
    double seconds = 0.0;  // that the film takes
};

// Takes the frames that choose_frames() chooses out of a film at its full size. Their names tell where in the
// film they are: "frame_00012.033s.jpg". What ffmpeg says goes into
// out/photos.log; the film is only read. Frames that are there from the same film are taken. Throws Error
// with a sentence (no ffmpeg, no film, no walk, too short, …), or Cancelled.
FilmPhotos photos_of_film(const std::string& film, const std::string& out, Progress* progress = nullptr);

}  // namespace treerec
