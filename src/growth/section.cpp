#include "growth/section.h"

#include <algorithm>
#include <cmath>

#include "geometry/portable_math.h"
#include "growth/plan.h"
#include "growth/texture.h"

namespace treerec::growth {

namespace {

constexpr size_t kDirections = 128;  // that are kept of a section
constexpr double kLeastShare = 0.2;  // what cubics may not go below
// Of its age, after which wood leaves off being round. Bark must not shrink meanwhile: a share s of a radius
// that grows evenly is (a + (s - 1) (a - kRound) / (1 - kRound)) of it at age a, and that grows for
// all s above kRound.
constexpr double kRound = 0.2;

double periodic_cubic(std::span<const double> values, double at) {
    const double count = static_cast<double>(values.size());
    at -= std::floor(at / count) * count;
    const size_t first = std::min(static_cast<size_t>(at), values.size() - 1), n = values.size();
    const double t = at - static_cast<double>(first);
    const double a = values[(first + n - 1) % n], b = values[first], c = values[(first + 1) % n],
                 d = values[(first + 2) % n];
    return b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)));
}

}  // namespace

void BranchSections::add(double along, double round, std::span<const double> shares) {
    Row row;
    row.along = along;
    const double count = static_cast<double>(shares.size());
    for (size_t i = 0; i < kDirections; i++) {
        const double direction = static_cast<double>(i) / static_cast<double>(kDirections);
        row.shares.push_back(std::max(periodic_cubic(shares, (direction - round) * count), kLeastShare));
    }
    row.slopes.assign(kDirections, 0.0);
    const auto at = std::lower_bound(rows_.begin(), rows_.end(), along,
                                     [](const Row& one, double value) { return one.along < value; });
    if (at != rows_.end() && at->along == along)
        *at = std::move(row);
    else
        rows_.insert(at, std::move(row));
    set_slopes();
}

void BranchSections::set_slopes() {
    for (size_t r = 1; r + 1 < rows_.size(); r++) {
        const double below = rows_[r].along - rows_[r - 1].along, above = rows_[r + 1].along - rows_[r].along;
        for (size_t i = 0; i < kDirections; i++) {
            const double a = (rows_[r].shares[i] - rows_[r - 1].shares[i]) / below;
            const double b = (rows_[r + 1].shares[i] - rows_[r].shares[i]) / above;
            // The harmonic mean, the nearer part weighing more.
            const double u = below + 2.0 * above, v = 2.0 * below + above;
            rows_[r].slopes[i] = a * b > 0.0 ? (u + v) / (u / b + v / a) : 0.0;
        }
    }
    if (rows_.empty()) return;
    std::fill(rows_.front().slopes.begin(), rows_.front().slopes.end(), 0.0);
    std::fill(rows_.back().slopes.begin(), rows_.back().slopes.end(), 0.0);
}

void BranchSections::fade(double from, double to) {
    std::vector<double> shares;
    for (size_t i = 0; i < kDirections; i++)
        shares.push_back(share(from, static_cast<double>(i) / static_cast<double>(kDirections)));
    std::erase_if(rows_, [&](const Row& row) { return row.along >= from; });
    add(from, 0.0, shares);
    const double round[] = {1.0, 1.0, 1.0};
    add(to, 0.0, round);
}

BranchSections::Height BranchSections::height(double along) const {
    Height height;
    const auto after = std::lower_bound(rows_.begin(), rows_.end(), along,
                                        [](const Row& row, double value) { return row.along < value; });
    if (after == rows_.begin()) return height;
    height.row = static_cast<size_t>(after - rows_.begin()) - 1;
    if (after == rows_.end()) return height;
    const double span = after->along - rows_[height.row].along;
    const double t = (along - rows_[height.row].along) / span, s = 1.0 - t;
    height.low = (1.0 + 2.0 * t) * s * s;
    height.high = t * t * (3.0 - 2.0 * t);
    height.leave = span * t * s * s;
    height.come = -span * t * t * s;
    return height;
}

double BranchSections::share(const Height& height, double round) const {
    if (rows_.empty()) return 1.0;
    const Row &low = rows_[height.row], &high = rows_[std::min(height.row + 1, rows_.size() - 1)];
    const double at = (round - std::floor(round)) * static_cast<double>(kDirections);
    const size_t first = std::min(static_cast<size_t>(at), kDirections - 1), next = (first + 1) % kDirections;
    const double t = at - static_cast<double>(first);
    const auto in = [&](size_t i) {
        return height.low * low.shares[i] + height.high * high.shares[i] + height.leave * low.slopes[i] +
               height.come * high.slopes[i];
    };
    return glm::mix(in(first), in(next), t);
}

double BranchSections::share(double along, double round) const {
    return share(height(along), round);
}

double pace_of(double share) {
    return 1.0 + (share - 1.0) / (1.0 - kRound);
}

WoodSection::WoodSection(double radius, const BranchSections* sections, const AxisPlace& place, double age,
                         const DVec3& x)
    : radius_(radius), sections_(sections) {
    if (!sections_) return;
    height_ = sections_->height(place.along);
    age_ = age > kRound ? (1.0 - kRound / age) / (1.0 - kRound) : 0.0;
    axis_ = place.direction;
    x_ = x;
    y_ = glm::cross(axis_, x_);
}

// Of round wood, in the end.
double WoodSection::share(const DVec3& off) const {
    const double x = glm::dot(off, x_), y = glm::dot(off, y_), up = glm::dot(off, axis_);
    const double beside = std::sqrt(x * x + y * y), length = std::sqrt(beside * beside + up * up);
    if (!(beside > 0.0)) return 1.0;
    const double share = sections_->share(height_, portable::atan2(y, x) / (2.0 * kPi));
    return 1.0 + (share - 1.0) * (beside / length);
}

double WoodSection::radius(const DVec3& off) const {
    return is_round() ? radius_ : radius_ * (1.0 + (share(off) - 1.0) * age_);
}

double WoodSection::pace(const DVec3& off) const {
    return is_round() || !(age_ > 0.0) ? 1.0 : pace_of(share(off));
}

WoodSections::WoodSections(const GrowthPlan& plan) : plan_(plan), coordinates_(plan.branches.size()) {
    for (size_t b = 0; b < plan.branches.size(); b++)
        if (!plan.branches[b].sections.empty()) coordinates_[b].emplace(plan.branches[b]);
}

WoodSections::~WoodSections() = default;

WoodSection WoodSections::at(int32_t branch, const AxisPlace& place, double step) const {
    const size_t b = static_cast<size_t>(branch);
    const double radius = bark_radius(plan_, place, step);
    if (!coordinates_[b]) return {radius, nullptr, place, 1.0, DVec3(0.0)};
    return {radius, &plan_.branches[b].sections, place, age_of(plan_, place, step),
            coordinates_[b]->direction(place.along, 0.0)};
}

}  // namespace treerec::growth
