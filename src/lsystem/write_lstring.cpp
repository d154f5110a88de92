#include <algorithm>
#include <cmath>
#include <vector>

#include "error.h"
#include "geometry/portable_math.h"
#include "lsystem/lstring.h"
#include "lsystem/short_number.h"
#include "lsystem/turtle.h"

namespace treerec {

namespace {

constexpr double kDegreesPerRadian = 180.0 / kPi;
constexpr double kShortest = 1e-12;  // metres: nearer nodes coincide

// Degrees, absolute (Chen 2025, algorithm 6).
DVec3 paper_direction(double yaw, double pitch) {
    const double a = yaw * kRadiansPerDegree;
    const double b = pitch * kRadiansPerDegree;
    return {portable::cos(b) * portable::cos(a), portable::sin(b), portable::cos(b) * portable::sin(a)};
}

class Writer {
  public:
    Writer(const Tree& tree, NodeId from, const LStringOptions& options, const Progress* progress)
        : tree_(tree),
          options_(options),
          progress_(progress),
          origin_(tree.node(from).position),
          accuracy_(std::max(options.accuracy, 1e-12)),
          radius_accuracy_(std::max(options.radius_accuracy, 1e-12)),
          paper_(options.dialect == LStringDialect::kPaper) {}

    std::string write(NodeId from) {
        write_root(from);
        state_.target = DVec3(0.0);
        // A node whose branches are being written, and the state of the turtle there.
        std::vector<Fork> forks;
        NodeId at = from;
        size_t steps = 0;
        while (true) {
            if ((++steps & 0xfff) == 0 && progress_) progress_->check();
            // The branches of `at` in brackets, then its first child.
            const Node& node = tree_.node(at);
            const NodeId side = paper_                        ? node.first_child
                                : node.first_child == kNoNode ? kNoNode
                                                              : tree_.node(node.first_child).next_sibling;
            if (side != kNoNode) {
                forks.push_back({side, state_});
                out_ += '[';
                at = side;
                step_to(at);
                continue;
            }
            if (!paper_ && node.first_child != kNoNode) {
                at = node.first_child;
                step_to(at);
                continue;
            }
            // A tip: back to the last fork that has something left.
            bool more = false;
            while (!more && !forks.empty()) {
                Fork& fork = forks.back();
                out_ += ']';
                state_ = fork.state;
                const NodeId next = tree_.node(fork.child).next_sibling;
                if (next != kNoNode) {
                    fork.child = next;
                    out_ += '[';
                    at = next;
                    more = true;
                } else {
                    const NodeId first = tree_.node(tree_.node(fork.child).parent).first_child;
                    forks.pop_back();
                    if (paper_) continue;
                    at = first;
                    more = true;
                }
            }
            if (!more) return std::move(out_);
            step_to(at);
        }
    }

  private:
    struct State {
        Turtle turtle;      // as a reader has it
        DVec3 target{0.0};  // where it should stand
        double radius = 0.0;
        double yaw = 0.0;
        double pitch = 0.0;
        uint8_t flags = 0;
    };
    struct Fork {
        NodeId child;  // the branch being written
        State state;
    };

    void command(char symbol, const ShortNumber& number) {
        out_ += symbol;
        out_ += '(';
        number.append(out_);
        out_ += ')';
    }

    void write_root(NodeId from) {
        if (paper_) return;
        const Node& root = tree_.node(from);
        const ShortNumber radius(root.radius, radius_tolerance(root.radius));
        command('!', radius);
        state_.radius = radius.rounded;
        bool any = false;
        if (options_.flags)
            for (const NodeId id : tree_.depth_first(from))
                any = any || tree_.node(id).flags != 0;
        // Later segments are guesses by their f.
        constexpr uint8_t known = kTrunkFlag | kMeasuredRadiusFlag | kGuessFlag;
        if (any) command('@', ShortNumber(root.flags & known, 0.0));
        state_.flags = root.flags & (kTrunkFlag | kMeasuredRadiusFlag);
    }

    double radius_tolerance(double radius) const { return 0.9 * radius_accuracy_ * std::min(radius, 1.0); }

    // How a segment is drawn: the angles in degrees, and where they take the turtle.
    struct Plan {
        ShortNumber yaw{0.0, 0.0};
        ShortNumber pitch{0.0, 0.0};
        ShortNumber length{0.0, 0.0};
        Turtle turtle;
    };

    // Appends the segment to `id` from where the turtle stands.
    void step_to(NodeId id) {
        const Node& node = tree_.node(id);
        const DVec3 target = node.position - origin_;
        const DVec3 own = target - state_.target;
        const DVec3 way = target - state_.turtle.position;
        const double length = glm::length(own);
        // Straight on as the segment lies, as long as that ends near enough; else aimed at its end, to take
        // the turtle's error back. Where two nodes coincide, all of it.
        const double allowed = std::max(0.9 * accuracy_ * length, kShortest);
        const double tolerance = allowed / 3.0;
        Plan plan = plan_for(own, tolerance);
        if (glm::distance(plan.turtle.position, target) > allowed)
            plan = plan_for(way, std::min(tolerance, 0.3 * accuracy_ * glm::length(way)));
        state_.target = target;
        state_.turtle = plan.turtle;
        if (paper_) {
            write_paper_turns(plan);
        } else {
            write_turns(plan);
            write_marks(node);
        }
        command(!paper_ && options_.flags && node.is_guess() ? 'f' : 'F', plan.length);
    }

    // tolerance: metres, of each of the three numbers.
    Plan plan_for(const DVec3& way, double tolerance) const {
        Plan plan;
        plan.turtle = state_.turtle;
        Turtle& turtle = plan.turtle;
        const double length = glm::length(way);
        if (length <= kShortest) {
            plan.yaw.rounded = state_.yaw;
            plan.pitch.rounded = state_.pitch;
            return plan;
        }
        tolerance = std::max(tolerance, kShortest);
        const DVec3 local = paper_ ? DVec3(way.x, way.z, way.y)
                                   : DVec3(glm::dot(way, turtle.heading), glm::dot(way, turtle.left),
                                           glm::dot(way, turtle.up));
        const double level = portable::hypot(local.x, local.y);
        // Straight up or down there is no yaw.
        if (level > tolerance)
            plan.yaw = ShortNumber(portable::atan2(local.y, local.x) * kDegreesPerRadian,
                                   tolerance / level * kDegreesPerRadian);
        if (paper_) {
            plan.pitch = ShortNumber(portable::atan2(local.z, level) * kDegreesPerRadian,
                                     tolerance / length * kDegreesPerRadian);
            turtle.heading = paper_direction(plan.yaw.rounded, plan.pitch.rounded);
        } else {
            if (std::abs(plan.yaw.rounded) == 180.0)
                turtle.turn_around();
            else if (plan.yaw.rounded != 0.0)
                turtle.turn_left(plan.yaw.rounded);
            plan.pitch =
                ShortNumber(portable::atan2(local.z, glm::dot(way, turtle.heading)) * kDegreesPerRadian,
                            tolerance / length * kDegreesPerRadian);
            if (plan.pitch.rounded != 0.0) turtle.pitch_up(plan.pitch.rounded);
        }
        plan.length = ShortNumber(std::max(0.0, glm::dot(way, turtle.heading)), tolerance);
        turtle.move(plan.length.rounded);
        return plan;
    }

    void write_turns(const Plan& plan) {
        if (std::abs(plan.yaw.rounded) == 180.0)
            out_ += '|';
        else if (plan.yaw.rounded != 0.0)
            command(plan.yaw.rounded > 0.0 ? '+' : '-', plan.yaw.magnitude());
        if (plan.pitch.rounded != 0.0) command(plan.pitch.rounded > 0.0 ? '^' : '&', plan.pitch.magnitude());
    }

    // Algorithm 4 leaves a zero out, but algorithm 6 would then go on with the last angle.
    void write_paper_turns(const Plan& plan) {
        if (plan.yaw.rounded != state_.yaw) command(plan.yaw.rounded < 0.0 ? '-' : '+', plan.yaw.magnitude());
        if (plan.pitch.rounded != state_.pitch)
            command(plan.pitch.rounded < 0.0 ? '^' : '&', plan.pitch.magnitude());
        state_.yaw = plan.yaw.rounded;
        state_.pitch = plan.pitch.rounded;
    }

    void write_marks(const Node& node) {
        const uint8_t flags = node.flags & (kTrunkFlag | kMeasuredRadiusFlag);
        if (options_.flags && flags != state_.flags) {
            command('@', ShortNumber(flags, 0.0));
            state_.flags = flags;
        }
        const double tolerance = radius_tolerance(node.radius);
        if (std::abs(state_.radius - node.radius) > tolerance) {
            const ShortNumber radius(node.radius, tolerance);
            command('!', radius);
            state_.radius = radius.rounded;
        }
    }

    const Tree& tree_;
    const LStringOptions& options_;
    const Progress* progress_;
    DVec3 origin_;
    double accuracy_;
    double radius_accuracy_;
    bool paper_;
    State state_;
    std::string out_;
};

}  // namespace

std::string write_lstring(const Tree& tree, NodeId from, const LStringOptions& options,
                          const Progress* progress) {
    if (!tree.contains(from)) throw Error("There is no node " + std::to_string(from) + " in this tree.");
    return Writer(tree, from, options, progress).write(from);
}

}  // namespace treerec
