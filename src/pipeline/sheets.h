// Two sheets that tell of a tree in pictures, as the theses that it was made by show theirs.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "fidelity/fidelity.h"
#include "fidelity/photo_judge.h"
#include "fidelity/photo_overlap.h"
#include "fidelity/picture.h"
#include "mesh/image.h"
#include "photos/colmap_model.h"
#include "pipeline/panels.h"
#include "progress.h"
#include "scan/point_cloud.h"
#include "tree/tree.h"

namespace treerec {

// The photos of a tree.
struct SheetPhotos {
    PhotoModel model;    // the tree's scan coordinates are the model's
    std::string folder;  // of the photos, by their names in the model
};

// What a sheet shows. The tree, its parts, the raw skeleton and the cloud's positions are in one frame.
struct SheetSubject {
    std::string name;  // the title
    const Tree& tree;
    std::span<const OutlinePart> parts;  // of the tree (outline_parts())
    const PointCloud& cloud;             // cleaned
    const Tree* raw = nullptr;           // the skeleton before it was pruned, where it is known
    const SheetPhotos* photos = nullptr;
    Rgb bark = kPanelBark;
};

// Chen 2025, 4.2: the photo that shows most of the tree, the cloud, the first skeleton and the pruned one,
// as that photo's camera sees them; below, the tree from +z, +x, -z and -x at one scale. Without photos that
// can be read the upper row looks along -z and begins with the cloud. Throws Cancelled, or Error for a tree
// without wood.
Image stages_sheet(const SheetSubject& subject, const Progress* progress = nullptr);

// What the pictures and the words below them are made of.
struct SheetFidelity {
    const Fidelity& fidelity;
    const PointCloud& wood;             // the cloud that it is of, in the tree's frame
    const PhotoJudge* judge = nullptr;  // of the photos
    const OutlineOverlap* outline = nullptr;
};

// Zhang 2013, 9.4 to 9.9 with table 9.1: from the front and from the side, as photos' cameras see them, the
// photo, the tree's outline on it, the cloud, and the tree; below, Q and what it is made of. Without photos
// that can be read: the cloud, its distances to the bark, the skeleton and the tree, from +z and from +x.
// Throws as stages_sheet() does.
Image fidelity_sheet(const SheetSubject& subject, const SheetFidelity& figures,
                     const Progress* progress = nullptr);

// The tree alone, from the front: for lists of many. Throws as stages_sheet() does.
Image tree_picture(const Tree& tree, std::span<const OutlinePart> parts, const Progress* progress = nullptr);

}  // namespace treerec
