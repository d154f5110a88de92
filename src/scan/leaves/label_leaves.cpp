#include "scan/leaves/label_leaves.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "error.h"
#include "scan/robust.h"

namespace treerec {

namespace {

constexpr size_t kRarest = 100;       // one of so many points may have a third label
constexpr double kFoot = 0.1;         // of the height
constexpr double kShareOfFoot = 0.8;  // of its points are wood
constexpr double kTopOfWood = 0.98;   // so much of the wood's points, by height, ends above
constexpr double kLowLeaves = 0.25;   // so much of the leaves'

// The height under which this share of the points with a label lie.
float height_under(const PointCloud& cloud, uint8_t label, double share) {
    std::vector<float> heights;
    for (size_t i = 0; i < cloud.size(); i++)
        if (cloud.labels.values[i] == label) heights.push_back(cloud.positions[i].y);
    const auto at =
        heights.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(heights.size() - 1));
    std::nth_element(heights.begin(), at, heights.end());
    return *at;
}

// Whether `wood` has the foot, and goes up from there to where leaves are.
bool stands_in(const PointCloud& cloud, uint8_t wood, uint8_t leaf) {
    const Range range = robust_ranges(cloud.positions)[1];
    const double foot = range.low + kFoot * range.size();
    size_t woody = 0, leafy = 0;
    for (size_t i = 0; i < cloud.size(); i++) {
        if (cloud.positions[i].y > foot) continue;
        woody += cloud.labels.values[i] == wood;
        leafy += cloud.labels.values[i] == leaf;
    }
    if (woody == 0 || static_cast<double>(woody) < kShareOfFoot * static_cast<double>(woody + leafy))
        return false;
    return height_under(cloud, wood, kTopOfWood) > height_under(cloud, leaf, kLowLeaves);
}

}  // namespace

LabelledLeaves find_labelled_leaves(const PointCloud& cloud) {
    LabelledLeaves found;
    if (cloud.labels.empty() || cloud.labels.by_colour) return found;
    std::array<size_t, 256> counts{};
    for (const uint8_t label : cloud.labels.values)
        counts[label]++;
    const std::string column = "The column " + quote_word(cloud.labels.column);
    if (cloud.labels.leaf_is_one) {
        // A bare tree's labels are all wood, and right; a tree without wood is none.
        found.wood = uint8_t{0};
        if (counts[1] > 0) found.leaf = uint8_t{1};
        if (counts[0] * kRarest < cloud.size()) {
            found.sentence =
                column + " calls nearly all points leaves, and was not used to tell them from wood.";
            found.leaf = found.wood = std::nullopt;
        }
    } else {
        std::vector<uint8_t> labels;
        for (size_t label = 0; label < counts.size(); label++)
            if (counts[label] * kRarest >= cloud.size()) labels.push_back(static_cast<uint8_t>(label));
        // Every LAS file has classes, and says other things by them.
        if (labels.size() > 2 && cloud.labels.column != "classification")
            found.sentence = column + " has " + std::to_string(labels.size()) +
                             " values, where two would tell leaves from wood, and was not used for it.";
        if (labels.size() != 2) return found;
        for (const auto& [wood, leaf] : {std::pair{labels[0], labels[1]}, std::pair{labels[1], labels[0]}})
            if (stands_in(cloud, wood, leaf)) {
                found.wood = wood;
                found.leaf = leaf;
            }
        if (!found.wood)
            found.sentence = column +
                             " has two values, but neither of them stands at the foot alone and reaches into "
                             "the crown, as wood does; it was not used to tell leaves from wood.";
    }
    if (!found.leaf) return found;
    found.sentence = column + " tells leaves from wood: " + std::to_string(counts[*found.leaf]) + " of " +
                     std::to_string(cloud.size()) + " points are leaves, " +
                     std::to_string(counts[*found.wood]) + " are wood.";
    return found;
}

}  // namespace treerec
