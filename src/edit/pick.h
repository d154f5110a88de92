// What of a tree lies under a pointer, seen through a camera.
#pragma once

#include <vector>

#include "geometry/vec.h"
#include "tree/tree.h"

namespace treerec {

// to_clip: tree space to clip space as OpenGL has it: what is seen has w > 0 and -w <= z <= w, near things
// the smaller z / w. width, height: of the viewport, in the pixels of all places here (x rightwards, y
// downwards).
struct ScreenView {
    glm::dmat4 to_clip{1.0};
    double width = 1.0;
    double height = 1.0;
};

// Where a place of tree space is seen: x, y in pixels, z = depth, -1 at the near plane and 1 at the far one.
// False where it lies before the one, behind the other or behind the camera, or is no number.
bool project(const ScreenView& view, const DVec3& place, DVec3& seen);

// Of the nodes seen within `distance` pixels of `position` the nearest one; of those within two pixels of it
// the one nearest to the eye. Where there is none, the same for wood (the segments, as thick as they are
// seen): then the upper node of the segment. kNoNode where there is nothing, and where the view or the
// position is no number. Linear; allocates once.
NodeId pick_node(const Tree& tree, const ScreenView& view, const DVec2& position, double distance);

// The nodes seen in the rectangle between two corners, by rising id.
std::vector<NodeId> pick_nodes(const Tree& tree, const ScreenView& view, const DVec2& one_corner,
                               const DVec2& other_corner);

}  // namespace treerec
