#include "skeleton/cylinders/axis.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/circle_fit.h"
#include "geometry/parallel.h"

namespace treerec {

namespace {

constexpr size_t kWantedPoints = 16;  // per circle; the window grows until it has them
constexpr size_t kWantedOfStem = 40;  // the same for the stem's lower part,
constexpr double kSparseStem = 0.25;  // where the points' spacing is more than that of its radius,
constexpr double kStemShare = 0.25;   // of its length
constexpr size_t kLeastPoints = 8;
constexpr size_t kMostPoints = 100;
constexpr double kLeastCoverage = 0.5;  // of the circle's sectors
constexpr double kMostSpread = 0.12;    // median residual over radius
constexpr double kLeastArc = 0.31;      // the same for one that is seen from one side
constexpr double kArcSpread = 0.03;
constexpr size_t kArcPoints = 24;       // which is enough of a stem's base if the radius'
constexpr double kArcError = 0.12;      // standard error is so small a share of it
constexpr double kMostInside = 0.08;    // share of points well inside: a crown, not a stem
constexpr double kWideSpread = 0.09;    // the same for one that is wide for its tree: bark keeps to its
constexpr double kWideInside = 0.03;    // circle, and nothing shines through it; a hollow crown is neither
constexpr double kSureCoverage = 0.95;  // such a circle needs one alike beside it and no more
constexpr double kSureSpread = 0.09;
constexpr double kRingCoverage = 0.85;  // the same for closed sections that are not round
constexpr double kRingInside = 0.04;
constexpr double kRingSpread = 0.33;
constexpr double kEndCut = 1.5;      // radii: so near to an end, no circle is whole
constexpr double kEndStretch = 3.0;  // radii: so far a fitted stretch is continued to an end
constexpr int kSmoothings = 3;

// One branch while its axis is fitted.
class BranchFitter {
  public:
    BranchFitter(const SkeletonBranch& branch, const Slices& slices, const std::vector<Vec3>& points,
                 const LocalScale& scale, const AxisOptions& options, uint64_t stream)
        : slices_(slices),
          points_(points),
          options_(options),
          stream_(stream),
          is_first_(branch.parent < 0),
          count_(branch.slices.size()) {
        collect(branch);
        start_.resize(count_);
        spacing_.assign(count_, 0.0);
        stations_.resize(count_);
        for (size_t i = 0; i < count_; i++) {
            const int32_t slice = branch.slices[i];
            start_[i] = slices.centre[slice];
            if (own_[i] > begin_[i]) {
                DVec3 sum(0.0);
                for (size_t m = begin_[i]; m < own_[i]; m++)
                    sum += DVec3(points[members_[m]]);
                start_[i] = sum / static_cast<double>(own_[i] - begin_[i]);
            }
            stations_[i].bridged = slices.bridged[slice] != 0;
            for (const uint32_t v : slices.points_of(slice))
                spacing_[i] += scale.spacing[v];
            if (!slices.points_of(slice).empty())
                spacing_[i] /= static_cast<double>(slices.points_of(slice).size());
        }
        smooth(start_);
        for (size_t i = 0; i < count_; i++)
            stations_[i].position = start_[i];
        measure_arc();
        soft_radii();
    }

    std::vector<Station> run() {
        if (options_.fit_radii)
            for (int round = 0; round < (does(Pass::kSecondFit) ? options_.rounds : 1); round++) {
                fit_all();
                move_axis();
                measure_arc();
            }
        soft_radii();
        finish_ends();
        return std::move(stations_);
    }

  private:
    bool does(Pass pass) const { return !options_.left_out.has(pass); }

    // The points of each station, those of absorbed side chains included.
    void collect(const SkeletonBranch& branch) {
        begin_.assign(count_ + 1, 0);
        for (size_t i = 0; i < count_; i++)
            begin_[i + 1] += slices_.points_of(branch.slices[i]).size();
        for (size_t m = 0; m < branch.merged.size(); m++)
            begin_[branch.merged_at[m] + 1] += slices_.points_of(branch.merged[m]).size();
        for (size_t a = 0; a < branch.absorbed.size(); a++)
            begin_[branch.absorbed_at[a] + 1] += slices_.points_of(branch.absorbed[a]).size();
        for (size_t i = 0; i < count_; i++)
            begin_[i + 1] += begin_[i];
        members_.resize(begin_[count_]);
        std::vector<size_t> fill(begin_.begin(), begin_.end() - 1);
        own_.resize(count_);
        for (size_t i = 0; i < count_; i++)
            for (const uint32_t v : slices_.points_of(branch.slices[i]))
                members_[fill[i]++] = v;
        for (size_t m = 0; m < branch.merged.size(); m++)
            for (const uint32_t v : slices_.points_of(branch.merged[m]))
                members_[fill[branch.merged_at[m]]++] = v;
        for (size_t i = 0; i < count_; i++)
            own_[i] = fill[i];
        for (size_t a = 0; a < branch.absorbed.size(); a++)
            for (const uint32_t v : slices_.points_of(branch.absorbed[a]))
                members_[fill[branch.absorbed_at[a]]++] = v;
    }

    void measure_arc() {
        arc_.assign(count_, 0.0);
        for (size_t i = 1; i < count_; i++)
            arc_[i] = arc_[i - 1] + glm::distance(stations_[i].position, stations_[i - 1].position);
    }

    // The stations within `reach` of station i along the branch, as [first, last].
    std::pair<size_t, size_t> window(size_t i, double reach) const {
        size_t first = i;
        size_t last = i;
        while (first > 0 && arc_[i] - arc_[first - 1] <= reach)
            first--;
        while (last + 1 < count_ && arc_[last + 1] - arc_[i] <= reach)
            last++;
        return {first, last};
    }

    DVec3 direction(size_t i, double reach) const {
        auto [first, last] = window(i, reach);
        if (first == i && i > 0) first = i - 1;
        if (last == i && i + 1 < count_) last = i + 1;
        return normalized_or(stations_[last].position - stations_[first].position, DVec3(0, 1, 0));
    }

    std::optional<CircleFit> fit(size_t i, DVec3& u, DVec3& v) {
        const double radius = std::max(stations_[i].radius, 0.5 * spacing_[i]);
        double reach = std::max(radius, 1.5 * spacing_[i]);
        auto [first, last] = window(i, reach);
        // Of a sparse stem, a longer piece tells what a short one cannot.
        const bool stem_base = is_first_ && arc_[i] <= kStemShare * arc_.back();
        const bool stem = stem_base && options_.long_windows && does(Pass::kLongWindows) &&
                          spacing_[i] > kSparseStem * radius;
        const size_t wanted = stem ? kWantedOfStem : kWantedPoints;
        for (int grow = 0; grow < (stem ? 6 : 3) && begin_[last + 1] - begin_[first] < wanted; grow++) {
            reach *= 1.6;
            std::tie(first, last) = window(i, reach);
        }
        if (begin_[last + 1] - begin_[first] < kLeastPoints) return std::nullopt;
        const DVec3 along = direction(i, std::max(2.0 * radius, 4.0 * spacing_[i]));
        u = any_perpendicular(along);
        v = glm::cross(along, u);
        std::vector<DVec2>& flat = flat_;
        flat.clear();
        double extent = 0.0;
        const size_t stride = 1 + (begin_[last + 1] - begin_[first]) / kMostPoints;
        for (size_t m = begin_[first]; m < begin_[last + 1]; m += stride) {
            const DVec3 offset = DVec3(points_[members_[m]]) - stations_[i].position;
            if (std::abs(glm::dot(offset, along)) > 2.0 * reach) continue;
            flat.emplace_back(glm::dot(offset, u), glm::dot(offset, v));
            extent += glm::length(flat.back());
        }
        if (flat.size() < kLeastPoints) return std::nullopt;
        extent /= static_cast<double>(flat.size());
        const auto plausible = [&](const CircleFit& circle) {
            return circle.radius > 0.0 && glm::length(circle.centre) < 2.0 * circle.radius;
        };
        const std::optional<CircleFit> circle =
            fit_circle(flat, 3.0 * extent, Random(options_.seed, hash_seed(stream_, i)));
        // The less of a circle is seen, the closer the points must keep to it.
        const bool wide = circle && circle->radius > options_.widest_ring;
        if (circle && plausible(*circle) && circle->inside <= (wide ? kWideInside : kMostInside)) {
            const double spread = circle->spread / circle->radius;
            if (circle->coverage >= kLeastCoverage && spread <= (wide ? kWideSpread : kMostSpread))
                return circle;
            if (does(Pass::kArcs) && circle->coverage >= kLeastArc && spread <= kArcSpread) return circle;
            // Of a noisy stem that is seen from one side, many points tell what few cannot.
            if (does(Pass::kManyPointedArcs) && stem_base && !wide && circle->coverage >= kLeastArc &&
                spread <= kMostSpread && flat.size() >= kArcPoints &&
                circle->error <= kArcError * circle->radius)
                return circle;
        }
        if (!does(Pass::kRings)) return std::nullopt;
        const std::optional<CircleFit> ring = fit_ring(flat);
        if (ring && plausible(*ring) && ring->coverage >= kRingCoverage && ring->inside <= kRingInside &&
            ring->spread <= kRingSpread * ring->radius && ring->radius <= options_.widest_ring)
            return ring;
        return std::nullopt;
    }

    // A second round looks again only where the first one found something: elsewhere the axis did not move.
    void fit_all() {
        const std::vector<std::optional<DVec3>> before = std::move(centres_);
        centres_.assign(count_, std::nullopt);
        sure_.assign(count_, 0);
        for (size_t i = 0; i < count_; i++) {
            bool worthwhile = before.empty();
            for (size_t j = i >= 2 ? i - 2 : 0; !worthwhile && j <= std::min(i + 2, count_ - 1); j++)
                worthwhile = before[j].has_value();
            if (!worthwhile) continue;
            DVec3 u, v;
            const std::optional<CircleFit> circle = fit(i, u, v);
            if (!circle) continue;
            centres_[i] = stations_[i].position + circle->centre.x * u + circle->centre.y * v;
            stations_[i].radius = circle->radius;
            stations_[i].scatter = circle->spread;
            sure_[i] = circle->coverage >= kSureCoverage && circle->inside <= kWideInside &&
                       circle->spread <= kSureSpread * circle->radius;
        }
        // A circle that none of its neighbours confirms is an accident.
        for (size_t i = 0; i < count_; i++) {
            stations_[i].measured = false;
            if (!centres_[i]) continue;
            size_t alike = 0;
            size_t fitted = 0;
            for (size_t j = i >= 3 ? i - 3 : 0; j <= std::min(i + 3, count_ - 1); j++) {
                if (j == i || !centres_[j]) continue;
                fitted++;
                if (std::abs(stations_[j].radius - stations_[i].radius) < 0.25 * stations_[i].radius) alike++;
            }
            const size_t needed = sure_[i] != 0 ? 1 : options_.confirmations;
            stations_[i].measured = alike >= needed && 2 * alike >= fitted;
        }
        for (size_t i = 0; i < count_; i++)
            if (!stations_[i].measured) centres_[i].reset();
    }

    // Puts the measured stations on their centres and takes the others along.
    void move_axis() {
        std::vector<DVec3> position(count_);
        size_t before = count_;
        size_t after = 0;
        for (size_t i = 0; i < count_; i++) {
            if (centres_[i]) before = i;
            after = std::max(after, i);
            while (after < count_ && !centres_[after])
                after++;
            DVec3 shift(0.0);
            auto shift_of = [&](size_t j) {
                // Fades over a few radii beyond the measured stretch.
                const double fade = 1.0 - std::abs(arc_[i] - arc_[j]) / (8.0 * stations_[j].radius + 1e-9);
                return std::max(0.0, fade) * (*centres_[j] - start_[j]);
            };
            if (before < count_ && after < count_ && before != after) {
                const double span = arc_[after] - arc_[before];
                const double t = span > 0.0 ? (arc_[i] - arc_[before]) / span : 0.0;
                shift = (1.0 - t) * shift_of(before) + t * shift_of(after);
            } else if (before < count_) {
                shift = shift_of(before);
            } else if (after < count_) {
                shift = shift_of(after);
            }
            position[i] = start_[i] + shift;
        }
        smooth(position);
        for (size_t i = 0; i < count_; i++)
            stations_[i].position = position[i];
    }

    // Evens out what chance did to the slices; ends and both sides of a gap stay where they are.
    void smooth(std::vector<DVec3>& line) const {
        std::vector<DVec3> next = line;
        for (int round = 0; round < kSmoothings; round++) {
            for (size_t i = 1; i + 1 < line.size(); i++)
                if (!stations_[i].bridged && !stations_[i + 1].bridged)
                    next[i] = 0.25 * line[i - 1] + 0.5 * line[i] + 0.25 * line[i + 1];
            line.swap(next);
            next = line;
        }
    }

    // What the points say where no circle was found: their median distance to the axis.
    void soft_radii() {
        std::vector<double> distances;
        for (size_t i = 0; i < count_; i++) {
            if (stations_[i].measured) continue;
            const DVec3 along = direction(i, 3.0 * spacing_[i]);
            distances.clear();
            for (size_t m = begin_[i]; m < own_[i]; m++) {
                const DVec3 offset = DVec3(points_[members_[m]]) - stations_[i].position;
                distances.push_back(glm::length(offset - glm::dot(offset, along) * along));
            }
            stations_[i].radius = 0.0;
            if (distances.empty()) continue;
            const auto middle = distances.begin() + static_cast<ptrdiff_t>(distances.size() / 2);
            std::nth_element(distances.begin(), middle, distances.end());
            stations_[i].radius = *middle;
        }
    }

    // The slices at the ends of a branch are cut off: half rings, whose centres lie beside the axis. So the
    // ends continue the nearest fitted stretch straight on, and a tip reaches as far as its points do.
    void finish_ends() {
        measure_arc();
        size_t first = 0;
        while (first < count_ &&
               !(stations_[first].measured && arc_[first] >= kEndCut * stations_[first].radius))
            first++;
        if (first < count_ && is_first_ && does(Pass::kStraightEnds)) straighten(first, -1);
        size_t last = count_;
        while (last > 0 && !(stations_[last - 1].measured &&
                             arc_[count_ - 1] - arc_[last - 1] >= kEndCut * stations_[last - 1].radius))
            last--;
        if (last > 0 && does(Pass::kStraightEnds)) straighten(last - 1, 1);
        if (count_ < 2) return;
        Station& tip = stations_[count_ - 1];
        measure_arc();
        const DVec3 ahead = direction(count_ - 1, std::max(2.0 * tip.radius, 4.0 * spacing_[count_ - 1]));
        double reach = 0.0;
        for (size_t m = begin_[count_ - 1]; m < own_[count_ - 1]; m++)
            reach = std::max(reach, glm::dot(DVec3(points_[members_[m]]) - tip.position, ahead));
        tip.position += reach * ahead;
    }

    // Lays the stations from `end` outward (step 1: to the tip, -1: to the base) on the line through the
    // fitted stretch before, if they are near.
    void straighten(size_t end, int step) {
        const Station anchor = stations_[end];
        const size_t outermost = step > 0 ? count_ - 1 : 0;
        if (end == outermost || std::abs(arc_[outermost] - arc_[end]) > kEndStretch * anchor.radius) return;
        size_t back = end;
        while (back != count_ - 1 - outermost &&
               std::abs(arc_[back] - arc_[end]) < 2.0 * kEndStretch * anchor.radius &&
               stations_[back].measured)
            back = static_cast<size_t>(static_cast<ptrdiff_t>(back) - step);
        const DVec3 outward = normalized_or(anchor.position - stations_[back].position, DVec3(0.0));
        // A base beside this line is shared with other stems.
        const DVec3 aside = start_[outermost] - anchor.position;
        if (glm::length(aside - glm::dot(aside, outward) * outward) > 1.5 * anchor.radius) return;
        double reach = 0.0;
        for (size_t i = end; i != outermost;) {
            i = static_cast<size_t>(static_cast<ptrdiff_t>(i) + step);
            reach = std::max(reach, glm::dot(start_[i] - anchor.position, outward));
            stations_[i].position = anchor.position + reach * outward;
            stations_[i].radius = anchor.radius;
        }
    }

    const Slices& slices_;
    const std::vector<Vec3>& points_;
    const AxisOptions& options_;
    uint64_t stream_;
    bool is_first_;
    size_t count_;
    std::vector<size_t> begin_;  // members_ of station i: begin_[i] .. begin_[i + 1]
    std::vector<size_t> own_;    // the part before own_[i] is the station's own slice
    std::vector<uint32_t> members_;
    std::vector<DVec3> start_;  // smoothed slice centres
    std::vector<double> spacing_;
    std::vector<double> arc_;
    std::vector<Station> stations_;
    std::vector<std::optional<DVec3>> centres_;
    std::vector<uint8_t> sure_;  // by station: the circle is whole and clean
    std::vector<DVec2> flat_;    // a section's points, kept between sections
};

}  // namespace

void move_attach(SkeletonBranch& branch, const std::vector<Station>& own,
                 const std::vector<Station>& parent) {
    const double radius = parent[branch.attach].radius;
    size_t ahead = 0;
    while (ahead + 1 < own.size() && glm::distance(own[ahead].position, own[0].position) < 2.0 * radius)
        ahead++;
    if (ahead == 0 || own[0].bridged) return;
    const DVec3 direction = normalized_or(own[ahead].position - own[0].position, DVec3(0.0));
    const DVec3 from = parent[branch.attach].position;
    double best = -2.0;
    int32_t best_station = branch.attach;
    for (int32_t j = branch.attach; j >= 0 && glm::distance(parent[j].position, from) <= 3.0 * radius; j--) {
        const double straight =
            glm::dot(normalized_or(own[0].position - parent[j].position, DVec3(0.0)), direction);
        if (straight > best + 1e-6) {
            best = straight;
            best_station = j;
        }
    }
    branch.attach = best_station;
}

std::vector<std::vector<Station>> fit_axes(std::vector<SkeletonBranch>& branches, const Slices& slices,
                                           const std::vector<Vec3>& points, const LocalScale& scale,
                                           const AxisOptions& options, Progress& progress) {
    std::vector<std::vector<Station>> axes(branches.size());
    parallel_for(branches.size(), 4, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++) {
            progress.check();
            axes[i] = BranchFitter(branches[i], slices, points, scale, options, i).run();
        }
    });
    for (SkeletonBranch& branch : branches)
        if (branch.parent >= 0 && !options.left_out.has(Pass::kAttach))
            move_attach(branch, axes[&branch - branches.data()], axes[branch.parent]);
    return axes;
}

}  // namespace treerec
