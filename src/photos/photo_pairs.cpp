#include "photos/photo_pairs.h"

#include <algorithm>
#include <set>

#include "geometry/parallel.h"

namespace treerec {

namespace {

using Pair = std::pair<size_t, size_t>;

std::vector<Pair> candidates(size_t count, const PhotoPairOptions& options) {
    std::vector<Pair> pairs;
    for (size_t i = 0; i < count; i++)
        for (size_t j = i + 1; j < count; j++)
            if (!options.sequence || j - i <= options.steps ||
                (i < options.closing && j + options.closing >= count))
                pairs.emplace_back(i, j);
    return pairs;
}

}  // namespace

std::vector<Pair> choose_photo_pairs(const std::vector<PhotoFeatures>& features,
                                     const PhotoPairOptions& options, Progress* progress) {
    const size_t count = features.size();
    std::vector<CornerPatches> patches(count);
    for (size_t i = 0; i < count; i++)
        patches[i] = strongest_of(features[i].patches, options.corners);
    const std::vector<Pair> pairs = candidates(count, options);
    std::vector<size_t> shared(pairs.size());
    parallel_for(pairs.size(), 16, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; k++) {
            if (progress) progress->check();
            shared[k] = match_patches(patches[pairs[k].first], patches[pairs[k].second]).size();
        }
    });
    std::set<Pair> chosen;
    for (size_t i = 0; i + 1 < count; i++)
        chosen.emplace(i, i + 1);
    std::vector<std::vector<std::pair<size_t, size_t>>> of(count);  // what is shared, and the pair
    for (size_t k = 0; k < pairs.size(); k++)
        if (shared[k] >= options.least) {
            of[pairs[k].first].emplace_back(shared[k], k);
            of[pairs[k].second].emplace_back(shared[k], k);
        }
    for (auto& others : of) {
        std::stable_sort(others.begin(), others.end(),
                         [](const auto& a, const auto& b) { return a.first > b.first; });
        for (size_t k = 0; k < std::min(options.alike, others.size()); k++)
            chosen.insert(pairs[others[k].second]);
    }
    return {chosen.begin(), chosen.end()};
}

}  // namespace treerec
