// The one card that a MultiMesh repeats: what a leaf rule's leaf looks like.
#include <algorithm>
#include <cmath>

#include "error.h"
#include "geometry/portable_math.h"
#include "mesh/leaf_cards.h"

namespace treerec {

namespace {

constexpr float kStrongCurl = 40.0f;      // degrees: beyond it a card has several pieces
constexpr float kLeastFold = 10.0f;       // degrees: a smaller one shows from near alone
constexpr float kStalkShare = 0.022f;     // a petiole's width over the leaf's length
constexpr float kLeafletReach = 2.2f;     // over the number of leaflets: their length over the whole leaf's
constexpr float kPalmateHalf = 115.0f;    // degrees from the middle leaflet to the outermost
constexpr float kRounded = 0.45f;         // of a flat card's normals, from one edge to the other
constexpr float kNeedleSplay = 14.0f;     // degrees
constexpr double kSprigLeafShare = 0.34;  // of the sprig's length

// Where a piece of the card lies: x across, y along, z out of the upper face; unit.
struct Frame {
    Vec3 origin{0.0f};
    Vec3 x{1.0f, 0.0f, 0.0f}, y{0.0f, 1.0f, 0.0f}, z{0.0f, 0.0f, 1.0f};

    Vec3 at(float across, float along, float up) const { return origin + x * across + y * along + z * up; }
    // Turned about its own z, to the right for positive degrees.
    Frame turned(float degrees) const {
        const float c = portable::cos(glm::radians(degrees)), s = portable::sin(glm::radians(degrees));
        return {origin, x * c - y * s, y * c + x * s, z};
    }
    // Turned about its own y, so that x sinks for positive degrees.
    Frame rolled(float degrees) const {
        const float c = portable::cos(glm::radians(degrees)), s = portable::sin(glm::radians(degrees));
        return {origin, x * c - z * s, y, z * c + x * s};
    }
};

bool shows_fold(double fold, int level) {
    return level <= 0 ? fold != 0.0 : std::abs(fold) >= kLeastFold;
}

class CardBuilder {
  public:
    // A strip along frame.y that bends down by `curl` degrees on its way, and whose halves are turned down by
    // `fold` degrees about its middle. u0, u1, v0 (at the base), v1: its part of the picture.
    void strip(const Frame& frame, float length, float width, int pieces, float curl, float fold,
               const float (&u)[2], const float (&v)[2]) {
        const auto first = static_cast<uint32_t>(mesh_.positions.size());
        const float bend = glm::radians(curl), turn = glm::radians(fold);
        const int columns = fold != 0.0f ? 3 : 2;
        const float spread = fold != 0.0f ? portable::cos(turn) : 1.0f;
        const float sunk = fold != 0.0f ? portable::sin(turn) : 0.0f;
        for (int i = 0; i <= pieces; i++) {
            const float t = static_cast<float>(i) / static_cast<float>(pieces);
            const bool straight = std::abs(bend) < 1e-3f;
            const float along = straight ? t : portable::sin(bend * t) / bend;
            const float down = straight ? 0.0f : (1.0f - portable::cos(bend * t)) / bend;
            const Vec3 out = frame.z * portable::cos(bend * t) + frame.y * portable::sin(bend * t);
            for (int k = 0; k < columns; k++) {
                const float across = static_cast<float>(k) / static_cast<float>(columns - 1) - 0.5f;
                // Each edge faces as its half does, and the midrib between them: its ridge is round.
                const Vec3 normal = columns == 2 ? out + frame.x * (kRounded * across)
                                                 : out * spread + frame.x * (2.0f * sunk * across);
                add(frame.at(width * spread * across, length * along, -length * down) -
                        out * (width * sunk * std::abs(across)),
                    normal, frame.x, {u[0] + (u[1] - u[0]) * (across + 0.5f), v[0] + (v[1] - v[0]) * t});
            }
        }
        const auto row = static_cast<uint32_t>(columns);
        for (uint32_t i = 0; i < static_cast<uint32_t>(pieces); i++)
            for (uint32_t k = 0; k + 1 < row; k++) {
                const uint32_t a = first + i * row + k, c = a + row;
                for (const uint32_t index : {a, a + 1, c + 1, a, c + 1, c})
                    mesh_.indices.push_back(index);
            }
    }

    void add(const Vec3& position, const Vec3& normal, const Vec3& across, const Vec2& uv) {
        const Vec3 unit = glm::normalize(normal);
        mesh_.positions.push_back(position);
        mesh_.normals.push_back(unit);
        mesh_.tangents.push_back(Vec4(glm::normalize(across - unit * glm::dot(across, unit)), 1.0f));
        mesh_.uvs.push_back(uv);
    }

    // One blade with the stalk's part of its own picture below it; its halves stand up, as a channel.
    void blade(const Frame& frame, float length, float width, int level, float curl, double fold) {
        const bool folded = shows_fold(fold, level) && (width > 0.1f * length || shows_fold(fold, 1));
        strip(frame, length, width, level <= 0 ? 2 : 1, curl, folded ? static_cast<float>(-fold) : 0.0f,
              {0.0f, 1.0f}, {1.0f - kBladeStalk, 0.0f});
    }

    // Wood or a stalk, `width` metres thick.
    void stalk(const Frame& frame, float length, float width) {
        if (length <= 0.0f) return;
        strip(frame, length, width, 1, 0.0f, 0.0f,
              {0.5f - 0.5f * kBladeStalkWidth, 0.5f + 0.5f * kBladeStalkWidth}, {1.0f, 1.0f - kBladeStalk});
    }

    Mesh take() {
        // The wind channel runs from the base to what is farthest from it.
        float reach = 1e-6f;
        for (const Vec3& position : mesh_.positions)
            reach = std::max(reach, glm::length(position));
        for (const Vec3& position : mesh_.positions)
            mesh_.colors.push_back(Vec4(0.0f, glm::length(position) / reach, 0.0f, 1.0f));
        return std::move(mesh_);
    }

    Mesh& mesh() { return mesh_; }

  private:
    Mesh mesh_;
};

// A card that is hardly curled and hardly folded: both at once from its middle, or flat from afar.
Mesh bowed_spray(const LeafRules& rules, int level) {
    CardBuilder card;
    const bool fine = level <= 0;
    const auto corner = [&](float x, float y, float z) {
        const Vec3 normal = fine ? Vec3(0.45f * x, 0.35f * (y - 0.4f), 1.0f) : Vec3(0.0f, 0.0f, 1.0f);
        card.add({x, y, z}, normal, {1.0f, 0.0f, 0.0f}, {x + 0.5f, 1.0f - y});
    };
    corner(-0.5f, 0.0f, 0.0f);
    corner(0.5f, 0.0f, 0.0f);
    corner(0.5f, 1.0f, fine ? -0.16f : 0.0f);
    corner(-0.5f, 1.0f, fine ? -0.16f : 0.0f);
    if (fine) corner(0.0f, 0.5f, 0.07f - 0.15f * static_cast<float>(1.0 - rules.fold / kUsualFold));
    card.mesh().indices = fine ? MeshArray<uint32_t>{0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4}
                               : MeshArray<uint32_t>{0, 1, 2, 0, 2, 3};
    Mesh mesh = card.take();
    for (size_t i = 0; i < mesh.positions.size(); i++)
        mesh.colors[i].g = mesh.positions[i].y;
    return mesh;
}

Mesh spray(const LeafRules& rules, int level) {
    const bool curled = std::abs(rules.curl) > kStrongCurl;
    if (!curled && !shows_fold(rules.fold, 1)) return bowed_spray(rules, level);
    CardBuilder card;
    const int pieces = curled ? (level <= 0 ? 5 : 2) : (level <= 0 ? 2 : 1);
    card.strip(Frame(), 1.0f, 1.0f, pieces, static_cast<float>(rules.curl),
               shows_fold(rules.fold, level) ? static_cast<float>(rules.fold) : 0.0f, {0.0f, 1.0f},
               {1.0f, 0.0f});
    return card.take();
}

// Lengths from here on are shares of leaf_size.
Mesh single_leaf(const LeafRules& rules, int level, float petiole) {
    CardBuilder card;
    card.stalk(Frame(), petiole, kStalkShare);
    Frame base;
    base.origin.y = petiole;
    card.blade(base, 1.0f, static_cast<float>(rules.blade_width), level, static_cast<float>(rules.curl),
               rules.fold);
    return card.take();
}

// Of a compound leaf the fold turns the leaflets about the stalk; they themselves have little of it.
double leaflets_fold(const LeafRules& rules) {
    return std::clamp(rules.fold, -kUsualFold, kUsualFold);
}

// Coarser levels have fewer, larger leaflets.
int leaflets_at(const LeafRules& rules, int level) {
    return std::max(std::min(rules.leaflets, 3), rules.leaflets >> std::max(level, 0));
}

Mesh pinnate_leaf(const LeafRules& rules, int level, float petiole) {
    CardBuilder card;
    const int count = leaflets_at(rules, level);
    const int pairs = count / 2;
    const float length = std::clamp(kLeafletReach / static_cast<float>(count), 0.12f, 0.5f);
    const float top = 1.0f - (count % 2 ? length : 0.6f * length);  // the rachis
    card.stalk(Frame(), petiole + top, kStalkShare);
    const auto width = static_cast<float>(rules.blade_width) * length;
    const auto curl = static_cast<float>(rules.curl), fold = static_cast<float>(rules.fold);
    for (int i = 0; i < pairs; i++) {
        const float place = pairs > 1 ? static_cast<float>(i) / static_cast<float>(pairs - 1) : 1.0f;
        Frame base;
        base.origin.y = petiole + 0.12f + (top - 0.12f) * (count % 2 ? 0.86f : 1.0f) * place;
        // Longest in the middle, and closing in on the tip.
        const float size = length * (0.78f + 0.22f * portable::sin(3.1f * (0.15f + 0.7f * place)));
        for (const float side : {-1.0f, 1.0f})
            card.blade(base.rolled(side * fold).turned(side * (72.0f - 22.0f * place)), size,
                       width * size / length, level, curl, leaflets_fold(rules));
    }
    if (count % 2) {
        Frame base;
        base.origin.y = petiole + top;
        card.blade(base, length, width, level, curl, leaflets_fold(rules));
    }
    return card.take();
}

Mesh palmate_leaf(const LeafRules& rules, int level, float petiole) {
    CardBuilder card;
    const int count = leaflets_at(rules, level);
    card.stalk(Frame(), petiole, kStalkShare);
    Frame base;
    base.origin.y = petiole;
    for (int i = 0; i < count; i++) {
        const float place =
            count > 1 ? 2.0f * static_cast<float>(i) / static_cast<float>(count - 1) - 1.0f : 0.0f;
        const float spread =
            count > 1 ? kPalmateHalf * std::min(1.0f, 0.35f + 0.11f * static_cast<float>(count)) : 0.0f;
        const float size = 1.0f - 0.42f * place * place;
        const float side = place < 0.0f ? -1.0f : place > 0.0f ? 1.0f : 0.0f;
        card.blade(base.rolled(side * static_cast<float>(rules.fold)).turned(spread * place), size,
                   size * static_cast<float>(rules.blade_width), level, static_cast<float>(rules.curl),
                   leaflets_fold(rules));
    }
    return card.take();
}

Mesh needle_bundle(const LeafRules& rules, int level, float petiole) {
    CardBuilder card;
    const int count = leaflets_at(rules, level);
    card.stalk(Frame(), petiole, kStalkShare);
    for (int i = 0; i < count; i++) {
        // Around the bundle's axis, each leaning out of it.
        const double around = 2.0 * kPi * i / count;
        const float lean = count > 1 ? glm::radians(kNeedleSplay) : 0.0f;
        Frame base;
        base.origin.y = petiole;
        const Vec3 out(static_cast<float>(portable::cos(around)), 0.0f,
                       static_cast<float>(portable::sin(around)));
        base.y = Vec3(0.0f, portable::cos(lean), 0.0f) + out * portable::sin(lean);
        base.x =
            glm::normalize(glm::cross(base.y, std::abs(out.z) > 0.5f ? Vec3(0, 0, 1) : Vec3(0.3f, 0, 1)));
        base.z = glm::cross(base.x, base.y);
        card.blade(base, 1.0f, static_cast<float>(rules.blade_width), 1, static_cast<float>(rules.curl), 0.0);
    }
    return card.take();
}

Mesh sprig_card(const LeafRules& rules, int level) {
    const LeafSprig& sprig = *rules.sprig;
    const Tree& wood = sprig.wood;
    const DVec3 root = wood.node(wood.root()).position;
    std::vector<LeafSprig::Leaf> leaves = sprig.leaves;
    double reach = 0.0;
    for (const NodeId id : wood.depth_first()) {
        const Node& node = wood.node(id);
        reach = std::max(reach, glm::distance(node.position, root));
        if (!sprig.leaves.empty() || node.child_count > 0 || node.parent == kNoNode) continue;
        const DVec3 along = node.position - wood.node(node.parent).position;
        leaves.push_back({node.position, normalized_or(along, {0.0, 1.0, 0.0}), {0.0, 0.0, 1.0}, 0.0});
    }
    if (wood.size() - 1 + leaves.size() > kMostSprigParts)
        throw Error("A leaf rule's sprig has " + std::to_string(wood.size() - 1) + " pieces of wood and " +
                    std::to_string(leaves.size()) + " leaves; the most for one card are " +
                    std::to_string(kMostSprigParts) + ".");
    const double scale = reach > 0.0 ? 1.0 / reach : 1.0;
    const auto frame_of = [&](const DVec3& origin, const DVec3& heading, const DVec3& up) {
        Frame frame;
        frame.origin = Vec3((origin - root) * scale);
        const DVec3 y = normalized_or(heading, {0.0, 1.0, 0.0});
        const DVec3 z = normalized_or(up - y * glm::dot(up, y), any_perpendicular(y));
        frame.y = Vec3(y);
        frame.z = Vec3(z);
        frame.x = Vec3(glm::cross(y, z));
        return frame;
    };
    CardBuilder card;
    // From afar the leaves alone are seen.
    if (level <= 1)
        for (const NodeId id : wood.depth_first()) {
            const Node& node = wood.node(id);
            if (node.parent == kNoNode) continue;
            const DVec3 from = wood.node(node.parent).position;
            card.stalk(frame_of(from, node.position - from, {0.0, 0.0, 1.0}),
                       static_cast<float>(scale * glm::distance(node.position, from)),
                       static_cast<float>(std::max(2.0 * scale * node.radius, 0.004)));
        }
    const size_t step = size_t{1} << std::clamp(level, 0, 3);
    for (size_t i = 0; i < leaves.size(); i += step) {
        const double size = leaves[i].size > 0.0 ? scale * leaves[i].size : kSprigLeafShare;
        const auto length = static_cast<float>(size * std::sqrt(static_cast<double>(step)));
        card.blade(frame_of(leaves[i].position, leaves[i].heading, leaves[i].up), length,
                   length * static_cast<float>(rules.blade_width), level, static_cast<float>(rules.curl),
                   rules.fold);
    }
    return card.take();
}

}  // namespace

bool uses_blade_picture(const LeafRules& rules) {
    return rules.form != LeafForm::kSpray;
}

Mesh build_leaf_card(const LeafRules& rules, int level) {
    check_leaf_rules(rules);
    const auto petiole = static_cast<float>(rules.petiole / rules.leaf_size);
    switch (rules.form) {
        case LeafForm::kSpray:
            return spray(rules, level);
        case LeafForm::kPinnate:
            return pinnate_leaf(rules, level, petiole);
        case LeafForm::kPalmate:
            return palmate_leaf(rules, level, petiole);
        case LeafForm::kNeedles:
            return needle_bundle(rules, level, petiole);
        case LeafForm::kSprig:
            if (rules.sprig) return sprig_card(rules, level);
            break;
        case LeafForm::kSimple:
            break;
    }
    return single_leaf(rules, level, petiole);
}

Mesh build_leaf_card(int level) {
    return build_leaf_card(LeafRules(), level);
}

}  // namespace treerec
