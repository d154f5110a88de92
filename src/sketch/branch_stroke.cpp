#include "sketch/branch_stroke.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "error.h"
#include "geometry/portable_math.h"
#include "geometry/segment.h"
#include "sketch/clean.h"

namespace treerec {

namespace {

constexpr double kReach = 0.15;  // of the stroke's length, to the nearest wood (Ma and Liu 2020, 2.2)
constexpr double kTailShare = 0.25;
constexpr double kBears = 0.75;  // of the base radius that a branch of its length has: a host's least
constexpr double kAlike = 0.5;   // of the thickest wood's radius: may hide it
constexpr double kClearly = 1.5;
constexpr size_t kMostHosts = 4;

double along_segment(const DVec2& p, const DVec2& a, const DVec2& b) {
    const DVec2 ab = b - a;
    const double square = glm::dot(ab, ab);
    return square > 0.0 ? std::clamp(glm::dot(p - a, ab) / square, 0.0, 1.0) : 0.0;
}

// A segment of wood as the camera sees it.
struct SeenWood {
    NodeId child;
    int32_t branch;
    DVec2 from, to;
    double from_depth, to_depth;
    double radius;  // metres
};

// An end of the stroke beside a segment.
struct Fall {
    size_t wood = 0;
    double part = 0.0;   // along the segment, 0..1
    double apart = 0.0;  // pixels outside of its outline; 0 on it
    double depth = 0.0;
};

class Picture {
  public:
    Picture(const Tree& tree, const BranchStatistics& statistics, const PinholeView& view,
            const Progress* progress)
        : focal_(view.focal) {
        const DMat3 into = glm::transpose(view.turn);
        size_t count = 0;
        for (const NodeId id : tree.depth_first()) {
            if (progress && (++count & 0xfff) == 0) progress->check();
            const Node& node = tree.node(id);
            if (node.parent == kNoNode) continue;
            const DVec3& below = tree.node(node.parent).position;
            const auto from = view.project(below), to = view.project(node.position);
            if (!from || !to) continue;
            wood_.push_back({id, statistics.list().branch_of[static_cast<size_t>(id)], *from, *to,
                             -(into * (below - view.centre)).z, -(into * (node.position - view.centre)).z,
                             node.radius});
        }
    }

    bool empty() const { return wood_.empty(); }
    const SeenWood& wood(size_t i) const { return wood_[i]; }
    size_t size() const { return wood_.size(); }
    double metres_per_pixel(double depth) const { return depth / focal_; }

    Fall fall(const DVec2& p, size_t i) const {
        const SeenWood& seen = wood_[i];
        Fall fall;
        fall.wood = i;
        fall.part = along_segment(p, seen.from, seen.to);
        const DVec2 at = seen.from + (seen.to - seen.from) * fall.part;
        // Depth is not linear in the picture, but its inverse is.
        fall.depth =
            1.0 / (1.0 / seen.from_depth + (1.0 / seen.to_depth - 1.0 / seen.from_depth) * fall.part);
        fall.apart = std::max(0.0, glm::length(p - at) - focal_ * seen.radius / fall.depth);
        return fall;
    }

  private:
    double focal_;
    std::vector<SeenWood> wood_;
};

// The wood that one end of the stroke may hang on.
struct EndWood {
    bool on = false;  // it falls on it
    double apart = std::numeric_limits<double>::max();
    double thickest = 0.0;    // metres
    std::vector<Fall> falls;  // of distinct branches, the likeliest first
};

EndWood wood_at(const Picture& picture, const RadiusLaw& law, const DVec2& end, double length,
                double jitter) {
    EndWood found;
    // Wood that could bear the branch, else any.
    for (const bool strict : {true, false}) {
        std::vector<Fall> falls;
        for (size_t i = 0; i < picture.size(); i++) {
            const Fall fall = picture.fall(end, i);
            if (fall.apart > std::max(jitter, kReach * length)) continue;
            const double side_branch = law.base_radius(length * picture.metres_per_pixel(fall.depth));
            if (strict && picture.wood(i).radius < kBears * side_branch) continue;
            falls.push_back(fall);
        }
        if (falls.empty()) continue;
        for (const Fall& fall : falls)
            found.apart = std::min(found.apart, fall.apart);
        found.on = found.apart <= jitter;
        // Of each branch the nearest place to the end.
        std::stable_sort(falls.begin(), falls.end(),
                         [](const Fall& a, const Fall& b) { return a.apart < b.apart; });
        std::vector<Fall> best;
        for (const Fall& fall : falls) {
            const int32_t branch = picture.wood(fall.wood).branch;
            if (std::none_of(best.begin(), best.end(),
                             [&](const Fall& f) { return picture.wood(f.wood).branch == branch; }))
                best.push_back(fall);
        }
        // Those that it falls on, the one in front first, go before those that are only near.
        const auto on_end = std::find_if(best.begin(), best.end(),
                                         [&](const Fall& fall) { return found.on && fall.apart > jitter; });
        std::vector<Fall> on(best.begin(), found.on ? on_end : best.begin());
        for (const Fall& fall : found.on ? on : best)
            found.thickest = std::max(found.thickest, picture.wood(fall.wood).radius);
        const auto thin = [&](const Fall& fall) {
            return picture.wood(fall.wood).radius < kAlike * found.thickest;
        };
        std::erase_if(on, thin);
        std::stable_sort(on.begin(), on.end(),
                         [](const Fall& a, const Fall& b) { return a.depth < b.depth; });
        for (auto near = found.on ? on_end : best.begin(); near != best.end(); ++near)
            on.push_back(*near);
        best = on;
        if (best.size() > kMostHosts) best.resize(kMostHosts);
        found.falls = best;
        break;
    }
    return found;
}

// Where on its way from a to b the line crosses that from c to d, 0..1.
std::optional<double> crossing(const DVec2& a, const DVec2& b, const DVec2& c, const DVec2& d) {
    const DVec2 u = b - a, v = d - c, w = c - a;
    const double area = u.x * v.y - u.y * v.x;
    if (std::abs(area) < 1e-12) return std::nullopt;
    const double s = (w.x * v.y - w.y * v.x) / area;
    const double t = (w.x * u.y - w.y * u.x) / area;
    if (s < 0.0 || s > 1.0 || t < 0.0 || t > 1.0) return std::nullopt;
    return s;
}

struct Cut {
    DVec2 at{0.0};
    double along = 0.0;  // pixels from the stroke's first point
    size_t next = 0;     // the stroke's first point beyond it
    size_t wood = 0;
};

// The last crossing of the stroke, from its first point to `until` pixels on, with wood that `counts`.
template <typename Counts>
std::optional<Cut> last_crossing(const std::vector<DVec2>& points, const Picture& picture, double until,
                                 const Counts& counts) {
    std::optional<Cut> found;
    double along = 0.0;
    for (size_t i = 1; i < points.size() && along <= until; i++) {
        const DVec2 &a = points[i - 1], &b = points[i];
        const double step = glm::length(b - a);
        for (size_t k = 0; k < picture.size(); k++) {
            const SeenWood& seen = picture.wood(k);
            if (std::max(seen.from.x, seen.to.x) < std::min(a.x, b.x) ||
                std::min(seen.from.x, seen.to.x) > std::max(a.x, b.x) ||
                std::max(seen.from.y, seen.to.y) < std::min(a.y, b.y) ||
                std::min(seen.from.y, seen.to.y) > std::max(a.y, b.y) || !counts(k))
                continue;
            const auto s = crossing(a, b, seen.from, seen.to);
            if (!s || along + *s * step > until) continue;
            if (!found || along + *s * step > found->along)
                found = Cut{a + (b - a) * *s, along + *s * step, i, k};
        }
        along += step;
    }
    return found;
}

void cut_tail(std::vector<DVec2>& points, const Cut& cut) {
    points.erase(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(cut.next));
    points.insert(points.begin(), cut.at);
}

}  // namespace

std::vector<DVec2> clean_stroke(const std::vector<DVec2>& points) {
    const FlatLine kept = thin_line(points, kLeastSpacing);
    return smooth_line(kept, std::vector<bool>(kept.size(), false));
}

std::vector<DVec2> even_stroke(const std::vector<DVec2>& points, double step, double smooth) {
    std::vector<double> along{0.0};
    for (size_t i = 1; i < points.size(); i++)
        along.push_back(along.back() + glm::length(points[i] - points[i - 1]));
    const double length = along.back();
    const auto count = static_cast<size_t>(std::max(2.0, std::round(length / step)));
    std::vector<DVec2> even;
    for (size_t i = 0; i <= count; i++) {
        const double at = length * static_cast<double>(i) / static_cast<double>(count);
        double w = 0.0, wx = 0.0, wxx = 0.0;
        DVec2 y(0.0), xy(0.0);
        for (size_t k = 0; k < points.size(); k++) {
            const double x = along[k] - at;
            if (std::abs(x) > 3.0 * smooth) continue;
            const double weight = portable::exp(-0.5 * (x / smooth) * (x / smooth));
            w += weight;
            wx += weight * x;
            wxx += weight * x * x;
            y += points[k] * weight;
            xy += points[k] * (weight * x);
        }
        const double spread = w * wxx - wx * wx;
        if (spread > 1e-6 * w * w) {
            even.push_back((y * wxx - xy * wx) / spread);
            continue;
        }
        const size_t k = std::max<size_t>(
            1, static_cast<size_t>(std::lower_bound(along.begin(), along.end() - 1, at) - along.begin()));
        const double part = along[k] > along[k - 1] ? (at - along[k - 1]) / (along[k] - along[k - 1]) : 0.0;
        even.push_back(points[k - 1] + (points[k] - points[k - 1]) * std::clamp(part, 0.0, 1.0));
    }
    return even;
}

HungStroke hang_stroke(const Tree& tree, const BranchStatistics& statistics, const BranchStroke& stroke,
                       double jitter, const Progress* progress) {
    HungStroke hung;
    hung.points = clean_stroke(stroke.points);
    if (hung.points.size() < 2 || line_length(hung.points) < 2.0 * kLeastSpacing)
        throw Error("The stroke is too short to be a branch: draw it along the whole branch.");
    const Picture picture(tree, statistics, stroke.view, progress);
    if (picture.empty()) throw Error("The tree lies behind the camera: turn the camera towards it.");
    const double length = line_length(hung.points);
    const RadiusLaw law = statistics.radius_law(1);

    EndWood tail = wood_at(picture, law, hung.points.front(), length, jitter);
    const EndWood other = wood_at(picture, law, hung.points.back(), length, jitter);
    const bool turned = tail.on != other.on ? other.on
                        : tail.on           ? other.thickest > kClearly * tail.thickest
                                            : other.apart < tail.apart;
    if (turned) {
        std::reverse(hung.points.begin(), hung.points.end());
        tail = other;
    }
    if (!tail.on) {
        // It may run through the wood, from the far side of it.
        const auto through = [&](size_t k) {
            const SeenWood& seen = picture.wood(k);
            return seen.radius >= law.base_radius(length * picture.metres_per_pixel(seen.from_depth));
        };
        std::vector<DVec2> back(hung.points.rbegin(), hung.points.rend());
        const auto cut = last_crossing(hung.points, picture, 0.5 * length, through);
        const auto far = last_crossing(back, picture, 0.5 * length, through);
        const bool use_far = far && (!cut || picture.wood(far->wood).radius > picture.wood(cut->wood).radius);
        if (cut || far) {
            if (use_far) hung.points = back;
            cut_tail(hung.points, use_far ? *far : *cut);
            tail = wood_at(picture, law, hung.points.front(), line_length(hung.points), jitter);
            hung.remarks.emplace_back("The stroke runs through the wood: its shorter part was left out.");
        }
    }
    if (tail.falls.empty())
        throw Error(
            "The stroke begins near no wood of the tree: draw it from the wood that the branch grows "
            "from.");

    // What lies beyond the axis of the host.
    const int32_t branch = picture.wood(tail.falls.front().wood).branch;
    const auto cut = last_crossing(hung.points, picture, kTailShare * length,
                                   [&](size_t k) { return picture.wood(k).branch == branch; });
    if (cut) {
        if (cut->along > std::max(4.0 * jitter, 0.05 * length))
            hung.remarks.emplace_back("The stroke runs through the wood: its shorter part was left out.");
        cut_tail(hung.points, *cut);
        tail.falls.front() = picture.fall(hung.points.front(), cut->wood);
    } else if (!tail.on) {
        hung.remarks.emplace_back("The stroke ends before the wood and was joined to the nearest.");
    }
    for (const Fall& fall : tail.falls) {
        const SeenWood& seen = picture.wood(fall.wood);
        const NodeId below = tree.node(seen.child).parent;
        hung.hosts.push_back(
            {seen.child, fall.part < 0.5 ? below : seen.child, fall.depth, fall.apart <= jitter});
    }
    return hung;
}

}  // namespace treerec
