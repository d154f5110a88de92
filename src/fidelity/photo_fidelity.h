// What photos say about a cloud (Zhang 2013, 7.1 and 7.2).
#pragma once

#include <string>
#include <vector>

#include "mesh/image.h"
#include "photos/colmap_model.h"
#include "progress.h"
#include "scan/point_cloud.h"

namespace treerec {

struct PhotoHits {
    std::string name;
    size_t inside = 0;   // P_i: points that fall on the tree's outline
    size_t outside = 0;  // O_i: all others, also those that fall beside the picture or lie behind the camera
    size_t unseen = 0;   // of these, those that fall beside the picture or lie behind the camera
    double share = 0.0;  // P_i / (P_i + O_i)
};

struct PhotoFidelity {
    double information = 0.0;     // I = 1 - (a/b)^n (definition 7.2)
    double reconstruction = 0.0;  // R_3d: the mean of the shares (definition 7.3)
    double seen = 0.0;            // the same of the points that each photo shows
    std::vector<PhotoHits> photos;
};

inline constexpr double kInformationRatio = 0.8;  // a/b: how much less each further photo tells

// I of n photos, 0..1. ratio: a/b, 0..1.
double photo_information(size_t photos, double ratio = kInformationRatio);

// Throws Error where masks are missing or not of their camera's size, or for a model without photos.
void check_masks(const PhotoModel& model, const std::vector<Image>& masks);

// masks[i] belongs to model.photos[i]: one channel, 255 on the tree and 0 beside it. The cloud's scan
// coordinates are the model's. Throws Error where masks are missing or not of their camera's size, or for an
// empty cloud or a model without photos.
PhotoFidelity measure_photos(const PointCloud& cloud, const PhotoModel& model,
                             const std::vector<Image>& masks, double ratio = kInformationRatio,
                             const Progress* progress = nullptr);

// The masks of all photos of a model, from a folder that holds PHOTO.png (as COLMAP has it: a.jpg's is
// a.jpg.png), or the photo's name with the extension png, jpg, bmp or tga. What is at least half bright is
// tree. Throws Error naming the photos that have no mask, and masks that cannot be read.
std::vector<Image> read_masks(const std::string& folder, const PhotoModel& model,
                              const Progress* progress = nullptr);

// model: a folder with COLMAP's model; all of the above in one call.
PhotoFidelity measure_photos(const PointCloud& cloud, const std::string& model, const std::string& masks,
                             const Progress* progress = nullptr);

}  // namespace treerec
