#include "synth/grow.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "error.h"
#include "geometry/portable_math.h"
#include "geometry/random.h"
#include "synth/habits.h"
#include "tree/trunk.h"

namespace treerec {

namespace {

constexpr double kGoldenAngle = 137.50776405003785;  // degrees
constexpr double kTurnSpread = 0.35;                 // of a branch's turn off the trunk, either way

double lerp(double a, double b, double t) {
    return a + (b - a) * t;
}

DVec3 rotated(const DVec3& v, const DVec3& axis, double radians) {
    const double c = portable::cos(radians), s = portable::sin(radians);
    return c * v + s * glm::cross(axis, v) + (1.0 - c) * glm::dot(axis, v) * axis;
}

// Which wood lies near a place: a hash grid of nodes.
class Crowd {
  public:
    explicit Crowd(double cell) : cell_(cell) {}

    void add(const DVec3& p, int32_t axis) {
        cells_[key(index(p.x), index(p.y), index(p.z))].push_back({p, axis});
    }

    // The nearest node within `reach` (at most the cell's size) of another axis than `own` and `parent`, as a
    // vector from it to `p`; no direction where there is none.
    bool nearest(const DVec3& p, double reach, int32_t own, int32_t parent, DVec3& away) const {
        double best = reach * reach;
        bool found = false;
        for (int64_t x = index(p.x) - 1; x <= index(p.x) + 1; x++)
            for (int64_t y = index(p.y) - 1; y <= index(p.y) + 1; y++)
                for (int64_t z = index(p.z) - 1; z <= index(p.z) + 1; z++) {
                    const auto cell = cells_.find(key(x, y, z));
                    if (cell == cells_.end()) continue;
                    for (const Entry& entry : cell->second) {
                        if (entry.axis == own || entry.axis == parent) continue;
                        const DVec3 d = p - entry.position;
                        if (glm::dot(d, d) >= best) continue;
                        best = glm::dot(d, d);
                        away = d;
                        found = true;
                    }
                }
        return found;
    }

  private:
    struct Entry {
        DVec3 position;
        int32_t axis;
    };
    int64_t index(double x) const { return static_cast<int64_t>(std::floor(x / cell_)); }
    static uint64_t key(int64_t x, int64_t y, int64_t z) {
        constexpr int64_t kMask = (1 << 21) - 1;
        return static_cast<uint64_t>(x & kMask) << 42 | static_cast<uint64_t>(y & kMask) << 21 |
               static_cast<uint64_t>(z & kMask);
    }

    double cell_;
    std::unordered_map<uint64_t, std::vector<Entry>> cells_;  // looked up only
};

// A branch that waits to be grown.
struct Bud {
    NodeId node;  // it grows from here
    DVec3 direction;
    double length;
    int order;
    int32_t parent_axis;
    bool leader = false;  // a branch that the trunk splits into: side branches as the trunk's
};

class Grower {
  public:
    Grower(const HabitRules& rules, double height, uint64_t seed)
        : rules_(rules), height_(height), seed_(seed), crowd_(0.3) {}

    Tree grow() {
        Random random(seed_, 1);
        const double lean = random.uniform(rules_.least_lean, rules_.most_lean);
        const DVec3 up = tilted(lean, random.uniform(0.0, 360.0));
        tree_.add_root(DVec3(0.0), kProvisionalRadius, kMeasuredRadiusFlag);
        if (rules_.stems == 1)
            buds_.push_back(
                {tree_.root(), up, height_ * (rules_.leaders > 1 ? rules_.split : 1.0), 0, -1, false});
        else
            sprout_stems(random);
        for (size_t i = 0; i < buds_.size(); i++)
            grow_axis(buds_[i], static_cast<int32_t>(i));
        set_radii();
        mark_trunk(tree_);
        ScanFrame frame;
        frame.up = UpAxis::kZ;
        tree_.set_frame(frame);
        return std::move(tree_);
    }

  private:
    static constexpr double kProvisionalRadius = 0.01;

    struct Place {
        NodeId node;
        DVec3 direction;
        double along;  // 0..1
    };

    // The vertical, leaning by `lean` towards `azimuth`, degrees.
    static DVec3 tilted(double lean, double azimuth) {
        const double angle = glm::radians(lean), to = glm::radians(azimuth);
        return {portable::sin(angle) * portable::cos(to), portable::cos(angle),
                portable::sin(angle) * portable::sin(to)};
    }

    // Several stems from the root, each with branches like a branch's.
    void sprout_stems(Random& random) {
        const double turn = random.uniform(0.0, 360.0);
        for (int i = 0; i < rules_.stems; i++) {
            const double azimuth = turn + 360.0 * i / rules_.stems + random.uniform(-20.0, 20.0);
            const double lean = rules_.spread * random.uniform(0.6, 1.4);
            const double length = height_ * (i == 0 ? 1.0 : random.uniform(0.65, 0.95));
            buds_.push_back({tree_.root(), tilted(lean, azimuth), length, 0, -1, true});
        }
    }

    void grow_axis(const Bud bud, int32_t axis) {
        const OrderHabit& habit = rules_.orders[bud.order];
        Random random(hash_seed(seed_, static_cast<uint64_t>(axis)), 2);
        DVec3 heading = bud.direction;
        DVec3 position = tree_.node(bud.node).position;
        // The sway is a heading's drift that itself drifts: a smooth curve, not a jitter.
        DVec3 drift(0.0);
        NodeId at = bud.node;
        std::vector<Place> places;
        const int steps = std::max(2, static_cast<int>(std::lround(bud.length / habit.step)));
        const double step = bud.length / steps;
        for (int i = 0; i < steps; i++) {
            const double along = static_cast<double>(i) / steps;
            drift = 0.75 * drift + glm::radians(habit.sway) * std::sqrt(step) * 0.6 * random.direction();
            double lift = lerp(habit.lift, habit.tip_lift, along);
            // Branches first leave the trunk's way and then bend up; the trunk itself returns to the
            // vertical.
            const DVec3 sky(0.0, lift, 0.0);
            heading = glm::normalize(heading + drift + step * (sky - glm::dot(sky, heading) * heading));
            DVec3 next = position + step * heading;
            DVec3 away(0.0);
            if (i > 1 && crowd_.nearest(next, habit.clearance, axis, bud.parent_axis, away)) {
                heading = glm::normalize(heading + 0.6 * normalized_or(away, DVec3(0, 1, 0)));
                next = position + step * heading;
                // Room was made until the branch turned back: it would curl.
                if (glm::dot(heading, bud.direction) < 0.0) break;
                if (bud.order > 0 && crowd_.nearest(next, 0.6 * habit.clearance, axis, bud.parent_axis, away))
                    break;
            }
            if (next.y < 0.3 && bud.order > 0) break;
            at = tree_.add_child(at, next, kProvisionalRadius, kMeasuredRadiusFlag);
            position = next;
            places.push_back({at, heading, (i + 1.0) / steps});
        }
        if (places.empty()) return;
        for (const Place& place : places)
            crowd_.add(tree_.node(place.node).position, axis);
        if (bud.order == 0 && rules_.leaders > 1 && !bud.leader) {
            split(places.back(), axis, random);
            return;
        }
        if (bud.order < kMaximumOrder && habit.whorl > 0) sprout(bud, habit, places, axis, random);
    }

    // The trunk of a decurrent tree ends here in several branches.
    void split(const Place& top, int32_t axis, Random& random) {
        const double turn = random.uniform(0.0, 360.0);
        const double reach = height_ * (1.0 - rules_.split);
        for (int i = 0; i < rules_.leaders; i++) {
            const bool first = i == 0;
            const double angle = (first ? rules_.first_turn : rules_.other_turn) *
                                 random.uniform(1.0 - kTurnSpread, 1.0 + kTurnSpread);
            const double azimuth = turn + 360.0 * i / rules_.leaders + random.uniform(-20.0, 20.0);
            const double length = reach * (first ? 1.0 : random.uniform(0.72, 0.95));
            // A fork of four branches in one point is rare in nature: they leave over the last metre.
            NodeId node = top.node;
            for (int down = 0; down < 3 * i && tree_.node(node).parent != kNoNode; down++)
                node = tree_.node(node).parent;
            buds_.push_back({node, turned(top.direction, angle, azimuth), length, 0, axis, true});
        }
    }

    // Side branches along the axis, the longest first along its length by the habit's profile.
    void sprout(const Bud& bud, const OrderHabit& habit, const std::vector<Place>& places, int32_t axis,
                Random& random) {
        const double grown = bud.length * static_cast<double>(places.size()) /
                             std::max(2.0, std::round(bud.length / habit.step));
        double azimuth = random.uniform(0.0, 360.0);
        // A branch's first part is bare like a branch's, not like a trunk's.
        const double bare = bud.leader ? 0.14 : habit.bare;
        double distance = bare * bud.length;
        while (distance < 0.97 * grown) {
            const double along = distance / bud.length;
            const size_t index =
                std::min(places.size() - 1, static_cast<size_t>(along * bud.length / habit.step));
            const Place& place = places[index];
            const double share = (along - bare) / (1.0 - bare);
            for (int k = 0; k < habit.whorl; k++) {
                azimuth += habit.whorl == 1 ? kGoldenAngle + random.uniform(-18.0, 18.0)
                                            : 360.0 / habit.whorl + random.uniform(-12.0, 12.0);
                const double length =
                    bud.length * habit.child_ratio * profile(bud.order, share) * random.uniform(0.7, 1.1);
                const double angle = lerp(habit.angle, habit.tip_angle, share) + random.uniform(-9.0, 9.0);
                const DVec3 direction = turned(place.direction, angle, azimuth);
                const double kept = length * light(place, direction, bud.order);
                if (kept < habit.least_length) continue;
                buds_.push_back({place.node, direction, kept, bud.order + 1, axis, false});
            }
            if (habit.whorl > 1) azimuth += 0.5 * 360.0 / habit.whorl;
            distance += habit.spacing * random.uniform(0.75, 1.25) * lerp(1.0, 0.7, share);
        }
    }

    double profile(int order, double share) const {
        if (order > 0) return lerp(1.0, 0.3, share);
        if (share < 0.35) return lerp(rules_.profile_base, rules_.profile_middle, share / 0.35);
        return lerp(rules_.profile_middle, rules_.profile_top, (share - 0.35) / 0.65);
    }

    // Shoots that grow back into the crown, or down below their branch, starve.
    double light(const Place& place, const DVec3& direction, int order) const {
        if (order == 0) return 1.0;
        const DVec3 position = tree_.node(place.node).position;
        const DVec3 outward = normalized_or(DVec3(position.x, 0.0, position.z), DVec3(0, 1, 0));
        const double outwards = glm::dot(outward, direction);
        const double upwards = direction.y;
        return std::clamp(0.80 + 0.28 * outwards + 0.12 * upwards, 0.25, 1.1);
    }

    // `axis` turned off itself by `angle`, towards `azimuth` around it (degrees; 0 to the sky).
    static DVec3 turned(const DVec3& axis, double angle, double azimuth) {
        const DVec3 sky(0.0, 1.0, 0.0);
        DVec3 side = glm::cross(axis, sky);
        side = glm::length(side) > 0.05 ? glm::normalize(side) : any_perpendicular(axis);
        const DVec3 pivot = rotated(side, axis, glm::radians(azimuth));
        return rotated(axis, pivot, glm::radians(angle));
    }

    // r^e of a segment is the sum of its children's plus a little for its own length; e by bisection so that
    // the base meets the habit's slenderness.
    void set_radii() {
        const double base = 0.5 * height_ / rules_.slenderness;
        double low = 1.3, high = 5.0;
        std::vector<double> radii;
        for (int i = 0; i < 50; i++) {
            const double exponent = 0.5 * (low + high);
            radii = pipe_radii(exponent);
            // A larger exponent makes a thinner base.
            (radii[tree_.root()] > base ? low : high) = exponent;
        }
        for (NodeId id : tree_.depth_first()) {
            const double y = std::max(0.0, tree_.node(id).position.y);
            // The root flare.
            const double flare = 1.0 + 0.30 * portable::exp(-y / 0.22);
            const bool low_trunk = tree_.node(id).depth < 40 && radii[id] > 0.5 * base;
            tree_.set_radius(id, radii[id] * (low_trunk ? flare : 1.0));
        }
    }

    std::vector<double> pipe_radii(double exponent) const {
        std::vector<double> pipes(static_cast<size_t>(tree_.id_end()), 0.0);
        const std::vector<NodeId> order = tree_.depth_first();
        const double tip = portable::pow(rules_.tip_radius, exponent);
        for (auto at = order.rbegin(); at != order.rend(); ++at) {
            const Node& node = tree_.node(*at);
            if (node.child_count == 0) pipes[*at] = tip;
            if (node.parent == kNoNode) continue;
            const double length = glm::distance(node.position, tree_.node(node.parent).position);
            pipes[node.parent] += pipes[*at] + tip * length;
        }
        for (NodeId id : order)
            pipes[id] = portable::pow(pipes[id], 1.0 / exponent);
        return pipes;
    }

    const HabitRules& rules_;
    double height_;
    uint64_t seed_;
    Tree tree_;
    std::vector<Bud> buds_;  // grown in order: thick branches take their room first
    Crowd crowd_;
};

}  // namespace

std::vector<Habit> all_habits() {
    return {Habit::kBroadleaf, Habit::kConifer, Habit::kBirch,      Habit::kForked,
            Habit::kLeaning,   Habit::kShrub,   Habit::kButtressed, Habit::kPalm};
}

Habit parse_habit(const std::string& name) {
    std::string names;
    for (Habit habit : all_habits()) {
        if (name == habit_rules(habit).name) return habit;
        names += std::string(names.empty() ? "" : ", ") + habit_rules(habit).name;
    }
    throw Error("There is no habit '" + name + "'; use one of " + names + ".");
}

std::string habit_name(Habit habit) {
    return habit_rules(habit).name;
}

std::vector<std::string> habit_names() {
    std::vector<std::string> names;
    for (Habit habit : all_habits())
        names.push_back(habit_name(habit));
    return names;
}

Tree grow_tree(const GrowOptions& options) {
    const HabitRules& rules = habit_rules(options.habit);
    double height = options.height;
    if (height == 0.0) height = Random(options.seed, 7).uniform(rules.least_height, rules.most_height);
    if (!(height >= 1.0 && height <= 60.0)) throw Error("A tree can be grown from 1 to 60 m high.");
    return Grower(rules, height, options.seed).grow();
}

}  // namespace treerec
