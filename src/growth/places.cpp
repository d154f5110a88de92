#include "growth/places.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "error.h"
#include "growth/feature.h"
#include "growth/texture.h"
#include "growth/tree_plan.h"

namespace treerec {

namespace {

using growth::AxisPlace;
using growth::BranchCoordinates;
using growth::GrowthBranch;

constexpr int kAround = 40, kMostAlong = 160;  // quads of a patch
constexpr int kMouth = 24;                     // likewise, of a mouth
constexpr double kAboveMouth = 0.04;           // radii over the wood: tubes have flat sides and bend
constexpr double kLeast = 5e-4;                // metres: what is lifted by less is left out
constexpr double kAbove = 1e-3;                // metres over the tube, so that both are told apart

}  // namespace

struct BarkPlaces::Data {
    BranchList list;
    growth::TreePlan planned;
    std::vector<BranchCoordinates> coordinates;  // by branch of the plan
    std::vector<NodeId> nodes;                   // likewise: from where its places are told,
    std::vector<double> begins;                  // and metres along its axis of that node
    std::vector<DVec3> positions;                // by node id
    NodeId root = kNoNode;

    // Of the plan; -1: a tube.
    int32_t branch_of(NodeId node) const {
        if (node < 0 || static_cast<size_t>(node) >= list.branch_of.size()) return -1;
        const auto at = std::find(planned.branch_of.begin(), planned.branch_of.end(), list.branch_of[node]);
        return at == planned.branch_of.end() ? -1 : static_cast<int32_t>(at - planned.branch_of.begin());
    }

    double along_of(size_t branch, NodeId node) const {
        if (node == root) return 0.0;
        const std::vector<AxisPlace>& axis = planned.plan.branches[branch].axis;
        const DVec3 place = positions[static_cast<size_t>(node)];
        return std::min_element(axis.begin(), axis.end(),
                                [&](const AxisPlace& a, const AxisPlace& b) {
                                    return glm::distance(a.position, place) <
                                           glm::distance(b.position, place);
                                })
            ->along;
    }

    BarkPlace place(size_t branch, NodeId node, double from, double along, double around) const {
        const GrowthBranch& grown = planned.plan.branches[branch];
        along = std::clamp(along, std::max(grown.axis.front().along, branch == 0 ? 0.0 : -INFINITY),
                           grown.axis.back().along);
        const AxisPlace at = growth::place_at(grown, along);
        BarkPlace found;
        found.node = node;
        found.along = along - from;
        found.around = around;
        found.axis = at.position;
        found.direction = at.direction;
        found.out = coordinates[branch].direction(along, around / 360.0);
        found.radius = at.radius;
        return found;
    }
};

BarkPlaces::BarkPlaces(const Tree& tree, double longest, double shortest) : data_(std::make_unique<Data>()) {
    Data& data = *data_;
    data.list = list_branches(tree);
    data.root = tree.root();
    try {
        data.planned = growth::plan_tree(tree, data.list, longest, shortest, 0);
    } catch (const Error&) {
        // Nothing is thick enough: that is told by whoever grows it.
        return;
    }
    data.positions.resize(data.list.branch_of.size());
    for (const NodeId node : data.list.nodes)
        data.positions[static_cast<size_t>(node)] = tree.node(node).position;
    const size_t count = data.planned.plan.branches.size();
    for (size_t b = 0; b < count; b++) {
        data.coordinates.emplace_back(data.planned.plan.branches[b]);
        const Branch& branch = data.list.branches[static_cast<size_t>(data.planned.branch_of[b])];
        const NodeId node = b == 0 ? data.root : data.list.nodes[static_cast<size_t>(branch.begin)];
        data.nodes.push_back(node);
        data.begins.push_back(data.along_of(b, node));
    }
}

BarkPlaces::~BarkPlaces() = default;
BarkPlaces::BarkPlaces(BarkPlaces&&) noexcept = default;
BarkPlaces& BarkPlaces::operator=(BarkPlaces&&) noexcept = default;

std::optional<BarkPlace> BarkPlaces::pick(const DVec3& from, const DVec3& way) const {
    const DVec3 ahead = glm::normalize(way);
    double nearest = std::numeric_limits<double>::infinity();
    size_t branch = 0;
    DVec3 hit{0.0};
    const std::vector<GrowthBranch>& branches = data_->planned.plan.branches;
    // The places of an axis lie so close that the balls about them are its tube.
    for (size_t b = 0; b < branches.size(); b++)
        for (const AxisPlace& place : branches[b].axis) {
            if (b == 0 && place.along < 0.0) continue;
            const DVec3 off = place.position - from;
            const double middle = glm::dot(off, ahead);
            const double half = place.radius * place.radius - (glm::dot(off, off) - middle * middle);
            if (half < 0.0) continue;
            const double distance = middle - std::sqrt(half);
            if (distance <= 0.0 || distance >= nearest) continue;
            nearest = distance;
            branch = b;
            hit = from + ahead * distance;
        }
    if (!std::isfinite(nearest)) return std::nullopt;
    const GrowthBranch& grown = branches[branch];
    // Where the axis comes nearest.
    const AxisPlace* at = &grown.axis.front();
    for (const AxisPlace& place : grown.axis)
        if (glm::distance(place.position, hit) < glm::distance(at->position, hit)) at = &place;
    const double along = at->along + glm::dot(hit - at->position, at->direction);
    const double around = 360.0 * data_->coordinates[branch].around(hit, along);
    return data_->place(branch, data_->nodes[branch], data_->begins[branch], along, around);
}

std::optional<BarkPlace> BarkPlaces::find(const GrowthPlace& place) const {
    const int32_t branch = data_->branch_of(place.node);
    if (branch < 0) return std::nullopt;
    const double from = data_->along_of(static_cast<size_t>(branch), place.node);
    return data_->place(static_cast<size_t>(branch), place.node, from, from + place.along, place.around);
}

Mesh BarkPlaces::mouth(const GrowthFeature& hollow) const {
    Mesh patch;
    const int32_t found = data_->branch_of(hollow.node);
    if (found < 0 || hollow.width <= 0.0 || hollow.height <= 0.0) return patch;
    const size_t branch = static_cast<size_t>(found);
    const double from = data_->along_of(branch, hollow.node);
    const BarkPlace middle = data_->place(branch, hollow.node, from, from + hollow.along, hollow.around);
    const GrowthBranch& grown = data_->planned.plan.branches[branch];
    const double half = 0.5 * hollow.height, centre = from + middle.along;
    const double begin = std::max(centre - half, branch == 0 ? 0.0 : grown.axis.front().along);
    const double end = std::min(centre + half, grown.axis.back().along);
    const double widest = std::min(0.5 * hollow.width / std::max(middle.radius, 1e-6) * 180.0 / kPi, 180.0);
    for (int i = 0; i <= kMouth; i++)
        for (int j = 0; j <= kMouth; j++) {
            const double at = begin + (end - begin) * i / kMouth, turn = 2.0 * j / kMouth - 1.0;
            const BarkPlace place =
                data_->place(branch, hollow.node, from, at, hollow.around + widest * turn);
            patch.positions.push_back(Vec3(place.position() + place.out * (kAboveMouth * place.radius)));
            patch.normals.push_back(Vec3(place.out));
            patch.tangents.push_back(Vec4(Vec3(glm::cross(place.direction, place.out)), 1.0f));
            patch.uvs.push_back(Vec2(static_cast<float>(turn), static_cast<float>((at - centre) / half)));
            patch.custom0.push_back(Vec4(Vec3(DVec3(0.5 * hollow.width, half, hollow.depth)), 0.0f));
        }
    for (int i = 0; i < kMouth; i++)
        for (int j = 0; j < kMouth; j++) {
            const uint32_t a = static_cast<uint32_t>(i * (kMouth + 1) + j), b = a + 1, c = a + kMouth + 1;
            patch.indices.insert(patch.indices.end(), {a, b, c + 1, a, c + 1, c});
        }
    return patch;
}

Mesh BarkPlaces::lift(const GrowthFeature& burl, double twist) const {
    Mesh patch;
    const int32_t found = data_->branch_of(burl.node);
    if (found < 0 || burl.radius <= 0.0) return patch;
    const size_t branch = static_cast<size_t>(found);
    const double from = data_->along_of(branch, burl.node);
    std::vector<DVec3> centres;
    const int sides = burl.length > 0.0
                          ? static_cast<int>(std::min(0.5 * burl.length / std::max(burl.every, 1e-3), 500.0))
                          : 0;
    for (int i = -sides; i <= sides; i++) {
        const double off = i * burl.every;
        const double turn = off * twist * 180.0 / kPi;
        centres.push_back(
            data_->place(branch, burl.node, from, from + burl.along + off, burl.around + turn).position());
    }
    const BarkPlace middle = data_->place(branch, burl.node, from, from + burl.along, burl.around);
    const double reach = burl.radius + 0.5 * burl.length;
    const GrowthBranch& grown = data_->planned.plan.branches[branch];
    const double begin = std::max(from + middle.along - reach, branch == 0 ? 0.0 : grown.axis.front().along);
    const double end = std::min(from + middle.along + reach, grown.axis.back().along);
    const double share = std::min(burl.radius / std::max(middle.radius, 1e-6), 2.0);
    const double widest =
        twist != 0.0 && sides > 0 ? 180.0 : std::min(180.0, 360.0 / kPi * std::asin(0.5 * share));
    const int along =
        std::clamp(static_cast<int>(kAround * (end - begin) / (2.0 * burl.radius)), 8, kMostAlong);
    std::vector<char> lifted;
    for (int i = 0; i <= along; i++)
        for (int j = 0; j <= kAround; j++) {
            const double at = begin + (end - begin) * i / along;
            const double around = burl.around + widest * (2.0 * j / kAround - 1.0);
            const BarkPlace place = data_->place(branch, burl.node, from, at, around);
            double growth = 0.0;
            for (const DVec3& centre : centres)
                growth = std::max(growth, growth::burl_growth(burl.radius, burl.inner, burl.growth,
                                                              glm::distance(centre, place.position())));
            const double height = growth * (1.0 - burl.from) * place.radius;
            lifted.push_back(height > kLeast);
            patch.positions.push_back(Vec3(place.position() + place.out * (height + kAbove)));
            patch.uvs.push_back(
                Vec2(static_cast<float>(around / 180.0 * kPi * middle.radius), static_cast<float>(at)));
        }
    patch.normals.assign(patch.positions.size(), Vec3(0.0f));
    const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
        const Vec3 normal =
            glm::cross(patch.positions[b] - patch.positions[a], patch.positions[c] - patch.positions[a]);
        for (const uint32_t corner : {a, b, c})
            patch.normals[corner] += normal;
        if (lifted[a] || lifted[b] || lifted[c]) patch.indices.insert(patch.indices.end(), {a, b, c});
    };
    for (int i = 0; i < along; i++)
        for (int j = 0; j < kAround; j++) {
            const uint32_t a = static_cast<uint32_t>(i * (kAround + 1) + j), b = a + 1, c = a + kAround + 1;
            add(a, b, c + 1);
            add(a, c + 1, c);
        }
    for (Vec3& normal : patch.normals)
        normal = glm::length(normal) > 0.0f ? glm::normalize(normal) : Vec3(0.0f, 1.0f, 0.0f);
    return patch;
}

}  // namespace treerec
