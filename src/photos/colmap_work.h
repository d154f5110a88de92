// What the stages of one run of COLMAP share. Internal to photos/.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "file_bytes.h"
#include "photos/colmap_job.h"
#include "photos/photo_folder.h"
#include "photos/run_colmap.h"

namespace treerec {

// Where the stages end, as shares of the whole (71 photos on two cores: 30, 490 and 10 s).
inline constexpr double kFeaturesEnd = 0.1;
inline constexpr double kMatchingEnd = 0.9;

struct Effort {
    int pixels;    // of a photo's longer side
    int features;  // of a photo
};

Effort effort_of(PhotoEffort effort);

// All there is to know while the stages run.
struct ColmapWork {
    ColmapJob& job;
    const PhotoFolder& photos;
    const ColmapOptions& options;
    std::filesystem::path folder;    // out/colmap
    std::filesystem::path sparse;    // out/sparse
    double sift_end = kMatchingEnd;  // where SIFT's matching ends, as a share of the whole
    std::vector<size_t> features{};  // of the photos that are new
    size_t usual_features = 0;       // of a photo; 0 where COLMAP did not tell
    size_t unreadable = 0;
    std::vector<std::string> warnings{};  // of the stages

    std::string at(const std::string& name) const { return utf8_of(folder / name); }

    // Whether neighbours by name alone are compared.
    bool in_sequence() const;
    void set_threads(ColmapCall& call, const OptionNames& names) const;
    // Of a call that reads the photos: all were taken by one camera.
    void set_one_camera(ColmapCall& call) const;
    // Throws Error.
    void remove_database(const std::string& name) const;
    // Runs a call on the graphics card where COLMAP can, and where that fails, without.
    ColmapEnd run_on_either(const ColmapCall& call, const OptionNames& use_gpu,
                            const std::function<void()>& begin_anew,
                            const std::function<void(const std::string&)>& on_line) const;
};

// What a stage's result depends on: that of the one before, and its own calls.
std::string basis_of(const std::string& before, const std::vector<ColmapCall>& calls);

}  // namespace treerec
