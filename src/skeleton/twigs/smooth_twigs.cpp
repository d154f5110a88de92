#include "skeleton/twigs/smooth_twigs.h"

#include <algorithm>
#include <array>
#include <vector>

#include "tree/branches.h"

namespace treerec {

namespace {

// Square radians in a metre by which the heading of thin wood drifts: 40 degrees in the root mean square.
constexpr double kDrift = 0.5;
constexpr double kStout = 0.01;       // metres: thicker wood has bends of its own (branches/bends.h)
constexpr double kUnsure = 0.006;     // metres: how far off a node lies, as a scanner's beam is wide
constexpr double kSure = 1e-5;        // metres: of what stays
constexpr double kLeastStep = 0.002;  // metres

// A symmetric system whose matrix has two diagonals beside the main one, with a place on its right side.
class PentadiagonalSystem {
  public:
    explicit PentadiagonalSystem(size_t count) : rows_(count), right_(count, DVec3(0.0)) {}

    void add_place(size_t i, double weight, const DVec3& place) {
        rows_[i][0] += weight;
        right_[i] += weight * place;
    }

    // weight times the square of a x_i + b x_i+1 + c x_i+2.
    void add_turn(size_t i, double weight, double a, double b, double c) {
        rows_[i][0] += weight * a * a;
        rows_[i][1] += weight * a * b;
        rows_[i][2] += weight * a * c;
        rows_[i + 1][0] += weight * b * b;
        rows_[i + 1][1] += weight * b * c;
        rows_[i + 2][0] += weight * c * c;
    }

    // By Cholesky's decomposition without roots.
    std::vector<DVec3> solve() {
        const size_t count = rows_.size();
        for (size_t i = 0; i < count; i++) {
            for (size_t k = 1; k <= 2 && i + k < count; k++) {
                const double share = rows_[i][k] / rows_[i][0];
                for (size_t j = k; j <= 2 && i + j < count; j++)
                    rows_[i + k][j - k] -= share * rows_[i][j];
                right_[i + k] -= share * right_[i];
            }
        }
        for (size_t i = count; i-- > 0;) {
            for (size_t k = 1; k <= 2 && i + k < count; k++)
                right_[i] -= rows_[i][k] * right_[i + k];
            right_[i] /= rows_[i][0];
        }
        return std::move(right_);
    }

  private:
    std::vector<std::array<double, 3>> rows_;  // by row: the main diagonal and the two to its right
    std::vector<DVec3> right_;
};

bool stays(const Tree& tree, NodeId id, NodeId next, double factor) {
    const Node& node = tree.node(id);
    const bool gap =
        (node.flags & kGuessFlag) != 0 || (next != kNoNode && (tree.node(next).flags & kGuessFlag) != 0);
    return gap || (node.flags & kMeasuredRadiusFlag) != 0 || factor * node.radius >= kStout;
}

// chain: from the node where the branch leaves its parent, or the first one's root, to its tip.
void smooth_chain(Tree& tree, const std::vector<NodeId>& chain, double factor) {
    const size_t count = chain.size();
    if (count < 3 || factor * tree.node(chain.back()).radius >= kStout) return;
    PentadiagonalSystem system(count);
    std::vector<double> steps(count - 1);
    std::vector<bool> fixed(count, true);
    for (size_t i = 0; i < count; i++) {
        if (i > 0) fixed[i] = stays(tree, chain[i], i + 1 < count ? chain[i + 1] : kNoNode, factor);
        const double deviation = fixed[i] ? kSure : kUnsure;
        const DVec3 place = factor * tree.node(chain[i]).position;
        system.add_place(i, 1.0 / (deviation * deviation), place);
        if (i > 0)
            steps[i - 1] =
                std::max(kLeastStep, glm::distance(place, factor * tree.node(chain[i - 1]).position));
    }
    for (size_t i = 0; i + 2 < count; i++) {
        const double before = 1.0 / steps[i], after = 1.0 / steps[i + 1];
        const double variance = kDrift * 0.5 * (steps[i] + steps[i + 1]);
        system.add_turn(i, 1.0 / variance, before, -before - after, after);
    }
    const std::vector<DVec3> smooth = system.solve();
    for (size_t i = 0; i < count; i++)
        if (!fixed[i]) tree.set_position(chain[i], smooth[i] / factor);
}

}  // namespace

void smooth_twigs(Tree& tree, double factor) {
    const BranchList list = list_branches(tree);
    for (const Branch& branch : list.branches) {
        std::vector<NodeId> chain;
        if (branch.attach != kNoNode) chain.push_back(branch.attach);
        for (const NodeId id : list.nodes_of(branch))
            chain.push_back(id);
        smooth_chain(tree, chain, factor);
    }
}

}  // namespace treerec
