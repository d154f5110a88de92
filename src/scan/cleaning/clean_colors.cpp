#include <algorithm>
#include <cmath>

#include "scan/cleaning/clean_steps.h"
#include "scan/robust.h"

namespace treerec {

namespace {

// Fewer than this share of the points go without a word, and whatever they are.
constexpr double kFew = 0.02;
constexpr size_t kLookedAt = 16384;  // points, of which so many that are extreme are judged:
constexpr size_t kJudged = 256;
constexpr double kAround = 0.04;  // of the extent: the piece of a branch that tells its axis
constexpr size_t kLeastAround = 5;
// Sky that was taken for wood lies around it: on average further from the axis than this share of the other
// points. What has the colour by nature, or from the sun, lies among them, below 0.6.
constexpr double kRim = 0.65;
// Of the nearest points, where the extreme ones are strewn over the tree.
constexpr size_t kNearest = 8;
constexpr double kStrewn = 0.5;

enum class Shade : uint8_t { kUsual, kWhite, kBlack };

bool has_real_colors(const PointCloud& cloud) {
    for (const Color8& c : cloud.colors)
        if (c != cloud.colors.front()) return true;
    return false;
}

bool before(const Vec3& a, const Vec3& b) {
    return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
}

// The points of one or the other kind, thinned alike, in an order of their own.
struct Looked {
    std::vector<Vec3> points;
    std::vector<uint8_t> extreme;
};

Looked look(const PointCloud& cloud, const std::vector<Shade>& shades, Shade which,
            const Progress* progress) {
    std::array<std::vector<Vec3>, 2> kinds;
    for (size_t i = 0; i < shades.size(); i++)
        if (shades[i] == which || shades[i] == Shade::kUsual)
            kinds[shades[i] == which].push_back(cloud.positions[i]);
    const double share = std::min(
        1.0, static_cast<double>(kLookedAt) / static_cast<double>(kinds[0].size() + kinds[1].size()));
    Looked looked;
    for (const uint8_t extreme : {0, 1}) {
        const auto wanted =
            static_cast<size_t>(std::ceil(share * static_cast<double>(kinds[extreme].size())));
        std::vector<Vec3> some = some_of(kinds[extreme], wanted, progress);
        std::sort(some.begin(), some.end(), before);
        looked.points.insert(looked.points.end(), some.begin(), some.end());
        looked.extreme.insert(looked.extreme.end(), some.size(), extreme);
    }
    return looked;
}

// The axis of a piece of branch: through the mean, the way in which it extends most.
DVec3 axis_of(const std::vector<DVec3>& from_mean) {
    DMat3 covariance(0.0);
    for (const DVec3& d : from_mean)
        covariance += glm::outerProduct(d, d);
    int widest = 0;
    for (int axis = 1; axis < 3; axis++)
        if (covariance[axis][axis] > covariance[widest][widest]) widest = axis;
    DVec3 axis = normalized_or(covariance[widest], DVec3(0.0, 1.0, 0.0));
    for (int step = 0; step < 16; step++)
        axis = normalized_or(covariance * axis, axis);
    return axis;
}

// Whether points of this shade are no part of the tree: around it, as sky is, or strewn over it, as noise is.
bool is_foreign(const PointCloud& cloud, const std::vector<Shade>& shades, Shade which, double extent,
                const Progress* progress) {
    const Looked looked = look(cloud, shades, which, progress);
    const double reach = kAround * extent;
    std::vector<size_t> judged;
    for (size_t i = 0; i < looked.points.size(); i++)
        if (looked.extreme[i]) judged.push_back(i);
    const size_t stride = std::max<size_t>(1, judged.size() / kJudged);
    double rim = 0.0;
    double alike = 0.0;
    size_t count = 0;
    std::vector<DVec3> around;
    std::vector<uint8_t> extreme;
    std::vector<std::pair<double, uint8_t>> distances;
    for (size_t j = stride / 2; j < judged.size(); j += stride, count++) {
        if (progress) progress->check();
        const DVec3 place(looked.points[judged[j]]);
        around.clear();
        extreme.clear();
        distances.clear();
        DVec3 mean(0.0);
        for (size_t i = 0; i < looked.points.size(); i++) {
            const DVec3 p(looked.points[i]);
            const double distance = glm::length(p - place);
            distances.emplace_back(distance, looked.extreme[i]);
            if (distance > reach) continue;
            around.push_back(p);
            extreme.push_back(looked.extreme[i]);
            mean += p;
        }
        const size_t nearest = std::min(kNearest + 1, distances.size());
        std::partial_sort(distances.begin(), distances.begin() + static_cast<ptrdiff_t>(nearest),
                          distances.end());
        // The first one is the point itself, or one at its place.
        for (size_t n = 1; n < nearest; n++)
            alike += distances[n].second / static_cast<double>(nearest - 1);

        mean /= static_cast<double>(around.size());
        for (DVec3& p : around)
            p -= mean;
        const DVec3 axis = axis_of(around);
        const auto off_axis = [&](const DVec3& d) { return glm::length(d - glm::dot(d, axis) * axis); };
        const double own = off_axis(place - mean);
        size_t others = 0;
        size_t inside = 0;
        for (size_t i = 0; i < around.size(); i++) {
            if (extreme[i]) continue;
            others++;
            inside += off_axis(around[i]) < own;
        }
        if (others >= kLeastAround) rim += static_cast<double>(inside) / static_cast<double>(others);
    }
    return rim > kRim * static_cast<double>(count) || alike < kStrewn * static_cast<double>(count);
}

}  // namespace

void clean_colors(PointCloud& cloud, const CleanOptions& options, CleanReport& report,
                  const Progress* progress) {
    size_t removed = 0;
    if (has_real_colors(cloud)) {
        std::vector<Shade> shades(cloud.size(), Shade::kUsual);
        std::array<size_t, 3> counts{};
        for (size_t i = 0; i < cloud.size(); i++) {
            const Color8& c = cloud.colors[i];
            const auto [low, high] = std::minmax({c[0], c[1], c[2]});
            if (low >= options.white_above) shades[i] = Shade::kWhite;
            if (high <= options.black_below) shades[i] = Shade::kBlack;
            counts[static_cast<size_t>(shades[i])]++;
        }
        const std::array<Range, 3> ranges = robust_ranges(cloud.positions, progress);
        const double extent = std::max({ranges[0].size(), ranges[1].size(), ranges[2].size()});
        // Noise against the sky is a part of the points; half of them would be the way the cloud is painted.
        const size_t extreme = counts[1] + counts[2];
        const bool painted = extreme * 2 > cloud.size();
        if (painted)
            report.warnings.push_back("More than half of the points are near white or near black (" +
                                      std::to_string(extreme) + "); they were kept.");
        std::array<bool, 3> goes{};
        for (const Shade shade : {Shade::kWhite, Shade::kBlack}) {
            const auto s = static_cast<size_t>(shade);
            if (painted || counts[s] == 0) continue;
            const double share = static_cast<double>(counts[s]) / static_cast<double>(cloud.size());
            goes[s] = share <= kFew || is_foreign(cloud, shades, shade, extent, progress);
            if (goes[s]) removed += counts[s];
            if (share <= kFew) continue;
            const std::string what = std::to_string(std::lround(100.0 * share)) +
                                     " % of the points are near " +
                                     (shade == Shade::kWhite ? "white" : "black");
            report.warnings.push_back(
                goes[s]
                    ? what +
                          " and lie around the wood or strewn over it, as background and noise do; they were "
                          "left out. If they are part of the tree, leave out the cleaning of colours."
                    : what + ", but lie on the tree as bark does; they were kept.");
        }
        std::vector<uint8_t> keep(cloud.size());
        for (size_t i = 0; i < keep.size(); i++)
            keep[i] = !goes[static_cast<size_t>(shades[i])];
        if (removed > 0) cloud.keep_only(keep);
    }
    report.steps.push_back({"Extreme colours", removed});
}

}  // namespace treerec
