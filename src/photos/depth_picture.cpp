#include "photos/depth_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace treerec {

DepthPicture::DepthPicture(const PinholeView& view)
    : view_(view),
      depth_(static_cast<size_t>(view.width) * static_cast<size_t>(view.height),
             std::numeric_limits<float>::max()) {}

bool DepthPicture::hides(const DVec2& at, double reach, double far) const {
    for (int k = 0; k < 9; k++) {
        const int x = static_cast<int>(std::floor(at.x + reach * (k % 3 - 1)));
        const int y = static_cast<int>(std::floor(at.y + reach * (k / 3 - 1)));
        if (x < 0 || y < 0 || x >= view_.width || y >= view_.height) continue;
        if (depth_[static_cast<size_t>(y) * static_cast<size_t>(view_.width) + static_cast<size_t>(x)] < far)
            return true;
    }
    return false;
}

void DepthPicture::put(const DVec3& place, double radius, double thinnest) {
    const auto middle = view_.project(place);
    if (!middle) return;
    const double far = glm::dot(-view_.turn[2], place - view_.centre);
    const double reach = std::max(thinnest, radius * view_.focal / far);
    if (middle->x + reach < 0.0 || middle->y + reach < 0.0 || middle->x - reach > view_.width ||
        middle->y - reach > view_.height)
        return;
    const int left = static_cast<int>(std::max(middle->x - reach, 0.0));
    const int right = static_cast<int>(std::min(middle->x + reach, view_.width - 1.0));
    const int top = static_cast<int>(std::max(middle->y - reach, 0.0));
    const int bottom = static_cast<int>(std::min(middle->y + reach, view_.height - 1.0));
    for (int y = top; y <= bottom; y++)
        for (int x = left; x <= right; x++) {
            const DVec2 off = DVec2(x + 0.5, y + 0.5) - *middle;
            if (glm::dot(off, off) <= reach * reach)
                at(x, y) = std::min(at(x, y), static_cast<float>(far - radius));
        }
}

}  // namespace treerec
