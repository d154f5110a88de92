#include "sketch/branch_plane.h"

#include <algorithm>
#include <cmath>

#include "geometry/portable_math.h"

namespace treerec {

namespace {

constexpr double kDegree = kPi / 180.0;
constexpr double kSteepest = 75.0 * kDegree;
constexpr double kStep = 1.5 * kDegree;
// Widths of the kernels.
constexpr double kLeanWidth = 7.0 * kDegree;
constexpr double kAzimuthWidth = 14.0 * kDegree;
constexpr double kLengthWidth = 0.16;  // of the logarithm
constexpr double kShareWidth = 0.15;   // of the host's length: siblings so near tell most
// What the siblings do not tell: a share of each density that is even.
constexpr double kEven = 0.12;
constexpr double kFewTurns = 8.0;
constexpr double kSamePlace = 0.02;  // metres along the host: a whorl
constexpr double kShortest = 0.4;    // of the stroke's own length: shorter siblings are other things
constexpr double kMostLoss = 45.0 * kDegree;
constexpr size_t kLeastSiblings = 4;

double gauss(double x, double width) {
    return portable::exp(-0.5 * (x / width) * (x / width)) / (width * std::sqrt(2.0 * kPi));
}

double turned_by(double angle) {
    while (angle > kPi)
        angle -= 2.0 * kPi;
    while (angle <= -kPi)
        angle += 2.0 * kPi;
    return angle;
}

struct Sibling {
    double lean, chord, share;
};

// What is known of one place on a host.
class Siblings {
  public:
    Siblings(const BranchStatistics& statistics, int32_t host, double share, double along, double shortest)
        : share_(share) {
        gather(statistics, host, shortest);
        if (known_.size() < kLeastSiblings)
            for (size_t i = 0; i < statistics.list().branches.size(); i++)
                if (static_cast<int32_t>(i) != host &&
                    statistics.list().branches[i].order ==
                        statistics.list().branches[static_cast<size_t>(host)].order)
                    gather(statistics, static_cast<int32_t>(i), shortest);
        const std::vector<SideBranch>& sides = statistics.sides(host);
        for (const SideBranch& side : sides) {
            if (std::abs(side.along - along) <= kSamePlace)
                beside_.push_back(side.chord_azimuth);
            else if (side.along < along)
                before_ = &side;
            else if (!after_)
                after_ = &side;
        }
        for (size_t i = 0; i < sides.size(); i++) {
            // The gap where it is missing tells nothing.
            if (i + 1 < sides.size() && &sides[i] != before_ &&
                sides[i + 1].along - sides[i].along > kSamePlace)
                following_.push_back(turned_by(sides[i + 1].chord_azimuth - sides[i].chord_azimuth));
            for (size_t k = i + 1; k < sides.size() && sides[k].along - sides[i].along <= kSamePlace; k++) {
                const double turn = turned_by(sides[k].chord_azimuth - sides[i].chord_azimuth);
                whorled_.push_back(turn);
                whorled_.push_back(-turn);
            }
        }
    }

    double lean_density(double lean) const {
        double sum = 0.0, weights = 0.0;
        for (const Sibling& one : known_) {
            const double w = weight(one);
            sum += w * gauss(lean - one.lean, kLeanWidth);
            weights += w;
        }
        return (weights > 0.0 ? (1.0 - kEven) * sum / weights : 0.0) + kEven / kPi;
    }

    double length_density(double chord) const {
        double sum = 0.0, weights = 0.0;
        for (const Sibling& one : known_) {
            const double w = weight(one);
            sum += w * gauss(portable::log(chord / one.chord), kLengthWidth);
            weights += w;
        }
        return (weights > 0.0 ? (1.0 - kEven) * sum / weights : 0.0) + kEven / 3.0;
    }

    double azimuth_density(double azimuth) const {
        double density = 1.0;
        if (!beside_.empty() && !whorled_.empty()) {
            for (const double other : beside_)
                density *= turn_density(whorled_, azimuth - other);
            return density;
        }
        if (before_) density *= turn_density(following_, azimuth - before_->chord_azimuth);
        if (after_) density *= turn_density(following_, after_->chord_azimuth - azimuth);
        return density;
    }

  private:
    void gather(const BranchStatistics& statistics, int32_t host, double shortest) {
        for (const SideBranch& side : statistics.sides(host))
            if (side.chord >= shortest) known_.push_back({side.lean, side.chord, side.share});
    }

    double weight(const Sibling& one) const { return gauss(one.share - share_, kShareWidth) + 0.02; }

    static double turn_density(const std::vector<double>& turns, double turn) {
        double sum = 0.0;
        for (const double one : turns)
            sum += gauss(turned_by(turn - one), kAzimuthWidth);
        // Few turns tell little.
        const double count = static_cast<double>(turns.size());
        const double share = std::max(kEven, kFewTurns / (kFewTurns + count));
        const double even = share / (2.0 * kPi);
        return turns.empty() ? even : (1.0 - share) * sum / count + even;
    }

    double share_;
    std::vector<Sibling> known_;
    std::vector<double> beside_, following_, whorled_;
    const SideBranch* before_ = nullptr;
    const SideBranch* after_ = nullptr;
};

}  // namespace

BranchPlane::BranchPlane(const DVec3& from, const DVec2& along, double slope) : base(from) {
    const DVec2 way = glm::normalize(DVec2(along.x, -along.y));
    const DVec3 ahead(way.x * portable::cos(slope), way.y * portable::cos(slope), -portable::sin(slope));
    normal = glm::cross(ahead, DVec3(-way.y, way.x, 0.0));
}

DVec3 BranchPlane::meet(const PinholeView& view, const DVec2& pixel, double most) const {
    const DVec2 at = (pixel - view.principal) / view.focal;
    const DVec3 ray(at.x, -at.y, -1.0);
    const double across = glm::dot(ray, normal);
    const double depth = -base.z;
    double t = std::abs(across) > 1e-9 ? glm::dot(base, normal) / across : depth;
    const double nearest = std::max(0.05 * depth, depth - most);
    t = t > 0.0 ? std::clamp(t, nearest, depth + most) : depth + most;
    return ray * t;
}

DVec3 into_camera(const PinholeView& view, const DVec3& place) {
    return glm::transpose(view.turn) * (place - view.centre);
}

DVec3 out_of_camera(const PinholeView& view, const DVec3& place) {
    return view.centre + view.turn * place;
}

double likely_slope(const Tree& tree, const BranchStatistics& statistics, const PinholeView& view,
                    NodeId host, const std::vector<DVec2>& line) {
    const int32_t branch = statistics.list().branch_of[static_cast<size_t>(host)];
    const Branch& bearing = statistics.list().branches[static_cast<size_t>(branch)];
    const std::vector<DMat3> frames = statistics.frames(branch);
    double along = 0.0;
    size_t place = bearing.attach == kNoNode ? 0 : 1;
    NodeId before = bearing.attach;
    for (const NodeId id : statistics.list().nodes_of(bearing)) {
        if (before != kNoNode) along += glm::distance(tree.node(id).position, tree.node(before).position);
        before = id;
        if (id == host) break;
        place++;
    }
    const DMat3 frame = glm::transpose(frames[std::min(place, frames.size() - 1)]);
    const DVec3 base = into_camera(view, tree.node(host).position);
    const DVec2 way = line.back() - line.front();
    if (!(glm::length(way) > 1e-6)) return 0.0;
    const double most = 2.0 * tree.bounds().diagonal();
    const double flat = glm::distance(BranchPlane(base, way, 0.0).meet(view, line.back(), most), base);
    const Siblings siblings(statistics, branch, bearing.length > 0.0 ? along / bearing.length : 0.0, along,
                            kShortest * flat);
    std::vector<double> slopes, densities;
    for (double slope = -kSteepest; slope <= kSteepest; slope += kStep) {
        const DVec3 tip = BranchPlane(base, way, slope).meet(view, line.back(), most);
        const DVec3 chord = frame * (out_of_camera(view, tip) - tree.node(host).position);
        const double length = glm::length(chord);
        const double level = portable::hypot(chord.x, chord.z);
        const double lean = portable::atan2(level, chord.y);
        // Densities of lean and azimuth are of angles; the last factors make them one of the slope.
        double density = siblings.lean_density(lean) * siblings.length_density(length) *
                         siblings.azimuth_density(portable::atan2(chord.x, chord.z));
        density *= portable::cos(slope) / std::max(0.05, level / std::max(length, 1e-9));
        slopes.push_back(slope);
        densities.push_back(density);
    }
    double best = 0.0, least = 1e300;
    for (const double slope : slopes) {
        double loss = 0.0;
        for (size_t i = 0; i < slopes.size(); i++)
            loss += densities[i] * std::min(std::abs(slopes[i] - slope), kMostLoss);
        if (loss >= least) continue;
        least = loss;
        best = slope;
    }
    return best;
}

}  // namespace treerec
