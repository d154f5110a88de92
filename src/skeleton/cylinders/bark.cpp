#include "skeleton/cylinders/bark.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/parallel.h"
#include "geometry/segment.h"

namespace treerec {

namespace {

constexpr int kLookAround = 2;      // stations to each side
constexpr double kThick = 0.03;     // metres: from stouter wood,
constexpr double kWhisker = 0.6;    // so many times what it is stouter, besides
constexpr double kRounding = 1e-3;  // metres, more than that of places to floats
constexpr double kStub = 0.6;       // radii that a branch must reach out of thick wood

// The square of what is above 0, a little more for the rounding; below, what no square is.
float square_above(double metres) {
    return metres > 0.0 ? static_cast<float>(1.00001 * metres * metres) : -1.0f;
}

}  // namespace

BarkPlace place_near(const std::vector<Station>& line, int32_t station, const DVec3& p) {
    const int32_t last = static_cast<int32_t>(line.size()) - 1;
    const DVec3 off = line[station].position - p;
    double least = glm::dot(off, off);
    BarkPlace best{-1, station, std::sqrt(least), line[station].radius};
    for (int32_t i = std::max(0, station - kLookAround); i < std::min(last, station + kLookAround); i++) {
        double t;
        const double square = square_to_segment(p, line[i].position, line[i + 1].position, t);
        if (square >= least) continue;
        // Squares that differ may have the same root.
        const double distance = std::sqrt(square);
        if (distance >= best.distance) continue;
        least = square;
        best = {-1, t < 0.5 ? i : i + 1, distance,
                line[i].radius + t * (line[i + 1].radius - line[i].radius)};
    }
    return best;
}

// For PointTree::search(): the piece whose surface is nearest.
struct Bark::Nearest {
    const Bark& bark;
    const DVec3 p;
    const std::vector<uint8_t>* except;
    BarkPlace best;
    uint32_t index;
    float reach = 0.0f;  // of the node that is looked into

    // Pieces that reach so far come no nearer when their middles are farther than this.
    float most(float piece_reach) const { return square_above(best.outside() + piece_reach + kRounding); }

    float limit() const { return most(reach); }
    void add(float squared, uint32_t candidate) {
        if (squared <= most(bark.reach_[candidate])) look_at(candidate);
    }
    void look_at(uint32_t candidate) {
        const Piece& piece = bark.pieces_[candidate];
        if (except != nullptr && (*except)[piece.branch] != 0) return;
        double t;
        const double distance = std::sqrt(square_to_segment(p, piece.from, piece.to, t));
        const double radius = piece.from_radius + t * (piece.to_radius - piece.from_radius);
        const double outside = distance - radius;
        if (outside > best.outside()) return;
        if (outside == best.outside() && (best.branch < 0 || candidate > index)) return;
        best = {piece.branch, t < 0.5 ? piece.from_station : piece.to_station, distance, radius};
        index = candidate;
    }
};

Bark::Bark(const std::vector<SkeletonBranch>& branches, const std::vector<std::vector<Station>>& axes)
    : branches_(branches), axes_(axes) {
    for (size_t l = 0; l < axes.size(); l++) {
        const std::vector<Station>& line = axes[l];
        const int32_t branch = static_cast<int32_t>(l);
        const Station& first = line.front();
        const bool forks = branches[l].parent >= 0;
        if (forks || line.size() == 1) {
            const DVec3& from =
                forks ? axes[branches[l].parent][branches[l].attach].position : first.position;
            add({from, first.position, first.radius, first.radius, branch, 0, 0});
        }
        for (int32_t i = 1; i < static_cast<int32_t>(line.size()); i++)
            add({line[i - 1].position, line[i].position, line[i - 1].radius, line[i].radius, branch, i - 1,
                 i});
    }
    if (pieces_.empty()) return;
    std::vector<Vec3> middles;
    middles.reserve(pieces_.size());
    for (const Piece& piece : pieces_)
        middles.emplace_back(0.5 * (piece.from + piece.to));
    tree_ = std::make_unique<PointTree>(middles);
    node_reach_.assign(tree_->node_count(), 0.0f);
    for (size_t node = 0; node < node_reach_.size(); node++) {
        const bool group = node < tree_->group_count();
        for (const uint32_t i : group ? tree_->in_group(node) : tree_->in_block(node))
            node_reach_[node] = std::max(node_reach_[node], group ? reach_[i] : node_reach_[i]);
    }
}

void Bark::add(const Piece& piece) {
    const double reach =
        0.5 * glm::distance(piece.from, piece.to) + std::max(piece.from_radius, piece.to_radius);
    pieces_.push_back(piece);
    thickest_ = std::max({thickest_, piece.from_radius, piece.to_radius});
    reach_.push_back(static_cast<float>(reach));
}

BarkPlace Bark::on_branch(int32_t branch, int32_t station, const DVec3& p) const {
    const std::vector<Station>& line = axes_[branch];
    BarkPlace place = place_near(line, station, p);
    place.branch = branch;
    if (station > 0 || branches_[branch].parent < 0) return place;
    const DVec3& fork = axes_[branches_[branch].parent][branches_[branch].attach].position;
    const double distance = distance_to_segment(p, fork, line[0].position);
    if (distance < place.distance) place = {branch, 0, distance, line[0].radius};
    return place;
}

BarkPlace Bark::nearest(const Vec3& p, double within, uint32_t& hint,
                        const std::vector<uint8_t>* except) const {
    Nearest nearest{*this, DVec3(p), except, {}, hint};
    nearest.best.distance = within;
    if (!tree_) return nearest.best;
    nearest.look_at(hint);
    tree_->search(p, nearest, [&](uint32_t node) {
        nearest.reach = node_reach_[node];
        return true;
    });
    hint = nearest.index;
    return nearest.best;
}

std::vector<int32_t> Bark::branches_by_place() const {
    std::vector<int32_t> order;
    if (!tree_) return order;
    order.reserve(branches_.size());
    for (size_t group = 0; group < tree_->group_count(); group++)
        for (const uint32_t i : tree_->in_group(group)) {
            const Piece& piece = pieces_[i];
            if (static_cast<size_t>(piece.to_station) + 1 == axes_[piece.branch].size())
                order.push_back(piece.branch);
        }
    return order;
}

double required_escape(double least_escape, double radius) {
    if (radius <= kThick) return std::max(least_escape, kStub * radius);
    return std::max(least_escape, kStub * kThick) + kWhisker * (radius - kThick);
}

void remove_branches(std::vector<SkeletonBranch>& branches, std::vector<std::vector<Station>>& axes,
                     const std::vector<uint8_t>& goes) {
    std::vector<int32_t> now(branches.size());
    size_t kept = 0;
    for (size_t l = 0; l < branches.size(); l++) {
        if (goes[l] != 0) continue;
        now[l] = static_cast<int32_t>(kept);
        if (branches[l].parent >= 0) branches[l].parent = now[branches[l].parent];
        if (kept != l) {
            branches[kept] = std::move(branches[l]);
            axes[kept] = std::move(axes[l]);
        }
        kept++;
    }
    branches.resize(kept);
    axes.resize(kept);
}

void drop_strips(std::vector<SkeletonBranch>& branches, std::vector<std::vector<Station>>& axes,
                 double least_escape) {
    const Bark bark(branches, axes);
    std::vector<uint32_t> bears(branches.size(), 0);
    for (const SkeletonBranch& branch : branches)
        if (branch.parent >= 0) bears[branch.parent]++;
    // All bark farther away is escaped.
    const double far = required_escape(least_escape, bark.thickest());
    // A place that no branch but `except` explains.
    const auto escapes = [&](const std::vector<Station>& line, const std::vector<uint8_t>& except) {
        uint32_t hint = 0;
        return std::any_of(line.rbegin(), line.rend(), [&](const Station& station) {
            const BarkPlace place = bark.nearest(Vec3(station.position), far, hint, &except);
            return place.branch < 0 || place.outside() >= required_escape(least_escape, place.radius);
        });
    };
    // What is clear of all others stays. Of the rest, the last branches go first, and then hold nothing any
    // more.
    std::vector<uint8_t> doubtful(branches.size(), 0);
    // Branches side by side are compared with much the same ones, which memory then still has at hand.
    const std::vector<int32_t> order = bark.branches_by_place();
    parallel_for(order.size(), 64, [&](size_t begin, size_t end) {
        std::vector<uint8_t> except(branches.size(), 0);
        for (size_t i = begin; i < end; i++) {
            const int32_t l = order[i];
            if (l == 0) continue;
            except[l] = 1;
            doubtful[l] = escapes(axes[l], except) ? 0 : 1;
            except[l] = 0;
        }
    });
    std::vector<uint8_t> goes(branches.size(), 0);
    for (size_t l = branches.size(); l-- > 1;) {
        if (bears[l] > 0 || doubtful[l] == 0) continue;
        goes[l] = 1;  // nor is it looked at itself
        if (escapes(axes[l], goes)) {
            goes[l] = 0;
            continue;
        }
        bears[branches[l].parent]--;
    }
    remove_branches(branches, axes, goes);
}

}  // namespace treerec
