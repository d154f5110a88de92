#include "fidelity/sample_mask.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace treerec {

namespace {

constexpr int kOpaque = 128;

// Where sample centres p + 0.5 lie between two places, without overflow however far away these are.
int first_after(double place, int count) {
    return static_cast<int>(std::ceil(std::clamp(place - 0.5, 0.0, static_cast<double>(count))));
}
int last_before(double place, int count) {
    return static_cast<int>(std::floor(std::clamp(place - 0.5, -1.0, count - 1.0)));
}

}  // namespace

SampleMask::SampleMask(int width, int height)
    : width_(kSamples * width),
      height_(kSamples * height),
      words_((static_cast<size_t>(width_) + 63) / 64),
      bits_(words_ * static_cast<size_t>(height_), 0) {}

SampleMask::Span SampleMask::rows_of(const DVec2 (&corners)[3]) const {
    const auto [low, high] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
    return {first_after(low, height_), last_before(high, height_)};
}

SampleMask::Span SampleMask::span_of(const DVec2 (&corners)[3], int row) const {
    const double y = row + 0.5;
    double from = INFINITY, to = -INFINITY;
    for (int k = 0; k < 3; k++) {
        const DVec2 &a = corners[k], &b = corners[(k + 1) % 3];
        if ((a.y < y && b.y < y) || (a.y > y && b.y > y)) continue;
        if (a.y == b.y) {
            from = std::min({from, a.x, b.x});
            to = std::max({to, a.x, b.x});
            continue;
        }
        const double x = a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
        from = std::min(from, x);
        to = std::max(to, x);
    }
    return {first_after(from, width_), last_before(to, width_)};
}

void SampleMask::fill(const DVec2 (&corners)[3]) {
    const Span rows = rows_of(corners);
    for (int row = rows.first; row <= rows.last; row++) {
        const Span span = span_of(corners, row);
        if (span.first <= span.last) set(row, span.first, span.last);
    }
}

void SampleMask::fill(const DVec2 (&corners)[3], const Vec2 (&uvs)[3], const Image& cut_out) {
    const DVec2 a = corners[1] - corners[0], b = corners[2] - corners[0];
    const double area = a.x * b.y - a.y * b.x;
    if (area == 0.0) return;
    const auto texel = [](double at, int count) {
        return std::clamp(static_cast<int>(std::floor(at * count)), 0, count - 1);
    };
    const Span rows = rows_of(corners);
    for (int row = rows.first; row <= rows.last; row++) {
        const Span span = span_of(corners, row);
        const uint64_t* covered = &bits_[words_ * static_cast<size_t>(row)];
        for (int x = span.first; x <= span.last; x++) {
            // In a crown most are, many times.
            if (covered[x / 64] >> (x % 64) & 1U) continue;
            const DVec2 p = DVec2(x + 0.5, row + 0.5) - corners[0];
            const double s = (p.x * b.y - p.y * b.x) / area, t = (a.x * p.y - a.y * p.x) / area;
            const DVec2 uv = DVec2(uvs[0]) + s * DVec2(uvs[1] - uvs[0]) + t * DVec2(uvs[2] - uvs[0]);
            if (cut_out.at(texel(uv.x, cut_out.width), texel(uv.y, cut_out.height))[3] >= kOpaque)
                set(row, x, x);
        }
    }
}

int SampleMask::covered(int x, int y) const {
    int count = 0;
    for (int row = kSamples * y; row < kSamples * (y + 1); row++)
        count += std::popcount(bits_[words_ * static_cast<size_t>(row) + static_cast<size_t>(x / 16)] >>
                                   (kSamples * (x % 16)) &
                               0xFU);
    return count;
}

void SampleMask::set(int row, int begin, int end) {
    uint64_t* words = &bits_[words_ * static_cast<size_t>(row)];
    const int first = begin / 64, last = end / 64;
    const uint64_t head = ~uint64_t{0} << (begin % 64), tail = ~uint64_t{0} >> (63 - end % 64);
    if (first == last) {
        words[first] |= head & tail;
        return;
    }
    words[first] |= head;
    for (int i = first + 1; i < last; i++)
        words[i] = ~uint64_t{0};
    words[last] |= tail;
}

}  // namespace treerec
