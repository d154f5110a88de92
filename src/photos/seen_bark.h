// What photos show of a trunk's bark, on the trunk's chart.
#pragma once

#include <string>
#include <vector>

#include "mesh/image.h"
#include "photos/colmap_model.h"
#include "photos/trunk_chart.h"
#include "progress.h"

namespace treerec {

// How a photo shows a cell of the chart.
struct Glimpse {
    size_t photo = 0;    // of the model
    double score = 0.0;  // cosine of the angle of view, over the metres of a pixel
    double pixel = 0.0;  // metres on the bark that a pixel is wide
};

// Which photos can see which parts of the chart, told by where they were taken from.
struct BarkSurvey {
    double cell = 0.0;  // metres: the edge of the chart's cells
    int columns = 0;
    int rows = 0;                                // the uppermost first
    std::vector<std::vector<Glimpse>> glimpses;  // by cell, the best first, a few

    // The middle of the pixels' sizes in the best photos of all cells that are seen; 0 where none is.
    double usual_pixel() const;
    double seen_area() const;  // square metres
};

// What else the photos show: points of any surfaces in the tree's space, the trunk's own among them.
struct SeenThings {
    std::vector<DVec3> places;
    double spacing = 0.0;  // metres between points of one surface
};

// things: what stands before the trunk hides it, as the tree's other wood does.
BarkSurvey survey_bark(const Tree& tree, const TrunkChart& chart, const PhotoModel& model,
                       const SeenThings& things = {}, const Progress* progress = nullptr);

struct SeenBark {
    Image colours;              // RGB, sRGB, the photos' exposures evened out; 0 where nothing was seen
    std::vector<uint8_t> seen;  // by texel, 1 where it was
    double pixel = 0.0;         // metres on the bark: the middle of those that were used; 0 without any
    double detail = 0.0;        // metres: the same, where unsharp photos count as ones of larger pixels
    double area = 0.0;          // square metres that were seen
    size_t photos = 0;          // that were used
};

// The chart's colours with texels of this size (metres). Each cell is taken from the photo that shows it
// best, with regard to its sharpness, its likeness to other photos of the same place (what stands before the
// trunk is unlike) and to its neighbours' photo; exposures are evened out by one gain per photo and channel,
// as in Brown and Lowe, "Automatic Panoramic Image Stitching using Invariant Features", 2007, section 6.
// Photos of the folder are read one at a time; those that can't be read are passed over. Throws Cancelled.
SeenBark gather_bark(const TrunkChart& chart, const BarkSurvey& survey, const DVec2& texel,
                     const ScanFrame& frame, const PhotoModel& model, const std::string& folder,
                     Progress* progress = nullptr);

}  // namespace treerec
