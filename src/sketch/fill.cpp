#include "sketch/fill.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "edit/graft/scion.h"
#include "foliage/leaf_rules.h"
#include "geometry/portable_math.h"
#include "geometry/random.h"
#include "sketch/alpha_crown.h"
#include "sketch/axis_cells.h"
#include "sketch/close_gaps.h"
#include "sketch/crown_leaves.h"
#include "sketch/lift.h"
#include "tree/branches.h"

namespace treerec {

namespace {

constexpr double kGolden = 137.508 * kPi / 180.0;
// Between places of one twig each, in the middle twig's lengths, at least; and over the edge of the cube that
// each would have if the leaves that a tree may bear were shared out in its crown.
constexpr double kSpacing = 0.2, kShareSpacing = 0.7;
// Of the twigs that bear the leaves, those that stand evenly; the rest is for gaps.
constexpr double kEven = 0.5;
// Twigs of one's own may be crowded ones, which leave more gaps: so many times the wood is for all.
constexpr double kForGaps = 2.0;
constexpr double kBare = 0.12;  // of a branch, at its base
constexpr double kMostScale = 1.3;
// A branch for a place that no twig is long enough for: of the room there, and its steps.
constexpr double kBranchShare = 0.8;
constexpr int kBranchSteps = 7;
constexpr double kUpwards = 0.35;         // how much of its way turns up along it
constexpr double kBranchThickness = 0.6;  // of its parent's, at most
constexpr int kDeepest = 4;               // branches on branches
constexpr size_t kMostTwigs = 4000;

struct Filler {
    const CrownSections& crown;
    const SketchSpecies& species;
    const std::optional<WoodTaper>& taper;  // of this tree's height
    const SketchOptions& options;
    const Progress* progress;
    double growth;
    double margin;
    double step;
    double spacing;
    std::vector<size_t> cell_of;  // by filled branch
    Filling filling = {};

    bool printed() const { return options.depth == SketchDepth::kPaper; }

    int at_a_place() const {
        if (printed()) return 1;
        switch (species.arrangement) {
            case TwigArrangement::kOpposite:
                return 2;
            case TwigArrangement::kClustered:
                return 3;
            default:
                return 1;
        }
    }

    void add_branch(const CrownBound& bound, size_t parent, double along, const DVec3& way, double room,
                    int depth) {
        const SketchAxis& host = filling.axes[parent].axis;
        FilledAxis branch;
        branch.parent = static_cast<int32_t>(parent);
        branch.axis.along = along;
        branch.axis.seed = hash_seed(host.seed, 7000 + static_cast<uint64_t>(filling.axes.size()));
        DVec3 at = place_along(host.points, along);
        DVec3 direction = way;
        branch.axis.points.push_back(at);
        for (int i = 0; i < kBranchSteps; i++) {
            const DVec3 next = at + direction * (kBranchShare * room / kBranchSteps);
            if (!crown.contains(next, margin)) break;
            branch.axis.points.push_back(at = next);
            direction = glm::normalize(direction + DVec3(0.0, kUpwards / kBranchSteps, 0.0));
        }
        if (branch.axis.points.size() < 3) return;
        const double radius = kBranchThickness * value_along(host.points, host.radii, along);
        branch.axis.radii =
            taper ? taper->branches.radii_along(branch.axis.points, 1.0, std::max(radius, kLeastRadius))
                  : tapered(branch.axis.points, radius, kLeastRadius);
        const size_t cell = cell_of[parent];
        filling.axes.push_back(std::move(branch));
        cell_of.push_back(cell);
        fill(bound, filling.axes.size() - 1, 0.0, depth + 1);
    }

    // Twigs on the branch from `begin` metres on.
    void fill(const CrownBound& bound, size_t index, double begin, int depth) {
        if (progress) progress->check();
        const SketchAxis axis = filling.axes[index].axis;  // the list grows
        const double length = length_of(axis.points);
        const DVec3 direction =
            normalized_or(axis.points.back() - place_along(axis.points, begin), DVec3(0, 1, 0));
        const DMat3 frame = frame_about(direction);
        const double bare = begin > 0.0 || printed() ? begin : kBare * length;
        const int several = at_a_place();
        const auto places =
            static_cast<size_t>(std::max(1.0, std::floor((length - bare) / (spacing * several) + 0.5)));
        Random random(hash_seed(axis.seed, 11));
        const double first = random.uniform(0.0, 2.0 * kPi);
        for (size_t i = 0; i < places && options.density > 0.0; i++) {
            const double group = (length - bare) / static_cast<double>(places);
            const double along = bare + group * (static_cast<double>(i) + random.uniform(0.15, 0.85));
            const DMat3 here = species.own ? frame_about(direction_along(axis.points, along)) : frame;
            for (int k = 0; k < several; k++) {
                const double off = species.angle_at(random.uniform()) * kPi / 180.0;
                const double roll = printed() ? random.uniform(0.0, 2.0 * kPi)
                                              : first + kGolden * static_cast<double>(i) +
                                                    2.0 * kPi * k / several + random.uniform(-0.3, 0.3);
                const DVec3 way =
                    here[1] * portable::cos(off) +
                    (here[0] * portable::cos(roll) + here[2] * portable::sin(roll)) * portable::sin(off);
                add(bound, index, along, way, random.uniform(0.0, 2.0 * kPi), depth);
            }
        }
        // The branch itself goes on in a twig.
        if (!printed() && options.density > 0.0) {
            const DVec3 last = axis.points.back() - axis.points[axis.points.size() - 2];
            add(bound, index, length, normalized_or(last, direction), random.uniform(0.0, 2.0 * kPi),
                kDeepest);
        }
    }

    void add(const CrownBound& bound, size_t index, double along, const DVec3& way, double spin, int depth) {
        if (filling.twigs.size() >= kMostTwigs) return;
        const SketchAxis& axis = filling.axes[index].axis;
        const double room = bound.reach(place_along(axis.points, along), way, cell_of[index], step, margin);
        if (!(room > 0.0)) return;
        const double longest = kMostScale * growth * species.twigs.back().length;
        if (!printed() && room > longest && depth < kDeepest) {
            add_branch(bound, index, along, way, room, depth);
            return;
        }
        const double radius = value_along(axis.points, axis.radii, along);
        const auto chosen = choose_twig(species, printed() ? room : std::min(room, longest), radius, growth,
                                        !printed(), hash_seed(axis.seed, 40000 + filling.twigs.size()));
        if (chosen)
            filling.twigs.push_back({index, along, way, chosen->twig, chosen->scale, spin});
        else
            filling.bare++;
    }
};

// The trunk above its lowest branch, or in the crown, is a branch of its own: metres along it where that
// begins.
double leader_begin(const SketchAxes& axes, const CrownSections& crown) {
    const double length = length_of(axes.trunk.points);
    double begin = length;
    for (const SketchAxis& branch : axes.branches)
        if (branch.parent < 0) begin = std::min(begin, branch.along);
    if (!axes.branches.empty()) return begin;
    for (double along = 0.0; along < length; along += 0.01 * length)
        if (place_along(axes.trunk.points, along).y >= crown.bottom()) return along;
    return length;
}

std::vector<DVec3> line_from(const std::vector<DVec3>& points, double begin) {
    std::vector<DVec3> line{place_along(points, begin)};
    double along = 0.0;
    for (size_t i = 1; i < points.size(); i++) {
        along += glm::length(points[i] - points[i - 1]);
        if (along > begin) line.push_back(points[i]);
    }
    return line;
}

}  // namespace

namespace {

// Twigs are evenly left out until the rest have no more wood in the crown than that.
void thin_out(Filling& filling, const SketchSpecies& species, const CrownSections& crown, double margin,
              double most) {
    double all = 0.0;
    for (const TwigPlace& place : filling.twigs)
        all += kept_wood(species.twigs[place.twig].scion, place,
                         place_along(filling.axes[place.axis].axis.points, place.along), crown, margin);
    if (all <= most) return;
    std::vector<TwigPlace> kept;
    double due = 0.0;
    for (const TwigPlace& place : filling.twigs) {
        due += most / all;
        if (due < 1.0) continue;
        due -= 1.0;
        kept.push_back(place);
    }
    filling.twigs = std::move(kept);
}

}  // namespace

Filling fill_crown(const SketchAxes& axes, const CrownSections& crown, const SketchSpecies& species,
                   double height, double metres_per_pixel, uint64_t seed, const SketchOptions& options,
                   const Progress* progress) {
    const bool printed = options.depth == SketchDepth::kPaper;
    const LeafRules& rules = species.leaves;
    const double growth = printed ? 1.0 : twig_growth(species, height);
    const double middle = species.twigs[species.twigs.size() / 2].length;
    const Tree& usual = species.twigs[species.twigs.size() / 2].scion;
    const double wood = subtree_lengths(usual)[static_cast<size_t>(usual.root())];
    const double wanted = options.density * wanted_wood(crown, species, height);
    const double count = std::max(kEven * wanted / (growth * wood), 1.0);
    // As near as on the tree that its twigs are from, but no farther than a twig reaches.
    const double own_step = growth * std::min(species.internode, middle);
    Filler filler{crown,
                  species,
                  axes.taper,
                  options,
                  progress,
                  growth,
                  printed ? 0.0 : leaf_margin(crown, rules, height),
                  metres_per_pixel,
                  printed ? kSpacing * middle
                          : std::max({kSpacing * growth * middle, own_step,
                                      kShareSpacing * portable::cbrt(crown.volume() / count)}),
                  {}};
    filler.filling.axes.push_back({axes.trunk, -1});
    filler.cell_of.push_back(0);
    const double begin = leader_begin(axes, crown);
    std::vector<std::vector<DVec3>> lines{line_from(axes.trunk.points, begin)};
    for (const SketchAxis& branch : axes.branches) {
        // The trunk is the first of these.
        filler.filling.axes.push_back({branch, branch.parent + 1});
        filler.cell_of.push_back(lines.size());
        lines.push_back(branch.points);
    }
    if (lines[0].size() < 2) lines[0].push_back(lines[0][0] + DVec3(0.0, 1e-6, 0.0));
    const AxisCells cells(crown, lines);
    std::unique_ptr<const CrownBound> alpha;
    if (options.crown == SketchCrown::kAlpha) alpha = alpha_crown(crown, cells, lines.size(), seed, progress);
    const CrownBound* const bound = alpha ? alpha.get() : &cells;
    const size_t first_order = filler.filling.axes.size();
    if (begin < length_of(axes.trunk.points)) filler.fill(*bound, 0, begin, 0);
    for (size_t i = 1; i < first_order; i++)
        filler.fill(*bound, i, 0.0, 0);
    if (!printed) thin_out(filler.filling, species, crown, filler.margin, kEven * wanted);
    if (!printed && options.density > 0.0)
        close_gaps(filler.filling, crown, species, rules, height, (species.own ? kForGaps : 1.0) * wanted,
                   hash_seed(seed, 5), progress);
    return filler.filling;
}

}  // namespace treerec
