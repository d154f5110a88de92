#include "fidelity/fidelity.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "edit/lighten/lighten.h"
#include "error.h"
#include "fidelity/fidelity_parts.h"
#include "geometry/capsule_tree.h"
#include "geometry/parallel.h"
#include "tree/wood_segments.h"

namespace treerec {

namespace {

constexpr size_t kChunk = 512;

// Where most of the wood changed, all of it is measured.
constexpr double kMostChanged = 0.5;

bool same(const WoodSegment& a, const WoodSegment& b) {
    return a.from == b.from && a.to == b.to && a.radius == b.radius && a.from_radius == b.from_radius;
}

}  // namespace

struct FidelityTracker::State {
    FidelityOptions options;
    PointCloud cloud;  // positions and frame alone
    ScanFrame frame;   // of the tree that `points` are in
    std::vector<DVec3> points;
    // By point.
    std::vector<BarkHit> bark;   // segment: of no use between updates
    std::vector<NodeId> within;  // whose solid holds it with the tolerance, or kNoNode
    std::vector<NodeId> inside;  // whose solid holds it without
    // By child's id: the segments that these figures are of; child kNoNode where there is none.
    std::vector<WoodSegment> wood;
    Fidelity current;
    std::optional<Fidelity> previous;
    bool measured = false;
    size_t anew = 0;

    // What changed since the last update: segments that are new or moved, and whose old ones are gone.
    struct Change {
        std::vector<WoodSegment> fresh;
        std::vector<uint8_t> stale;  // by child's id
        size_t gone = 0;
    };
    Change change_to(const std::vector<WoodSegment>& segments) const;
    void enter(const ScanFrame& target);
    void measure_all(const CapsuleTree& all, const Progress* progress);
    void measure_changed(const CapsuleTree& all, const Change& change, const Progress* progress);
};

FidelityTracker::State::Change FidelityTracker::State::change_to(
    const std::vector<WoodSegment>& segments) const {
    Change change;
    change.stale.assign(wood.size(), 0);
    std::vector<uint8_t> kept(wood.size(), 0);
    for (const WoodSegment& segment : segments) {
        const size_t id = static_cast<size_t>(segment.child);
        if (id < wood.size() && wood[id].child != kNoNode && same(wood[id], segment))
            kept[id] = 1;
        else
            change.fresh.push_back(segment);
    }
    for (size_t id = 0; id < wood.size(); id++) {
        change.stale[id] = wood[id].child != kNoNode && !kept[id];
        change.gone += change.stale[id];
    }
    return change;
}

void FidelityTracker::State::enter(const ScanFrame& target) {
    frame = target;
    points.resize(cloud.size());
    const bool as_it_is = cloud.frame == target;
    for (size_t i = 0; i < points.size(); i++) {
        const DVec3 p(cloud.positions[i]);
        points[i] = as_it_is ? p : target.to_tree(cloud.frame.to_scan(p));
    }
}

void FidelityTracker::State::measure_all(const CapsuleTree& all, const Progress* progress) {
    bark.assign(points.size(), {});
    within.assign(points.size(), kNoNode);
    inside.assign(points.size(), kNoNode);
    anew = points.size();
    parallel_for(points.size(), kChunk, [&](size_t begin, size_t end) {
        if (progress) progress->check();
        int32_t hint = -1;
        for (size_t i = begin; i < end; i++) {
            BarkHit hit;
            if (hint >= 0) hit = {all.segment(hint).child, bark_error(all.segment(hint), points[i]), hint};
            all.find_bark(points[i], hit);
            hint = hit.segment;
            bark[i] = hit;
            const int32_t holds = all.find_solid(points[i], options.tolerance, hint);
            if (holds < 0) continue;
            within[i] = all.segment(holds).child;
            const int32_t strictly = all.find_solid(points[i], 0.0, holds);
            if (strictly >= 0) inside[i] = all.segment(strictly).child;
        }
    });
}

void FidelityTracker::State::measure_changed(const CapsuleTree& all, const Change& change,
                                             const Progress* progress) {
    const CapsuleTree fresh(change.fresh);
    const auto stale = [&](NodeId id) { return id != kNoNode && change.stale[static_cast<size_t>(id)] != 0; };
    std::vector<uint8_t> touched(points.size(), 0);
    parallel_for(points.size(), kChunk, [&](size_t begin, size_t end) {
        if (progress) progress->check();
        int32_t hint = -1;
        for (size_t i = begin; i < end; i++) {
            const DVec3& p = points[i];
            BarkHit& hit = bark[i];
            if (stale(hit.child)) {
                hit = {};
                if (hint >= 0) hit = {all.segment(hint).child, bark_error(all.segment(hint), p), hint};
                all.find_bark(p, hit);
                hint = hit.segment;
                touched[i] = 1;
            } else {
                hit.segment = -1;
                fresh.find_bark(p, hit);
                touched[i] = hit.segment >= 0;
            }
            for (const auto& [holder, tolerance] :
                 {std::pair(&within[i], options.tolerance), std::pair(&inside[i], 0.0)}) {
                const bool again = stale(*holder);
                if (*holder != kNoNode && !again) continue;
                const CapsuleTree& where = again ? all : fresh;
                const int32_t holds = where.find_solid(p, tolerance);
                *holder = holds < 0 ? kNoNode : where.segment(holds).child;
                touched[i] |= again || holds >= 0;
            }
        }
    });
    anew = static_cast<size_t>(std::count(touched.begin(), touched.end(), uint8_t{1}));
}

FidelityTracker::FidelityTracker(const PointCloud& cloud, const FidelityOptions& options)
    : state_(std::make_unique<State>()) {
    if (cloud.empty()) throw Error("The point cloud is empty; there is nothing to measure the tree against.");
    if (!(options.tolerance >= 0.0 && options.tolerance <= 10.0))
        throw Error("The tolerance of a fidelity is 0 to 10 metres.");
    if (!(options.patch >= 0.001 && options.patch <= 10.0))
        throw Error("The pieces of bark that a fidelity looks at are 1 mm to 10 m long.");
    state_->options = options;
    state_->cloud.frame = cloud.frame;
    state_->cloud.positions = cloud.positions;
}

FidelityTracker::~FidelityTracker() = default;
FidelityTracker::FidelityTracker(FidelityTracker&&) noexcept = default;
FidelityTracker& FidelityTracker::operator=(FidelityTracker&&) noexcept = default;

const Fidelity& FidelityTracker::update(const Tree& tree, const Progress* progress) {
    State& state = *state_;
    std::vector<WoodSegment> segments = wood_segments(tree);
    if (segments.empty()) throw Error("The tree has no wood: it needs at least two nodes.");
    const bool whole = !state.measured || state.frame != tree.frame();
    State::Change change;
    if (!whole) change = state.change_to(segments);
    const double changed = static_cast<double>(change.fresh.size() + change.gone);
    const CapsuleTree all(segments);
    // Stopped on the way, the next one begins anew.
    state.measured = false;
    if (whole || changed > kMostChanged * static_cast<double>(segments.size())) {
        if (whole) state.enter(tree.frame());
        state.measure_all(all, progress);
    } else if (changed > 0.0) {
        state.measure_changed(all, change, progress);
    } else {
        state.anew = 0;
    }
    Fidelity next =
        sum_up(tree, {state.points, state.bark, state.within, state.inside}, state.options, progress);
    state.wood.assign(static_cast<size_t>(tree.id_end()), {});
    for (const WoodSegment& segment : segments)
        state.wood[static_cast<size_t>(segment.child)] = segment;
    if (state.current.points > 0) state.previous = std::move(state.current);
    state.current = std::move(next);
    state.measured = true;
    return state.current;
}

const Fidelity& FidelityTracker::current() const {
    return state_->current;
}

const std::optional<Fidelity>& FidelityTracker::previous() const {
    return state_->previous;
}

size_t FidelityTracker::points_measured() const {
    return state_->anew;
}

bool Fidelity::explains(size_t point) const {
    return std::abs(static_cast<double>(point_error[point])) <= tolerance;
}

double modelling_fidelity(const PhotoFidelity& photos, const Fidelity& fidelity) {
    return photos.information * photos.reconstruction * fidelity.skeleton;
}

Fidelity measure_fidelity(const Tree& tree, const PointCloud& cloud, const FidelityOptions& options,
                          const Progress* progress) {
    FidelityTracker tracker(cloud, options);
    return tracker.update(tree, progress);
}

std::vector<LevelFidelity> measure_levels(const Tree& tree, const PointCloud& cloud, int levels,
                                          const FidelityOptions& options, const Progress* progress) {
    FidelityTracker tracker(cloud, options);
    std::vector<LevelFidelity> result;
    Tree lighter = tree;
    for (int level = 0; level < levels; level++) {
        if (level > 0) {
            const size_t before = lighter.size();
            LightenOptions target;
            target.nodes = std::max<size_t>(2, tree.size() >> level);
            lighten(lighter, target, progress);
            if (lighter.size() >= before) break;
        }
        const Fidelity& fidelity = tracker.update(lighter, progress);
        result.push_back({lighter.size(), fidelity.skeleton, fidelity.all});
    }
    return result;
}

}  // namespace treerec
