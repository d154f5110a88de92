#include "edit/pick.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace treerec {

namespace {

constexpr double kTie = 2.0;  // pixels
constexpr double kLeastW = 1e-9;

DVec3 to_screen(const ScreenView& view, const glm::dvec4& clip) {
    return {(0.5 + 0.5 * clip.x / clip.w) * view.width, (0.5 - 0.5 * clip.y / clip.w) * view.height,
            clip.z / clip.w};
}

bool is_sound(const ScreenView& view) {
    for (int column = 0; column < 4; column++)
        for (int row = 0; row < 4; row++)
            if (!std::isfinite(view.to_clip[column][row])) return false;
    return std::isfinite(view.width) && std::isfinite(view.height);
}

// Cuts a-b down to what lies between the near and the far plane; false where nothing does.
bool clip_depth(glm::dvec4& a, glm::dvec4& b) {
    // Each is positive on the side that is seen.
    const auto cut = [&](double at_a, double at_b) {
        if (!(at_a > 0.0) && !(at_b > 0.0)) return false;
        if (!(at_a > 0.0)) a += (b - a) * (at_a / (at_a - at_b));
        if (!(at_b > 0.0)) b += (a - b) * (at_b / (at_b - at_a));
        return true;
    };
    return cut(a.w - kLeastW, b.w - kLeastW) && cut(a.z + a.w, b.z + b.w) && cut(a.w - a.z, b.w - b.z) &&
           a.w > 0.0 && b.w > 0.0;
}

// Keeps the nearest of what it is offered, by the rule of pick_node().
class Nearest {
  public:
    explicit Nearest(double distance) : limit_(distance) {}
    bool may_win(double distance) const { return distance <= limit_ && distance <= least_ + kTie; }
    void offer(NodeId id, double distance, double depth) {
        if (!may_win(distance)) return;
        offers_.push_back({id, distance, depth});
        least_ = std::min(least_, distance);
    }
    NodeId winner() const {
        const Offer* best = nullptr;
        for (const Offer& one : offers_) {
            if (one.distance > least_ + kTie) continue;
            if (!best || one.depth < best->depth ||
                (one.depth == best->depth && one.distance < best->distance))
                best = &one;
        }
        return best ? best->id : kNoNode;
    }

  private:
    struct Offer {
        NodeId id;
        double distance, depth;
    };
    double limit_;
    double least_ = std::numeric_limits<double>::infinity();
    std::vector<Offer> offers_;
};

}  // namespace

bool project(const ScreenView& view, const DVec3& place, DVec3& seen) {
    const glm::dvec4 clip = view.to_clip * glm::dvec4(place, 1.0);
    if (!(clip.w > kLeastW && clip.z >= -clip.w && clip.z <= clip.w)) return false;
    seen = to_screen(view, clip);
    return is_finite(seen);
}

NodeId pick_node(const Tree& tree, const ScreenView& view, const DVec2& position, double distance) {
    if (!std::isfinite(position.x) || !std::isfinite(position.y) || !is_sound(view)) return kNoNode;
    std::vector<glm::dvec4> clip(static_cast<size_t>(tree.id_end()));
    Nearest nodes(distance);
    for (NodeId id = 0; id < tree.id_end(); id++) {
        if (!tree.contains(id)) continue;
        const glm::dvec4 at = view.to_clip * glm::dvec4(tree.node(id).position, 1.0);
        clip[id] = at;
        if (!(at.w > kLeastW && at.z >= -at.w && at.z <= at.w)) continue;
        const DVec3 seen = to_screen(view, at);
        nodes.offer(id, glm::distance(DVec2(seen), position), seen.z);
    }
    if (nodes.winner() != kNoNode) return nodes.winner();
    // A metre across the view, at w = 1, in pixels.
    const double metre =
        0.5 * view.height * glm::length(DVec3(view.to_clip[0][1], view.to_clip[1][1], view.to_clip[2][1]));
    Nearest wood(distance);
    for (NodeId id = 0; id < tree.id_end(); id++) {
        if (!tree.contains(id) || tree.node(id).parent == kNoNode) continue;
        glm::dvec4 a = clip[tree.node(id).parent], b = clip[id];
        if (!clip_depth(a, b)) continue;
        const DVec3 from = to_screen(view, a), to = to_screen(view, b);
        const DVec2 way = DVec2(to) - DVec2(from);
        const double square = glm::dot(way, way);
        const double t =
            square > 0.0 ? std::clamp(glm::dot(position - DVec2(from), way) / square, 0.0, 1.0) : 0.0;
        const double across = glm::distance(position, DVec2(from) + t * way);
        // How far along the wood that is: the view foreshortens it.
        const double w = 1.0 / ((1.0 - t) / a.w + t / b.w);
        const double radius = tree.node(id).radius * metre / w;
        // In this order, so that what is no number stays none.
        wood.offer(id, std::max(across - radius, 0.0), from.z + t * (to.z - from.z));
    }
    return wood.winner();
}

std::vector<NodeId> pick_nodes(const Tree& tree, const ScreenView& view, const DVec2& one_corner,
                               const DVec2& other_corner) {
    const DVec2 least = glm::min(one_corner, other_corner), most = glm::max(one_corner, other_corner);
    std::vector<NodeId> ids;
    if (!is_sound(view)) return ids;
    DVec3 seen;
    for (NodeId id = 0; id < tree.id_end(); id++) {
        if (!tree.contains(id) || !project(view, tree.node(id).position, seen)) continue;
        if (seen.x >= least.x && seen.x <= most.x && seen.y >= least.y && seen.y <= most.y) ids.push_back(id);
    }
    return ids;
}

}  // namespace treerec
