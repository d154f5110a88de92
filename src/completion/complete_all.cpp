#include "completion/complete_all.h"

#include <algorithm>

#include "completion/unexplained.h"
#include "skeleton/branches/skeleton_branches.h"

namespace treerec {

namespace {

constexpr double kWiderReach = 1.5;  // times a cluster's gap: the flood may begin so far from the joint
constexpr double kBeyondGap = 0.05;  // metres more

// Passes a cancel on, and no progress: one proposal is too short for it.
class Quiet final : public Progress {
  public:
    explicit Quiet(const Progress& whole) : whole_(whole) {}
    bool cancelled() const override { return whole_.cancelled(); }

  private:
    const Progress& whole_;
};

}  // namespace

CompletedTree complete_all(Tree& tree, const PointCloud& cloud, const CompleteAllOptions& options,
                           const std::vector<uint8_t>& wood, Progress* listener) {
    SubProgress progress(listener, 0.0, 1.0);
    progress.update(0.0, "Unexplained points");
    const double least_length =
        options.least_length > 0.0 ? options.least_length : automatic_branch(tree.bounds().diagonal());
    Tree grown = tree;
    CompletedTree walked;
    FidelityTracker tracker(cloud);
    const Fidelity first = tracker.update(grown, &progress);
    walked.explained_before = first.all.explained;
    UnexplainedOptions finding;
    finding.least_points = options.least_points;
    // The joints of one look are still there after the others were followed: nothing is taken away.
    const std::vector<UnexplainedCluster> clusters =
        find_unexplained(grown, cloud, first, wood, finding, &progress);
    Quiet preparing(progress);
    Completer completer(grown, cloud, options.branch, wood, &preparing);
    const size_t count = std::min(options.most, clusters.size());
    for (size_t c = 0; c < count; c++) {
        progress.check();
        Quiet quiet(progress);
        progress.update(0.1 + 0.9 * static_cast<double>(c) / static_cast<double>(count), "Completing");
        const UnexplainedCluster& cluster = clusters[c];
        const double reach =
            options.branch.reach > 0.0 ? options.branch.reach : kWiderReach * cluster.gap + kBeyondGap;
        try {
            const Completion done =
                completer.complete(grown, cluster.joint, cluster.direction, reach, &quiet);
            if (done.length < least_length) {
                grown.remove_subtree(done.added.front());
                walked.refused++;
            } else {
                walked.branches.push_back(done);
            }
        } catch (const Cancelled&) {
            throw;
        } catch (const Error&) {
            // Another branch has explained it meanwhile, or nothing hangs together there.
            walked.refused++;
        }
    }
    walked.explained_after = tracker.update(grown, &progress).all.explained;
    tree = std::move(grown);
    progress.update(1.0, "Completing");
    return walked;
}

}  // namespace treerec
