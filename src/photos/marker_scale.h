// How long a model's unit is, from a printed marker of known size that its photos show.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "geometry/vec.h"
#include "photos/colmap_model.h"
#include "photos/photo_markers.h"

namespace treerec {

// One id, as all photos together have it.
struct MeasuredMarker {
    int id = 0;
    size_t photos = 0;               // that show it once
    size_t kept = 0;                 // of these, those that agree on where it is
    double parallax = 0.0;           // degrees: the widest angle between two of their lines of sight
    double side = 0.0;               // in the model's unit, the mean of four; 0 where it can't be measured
    double uneven = 0.0;             // how unlike its sides and diagonals / sqrt(2) are: deviation by mean
    double bent = 0.0;               // how far its diagonals are apart in their middles, by its side
    std::array<DVec3, 4> corners{};  // in the model's coordinates, in the order of FoundMarker
    std::string why_not;             // a sentence where it tells no size

    bool usable() const { return why_not.empty() && side > 0.0; }
};

struct MarkerScale {
    // Of `uneven` and `bent`: corners that are found to a part of a pixel make a square of a print to 2 %,
    // unless it is bent, or the photos are wrong about it.
    static constexpr double kMostUneven = 0.05;
    static constexpr double kLeastParallax = 4.0;  // degrees
    static constexpr size_t kLeastPhotos = 2;

    size_t photos = 0;                    // that show a marker
    size_t unreadable = 0;                // that could not be looked at
    double told_side = 0.0;               // metres; 0: not told
    std::vector<MeasuredMarker> markers;  // by id
    double units_per_side = 0.0;          // of the model: the middle of all usable markers; 0 where none is
    double spread = 0.0;                  // by which that may be off, one deviation, as a share of it

    bool usable() const { return told_side > 0.0 && units_per_side > 0.0; }
    double metres_per_unit() const { return usable() ? told_side / units_per_side : 0.0; }
};

// Where each id is, from the photos that show it: its corners are the places nearest to their lines of sight,
// weighed by how sharply a photo sees them; a photo that does not agree with the most others is left out
// (M. Fischler and R. Bolles, "Random sample consensus", 1981, over all pairs of photos). Several ids: the
// median of their sides, weighed by photos. side: of the printed black square, metres; 0 is not known.
MarkerScale measure_markers(const PhotoModel& model, std::span<const PhotoMarkers> seen, double side);

// Why markers tell no size though their side is told, or that they would if it were; else nothing. told: the
// user has told the tree's size otherwise.
std::string marker_sentence(const MarkerScale& scale, bool told);

// A sentence where two scales, in metres per unit of the model, differ by more than 5 %; else nothing. one:
// the one that was taken; both as in "the printed marker".
std::string disagreement(const std::string& one, double scale, const std::string& other, double other_scale);

}  // namespace treerec
