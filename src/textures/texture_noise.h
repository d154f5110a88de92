// Periodic noise for seamless pictures.
#pragma once

#include <cmath>
#include <cstdint>

#include "geometry/random.h"
#include "geometry/vec.h"

namespace treerec::texture {

inline double clamp01(double x) {
    return x < 0.0 ? 0.0 : x > 1.0 ? 1.0 : x;
}

inline double smoothstep(double low, double high, double x) {
    const double t = clamp01((x - low) / (high - low));
    return t * t * (3.0 - 2.0 * t);
}

inline double mix(double a, double b, double t) {
    return a + (b - a) * t;
}

inline uint8_t to_byte(double x) {
    return static_cast<uint8_t>(clamp01(x) * 255.0 + 0.5);
}

inline int wrap(int i, int period) {
    i %= period;
    return i < 0 ? i + period : i;
}

// A number in [0, 1) that belongs to a cell of a lattice.
inline double cell_number(int x, int y, uint64_t seed) {
    const uint64_t key = (static_cast<uint64_t>(static_cast<uint32_t>(x)) << 32) | static_cast<uint32_t>(y);
    return static_cast<double>(hash_seed(seed, key) >> 11) * 0x1p-53;
}

// Value noise, -1..1, with `nx` x `ny` lattice cells over the unit square, repeating after it.
inline double noise(DVec2 p, int nx, int ny, uint64_t seed) {
    const double x = p.x * nx, y = p.y * ny;
    const int ix = static_cast<int>(std::floor(x)), iy = static_cast<int>(std::floor(y));
    const double fx = x - ix, fy = y - iy;
    const double sx = fx * fx * fx * (fx * (fx * 6 - 15) + 10);
    const double sy = fy * fy * fy * (fy * (fy * 6 - 15) + 10);
    const int x0 = wrap(ix, nx), x1 = wrap(ix + 1, nx), y0 = wrap(iy, ny), y1 = wrap(iy + 1, ny);
    const double a = mix(cell_number(x0, y0, seed), cell_number(x1, y0, seed), sx);
    const double b = mix(cell_number(x0, y1, seed), cell_number(x1, y1, seed), sx);
    return 2.0 * mix(a, b, sy) - 1.0;
}

// Sum of octaves, each twice as fine and half as strong; about -1..1.
inline double fractal(DVec2 p, int nx, int ny, int octaves, uint64_t seed) {
    double sum = 0.0, strength = 0.5;
    for (int i = 0; i < octaves; i++, strength *= 0.5) {
        sum += strength * noise(p, nx << i, ny << i, seed + static_cast<uint64_t>(i));
    }
    return sum;
}

// Worley cells, in units of cells.
struct Cell {
    double border;  // distance to the nearest border
    double across;  // 0..1: how far that border runs up and down (1) rather than across the picture (0)
    double number;  // belongs to the cell, [0, 1)
};

inline Cell cells(DVec2 p, int nx, int ny, uint64_t seed) {
    const double x = p.x * nx, y = p.y * ny;
    const int ix = static_cast<int>(std::floor(x)), iy = static_cast<int>(std::floor(y));
    DVec2 offsets[25];
    int nearest = 0;
    double nearest_square = 1e9;
    for (int i = 0; i < 25; i++) {
        const int cx = ix + i % 5 - 2, cy = iy + i / 5 - 2;
        const int wx = wrap(cx, nx), wy = wrap(cy, ny);
        offsets[i] = {cx + 0.1 + 0.8 * cell_number(wx, wy, seed) - x,
                      cy + 0.1 + 0.8 * cell_number(wx, wy, seed + 1) - y};
        const double square = glm::dot(offsets[i], offsets[i]);
        if (square < nearest_square) {
            nearest_square = square;
            nearest = i;
        }
    }
    Cell cell{1e9, 1.0,
              cell_number(wrap(ix + nearest % 5 - 2, nx), wrap(iy + nearest / 5 - 2, ny), seed + 2)};
    for (int i = 0; i < 25; i++) {
        if (i == nearest) continue;
        const DVec2 between = offsets[i] - offsets[nearest];
        const double distance =
            glm::dot(0.5 * (offsets[i] + offsets[nearest]), between) / glm::length(between);
        if (distance < cell.border) {
            cell.border = distance;
            cell.across = std::abs(between.x) / glm::length(between);
        }
    }
    return cell;
}

}  // namespace treerec::texture
