#include "foliage/leaf_area.h"

#include <algorithm>
#include <cmath>

#include "geometry/parallel.h"
#include "geometry/portable_math.h"
#include "geometry/random.h"

namespace treerec {

namespace {

constexpr double kSquare = 0.5;         // metres along an edge
constexpr double kFewestAcross = 6.0;   // squares in a crown's width
constexpr double kBladeFill = 0.65;     // of the rectangle around a blade: an ellipse with a drawn-out tip
constexpr double kPinnateLength = 2.2;  // of all leaflets together, over the leaf's (leaf_card_shapes.cpp)
constexpr double kPinnateMean = 0.85;   // of a leaflet's area, over that of the longest
constexpr double kPalmateMean = 0.72;   // of a leaflet's length and width, over those of the middle one
constexpr double kSprigLeaf = 0.34;     // of the sprig's length, as leaf_card_shapes.cpp has it
constexpr double kExtinction = 0.5;   // of light, by an area of leaves as large as the ground (Monsi, Saeki)
constexpr double kSideLight = 0.6;    // of the light from above: what comes in where there is nothing beside
constexpr double kLeastLight = 0.05;  // scattered
constexpr double kWoodland = 1.5;     // a crown's height over its width, as those have that an index is of
constexpr double kTipsFirst = 2.0;    // a twig's end shows more when it is bare
constexpr size_t kSpotsPerChunk = 512;
constexpr uint64_t kIndexKey = 0x6c616900ULL;  // "lai"

uint64_t pack(int64_t x, int64_t y, int64_t z) {
    constexpr int64_t kMiddle = 1 << 20;
    constexpr uint64_t kMask = (1ULL << 21) - 1;
    return ((static_cast<uint64_t>(x + kMiddle) & kMask) << 42) |
           ((static_cast<uint64_t>(z + kMiddle) & kMask) << 21) |
           (static_cast<uint64_t>(y + kMiddle) & kMask);
}

int64_t cell_at(double way, double edge) {
    return static_cast<int64_t>(std::floor(std::clamp(way / edge, -1e6, 1e6)));
}

struct Borne {
    int64_t x, y, z;  // of its cube
    double height;
    double area;
    size_t place;       // in the spots
    double rank = 0.0;  // the lower, the longer it stays

    uint64_t square() const { return pack(x, 0, z); }
};

// Where most of the leaf will be.
DVec3 middle_of(const LeafSpot& spot, double size) {
    const SineCosine out = portable_sine_cosine(glm::radians(spot.angle));
    return spot.at.position + (spot.at.direction * out.cosine + spot.radial * out.sine) * (0.5 * size);
}

// By a random number of its own, weighted by its light (Efraimidis and Spirakis 2006).
double rank_of(const LeafPlacer& placer, const LeafSpot& spot, double light) {
    const uint64_t key = hash_seed(placer.seed ^ kIndexKey, static_cast<uint64_t>(spot.tip));
    const double own = (static_cast<double>(hash_seed(key, spot.number) >> 11) + 0.5) * 0x1p-53;
    return -portable::log(own) / (light * (spot.number == 0 ? kTipsFirst : 1.0));
}

// The cubes of the crown that have leaves.
class LeafyCubes {
  public:
    explicit LeafyCubes(const std::vector<Borne>& leaves) {
        for (const Borne& leaf : leaves)
            cubes_.push_back(pack(leaf.x, leaf.y, leaf.z));
        std::sort(cubes_.begin(), cubes_.end());
        cubes_.erase(std::unique(cubes_.begin(), cubes_.end()), cubes_.end());
    }
    // The share of the ways to the side that have none for a metre.
    double open_sides(const Borne& leaf) const {
        constexpr int64_t kAside[][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
        int open = 0;
        for (const auto& [x, z] : kAside) {
            bool free = true;
            for (const int64_t far : {1, 2})
                free = free && !std::binary_search(cubes_.begin(), cubes_.end(),
                                                   pack(leaf.x + far * x, leaf.y, leaf.z + far * z));
            open += free;
        }
        return 0.25 * open;
    }

  private:
    std::vector<uint64_t> cubes_;
};

std::vector<Borne> weigh(const LeafPlacer& placer, const CrownGround& ground,
                         const std::vector<const LeafSpot*>& spots) {
    std::vector<Borne> leaves(spots.size());
    const double share = blade_area(placer.rules);
    parallel_for(spots.size(), kSpotsPerChunk, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++) {
            const double size = placer.size_of(*spots[i]);
            const DVec3 p = middle_of(*spots[i], size);
            const auto [x, y, z] = ground.cube_of(p);
            leaves[i] = {x, y, z, p.y, share * size * size, i};
        }
    });
    return leaves;
}

}  // namespace

double blade_area(const LeafRules& rules) {
    const double single = kBladeFill * rules.blade_width;
    switch (rules.form) {
        case LeafForm::kSpray:
            return rules.spray_cover;
        case LeafForm::kPinnate: {
            const double length = std::clamp(kPinnateLength / rules.leaflets, 0.12, 0.5);
            return rules.leaflets * single * length * length * kPinnateMean;
        }
        case LeafForm::kPalmate:
            return rules.leaflets * single * kPalmateMean * kPalmateMean;
        case LeafForm::kNeedles:
            return rules.leaflets * single;
        case LeafForm::kSprig:
            if (rules.sprig) {
                const size_t leaves = rules.sprig->leaves.empty()
                                          ? rules.sprig->wood.nodes_of_kind(NodeKind::kLeaf).size()
                                          : rules.sprig->leaves.size();
                return static_cast<double>(leaves) * single * kSprigLeaf * kSprigLeaf;
            }
            break;
        case LeafForm::kSimple:
            break;
    }
    return single;
}

double light_on(const Crown& crown) {
    // Knud Thomsen's surface of an ellipsoid; a quarter of it is the mean of its shadows (Cauchy).
    constexpr double kPower = 1.6;
    const double slender = crown.radii.y / (kWoodland * crown.radii.x);
    if (slender <= 1.0) return 1.0;
    return portable::pow((1.0 + 2.0 * portable::pow(slender, kPower)) / 3.0, 1.0 / kPower);
}

CrownGround::CrownGround(const Crown& crown) : edge_(kSquare) {
    const double widest = 2.0 * crown.radii.x / kFewestAcross;
    while (edge_ > widest)
        edge_ *= 0.5;
    edge_ = std::max(edge_, 1e-5 * crown.coordinate);
}

std::array<int64_t, 3> CrownGround::cube_of(const DVec3& p) const {
    return {cell_at(p.x, edge_), cell_at(p.y, edge_), cell_at(p.z, edge_)};
}

namespace {

double area_of(const CrownGround& ground, std::vector<uint64_t>& squares) {
    std::sort(squares.begin(), squares.end());
    const auto count = std::unique(squares.begin(), squares.end()) - squares.begin();
    return static_cast<double>(count) * ground.edge() * ground.edge();
}

}  // namespace

LeafBudget measure_leaves(const LeafPlacer& placer, const std::vector<const LeafSpot*>& spots) {
    const CrownGround ground(placer.crown);
    std::vector<uint64_t> squares;
    LeafBudget budget;
    for (const Borne& leaf : weigh(placer, ground, spots)) {
        squares.push_back(leaf.square());
        budget.blades += leaf.area;
    }
    budget.ground = area_of(ground, squares);
    return budget;
}

double covered_ground(const CrownGround& ground, const Foliage& foliage) {
    std::vector<uint64_t> squares;
    for (const FoliageCell& cell : foliage.cells) {
        const auto [x, y, z] = ground.cube_of(foliage.centre(cell));
        squares.push_back(pack(x, 0, z));
    }
    const double own = foliage.edge / ground.edge();
    return area_of(ground, squares) * std::max(1.0, own * own);
}

void thin_to_index(const LeafPlacer& placer, double index, std::vector<const LeafSpot*>& spots) {
    const CrownGround ground(placer.crown);
    const double square = ground.edge() * ground.edge(), most = index * square;
    std::vector<Borne> leaves = weigh(placer, ground, spots);
    const LeafyCubes cubes(leaves);
    std::sort(leaves.begin(), leaves.end(), [](const Borne& a, const Borne& b) {
        if (a.square() != b.square()) return a.square() < b.square();
        return a.height != b.height ? a.height > b.height : a.place < b.place;
    });
    std::vector<uint8_t> stays(spots.size(), 0);
    for (auto begin = leaves.begin(); begin != leaves.end();) {
        const auto end = std::find_if(begin, leaves.end(),
                                      [&](const Borne& leaf) { return leaf.square() != begin->square(); });
        double above = 0.0;
        for (auto leaf = begin; leaf != end; ++leaf) {
            const double from_above = portable::exp(-kExtinction * above / square);
            const double light = std::max({from_above, kSideLight * cubes.open_sides(*leaf), kLeastLight});
            leaf->rank = rank_of(placer, *spots[leaf->place], light);
            above += leaf->area;
        }
        if (above > most)
            std::sort(begin, end, [](const Borne& a, const Borne& b) {
                return a.rank != b.rank ? a.rank < b.rank : a.place < b.place;
            });
        double borne = 0.0;
        for (auto leaf = begin; leaf != end && borne + 0.5 * leaf->area < most; ++leaf) {
            stays[leaf->place] = 1;
            borne += leaf->area;
        }
        begin = end;
    }
    size_t kept = 0;
    for (size_t i = 0; i < spots.size(); i++)
        if (stays[i]) spots[kept++] = spots[i];
    spots.resize(kept);
}

}  // namespace treerec
