// No wood is quite round: what a section has by measure, or where nothing better is known. Internal to mesh/.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/tube_rings.h"
#include "tree/section_shape.h"

namespace treerec {

// A ring's measured outline, by the ring's own angles.
struct RingOutline {
    double along = 0.0;
    double share = 0.0;  // how much of it is measured: 0 .. 1
    std::array<double, SectionShape::kHarmonics> cosine{}, sine{};
};

// What a node's section says, so many metres along its branch.
struct SectionPlace {
    double along;
    const SectionShape* shape;  // null: it was not measured
};

// A sum of low harmonics of the angle. Those that were not measured have phases that drift along the wood.
// Its mean radius is the wood's.
struct UnevenSection {
    // Metres along: it is round at both ends, and uneven between them. Nothing where they are equal.
    double from = 0.0;
    double until = 0.0;
    double radius = 1.0;                       // metres, about that of the wood
    std::array<double, 3> phases = {0, 0, 0};  // of the second to the fourth harmonic, where it begins,
    std::array<double, 3> drifts = {0, 0, 0};  // and radians per metre
    std::vector<RingOutline> rings;            // rising along; empty: nothing was measured

    // The radius at an angle, over the wood's.
    double factor(double along, double angle) const;
    // How that changes with the angle, per radian.
    double turn(double along, double angle) const;
    // How it changes along the wood, per metre.
    double rise(double along, double angle) const;
    bool is_measured() const { return !rings.empty(); }

  private:
    enum class Of { kRadius, kTurn };
    double prior(double along, double angle, Of what) const;
    double sum_at(double along, double angle, Of what) const;
    RingOutline outline_at(double along) const;
};

// seed: tells branches apart.
UnevenSection uneven_section(uint64_t seed, double radius, double from, double until);

// Metres over which what was measured fades, beside wood of such a radius in metres.
double section_lead(double radius);

// How far the outlines at the places between two others are from what is blended of those: over the radius,
// of the largest corner about. lead: see section_lead().
double missed_outline(std::span<const SectionPlace> places, double from, double to, double lead);

// How far what was measured stands out at most, from narrowest to widest, over the radius; 0 where nothing
// was.
double outline_relief(std::span<const SectionPlace> places, double along, double lead);

// Adds what was measured. It is blended between places, and fades to the rest within a few radii of the last
// one that has any. places: rising along the branch; rings: framed; on_foot: it goes on down a foot, else it
// begins at section.from.
void measure_section(UnevenSection& section, std::span<const SectionPlace> places, const Ring* rings,
                     size_t count, bool on_foot);

}  // namespace treerec
