#include "mesh/tree_picture.h"

#include <algorithm>
#include <cmath>

#include "error.h"
#include "geometry/bounds.h"
#include "mesh/sample_canvas.h"

namespace treerec {

namespace {

constexpr double kFilled = 0.96;             // of the picture's side
constexpr double kLeastWood = 0.55;          // samples: twigs stay visible
constexpr double kStoutShare = 0.4;          // of the thickest radius: wood of the stem's colour
constexpr double kBase = 0.26, kTip = 0.12;  // of a leaf's length: half its width at its two ends
constexpr double kLeastLeaf = 1.0;           // samples
constexpr double kFrond = 0.8;  // metres: leaves as long as that are fronds: narrow, and seen to hang
constexpr double kFrondWidth = 0.3;
constexpr double kHang = 0.2;  // of its length: how far a leaf's tip sinks
const DVec3 kLight(-0.45, 0.75, 0.48);

// A place on a leaf, from its base to its tip.
DVec3 along(const LeafPlacement& leaf, double t) {
    const double size = leaf.size;
    return DVec3(leaf.position) + size * (0.1 + 0.85 * t) * DVec3(leaf.y) -
           DVec3(0.0, kHang * size * t * t, 0.0);
}

}  // namespace

TreeColors tree_colors(const std::string& preset) {
    struct Named {
        const char* name;
        TreeColors colors;
    };
    static const Named kNamed[] = {
        {"oak", {{104, 92, 78}, {132, 112, 88}, {92, 126, 46}, {142, 150, 56}}},
        {"maple", {{116, 104, 90}, {142, 122, 98}, {90, 136, 48}, {156, 166, 60}}},
        {"cherry", {{104, 70, 56}, {136, 96, 74}, {104, 142, 60}, {158, 160, 68}}},
        {"birch", {{206, 202, 194}, {128, 98, 80}, {134, 164, 64}, {182, 184, 74}}},
        {"willow", {{116, 102, 82}, {150, 136, 84}, {136, 160, 82}, {178, 186, 92}}},
        {"apple", {{112, 100, 90}, {136, 112, 92}, {98, 140, 62}, {152, 160, 72}}},
        {"pine", {{136, 92, 66}, {138, 104, 78}, {64, 106, 60}, {104, 134, 68}}},
        {"spruce", {{112, 84, 68}, {126, 98, 78}, {54, 94, 64}, {88, 120, 70}}},
        {"ginkgo", {{118, 106, 92}, {150, 134, 110}, {128, 156, 58}, {176, 182, 74}}},
        {"poplar", {{146, 146, 126}, {152, 140, 104}, {104, 142, 60}, {160, 172, 84}}},
        {"magnolia", {{126, 122, 114}, {122, 102, 74}, {48, 84, 44}, {88, 112, 60}}},
        {"palm", {{132, 114, 90}, {138, 124, 84}, {98, 142, 60}, {156, 166, 72}}},
    };
    for (const Named& one : kNamed)
        if (preset == one.name) return one.colors;
    return {};
}

Image draw_tree(const Tree& tree, const std::vector<LeafPlacement>& leaves, const TreeColors& colors,
                int size) {
    return draw_leafy_tree(tree, {{leaves, colors.leaf, colors.other}}, colors, size);
}

Image draw_leafy_tree(const Tree& tree, const std::vector<PicturedLeaves>& kinds, const TreeColors& colors,
                      int size) {
    if (size < 16 || size > 1024) throw Error("A tree's picture must be 16 to 1024 pixels wide.");
    SampleCanvas canvas(size);
    if (tree.empty()) return canvas.finish();
    Bounds seen;
    double thickest = 0.0;
    for (NodeId id = 0; id < tree.id_end(); id++) {
        if (!tree.contains(id)) continue;
        const Node& node = tree.node(id);
        seen.add(node.position, node.radius);
        thickest = std::max(thickest, node.radius);
    }
    for (const PicturedLeaves& kind : kinds)
        for (const LeafPlacement& leaf : kind.leaves)
            seen.add(along(leaf, 1.0), kTip * leaf.size);
    const DVec3 extent = seen.size();
    const double side = canvas.side();
    const double scale = kFilled * side / std::max({extent.x, extent.y, 1e-9});
    const auto place = [&](const DVec3& p) {
        const DVec3 off = (p - seen.centre()) * scale;
        return DVec3(0.5 * side + off.x, 0.5 * side - off.y, off.z);
    };
    for (NodeId id = 0; id < tree.id_end(); id++) {
        if (!tree.contains(id) || tree.node(id).parent == kNoNode) continue;
        const Node& node = tree.node(id);
        const Node& below = tree.node(node.parent);
        const double first = std::min(below.radius, 1.3 * node.radius);
        const double share = std::clamp(node.radius / (kStoutShare * thickest), 0.0, 1.0);
        canvas.draw_wood({place(below.position), std::max(first * scale, kLeastWood)},
                         {place(node.position), std::max(node.radius * scale, kLeastWood)},
                         glm::mix(colors.thin, colors.stout, std::sqrt(share)));
    }
    const DVec3 light = glm::normalize(kLight);
    // What lies behind what is drawn already costs next to nothing.
    struct Seen {
        const LeafPlacement* leaf;
        const PicturedLeaves* kind;
    };
    std::vector<Seen> from_the_eye;
    for (const PicturedLeaves& kind : kinds)
        for (const LeafPlacement& leaf : kind.leaves)
            from_the_eye.push_back({&leaf, &kind});
    std::stable_sort(from_the_eye.begin(), from_the_eye.end(),
                     [](const Seen& a, const Seen& b) { return a.leaf->position.z > b.leaf->position.z; });
    for (const Seen& one : from_the_eye) {
        const LeafPlacement& leaf = *one.leaf;
        const double lit = 0.5 + 0.5 * glm::dot(DVec3(leaf.outward), light);
        const double open = 0.55 + 0.45 * leaf.occlusion;
        const DVec3 color =
            glm::mix(one.kind->leaf, one.kind->other, 0.8 * leaf.hue) * open * (0.66 + 0.62 * lit);
        const bool frond = leaf.size > kFrond;
        const double width = frond ? kFrondWidth : 1.0;
        const int pieces = frond ? 4 : 1;
        const auto ball_at = [&](int i) {
            const double t = static_cast<double>(i) / pieces;
            const double radius = width * leaf.size * scale * (kBase + (kTip - kBase) * t);
            return SampleCanvas::Ball{place(along(leaf, t)), std::max(radius, kLeastLeaf)};
        };
        for (int i = 0; i < pieces; i++)
            canvas.draw_wood(ball_at(i), ball_at(i + 1), color);
    }
    return canvas.finish();
}

}  // namespace treerec
