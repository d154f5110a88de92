// What a vegetation artist sees at once in a tree, as figures.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>

#include "bench.h"
#include "error.h"
#include "exchange/material_textures.h"
#include "file_bytes.h"
#include "geometry/capsule_tree.h"
#include "geometry/circle_fit.h"
#include "geometry/quantile.h"
#include "mesh/leaf_cards.h"
#include "mesh/levels.h"
#include "photos/cameras_tell.h"
#include "pipeline/reconstruct.h"
#include "textures/textures.h"
#include "tree/wood_segments.h"

namespace treerec::bench {

namespace {

constexpr double kBreastHeight = 1.3;  // metres
constexpr double kStout = 3.0;         // times as thick as a tip: wood that it may hug
constexpr double kHugs = 3.0;          // of that wood's radii from its axis
constexpr double kSharp = 60.0;        // degrees
constexpr float kSolid = 0.4F;         // alpha from which on a leaf is drawn (leaf.gdshader)
constexpr int kPictureSize = 256;

double degrees_between(const DVec3& a, const DVec3& b) {
    const double lengths = glm::length(a) * glm::length(b);
    if (!(lengths > 0.0)) return 0.0;
    return std::acos(std::clamp(glm::dot(a, b) / lengths, -1.0, 1.0)) * 180.0 / std::numbers::pi;
}

// --- leaves -----------------------------------------------------------------------------------------------

// Of a card of size 1: square metres that its picture fills.
double filled_area(const Mesh& card, const Image& picture) {
    constexpr int kSteps = 12;
    double area = 0.0;
    for (size_t t = 0; t < card.indices.size(); t += 3) {
        const uint32_t a = card.indices[t], b = card.indices[t + 1], c = card.indices[t + 2];
        const double whole = 0.5 * glm::length(glm::cross(card.positions[b] - card.positions[a],
                                                          card.positions[c] - card.positions[a]));
        int filled = 0, all = 0;
        for (int i = 0; i < kSteps; i++)
            for (int j = 0; i + j < kSteps; j++) {
                const float u = (static_cast<float>(i) + 0.33F) / kSteps;
                const float v = (static_cast<float>(j) + 0.33F) / kSteps;
                const Vec2 uv =
                    card.uvs[a] + u * (card.uvs[b] - card.uvs[a]) + v * (card.uvs[c] - card.uvs[a]);
                const int x = std::clamp(static_cast<int>(uv.x * static_cast<float>(picture.width)), 0,
                                         picture.width - 1);
                const int y = std::clamp(static_cast<int>(uv.y * static_cast<float>(picture.height)), 0,
                                         picture.height - 1);
                filled += static_cast<float>(picture.at(x, y)[3]) >= 255.0F * kSolid;
                all++;
            }
        area += whole * filled / all;
    }
    return area;
}

// Square metres of ground that leaves hang over, by cells a fortieth as wide as the tree is high.
double projection_of(const std::vector<LeafPlacement>& leaves, double height) {
    const double cell = std::clamp(height / 40.0, 0.02, 0.5);
    std::set<std::pair<int64_t, int64_t>> covered;
    for (const LeafPlacement& leaf : leaves) {
        // A frond reaches over many cells, a spray over one.
        const int steps = 1 + static_cast<int>(leaf.size / cell);
        for (int i = 0; i < steps; i++) {
            const auto along = (static_cast<float>(i) + 0.5F) / static_cast<float>(steps);
            const Vec3 p = leaf.position + along * leaf.size * leaf.y;
            covered.emplace(std::llround(p.x / cell), std::llround(p.z / cell));
        }
    }
    return static_cast<double>(covered.size()) * cell * cell;
}

struct LeafFigures {
    double area = 0.0, over_projection = 0.0;
    size_t cards = 0;
};

LeafFigures measure_leaves(const TreeLevel& level, const std::string& look, const LeafRules& rules,
                           double height) {
    LeafFigures found;
    if (level.foliage.empty() || level.foliage.front().leaves.empty()) return found;
    const LevelLeaves& kind = level.foliage.front();
    const Image picture = uses_blade_picture(rules)
                              ? make_blade_textures(look, kPictureSize, kTextureSeed).albedo
                              : make_leaf_textures(look, kPictureSize, kTextureSeed).albedo;
    const double filled = filled_area(kind.card, picture);
    for (const LeafPlacement& leaf : kind.leaves)
        found.area += filled * leaf.size * leaf.size;
    found.cards = kind.leaves.size();
    found.over_projection = found.area / projection_of(kind.leaves, height);
    return found;
}

// --- twigs ------------------------------------------------------------------------------------------------

struct TwigFigures {
    double hugging = 0.0, sharp = 0.0;  // shares of tips, and of bends
    std::array<double, 3> tips{};       // metres: radii of the 10th, 50th and 90th of 100
};

TwigFigures measure_twigs(const Tree& tree) {
    std::vector<double> tips;
    std::vector<WoodSegment> stout;
    for (const NodeId id : tree.depth_first())
        if (tree.node(id).child_count == 0) tips.push_back(tree.node(id).radius);
    const double usual = quantile(tips, 0.5);
    for (const WoodSegment& segment : wood_segments(tree))
        if (segment.radius > kStout * usual) stout.push_back(segment);
    const CapsuleTree near(stout);
    size_t hugging = 0, bends = 0, sharp = 0;
    for (const NodeId id : tree.depth_first()) {
        const Node& node = tree.node(id);
        if (node.child_count == 0 && !near.empty() && node.radius < kStout * usual) {
            const CapsuleTree::Hit hit = near.nearest_axis(node.position);
            hugging += hit.distance < kHugs * near.segment(hit.segment).radius;
        }
        if (node.parent == kNoNode || node.first_child == kNoNode) continue;
        bends++;
        sharp += degrees_between(node.position - tree.node(node.parent).position,
                                 tree.node(node.first_child).position - node.position) > kSharp;
    }
    return {static_cast<double>(hugging) / static_cast<double>(std::max<size_t>(1, tips.size())),
            static_cast<double>(sharp) / static_cast<double>(std::max<size_t>(1, bends)),
            {quantile(tips, 0.1), usual, quantile(tips, 0.9)}};
}

// --- sections ---------------------------------------------------------------------------------------------

// How far a section is from a circle: from peak to peak of its distance from its middle, by direction, over
// the mean; less than 0 where points surround too little of it.
double spread_of(const std::vector<DVec2>& section) {
    constexpr size_t kSectors = 24;
    constexpr double kCovered = 0.7;
    const std::optional<CircleFit> ring = fit_ring(section);
    if (!ring) return -1.0;
    std::array<std::vector<double>, kSectors> sectors;
    for (const DVec2& p : section) {
        const DVec2 out = p - ring->centre;
        const double turn = std::atan2(out.y, out.x) / (2.0 * std::numbers::pi) + 0.5;
        sectors[static_cast<size_t>(turn * kSectors) % kSectors].push_back(glm::length(out));
    }
    std::vector<double> reach;
    for (std::vector<double>& sector : sectors)
        if (!sector.empty()) reach.push_back(quantile(sector, 0.5));
    if (static_cast<double>(reach.size()) < kCovered * kSectors) return -1.0;
    const auto [least, most] = std::minmax_element(reach.begin(), reach.end());
    return (*most - *least) * static_cast<double>(reach.size()) /
           std::accumulate(reach.begin(), reach.end(), 0.0);
}

// Where the trunk is at breast height, or half way up where it is lower.
struct Section {
    DVec3 middle{0.0};
    double radius = 0.0;
    DVec3 axis{0.0, 1.0, 0.0};  // unit
};

Section section_of(const Tree& tree, double height) {
    const double at = std::min(kBreastHeight, 0.5 * height);
    NodeId before = tree.root();
    for (NodeId id = tree.root(); id != kNoNode;) {
        if (tree.node(id).position.y >= at) {
            const Node &low = tree.node(before), &high = tree.node(id);
            const double rise = high.position.y - low.position.y;
            const double share = rise > 0.0 ? std::clamp((at - low.position.y) / rise, 0.0, 1.0) : 1.0;
            const DVec3 axis = high.position - low.position;
            return {glm::mix(low.position, high.position, share), glm::mix(low.radius, high.radius, share),
                    glm::length(axis) > 0.0 ? glm::normalize(axis) : DVec3(0.0, 1.0, 0.0)};
        }
        before = id;
        NodeId next = kNoNode;
        for (const NodeId child : tree.children(id))
            if (next == kNoNode || tree.node(child).is_trunk()) next = child;
        id = next;
    }
    return {tree.node(before).position, tree.node(before).radius};
}

// Those of the points that lie around the section, within its plane.
std::vector<DVec2> around(const Section& section, const MeshArray<Vec3>& points, double thick) {
    const DVec3 across = glm::normalize(glm::cross(section.axis, DVec3(0.36, 0.48, 0.8)));
    const DVec3 other = glm::cross(section.axis, across);
    std::vector<DVec2> found;
    for (const Vec3& p : points) {
        const DVec3 d = DVec3(p) - section.middle;
        const DVec2 out(glm::dot(d, across), glm::dot(d, other));
        const double distance = glm::length(out);
        if (std::abs(glm::dot(d, section.axis)) <= thick && distance <= 1.8 * section.radius &&
            distance >= 0.3 * section.radius)
            found.push_back(out);
    }
    return found;
}

// The trunk's bark, cut across.
MeshArray<Vec3> cut_bark(const Mesh& bark, const Section& section) {
    MeshArray<Vec3> cut;
    const auto above = [&](const Vec3& p) { return glm::dot(DVec3(p) - section.middle, section.axis); };
    for (size_t t = 0; t < bark.indices.size(); t += 3) {
        if (bark.custom0[bark.indices[t]].w > 0.0F) continue;  // a branch's
        for (size_t k = 0; k < 3; k++) {
            const Vec3& a = bark.positions[bark.indices[t + k]];
            const Vec3& b = bark.positions[bark.indices[t + (k + 1) % 3]];
            const double from = above(a), to = above(b);
            if ((from < 0.0) == (to < 0.0)) continue;
            cut.push_back(a + (b - a) * static_cast<float>(from / (from - to)));
        }
    }
    return cut;
}

// Texels in a metre of the trunk's picture: along it and around.
std::pair<double, double> texels_of(const Mesh& bark, const Section& section) {
    std::vector<double> along, round;
    for (size_t t = 0; t < bark.indices.size(); t += 3) {
        const uint32_t a = bark.indices[t], b = bark.indices[t + 1], c = bark.indices[t + 2];
        if (std::abs(bark.positions[a].y - section.middle.y) > 0.5 ||
            glm::distance(DVec3(bark.positions[a]), section.middle) > 0.5 + 2.0 * section.radius)
            continue;
        const DVec3 p = bark.positions[b] - bark.positions[a], q = bark.positions[c] - bark.positions[a];
        const DVec2 u = bark.uvs[b] - bark.uvs[a], v = bark.uvs[c] - bark.uvs[a];
        const double turn = u.x * v.y - u.y * v.x;
        if (std::abs(turn) < 1e-9) continue;
        round.push_back(bark_size(kTextureSize) / glm::length((p * v.y - q * u.y) / turn));
        along.push_back(bark_rows(bark_size(kTextureSize)) / kBarkLength /
                        glm::length((q * u.x - p * v.x) / turn));
    }
    if (along.empty()) return {0.0, 0.0};
    return {quantile(along, 0.5), quantile(round, 0.5)};
}

void look_at(const std::string& scan) {
    const Reconstruction made = reconstruct_file(scan, {});
    const std::string look = chosen_leaves("auto", made);
    const LeafRules rules = suited_leaves(look, made);
    const double height = made.tree.bounds().size().y;
    const LevelBuilder builder(made.tree, leaf_kinds(made.tree, rules), 1, made.foliage);
    std::array<size_t, 4> triangles{};
    LeafFigures leaves;
    Mesh bark;
    for (int level = 0; level < 4; level++) {
        TreeLevel built = builder.build(level);
        triangles[static_cast<size_t>(level)] = built.triangle_count();
        if (level > 0) continue;
        leaves = measure_leaves(built, look, rules, height);
        bark = std::move(built.bark);
    }
    const TwigFigures twigs = measure_twigs(made.tree);
    const Section section = section_of(made.tree, height);
    const double drawn = spread_of(around(section, cut_bark(bark, section), 0.001));
    const MeshArray<Vec3> points(made.cloud.positions.begin(), made.cloud.positions.end());
    const double scanned = spread_of(around(section, points, 0.05));
    const auto [along, round] = texels_of(bark, section);
    std::printf(
        "%-32s %6zu %5zu %5zu %5zu %6zu %7.1f %5.1f %6.1f %6.1f %5.1f %4.1f %4.1f %6.0f %6.0f %5.0f %5.0f\n",
        utf8_of(path_of(scan).stem()).substr(0, 32).c_str(), triangles[0], triangles[1], triangles[2],
        triangles[3], leaves.cards, leaves.area, leaves.over_projection, 100.0 * twigs.hugging,
        100.0 * twigs.sharp, 1000.0 * twigs.tips[0], 1000.0 * twigs.tips[1], 1000.0 * twigs.tips[2], along,
        round, 100.0 * scanned, 100.0 * drawn);
    std::fflush(stdout);
}

}  // namespace

void bench_looks(const std::vector<std::string>& scans) {
    std::printf("%-32s %24s %6s %7s %5s %6s %6s %15s %13s %11s\n", "", "triangles of level", "", "leaf m2",
                "/", "hug", ">60", "tips, mm", "texels/m", "section, %");
    std::printf("%-32s %6s %5s %5s %5s %6s %7s %5s %6s %6s %5s %4s %4s %6s %6s %5s %5s\n", "scan", "0", "1",
                "2", "3", "cards", "", "crown", "wood,%", "deg,%", "10", "50", "90", "along", "around",
                "scan", "tree");
    for (const std::string& scan : scans) {
        try {
            look_at(scan);
        } catch (const Error& error) {
            std::printf("%-32s %s\n", utf8_of(path_of(scan).filename()).c_str(), error.what());
        }
    }
}

}  // namespace treerec::bench
