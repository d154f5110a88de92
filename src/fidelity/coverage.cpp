#include "fidelity/coverage.h"

#include <algorithm>
#include <cmath>

#include "geometry/portable_math.h"

namespace treerec {

namespace {

constexpr int kMostRows = 100000;  // of one branch
constexpr int kMostAround = 1000;

}  // namespace

BarkPatches::BarkPatches(const Tree& tree, const BranchList& list, double patch) {
    pieces_.resize(static_cast<size_t>(tree.id_end()));
    begin_.push_back(0);
    row_begin_.push_back(0);
    for (size_t b = 0; b < list.branches.size(); b++) {
        const Branch& branch = list.branches[b];
        const std::span<const NodeId> chain = list.nodes_of(branch);
        // A side branch comes out of its parent's bark, not out of its axis.
        double along = branch.attach == kNoNode ? 0.0 : -tree.node(branch.attach).radius;
        DVec3 last_axis(0.0, 1.0, 0.0), normal(1.0, 0.0, 0.0);
        for (NodeId id : chain) {
            const Node& node = tree.node(id);
            Piece& piece = pieces_[static_cast<size_t>(id)];
            piece.branch = static_cast<int32_t>(b);
            piece.start = along;
            if (node.parent == kNoNode) continue;
            piece.from = tree.node(node.parent).position;
            const DVec3 d = node.position - piece.from;
            piece.length = glm::length(d);
            if (piece.length > 0.0) {
                piece.axis = d / piece.length;
                const DVec3 bent = normal - glm::dot(normal, piece.axis) * piece.axis;
                normal = normalized_or(bent, any_perpendicular(piece.axis));
                last_axis = piece.axis;
            }
            piece.normal = normal;
            along += piece.length;
        }
        const double seen = std::max(0.0, along);
        const int rows =
            seen > 0.0 ? static_cast<int>(std::clamp(std::ceil(seen / patch), 1.0, double{kMostRows})) : 0;
        const double height = rows > 0 ? seen / rows : 1.0;
        row_height_.push_back(height);
        size_t at = 0;
        for (int row = 0; row < rows; row++) {
            const double middle = (row + 0.5) * height;
            const auto end_of = [&](NodeId id) {
                return pieces_[static_cast<size_t>(id)].start + pieces_[static_cast<size_t>(id)].length;
            };
            while (at + 1 < chain.size() && end_of(chain[at]) < middle)
                at++;
            const double around = 2.0 * kPi * tree.node(chain[at]).radius;
            const int count =
                static_cast<int>(std::clamp(std::round(around / patch), 1.0, double{kMostAround}));
            rows_.push_back({static_cast<int32_t>(area_.size()), count});
            area_.insert(area_.end(), static_cast<size_t>(count), around * height / count);
        }
        row_begin_.push_back(static_cast<int32_t>(rows_.size()));
        begin_.push_back(area_.size());
    }
}

int32_t BarkPatches::find(const DVec3& p, NodeId child) const {
    const Piece& piece = pieces_[static_cast<size_t>(child)];
    const DVec3 d = p - piece.from;
    const double t = std::clamp(glm::dot(d, piece.axis), 0.0, piece.length);
    const double along = piece.start + t;
    const size_t b = static_cast<size_t>(piece.branch);
    const int32_t rows = row_begin_[b + 1] - row_begin_[b];
    if (along < 0.0 || rows == 0) return -1;
    const int32_t row = std::min(static_cast<int32_t>(along / row_height_[b]), rows - 1);
    const Row& found = rows_[static_cast<size_t>(row_begin_[b] + row)];
    if (found.count == 1) return found.first;
    const double angle =
        portable::atan2(glm::dot(d, glm::cross(piece.axis, piece.normal)), glm::dot(d, piece.normal));
    const double turn = angle / (2.0 * kPi) + 0.5;  // 0..1
    return found.first + std::min(static_cast<int32_t>(turn * found.count), found.count - 1);
}

}  // namespace treerec
