// The height fields of bark, each of a family of kinds. Lengths are metres.
#pragma once

#include <string>

#include "textures/bark_field.h"

namespace treerec::bark {

struct Palette {
    DVec3 crack;   // sRGB, the floor of the cracks
    DVec3 side;    // what lies between
    DVec3 crest;   // what the weather has bleached
    DVec3 accent;  // patches of another hue
};

// Deep interlacing ridges: oak, willow, poplar, ash. Shallow and narrow ones: maple, ginkgo.
struct Ridges {
    double spacing, length;  // of the net of fissures, around and along
    double depth, width;     // of the fissures
    double blocks;           // 0..1: how far cracks across cut the ridges
    double fibre;            // how far the fibres on them stand out
};
BarkPoint ridged(const Place& place, const Ridges& ridges, const Palette& palette);

// Plates of thin layers that flake off, with fissures between them: pine.
struct Plates {
    DVec2 size;
    double depth, width;  // of the fissures
    double layer;         // how thick a layer is
};
BarkPoint plated(const Place& place, const Plates& plates, const Palette& palette);

// Scales that lie over each other: spruce, apple; long ones are strips: an old maple.
struct Scales {
    DVec2 size;
    double thickness;
    double curl;  // 0..1: how far their lower edges stand off
};
BarkPoint scaly(const Place& place, const Scales& scales, const Palette& palette);

// A smooth skin, with lenticels across it: cherry, and what is young of most kinds.
struct Skin {
    DVec2 least, most;  // of its lenticels: around, along
    DVec2 spacing;
    double share;    // of places that have one
    double lip;      // how far they stand out (in, below 0)
    double stretch;  // 0..1: the fine fissures along the stem that growth makes
    double bands;    // 0..1: of lightness, around the stem
    double gloss;    // 0..1
};
BarkPoint smooth(const Place& place, const Skin& skin, const Palette& palette, const DVec3& lenticel);

// White peeling bark with black scars; the young one is copper and pales.
BarkPoint birch(const Place& place, bool young);
// Bumps, faint rings, blots.
BarkPoint pimpled(const Place& place, const Palette& palette);
// The rings that fallen fronds leave, with fibres between them.
BarkPoint ringed(const Place& place, const Palette& palette);

BarkPoint old_bark(const std::string& preset, const Place& place);
BarkPoint young_bark(const std::string& preset, const Place& place);

}  // namespace treerec::bark
