#include "textures/bark_field.h"

#include <algorithm>
#include <cmath>

namespace treerec::bark {

namespace {

constexpr double kStep = 0.0006;  // metres, of differences

// At a corner of the lattice: the slope there times the way from it.
double corner(int x, int y, double dx, double dy, uint64_t seed) {
    const uint64_t key = (static_cast<uint64_t>(static_cast<uint32_t>(x)) << 32) | static_cast<uint32_t>(y);
    const uint64_t bits = hash_seed(seed, key);
    const double gx = static_cast<double>(bits >> 32) * 0x1p-31 - 1.0;
    const double gy = static_cast<double>(bits & 0xffffffffu) * 0x1p-31 - 1.0;
    return gx * dx + gy * dy;
}

double fade(double t) {
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

double gradient_noise(DVec2 p, int nx, int ny, uint64_t seed) {
    const double x = p.x * nx, y = p.y * ny;
    const double floor_x = std::floor(x), floor_y = std::floor(y);
    const int x0 = wrap(static_cast<int>(floor_x), nx), y0 = wrap(static_cast<int>(floor_y), ny);
    const int x1 = x0 + 1 == nx ? 0 : x0 + 1, y1 = y0 + 1 == ny ? 0 : y0 + 1;
    const double dx = x - floor_x, dy = y - floor_y;
    const double sx = fade(dx);
    const double lower = mix(corner(x0, y0, dx, dy, seed), corner(x1, y0, dx - 1.0, dy, seed), sx);
    const double upper =
        mix(corner(x0, y1, dx, dy - 1.0, seed), corner(x1, y1, dx - 1.0, dy - 1.0, seed), sx);
    return 1.6 * mix(lower, upper, fade(dy));
}

}  // namespace

glm::ivec2 Place::lattice(DVec2 size) const {
    return {std::max(2, static_cast<int>(std::lround(metres.x / size.x))),
            std::max(2, static_cast<int>(std::lround(metres.y / size.y)))};
}

double Place::noise(DVec2 size, int octaves, uint64_t salt) const {
    const glm::ivec2 cells = lattice(size);
    double sum = 0.0, strength = 0.65;
    for (int i = 0; i < octaves; i++, strength *= 0.5)
        sum += strength *
               gradient_noise(at, cells.x << i, cells.y << i, seed + salt * 64 + static_cast<uint64_t>(i));
    return sum;
}

Line Place::line(DVec2 size, int octaves, uint64_t salt) const {
    // Not zero: noise is that at all of its lattice's points, which would string the lines up in rows.
    constexpr double kLevel = 0.09;
    const double here = noise(size, octaves, salt) - kLevel;
    const double dx = (moved({kStep, 0.0}).noise(size, octaves, salt) - kLevel - here) / kStep;
    const double dy = (moved({0.0, kStep}).noise(size, octaves, salt) - kLevel - here) / kStep;
    // Where the field is flat there is no line, however near to zero it is.
    const double flat = 0.35 / size.x;
    return {std::abs(here) / std::sqrt(dx * dx + dy * dy + flat * flat), here};
}

texture::Cell Place::cell(DVec2 size, uint64_t salt) const {
    const glm::ivec2 cells = lattice(size);
    texture::Cell cell = texture::cells(at, cells.x, cells.y, seed + salt * 64);
    cell.border *= mix(size.y, size.x, cell.across);
    return cell;
}

Flake Place::flake(DVec2 size, double share, double overlap, double ragged, uint64_t salt) const {
    const glm::ivec2 cells = lattice(size);
    const uint64_t key = seed + salt * 64;
    const DVec2 grid(at.x * cells.x, at.y * cells.y);
    const int ix = static_cast<int>(std::floor(grid.x)), iy = static_cast<int>(std::floor(grid.y));
    const double stray = ragged * noise(size * 0.45, 4, salt + 1);
    Flake top;
    for (int i = 0; i < 25; i++) {
        const int cx = ix + i % 5 - 2, cy = iy + i / 5 - 2;
        const int wx = wrap(cx, cells.x), wy = wrap(cy, cells.y);
        const double level = cell_number(wx, wy, key + 2);
        if (level > share || level / share <= top.level) continue;
        const double large = 0.5 * overlap * (0.7 + 0.6 * cell_number(wx, wy, key + 3));
        const DVec2 offset((grid.x - cx - cell_number(wx, wy, key)) / large,
                           (grid.y - cy - cell_number(wx, wy, key + 1)) / large);
        const DVec2 square = offset * offset;
        // Between a disc and a square.
        const double away =
            std::sqrt(std::sqrt(square.x * square.x + square.y * square.y + 1.2 * square.x * square.y)) +
            stray;
        if (away < 1.0) top = {level / share, 1.0 - away, cell_number(wx, wy, key + 4), offset};
    }
    return top;
}

double Place::lens(DVec2 spacing, DVec2 least, DVec2 most, double share, uint64_t salt) const {
    const glm::ivec2 cells = lattice(spacing);
    const uint64_t key = seed + salt * 64;
    const DVec2 grid(at.x * cells.x, at.y * cells.y);
    const DVec2 pitch(metres.x / cells.x, metres.y / cells.y);
    const int ix = static_cast<int>(std::floor(grid.x)), iy = static_cast<int>(std::floor(grid.y));
    double best = 0.0;
    for (int i = 0; i < 9; i++) {
        const int cx = ix + i % 3 - 1, cy = iy + i / 3 - 1;
        const int wx = wrap(cx, cells.x), wy = wrap(cy, cells.y);
        if (cell_number(wx, wy, key + 2) > share) continue;
        const double large = cell_number(wx, wy, key + 3);
        const DVec2 half = 0.5 * glm::mix(least, most, large * large);
        const double x = std::abs((grid.x - cx - cell_number(wx, wy, key)) * pitch.x) / half.x;
        const double y = std::abs((grid.y - cy - cell_number(wx, wy, key + 1)) * pitch.y) / half.y;
        best = std::max(best, 1.0 - x * x - y);
    }
    return best;
}

double Place::cover() const {
    const double broad = noise({0.11, 0.13}, 5, 90);
    const double fine = noise({0.006, 0.006}, 3, 91);
    const Flake blot = flake({0.035, 0.035}, 0.45, 0.85, 0.55, 92);
    const double spot =
        blot.level > 0.0 ? smoothstep(0.0, 0.35, blot.inside) * (0.5 + 0.5 * blot.number) : 0.0;
    return clamp01(0.55 + 0.55 * broad + 0.16 * fine - 0.45 * spot);
}

}  // namespace treerec::bark
