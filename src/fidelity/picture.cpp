#include "fidelity/picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "error.h"
#include "geometry/capsule_tree.h"
#include "geometry/parallel.h"
#include "geometry/portable_math.h"
#include "tree/wood_segments.h"

namespace treerec {

namespace {

constexpr int kSamples = 2;  // across a pixel and down it
constexpr uint8_t kOpaque = 128;
constexpr float kFar = std::numeric_limits<float>::max();
constexpr double kReach = 3.0;      // samples to the neighbours that shade
constexpr double kDarkest = 0.35;   // what shading leaves of a colour
constexpr double kDepthScale = 40;  // of the picture's height to the depth that shades by 1/e

Rgb scaled(const Rgb& color, double factor) {
    Rgb result;
    for (size_t i = 0; i < 3; i++)
        result[i] = static_cast<uint8_t>(std::clamp(std::lround(factor * color[i]), 0L, 255L));
    return result;
}

}  // namespace

PictureView view_of(const Bounds& box, double azimuth, int pixels) {
    constexpr double kMargin = 1.04;
    PictureView view;
    view.azimuth = azimuth;
    view.centre = box.centre();
    view.pixels = pixels;
    const DVec3 size = box.size();
    const double across =
        std::abs(portable::cos(azimuth)) * size.x + std::abs(portable::sin(azimuth)) * size.z;
    view.width = std::max(kMargin * across, 1e-3);
    view.height = std::max({kMargin * size.y, 0.25 * view.width, 1e-3});
    return view;
}

Picture::Picture(const PictureView& view) : view_(view) {
    if (view.pixels < 16 || view.pixels > 4096) throw Error("A picture is drawn with 16 to 4096 pixels.");
    if (!(view.width > 0.0 && view.height > 0.0 && view.width < 1e6 && view.height < 1e6))
        throw Error("A picture shows more than nothing and less than 1000 km.");
    right_ = DVec3(portable::cos(view.azimuth), 0.0, -portable::sin(view.azimuth));
    away_ = DVec3(-portable::sin(view.azimuth), 0.0, -portable::cos(view.azimuth));
    height_ = kSamples * view.pixels;
    sample_ = view.height / height_;
    const double across = std::ceil(view.width / sample_ / kSamples);
    width_ = kSamples * static_cast<int>(std::clamp(across, 1.0, 4096.0));
    const size_t count = static_cast<size_t>(width_) * static_cast<size_t>(height_);
    depth_.assign(count, kFar);
    color_.assign(count, {});
}

DVec3 Picture::place(const DVec3& p) const {
    const DVec3 d = p - view_.centre;
    return {0.5 * width_ + glm::dot(d, right_) / sample_, 0.5 * height_ - d.y / sample_, glm::dot(d, away_)};
}

template <typename Pixel>
void Picture::draw_triangles(const Mesh& mesh, Pixel pixel, const Progress* progress) {
    const DVec3 light = glm::normalize(-0.5 * right_ + DVec3(0.0, 0.7, 0.0) - 0.8 * away_);
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        if (progress && i % 49152 == 0) progress->check();
        DVec3 corners[3], at[3];
        for (int k = 0; k < 3; k++) {
            corners[k] = DVec3(mesh.positions[mesh.indices[i + static_cast<size_t>(k)]]);
            at[k] = place(corners[k]);
        }
        const double area =
            (at[1].x - at[0].x) * (at[2].y - at[0].y) - (at[2].x - at[0].x) * (at[1].y - at[0].y);
        if (std::abs(area) < 1e-12) continue;
        const DVec3 normal =
            normalized_or(glm::cross(corners[1] - corners[0], corners[2] - corners[0]), light);
        // Either side: cards have two.
        const double lit = 0.35 + 0.65 * std::abs(glm::dot(normal, light));
        const auto [low_x, high_x] = std::minmax({at[0].x, at[1].x, at[2].x});
        const auto [low_y, high_y] = std::minmax({at[0].y, at[1].y, at[2].y});
        const int x0 = static_cast<int>(std::clamp(std::ceil(low_x - 0.5), 0.0, double(width_)));
        const int x1 = static_cast<int>(std::clamp(std::floor(high_x - 0.5), -1.0, double(width_ - 1)));
        const int y0 = static_cast<int>(std::clamp(std::ceil(low_y - 0.5), 0.0, double(height_)));
        const int y1 = static_cast<int>(std::clamp(std::floor(high_y - 0.5), -1.0, double(height_ - 1)));
        for (int y = y0; y <= y1; y++)
            for (int x = x0; x <= x1; x++) {
                const double px = x + 0.5, py = y + 0.5;
                const double b =
                    ((px - at[0].x) * (at[2].y - at[0].y) - (at[2].x - at[0].x) * (py - at[0].y)) / area;
                const double c =
                    ((at[1].x - at[0].x) * (py - at[0].y) - (px - at[0].x) * (at[1].y - at[0].y)) / area;
                if (b < 0.0 || c < 0.0 || b + c > 1.0) continue;
                if (const std::optional<Rgb> color = pixel(i, b, c))
                    set(x, y, at[0].z + b * (at[1].z - at[0].z) + c * (at[2].z - at[0].z),
                        scaled(*color, lit));
            }
    }
}

void Picture::draw(const Mesh& mesh, const Rgb& color, const Progress* progress) {
    draw_triangles(
        mesh, [&](size_t, double, double) { return std::optional(color); }, progress);
}

void Picture::draw_textured(const Mesh& mesh, const Image& picture, const Progress* progress) {
    if (picture.channels != 4 || mesh.uvs.size() != mesh.positions.size())
        throw Error("A picture on a mesh has four channels, and the mesh has UVs.");
    const auto texel = [](double at, int count) {
        return std::clamp(static_cast<int>(std::floor(at * count)), 0, count - 1);
    };
    const auto pixel = [&](size_t i, double b, double c) -> std::optional<Rgb> {
        const DVec2 first(mesh.uvs[mesh.indices[i]]);
        const DVec2 uv = first + b * (DVec2(mesh.uvs[mesh.indices[i + 1]]) - first) +
                         c * (DVec2(mesh.uvs[mesh.indices[i + 2]]) - first);
        const uint8_t* at = picture.at(texel(uv.x, picture.width), texel(uv.y, picture.height));
        if (at[3] < kOpaque) return std::nullopt;
        return Rgb{at[0], at[1], at[2]};
    };
    draw_triangles(mesh, pixel, progress);
}

void Picture::draw(const std::vector<Vec3>& points, const std::vector<Rgb>& colors, double radius,
                   const Progress* progress) {
    const double r = std::clamp(radius / sample_, 0.5 * kSamples, 16.0);
    for (size_t i = 0; i < points.size(); i++) {
        if (progress && i % 65536 == 0) progress->check();
        const DVec3 at = place(DVec3(points[i]));
        if (!(at.x > -r && at.y > -r && at.x < width_ + r && at.y < height_ + r)) continue;
        const int x0 = std::max(0, static_cast<int>(std::ceil(at.x - r - 0.5)));
        const int x1 = std::min(width_ - 1, static_cast<int>(std::floor(at.x + r - 0.5)));
        const int y0 = std::max(0, static_cast<int>(std::ceil(at.y - r - 0.5)));
        const int y1 = std::min(height_ - 1, static_cast<int>(std::floor(at.y + r - 0.5)));
        for (int y = y0; y <= y1; y++)
            for (int x = x0; x <= x1; x++) {
                const double dx = x + 0.5 - at.x, dy = y + 0.5 - at.y;
                if (dx * dx + dy * dy <= r * r) set(x, y, at.z, colors[i]);
            }
    }
}

Image Picture::finish(const Rgb& background) const {
    Image image(width_ / kSamples, height_ / kSamples, 3);
    const double scale = kDepthScale / view_.height;
    const auto depth_at = [&](int x, int y) {
        if (x < 0 || y < 0 || x >= width_ || y >= height_) return kFar;
        return depth_[static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)];
    };
    constexpr int kDirections = 8;
    std::array<std::array<int, 2>, kDirections> around;
    for (int k = 0; k < kDirections; k++) {
        const double angle = 2.0 * kPi * k / kDirections;
        around[static_cast<size_t>(k)] = {static_cast<int>(std::lround(kReach * portable::cos(angle))),
                                          static_cast<int>(std::lround(kReach * portable::sin(angle)))};
    }
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x++) {
            std::array<double, 3> sum{};
            for (int k = 0; k < kSamples * kSamples; k++) {
                const int sx = kSamples * x + k % kSamples, sy = kSamples * y + k / kSamples;
                const float depth = depth_at(sx, sy);
                const bool covered = depth < kFar;
                double shade = 1.0;
                if (covered) {
                    double nearer = 0.0;
                    for (const auto& [dx, dy] : around) {
                        const float other = depth_at(sx + dx, sy + dy);
                        if (other < depth) nearer += std::min(1.0, scale * (depth - other));
                    }
                    shade = kDarkest + (1.0 - kDarkest) * portable::exp(-2.0 * nearer / kDirections);
                }
                const Rgb& color = covered ? color_[static_cast<size_t>(sy) * static_cast<size_t>(width_) +
                                                    static_cast<size_t>(sx)]
                                           : background;
                for (size_t c = 0; c < 3; c++)
                    sum[c] += shade * color[c];
            }
            for (size_t c = 0; c < 3; c++)
                image.at(x, y)[c] = static_cast<uint8_t>(std::lround(sum[c] / (kSamples * kSamples)));
        }
    return image;
}

Rgb heat_color(double distance, double tolerance) {
    // Told apart by those who see no red or no green too.
    constexpr std::array<std::array<double, 3>, 5> kColors = {
        {{38, 84, 160}, {94, 164, 200}, {242, 221, 130}, {236, 130, 56}, {176, 16, 32}}};
    const double x = tolerance > 0.0 ? distance / tolerance : distance > 0.0 ? 3.0 : 0.0;
    // The tolerance is the middle.
    const double at = 4.0 * (x < 1.0 ? 0.5 * x : std::min(1.0, 0.5 + 0.25 * (x - 1.0)));
    const size_t i = std::min<size_t>(3, static_cast<size_t>(at));
    const double t = at - static_cast<double>(i);
    Rgb color;
    for (size_t c = 0; c < 3; c++)
        color[c] = static_cast<uint8_t>(std::lround((1.0 - t) * kColors[i][c] + t * kColors[i + 1][c]));
    return color;
}

std::vector<Rgb> bark_heat(const Tree& tree, const Fidelity& fidelity, const Mesh& bark,
                           const Progress* progress) {
    if (fidelity.node_points.size() != static_cast<size_t>(tree.id_end()))
        throw Error("The fidelity was measured with another tree.");
    const CapsuleTree wood(wood_segments(tree));
    std::vector<Rgb> colors(bark.positions.size(), kUnseenWood);
    if (wood.empty()) return colors;
    parallel_for(colors.size(), 1024, [&](size_t begin, size_t end) {
        if (progress) progress->check();
        int32_t hint = -1;
        for (size_t i = begin; i < end; i++) {
            const DVec3 p(bark.positions[i]);
            BarkHit hit;
            if (hint >= 0) hit = {wood.segment(hint).child, bark_error(wood.segment(hint), p), hint};
            wood.find_bark(p, hit);
            hint = hit.segment;
            const size_t node = static_cast<size_t>(hit.child);
            if (fidelity.node_points[node] > 0)
                colors[i] = heat_color(static_cast<double>(fidelity.node_error[node]), fidelity.tolerance);
        }
    });
    return colors;
}

}  // namespace treerec
