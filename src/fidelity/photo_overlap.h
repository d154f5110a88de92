// Whether a tree has the outline that its photos show. R_3d (photo_fidelity.h) and R_s tell how much of a
// cloud is right and can't see what is missing: a cloud of ten points on the trunk has both at 1. Recall and
// intersection over union can.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "fidelity/sample_mask.h"
#include "foliage/foliage.h"
#include "foliage/leaves.h"
#include "geometry/scan_frame.h"
#include "mesh/image.h"
#include "mesh/mesh.h"
#include "photos/colmap_model.h"
#include "photos/pinhole_view.h"
#include "progress.h"
#include "tree/tree.h"

namespace treerec {

// Shares of pixels; each counts by how much of it is covered.
struct Overlap {
    double recall = 0.0;     // of the mask that the tree covers
    double precision = 0.0;  // of the tree in the picture that lies on the mask
    double iou = 0.0;        // of what either covers that both do (intersection over union)
};

struct PhotoOverlap {
    std::string name;
    Overlap overlap;
};

struct OutlineOverlap {
    Overlap mean;  // over the photos
    std::vector<PhotoOverlap> photos;
};

// A part of what is seen.
struct OutlinePart {
    Mesh mesh;      // metres, Y up
    Image cut_out;  // of four channels: what is less than half opaque is a hole; or empty
};

// A tree as a game shows it from near: its bark above the ground, and its leaves' cards with the holes in
// their pictures.
// Throws Error for rules that check_leaf_rules() refuses, or Cancelled.
std::vector<OutlinePart> outline_parts(const Tree& tree, const LeafRules& rules, const std::string& textures,
                                       uint64_t seed, const Foliage& foliage,
                                       const Progress* progress = nullptr);

// The same of kinds of leaves (leaf_kinds()).
std::vector<OutlinePart> outline_parts(const Tree& tree, const std::vector<LeafKind>& kinds,
                                       const std::string& textures, uint64_t seed, const Foliage& foliage,
                                       const Progress* progress = nullptr);

// The parts as black shapes in a view. Triangles that reach behind the camera are left out. Throws Cancelled.
SampleMask drawn_outline(std::span<const OutlinePart> parts, const PinholeView& view,
                         const Progress* progress = nullptr);

// As a camera without a lens sees them, in pictures whose longer side has `longest` pixels at most. Triangles
// that reach behind the camera are left out. frame: of the parts, whose scan coordinates are the model's.
// masks: as measure_photos() takes them (photo_fidelity.h); those without a white pixel count neither way.
// Deterministic, on several threads. Throws Error where masks are missing or of other proportions than their
// photo, where all are black, or Cancelled.
OutlineOverlap measure_overlap(std::span<const OutlinePart> parts, const ScanFrame& frame,
                               const PhotoModel& model, const std::vector<Image>& masks, int longest = 1024,
                               const Progress* progress = nullptr);

// A photo's mask as a camera without a lens shows it, to be compared with again and again.
struct OutlineMask {
    Photo photo;
    Camera camera;
    int longest = 0;  // pixels of the longer side at most
    Image mask;       // one channel, 255 on the tree
    Image shown;      // 0 where the lens shows nothing
};

// mask: of any size with the photo's proportions. Throws Error for a lens without a middle.
OutlineMask outline_mask(const Photo& photo, const Camera& camera, const Image& mask, int longest = 1024);

// measure_overlap() with these masks: the same figures.
OutlineOverlap measure_overlap(std::span<const OutlinePart> parts, const ScanFrame& frame,
                               std::span<const OutlineMask> masks, const Progress* progress = nullptr);

}  // namespace treerec
