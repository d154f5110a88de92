#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "geometry/circle_fit.h"
#include "geometry/portable_math.h"
#include "geometry/quantile.h"
#include "scan/cleaning/samples.h"
#include "scan/stems/separate_trees.h"
#include "scan/stems/stem_rules.h"

namespace treerec {

namespace {

// All as shares of the height.
constexpr double kSlice = 0.02;        // thickness of a slice
constexpr double kLookedAt = 0.48;     // up to here
constexpr double kLatestStart = 0.05;  // a stem starts below this
constexpr double kLatestStartInThicket = 0.22;
constexpr double kLatestStartInAir = 0.04;
constexpr double kShortest = 0.18;  // a stem goes up for this long
constexpr double kStraight = 0.14;  // of it is taken for straight
constexpr double kWidest = 0.03;    // root mean square radius of a stem
constexpr double kCore = 0.01;      // across the densest spot
constexpr double kThicket = 0.05;   // what is wider is no trunk of which a branch could be part
constexpr double kClosestInThicket = 0.1;
// Others.
constexpr double kLeastFilled = 0.6;  // share of a stem's slices in which it is seen
constexpr double kLeastFilledInBranches = 0.8;
constexpr double kSteepest = 1.0;       // run over rise, from slice to slice
constexpr double kThinnestInAir = 0.4;  // where no ground tells what stands on it
constexpr double kCoreContrast = 4.0;   // how much denser it is than the rest
constexpr size_t kFewestPoints = 4;     // of a slice
constexpr double kRoundSpread = 0.08;   // of its radius: how far half of the points lie off round bark,
constexpr double kRoundCoverage = 0.8;  // seen from all sides,
constexpr double kRoundInside = 0.05;   // and the share of the points within

struct Cluster {
    DVec2 centre{0.0};
    double radius = 0.0;  // root mean square
    size_t slice = 0;
    bool in_branches = false;  // the core of a wider cluster
    bool round = false;        // wider than most stems, but bark, and nothing within
    std::vector<uint32_t> points;
};

// A stem may be wider than any bush at its foot: a stump, a banyan, a baobab.
bool is_round(const Cluster& wide, const std::vector<Vec3>& points, double height) {
    std::vector<DVec2> section;
    for (const uint32_t i : wide.points)
        section.emplace_back(points[i].x, points[i].z);
    const std::optional<CircleFit> circle = fit_circle(section, height, Random(1));
    return circle && circle->spread <= kRoundSpread * circle->radius && circle->coverage >= kRoundCoverage &&
           circle->inside <= kRoundInside;
}

// The densest spot of a wide cluster, as a cluster of its own: a stem among its own low branches.
bool find_core(const Cluster& wide, const std::vector<Vec3>& points, double height, Cluster& core) {
    const double cell = kCore * height;
    std::vector<std::pair<uint64_t, uint32_t>> keyed;
    auto key_of = [&](const Vec3& p, int dx, int dz) {
        const int64_t x = static_cast<int64_t>(std::floor(static_cast<double>(p.x) / cell)) + dx + (1 << 20);
        const int64_t z = static_cast<int64_t>(std::floor(static_cast<double>(p.z) / cell)) + dz + (1 << 20);
        return static_cast<uint64_t>(x) << 32 | static_cast<uint64_t>(z);
    };
    for (const uint32_t i : wide.points)
        keyed.emplace_back(key_of(points[i], 0, 0), i);
    std::sort(keyed.begin(), keyed.end());
    size_t cells = 0;
    size_t most = 0;
    size_t at = 0;
    for (size_t begin = 0, end = 0; begin < keyed.size(); begin = end) {
        while (end < keyed.size() && keyed[end].first == keyed[begin].first)
            end++;
        cells++;
        if (end - begin > most) {
            most = end - begin;
            at = begin;
        }
    }
    if (static_cast<double>(most * cells) < kCoreContrast * static_cast<double>(keyed.size())) return false;
    // What lies around the peak, twice, so that the cells' borders do not matter.
    DVec2 centre(0.0);
    for (size_t i = at; i < at + most; i++)
        centre += DVec2(points[keyed[i].second].x, points[keyed[i].second].z) / static_cast<double>(most);
    for (int round = 0; round < 2; round++) {
        core = {};
        for (const uint32_t i : wide.points)
            if (glm::distance(DVec2(points[i].x, points[i].z), centre) < 1.5 * cell) core.points.push_back(i);
        for (const uint32_t i : core.points)
            core.centre += DVec2(points[i].x, points[i].z) / static_cast<double>(core.points.size());
        centre = core.centre;
    }
    for (const uint32_t i : core.points) {
        const DVec2 d = DVec2(points[i].x, points[i].z) - centre;
        core.radius += glm::dot(d, d) / static_cast<double>(core.points.size());
    }
    core.radius = std::sqrt(core.radius);
    core.slice = wide.slice;
    core.in_branches = true;
    return core.points.size() >= kFewestPoints;
}

struct Track {
    std::vector<const Cluster*> clusters;
    bool from_thicket = false;
};

// The connected parts of each slice, seen from above.
std::vector<std::vector<Cluster>> cut_slices(const std::vector<Vec3>& points, const std::vector<float>& above,
                                             double height, double cell, const Progress* progress) {
    const size_t count = static_cast<size_t>(kLookedAt / kSlice);
    std::vector<std::vector<uint32_t>> members(count);
    for (size_t i = 0; i < points.size(); i++) {
        const double slice = static_cast<double>(above[i]) / (kSlice * height);
        if (slice >= 0.0 && slice < static_cast<double>(count))
            members[static_cast<size_t>(slice)].push_back(static_cast<uint32_t>(i));
    }
    std::vector<std::vector<Cluster>> slices(count);
    for (size_t s = 0; s < count; s++) {
        if (progress) progress->check();
        std::vector<Vec3> flat;
        for (const uint32_t i : members[s])
            flat.emplace_back(points[i].x, 0.0F, points[i].z);
        if (flat.empty()) continue;
        const std::vector<uint32_t> label = connected_components(flat, robust_ranges(flat), cell, progress);
        std::vector<Cluster> clusters(*std::max_element(label.begin(), label.end()) + size_t{1});
        for (size_t i = 0; i < flat.size(); i++) {
            Cluster& cluster = clusters[label[i]];
            cluster.points.push_back(members[s][i]);
            cluster.centre += DVec2(flat[i].x, flat[i].z);
        }
        for (Cluster& cluster : clusters) {
            cluster.slice = s;
            cluster.centre /= static_cast<double>(cluster.points.size());
            for (const uint32_t i : cluster.points) {
                const DVec2 d = DVec2(points[i].x, points[i].z) - cluster.centre;
                cluster.radius += glm::dot(d, d);
            }
            cluster.radius = std::sqrt(cluster.radius / static_cast<double>(cluster.points.size()));
            if (cluster.points.size() < kFewestPoints) continue;
            Cluster core;
            const bool wide = cluster.radius > kWidest * height;
            cluster.round = wide && is_round(cluster, points, height);
            if (wide && !cluster.round && find_core(cluster, points, height, core))
                slices[s].push_back(std::move(core));
            slices[s].push_back(std::move(cluster));
        }
    }
    return slices;
}

// Follows compact clusters upwards, each to the nearest one above that no other stem has.
std::vector<Track> follow_up(const std::vector<std::vector<Cluster>>& slices, double height, double cell,
                             bool on_ground) {
    const double latest_start = on_ground ? kLatestStart : kLatestStartInAir;
    const double rise = kSlice * height;
    constexpr size_t kReach = 3;  // slices that may be missing
    std::vector<Track> tracks;
    for (size_t s = 0; s < slices.size(); s++) {
        for (const Cluster& cluster : slices[s]) {
            if (cluster.radius > kWidest * height && !cluster.round) continue;
            // The best of the tracks that come from below.
            Track* best = nullptr;
            double best_distance = 0.0;
            for (Track& track : tracks) {
                const Cluster& last = *track.clusters.back();
                if (last.slice == s || last.slice + kReach + 1 < s) continue;
                const double reach = kSteepest * rise * static_cast<double>(s - last.slice) + cell;
                const double distance = glm::distance(last.centre, cluster.centre);
                if (distance > reach || (best && distance >= best_distance)) continue;
                best = &track;
                best_distance = distance;
            }
            if (best) {
                best->clusters.push_back(&cluster);
                continue;
            }
            const double start = static_cast<double>(s) * kSlice;
            if (start > (on_ground ? kLatestStartInThicket : latest_start)) continue;
            // A branch of what is right below starts no stem.
            Track track;
            bool is_limb = false;
            for (size_t below = s >= kReach ? s - kReach : 0; below < s; below++)
                for (const Cluster& other : slices[below]) {
                    const double reach = 2.0 * other.radius + cell + rise * static_cast<double>(s - below);
                    if (glm::distance(other.centre, cluster.centre) > reach) continue;
                    if (other.radius > kThicket * height)
                        track.from_thicket = true;
                    else
                        is_limb = true;
                }
            if (is_limb || (start > latest_start && !track.from_thicket)) continue;
            track.clusters.push_back(&cluster);
            tracks.push_back(std::move(track));
        }
    }
    return tracks;
}

// A least-squares line through the lowest slices, down to where the stem starts; false where it leans too
// much. Further up, the slices may hold others' branches, and lead into them.
bool find_foot(const Track& track, const std::vector<Vec3>& points, Stem& stem) {
    DVec3 mean(0.0);
    std::vector<DVec3> centres;
    double squares = 0.0;
    double base = std::numeric_limits<double>::max();
    const size_t last = track.clusters.front()->slice + static_cast<size_t>(kSeed / kSlice);
    const size_t straight = track.clusters.front()->slice + static_cast<size_t>(kStraight / kSlice);
    for (const Cluster* cluster : track.clusters) {
        if (cluster->slice > straight && centres.size() > 2) break;
        double y = 0.0;
        for (const uint32_t i : cluster->points) {
            y += points[i].y;
            base = std::min<double>(base, points[i].y);
        }
        y /= static_cast<double>(cluster->points.size());
        centres.emplace_back(cluster->centre.x, y, cluster->centre.y);
        mean += centres.back();
        if (cluster->slice <= last)
            stem.seed.insert(stem.seed.end(), cluster->points.begin(), cluster->points.end());
    }
    const double n = static_cast<double>(centres.size());
    mean /= n;
    double yy = 0.0;
    DVec2 lean(0.0);
    for (const DVec3& c : centres) {
        yy += (c.y - mean.y) * (c.y - mean.y);
        lean += (c.y - mean.y) * DVec2(c.x - mean.x, c.z - mean.z);
    }
    lean /= yy;
    if (glm::length(lean) > kMostLean) return false;
    stem.lean = lean;
    const DVec2 at = DVec2(centres[0].x, centres[0].z) + (base - centres[0].y) * lean;
    stem.foot = {at.x, base, at.y};
    // Across the axis: a slice of a leaning stem is drawn out.
    for (size_t k = 0; k < centres.size(); k++) {
        double across = 0.0;
        for (const uint32_t i : track.clusters[k]->points) {
            const DVec2 offset = DVec2(points[i].x, points[i].z) - DVec2(centres[k].x, centres[k].z) -
                                 (points[i].y - centres[k].y) * lean;
            across += glm::dot(offset, offset);
        }
        squares += across / static_cast<double>(track.clusters[k]->points.size());
    }
    stem.radius = std::sqrt(squares / n);
    return true;
}

}  // namespace

std::vector<Stem> find_stems(const std::vector<Vec3>& points, const std::vector<float>& above, double height,
                             double spacing, bool on_ground, const Progress* progress) {
    const double cell = std::clamp(1.5 * spacing, 0.01 * height, 0.02 * height);
    const std::vector<std::vector<Cluster>> slices = cut_slices(points, above, height, cell, progress);
    struct Candidate {
        Stem stem;
        bool from_thicket = false;
    };
    std::vector<Candidate> found;
    for (const Track& track : follow_up(slices, height, cell, on_ground)) {
        const size_t span = track.clusters.back()->slice - track.clusters.front()->slice + 1;
        if (static_cast<double>(span) * kSlice < kShortest) continue;
        const double cores = static_cast<double>(std::count_if(
            track.clusters.begin(), track.clusters.end(), [](const Cluster* c) { return c->in_branches; }));
        const double filled = static_cast<double>(track.clusters.size());
        const double least = cores > 0.3 * filled ? kLeastFilledInBranches : kLeastFilled;
        if (filled < least * static_cast<double>(span)) continue;
        Candidate candidate;
        candidate.from_thicket = track.from_thicket;
        candidate.stem.in_branches = track.from_thicket || cores > 0.3 * filled;
        if (!find_foot(track, points, candidate.stem)) continue;
        found.push_back(std::move(candidate));
    }
    // Stems close together at the foot are one tree's, the thicker one's.
    std::stable_sort(found.begin(), found.end(),
                     [](const Candidate& a, const Candidate& b) { return a.stem.radius > b.stem.radius; });
    // A bush may be thicker than any stem, but not most of them.
    if (!found.empty()) {
        const double thick = found[found.size() / 4].stem.radius;
        std::erase_if(found, [&](const Candidate& c) {
            return c.stem.radius < (on_ground ? kThinnest : kThinnestInAir) * thick;
        });
    }
    std::vector<Stem> stems;
    for (Candidate& c : found) {
        Stem* same = nullptr;
        for (Stem& stem : stems) {
            if (stand_together(stem, c.stem, c.from_thicket ? kClosestInThicket : kClosest, height))
                same = &stem;
        }
        c.stem.feet.emplace_back(c.stem.foot.x, c.stem.foot.z);
        if (same)
            take_in(*same, c.stem);
        else
            stems.push_back(std::move(c.stem));
    }
    join_clumps(stems, height);
    return stems;
}

std::vector<Stem> find_tops(const std::vector<Vec3>& points, const std::vector<float>& above, double height,
                            double spacing, const Progress* progress) {
    const std::array<Range, 3> ranges = robust_ranges(points, progress);
    const double cell = std::max(0.02 * height, 0.7 * spacing);
    const int width = static_cast<int>(ranges[0].size() / cell) + 1;
    const int depth = static_cast<int>(ranges[2].size() / cell) + 1;
    if (static_cast<double>(width) * static_cast<double>(depth) > 4e6) return {};
    std::vector<int32_t> top(static_cast<size_t>(width) * static_cast<size_t>(depth), -1);
    for (size_t i = 0; i < points.size(); i++) {
        const Vec3& p = points[i];
        if (!ranges[0].contains(p.x) || !ranges[2].contains(p.z) || !ranges[1].contains(p.y)) continue;
        int32_t& highest = top[static_cast<size_t>(static_cast<int>((p.z - ranges[2].low) / cell) * width +
                                                   static_cast<int>((p.x - ranges[0].low) / cell))];
        if (highest < 0 || above[i] > above[static_cast<size_t>(highest)]) highest = static_cast<int32_t>(i);
    }
    std::vector<Stem> tops;
    for (int z = 0; z < depth; z++) {
        if (progress) progress->check();
        for (int x = 0; x < width; x++) {
            const int32_t i = top[static_cast<size_t>(z * width + x)];
            if (i < 0 || static_cast<double>(above[static_cast<size_t>(i)]) < 0.3 * height) continue;
            const Vec3& p = points[static_cast<size_t>(i)];
            // Crowns are the wider the higher they are (Popescu and Wynne 2004).
            const double reach = 0.12 * static_cast<double>(above[static_cast<size_t>(i)]) + 0.5 * cell;
            const int r = static_cast<int>(std::ceil(reach / cell));
            bool highest = true;
            for (int k = std::max(0, z - r); highest && k <= std::min(depth - 1, z + r); k++)
                for (int j = std::max(0, x - r); highest && j <= std::min(width - 1, x + r); j++) {
                    const int32_t other = top[static_cast<size_t>(k * width + j)];
                    if (other < 0 || other == i) continue;
                    const Vec3& q = points[static_cast<size_t>(other)];
                    if (portable::hypot(q.x - p.x, q.z - p.z) > static_cast<float>(reach)) continue;
                    const float difference =
                        above[static_cast<size_t>(other)] - above[static_cast<size_t>(i)];
                    highest = difference < 0.0F || (difference == 0.0F && other > i);
                }
            if (!highest) continue;
            Stem stem;
            stem.foot = DVec3(p) - DVec3(0.0, above[static_cast<size_t>(i)], 0.0);
            stem.seed.push_back(static_cast<uint32_t>(i));
            tops.push_back(std::move(stem));
        }
    }
    return tops;
}

}  // namespace treerec
