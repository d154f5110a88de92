#include "sketch/branch_wood.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "edit/graft/scion.h"
#include "geometry/portable_math.h"
#include "geometry/quantile.h"
#include "geometry/random.h"
#include "lsystem/lstring.h"
#include "sketch/sketch_axes.h"

namespace treerec {

namespace {

constexpr double kJointRatio = 0.8;  // Chen 2025, algorithm 5
constexpr double kLeastScale = 0.5, kMostScale = 1.5;
constexpr size_t kMostNodes = 2000;     // of one twig
constexpr size_t kMostTwigs = 400;      // on a branch
constexpr size_t kNeighbours = 6;       // twigs of about that share that one is drawn from
constexpr double kTwigThickness = 0.9;  // of the axis where it stands, at most

// The value below which the share q lies, between two linearly. values: ascending, not empty.
double quantile_of(const std::vector<double>& values, double q) {
    const double at =
        std::clamp(q * static_cast<double>(values.size()) - 0.5, 0.0, static_cast<double>(values.size() - 1));
    const size_t i = static_cast<size_t>(at);
    const size_t k = std::min(i + 1, values.size() - 1);
    return values[i] + (values[k] - values[i]) * (at - static_cast<double>(i));
}

void shuffle(std::vector<double>& values, Random& random) {
    for (size_t i = values.size(); i > 1; i--)
        std::swap(values[i - 1], values[random.below(static_cast<uint32_t>(i))]);
}

struct Donor {
    SideBranch side;
    double branch_length;
    double length;
};

double middle(std::vector<double> values) {
    return quantile(values, 0.5);
}

// How far apart twigs follow each other, from the base on: as many as `room` metres hold.
std::vector<double> internodes(std::vector<double> known, double room, Random& random) {
    std::sort(known.begin(), known.end());
    const double mean = std::accumulate(known.begin(), known.end(), 0.0) / static_cast<double>(known.size());
    if (!(mean > 0.0)) return {};
    const auto count = std::min(kMostTwigs, static_cast<size_t>(std::max(0.0, std::floor(room / mean))));
    std::vector<double> drawn;
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) {
        drawn.push_back(quantile_of(known, (static_cast<double>(i) + 0.5) / static_cast<double>(count)));
        sum += drawn.back();
    }
    // Long ones must not be the ones that find no room.
    if (sum > room)
        for (double& one : drawn)
            one *= room / sum;
    shuffle(drawn, random);
    return drawn;
}

}  // namespace

void set_branch_radii(std::vector<BranchPlace>& axis, const RadiusLaw& law, double stouter,
                      double host_radius) {
    std::vector<DVec3> line;
    for (const BranchPlace& place : axis)
        line.push_back(place.position);
    const std::vector<double> radii = law.radii_along(line, stouter, kJointRatio * host_radius);
    for (size_t i = 0; i < axis.size(); i++)
        axis[i].radius = radii[i];
}

std::vector<TwigOnBranch> draw_twigs(const BranchStatistics& statistics, int32_t order,
                                     const std::vector<BranchPlace>& axis, uint64_t seed) {
    std::vector<DVec3> line;
    std::vector<double> radii;
    for (const BranchPlace& place : axis) {
        line.push_back(place.position);
        radii.push_back(place.radius);
    }
    const double length = length_of(line);
    const std::vector<int32_t> side_branches = statistics.kindred(order, radii.front());
    std::vector<Donor> donors;
    std::vector<double> bare, between, angles;
    int32_t like = -1;
    double unlike = 1e300;
    for (const int32_t side_branch : side_branches) {
        const double whole = statistics.list().branches[static_cast<size_t>(side_branch)].length;
        const std::vector<SideBranch>& sides = statistics.sides(side_branch);
        for (const SideBranch& side : sides) {
            const double own = statistics.list().branches[static_cast<size_t>(side.branch)].length;
            donors.push_back({side, whole, own});
            angles.push_back(side.angle);
            if (side.first)
                bare.push_back(side.share);
            else
                between.push_back(side.internode);
        }
        const double off = std::abs(portable::log(whole / length)) + 1.0 / static_cast<double>(sides.size());
        if (off < unlike) {
            unlike = off;
            like = side_branch;
        }
    }
    if (donors.empty()) return {};
    Random random(hash_seed(seed, 28), 3);
    const double first = std::min(0.9, middle(bare)) * length;
    std::vector<double> places{first};
    if (!between.empty())
        for (const double step : internodes(between, 0.98 * length - first, random))
            places.push_back(places.back() + step);

    // Donors by the share of their branch, each place drawing from those around it.
    std::stable_sort(donors.begin(), donors.end(),
                     [](const Donor& a, const Donor& b) { return a.side.share < b.side.share; });
    std::vector<TwigOnBranch> twigs;
    std::vector<double> own_angles;
    const std::vector<SideBranch>& pattern = statistics.sides(like);
    const double side = random.below(2) == 0 ? 1.0 : -1.0;
    for (size_t i = 0; i < places.size(); i++) {
        const double share = places[i] / length;
        const auto at = std::lower_bound(donors.begin(), donors.end(), share,
                                         [](const Donor& d, double s) { return d.side.share < s; });
        const size_t from = static_cast<size_t>(std::max<std::ptrdiff_t>(
            0,
            std::min(at - donors.begin() - static_cast<std::ptrdiff_t>(kNeighbours / 2),
                     static_cast<std::ptrdiff_t>(donors.size()) - static_cast<std::ptrdiff_t>(kNeighbours))));
        const size_t count = std::min(kNeighbours, donors.size() - from);
        const double room = kTwigThickness * value_along(line, radii, places[i]);
        // The one drawn, unless it had to shrink more than another.
        const size_t drawn = random.below(static_cast<uint32_t>(count));
        const Donor* best = nullptr;
        double best_scale = 0.0;
        for (size_t k = 0; k < count; k++) {
            const Donor& donor = donors[from + (drawn + k) % count];
            const double wanted = std::clamp(length / donor.branch_length, kLeastScale, kMostScale);
            const double scale = std::min(wanted, room / statistics.base_radius(donor.side.branch));
            if (best && scale <= best_scale) continue;
            best = &donor;
            best_scale = scale;
            if (scale >= std::min(1.0, wanted)) break;
        }
        TwigOnBranch twig;
        twig.along = places[i];
        twig.child =
            statistics.list().nodes_of(statistics.list().branches[static_cast<size_t>(best->side.branch)])[0];
        twig.scale = best_scale;
        twig.azimuth = side * pattern[i * pattern.size() / places.size()].azimuth;
        own_angles.push_back(best->side.angle);
        twigs.push_back(twig);
    }
    std::sort(angles.begin(), angles.end());
    std::vector<size_t> ranks(twigs.size());
    std::iota(ranks.begin(), ranks.end(), size_t{0});
    std::stable_sort(ranks.begin(), ranks.end(),
                     [&](size_t a, size_t b) { return own_angles[a] < own_angles[b]; });
    for (size_t r = 0; r < ranks.size(); r++)
        twigs[ranks[r]].angle =
            quantile_of(angles, (static_cast<double>(r) + 0.5) / static_cast<double>(ranks.size()));
    return twigs;
}

namespace {

// Puts the twig of the tree onto a node of the branch that is being made, so that it leaves as it was drawn.
void place_twig(Tree& side_branch, NodeId joint, const Tree& tree, const TwigOnBranch& twig,
                const DMat3& frame) {
    Tree scion = take_scion(tree, twig.child);
    if (scion.size() > kMostNodes) return;
    const DVec3 own = scion_direction(scion);
    const DVec3 ahead(0.0, 1.0, 0.0);
    // About the twig's own parent it turns to the drawn azimuth, then it opens to the drawn angle.
    const double azimuth = portable::atan2(own.x, own.z);
    const DMat3 roll = turn_about(ahead, twig.azimuth - azimuth);
    const DVec3 side(portable::sin(twig.azimuth), 0.0, portable::cos(twig.azimuth));
    const double angle = portable::atan2(portable::hypot(own.x, own.z), own.y);
    const DMat3 open = turn_about(glm::cross(ahead, side), twig.angle - angle);
    place_scion(side_branch, joint, scion, {frame * open * roll, twig.scale});
}

}  // namespace

Tree branch_scion(const Tree& tree, NodeId host, const std::vector<BranchPlace>& axis,
                  const std::vector<TwigOnBranch>& twigs, double step) {
    std::vector<DVec3> line;
    std::vector<double> radii;
    std::vector<double> until{0.0};
    for (const BranchPlace& place : axis) {
        if (!line.empty()) until.push_back(until.back() + glm::distance(line.back(), place.position));
        line.push_back(place.position);
        radii.push_back(place.radius);
    }
    const double length = until.back();
    const auto count = static_cast<size_t>(std::max(2.0, std::round(length / step)));
    // Nodes where twigs leave, and between them where none is near.
    std::vector<double> places;
    for (const TwigOnBranch& twig : twigs)
        if (places.empty() || twig.along - places.back() > 1e-6) places.push_back(twig.along);
    const std::vector<double> forks = places;
    for (size_t i = 1; i <= count; i++) {
        const double at = length * static_cast<double>(i) / static_cast<double>(count);
        const auto next = std::lower_bound(forks.begin(), forks.end(), at);
        const bool crowded = (next != forks.end() && *next - at < 0.3 * step) ||
                             (next != forks.begin() && at - *(next - 1) < 0.3 * step);
        if (!crowded || i == count) places.push_back(at);
    }
    std::sort(places.begin(), places.end());

    Tree side_branch;
    const Node& stem_base = tree.node(host);
    NodeId at = side_branch.add_root(DVec3(0.0), radii.front());
    const DVec3 forward = direction_at(tree, host);
    const DMat3 into = glm::transpose(frame_about(forward));
    std::vector<NodeId> nodes;
    for (const double place : places) {
        const size_t next = std::min(
            line.size() - 1,
            static_cast<size_t>(std::lower_bound(until.begin(), until.end(), place - 1e-9) - until.begin()));
        const uint8_t flags = axis[next].measured ? 0 : kGuessFlag;
        at = side_branch.add_child(at, into * (place_along(line, place) - stem_base.position),
                                   std::min(value_along(line, radii, place), side_branch.node(at).radius),
                                   flags);
        nodes.push_back(at);
    }
    DVec3 way(0.0, 1.0, 0.0);
    size_t twig = 0;
    NodeId before = side_branch.root();
    for (size_t i = 0; i < nodes.size(); i++) {
        way = normalized_or(side_branch.node(nodes[i]).position - side_branch.node(before).position, way);
        // Up is the tree's, the scion's axes are the host's.
        const DMat3 frame = into * frame_about(glm::transpose(into) * way);
        for (; twig < twigs.size() && twigs[twig].along <= places[i] + 1e-6; twig++)
            place_twig(side_branch, nodes[i], tree, twigs[twig], frame);
        before = nodes[i];
    }
    return side_branch;
}

std::string graft_command(NodeId host, const Tree& scion, const Progress* progress) {
    LStringOptions options;
    return "graft node=" + std::to_string(host) +
           " aim=own scale=factor factor=1 angle=0 stretch=0 smooth=no" + " string=\"" +
           write_lstring(scion, scion.root(), options, progress) + "\"";
}

}  // namespace treerec
