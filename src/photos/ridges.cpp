#include "photos/ridges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace treerec {

namespace {

constexpr double kMostAside = 0.6;  // pixels between a pixel's middle and the ridge that is its own
constexpr double kFarthest = 5.0;   // pixels to each side, where an edge is looked for
constexpr double kStep = 0.25;      // pixels along that way
constexpr double kNarrowest = 1.0;  // pixels of the first level
constexpr double kNarrower = 2.0;   // of the others: what is narrower is found on the level before
constexpr double kWidest = 4.5;
// Pixels: how wide at half height a line without width seems. 1.15 of it are a lens, the sensor and a JPEG
// (contrast down to half at .38 periods a pixel), the rest is that grey levels are read between pixels. In
// the photos of tests/photos/ lines of 1.5 to 5 pixels come out .94 to 1.02 times as wide as they are.
constexpr double kBlur = 1.5;
constexpr double kLeastWidth = 0.5;  // pixels: what is seen as a line at all, and no wider than a blur
constexpr double kStraight = 0.85;   // cosine between a line's neighbouring places
constexpr double kUneven = 2.0;      // one side of a line by the other, from its brightest bend

struct Bend {
    DVec2 place{0.0}, way{0.0};
    double strength = 0.0;  // negative for a light line
};

// The ridge that passes through a pixel of the smoothed picture.
std::optional<Bend> bend_at(const GreyPicture& smooth, int x, int y, double least) {
    const uint8_t *above = smooth.row(y - 1) + x, *here = smooth.row(y) + x, *below = smooth.row(y + 1) + x;
    const double xx = here[1] - 2.0 * here[0] + here[-1], yy = below[0] - 2.0 * here[0] + above[0];
    const double xy = 0.25 * (below[1] - below[-1] - above[1] + above[-1]);
    const double half = 0.5 * (xx + yy), spread = std::sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy);
    const double value = std::abs(half + spread) > std::abs(half - spread) ? half + spread : half - spread;
    if (std::abs(value) < least) return {};
    // The eigenvector of the larger value is the way across.
    DVec2 across =
        std::abs(xx - value) > std::abs(yy - value) ? DVec2(-xy, xx - value) : DVec2(yy - value, -xy);
    const double length = glm::length(across);
    across = length > 0.0 ? across / length : (std::abs(xx) > std::abs(yy) ? DVec2(1, 0) : DVec2(0, 1));
    const DVec2 slope(0.5 * (here[1] - here[-1]), 0.5 * (below[0] - above[0]));
    const DVec2 away = -glm::dot(slope, across) / value * across;
    if (std::abs(away.x) > kMostAside || std::abs(away.y) > kMostAside) return {};
    return Bend{DVec2(x, y) + away, {-across.y, across.x}, value};
}

// How wide a line is that seems `seen` pixels wide at half its height: a box that a normal distribution of
// full width kBlur at half height blurs. The wider it is, the less is its width changed.
double width_before_blur(double seen) {
    constexpr size_t kSteps = 64;
    constexpr double kStepWidth = 0.1;
    static const auto seen_of = [] {
        std::array<double, kSteps> table{};
        const double sigma = kBlur / (2.0 * std::sqrt(2.0 * std::log(2.0)));
        for (size_t i = 0; i < kSteps; i++) {
            const double half = 0.5 * kStepWidth * static_cast<double>(i + 1);
            const auto height = [&](double x) {
                const double scale = 1.0 / (sigma * std::sqrt(2.0));
                return std::erf((x + half) * scale) - std::erf((x - half) * scale);
            };
            double low = 0.0, high = half + 2.0 * kBlur;
            for (int round = 0; round < 40; round++) {
                const double x = 0.5 * (low + high);
                (height(x) > 0.5 * height(0.0) ? low : high) = x;
            }
            table[i] = low + high;
        }
        return table;
    }();
    const auto above = std::upper_bound(seen_of.begin(), seen_of.end(), seen);
    if (above == seen_of.end()) return seen;
    const auto i = static_cast<double>(above - seen_of.begin());
    if (above == seen_of.begin()) return kLeastWidth;
    const double part = (seen - above[-1]) / (above[0] - above[-1]);
    return std::max(kLeastWidth, kStepWidth * (i + part));
}

// How far from the middle the grey level is half that of the side, and that side's contrast.
struct Edge {
    double away = 0.0, contrast = 0.0;
};

Edge edge_beside(const GreyPicture& picture, const DVec2& middle, const DVec2& across, double sign) {
    constexpr size_t kCount = static_cast<size_t>(kFarthest / kStep) + 1;
    std::array<double, kCount> heights{};
    const double centre = picture.at(static_cast<float>(middle.x), static_cast<float>(middle.y));
    Edge edge;
    size_t count = 0;
    for (; count < kCount; count++) {
        const DVec2 at = middle + kStep * static_cast<double>(count) * across;
        if (!picture.has(at.x, at.y)) break;
        heights[count] =
            sign *
            (static_cast<double>(picture.at(static_cast<float>(at.x), static_cast<float>(at.y))) - centre);
        // What stands behind the next line is not this one's side.
        if (count > 4 && heights[count] < 0.5 * edge.contrast) break;
        edge.contrast = std::max(edge.contrast, heights[count]);
    }
    for (size_t i = 1; i < count; i++)
        if (heights[i] >= 0.5 * edge.contrast) {
            const double part = (0.5 * edge.contrast - heights[i - 1]) / (heights[i] - heights[i - 1]);
            edge.away = kStep * (static_cast<double>(i - 1) + part);
            break;
        }
    return edge;
}

std::optional<Ridge> ridge_of(const GreyPicture& picture, const Bend& bend, size_t level,
                              double least_contrast) {
    const DVec2 across(-bend.way.y, bend.way.x);
    if (!picture.has(bend.place.x, bend.place.y)) return {};
    const double sign = bend.strength > 0.0 ? 1.0 : -1.0;
    const Edge left = edge_beside(picture, bend.place, across, sign),
               right = edge_beside(picture, bend.place, -across, sign);
    if (std::min(left.contrast, right.contrast) < least_contrast) return {};
    if (!(left.away > 0.0 && right.away > 0.0)) return {};
    if (left.away > kUneven * right.away + 1.0 || right.away > kUneven * left.away + 1.0) return {};
    const double width = left.away + right.away;
    if (width < (level > 0 ? kNarrower : kNarrowest) || width > kWidest) return {};
    Ridge ridge;
    ridge.place = bend.place + 0.5 * (left.away - right.away) * across;
    ridge.way = bend.way;
    ridge.width = width_before_blur(width);
    return ridge;
}

class Tracer {
  public:
    Tracer(int width, int height)
        : width_(width), height_(height), at_(static_cast<size_t>(width) * static_cast<size_t>(height), 0) {}

    void add(int x, int y, const Bend& bend) {
        bends_.push_back(bend);
        at_[index(x, y)] = static_cast<uint32_t>(bends_.size());
        pixels_.push_back({x, y});
    }

    // The bends in rows along their lines, each once.
    std::vector<std::vector<Bend>> lines() {
        std::vector<uint32_t> order(bends_.size());
        for (uint32_t i = 0; i < order.size(); i++)
            order[i] = i;
        std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
            return std::abs(bends_[a].strength) > std::abs(bends_[b].strength);
        });
        std::vector<std::vector<Bend>> found;
        for (const uint32_t first : order) {
            if (at_[index(pixels_[first].x, pixels_[first].y)] == 0) continue;
            std::vector<Bend> line = follow(first, 1.0);
            std::reverse(line.begin(), line.end());
            for (Bend& bend : line)
                bend.way = -bend.way;
            line.push_back(bends_[first]);
            const std::vector<Bend> rest = follow(first, -1.0);
            // Both halves begin at the first one; the second one goes on where this one came from.
            for (Bend bend : rest) {
                bend.way = -bend.way;
                line.push_back(bend);
            }
            found.push_back(std::move(line));
        }
        return found;
    }

  private:
    struct Pixel {
        int x, y;
    };
    size_t index(int x, int y) const {
        return static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
    }
    // Takes a bend and those beside it, which are of the same line, out.
    void take(uint32_t i) {
        const auto [x, y] = pixels_[i];
        at_[index(x, y)] = 0;
        const DVec2 across(-bends_[i].way.y, bends_[i].way.x);
        for (const double side : {-1.0, 1.0}) {
            const int u = x + static_cast<int>(std::lround(side * across.x)),
                      v = y + static_cast<int>(std::lround(side * across.y));
            if (u >= 0 && v >= 0 && u < width_ && v < height_) at_[index(u, v)] = 0;
        }
    }
    // Those after `first`, their way as it is gone.
    std::vector<Bend> follow(uint32_t first, double sign) {
        std::vector<Bend> line;
        uint32_t here = first;
        DVec2 way = sign * bends_[first].way;
        take(first);
        while (true) {
            const auto [x, y] = pixels_[here];
            uint32_t best = UINT32_MAX;
            double most = 0.0;
            for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height_ - 1); v++)
                for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width_ - 1); u++) {
                    const uint32_t number = at_[index(u, v)];
                    if (number == 0) continue;
                    const Bend& bend = bends_[number - 1];
                    const DVec2 step = bend.place - bends_[here].place;
                    if (bend.strength * bends_[here].strength < 0.0 || !(glm::length(step) > 0.0)) continue;
                    const double alike = std::abs(glm::dot(bend.way, way)),
                                 ahead = glm::dot(glm::normalize(step), way);
                    if (alike < kStraight || ahead < 0.6 || alike + ahead <= most) continue;
                    most = alike + ahead;
                    best = number - 1;
                }
            if (best == UINT32_MAX) return line;
            take(best);
            Bend next = bends_[best];
            if (glm::dot(next.way, way) < 0.0) next.way = -next.way;
            way = next.way;
            line.push_back(next);
            here = best;
        }
    }

    int width_, height_;
    std::vector<uint32_t> at_;  // by pixel: the number of a bend from 1, or 0
    std::vector<Bend> bends_;
    std::vector<Pixel> pixels_;
};

// With places about a pixel of the picture apart.
std::vector<Ridge> filled(const std::vector<Ridge>& row) {
    std::vector<Ridge> all;
    for (size_t i = 0; i + 1 < row.size(); i++) {
        const Ridge &one = row[i], &next = row[i + 1];
        const int pieces = std::max(1, static_cast<int>(std::lround(glm::distance(one.place, next.place))));
        for (int k = 0; k < pieces; k++) {
            const double t = static_cast<double>(k) / pieces;
            // Neighbours' ways are nearly the same, or opposite.
            const DVec2 other = glm::dot(one.way, next.way) < 0.0 ? -next.way : next.way;
            all.push_back({glm::mix(one.place, next.place, t), glm::normalize(glm::mix(one.way, other, t)),
                           glm::mix(one.width, next.width, t)});
        }
    }
    all.push_back(row.back());
    return all;
}

}  // namespace

std::vector<std::vector<Ridge>> find_ridges(const GreyPyramid& pyramid, const RidgeOptions& options,
                                            const Progress* progress) {
    std::vector<std::vector<Ridge>> found;
    for (size_t level = 0; level < std::min(options.levels, pyramid.levels.size()); level++) {
        if (progress) progress->check();
        const GreyPicture& picture = pyramid.levels[level];
        const GreyPicture smooth = smoothed(picture);
        const double size = static_cast<double>(size_t{1} << level);
        Tracer tracer(picture.width, picture.height);
        for (int y = 1; y + 1 < picture.height; y++)
            for (int x = 1; x + 1 < picture.width; x++)
                if (const auto bend = bend_at(smooth, x, y, options.least_bend)) tracer.add(x, y, *bend);
        for (const std::vector<Bend>& line : tracer.lines()) {
            std::vector<Ridge> row;
            const auto end_row = [&] {
                if (row.size() >= options.least_points) found.push_back(filled(row));
                row.clear();
            };
            for (const Bend& bend : line) {
                auto ridge = ridge_of(picture, bend, level, options.least_contrast);
                if (!ridge) {
                    end_row();
                    continue;
                }
                ridge->place *= size;
                ridge->width *= size;
                row.push_back(*ridge);
            }
            end_row();
        }
    }
    return found;
}

}  // namespace treerec
