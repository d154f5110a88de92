#include "pipeline/panels.h"

#include <algorithm>
#include <cmath>

#include "geometry/portable_math.h"
#include "tree/branches.h"

namespace treerec {

namespace {

constexpr double kMargin = 1.06;     // of what a picture shows to what is in it
constexpr double kLeastAway = 0.02;  // of the way to the subject: what is nearer to a camera is left out
constexpr Rgb kOrders[] = {{74, 50, 34}, {176, 84, 32}, {214, 150, 40}, {94, 140, 70}, {60, 128, 134}};

// By how high they are, from dark to light green.
Rgb height_color(double share) {
    const double t = std::clamp(share, 0.0, 1.0);
    const auto between = [&](double low, double high) {
        return static_cast<uint8_t>(std::lround(low + t * (high - low)));
    };
    return {between(54.0, 150.0), between(72.0, 178.0), between(64.0, 92.0)};
}

// So wide that neighbours on a surface touch, and never less than a pixel.
double dot_radius(const PanelView& view, const PointCloud& cloud) {
    const double apart = cloud.spacing > 0.0 ? cloud.spacing * cloud.frame.metres_per_unit : 0.0;
    return std::clamp(0.6 * apart, 0.7 * view.metres_per_pixel(), 5.0 * view.metres_per_pixel());
}

Image drawn_points(const PanelView& view, const PointCloud& cloud, const std::vector<Rgb>& colors,
                   const Progress* progress) {
    std::vector<Vec3> places;
    std::vector<Rgb> seen;
    for (size_t i = 0; i < cloud.size(); i++) {
        const std::optional<DVec3> place = view.place(DVec3(cloud.positions[i]));
        if (!place) continue;
        places.emplace_back(*place);
        seen.push_back(colors[i]);
    }
    Picture picture = view.start();
    picture.draw(places, seen, dot_radius(view, cloud), progress);
    return picture.finish();
}

// Albedo is what a sun of several times white makes green of: in a picture without a sky it is nearly black.
Image sunlit(const Image& albedo) {
    constexpr double kSun = 1.7;
    Image made = albedo;
    for (size_t i = 0; i < made.pixels.size(); i++)
        if (made.channels != 4 || i % 4 != 3)
            made.pixels[i] = static_cast<uint8_t>(std::min(255.0, kSun * made.pixels[i]));
    return made;
}

}  // namespace

PanelView PanelView::level(const Bounds& box, double azimuth, int width, int height,
                           double metres_per_pixel) {
    const double scale = metres_per_pixel > 0.0 ? metres_per_pixel : fitting_scale(box, width, height);
    PanelView panel;
    panel.view_.azimuth = azimuth;
    panel.view_.centre = box.centre();
    panel.view_.width = scale * width;
    panel.view_.height = scale * height;
    panel.view_.pixels = height;
    panel.width_ = width;
    return panel;
}

PanelView PanelView::photo(const PinholeView& view, double away) {
    PanelView panel;
    panel.camera_ = view;
    panel.away_ = away;
    const double scale = away / view.focal;
    panel.view_.width = scale * view.width;
    panel.view_.height = scale * view.height;
    panel.view_.pixels = view.height;
    panel.view_.centre = DVec3(scale * (0.5 * view.width - view.principal.x),
                               scale * (view.principal.y - 0.5 * view.height), 0.0);
    panel.width_ = view.width;
    return panel;
}

std::optional<DVec3> PanelView::place(const DVec3& p) const {
    if (!camera_) return p;
    // Lines stay lines, and what is nearer stays nearer.
    const DVec3 seen = glm::transpose(camera_->turn) * (p - camera_->centre);
    const double ahead = -seen.z;
    if (!(ahead > kLeastAway * away_)) return std::nullopt;
    return DVec3(seen.x * away_ / ahead, seen.y * away_ / ahead, away_ - ahead);
}

Mesh PanelView::placed(const Mesh& mesh) const {
    if (!camera_) return mesh;
    Mesh made;
    made.uvs = mesh.uvs;
    std::vector<uint8_t> in_front(mesh.positions.size(), 1);
    made.positions.reserve(mesh.positions.size());
    for (size_t i = 0; i < mesh.positions.size(); i++) {
        const std::optional<DVec3> at = place(DVec3(mesh.positions[i]));
        in_front[i] = at.has_value();
        made.positions.emplace_back(at.value_or(DVec3(0.0)));
    }
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
        if (in_front[mesh.indices[i]] && in_front[mesh.indices[i + 1]] && in_front[mesh.indices[i + 2]])
            made.indices.insert(made.indices.end(), mesh.indices.begin() + static_cast<ptrdiff_t>(i),
                                mesh.indices.begin() + static_cast<ptrdiff_t>(i) + 3);
    return made;
}

double fitting_scale(const Bounds& box, int width, int height) {
    const DVec3 size = box.size();
    return kMargin * std::max({std::max(size.x, size.z) / width, size.y / height, 1e-6});
}

Bounds box_of(const Tree& tree, std::span<const OutlinePart> parts, const PointCloud& cloud) {
    Bounds box;
    for (NodeId id : tree.depth_first())
        box.add(tree.node(id).position, tree.node(id).radius);
    for (const OutlinePart& part : parts)
        for (const Vec3& p : part.mesh.positions)
            box.add(DVec3(p));
    const Vec3 low(box.min - 0.1 * box.diagonal()), high(box.max + 0.1 * box.diagonal());
    for (const Vec3& p : cloud.positions)
        if (p.x > low.x && p.y > low.y && p.z > low.z && p.x < high.x && p.y < high.y && p.z < high.z)
            box.add(DVec3(p));
    return box;
}

Image cloud_panel(const PanelView& view, const PointCloud& cloud, const Progress* progress) {
    std::vector<Rgb> colors(cloud.colors.begin(), cloud.colors.end());
    if (!cloud.has_colors()) {
        Bounds box;
        for (const Vec3& p : cloud.positions)
            box.add(DVec3(p));
        colors.clear();
        for (const Vec3& p : cloud.positions)
            colors.push_back(
                height_color((static_cast<double>(p.y) - box.min.y) / std::max(box.size().y, 1e-6)));
    }
    return drawn_points(view, cloud, colors, progress);
}

Image heat_panel(const PanelView& view, const PointCloud& cloud, const Fidelity& fidelity,
                 const Progress* progress) {
    if (fidelity.point_error.size() != cloud.size())
        throw Error("The fidelity was measured with another cloud.");
    std::vector<Rgb> colors;
    for (float error : fidelity.point_error)
        colors.push_back(heat_color(std::abs(static_cast<double>(error)), fidelity.tolerance));
    return drawn_points(view, cloud, colors, progress);
}

Image skeleton_panel(const PanelView& view, const Tree& tree, const Rgb* plain, const Progress* progress) {
    const BranchList list = list_branches(tree);
    std::vector<Vec3> dots;
    std::vector<Rgb> colors;
    const double step = 0.5 * view.metres_per_pixel();
    for (const Branch& branch : list.branches) {
        if (progress) progress->check();
        const Rgb& color =
            plain != nullptr
                ? *plain
                : kOrders[std::min<size_t>(static_cast<size_t>(branch.order), std::size(kOrders) - 1)];
        for (NodeId id : list.nodes_of(branch)) {
            const Node& node = tree.node(id);
            const std::optional<DVec3> to = view.place(node.position);
            if (!to) continue;
            if (node.parent == kNoNode) continue;
            const std::optional<DVec3> from = view.place(tree.node(node.parent).position);
            if (!from) continue;
            const double length = glm::distance(*from, *to);
            const auto parts = static_cast<size_t>(std::clamp(std::ceil(length / step), 1.0, 4096.0));
            for (size_t i = 0; i <= parts; i++) {
                dots.emplace_back(glm::mix(*from, *to, static_cast<double>(i) / static_cast<double>(parts)));
                colors.push_back(color);
            }
        }
    }
    Picture picture = view.start();
    picture.draw(dots, colors, 0.5 * view.metres_per_pixel(), progress);
    return picture.finish();
}

Image tree_panel(const PanelView& view, std::span<const OutlinePart> parts, const Rgb& bark,
                 const Progress* progress) {
    Picture picture = view.start();
    for (const OutlinePart& part : parts) {
        const Mesh mesh = view.placed(part.mesh);
        if (part.cut_out.pixels.empty())
            picture.draw(mesh, bark, progress);
        else
            picture.draw_textured(mesh, sunlit(part.cut_out), progress);
    }
    return picture.finish();
}

}  // namespace treerec
