#include "skeleton/branches/fork_points.h"

#include <algorithm>

namespace treerec {

namespace {

constexpr size_t kMostPoints = 400;

}  // namespace

void gather_points(const SkeletonBranch& branch, const Slices& slices, int32_t first, int32_t last,
                   std::vector<uint32_t>& found) {
    const auto take = [&](int32_t slice, int32_t at) {
        if (at < first || at > last) return;
        for (const uint32_t v : slices.points_of(static_cast<size_t>(slice)))
            found.push_back(v);
    };
    for (size_t i = 0; i < branch.slices.size(); i++)
        take(branch.slices[i], static_cast<int32_t>(i));
    for (size_t m = 0; m < branch.merged.size(); m++)
        take(branch.merged[m], branch.merged_at[m]);
    for (size_t a = 0; a < branch.absorbed.size(); a++)
        take(branch.absorbed[a], branch.absorbed_at[a]);
}

void thin_out(std::vector<uint32_t>& found) {
    std::sort(found.begin(), found.end());
    if (found.size() <= kMostPoints) return;
    const size_t every = (found.size() + kMostPoints - 1) / kMostPoints;
    size_t kept = 0;
    for (size_t i = 0; i < found.size(); i += every)
        found[kept++] = found[i];
    found.resize(kept);
}

}  // namespace treerec
