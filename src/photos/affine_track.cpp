#include "photos/affine_track.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace treerec {

namespace {

constexpr size_t kUnknowns = 6;         // a11 a12 a13 a21 a22 a23
constexpr double kDamping = 0.02;       // of the affine part, beside the shift's diagonal
constexpr int kShiftFirst = 4;          // iterations of the first level that only move the window
constexpr double kLeastOnTheWay = 0.3;  // similarity at the smaller levels
constexpr double kLeastContrast = 2.0;  // grey levels: standard deviation of a window

// Values of a window, zeros after them up to a whole number of lanes.
constexpr size_t kLanes = 8;
using Values = std::array<float, (TrackWindow::kMost + kLanes - 1) / kLanes * kLanes>;

// In lanes, which the processor adds up at once, in an order that does not depend on it.
float dot(const Values& a, const Values& b, size_t count) {
    std::array<float, kLanes> sums{};
    for (size_t i = 0; i < count; i += kLanes)
        for (size_t k = 0; k < kLanes; k++)
            sums[k] += a[i + k] * b[i + k];
    return ((sums[0] + sums[4]) + (sums[1] + sums[5])) + ((sums[2] + sums[6]) + (sums[3] + sums[7]));
}

// Takes the mean off. The root of the sum of squares.
double centre(Values& values, size_t count) {
    std::array<float, kLanes> sums{};
    for (size_t i = 0; i < count; i += kLanes)
        for (size_t k = 0; k < kLanes; k++)
            sums[k] += values[i + k];
    float sum = 0.0F;
    for (const float part : sums)
        sum += part;
    const float mean = sum / static_cast<float>(count);
    for (size_t i = 0; i < count; i++)
        values[i] -= mean;
    return std::sqrt(static_cast<double>(dot(values, values, count)));
}

using Vector = std::array<double, kUnknowns>;
using Matrix = std::array<Vector, kUnknowns>;

// Cholesky's, for the equations number first, first + every, ...; false where they do not determine it.
class NormalEquations {
  public:
    bool prepare(const Matrix& h, std::array<size_t, kUnknowns> which, size_t count) {
        which_ = which;
        count_ = count;
        for (size_t i = 0; i < count; i++)
            for (size_t j = 0; j <= i; j++) {
                double sum = h[which[i]][which[j]];
                for (size_t k = 0; k < j; k++)
                    sum -= root_[i][k] * root_[j][k];
                if (i != j) {
                    root_[i][j] = sum / root_[j][j];
                } else {
                    if (!(sum > 1e-6 * h[which[i]][which[i]]) || !(sum > 0.0)) return false;
                    root_[i][i] = std::sqrt(sum);
                }
            }
        return true;
    }
    Vector solve(const Vector& b) const {
        Vector half{}, result{};
        for (size_t i = 0; i < count_; i++) {
            double sum = b[which_[i]];
            for (size_t k = 0; k < i; k++)
                sum -= root_[i][k] * half[k];
            half[i] = sum / root_[i][i];
        }
        for (size_t i = count_; i-- > 0;) {
            double sum = half[i];
            for (size_t k = i + 1; k < count_; k++)
                sum -= root_[k][i] * result[which_[k]];
            result[which_[i]] = sum / root_[i][i];
        }
        return result;
    }

  private:
    Matrix root_{};
    std::array<size_t, kUnknowns> which_{};
    size_t count_ = 0;
};

// The window of the first picture, ready to be found at one level.
class Template {
  public:
    enum class State { kOutside, kPlain, kReady };

    State take(const GreyPicture& picture, const DVec2& place, const LucasKanadeOptions& options) {
        const int reach = std::clamp(options.reach, 2, kMostReach);
        if (!window_.take(picture, place, reach)) return State::kOutside;
        const size_t count = window_.count();
        if (count < count_)
            for (Values* values : {&grey_, &seen_, &slopes_[0], &slopes_[1], &slopes_[2], &slopes_[3],
                                   &slopes_[4], &slopes_[5]})
                values->fill(0.0F);
        count_ = count;
        std::copy_n(window_.grey.begin(), count, grey_.begin());
        contrast_ = centre(grey_, count);
        if (!(contrast_ > kLeastContrast * std::sqrt(static_cast<double>(count)))) return State::kPlain;
        const float to_unit = 1.0F / static_cast<float>(reach);
        size_t i = 0;
        for (int y = -reach; y <= reach; y++)
            for (int x = -reach; x <= reach; x++, i++) {
                const float u = static_cast<float>(x) * to_unit, v = static_cast<float>(y) * to_unit;
                const float dx = window_.dx[i], dy = window_.dy[i];
                slopes_[0][i] = dx * u;
                slopes_[1][i] = dx * v;
                slopes_[2][i] = dx;
                slopes_[3][i] = dy * u;
                slopes_[4][i] = dy * v;
                slopes_[5][i] = dy;
            }
        // What brightness and contrast would explain is no motion: it is taken out of the slopes.
        for (auto& slope : slopes_) {
            centre(slope, count);
            const auto share =
                static_cast<float>(static_cast<double>(dot(slope, grey_, count)) / (contrast_ * contrast_));
            for (size_t k = 0; k < count; k++)
                slope[k] -= share * grey_[k];
        }
        Matrix h{};
        for (size_t a = 0; a < kUnknowns; a++)
            for (size_t b = 0; b <= a; b++)
                h[a][b] = h[b][a] = static_cast<double>(dot(slopes_[a], slopes_[b], count));
        const double shift = 0.5 * (h[2][2] + h[5][5]);
        const double mean = 0.5 * (h[2][2] + h[5][5]),
                     root = std::sqrt(0.25 * (h[2][2] - h[5][5]) * (h[2][2] - h[5][5]) + h[2][5] * h[2][5]);
        if (!(mean - root >= options.least_eigen * static_cast<double>(count))) return State::kPlain;
        for (const size_t k : {0, 1, 3, 4})
            h[k][k] += kDamping * shift;
        if (!shift_.prepare(h, {2, 5}, 2) || !whole_.prepare(h, {0, 1, 2, 3, 4, 5}, kUnknowns))
            return State::kPlain;
        return State::kReady;
    }

    // The warped window of the other picture; false where it leaves that, or is plain.
    bool look(const GreyPicture& picture, const AffineMotion& motion) {
        const int reach = window_.reach;
        const DVec2 right = motion.turn[0], down = motion.turn[1];
        const DVec2 far = static_cast<double>(reach) * (glm::abs(right) + glm::abs(down));
        if (!picture.has(motion.place.x - far.x, motion.place.y - far.y) ||
            !picture.has(motion.place.x + far.x, motion.place.y + far.y))
            return false;
        size_t i = 0;
        const auto step_x = static_cast<float>(right.x), step_y = static_cast<float>(right.y);
        for (int y = -reach; y <= reach; y++) {
            const DVec2 start =
                motion.place + static_cast<double>(y) * down - static_cast<double>(reach) * right;
            const auto at_x = static_cast<float>(start.x), at_y = static_cast<float>(start.y);
            for (int x = 0; x <= 2 * reach; x++, i++)
                seen_[i] =
                    picture.at(at_x + static_cast<float>(x) * step_x, at_y + static_cast<float>(x) * step_y);
        }
        seen_contrast_ = centre(seen_, count_);
        return seen_contrast_ > 0.5 * kLeastContrast * std::sqrt(static_cast<double>(count_));
    }

    // (4.8), of what look() saw.
    double similarity() const {
        return static_cast<double>(dot(grey_, seen_, count_)) / (contrast_ * seen_contrast_);
    }

    // Moves `motion` by the least squares of (4.6). How far that moves the window's middle and corners, at
    // most.
    double step(AffineMotion& motion, bool only_shift) const {
        const double gain = contrast_ / seen_contrast_;
        // The slopes are at right angles to the first window itself, which so drops out of the difference.
        Vector b{};
        for (size_t a = 0; a < kUnknowns; a++)
            b[a] = gain * static_cast<double>(dot(slopes_[a], seen_, count_));
        const Vector p = (only_shift ? shift_ : whole_).solve(b);
        // The slopes are the first picture's: the motion found there is undone before the one known.
        const double reach = window_.reach;
        const DMat2 change(1.0 + p[0] / reach, p[3] / reach, p[1] / reach, 1.0 + p[4] / reach);
        const double determinant = glm::determinant(change);
        if (!(determinant > 0.1)) return INFINITY;
        motion.turn = motion.turn * glm::inverse(change);
        const DVec2 back = motion.turn * DVec2(p[2], p[5]);
        motion.place -= back;
        return std::abs(p[0]) + std::abs(p[1]) + std::abs(p[2]) + std::abs(p[3]) + std::abs(p[4]) +
               std::abs(p[5]);
    }

  private:
    TrackWindow window_;
    size_t count_ = 0;
    Values grey_{};
    std::array<Values, kUnknowns> slopes_{};
    Values seen_{};
    double contrast_ = 0.0, seen_contrast_ = 0.0;
    NormalEquations shift_, whole_;
};

// Whether no direction is stretched or shrunk more, and nothing is mirrored.
bool is_plausible(const DMat2& turn, double most_stretch) {
    const double determinant = glm::determinant(turn);
    const double squares = glm::dot(turn[0], turn[0]) + glm::dot(turn[1], turn[1]);
    if (!(determinant > 0.0)) return false;
    const double root = std::sqrt(std::max(0.0, squares * squares - 4.0 * determinant * determinant));
    const double largest = 0.5 * (squares + root), most = most_stretch * most_stretch;
    return largest <= most && determinant * determinant >= largest / most;
}

}  // namespace

std::optional<AffineTrack> track_affine(const GreyPyramid& from, const GreyPyramid& to, const DVec2& place,
                                        const AffineMotion& guess, const AffineTrackOptions& options) {
    const size_t levels =
        std::min({from.levels.size(), to.levels.size(), std::max<size_t>(options.levels, 1)});
    AffineMotion motion = guess;
    Template window;
    bool first = true;
    for (size_t level = levels; level-- > 0;) {
        const double size = static_cast<double>(1 << level);
        const Template::State state = window.take(from.levels[level], place / size, options.window);
        if (state != Template::State::kReady) {
            if (level == 0) return {};
            continue;
        }
        AffineMotion here{motion.place / size, motion.turn};
        bool well = true;
        const int shifts = first ? kShiftFirst : 0;
        for (int i = 0; i < shifts + options.window.iterations && well; i++) {
            well = window.look(to.levels[level], here);
            if (!well) break;
            const double moved = window.step(here, i < shifts);
            well = is_plausible(here.turn, options.most_stretch);
            if (moved < options.window.still) {
                if (i >= shifts) break;
                i = shifts - 1;
            }
        }
        if (level == 0) {
            if (!well || !window.look(to.levels[0], here)) return {};
            return AffineTrack{here, window.similarity()};
        }
        // A level that leads away is not believed; one that finds nothing alike ends it, as most guesses end
        // where the point is hidden.
        if (!well) continue;
        if (window.similarity() < kLeastOnTheWay) return {};
        motion.place = here.place * size;
        motion.turn = here.turn;
        first = false;
    }
    return {};
}

}  // namespace treerec
