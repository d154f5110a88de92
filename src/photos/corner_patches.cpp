#include "photos/corner_patches.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/portable_trig.h"

namespace treerec {

namespace {

constexpr double kStep = 5.0;           // pixels between a patch's grey levels
constexpr size_t kPatchLevel = 2;       // smooth enough for that step
constexpr float kLeastContrast = 4.0F;  // grey levels: standard deviation of a patch
constexpr float kLeastAlike = 0.75F;    // normalized correlation
constexpr float kLeastRival = 0.6F;     // of what may be taken for another
constexpr float kClearly = 0.8F;        // of the second best one's distance
constexpr double kElsewhere = 10.0;     // pixels: nearer ones show the same thing
constexpr size_t kAround = 8;           // neighbours that a match is compared with
constexpr size_t kAgreeing = 3;         // of them
constexpr double kUnlike = 0.35;        // pixels of motion per pixel between two neighbours
constexpr double kUnsure = 6.0;         // pixels of motion

// How alike one patch is to all of `others`.
void compare(const CornerPatches& one, size_t i, const CornerPatches& others, std::vector<float>& alike) {
    const size_t count = others.places.size(), all = one.places.size();
    std::fill(alike.begin(), alike.end(), 0.0F);
    float* const out = alike.data();
    for (size_t k = 0; k < CornerPatches::kSize; k++) {
        const float value = one.values[k * all + i];
        const float* row = others.values.data() + k * count;
        for (size_t j = 0; j < count; j++)
            out[j] += value * row[j];
    }
}

// Those that moved as a few around them, turned as the pair is.
std::vector<CoarseMatch> supported(const std::vector<CoarseMatch>& matches, const DMat2& turn) {
    std::vector<CoarseMatch> kept;
    std::vector<std::pair<double, size_t>> near;
    for (size_t i = 0; i < matches.size(); i++) {
        near.clear();
        for (size_t j = 0; j < matches.size(); j++) {
            const DVec2 way = matches[j].from - matches[i].from;
            if (j != i) near.emplace_back(glm::dot(way, way), j);
        }
        const size_t count = std::min(kAround, near.size());
        std::partial_sort(near.begin(), near.begin() + static_cast<ptrdiff_t>(count), near.end());
        size_t agreeing = 0;
        for (size_t k = 0; k < count; k++) {
            const CoarseMatch& other = matches[near[k].second];
            const DVec2 miss = other.to - matches[i].to - turn * (other.from - matches[i].from);
            agreeing += glm::length(miss) < kUnsure + kUnlike * std::sqrt(near[k].first);
        }
        if (agreeing >= kAgreeing) kept.push_back(matches[i]);
    }
    return kept;
}

}  // namespace

DMat2 PairTurn::matrix() const {
    const SineCosine angle = portable_sine_cosine(degrees * kPi / 180.0);
    return DMat2(scale * angle.cosine, scale * angle.sine, -scale * angle.sine, scale * angle.cosine);
}

CornerPatches patches_of(const GreyPyramid& pyramid, const std::vector<Corner>& corners, size_t most,
                         const PairTurn& turn) {
    constexpr size_t kSize = CornerPatches::kSize;
    CornerPatches patches;
    const size_t level = std::min(kPatchLevel, pyramid.levels.size() - 1);
    const GreyPicture& picture = pyramid.levels[level];
    const double size = static_cast<double>(1 << level);
    const DMat2 step = (kStep / size) * turn.matrix();
    constexpr double kMiddle = 0.5 * (CornerPatches::kSide - 1.0);
    std::vector<std::array<float, kSize>> found;
    for (size_t i = 0; i < std::min(most, corners.size()); i++) {
        const DVec2 middle = corners[i].place / size;
        const DVec2 far = kMiddle * (glm::abs(step[0]) + glm::abs(step[1]));
        if (!picture.has(middle.x - far.x, middle.y - far.y) ||
            !picture.has(middle.x + far.x, middle.y + far.y))
            continue;
        std::array<float, kSize> patch;
        float sum = 0.0F, squares = 0.0F;
        for (size_t k = 0; k < kSize; k++) {
            const DVec2 at = middle + step * DVec2(static_cast<double>(k % CornerPatches::kSide) - kMiddle,
                                                   static_cast<double>(k / CornerPatches::kSide) - kMiddle);
            patch[k] = picture.at(static_cast<float>(at.x), static_cast<float>(at.y));
            sum += patch[k];
        }
        for (float& value : patch) {
            value -= sum / static_cast<float>(kSize);
            squares += value * value;
        }
        if (!(squares > kLeastContrast * kLeastContrast * static_cast<float>(kSize))) continue;
        for (float& value : patch)
            value /= std::sqrt(squares);
        found.push_back(patch);
        patches.places.push_back(corners[i].place);
        patches.corners.push_back(static_cast<uint32_t>(i));
    }
    patches.values.resize(kSize * found.size());
    for (size_t i = 0; i < found.size(); i++)
        for (size_t k = 0; k < kSize; k++)
            patches.values[k * found.size() + i] = found[i][k];
    return patches;
}

CornerPatches strongest_of(const CornerPatches& patches, size_t most) {
    const size_t all = patches.places.size();
    size_t count = 0;
    while (count < all && patches.corners[count] < most)
        count++;
    CornerPatches few;
    few.places.assign(patches.places.begin(), patches.places.begin() + static_cast<ptrdiff_t>(count));
    few.corners.assign(patches.corners.begin(), patches.corners.begin() + static_cast<ptrdiff_t>(count));
    for (size_t k = 0; k < CornerPatches::kSize; k++) {
        const auto row = patches.values.begin() + static_cast<ptrdiff_t>(k * all);
        few.values.insert(few.values.end(), row, row + static_cast<ptrdiff_t>(count));
    }
    return few;
}

std::vector<size_t> rivals_of(const CornerPatches& one, uint32_t corner, const CornerPatches& other,
                              const DVec2& but, size_t most) {
    std::vector<size_t> rivals;
    const auto at = std::lower_bound(one.corners.begin(), one.corners.end(), corner);
    if (at == one.corners.end() || *at != corner) return rivals;
    std::vector<float> alike(other.places.size());
    compare(one, static_cast<size_t>(at - one.corners.begin()), other, alike);
    while (rivals.size() < most) {
        size_t best = alike.size();
        for (size_t j = 0; j < alike.size(); j++)
            if (alike[j] >= kLeastRival && (best == alike.size() || alike[j] > alike[best]) &&
                glm::distance(other.places[j], but) > kElsewhere)
                best = j;
        if (best == alike.size()) break;
        rivals.push_back(best);
        for (size_t j = 0; j < alike.size(); j++)
            if (glm::distance(other.places[j], other.places[best]) <= kElsewhere) alike[j] = -1.0F;
    }
    return rivals;
}

std::vector<CoarseMatch> match_patches(const CornerPatches& one, const CornerPatches& other,
                                       const PairTurn& turn) {
    const size_t count = other.places.size();
    if (count < 2 || one.places.empty()) return {};
    constexpr uint32_t kNone = UINT32_MAX;
    std::vector<float> alike(count), best_back(count, -1.0F);
    std::vector<uint32_t> back(count, kNone), forth(one.places.size(), kNone);
    for (size_t i = 0; i < one.places.size(); i++) {
        compare(one, i, other, alike);
        for (size_t j = 0; j < count; j++)
            if (alike[j] > best_back[j]) {
                best_back[j] = alike[j];
                back[j] = static_cast<uint32_t>(i);
            }
        const auto best = static_cast<size_t>(std::max_element(alike.begin(), alike.end()) - alike.begin());
        if (alike[best] < kLeastAlike) continue;
        // Any that another one beats is no rival where it shows the same thing.
        const float rival = 1.0F - (1.0F - alike[best]) / kClearly;
        bool clear = true;
        for (size_t j = 0; j < count && clear; j++)
            clear = alike[j] < rival || glm::distance(other.places[j], other.places[best]) <= kElsewhere;
        if (clear) forth[i] = static_cast<uint32_t>(best);
    }
    std::vector<CoarseMatch> matches;
    for (size_t i = 0; i < one.places.size(); i++)
        if (forth[i] != kNone && back[forth[i]] == i)
            matches.push_back(
                {one.corners[i], other.corners[forth[i]], one.places[i], other.places[forth[i]]});
    return supported(matches, turn.matrix());
}

}  // namespace treerec
