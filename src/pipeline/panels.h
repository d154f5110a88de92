// Pictures of the stages that a tree goes through, seen alike, and how they are laid out on a sheet.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fidelity/photo_overlap.h"
#include "fidelity/picture.h"
#include "geometry/bounds.h"
#include "mesh/image.h"
#include "mesh/mesh.h"
#include "photos/pinhole_view.h"
#include "progress.h"
#include "scan/point_cloud.h"
#include "tree/tree.h"

namespace treerec {

// One way to look at a tree that several pictures share, so that they lie on each other pixel by pixel.
class PanelView {
  public:
    // Level, without perspective, onto the whole of a box from an azimuth (PictureView's), in a picture of
    // this size; metres_per_pixel: as told, or so that the box just fits.
    static PanelView level(const Bounds& box, double azimuth, int width, int height,
                           double metres_per_pixel = 0.0);
    // As a photo's camera without a lens sees it. away: metres to what is looked at.
    static PanelView photo(const PinholeView& view, double away);

    // An empty picture of this view.
    Picture start() const { return Picture(view_); }
    // Places and meshes as Picture's view wants them; what is not in front of a camera goes.
    std::optional<DVec3> place(const DVec3& p) const;
    Mesh placed(const Mesh& mesh) const;
    int width() const { return width_; }
    int height() const { return view_.pixels; }
    double metres_per_pixel() const { return view_.height / view_.pixels; }

  private:
    PictureView view_;
    int width_ = 0;
    std::optional<PinholeView> camera_;
    double away_ = 0.0;
};

// The metres that a pixel of a picture of this size takes, so that the box fits in from every side.
double fitting_scale(const Bounds& box, int width, int height);

// Of the tree, its leaves, and the cloud but for its strays.
Bounds box_of(const Tree& tree, std::span<const OutlinePart> parts, const PointCloud& cloud);

// The cloud in its own colours, or by height where it has none. Throws Cancelled, as all of these do.
Image cloud_panel(const PanelView& view, const PointCloud& cloud, const Progress* progress = nullptr);
// Its points by their distance to the bark (heat_color()).
Image heat_panel(const PanelView& view, const PointCloud& cloud, const Fidelity& fidelity,
                 const Progress* progress = nullptr);
// The axes as lines, coloured by order of branching, or plain.
Image skeleton_panel(const PanelView& view, const Tree& tree, const Rgb* plain = nullptr,
                     const Progress* progress = nullptr);
// As a game shows it: parts of outline_parts(), the first of which is the bark.
Image tree_panel(const PanelView& view, std::span<const OutlinePart> parts, const Rgb& bark,
                 const Progress* progress = nullptr);
inline constexpr Rgb kPanelBark = {128, 99, 74};

struct Panel {
    Image image;  // of three channels
    std::string caption;
};

struct SheetFigure {
    std::string value;
    std::string name;
};

struct Sheet {
    std::string title;
    std::string subtitle;
    std::vector<std::vector<Panel>> rows;
    std::vector<SheetFigure> figures;  // below the pictures
    std::vector<std::string> notes;    // small, below these
};

// Light, with even margins; panels of a row have one height, and all columns one width. Sentences that are
// longer than the sheet is wide go on in a new line. Throws Error for a sheet without panels.
Image lay_out(const Sheet& sheet);

}  // namespace treerec
