#include "sketch/close_gaps.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "geometry/portable_math.h"
#include "geometry/random.h"
#include "geometry/segment.h"
#include "sketch/crown_leaves.h"
#include "tree/branches.h"

namespace treerec {

namespace {

// A leaf covers about so much of its length around the node that it stands on.
constexpr double kLeafCover = 0.55;
// The view's cells, of a leaf's length.
constexpr double kCell = 0.5;
constexpr size_t kMostCells = 300;  // along a side
// Twigs for gaps that one place of a branch bears at most, and how long a place is, in shortest twigs: more
// would stand like a broom.
constexpr int kMostAtAPlace = 3;
constexpr double kPlace = 0.3;
// Of the host, at the crown's base, as foliage/snags.cpp has it.
constexpr double kLowSnagRadii = 12.0, kLowShare = 0.1;

enum class View { kFront, kSide };

// One view of the crown, in cells.
class Cover {
  public:
    Cover(const CrownSections& crown, View view, double cell, double leaf, double margin)
        : view_(view), cell_(cell) {
        left_ = view == View::kFront ? crown.left() : -crown.reach();
        const double right = view == View::kFront ? crown.right() : crown.reach();
        bottom_ = crown.bottom();
        columns_ = static_cast<size_t>(std::ceil((right - left_) / cell));
        rows_ = static_cast<size_t>(std::ceil((crown.top() - bottom_) / cell));
        open_.assign(columns_ * rows_, false);
        for (size_t i = 0; i < open_.size(); i++) {
            const DVec2 at = middle(i);
            if (view == View::kFront) {
                open_[i] = crown.contains(DVec3(at.x, at.y, 0.0), margin);
            } else {
                for (const CrownSections::Section& section : crown.at(at.y))
                    if (std::abs(at.x) + margin <= 0.5 * (section.right - section.left)) open_[i] = true;
            }
        }
        reach_ = leaf;
    }

    size_t size() const { return open_.size(); }
    bool open(size_t i) const { return open_[i]; }
    // (x or z, y) of a cell's middle.
    DVec2 middle(size_t i) const {
        return {left_ + (static_cast<double>(i % columns_) + 0.5) * cell_,
                bottom_ + (static_cast<double>(i / columns_) + 0.5) * cell_};
    }
    DVec2 seen(const DVec3& p) const { return {view_ == View::kFront ? p.x : p.z, p.y}; }

    void mark(const DVec3& p) {
        const DVec2 at = seen(p);
        const auto from = [&](double value, double low) {
            return static_cast<int64_t>(std::floor((value - low) / cell_));
        };
        for (int64_t row = std::max<int64_t>(from(at.y - reach_, bottom_), 0);
             row <= std::min<int64_t>(from(at.y + reach_, bottom_), static_cast<int64_t>(rows_) - 1); row++)
            for (int64_t column = std::max<int64_t>(from(at.x - reach_, left_), 0);
                 column <= std::min<int64_t>(from(at.x + reach_, left_), static_cast<int64_t>(columns_) - 1);
                 column++) {
                const size_t i = static_cast<size_t>(row) * columns_ + static_cast<size_t>(column);
                const DVec2 off = middle(i) - at;
                if (glm::dot(off, off) <= reach_ * reach_) open_[i] = false;
            }
    }

  private:
    View view_;
    double cell_, left_, bottom_, reach_ = 0.0;
    size_t columns_ = 0, rows_ = 0;
    std::vector<bool> open_;
};

}  // namespace

void close_gaps(Filling& filling, const CrownSections& crown, const SketchSpecies& species,
                const LeafRules& rules, double height, double most_wood, uint64_t seed,
                const Progress* progress) {
    const double growth = twig_growth(species, height);
    const double leaf = leaf_length(rules, height);
    const double margin = leaf_margin(crown, rules, height);
    const double side = std::max(crown.top() - crown.bottom(), 2.0 * crown.reach());
    const double cell = std::max(kCell * leaf, side / kMostCells);
    std::vector<std::vector<double>> to_tip;
    for (const SpeciesTwig& twig : species.twigs)
        to_tip.push_back(longest_paths(twig.scion));
    const double bearing = rules.twig_length * shrunk(height) / growth;

    const auto joint_of = [&](const TwigPlace& place) {
        return place_along(filling.axes[place.axis].axis.points, place.along);
    };
    const auto mark = [&](Cover& cover, const TwigPlace& place) {
        const std::vector<std::optional<DVec3>> kept =
            kept_places(species.twigs[place.twig].scion, place, joint_of(place), crown, margin);
        for (size_t id = 0; id < kept.size(); id++)
            if (kept[id] && to_tip[place.twig][id] <= bearing) cover.mark(*kept[id]);
    };
    const auto wood_of = [&](const TwigPlace& place) {
        return kept_wood(species.twigs[place.twig].scion, place, joint_of(place), crown, margin);
    };
    double all = 0.0;
    for (const TwigPlace& place : filling.twigs)
        all += wood_of(place);

    const double place_length = kPlace * growth * species.twigs.front().length;
    const auto place_of = [&](double along) { return static_cast<int>(along / place_length); };
    std::map<std::pair<size_t, int>, int> borne;
    // Short twigs low on stout wood are taken for dead ones (foliage/snags.h).
    const double low = crown.bottom() + kLowShare * (crown.top() - crown.bottom());
    const auto bears_no_leaves = [&](const SketchAxis& axis, double along, double length) {
        const double radius = value_along(axis.points, axis.radii, along);
        const bool is_low = place_along(axis.points, along).y < low;
        return is_low && radius > 2.0 * rules.maximum_radius && length < kLowSnagRadii * radius;
    };
    for (const View view : {View::kFront, View::kSide}) {
        Cover cover(crown, view, cell, kLeafCover * leaf, margin);
        for (const TwigPlace& place : filling.twigs)
            mark(cover, place);
        // In no order that one sees.
        std::vector<uint32_t> order(cover.size());
        for (size_t i = 0; i < order.size(); i++)
            order[i] = static_cast<uint32_t>(i);
        Random random(hash_seed(seed, static_cast<uint64_t>(view)));
        for (size_t i = order.size(); i-- > 1;)
            std::swap(order[i], order[random.below(static_cast<uint32_t>(i + 1))]);
        for (const uint32_t i : order) {
            if (!cover.open(i) || all >= most_wood) continue;
            if (progress) progress->check();
            const DVec2 target = cover.middle(i);
            // The nearest wood as one sees it, that is in the crown.
            TwigPlace place;
            double least = 1e300;
            for (size_t l = 0; l < filling.axes.size(); l++) {
                const std::vector<DVec3>& points = filling.axes[l].axis.points;
                double passed = 0.0;
                for (size_t k = 0; k + 1 < points.size(); k++) {
                    const DVec2 a = cover.seen(points[k]), b = cover.seen(points[k + 1]);
                    double where;
                    const double square =
                        square_to_segment(DVec3(target, 0.0), DVec3(a, 0.0), DVec3(b, 0.0), where);
                    const double length = glm::length(points[k + 1] - points[k]);
                    const DVec3 p = points[k] + (points[k + 1] - points[k]) * where;
                    const double along = passed + where * length;
                    passed += length;
                    if (square >= least || !crown.contains(p)) continue;
                    if (bears_no_leaves(filling.axes[l].axis, along, std::sqrt(square))) continue;
                    const auto there = borne.find({l, place_of(along)});
                    if (there != borne.end() && there->second >= kMostAtAPlace) continue;
                    least = square;
                    place.axis = l;
                    place.along = along;
                }
            }
            if (least >= 1e300) continue;
            const SketchAxis& axis = filling.axes[place.axis].axis;
            DVec3 from = place_along(axis.points, place.along);
            if (species.own) {
                // Lower on the branch, so that it leaves it at an angle of its kind and still gets there.
                const double off = species.angle_at(random.uniform()) * kPi / 180.0;
                const double back = std::sqrt(least) * portable::cos(off) / portable::sin(off);
                const double along = std::clamp(place.along - back, 0.0, length_of(axis.points));
                const DVec3 lower = place_along(axis.points, along);
                if (crown.contains(lower) && !bears_no_leaves(axis, along, std::sqrt(least))) {
                    place.along = along;
                    from = lower;
                }
            }
            // To where it is seen, in the depth of the wood that it grows from.
            DVec3 to =
                view == View::kFront ? DVec3(target.x, target.y, from.z) : DVec3(from.x, target.y, target.x);
            if (!crown.contains(to)) {
                const double depth = crown.half_depth(to.x, to.y);
                to.z = std::clamp(to.z, -0.8 * std::max(depth, 0.0), 0.8 * std::max(depth, 0.0));
            }
            const double room = glm::length(to - from) + 0.5 * leaf;
            place.way = normalized_or(to - from, DVec3(0.0, 1.0, 0.0));
            place.spin = random.uniform(0.0, 2.0 * kPi);
            const double radius = value_along(axis.points, axis.radii, place.along);
            const double shortest = 0.36 * growth * species.twigs.front().length;
            const double longest = 1.3 * growth * species.twigs.back().length;
            const auto chosen = choose_twig(species, std::clamp(room, shortest, longest), radius, growth,
                                            true, hash_seed(axis.seed, 50000 + filling.twigs.size()));
            if (!chosen) continue;
            place.twig = chosen->twig;
            place.scale = chosen->scale;
            filling.twigs.push_back(place);
            borne[{place.axis, place_of(place.along)}]++;
            mark(cover, place);
            all += wood_of(place);
        }
    }
}

}  // namespace treerec
