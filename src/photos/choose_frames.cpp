#include "photos/choose_frames.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "geometry/quantile.h"

namespace treerec {

namespace {

constexpr int kBlock = 16;         // pixels
constexpr int kReach = 10;         // pixels: sideways
constexpr int kReachUp = 4;        // pixels: a hand shakes up and down
constexpr double kTexture = 30.0;  // mean squared slope of a block that can be found again
constexpr double kFar = 0.15;      // of the blocks' motions from the farthest one to a side
constexpr double kNoise = 0.002;   // of the picture's width: what a block's place is sure to

int difference(const Image& a, const Image& b, int ax, int ay, int bx, int by) {
    int sum = 0;
    for (int y = 0; y < kBlock; y++) {
        const uint8_t *row = a.at(ax, ay + y), *other = b.at(bx, by + y);
        for (int x = 0; x < kBlock; x++)
            sum += std::abs(static_cast<int>(row[x]) - static_cast<int>(other[x]));
    }
    return sum;
}

double texture_of(const Image& picture, int left, int top) {
    double sum = 0.0;
    for (int y = 0; y < kBlock; y++) {
        const uint8_t* row = picture.at(left, top + y);
        for (int x = 1; x < kBlock; x++) {
            const double slope = static_cast<double>(row[x]) - static_cast<double>(row[x - 1]);
            sum += slope * slope;
        }
    }
    return sum / (kBlock * (kBlock - 1));
}

// How far a block is moved sideways, in pixels, to a part of one; infinite where it is not found inside.
double block_motion(const Image& before, const Image& after, int left, int top) {
    int best = std::numeric_limits<int>::max(), best_x = 0, best_y = 0;
    for (int y = -kReachUp; y <= kReachUp; y++)
        for (int x = -kReach; x <= kReach; x++) {
            const int at_x = left + x, at_y = top + y;
            if (at_x < 0 || at_y < 0 || at_x + kBlock > after.width || at_y + kBlock > after.height) continue;
            // Of equals the nearest.
            const int sum = 4 * difference(before, after, left, top, at_x, at_y) + std::abs(x);
            if (sum < best) {
                best = sum;
                best_x = x;
                best_y = y;
            }
        }
    const int at_x = left + best_x;
    if (std::abs(best_x) == kReach || at_x <= 0 || at_x + kBlock >= after.width) return INFINITY;
    // The lowest place of a parabola through the three differences.
    const double here = difference(before, after, left, top, at_x, top + best_y),
                 less = difference(before, after, left, top, at_x - 1, top + best_y),
                 more = difference(before, after, left, top, at_x + 1, top + best_y);
    const double bend = less - 2.0 * here + more;
    return best_x + (bend > 0.0 ? std::clamp(0.5 * (less - more) / bend, -0.5, 0.5) : 0.0);
}

// Of the motions to a side before each frame, and of all.
std::vector<double> sums_of(std::span<const FrameLook> frames, double SideMotion::*side) {
    std::vector<double> sums(frames.size() + 1, 0.0);
    for (size_t i = 0; i < frames.size(); i++) {
        const double moved = frames[i].moved.*side;
        sums[i + 1] = sums[i] + (std::isfinite(moved) ? moved : 0.0);
    }
    return sums;
}

}  // namespace

SideMotion motion_between(const Image& before, const Image& after) {
    if (before.width != after.width || before.height != after.height) return {};
    std::vector<double> motions;
    for (int top = 0; top + kBlock <= before.height; top += kBlock)
        for (int left = 0; left + kBlock <= before.width; left += kBlock) {
            if (texture_of(before, left, top) < kTexture) continue;
            const double moved = block_motion(before, after, left, top);
            if (std::isfinite(moved)) motions.push_back(moved);
        }
    if (motions.empty()) return {};
    std::sort(motions.begin(), motions.end());
    const auto from_end = static_cast<size_t>(kFar * static_cast<double>(motions.size() - 1));
    return {motions[from_end] / before.width, motions[motions.size() - 1 - from_end] / before.width};
}

double sharpness_of(const Image& picture) {
    double sum = 0.0;
    size_t count = 0;
    for (int y = 1; y < picture.height; y++)
        for (int x = 1; x < picture.width; x++, count++) {
            const double here = *picture.at(x, y), across = here - *picture.at(x - 1, y),
                         down = here - *picture.at(x, y - 1);
            sum += across * across + down * down;
        }
    return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

std::vector<size_t> choose_frames(std::span<const FrameLook> frames, const FrameChoice& choice) {
    std::vector<size_t> chosen;
    if (frames.empty()) return chosen;
    // The way walked by each frame: motions are summed over some frames first, where shakes take themselves
    // away. Of the two sides the one that more moves to, in all of the film.
    std::vector<double> sums = sums_of(frames, &SideMotion::left), way(frames.size(), 0.0);
    const std::vector<double> right = sums_of(frames, &SideMotion::right);
    if (std::abs(right.back()) > std::abs(sums.back())) sums = right;
    for (size_t i = 1; i < frames.size(); i++) {
        const size_t first = i > choice.smoothed ? i - choice.smoothed : 0,
                     last = std::min(i + choice.smoothed + 1, frames.size());
        const double usual = std::abs(sums[last] - sums[first]) / static_cast<double>(last - first);
        way[i] = way[i - 1] + (usual > kNoise ? usual : 0.0);
    }
    const double whole = way.back();
    if (whole < choice.still) return chosen;
    const double count =
        std::clamp(whole / choice.step, static_cast<double>(choice.least), static_cast<double>(choice.most));
    const double step = whole / count;
    // The sharpest of each step; from one that stands still the first of equals.
    size_t slot = 0;
    for (size_t i = 0; i < frames.size(); i++) {
        const auto in = static_cast<size_t>(std::min(way[i] / step, count - 1.0));
        if (chosen.empty() || in != slot) {
            chosen.push_back(i);
            slot = in;
        } else if (frames[i].sharpness > frames[chosen.back()].sharpness) {
            chosen.back() = i;
        }
    }
    return chosen;
}

}  // namespace treerec
