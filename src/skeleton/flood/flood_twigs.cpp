#include "skeleton/flood/flood_twigs.h"

#include <algorithm>

#include "skeleton/cylinders/bark.h"
#include "skeleton/geodesics/paths.h"

namespace treerec {

namespace {

constexpr double kResolved = 2.0;  // points in each voxel: a twig of so many is a piece of bark

}  // namespace

void drop_flood_strips(FloodBranches& made, double least_escape) {
    std::vector<const Station*> first;  // a list that is moved keeps its stations where they are
    for (const std::vector<Station>& line : made.axes)
        first.push_back(line.data());
    drop_strips(made.branches, made.axes, least_escape);
    // Those that are kept stay in their order.
    std::vector<int32_t> now(first.size(), -1);
    size_t kept = 0;
    for (size_t l = 0; l < first.size() && kept < made.axes.size(); l++)
        if (made.axes[kept].data() == first[l]) now[l] = static_cast<int32_t>(kept++);
    for (int32_t& branch : made.places.branch)
        if (branch >= 0) branch = now[branch];
}

void drop_beside_stout(FloodBranches& made, double stout, double escape) {
    const Bark bark(made.branches, made.axes);
    const double far = required_escape(escape, bark.thickest());
    std::vector<uint8_t> except(made.branches.size(), 0);
    std::vector<uint32_t> bears(made.branches.size(), 0);
    for (size_t l = 0; l < made.branches.size(); l++) {
        except[l] = made.axes[l].front().radius <= stout;
        if (made.branches[l].parent >= 0) bears[made.branches[l].parent]++;
    }
    std::vector<uint8_t> goes(made.branches.size(), 0);
    for (size_t l = made.branches.size(); l-- > 1;) {
        if (bears[l] > 0) continue;
        const uint8_t slender = except[l];
        except[l] = 1;
        uint32_t hint = 0;
        const std::vector<Station>& line = made.axes[l];
        const bool escapes = std::any_of(line.rbegin(), line.rend(), [&](const Station& station) {
            const BarkPlace place = bark.nearest(Vec3(station.position), far, hint, &except);
            return place.branch < 0 || place.outside() >= required_escape(escape, place.radius);
        });
        if (escapes) {
            except[l] = slender;
            continue;
        }
        goes[l] = 1;
        bears[made.branches[l].parent]--;
    }
    drop_branches(made, goes);
}

void add_flood_twigs(const std::vector<Vec3>& points, const FloodGrid& grid, const LocalScale& scale,
                     const RootGuess& root, const TwigOptions& options, FloodBranches& made,
                     Progress& progress) {
    const PathTree paths = shortest_paths(grid.graph, scale, root.seeds, progress);
    const int32_t flooded = static_cast<int32_t>(made.branches.size());
    // The flood's branches have no slices, so that every voxel goes to the bark that it is nearest to.
    const PointPlaces places = add_twigs(grid.means, grid.graph, scale, paths, Slices{}, options,
                                         made.branches, made.axes, progress);
    std::vector<size_t> voxels(made.branches.size(), 0);
    std::vector<size_t> held(made.branches.size(), 0);
    std::vector<uint32_t> bears(made.branches.size(), 0);
    for (size_t v = 0; v < grid.size(); v++) {
        if (places.branch[v] < 0) continue;
        voxels[places.branch[v]]++;
        held[places.branch[v]] += grid.cells.in_cell(v).size();
    }
    for (const SkeletonBranch& branch : made.branches)
        if (branch.parent >= 0) bears[branch.parent]++;
    std::vector<uint8_t> goes(made.branches.size(), 0);
    for (size_t l = made.branches.size(); l-- > static_cast<size_t>(flooded);) {
        if (bears[l] > 0 || static_cast<double>(held[l]) < kResolved * static_cast<double>(voxels[l]))
            continue;
        goes[l] = 1;
        bears[made.branches[l].parent]--;
    }
    const std::vector<int32_t> now = drop_branches(made, goes);
    for (size_t v = 0; v < grid.size(); v++) {
        const int32_t branch = places.branch[v] < 0 ? -1 : now[places.branch[v]];
        if (branch < 0) continue;
        for (const uint32_t p : grid.cells.in_cell(v)) {
            // What the flood says of thick wood is not limited to what is near its first guess of the bark.
            if (branch < flooded && made.places.branch[p] >= 0) continue;
            made.places.branch[p] = branch;
            made.places.station[p] =
                place_near(made.axes[branch], places.station[v], DVec3(points[p])).station;
        }
    }
}

}  // namespace treerec
