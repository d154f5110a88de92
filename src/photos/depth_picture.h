// How far away what a camera sees is, by pixel.
#pragma once

#include <vector>

#include "geometry/vec.h"
#include "photos/pinhole_view.h"

namespace treerec {

// Distances along the axis of the view, in the view's space (metres).
class DepthPicture {
  public:
    // Nothing is there yet.
    explicit DepthPicture(const PinholeView& view);

    const PinholeView& view() const { return view_; }

    // A ball before or behind others. thinnest: pixels; it is drawn with that radius at least.
    void put(const DVec3& place, double radius, double thinnest);

    // Whether there is anything nearer than `far` in a square. at, reach: its middle and half its edge, in
    // pixels of the view.
    bool hides(const DVec2& at, double reach, double far) const;

  private:
    float& at(int x, int y) {
        return depth_[static_cast<size_t>(y) * static_cast<size_t>(view_.width) + static_cast<size_t>(x)];
    }
    PinholeView view_;
    std::vector<float> depth_;
};

}  // namespace treerec
