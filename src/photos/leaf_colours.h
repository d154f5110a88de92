// The colours of leaves out of the photos that a tree was made of.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "geometry/scan_frame.h"
#include "geometry/vec.h"
#include "photos/colmap_model.h"
#include "photos/seen_bark.h"
#include "progress.h"

namespace treerec {

struct LeafColourOptions {
    size_t most_points = 20000;  // that are looked at; of more, every n-th
    size_t least_points = 300;   // that have to be seen
    size_t least_photos = 3;     // that have to show leaves
    double shade_share = 0.5;    // of leaves, those that are darker count as shaded,
    double gloss_share = 0.1;    // and of the others so many of all as bleached by the light
    double darkest = 0.045;      // what leaves reflect of the light: others are brought to it,
    double lightest = 0.35;
};

// Leaves of about one height.
struct LeafBand {
    double low = 0.0;  // metres above the tree's root
    double high = 0.0;
    DVec3 colour{0.0};  // as LeafColours::albedo
    size_t points = 0;
};

// Colours are linear light (IEC 61966-2-1's primaries), 0..1, of leaves that the light falls on.
struct LeafColours {
    std::string why_not;          // a sentence, where there are none
    size_t photos = 0;            // that show leaves
    size_t points = 0;            // leaf points that were seen
    DVec3 albedo{0.0};            // the mean
    DVec3 as_seen{0.0};           // the same, as light as the photos have it
    DVec3 greenest{0.0};          // of the third that is the most green, as light as `albedo`,
    DVec3 least_green{0.0};       // and of the third that is the least
    double tone_spread = 0.0;     // standard deviation of the logarithm of the luminance among lit leaves
    std::vector<LeafBand> bands;  // from below
    // The course from the lowest leaves to the highest: factors of `albedo`, between which logarithms go
    // straight. Their mean over the leaves is 1.
    double low_height = 0.0;  // metres above the tree's root
    double high_height = 0.0;
    DVec3 low{1.0};
    DVec3 high{1.0};

    bool seen() const { return why_not.empty(); }
};

// Looks where photos show the points, unless something stands before them or the sky is there; evens out the
// photos' exposures and white balances (photos/even_exposures.h), takes the middle of what they show of each
// point, and of these the lit ones, in each of five bands of height. Light falls on a crown's top: half of
// the luminance's course is taken for that, the colour's is kept. How light leaves are no photo tells: that
// is brought to what leaves reflect, where it is outside of that.
// leaves: points of leaves in the tree's space (metres, Y up), in a canonical order; things: all that the
// photos show, the leaves too. frame: the tree's, whose scan coordinates are the model's. Photos of the
// folder are read one at a time; those that can't be read are passed over. The same numbers whatever the
// number of threads. Throws Cancelled; what photos can't give is no error but told in `why_not`.
LeafColours leaf_colours_of_photos(const std::vector<DVec3>& leaves, const ScanFrame& frame,
                                   const PhotoModel& model, const std::string& folder,
                                   const SeenThings& things, const LeafColourOptions& options = {},
                                   Progress* progress = nullptr);

}  // namespace treerec
