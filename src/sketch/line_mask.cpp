#include "sketch/line_mask.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace treerec {

namespace {

// Clockwise from above.
constexpr std::array<std::pair<int, int>, 8> kAround = {
    {{0, -1}, {1, -1}, {1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}}};

struct Patch {
    std::vector<size_t> places;
    int width = 0, height = 0;  // of the box around
    bool at_border = false;
};

// Calls take(patch) for each connected patch of pixels that have `ink`: at corners too for those with, at
// sides alone for those without.
template <typename Take>
void each_patch(const LineMask& mask, bool ink, const Take& take) {
    std::vector<uint8_t> seen(mask.ink.size(), 0);
    const size_t step = ink ? 1 : 2;
    Patch patch;
    for (int y0 = 0; y0 < mask.height; y0++)
        for (int x0 = 0; x0 < mask.width; x0++) {
            const size_t first = mask.place(x0, y0);
            if (seen[first] != 0 || (mask.ink[first] != 0) != ink) continue;
            patch.places.assign(1, first);
            seen[first] = 1;
            int left = x0, right = x0, bottom = y0;
            for (size_t i = 0; i < patch.places.size(); i++) {
                const int x = static_cast<int>(patch.places[i] % static_cast<size_t>(mask.width));
                const int y = static_cast<int>(patch.places[i] / static_cast<size_t>(mask.width));
                left = std::min(left, x);
                right = std::max(right, x);
                bottom = std::max(bottom, y);
                for (size_t k = 0; k < kAround.size(); k += step) {
                    const int u = x + kAround[k].first, v = y + kAround[k].second;
                    if (u < 0 || v < 0 || u >= mask.width || v >= mask.height) continue;
                    const size_t next = mask.place(u, v);
                    if (seen[next] != 0 || (mask.ink[next] != 0) != ink) continue;
                    seen[next] = 1;
                    patch.places.push_back(next);
                }
            }
            patch.width = right - left + 1;
            patch.height = bottom - y0 + 1;
            patch.at_border = left == 0 || y0 == 0 || right + 1 == mask.width || bottom + 1 == mask.height;
            take(patch);
        }
}

}  // namespace

std::vector<float> depths_of(const LineMask& mask) {
    constexpr int kStraight = 3, kDiagonal = 4, kFar = 1 << 28;
    std::vector<int> depth(mask.ink.size());
    const auto sweep = [&](int x, int y, int back) {
        int& here = depth[mask.place(x, y)];
        const auto look = [&](int u, int v, int step) {
            if (u >= 0 && v >= 0 && u < mask.width && v < mask.height)
                here = std::min(here, depth[mask.place(u, v)] + step);
        };
        look(x - back, y, kStraight);
        look(x, y - back, kStraight);
        look(x - 1, y - back, kDiagonal);
        look(x + 1, y - back, kDiagonal);
    };
    for (size_t i = 0; i < depth.size(); i++)
        depth[i] = mask.ink[i] != 0 ? kFar : 0;
    for (int y = 0; y < mask.height; y++)
        for (int x = 0; x < mask.width; x++)
            sweep(x, y, 1);
    for (int y = mask.height - 1; y >= 0; y--)
        for (int x = mask.width - 1; x >= 0; x--)
            sweep(x, y, -1);
    std::vector<float> depths(depth.size());
    for (size_t i = 0; i < depth.size(); i++)
        depths[i] = static_cast<float>(depth[i]) / kStraight;
    return depths;
}

// The pixels across a line w wide have the depths 1, 2, .. w / 2 and back: a mean of w / 4 + 1 / 2.
double line_width(const LineMask& mask, const std::vector<float>& depths) {
    double sum = 0.0, count = 0.0;
    for (size_t i = 0; i < depths.size(); i++)
        if (mask.ink[i] != 0) {
            sum += static_cast<double>(depths[i]);
            count += 1.0;
        }
    return count > 0.0 ? std::max(1.0, 4.0 * (sum / count - 0.5)) : 0.0;
}

double speck_size(const LineMask& mask, double width) {
    return std::max({2.0 * width, 0.01 * mask.height, 4.0});
}

void clean_mask(LineMask& mask, double width) {
    const double hole = 4.0 + 0.5 * width * width;  // pixels
    const double speck = speck_size(mask, width);
    LineMask cleaned = mask;
    each_patch(mask, false, [&](const Patch& patch) {
        if (patch.at_border || static_cast<double>(patch.places.size()) > hole) return;
        for (const size_t place : patch.places)
            cleaned.ink[place] = 1;
    });
    each_patch(mask, true, [&](const Patch& patch) {
        if (std::max(patch.width, patch.height) >= speck) return;
        for (const size_t place : patch.places)
            cleaned.ink[place] = 0;
    });
    mask = std::move(cleaned);
}

void thin_mask(LineMask& mask) {
    // What is around a pixel never changes without the pixel being looked at again: the work grows with the
    // ink and not with how wide the lines are.
    std::array<std::vector<size_t>, 2> waiting;
    std::array<std::vector<uint8_t>, 2> waits = {std::vector<uint8_t>(mask.ink.size(), 0),
                                                 std::vector<uint8_t>(mask.ink.size(), 0)};
    const auto wait = [&](size_t place) {
        for (size_t pass = 0; pass < 2; pass++)
            if (waits[pass][place] == 0) {
                waits[pass][place] = 1;
                waiting[pass].push_back(place);
            }
    };
    const auto xy = [&](size_t place) {
        return std::pair(static_cast<int>(place % static_cast<size_t>(mask.width)),
                         static_cast<int>(place / static_cast<size_t>(mask.width)));
    };
    const auto goes = [&](size_t place, size_t pass) {
        const auto [x, y] = xy(place);
        std::array<bool, 8> p{};  // the paper's p2 to p9
        for (size_t k = 0; k < 8; k++)
            p[k] = mask.at(x + kAround[k].first, y + kAround[k].second);
        int crossings = 0, before = 0, after = 0;
        for (size_t k = 0; k < 8; k += 2) {
            crossings += !p[k] && (p[k + 1] || p[(k + 2) % 8]) ? 1 : 0;
            before += p[(k + 7) % 8] || p[k] ? 1 : 0;
            after += p[k] || p[k + 1] ? 1 : 0;
        }
        const int around = std::min(before, after);
        if (crossings != 1 || around < 2 || around > 3) return false;
        return pass == 0 ? !((p[0] || p[1] || !p[3]) && p[2]) : !((p[4] || p[5] || !p[7]) && p[6]);
    };
    for (size_t place = 0; place < mask.ink.size(); place++)
        if (mask.ink[place] != 0) wait(place);
    std::vector<size_t> gone, now;
    while (!waiting[0].empty() || !waiting[1].empty())
        for (size_t pass = 0; pass < 2; pass++) {
            now.swap(waiting[pass]);
            waiting[pass].clear();
            gone.clear();
            for (const size_t place : now) {
                waits[pass][place] = 0;
                if (mask.ink[place] != 0 && goes(place, pass)) gone.push_back(place);
            }
            now.clear();
            for (const size_t place : gone)
                mask.ink[place] = 0;
            for (const size_t place : gone) {
                const auto [x, y] = xy(place);
                for (const auto& [right, down] : kAround)
                    if (mask.at(x + right, y + down)) wait(mask.place(x + right, y + down));
            }
        }
}

}  // namespace treerec
