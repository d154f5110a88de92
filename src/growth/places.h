// Where on a tree's bark a user points, and how a lump would look there, without anything being grown.
#pragma once

#include <memory>
#include <optional>

#include "geometry/vec.h"
#include "growth/recipe.h"
#include "mesh/mesh.h"
#include "tree/tree.h"

namespace treerec {

// A place of a recipe in the tree's space.
struct BarkPlace : GrowthPlace {
    DVec3 axis{0.0};       // metres: the middle of its branch there
    DVec3 direction{0.0};  // unit, of the branch, towards its tip
    DVec3 out{0.0};        // unit, from the axis to the bark
    double radius = 0.0;   // metres, of the branch there

    DVec3 position() const { return axis + out * radius; }
};

class BarkPlaces {
  public:
    // The wood that bark grows on with these edges, metres, of which there may be none.
    BarkPlaces(const Tree& tree, double longest, double shortest);
    ~BarkPlaces();
    BarkPlaces(BarkPlaces&&) noexcept;
    BarkPlaces& operator=(BarkPlaces&&) noexcept;

    // The bark that a line of sight meets first. from: metres; way: of any length but 0.
    std::optional<BarkPlace> pick(const DVec3& from, const DVec3& way) const;
    // Where a place of a recipe is, held at its branch's ends. Nothing on a branch that stays a tube.
    std::optional<BarkPlace> find(const GrowthPlace& place) const;
    // How a burl, or a ridge along the grain, lifts the bark at last: equation 6 of Mizoguchi and Miyata 2014
    // with the branch's radius for what plain cambium grows. twist: radians a metre, of the grain. Positions,
    // normals and UVs in metres: u about the branch, v along it. Empty as find().
    Mesh lift(const GrowthFeature& burl, double twist) const;
    // The mouth of a hollow, a patch that lies on the bark: UVs go from -1 to 1 across it and along the
    // branch, its ellipse is where they are as long as 1; custom0: half its width, half its height and its
    // depth, metres; tangents lie across. Empty as find().
    Mesh mouth(const GrowthFeature& hollow) const;

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace treerec
