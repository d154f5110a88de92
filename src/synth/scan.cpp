#include "synth/scan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "error.h"
#include "geometry/bounds.h"
#include "geometry/parallel.h"
#include "geometry/random.h"

namespace treerec {

namespace {

constexpr float kNothing = std::numeric_limits<float>::max();
constexpr double kMixedGap = 0.08;         // metres between two surfaces that one beam can mix
constexpr double kMixedReach = 0.6;        // metres behind an edge against the sky
constexpr int kOccluders = 600;            // at most, per station
constexpr size_t kMostBeams = 40'000'000;  // per station

// A tapered cylinder of wood, or (radius only at `from`) a disc of leaf with its normal in `to`.
struct Surface {
    DVec3 from;
    DVec3 to;
    double from_radius;
    double to_radius;
    bool leaf;
};

std::vector<Surface> wood_of(const Tree& tree) {
    std::vector<Surface> surfaces;
    surfaces.reserve(tree.size());
    for (NodeId id : tree.depth_first()) {
        const Node& node = tree.node(id);
        if (node.parent == kNoNode) continue;
        const Node& parent = tree.node(node.parent);
        // A side branch starts as thick as it is, not as thick as the wood it grows from.
        const double start = std::min(parent.radius, 1.15 * node.radius);
        if (glm::distance(parent.position, node.position) < 1e-9) continue;
        surfaces.push_back({parent.position, node.position, start, node.radius, false});
    }
    return surfaces;
}

// Discs along the thin wood. `share` of full foliage: 1 is a disc every 1.5 cm.
void add_leaves(const Tree& tree, double share, uint64_t seed, std::vector<Surface>& surfaces) {
    if (share <= 0.0) return;
    constexpr double kThinWood = 0.008;
    constexpr double kFullSpacing = 0.015;
    const double spacing = kFullSpacing / share;
    Random random(seed, 21);
    double until_next = spacing * random.uniform();
    for (NodeId id : tree.depth_first()) {
        const Node& node = tree.node(id);
        if (node.parent == kNoNode || node.radius > kThinWood) continue;
        const DVec3 from = tree.node(node.parent).position;
        const double length = glm::distance(from, node.position);
        for (; until_next < length; until_next += spacing * random.uniform(0.6, 1.4)) {
            const DVec3 out = random.direction();
            const DVec3 normal = glm::normalize(DVec3(0.0, 0.9, 0.0) + 0.8 * random.direction());
            const double radius = random.uniform(0.025, 0.05);
            const DVec3 centre = glm::mix(from, node.position, until_next / length) + 0.06 * out;
            surfaces.push_back({centre, normal, radius, radius, true});
        }
        until_next -= length;
    }
}

// The distance along the unit direction at which a ray from `eye` enters the tapered cylinder's side.
std::optional<double> hit_wood(const Surface& wood, const DVec3& eye, const DVec3& direction) {
    const DVec3 along = wood.to - wood.from;
    const double length = glm::length(along);
    const DVec3 axis = along / length;
    const double taper = (wood.to_radius - wood.from_radius) / length;
    // |q - (q.a) a| = r0 + taper (q.a) for q = eye + t direction - from.
    const DVec3 offset = eye - wood.from;
    const double offset_along = glm::dot(offset, axis);
    const double direction_along = glm::dot(direction, axis);
    const DVec3 offset_across = offset - offset_along * axis;
    const DVec3 direction_across = direction - direction_along * axis;
    const double start_radius = wood.from_radius + taper * offset_along;
    const double a =
        glm::dot(direction_across, direction_across) - taper * taper * direction_along * direction_along;
    const double b = glm::dot(offset_across, direction_across) - start_radius * taper * direction_along;
    const double c = glm::dot(offset_across, offset_across) - start_radius * start_radius;
    const double root = b * b - a * c;
    if (a <= 1e-15 || root < 0.0) return std::nullopt;
    const double t = (-b - std::sqrt(root)) / a;
    const double at = offset_along + t * direction_along;
    if (t <= 0.0 || at < 0.0 || at > length) return std::nullopt;
    return t;
}

std::optional<double> hit_leaf(const Surface& leaf, const DVec3& eye, const DVec3& direction) {
    const double facing = glm::dot(direction, leaf.to);
    if (std::abs(facing) < 1e-6) return std::nullopt;
    const double t = glm::dot(leaf.from - eye, leaf.to) / facing;
    if (t <= 0.0) return std::nullopt;
    const DVec3 d = eye + t * direction - leaf.from;
    if (glm::dot(d, d) > leaf.from_radius * leaf.from_radius) return std::nullopt;
    return t;
}

// One station's view: a depth per beam. Azimuth is measured from the direction to the tree, so that the view
// never wraps around.
class View {
  public:
    View(const DVec3& eye, const DVec3& towards, double step, const Bounds& bounds) : eye_(eye), step_(step) {
        forward_ = glm::normalize(DVec3(towards.x - eye.x, 0.0, towards.z - eye.z));
        right_ = glm::cross(forward_, DVec3(0.0, 1.0, 0.0));
        double low_azimuth = kPi, high_azimuth = -kPi, low_elevation = kPi, high_elevation = -kPi;
        for (int corner = 0; corner < 8; corner++) {
            const DVec3 p(corner & 1 ? bounds.max.x : bounds.min.x, corner & 2 ? bounds.max.y : bounds.min.y,
                          corner & 4 ? bounds.max.z : bounds.min.z);
            const DVec2 angles = angles_to(p);
            low_azimuth = std::min(low_azimuth, angles.x);
            high_azimuth = std::max(high_azimuth, angles.x);
        }
        // The elevation is largest where the tree is nearest: bounded by the height over the least distance.
        const double near = std::max(0.5, glm::length(DVec2(towards.x - eye.x, towards.z - eye.z)) -
                                              0.5 * glm::length(DVec2(bounds.size().x, bounds.size().z)));
        high_elevation = std::atan2(std::max(0.1, bounds.max.y - eye.y), near);
        low_elevation = std::atan2(std::min(-0.1, bounds.min.y - eye.y), near);
        azimuth_ = low_azimuth - step;
        elevation_ = low_elevation - step;
        columns_ = static_cast<int>((high_azimuth - low_azimuth) / step) + 3;
        rows_ = static_cast<int>((high_elevation - low_elevation) / step) + 3;
        if (static_cast<size_t>(columns_) * static_cast<size_t>(rows_) > kMostBeams)
            throw Error("The virtual scan would need too many beams; ask for fewer points.");
        depth_.assign(static_cast<size_t>(columns_) * static_cast<size_t>(rows_), kNothing);
        is_leaf_.assign(depth_.size(), 0);
    }

    void draw(const Surface& surface) {
        // The angular box of the surface's bounding balls.
        double low_column = 1e9, high_column = -1e9, low_row = 1e9, high_row = -1e9;
        const auto include = [&](const DVec3& p, double radius) {
            const DVec2 angles = angles_to(p);
            const double distance = std::max(glm::distance(p, eye_), 1.01 * radius);
            const double reach = std::asin(radius / distance);
            // Meridians draw together towards the zenith.
            const double azimuth_reach =
                std::abs(angles.y) + reach < 1.5 ? reach / std::cos(std::abs(angles.y) + reach) : kPi;
            low_column = std::min(low_column, angles.x - azimuth_reach);
            high_column = std::max(high_column, angles.x + azimuth_reach);
            low_row = std::min(low_row, angles.y - reach);
            high_row = std::max(high_row, angles.y + reach);
        };
        include(surface.from, surface.from_radius);
        if (!surface.leaf) include(surface.to, surface.to_radius);
        const auto clamp_to = [](double value, int count) {
            return static_cast<int>(std::clamp(value, 0.0, count - 1.0));
        };
        const int first_column = clamp_to((low_column - azimuth_) / step_, columns_);
        const int last_column = clamp_to((high_column - azimuth_) / step_ + 1.0, columns_);
        const int first_row = clamp_to((low_row - elevation_) / step_, rows_);
        const int last_row = clamp_to((high_row - elevation_) / step_ + 1.0, rows_);
        for (int row = first_row; row <= last_row; row++)
            for (int column = first_column; column <= last_column; column++) {
                const DVec3 direction = beam(column, row);
                const std::optional<double> t =
                    surface.leaf ? hit_leaf(surface, eye_, direction) : hit_wood(surface, eye_, direction);
                if (!t) continue;
                const size_t at = index(column, row);
                if (static_cast<float>(*t) >= depth_[at]) continue;
                depth_[at] = static_cast<float>(*t);
                is_leaf_[at] = surface.leaf;
            }
    }

    // Hides round patches of the view until about `share` of the returns are gone.
    void occlude(double share, Random& random) {
        if (share <= 0.0) return;
        const size_t wanted = static_cast<size_t>((1.0 - share) * static_cast<double>(returns()));
        size_t left = returns();
        for (int i = 0; i < kOccluders && left > wanted; i++) {
            const double centre_column = random.uniform() * columns_;
            const double centre_row = random.uniform() * rows_;
            const double radius = glm::radians(random.uniform(0.6, 2.5)) / step_;
            for (int row = std::max(0, static_cast<int>(centre_row - radius));
                 row < std::min<double>(rows_, centre_row + radius); row++)
                for (int column = std::max(0, static_cast<int>(centre_column - radius));
                     column < std::min<double>(columns_, centre_column + radius); column++) {
                    const double dx = column - centre_column, dy = row - centre_row;
                    float& depth = depth_[index(column, row)];
                    if (depth == kNothing || dx * dx + dy * dy > radius * radius) continue;
                    depth = kNothing;
                    left--;
                }
        }
    }

    size_t returns() const {
        return static_cast<size_t>(
            std::count_if(depth_.begin(), depth_.end(), [](float depth) { return depth != kNothing; }));
    }

    struct Return {
        DVec3 position;
        ScanOrigin origin;
    };
    // The returns, row by row, with noise along the beam and `mixed` of them drawn off their edge.
    void collect(double noise, double mixed, Random& random, std::vector<Return>& out) const {
        for (int row = 0; row < rows_; row++)
            for (int column = 0; column < columns_; column++) {
                const size_t at = index(column, row);
                if (depth_[at] == kNothing) continue;
                double range = depth_[at];
                ScanOrigin origin = is_leaf_[at] ? kFromLeaf : kFromWood;
                const double dice = random.uniform();
                const double share = random.uniform();
                const double deviation = random.normal();
                const float behind = column + 1 < columns_ ? depth_[at + 1] : kNothing;
                const bool edge = behind == kNothing || behind - depth_[at] > kMixedGap;
                if (edge && dice < mixed) {
                    const double gap =
                        behind == kNothing ? kMixedReach : std::min<double>(behind - range, kMixedReach);
                    range += share * gap;
                    origin = kMixedBeam;
                }
                out.push_back({eye_ + (range + noise * deviation) * beam(column, row), origin});
            }
    }

  private:
    DVec2 angles_to(const DVec3& p) const {
        const DVec3 d = p - eye_;
        const double ahead = glm::dot(d, forward_), aside = glm::dot(d, right_);
        return {std::atan2(aside, ahead), std::atan2(d.y, std::hypot(ahead, aside))};
    }
    DVec3 beam(int column, int row) const {
        const double azimuth = azimuth_ + column * step_, elevation = elevation_ + row * step_;
        return std::cos(elevation) * (std::cos(azimuth) * forward_ + std::sin(azimuth) * right_) +
               DVec3(0.0, std::sin(elevation), 0.0);
    }
    size_t index(int column, int row) const {
        return static_cast<size_t>(row) * static_cast<size_t>(columns_) + static_cast<size_t>(column);
    }

    DVec3 eye_, forward_, right_;
    double step_;
    double azimuth_ = 0.0, elevation_ = 0.0;
    int columns_ = 0, rows_ = 0;
    std::vector<float> depth_;
    std::vector<uint8_t> is_leaf_;
};

Color8 shade(const DVec3& colour, double light) {
    Color8 result;
    for (int i = 0; i < 3; i++)
        result[i] = static_cast<uint8_t>(std::clamp(colour[i] * light, 6.0, 245.0));
    return result;
}

Color8 colour_of(ScanOrigin origin, Random& random) {
    const double light = 1.0 + 0.16 * random.normal();
    switch (origin) {
        case kFromLeaf:
            return shade(DVec3(86.0 + 20.0 * random.uniform(), 128.0, 52.0), light);
        case kFromWood:
            return shade(DVec3(124.0, 106.0, 88.0), light);
        case kMixedBeam:
        case kStray:
            break;
    }
    return shade(DVec3(140.0, 140.0, 138.0), light);
}

void require_share(double value, double largest, const char* what) {
    if (!(value >= 0.0 && value <= largest))
        throw Error(std::string(what) + " must lie between 0 and " + (largest < 1.0 ? "0.95." : "1."));
}

}  // namespace

VirtualScan scan_tree(const Tree& tree, const VirtualScanOptions& options, Progress* progress) {
    require_share(options.occlusion, 0.95, "The occlusion");
    require_share(options.leaves, 1.0, "The leaves");
    require_share(options.mixed, 1.0, "The share of mixed beams");
    require_share(options.stray, 1.0, "The share of stray points");
    if (!(options.noise >= 0.0 && options.noise <= 1.0)) throw Error("The noise must lie between 0 and 1 m.");
    if (options.points < 1 || options.points > 20'000'000)
        throw Error("A virtual scan can have 1 to 20 million points.");
    if (options.stations < 1 || options.stations > 64) throw Error("A virtual scan needs 1 to 64 stations.");
    std::vector<Surface> surfaces = wood_of(tree);
    if (surfaces.empty()) throw Error("The tree has no wood to scan.");
    add_leaves(tree, options.leaves, options.seed, surfaces);
    Bounds bounds = tree.bounds();
    for (const Surface& surface : surfaces)
        bounds.add(surface.from, surface.from_radius);

    Random random(options.seed, 20);
    const DVec3 base = tree.node(tree.root()).position;
    const double away = 0.5 * glm::length(DVec2(bounds.size().x, bounds.size().z));
    std::vector<DVec3> eyes;
    const double turn = random.uniform(0.0, 2.0 * kPi);
    for (int i = 0; i < options.stations; i++) {
        const double azimuth = turn + 2.0 * kPi * (i + random.uniform(-0.25, 0.25)) / options.stations;
        const double distance = std::max(random.uniform(8.0, 15.0), 1.3 * away);
        eyes.push_back(base + DVec3(distance * std::cos(azimuth), 1.5, distance * std::sin(azimuth)));
    }

    const size_t stray = static_cast<size_t>(options.stray * static_cast<double>(options.points));
    const size_t wanted = std::max<size_t>(1, options.points - stray);
    const auto scan_all = [&](double step, std::vector<View::Return>& returns) {
        std::vector<std::vector<View::Return>> by_station(eyes.size());
        parallel_for(eyes.size(), 1, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; i++) {
                if (progress) progress->check();
                Random own(hash_seed(options.seed, i), 22);
                View view(eyes[i], bounds.centre(), step, bounds);
                for (const Surface& surface : surfaces)
                    view.draw(surface);
                view.occlude(options.occlusion, own);
                view.collect(options.noise, options.mixed, own, by_station[i]);
            }
        });
        for (const std::vector<View::Return>& station : by_station)
            returns.insert(returns.end(), station.begin(), station.end());
    };
    // Returns go with the square of the resolution: a coarse look tells how fine the beams must be.
    double step = glm::radians(0.12);
    std::vector<View::Return> returns;
    for (int attempt = 0; attempt < 4 && returns.size() < wanted; attempt++) {
        if (progress) progress->update(0.2 * attempt, "Scanning");
        returns.clear();
        scan_all(step, returns);
        const double found = std::max<double>(1.0, static_cast<double>(returns.size()));
        step *= std::sqrt(found / (1.06 * static_cast<double>(wanted)));
    }
    // A random part of what is too much: a shuffle of the first `wanted`, then back in the beams' order.
    std::vector<size_t> chosen(returns.size());
    for (size_t i = 0; i < chosen.size(); i++)
        chosen[i] = i;
    for (size_t i = 0; i < std::min(wanted, chosen.size()); i++)
        std::swap(chosen[i], chosen[i + random.below(static_cast<uint32_t>(chosen.size() - i))]);
    chosen.resize(std::min(wanted, chosen.size()));
    std::sort(chosen.begin(), chosen.end());

    VirtualScan scan;
    scan.cloud.frame = tree.frame();
    const auto add = [&](const DVec3& position, ScanOrigin origin) {
        scan.cloud.positions.emplace_back(position);
        scan.cloud.colors.push_back(colour_of(origin, random));
        scan.origin.push_back(origin);
    };
    for (size_t i : chosen)
        add(returns[i].position, returns[i].origin);
    const DVec3 margin = 0.1 * bounds.size();
    for (size_t i = 0; i < stray; i++) {
        DVec3 p;
        for (int axis = 0; axis < 3; axis++)
            p[axis] = random.uniform(bounds.min[axis] - margin[axis], bounds.max[axis] + margin[axis]);
        add(p, kStray);
    }
    if (progress) progress->update(1.0, "Scanning");
    return scan;
}

}  // namespace treerec
