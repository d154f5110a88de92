#include "growth/bark_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "error.h"
#include "geometry/parallel.h"
#include "growth/bark_map.h"
#include "growth/box_grid.h"
#include "mesh/branch_tubes.h"
#include "tree/measure.h"

namespace treerec {

namespace {

using namespace growth;

constexpr double kSlice = 0.1;       // metres
constexpr size_t kDirections = 24;   // of a slice
constexpr double kSeen = 0.75;       // of them
constexpr double kHalf = 0.5;        // of them, that must be seen for the diameter at breast height,
constexpr double kBeside = 0.25;     // metres above and below it
constexpr double kGridCell = 0.05;   // metres
constexpr double kNearest = 0.02;    // metres: where a triangle is looked for first
constexpr double kFarthest = 100.0;  // metres
constexpr double kSamples = 0.25;    // longest edges between samples of a surface
constexpr double kTenthMillimetre = 1e-4;
constexpr size_t kPointsPerCheck = 256;

// Squared, from p to the triangle: through the regions of its corners, edges and inside (Ericson
// 2005, 5.1.5).
double square_to_triangle(const DVec3& p, const DVec3& a, const DVec3& b, const DVec3& c) {
    const auto to = [&](const DVec3& q) { return glm::dot(p - q, p - q); };
    const DVec3 ab = b - a, ac = c - a, ap = p - a;
    const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0.0 && d2 <= 0.0) return to(a);
    const DVec3 bp = p - b;
    const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0.0 && d4 <= d3) return to(b);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return to(a + ab * (d1 / std::max(d1 - d3, 1e-300)));
    const DVec3 cp = p - c;
    const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0.0 && d5 <= d6) return to(c);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return to(a + ac * (d2 / std::max(d2 - d6, 1e-300)));
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0)
        return to(b + (c - b) * ((d4 - d3) / std::max(d4 - d3 + d5 - d6, 1e-300)));
    const double whole = va + vb + vc;
    return whole > 0.0 ? to(a + ab * (vb / whole) + ac * (vc / whole)) : to(a);
}

class MeshDistance {
  public:
    explicit MeshDistance(const Mesh& mesh) : mesh_(mesh), grid_(kGridCell) {
        for (size_t i = 0; i < mesh.triangle_count(); i++) {
            Box box;
            for (size_t k = 0; k < 3; k++)
                box.take(corner(i, k));
            grid_.add(static_cast<uint32_t>(i), box);
        }
    }

    // Metres to the nearest triangle.
    double to(const DVec3& p) const {
        for (double reach = kNearest; reach < kFarthest; reach *= 2.0) {
            double least = std::numeric_limits<double>::max();
            grid_.visit(Box{p, p}.grown(reach), [&](uint32_t i) {
                least = std::min(least, square_to_triangle(p, corner(i, 0), corner(i, 1), corner(i, 2)));
            });
            if (least <= reach * reach) return std::sqrt(least);
        }
        return kFarthest;
    }

  private:
    DVec3 corner(size_t triangle, size_t k) const {
        return DVec3(mesh_.positions[mesh_.indices[3 * triangle + k]]);
    }

    const Mesh& mesh_;
    BoxGrid grid_;
};

std::vector<double> distances(const Mesh& mesh, std::span<const DVec3> points, const Progress* progress) {
    const MeshDistance nearest(mesh);
    std::vector<double> found(points.size());
    parallel_for(points.size(), kPointsPerCheck, [&](size_t begin, size_t end) {
        if (progress) progress->check();
        for (size_t i = begin; i < end; i++)
            found[i] = nearest.to(points[i]);
    });
    return found;
}

BarkDistances summed(std::vector<double>& values) {
    BarkDistances result;
    if (values.empty()) return result;
    std::sort(values.begin(), values.end());
    for (const double value : values)
        result.mean += value;
    result.mean /= static_cast<double>(values.size());
    result.median = values[values.size() / 2];
    result.p95 = values[static_cast<size_t>(0.95 * static_cast<double>(values.size() - 1))];
    return result;
}

// A point that counts.
struct Place {
    double along = 0.0;
    double lump = 0.0;  // metres beyond the wood's radius, over it
    bool trunk = false;
};

// Even samples of the grown surface.
std::vector<DVec3> samples_of(const GrownBark& bark, double apart) {
    std::vector<DVec3> samples;
    for (size_t i = 0; i < bark.indices.size(); i += 3) {
        const DVec3 a(bark.vertices[bark.indices[i]].position),
            b(bark.vertices[bark.indices[i + 1]].position), c(bark.vertices[bark.indices[i + 2]].position);
        const double side = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
        const int parts = std::max(static_cast<int>(std::ceil(side / apart)), 1);
        for (int u = 0; u < parts; u++)
            for (int v = 0; u + v < parts; v++)
                samples.push_back(a + (b - a) * ((u + 1.0 / 3.0) / parts) +
                                  (c - a) * ((v + 1.0 / 3.0) / parts));
    }
    return samples;
}

// Mean radius of a row over the directions that both maps know; 0 where they are too few.
std::pair<double, double> radii_of(const BarkMap& scan, const BarkMap& grown, size_t row) {
    double a = 0.0, b = 0.0, seen = 0.0;
    for (size_t column = 0; column < scan.columns; column++) {
        const double x = scan.height[scan.cell(row, column)], y = grown.height[grown.cell(row, column)];
        if (std::isnan(x) || std::isnan(y)) continue;
        a += scan.radius[row] + x;
        b += grown.radius[row] + y;
        seen += 1.0;
    }
    if (seen < kSeen * static_cast<double>(scan.columns)) return {0.0, 0.0};
    return {a / seen, b / seen};
}

struct Diameters {
    double scan = 0.0, grown = 0.0;  // metres
};

// Of the slice at `height` metres where enough of the round is seen, else by slices beside it, too: by how
// far the grown bark is outside of the scan's, fitted by a circle off the axis, so that what one side alone
// shows does not count for the other. Nothing where less than half is seen.
Diameters diameters(const BarkMap& scan, const BarkMap& grown, double height) {
    std::vector<uint8_t> seen(scan.columns, 0);
    glm::dmat3 normal(0.0);
    DVec3 right(0.0);
    double sum = 0.0, count = 0.0;
    Diameters found;
    if (height < scan.begin || height > scan.begin + scan.step * static_cast<double>(scan.rows)) return found;
    const size_t own = std::min(static_cast<size_t>((height - scan.begin) / scan.step), scan.rows - 1);
    for (size_t row = 0; row < scan.rows; row++) {
        if (std::abs(scan.along(row) - height) > kBeside + 0.5 * kSlice) continue;
        if (row == own) {
            const auto [r_scan, r_grown] = radii_of(scan, grown, row);
            if (r_scan > 0.0) return {2.0 * r_scan, 2.0 * r_grown};
        }
        for (size_t column = 0; column < scan.columns; column++) {
            const double x = scan.height[scan.cell(row, column)], y = grown.height[grown.cell(row, column)];
            if (std::isnan(y)) continue;
            if (row == own) {
                sum += grown.radius[row] + y;
                count += 1.0;
            }
            if (std::isnan(x)) continue;
            seen[column] = 1;
            const double angle = 2.0 * kPi * (static_cast<double>(column) + 0.5) / scan.columns;
            const DVec3 shape(1.0, std::cos(angle), std::sin(angle));
            normal += glm::outerProduct(shape, shape);
            right += shape * (y - x);
        }
    }
    const double known = static_cast<double>(std::count(seen.begin(), seen.end(), 1));
    if (known < kHalf * static_cast<double>(scan.columns) ||
        count < kSeen * static_cast<double>(scan.columns))
        return {};
    const double outside = (glm::inverse(normal) * right).x;
    found.grown = 2.0 * sum / count;
    found.scan = found.grown - 2.0 * outside;
    return found;
}

class Judge {
  public:
    Judge(const Tree& tree, const GrowthRecipe& recipe, Progress* progress)
        : tree_(tree),
          recipe_(recipe),
          list_(list_branches(tree)),
          planned_(plan_tree(tree, list_, recipe.longest, recipe.shortest, recipe.steps)),
          axes_(tree, list_, planned_),
          progress_(progress) {}

    BarkFit judge(const GrownBark& bark, const PointCloud& cloud) {
        if (progress_) progress_->update(0.0, "Comparing with the scan");
        const std::vector<DVec3> points = points_near(tree_, cloud);
        const std::vector<BarkSpot> spots = axes_.find_all(points, progress_);
        const std::vector<DVec3> samples = samples_of(bark, kSamples * recipe_.longest);
        const std::vector<BarkSpot> sampled = axes_.find_all(samples, progress_);
        for (size_t b = 0; b < planned_.plan.branches.size(); b++)
            compare(static_cast<int32_t>(b), spots, sampled, points);
        if (chosen_.empty())
            throw Error(
                "No point of the scan lies on the bark that grew: is it the scan that this tree was made "
                "of?");
        if (progress_) progress_->update(0.3, "Comparing with the scan");
        TubeOptions options;
        const std::vector<double> tubes =
            distances(build_branch_tubes(tree_, options, progress_), chosen_, progress_);
        if (progress_) progress_->update(0.6, "Comparing with the scan");
        options.grown = &bark;
        const std::vector<double> grown =
            distances(build_branch_tubes(tree_, options, progress_), chosen_, progress_);
        finish(tubes, grown);
        return fit_;
    }

  private:
    static std::vector<BarkSpot> of_branch(const std::vector<BarkSpot>& spots, int32_t branch) {
        std::vector<BarkSpot> own;
        std::copy_if(spots.begin(), spots.end(), std::back_inserter(own),
                     [&](const BarkSpot& spot) { return spot.branch == branch; });
        return own;
    }

    // Slices of a branch, and its points that count.
    void compare(int32_t branch, const std::vector<BarkSpot>& spots, const std::vector<BarkSpot>& sampled,
                 const std::vector<DVec3>& points) {
        if (progress_) progress_->check();
        const auto [begin, end] = axes_.own_part(branch);
        const GrowthBranch& own = planned_.plan.branches[static_cast<size_t>(branch)];
        const std::vector<BarkSpot> mine = of_branch(spots, branch);
        const BarkMap scan = map_bark(own, mine, begin, end, kSlice, kDirections);
        const BarkMap grown = map_bark(own, of_branch(sampled, branch), begin, end, kSlice, kDirections);
        for (size_t row = 0; row < scan.rows; row++) {
            const auto [r_scan, r_grown] = radii_of(scan, grown, row);
            if (r_scan <= 0.0) continue;
            radii_.push_back(std::abs(r_grown / r_scan - 1.0));
        }
        if (branch == 0) {
            const Diameters breast = diameters(scan, grown, kBreastHeight);
            fit_.dbh_scan = breast.scan;
            fit_.dbh_grown = breast.grown;
        }
        // Finer cells tell what is a sheet.
        const double cell = recipe_.longest;
        const double wood = place_at(own, 0.5 * (begin + end)).radius;
        const double columns = std::clamp(std::round(2.0 * kPi * wood / cell), 8.0, 128.0);
        const BarkMap fine = map_bark(own, mine, begin, end, cell, static_cast<size_t>(columns));
        for (const BarkSpot& spot : mine) {
            const std::optional<size_t> at = fine.cell_of(spot);
            if (!at || std::isnan(fine.height[*at])) continue;
            chosen_.push_back(points[spot.point]);
            const double radius = fine.radius[*at / fine.columns];
            places_.push_back({spot.along, std::abs(fine.height[*at]) / radius, branch == 0});
        }
    }

    static BarkFitPart part_of(const std::vector<size_t>& chosen, const std::vector<Place>& places,
                               const std::vector<double>& tubes, const std::vector<double>& grown) {
        BarkFitPart part;
        part.points = chosen.size();
        std::vector<double> a, b, lumps;
        for (const size_t i : chosen) {
            a.push_back(tubes[i]);
            b.push_back(grown[i]);
            lumps.push_back(places[i].lump);
        }
        part.lumpy = summed(lumps).p95;
        part.tubes = summed(a);
        part.grown = summed(b);
        return part;
    }

    void finish(const std::vector<double>& tubes, const std::vector<double>& grown) {
        std::vector<size_t> all(chosen_.size()), lumpy;
        std::map<int, std::vector<size_t>> by_height;
        for (size_t i = 0; i < all.size(); i++) {
            all[i] = i;
            if (places_[i].trunk) by_height[static_cast<int>(std::floor(places_[i].along))].push_back(i);
        }
        fit_.all = part_of(all, places_, tubes, grown);
        for (const auto& [metre, chosen] : by_height) {
            BarkFitPart part = part_of(chosen, places_, tubes, grown);
            part.from = metre;
            part.to = metre + 1.0;
            if (part.grown.mean > (1.0 + kWorseBark) * part.tubes.mean + kTenthMillimetre) fit_.worse++;
            if (part.lumpy > kLumpyBark) lumpy.insert(lumpy.end(), chosen.begin(), chosen.end());
            fit_.heights.push_back(part);
        }
        fit_.lumpy = part_of(lumpy, places_, tubes, grown);
        if (!fit_.heights.empty()) {
            fit_.all.from = fit_.heights.front().from;
            fit_.all.to = fit_.heights.back().to;
        }
        fit_.slices = radii_.size();
        const BarkDistances radii = summed(radii_);
        fit_.radius_median = radii.median;
        fit_.radius_p95 = radii.p95;
    }

    const Tree& tree_;
    const GrowthRecipe& recipe_;
    const BranchList list_;
    const TreePlan planned_;
    const BarkAxes axes_;
    Progress* progress_;
    std::vector<DVec3> chosen_;
    std::vector<Place> places_;
    std::vector<double> radii_;
    BarkFit fit_;
};

}  // namespace

BarkFit measure_bark_fit(const Tree& tree, const GrowthRecipe& recipe, const GrownBark& bark,
                         const PointCloud& cloud, Progress* progress) {
    return Judge(tree, recipe, progress).judge(bark, cloud);
}

}  // namespace treerec
