// Pictures of points and meshes, drawn without an engine: for reports.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fidelity/fidelity.h"
#include "geometry/bounds.h"
#include "geometry/vec.h"
#include "mesh/image.h"
#include "mesh/mesh.h"
#include "progress.h"

namespace treerec {

using Rgb = std::array<uint8_t, 3>;

// A level, orthographic view from `azimuth` (radians about the up axis: 0 looks along -z, with +x to the
// right), onto a box of tree space.
struct PictureView {
    double azimuth = 0.0;
    DVec3 centre{0.0};    // shown in the middle
    double width = 1.0;   // metres across the picture
    double height = 1.0;  // and down it
    int pixels = 640;     // of the height, 16..4096
};

// The view from an azimuth that just holds a box. Views of one box have the same scale, unless it is flat.
PictureView view_of(const Bounds& box, double azimuth, int pixels);

class Picture {
  public:
    explicit Picture(const PictureView& view);

    // Lit from the upper left, behind the viewer. color: of all of it.
    void draw(const Mesh& mesh, const Rgb& color, const Progress* progress = nullptr);
    // Coloured by a picture of four channels that is laid on by the mesh's UVs; what is less than half opaque
    // is a hole.
    void draw_textured(const Mesh& mesh, const Image& picture, const Progress* progress = nullptr);
    // Round dots of `radius` metres (at least a pixel across), in tree space. colors: one each.
    void draw(const std::vector<Vec3>& points, const std::vector<Rgb>& colors, double radius,
              const Progress* progress = nullptr);

    // What has something nearer beside it gets darker (eye-dome lighting: C. Boucheny 2009), so that depth
    // shows; edges are smoothed. Three channels, on `background`.
    Image finish(const Rgb& background = {255, 255, 255}) const;

  private:
    // pixel(i, b, c): the colour of the triangle of which mesh.indices[i] is the first corner, where b and c
    // are the shares of its second and third one; nothing for a hole.
    template <typename Pixel>
    void draw_triangles(const Mesh& mesh, Pixel pixel, const Progress* progress);
    void set(int x, int y, double depth, const Rgb& color) {
        const size_t at = static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
        if (depth >= depth_[at]) return;
        depth_[at] = static_cast<float>(depth);
        color_[at] = color;
    }
    // In samples from the upper left corner, and metres away from the viewer.
    DVec3 place(const DVec3& p) const;

    PictureView view_;
    DVec3 right_, away_;
    double sample_ = 1.0;  // metres
    int width_ = 0, height_ = 0;
    std::vector<float> depth_;
    std::vector<Rgb> color_;
};

// Of a distance to the bark: blue at none, pale at the tolerance, red at three times it and beyond.
Rgb heat_color(double distance, double tolerance);

// By vertex of the tree's bark (mesh/branch_tubes.h): the colour of the mean distance of the points that lie
// nearest to the wood there, and grey for wood that no point is nearest to. Linear but for the search.
std::vector<Rgb> bark_heat(const Tree& tree, const Fidelity& fidelity, const Mesh& bark,
                           const Progress* progress = nullptr);
inline constexpr Rgb kUnseenWood = {140, 140, 148};

}  // namespace treerec
