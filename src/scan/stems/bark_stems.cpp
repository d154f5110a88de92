// Stems whose bark is seen.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "scan/robust.h"
#include "scan/stems/round_stems.h"
#include "scan/stems/separate_trees.h"
#include "scan/stems/stem_rules.h"

namespace treerec {

namespace {

// The searches for round bark in a plot: between needles, and by a mobile scanner.
constexpr std::array<RoundStemSearch, 2> kRoundSearches{{{}, kRoughBark}};
constexpr size_t kFewestRound = 16;
constexpr double kRoundUpTo = 0.5;  // of the height
constexpr size_t kMostRound = 200;
constexpr double kStemRoom = 15.0;   // square metres of a plot for each of them
constexpr double kApartRadii = 2.0;  // of both stems: between two that stand from the ground up
constexpr double kBranchLean = 0.5;  // run over rise, from a stem's foot to where a branch's bark is seen
constexpr double kStandsRoundBelow = 0.06;  // of the height: where the bark of such a stem begins
constexpr double kLeaning = 0.2;  // run over rise: a stem that leans more is looked at along itself,
constexpr double kAlong = 0.4;    // of the height: as far,
constexpr double kBeside = 0.05;  // and so far to its sides

struct Barked {
    Stem stem;
    bool stands = false;  // seen from the ground up
    double lowest = 0.0;  // metres above the ground: where it is seen first
};

// What the search found, as a stem. standing: the points that it looked at, by their height above the ground
// or along an axis.
Stem stem_of(const RoundStem& round, const std::vector<Vec3>& standing, double height) {
    Stem stem;
    const StemRing &low = round.front(), &high = round.back();
    stem.lean = (high.centre - low.centre) / (high.y - low.y);
    stem.radius = round[round.size() / 2].radius;
    stem.bark = true;
    const DVec2 foot = low.centre - low.y * stem.lean;
    stem.foot = {foot.x, 0.0, foot.y};
    const std::vector<uint8_t> on = points_on_stems(standing, {round});
    for (uint32_t i = 0; i < standing.size(); i++)
        if (on[i] && standing[i].y < low.y + kSeed * height) stem.seed.push_back(i);
    return stem;
}

// Puts the foot on the ground.
void stand(Stem& stem, const std::vector<Vec3>& standing, const std::vector<Vec3>& points) {
    stem.foot.y = std::numeric_limits<double>::max();
    for (const uint32_t i : stem.seed)
        stem.foot.y = std::min<double>(stem.foot.y, points[i].y - standing[i].y);
}

// The bark of a stem that leans too far for the search, which looks straight up: its surroundings are turned
// upright. Nothing where it gets thicker upwards, as a branch does that leans on the ground.
std::optional<Barked> find_bark_along(const Stem& leaning, const std::vector<Vec3>& standing,
                                      const std::vector<Vec3>& points, double height,
                                      const Progress* progress) {
    const DVec3 foot(leaning.foot.x, 0.0, leaning.foot.z);
    const DVec3 axis = glm::normalize(DVec3(leaning.lean.x, 1.0, leaning.lean.y));
    const DVec3 u = any_perpendicular(axis), v = glm::cross(axis, u);
    std::vector<Vec3> beside;
    std::vector<uint32_t> index;
    for (uint32_t i = 0; i < standing.size(); i++) {
        const DVec3 d = DVec3(standing[i]) - foot;
        const DVec3 at(glm::dot(d, u), glm::dot(d, axis), glm::dot(d, v));
        if (at.y < 0.0 || at.y > kAlong * height || glm::length(DVec2(at.x, at.z)) > kBeside * height)
            continue;
        beside.emplace_back(at);
        index.push_back(i);
    }
    for (RoundStemSearch search : kRoundSearches) {
        search.most = 1;
        for (const RoundStem& round : find_round_stems(beside, progress, search)) {
            const StemRing &low = round.front(), &high = round.back();
            if (high.radius > low.radius) continue;
            Barked barked;
            barked.stem = stem_of(round, beside, height);
            const auto place = [&](const StemRing& ring) {
                return foot + ring.centre.x * u + ring.y * axis + ring.centre.y * v;
            };
            const DVec3 way = place(high) - place(low);
            barked.stem.lean = DVec2(way.x, way.z) / way.y;
            const DVec3 at = place(low) - place(low).y / way.y * way;
            barked.stem.foot = {at.x, 0.0, at.z};
            barked.lowest = place(low).y;
            barked.stands = barked.lowest < kStandsRoundBelow * height;
            for (uint32_t& i : barked.stem.seed)
                i = index[i];
            stand(barked.stem, standing, points);
            if (barked.stands && glm::length(barked.stem.lean) < kMostLean) return barked;
        }
    }
    return std::nullopt;
}

// Thickest first. standing: the points, by their height above the ground.
std::vector<Barked> find_barked(const std::vector<Vec3>& standing, const std::vector<Vec3>& points,
                                const std::vector<Stem>& stems, double height, const Progress* progress) {
    const std::array<Range, 3> ranges = robust_ranges(standing, progress);
    const double room =
        std::min(ranges[0].size() * ranges[2].size() / kStemRoom, static_cast<double>(kMostRound));
    std::vector<Barked> found;
    for (RoundStemSearch search : kRoundSearches) {
        search.most = std::max(kFewestRound, static_cast<size_t>(room));
        search.highest = kRoundUpTo;
        for (const RoundStem& round : find_round_stems(standing, progress, search)) {
            Barked barked;
            barked.stem = stem_of(round, standing, height);
            if (glm::length(barked.stem.lean) > kMostLean) continue;
            stand(barked.stem, standing, points);
            barked.lowest = round.front().y;
            barked.stands = barked.lowest < kStandsRoundBelow * height;
            found.push_back(std::move(barked));
        }
    }
    for (const Stem& stem : stems)
        if (glm::length(stem.lean) > kLeaning)
            if (std::optional<Barked> barked = find_bark_along(stem, standing, points, height, progress))
                found.push_back(std::move(*barked));
    if (found.empty()) return found;
    std::stable_sort(found.begin(), found.end(),
                     [](const Barked& a, const Barked& b) { return a.stem.radius > b.stem.radius; });
    const double thick = found[found.size() / 4].stem.radius;
    std::erase_if(found, [&](const Barked& b) { return b.stem.radius < kThinnest * thick; });
    return found;
}

}  // namespace

void add_round_stems(const std::vector<Vec3>& points, const std::vector<float>& above, double height,
                     std::vector<Stem>& stems, const Progress* progress) {
    std::vector<Vec3> standing(points);
    for (size_t i = 0; i < points.size(); i++)
        standing[i].y = above[i];
    std::vector<Barked> found = find_barked(standing, points, stems, height, progress);
    // Bark that goes up from the ground says more than what is dense there.
    std::vector<Stem> all;
    for (Barked& barked : found) {
        if (!barked.stands) continue;
        const auto same = std::find_if(all.begin(), all.end(), [&](const Stem& other) {
            const DVec3 apart = other.foot - barked.stem.foot;
            return glm::length(DVec2(apart.x, apart.z)) <
                   std::max(kApartRadii * (other.radius + barked.stem.radius),
                            std::min(kClosestMetres, 0.15 * height));
        });
        barked.stem.feet.emplace_back(barked.stem.foot.x, barked.stem.foot.z);
        if (same == all.end())
            all.push_back(std::move(barked.stem));
        else
            take_in(*same, barked.stem);
    }
    const std::vector<Stem> from_ground = all;
    const auto known = [&](const std::vector<Stem>& others, const Stem& stem) {
        return std::any_of(others.begin(), others.end(),
                           [&](const Stem& other) { return stand_together(other, stem, kClosest, height); });
    };
    for (Stem& stem : stems) {
        if (!from_ground.empty()) stem.radius = std::min(stem.radius, from_ground.front().radius);
        if (known(from_ground, stem)) continue;
        const auto trunk = std::find_if(
            all.begin(), all.end(), [&](const Stem& other) { return lean_together(other, stem, height); });
        if (trunk == all.end())
            all.push_back(std::move(stem));
        else
            take_in(*trunk, stem);
    }
    // Bark that is seen from higher up alone is another one's branch where that one's foot is so near that
    // the branch may have come from there.
    const auto is_limb = [&](const Barked& barked) {
        return std::any_of(all.begin(), all.end(), [&](const Stem& other) {
            const DVec2 at = DVec2(barked.stem.foot.x, barked.stem.foot.z) + barked.lowest * barked.stem.lean;
            const DVec2 axis = DVec2(other.foot.x, other.foot.z) + barked.lowest * other.lean;
            return glm::distance(at, axis) < kBranchLean * barked.lowest;
        });
    };
    for (Barked& barked : found) {
        if (barked.stands || known(all, barked.stem) || is_limb(barked)) continue;
        barked.stem.feet.emplace_back(barked.stem.foot.x, barked.stem.foot.z);
        all.push_back(std::move(barked.stem));
    }
    stems = std::move(all);
    join_clumps(stems, height);
}

}  // namespace treerec
