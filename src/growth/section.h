// Wood that is not round: how far its bark lies from its axis towards each side. Internal to growth/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/vec.h"

namespace treerec::growth {

struct AxisPlace;
struct GrowthBranch;
struct GrowthPlan;
class BranchCoordinates;

// Of one branch: shares of its axis's radius, by height and direction. Around, a section goes through its
// shares by periodic cubics (Catmull and Rom 1974); from section to section they go by cubics that don't
// overshoot (Fritsch and Butland 1984). Before the first and after the last it stays as it is there, so that
// flutes run on into the ground.
class BranchSections {
  public:
    // along: metres of the axis; round: 0..1 about it, of the first of the shares, which stand in equal
    // directions. One at the same height as another takes its place.
    void add(double along, double round, std::span<const double> shares);
    // Becomes round from one height to another, and is so above.
    void fade(double from, double to);
    bool empty() const { return rows_.empty(); }
    // Of the axis's radius; 1 where there is no section.
    double share(double along, double round) const;

    // Between which rows a height is: for many directions at one height.
    struct Height {
        size_t row = 0;                                         // the lower one
        double low = 1.0, high = 0.0, leave = 0.0, come = 0.0;  // weights of both, and of their slopes
    };
    Height height(double along) const;
    double share(const Height& height, double round) const;

  private:
    struct Row {
        double along = 0.0;
        std::vector<double> shares, slopes;  // in equal directions; slopes: a metre along
    };
    void set_slopes();

    std::vector<Row> rows_;
};

// How many times as fast as round wood grows what is to have this share of its radius.
double pace_of(double share);

// Wood at one place of a branch, at one time.
class WoodSection {
  public:
    // radius: of round wood. In all directions the same where `sections` is null.
    WoodSection(double radius, const BranchSections* sections, const AxisPlace& place, double age,
                const DVec3& x);

    bool is_round() const { return sections_ == nullptr; }
    // Metres from its middle to its bark; off: from there any way, metres. Along the axis wood is round.
    double radius(const DVec3& off) const;
    // How many times as fast as round wood it grows towards there.
    double pace(const DVec3& off) const;

  private:
    double share(const DVec3& off) const;

    const double radius_;
    const BranchSections* sections_;
    BranchSections::Height height_;
    double age_ = 1.0;  // 0: still round, 1: as it is to be
    DVec3 axis_{0.0}, x_{0.0}, y_{0.0};
};

// Of all branches. The plan must outlive it.
class WoodSections {
  public:
    explicit WoodSections(const GrowthPlan& plan);
    ~WoodSections();
    WoodSections(const WoodSections&) = delete;
    WoodSections& operator=(const WoodSections&) = delete;

    WoodSection at(int32_t branch, const AxisPlace& place, double step) const;

  private:
    const GrowthPlan& plan_;
    std::vector<std::optional<BranchCoordinates>> coordinates_;  // of those that are not round
};

}  // namespace treerec::growth
