#include "sketch/sketch_branch.h"

#include <algorithm>
#include <cmath>

#include "error.h"
#include "geometry/portable_math.h"
#include "geometry/quantile.h"
#include "sketch/branch_depth.h"
#include "sketch/branch_plane.h"
#include "sketch/branch_statistics.h"
#include "sketch/branch_stroke.h"
#include "sketch/branch_wood.h"
#include "sketch/flat_line.h"
#include "sketch/sketch_axes.h"
#include "sketch/strokes.h"

namespace treerec {

namespace {

constexpr double kLargest = 1e6;    // pixels and, of the camera's place, metres
constexpr double kSamples = 60.0;   // along a stroke
constexpr double kLeastStep = 4.0;  // pixels
constexpr double kMostStep = 12.0;
constexpr double kSmooth = 7.0;        // pixels
constexpr double kAxisStep = 0.05;     // metres
constexpr double kReachJitters = 3.0;  // so far beside the stroke points are looked at, and half the branch
constexpr double kSlopeStretch = 0.4;  // of what was found, its last part, says how the branch goes on,
constexpr double kLeastStretch = 0.3;  // and at least so many metres
constexpr double kSteepest = 1.2;      // radians out of the picture
constexpr double kJointRatio = 0.8;    // Chen 2025, algorithm 5
// By how much more of a path's score another host must be better; one that the stroke does not fall on.
constexpr double kMargin = 1.0, kNearMargin = 2.5;
constexpr double kRadiusSpread = 0.9;  // of the logarithm of a branch's radius over the usual one
constexpr double kClearlyMore = 0.03;  // of the points on its bark
constexpr double kStouterShare = 0.3;  // measured: then its own points tell its radius
constexpr double kOneAxis = 1e-3;
constexpr double kLeastNodeStep = 0.04, kMostNodeStep = 0.4;

bool finite(const DVec2& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::abs(p.x) < kLargest && std::abs(p.y) < kLargest;
}

void require(const Tree& tree, const BranchStroke& stroke, const SketchedBranchOptions& options) {
    if (tree.size() < 2) throw Error("There is no tree to hang a branch on.");
    const PinholeView& view = stroke.view;
    bool right = is_finite(view.centre) && glm::length(view.centre) < 1e9 && std::isfinite(view.focal) &&
                 view.focal > 0.0 && view.focal < kLargest && finite(view.principal) && view.width > 0 &&
                 view.height > 0;
    for (int i = 0; i < 3 && right; i++)
        right = is_finite(view.turn[i]) && std::abs(glm::length(view.turn[i]) - 1.0) < kOneAxis &&
                std::abs(glm::dot(view.turn[i], view.turn[(i + 1) % 3])) < kOneAxis;
    if (!right || !(glm::determinant(view.turn) > 0.0))
        throw Error(
            "The camera of a drawn branch is no camera: its numbers must be finite, and its axes square.");
    if (stroke.points.empty()) throw Error("The stroke has no points: draw along the missing branch.");
    if (stroke.points.size() > kMostStrokePoints)
        throw Error("The stroke has more than " + std::to_string(kMostStrokePoints) + " points.");
    bool inside = false;
    for (const DVec2& p : stroke.points) {
        if (!finite(p)) throw Error("The stroke has a point that is no place in the picture.");
        inside = inside || (p.x >= 0.0 && p.y >= 0.0 && p.x <= view.width && p.y <= view.height);
    }
    if (!inside) throw Error("The stroke lies outside of the picture.");
    if (!(options.jitter > 0.0 && options.jitter <= 100.0))
        throw Error("The jitter of a stroke is above 0 and at most 100 pixels.");
    if (!(options.tolerance > 0.0 && options.tolerance <= 1.0))
        throw Error("The tolerance of a drawn branch is above 0 and at most 1 metre.");
}

// The stroke in space, from one host.
struct Lifted {
    std::vector<BranchPlace> axis;
    double score = 0.0;
    double stouter = 1.0;  // than branches of its length are
};

struct Lift {
    const Tree& tree;
    const BranchStatistics& statistics;
    const PinholeView& view;
    const std::vector<DVec2>& line;
    const std::vector<Vec3>& points;
    const RadiusLaw& law;
    double jitter;
    const Progress* progress;

    Lifted from(const BranchHost& host) const {
        const DVec3 joint = tree.node(host.node).position;
        const BranchPath path = find_path(points, view, line, joint, jitter, progress);
        Lifted lifted;
        lifted.score = path.score;
        const double most = 2.0 * tree.bounds().diagonal();
        if (path.stops.empty()) {
            const double slope = likely_slope(tree, statistics, view, host.node, line);
            const BranchPlane plane(into_camera(view, joint), line.back() - line.front(), slope);
            lifted.axis.push_back({joint, 0.0, false});
            for (size_t i = 1; i < line.size(); i++)
                lifted.axis.push_back({out_of_camera(view, plane.meet(view, line[i], most)), 0.0, false});
            return lifted;
        }
        PathRadius radius{law};
        radius.covered = static_cast<double>(path.stops.back().sample) / static_cast<double>(line.size() - 1);
        double length = glm::distance(joint, path.stops.front().place);
        for (size_t i = 1; i < path.stops.size(); i++)
            length += glm::distance(path.stops[i].place, path.stops[i - 1].place);
        radius.base = std::min(law.base_radius(length / std::max(radius.covered, 0.1)),
                               kJointRatio * tree.node(host.node).radius);
        // A branch may be stouter than its siblings: of the radii tried, the one whose bark has the points.
        const double most_radius = kJointRatio * tree.node(host.node).radius;
        const double usual = radius.base;
        std::vector<DVec3> found;
        double best = -1.0;
        for (const double factor : {1.0, 0.7, 1.4, 2.0, 2.8}) {
            PathRadius tried = radius;
            tried.base = std::min(factor * usual, most_radius);
            if (factor > 1.0 && tried.base < 1.2 * usual) break;
            std::vector<DVec3> centred = centre_path(points, joint, path, kAxisStep, tried, progress);
            const double unusual = portable::log(factor) / kRadiusSpread;
            const double share = bark_share(points, centred, tried) * portable::exp(-0.5 * unusual * unusual);
            if (share <= best + kClearlyMore) continue;
            best = share;
            found = std::move(centred);
            radius.base = tried.base;
        }
        lifted.stouter = radius.base / usual;
        const std::vector<uint8_t> shown = shown_places(points, found, radius);
        for (size_t i = 0; i < found.size(); i++)
            lifted.axis.push_back({found[i], 0.0, i > 0 && shown[i] != 0});
        go_on(lifted, path, most);
        return lifted;
    }

    // Beyond the last stop: in the plane that what was found last lies in.
    void go_on(Lifted& lifted, const BranchPath& path, double most) const {
        const size_t last = path.stops.back().sample;
        if (last + 1 >= line.size()) return;
        std::vector<DVec3> found;
        for (const BranchPlace& place : lifted.axis)
            found.push_back(place.position);
        const double length = length_of(found);
        const double stretch = std::min(length, std::max(kLeastStretch, kSlopeStretch * length));
        const DVec3 end = into_camera(view, found.back());
        const DVec3 before = into_camera(view, place_along(found, length - stretch));
        const DVec3 way = end - before;
        double slope = std::atan2(-way.z, std::max(std::hypot(way.x, way.y), 1e-9));
        slope = std::clamp(slope, -kSteepest, kSteepest);
        const auto pixel = view.project(found.back());
        if (!pixel) return;
        const DVec2 along = line.back() - line[last];
        if (!(glm::length(along) > 1e-6)) return;
        const BranchPlane plane(end, along, slope);
        // The stroke lies beside what was found; the difference fades.
        const DVec2 beside = *pixel - line[last];
        for (size_t i = last + 1; i < line.size(); i++) {
            const double fade = std::max(0.0, 1.0 - static_cast<double>(i - last) / 6.0);
            lifted.axis.push_back(
                {out_of_camera(view, plane.meet(view, line[i] + beside * fade, most)), 0.0, false});
        }
    }
};

// As far apart as the nodes of the tree's own branches are.
double node_step(const Tree& tree) {
    std::vector<double> steps;
    for (const NodeId id : tree.depth_first())
        if (tree.node(id).parent != kNoNode && !tree.node(id).is_trunk())
            steps.push_back(glm::distance(tree.node(id).position, tree.node(tree.node(id).parent).position));
    return steps.empty() ? 0.1 : std::clamp(quantile(steps, 0.5), kLeastNodeStep, kMostNodeStep);
}

}  // namespace

SketchedBranch sketch_branch(const Tree& tree, const PointCloud* cloud, const BranchStroke& stroke,
                             const SketchedBranchOptions& options, const std::vector<uint8_t>& wood,
                             Progress* listener) {
    require(tree, stroke, options);
    SubProgress progress(listener, 0.0, 1.0);
    progress.update(0.0, "Branch");
    const BranchStatistics statistics(tree);
    HungStroke hung = hang_stroke(tree, statistics, stroke, options.jitter, &progress);
    const PinholeView& view = stroke.view;
    const double pixels = line_length(hung.points);
    const double step = std::clamp(pixels / kSamples, kLeastStep, kMostStep);
    const std::vector<DVec2> line = even_stroke(hung.points, step, kSmooth);

    const BranchHost& likeliest = hung.hosts.front();
    const int32_t bearing = statistics.list().branch_of[static_cast<size_t>(likeliest.child)];
    const int32_t order = statistics.list().branches[static_cast<size_t>(bearing)].order + 1;
    const RadiusLaw law = statistics.radius_law(order);
    const double thick =
        view.focal / likeliest.depth * law.base_radius(line_length(line) * likeliest.depth / view.focal);
    std::vector<Vec3> points;
    if (cloud && cloud->size() > 0) {
        progress.update(0.2, "Branch");
        const double widest = view.focal / likeliest.depth * tree.node(likeliest.node).radius;
        points =
            points_beside(tree, *cloud, wood, view, line,
                          kReachJitters * options.jitter + std::max(thick, std::min(3.0 * thick, widest)),
                          options.tolerance, &progress);
    }
    progress.update(0.5, "Branch");
    const Lift lift{tree, statistics, view, line, points, law, options.jitter + 0.5 * thick, &progress};
    const BranchHost* host = &hung.hosts.front();
    Lifted lifted;
    for (const BranchHost& one : hung.hosts) {
        if (&one != &hung.hosts.front() && points.empty()) break;
        Lifted tried = lift.from(one);
        const double margin = host->on && !one.on ? kNearMargin : kMargin;
        if (&one != &hung.hosts.front() && !(tried.score > lifted.score + margin)) continue;
        lifted = std::move(tried);
        host = &one;
    }

    SketchedBranch branch;
    branch.host = host->node;
    const double stouter = lifted.stouter;
    branch.axis = std::move(lifted.axis);
    branch.remarks = std::move(hung.remarks);
    for (size_t i = 1; i < branch.axis.size(); i++) {
        const double part = glm::distance(branch.axis[i].position, branch.axis[i - 1].position);
        branch.length += part;
        if (branch.axis[i].measured) branch.measured += part;
    }
    if (!(branch.length > 1e-6))
        throw Error("The stroke is too short to be a branch: draw it along the whole branch.");
    branch.measured /= branch.length;
    set_branch_radii(branch.axis, law, branch.measured > kStouterShare ? stouter : 1.0,
                     tree.node(branch.host).radius);
    if (branch.measured <= 0.0)
        branch.remarks.emplace_back(
            cloud && cloud->size() > 0
                ? "No points of the scan lie along the stroke that the tree lacks: how far the branch "
                  "reaches "
                  "towards the camera or away from it is guessed from the tree's other branches."
                : "There is no scan: how far the branch reaches towards the camera or away from it is "
                  "guessed "
                  "from the tree's other branches.");
    progress.update(0.8, "Twigs");
    std::vector<TwigOnBranch> twigs;
    if (options.twigs) twigs = draw_twigs(statistics, order, branch.axis, options.seed);
    branch.twigs = twigs.size();
    branch.scion = branch_scion(tree, branch.host, branch.axis, twigs, node_step(tree));
    branch.command = graft_command(branch.host, branch.scion, &progress);
    progress.update(1.0, "Twigs");
    return branch;
}

}  // namespace treerec
