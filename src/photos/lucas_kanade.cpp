#include "photos/lucas_kanade.h"

#include <algorithm>
#include <cmath>

namespace treerec {

namespace {

// The step that (4.3)'s least squares give. false: the window leaves `to`.
bool step_of(const TrackWindow& window, const GreyPicture& to, const DVec2& at, DVec2& pull) {
    const int reach = window.reach;
    if (!to.has(at.x - reach, at.y - reach) || !to.has(at.x + reach, at.y + reach)) return false;
    const int side = 2 * reach + 1;
    double x = 0.0, y = 0.0;
    size_t i = 0;
    for (int v = 0; v < side; v++)
        for (int u = 0; u < side; u++, i++) {
            const float seen =
                to.at(static_cast<float>(at.x + u - reach), static_cast<float>(at.y + v - reach));
            const auto less = static_cast<double>(window.grey[i] - seen);  // -I_t
            x += static_cast<double>(window.dx[i]) * less;
            y += static_cast<double>(window.dy[i]) * less;
        }
    pull = {x, y};
    return true;
}

}  // namespace

bool TrackWindow::take(const GreyPicture& picture, const DVec2& middle, int half) {
    // One pixel more on each side, for the slopes.
    if (!picture.has(middle.x - half - 1, middle.y - half - 1) ||
        !picture.has(middle.x + half + 1, middle.y + half + 1))
        return false;
    reach = half;
    const int side = 2 * half + 1, wide = side + 2;
    std::array<float, (2 * kMostReach + 3) * (2 * kMostReach + 3)> around;
    const int left = static_cast<int>(middle.x) - half - 1, top = static_cast<int>(middle.y) - half - 1;
    const auto s = static_cast<float>(middle.x - std::floor(middle.x)),
               t = static_cast<float>(middle.y - std::floor(middle.y));
    const float a = (1 - s) * (1 - t), b = s * (1 - t), c = (1 - s) * t, d = s * t;
    for (int y = 0; y < wide; y++) {
        // At the last row and column the next pixel may be beyond the picture; its share is 0 then.
        const uint8_t* above = picture.row(top + y) + left;
        const uint8_t* below = picture.row(std::min(top + y + 1, picture.height - 1)) + left;
        float* out = around.data() + static_cast<size_t>(y) * static_cast<size_t>(wide);
        for (int x = 0; x < wide; x++) {
            const int next = std::min(x + 1, picture.width - 1 - left);
            out[x] = a * static_cast<float>(above[x]) + b * static_cast<float>(above[next]) +
                     c * static_cast<float>(below[x]) + d * static_cast<float>(below[next]);
        }
    }
    size_t i = 0;
    for (int y = 1; y <= side; y++) {
        const float* here = around.data() + static_cast<size_t>(y) * static_cast<size_t>(wide);
        for (int x = 1; x <= side; x++, i++) {
            grey[i] = here[x];
            dx[i] = 0.5F * (here[x + 1] - here[x - 1]);
            dy[i] = 0.5F * (here[x + wide] - here[x - wide]);
        }
    }
    return true;
}

std::optional<DVec2> track_lucas_kanade(const GreyPyramid& from, const GreyPyramid& to, const DVec2& place,
                                        const DVec2& guess, const LucasKanadeOptions& options) {
    const size_t levels = std::min(from.levels.size(), to.levels.size());
    const int reach = std::clamp(options.reach, 1, kMostReach);
    DVec2 moved = guess - place;  // in pixels of the picture itself
    TrackWindow window;
    for (size_t level = levels; level-- > 0;) {
        const double size = static_cast<double>(1 << level);
        const DVec2 here = place / size;
        DVec2 shift = moved / size;
        bool inside = window.take(from.levels[level], here, reach);
        if (inside) {
            double xx = 0.0, xy = 0.0, yy = 0.0;
            for (size_t i = 0; i < window.count(); i++) {
                xx += static_cast<double>(window.dx[i] * window.dx[i]);
                xy += static_cast<double>(window.dx[i] * window.dy[i]);
                yy += static_cast<double>(window.dy[i] * window.dy[i]);
            }
            const double root = std::sqrt((xx - yy) * (xx - yy) + 4.0 * xy * xy);
            const double eigen = 0.5 * (xx + yy - root) / static_cast<double>(window.count());
            if (!(eigen >= options.least_eigen)) {
                if (level == 0) return {};
                continue;
            }
            const double determinant = xx * yy - xy * xy;
            for (int i = 0; i < options.iterations && inside; i++) {
                DVec2 pull(0.0);
                inside = step_of(window, to.levels[level], here + shift, pull);
                const DVec2 step((yy * pull.x - xy * pull.y) / determinant,
                                 (xx * pull.y - xy * pull.x) / determinant);
                if (!inside) break;
                shift += step;
                if (glm::dot(step, step) < options.still * options.still) break;
            }
        }
        if (!inside) {
            if (level == 0) return {};
            continue;
        }
        moved = shift * size;
    }
    const DVec2 end = place + moved;
    const GreyPicture& other = to.levels[0];
    if (!other.has(end.x - reach, end.y - reach) || !other.has(end.x + reach, end.y + reach)) return {};
    return end;
}

}  // namespace treerec
