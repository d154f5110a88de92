// Which points of a cloud that was made of photos are leaves, by the bark's colour.
#pragma once

#include "progress.h"
#include "scan/point_cloud.h"
#include "tree/tree.h"

namespace treerec {

// Gives the cloud labels where much of the crown has not the colour of the stem's bark
// (photos/bark_colours.h), and none where it has, as a bare one's does. cloud: in the scan's coordinates;
// tree: a first one made of it, which tells where the stem is. sky: its colour, 0 to 255. Whether it did.
// Throws Cancelled.
bool label_photo_leaves(PointCloud& cloud, const Tree& tree, const DVec3& sky,
                        const Progress* progress = nullptr);

}  // namespace treerec
