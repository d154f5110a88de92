// The whole way from a folder of photos to a tree: what the program and the editor both run.
#pragma once

#include <optional>
#include <string>

#include "photos/bark_picture.h"
#include "photos/leaf_colours.h"
#include "photos/make_cloud.h"
#include "photos/marker_scale.h"
#include "photos/run_colmap.h"
#include "pipeline/reconstruct.h"
#include "progress.h"

namespace treerec {

struct PhotosOptions {
    ColmapOptions colmap;
    MakeCloudOptions cloud;
    ReconstructOptions reconstruct;  // a known length is one in the cloud's coordinates
    double marker_side = 0.0;        // metres: of the printed markers' black squares; 0 is not known
    bool bark = false;               // take the bark's pictures out of the photos, where they are good enough
    bool leaf_colours = false;       // and the leaves' colours
};

// How finely photos are matched.
MakeCloudOptions cloud_options_of(PhotoEffort effort);

struct PhotosResult {
    Reconstruction tree;  // with the warnings of all that was before it, the first ones first
    ColmapRun photos;
    MadeCloud made;
    MarkerScale marker;
    bool sized_by_marker = false;   // the scale is that of marker
    bool sized_by_gps = false;      // or that of photos.gps
    std::string photos_folder;      // where those lie that were read: given, taken out of a film, converted
    std::string cloud;              // the file that the tree was made of, in `out`
    std::optional<PhotoBark> bark;  // where the options ask for it,
    std::optional<LeafColours> leaf_colours;  // and for them
};

// photos: their folder, or a film of a walk around the tree, or a folder with one, whose frames become photos
// in out/frames (photos/film_frames.h). HEIC photos become JPEGs in out/photos (photos/heic_photos.h). Places
// the cameras (photos/run_colmap.h), makes out/cloud.ply, with COLMAP's model beside it in out/sparse/0, and
// a tree of that. What is there already from the same photos and options is taken: the tree alone may be made
// again with a known length or height. Where the options set no scale, printed markers of known side do
// (photos/marker_scale.h), or else the photos' GPS if it is sure enough (photos/gps_scale.h), and a warning
// says so, and where two of these differ by more than 5 %. The bark's pictures, where the photos give any
// (photos/bark_picture.h), go to out/bark/albedo.png, normal.png and roughness.png. Throws Error with a
// sentence, or Cancelled.
PhotosResult reconstruct_photos(const std::string& photos, const std::string& out,
                                const PhotosOptions& options, Progress* progress = nullptr);

}  // namespace treerec
