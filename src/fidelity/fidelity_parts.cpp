#include "fidelity/fidelity_parts.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "fidelity/coverage.h"
#include "geometry/parallel.h"
#include "tree/branches.h"

namespace treerec {

namespace {

constexpr size_t kChunk = 4096;

// Sums in whole steps of 10 nm, so that they do not depend on the order of the points.
constexpr double kSumStep = 1e-8;
constexpr double kLargestSummed = 1e6;  // metres

int64_t summand(double distance) {
    return std::llround(std::min(distance, kLargestSummed) / kSumStep);
}

// Between the two order statistics that q (0..1) falls between. Reorders.
double interpolated(std::span<double> values, double q) {
    const double position = q * static_cast<double>(values.size() - 1);
    const auto below = values.begin() + static_cast<std::ptrdiff_t>(position);
    std::nth_element(values.begin(), below, values.end());
    if (below + 1 == values.end()) return *below;
    const double above = *std::min_element(below + 1, values.end());
    return *below + (above - *below) * (position - std::floor(position));
}

// Fills in what distances tell. Reorders them.
void describe(FidelityPart& part, std::span<double> distances, double tolerance) {
    part.points = distances.size();
    if (distances.empty()) return;
    int64_t sum = 0;
    size_t explained = 0;
    for (double distance : distances) {
        sum += summand(distance);
        explained += distance <= tolerance;
    }
    const double count = static_cast<double>(distances.size());
    part.mean = static_cast<double>(sum) * kSumStep / count;
    part.explained = static_cast<double>(explained) / count;
    part.p95 = interpolated(distances, 0.95);
    part.median = interpolated(distances, 0.5);
}

// Distances of the points to the bark, sorted by the class of their wood. begin: by class, one more at the
// end.
struct Sorted {
    std::vector<size_t> begin;
    std::vector<double> distances;

    std::span<double> of(size_t c) { return std::span(distances).subspan(begin[c], begin[c + 1] - begin[c]); }
};

template <typename ClassOf>
Sorted sort_into(const std::vector<BarkHit>& bark, size_t classes, const ClassOf& class_of) {
    Sorted sorted;
    sorted.begin.assign(classes + 1, 0);
    for (const BarkHit& hit : bark)
        sorted.begin[class_of(hit) + 1]++;
    for (size_t c = 0; c < classes; c++)
        sorted.begin[c + 1] += sorted.begin[c];
    std::vector<size_t> next(sorted.begin.begin(), sorted.begin.end() - 1);
    sorted.distances.resize(bark.size());
    for (const BarkHit& hit : bark)
        sorted.distances[next[class_of(hit)]++] = std::abs(hit.error);
    return sorted;
}

void add_coverage(const Tree& tree, const BranchList& list, const MeasuredPoints& measured,
                  const FidelityOptions& options, Fidelity& result, const Progress* progress) {
    const BarkPatches patches(tree, list, options.patch);
    std::vector<int32_t> on(measured.points.size(), -1);
    parallel_for(on.size(), kChunk, [&](size_t begin, size_t end) {
        if (progress) progress->check();
        for (size_t i = begin; i < end; i++)
            if (std::abs(measured.bark[i].error) <= options.tolerance)
                on[i] = patches.find(measured.points[i], measured.bark[i].child);
    });
    std::vector<uint8_t> covered(patches.size(), 0);
    for (int32_t patch : on)
        if (patch >= 0) covered[static_cast<size_t>(patch)] = 1;
    const auto finish = [](FidelityPart& part) {
        part.coverage = part.bark > 0.0 ? part.coverage / part.bark : 0.0;
    };
    for (size_t b = 0; b < list.branches.size(); b++) {
        FidelityPart& branch = result.branches[b];
        FidelityPart& order = result.by_order[static_cast<size_t>(list.branches[b].order)];
        const auto [begin, end] = patches.range_of(b);
        for (size_t patch = begin; patch < end; patch++) {
            branch.bark += patches.area(patch);
            if (covered[patch]) branch.coverage += patches.area(patch);
        }
        branch.length = list.branches[b].length;
        for (FidelityPart* sum : {&order, &result.all}) {
            sum->bark += branch.bark;
            sum->coverage += branch.coverage;
            sum->length += branch.length;
        }
        finish(branch);
    }
    finish(result.all);
    for (FidelityPart& order : result.by_order)
        finish(order);
}

void add_nodes(const Tree& tree, const std::vector<BarkHit>& bark, Fidelity& result) {
    const size_t ids = static_cast<size_t>(tree.id_end());
    result.node_points.assign(ids, 0);
    result.node_error.assign(ids, 0.0F);
    std::vector<int64_t> sums(ids, 0);
    for (const BarkHit& hit : bark) {
        result.node_points[static_cast<size_t>(hit.child)]++;
        sums[static_cast<size_t>(hit.child)] += summand(std::abs(hit.error));
    }
    for (size_t id = 0; id < ids; id++)
        if (result.node_points[id] > 0)
            result.node_error[id] =
                static_cast<float>(static_cast<double>(sums[id]) * kSumStep / result.node_points[id]);
}

}  // namespace

Fidelity sum_up(const Tree& tree, const MeasuredPoints& measured, const FidelityOptions& options,
                const Progress* progress) {
    const BranchList list = list_branches(tree);
    const std::vector<BarkHit>& bark = measured.bark;
    Fidelity result;
    result.points = bark.size();
    result.tolerance = options.tolerance;
    const auto held = [](const std::vector<NodeId>& holders) {
        const auto none = std::count(holders.begin(), holders.end(), kNoNode);
        return 1.0 - static_cast<double>(none) / static_cast<double>(holders.size());
    };
    result.skeleton = held(measured.within);
    result.skeleton_strict = held(measured.inside);

    int32_t orders = 0;
    for (const Branch& branch : list.branches)
        orders = std::max(orders, branch.order + 1);
    result.branches.resize(list.branches.size());
    result.by_order.resize(static_cast<size_t>(orders));
    const auto branch_of = [&](const BarkHit& hit) {
        return static_cast<size_t>(list.branch_of[static_cast<size_t>(hit.child)]);
    };
    const auto order_of = [&](const BarkHit& hit) {
        return static_cast<size_t>(list.branches[branch_of(hit)].order);
    };
    Sorted by_branch = sort_into(bark, result.branches.size(), branch_of);
    for (size_t b = 0; b < result.branches.size(); b++)
        describe(result.branches[b], by_branch.of(b), options.tolerance);
    if (progress) progress->check();
    Sorted by_order = sort_into(bark, result.by_order.size(), order_of);
    for (size_t order = 0; order < result.by_order.size(); order++)
        describe(result.by_order[order], by_order.of(order), options.tolerance);
    if (progress) progress->check();
    describe(result.all, by_order.distances, options.tolerance);
    if (progress) progress->check();
    add_coverage(tree, list, measured, options, result, progress);
    if (progress) progress->check();
    add_nodes(tree, bark, result);

    result.point_error.resize(bark.size());
    result.point_node.resize(bark.size());
    for (size_t i = 0; i < bark.size(); i++) {
        result.point_error[i] = static_cast<float>(bark[i].error);
        result.point_node[i] = bark[i].child;
    }
    return result;
}

}  // namespace treerec
