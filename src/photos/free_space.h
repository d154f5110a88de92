// What photos see through: nothing stands between a camera and what it sees.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/vec.h"
#include "photos/rectify.h"
#include "progress.h"

namespace treerec {

// How far one photo looks, by what one pair sees in it.
class FreeSpace {
  public:
    FreeSpace() = default;
    explicit FreeSpace(const LoadedPhoto& photo);

    // place: what the photo sees, in the model. unsure: of its depth, in the model's unit.
    void add(const DVec3& place, double unsure);

    // Whether the photo sees what lies behind this place by more than `slack` (the model's unit) and what is
    // unsure of it: a free-space violation (Merrell et al., "Real-time visibility-based fusion of depth
    // maps", 2007). The nearest of what a square of two pixels sees counts, so that what is thin stays.
    bool sees_through(const DVec3& place, double slack) const;

  private:
    size_t square_of(const DVec3& seen) const;

    const Photo* photo_ = nullptr;
    const Camera* camera_ = nullptr;
    double squares_ = 0.0;  // of the camera's pixel
    int width_ = 0, height_ = 0;
    std::vector<float> depths_;  // less what is unsure; 0: none
};

// By place, how many of them see through it. Throws Cancelled.
std::vector<uint32_t> count_seen_through(std::span<const DVec3> places, std::span<const FreeSpace> photos,
                                         double slack, const Progress* progress = nullptr);

}  // namespace treerec
