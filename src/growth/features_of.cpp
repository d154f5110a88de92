#include "growth/features_of.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "error.h"
#include "exchange/read_triangles.h"
#include "growth/bark_map.h"
#include "growth/shapes.h"
#include "growth/texture.h"

namespace treerec::growth {

namespace {

constexpr int kMouthSides = 32, kPostSides = 16, kWireSides = 8;
constexpr double kMouthDepth = 0.15;  // of the radius at the end: from where on outwards bark decays
constexpr double kFace = 0.75;        // of the wood's radius when it is cut: of what is dead of a cut face
constexpr double kFaceDepth = 0.5;    // radii of a cut end that the region of its dead wood reaches in
constexpr double kBeforeEnd = 1.6;    // longest edges before its end at which a tip is through
constexpr double kFades = 4.0;  // radii below an open end, from where on wood becomes round as the tube is
constexpr double kSeed = 1.7;   // longest edges about the seed that must be free

struct Spot {
    int32_t branch = 0;   // of the plan
    AxisPlace axis;       // there
    DVec3 out{0.0};       // unit, from the axis
    double radius = 0.0;  // metres, of the wood towards there
};

// what: "A burl", for the sentence that tells why there is none.
std::optional<Spot> find_spot(const Tree& tree, const BranchList& list, const TreePlan& planned,
                              const GrowthRecipe& recipe, const GrowthPlace& place, const char* what,
                              std::vector<std::string>& remarks) {
    const int32_t branch = list.branch_of[place.node];
    const auto at = std::find(planned.branch_of.begin(), planned.branch_of.end(), branch);
    if (at == planned.branch_of.end()) {
        remarks.push_back(std::string(what) + " was left out: its branch is thinner than " +
                          std::to_string(static_cast<int>(std::lround(1000.0 * recipe.shortest))) +
                          " mm and stays a tube. Give it a thicker branch, or shorter edges.");
        return std::nullopt;
    }
    Spot spot;
    spot.branch = static_cast<int32_t>(at - planned.branch_of.begin());
    const GrowthBranch& grown = planned.plan.branches[static_cast<size_t>(spot.branch)];
    const double from = place.node == tree.root() ? 0.0 : along_of(tree, grown, place.node);
    const double along = from + place.along;
    if (along < grown.axis.front().along || along > grown.axis.back().along) {
        remarks.push_back(
            std::string(what) + " lies " + number_text(along) + " m along its branch, which is grown from " +
            number_text(std::round(100.0 * grown.axis.front().along) / 100.0) + " to " +
            number_text(std::round(100.0 * grown.axis.back().along) / 100.0) + " m: it was left out.");
        return std::nullopt;
    }
    spot.axis = place_at(grown, along);
    spot.out = BranchCoordinates(grown).direction(along, place.around / 360.0);
    spot.radius = spot.axis.radius * grown.sections.share(along, place.around / 360.0);
    return spot;
}

// The band holds the next vertices at least.
Lip lip_of(const GrowthLip& lip, double longest) {
    return {lip.radius, lip.inner, lip.growth, lip.wrap, std::max(lip.band, longest)};
}

// An elliptic mouth through which bark of any age comes.
Region mouth_of(const GrowthFeature& wanted, const Spot& spot) {
    Triangles triangles;
    if (wanted.region.empty()) {
        const DVec3 across = glm::cross(spot.axis.direction, spot.out);
        const DVec3 inside = spot.axis.position + spot.out * (kMouthDepth * spot.radius),
                    outside = spot.axis.position + spot.out * (4.0 * spot.radius + wanted.height);
        triangles = prism(inside, outside, across * (0.5 * wanted.width),
                          spot.axis.direction * (0.5 * wanted.height), kMouthSides);
    } else {
        triangles = read_triangles(wanted.region);
    }
    Region region;
    for (const std::array<DVec3, 3>& triangle : triangles)
        region.add(triangle[0], triangle[1], triangle[2]);
    return region;
}

Triangles placed_mesh(const GrowthObstacle& wanted) {
    if (!wanted.mesh.empty() && wanted.triangles.empty())
        throw Error("The obstacle " + quote_word(wanted.mesh) +
                    " is a mesh of a scene, which is not at hand here. Grow this recipe in the editor, or "
                    "give the obstacle a file=, a .glb, .gltf or .obj file.");
    Triangles triangles = wanted.mesh.empty() ? read_triangles(wanted.file) : wanted.triangles;
    const DVec3 x = wanted.x.value_or(DVec3(1.0, 0.0, 0.0)), y = wanted.y.value_or(DVec3(0.0, 1.0, 0.0)),
                z = wanted.z.value_or(DVec3(0.0, 0.0, 1.0)), middle = wanted.at.value_or(DVec3(0.0));
    const bool mirrored = glm::dot(glm::cross(x, y), z) < 0.0;
    for (std::array<DVec3, 3>& triangle : triangles) {
        for (DVec3& corner : triangle)
            corner = middle + x * corner.x + y * corner.y + z * corner.z;
        if (mirrored) std::swap(triangle[1], triangle[2]);
    }
    return triangles;
}

Triangles triangles_of(const GrowthObstacle& wanted, const Spot& spot) {
    using Shape = GrowthObstacle::Shape;
    if (wanted.shape == Shape::kMesh) return placed_mesh(wanted);
    const DVec3 middle = wanted.at ? *wanted.at : spot.axis.position + spot.out * (spot.radius + wanted.gap);
    const DVec3 across = glm::cross(spot.axis.direction, spot.out);
    // Unless told: posts stand along the branch, wires run across it, sheets and boxes face it, rings go
    // around it.
    const bool along = wanted.shape == Shape::kPost || wanted.shape == Shape::kTorus;
    const DVec3 standard = along ? spot.axis.direction : wanted.shape == Shape::kWire ? across : spot.out;
    const DVec3 z = wanted.direction ? *wanted.direction : standard;
    DVec3 y = spot.axis.direction - z * glm::dot(spot.axis.direction, z);
    y = normalized_or(y, any_perpendicular(z));
    const DVec3 x = glm::cross(y, z);
    const double half = 0.5 * wanted.length, thin = 0.5 * wanted.thickness;
    switch (wanted.shape) {
        case Shape::kPost:
            return prism(middle - z * half, middle + z * half, x * wanted.radius, y * wanted.radius,
                         kPostSides);
        case Shape::kWire:
            return prism(middle - z * half, middle + z * half, x * thin, y * thin, kWireSides);
        case Shape::kBox:
            return box(middle, x * (0.5 * wanted.width), y * half, z * thin);
        case Shape::kSheet:
            return sheet(middle, x * (0.5 * wanted.width), y * half);
        default:
            return torus(middle, z, wanted.radius, wanted.thickness);
    }
}

// Hollows at the covered branches' ends that are as thick as cut ones.
void add_cuts(const TreePlan& planned, const GrowthCuts& cuts, double longest,
              std::vector<Feature>& features) {
    for (size_t b = 0; b < planned.plan.branches.size(); b++) {
        const GrowthBranch& branch = planned.plan.branches[b];
        const AxisPlace& end = branch.axis.back();
        if (branch.ends_open || end.radius < cuts.least) continue;
        Feature feature;
        feature.kind = Feature::Kind::kHollow;
        feature.cut = true;
        feature.branch = static_cast<int32_t>(b);
        feature.along = std::max(end.along - kBeforeEnd * longest, branch.axis.front().along);
        feature.direction = any_perpendicular(end.direction);
        feature.first_step = std::min(glm::mix(end.step, static_cast<double>(planned.plan.steps), cuts.from),
                                      planned.plan.steps - 1.0);
        feature.last_step = feature.first_step + 1.0;
        const double radius = kFace * bark_radius(planned.plan, end, feature.first_step);
        const DVec3 x = feature.direction, y = glm::cross(end.direction, x);
        for (const std::array<DVec3, 3>& triangle :
             prism(end.position - end.direction * (kFaceDepth * end.radius),
                   end.position + end.direction * (4.0 * end.radius + longest), x * radius, y * radius,
                   kMouthSides))
            feature.region.add(triangle[0], triangle[1], triangle[2]);
        feature.deepest = cuts.depth;
        feature.lip = lip_of(cuts.lip, longest);
        features.push_back(std::move(feature));
    }
}

}  // namespace

void add_sections(const Tree& tree, const BranchList& list, const GrowthRecipe& recipe,
                  std::vector<std::string>& remarks, TreePlan& planned) {
    const size_t count = planned.plan.branches.size();
    std::vector<BranchSections> sections(count);
    for (const GrowthSection& wanted : recipe.sections)
        if (const std::optional<Spot> spot =
                find_spot(tree, list, planned, recipe, wanted, "A section", remarks))
            sections[static_cast<size_t>(spot->branch)].add(spot->axis.along, wanted.around / 360.0,
                                                            wanted.radii);
    for (size_t b = 0; b < count; b++) {
        GrowthBranch& branch = planned.plan.branches[b];
        if (branch.ends_open && !sections[b].empty()) {
            const AxisPlace& end = branch.axis.back();
            sections[b].fade(end.along - kFades * end.radius, end.along);
        }
        branch.sections = std::move(sections[b]);
    }
}

std::vector<Feature> features_of(const Tree& tree, const BranchList& list, const TreePlan& planned,
                                 const GrowthRecipe& recipe, std::vector<std::string>& remarks) {
    std::vector<Feature> features;
    for (const GrowthFeature& wanted : recipe.features) {
        const bool hollow = wanted.kind == GrowthFeature::Kind::kHollow;
        const std::optional<Spot> spot =
            find_spot(tree, list, planned, recipe, wanted, hollow ? "A hollow" : "A burl", remarks);
        if (!spot) continue;
        Feature feature;
        feature.kind = hollow ? Feature::Kind::kHollow : Feature::Kind::kBurl;
        feature.branch = spot->branch;
        feature.along = spot->axis.along;
        feature.direction = spot->out;
        const double age = planned.plan.steps - spot->axis.step;
        feature.first_step = spot->axis.step + wanted.from * age;
        feature.radius = wanted.radius;
        feature.inner = wanted.inner;
        feature.growth = wanted.growth;
        feature.length = wanted.length;
        feature.every = wanted.every;
        if (hollow) {
            feature.region = mouth_of(wanted, *spot);
            feature.last_step = spot->axis.step + wanted.until * age;
            feature.deepest = wanted.depth;
            feature.wall = wanted.wall;
            feature.lip = lip_of(wanted.lip, recipe.longest);
        }
        features.push_back(std::move(feature));
    }
    if (recipe.cuts) add_cuts(planned, *recipe.cuts, recipe.longest, features);
    return features;
}

void add_obstacles(const Tree& tree, const BranchList& list, const TreePlan& planned,
                   const GrowthRecipe& recipe, std::vector<std::string>& remarks, Obstacles& obstacles) {
    for (const GrowthObstacle& wanted : recipe.obstacles) {
        Spot spot;
        const bool placed = wanted.shape == GrowthObstacle::Shape::kMesh || (wanted.at && wanted.direction);
        if (!placed) {
            const std::optional<Spot> found =
                find_spot(tree, list, planned, recipe, wanted, "An obstacle", remarks);
            if (!found) continue;
            spot = *found;
        }
        obstacles.begin(lip_of(wanted.lip, recipe.longest));
        for (const std::array<DVec3, 3>& triangle : triangles_of(wanted, spot))
            obstacles.add(triangle[0], triangle[1], triangle[2]);
    }
    for (const std::array<DVec3, 3>& own : planned.plan.seed) {
        const DVec3 triangle[3] = {own[0], own[1], own[2]};
        if (obstacles.meets(triangle, 0.0) >= 0)
            throw Error("An obstacle stands in the seed that bark starts from. Move one of them aside.");
    }
    if (!planned.plan.seed.empty()) return;
    const DVec3& base = planned.plan.branches.front().axis.front().position;
    if (obstacles.distance(Box{base, base}, kSeed * recipe.longest) < kSeed * recipe.longest)
        throw Error(
            "An obstacle stands where the trunk begins, below the ground: nothing can grow there. "
            "Move it aside.");
}

}  // namespace treerec::growth
