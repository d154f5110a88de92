#include "skeleton/delaunay/simplify.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/segment.h"

namespace treerec {

namespace {

constexpr double kBeside = 1.0;    // spacings, or
constexpr double kWide = 1.5;      // radii of the wood: what lies no farther aside is the same branch,
constexpr double kSameWay = 0.25;  // if the edges' directions have at least this cosine
constexpr double kBack = 2.0;   // times as far as a child lies off: how much of the way to its parent counts
constexpr double kNoise = 3.0;  // radii of the wood that a side branch must reach
constexpr double kFewSpacings = 2.0;  // and spacings, likewise

class Simplifier {
  public:
    Simplifier(const TrunkCylinder& trunk, double spacing, double shortest)
        : trunk_(trunk), spacing_(spacing), shortest_(shortest) {}

    void take(const std::vector<Vec3>& points, const InitialSkeleton& skeleton, const DVec3& root) {
        vertices_.resize(points.size() + 1);
        children_.resize(points.size() + 1);
        vertices_[0].position = root;
        for (const uint32_t v : skeleton.tree.order) {
            vertices_[v + 1] = {DVec3(points[v]), skeleton.tree.parent[v] + 1, skeleton.weight[v],
                                skeleton.reach[v]};
            children_[skeleton.tree.parent[v] + 1].push_back(static_cast<int32_t>(v) + 1);
        }
        weigh();
    }

    // Vertices, parents before children.
    std::vector<int32_t> order() const {
        std::vector<int32_t> order{0};
        for (size_t i = 0; i < order.size(); i++)
            order.insert(order.end(), children_[order[i]].begin(), children_[order[i]].end());
        return order;
    }

    void weigh() {
        const std::vector<int32_t> all = order();
        for (const int32_t v : all)
            vertices_[v].weight = vertices_[v].reach = 0.0;
        for (auto it = all.rbegin(); it + 1 != all.rend(); ++it) {
            DelaunayVertex& below = vertices_[vertices_[*it].parent];
            const double step = glm::distance(vertices_[*it].position, below.position);
            below.weight += vertices_[*it].weight + step;
            below.reach = std::max(below.reach, vertices_[*it].reach + step);
        }
    }

    double radius(int32_t v) const {
        return std::min(trunk_.radius, allometric_radius(trunk_, vertices_[v].reach));
    }

    void drop_noise() {
        for (const int32_t v : order()) {
            std::vector<int32_t>& children = children_[v];
            if (children.size() < 2) continue;
            const auto reach = [&](int32_t c) {
                return vertices_[c].reach + glm::distance(vertices_[c].position, vertices_[v].position);
            };
            // The one that reaches farthest is no side branch.
            int32_t main = children.front();
            for (const int32_t c : children)
                if (reach(c) > reach(main)) main = c;
            const double least = std::max({shortest_, kNoise * radius(v), kFewSpacings * spacing_});
            std::erase_if(children, [&](int32_t c) { return c != main && reach(c) < least; });
        }
        weigh();
    }

    // From the root outwards: the two children that lie nearest to each other's edges first.
    void merge_adjacent(const Progress& progress) {
        std::vector<int32_t> open{0};
        size_t done = 0;
        while (!open.empty()) {
            const int32_t v = open.back();
            open.pop_back();
            if (done++ % 4096 == 0) progress.check();
            while (merge_pair(v) || take_in(v)) {
            }
            open.insert(open.end(), children_[v].begin(), children_[v].end());
        }
        weigh();
    }

    std::vector<DelaunayVertex> result() const {
        std::vector<DelaunayVertex> kept;
        std::vector<int32_t> at(vertices_.size(), -1);
        for (const int32_t v : order()) {
            at[v] = static_cast<int32_t>(kept.size());
            kept.push_back(vertices_[v]);
            if (v > 0) kept.back().parent = at[vertices_[v].parent];
        }
        return kept;
    }

  private:
    struct Pair {
        size_t nearer = 0;   // among the children: the one whose edge is shorter
        size_t farther = 0;  // and the other, which will hang on it
        double off = 0.0;    // metres
        double where = 0.0;  // of the farther one's edge
    };

    // A side child that turns aside or back within v's own wood is that wood: what it carries grows from v.
    bool take_in(int32_t v) {
        std::vector<int32_t>& children = children_[v];
        if (children.size() < 2) return false;
        int32_t main = children.front();
        for (const int32_t c : children)
            if (vertices_[c].weight > vertices_[main].weight) main = c;
        const double own = std::max(kBeside * spacing_, radius(v));
        for (size_t i = 0; i < children.size(); i++) {
            const int32_t c = children[i];
            if (c == main || !lies_within(c, v, own)) continue;
            children.erase(children.begin() + static_cast<ptrdiff_t>(i));
            for (const int32_t further : children_[c]) {
                vertices_[further].parent = v;
                children.push_back(further);
            }
            children_[c].clear();
            return true;
        }
        return false;
    }

    // Whether c lies no farther than `own` from v, or from the way that leads there.
    bool lies_within(int32_t c, int32_t v, double own) const {
        const DVec3 at = vertices_[c].position;
        double left = kBack * glm::distance(at, vertices_[v].position);
        if (glm::distance(at, vertices_[v].position) <= own) return true;
        for (int32_t a = v; left > 0.0 && vertices_[a].parent >= 0; a = vertices_[a].parent) {
            const DVec3 upper = vertices_[a].position, lower = vertices_[vertices_[a].parent].position;
            if (distance_to_segment(at, lower, upper) <= own) return true;
            left -= glm::distance(lower, upper);
        }
        return false;
    }

    bool merge_pair(int32_t v) {
        std::vector<int32_t>& children = children_[v];
        if (children.size() < 2) return false;
        const DVec3 from = vertices_[v].position;
        const double widest = std::max(kBeside * spacing_, kWide * radius(v));
        Pair best;
        bool found = false;
        for (size_t i = 0; i < children.size(); i++)
            for (size_t j = 0; j < children.size(); j++) {
                if (i == j) continue;
                const DVec3 near = vertices_[children[i]].position, far = vertices_[children[j]].position;
                const double own = glm::distance(near, from), other = glm::distance(far, from);
                if (own > other || (own == other && i > j)) continue;
                if (glm::dot(near - from, far - from) < kSameWay * own * other) continue;
                double where = 0.0;
                const double off = distance_to_segment(near, from, far, &where);
                if (off > widest || (found && off >= best.off)) continue;
                best = {i, j, off, where};
                found = true;
            }
        if (!found) return false;
        const int32_t near = children[best.nearer], far = children[best.farther];
        const DVec3 beside = from + best.where * (vertices_[far].position - from);
        // Each as heavy as what it carries; edges alone count, too, or two tips would weigh nothing.
        const double a = vertices_[near].weight + glm::distance(vertices_[near].position, from);
        const double b = vertices_[far].weight + glm::distance(vertices_[far].position, from);
        if (a + b > 0.0) vertices_[near].position = (a * vertices_[near].position + b * beside) / (a + b);
        vertices_[near].weight += b;
        vertices_[near].reach = std::max(vertices_[near].reach, vertices_[far].reach);
        vertices_[far].parent = near;
        children_[near].push_back(far);
        children.erase(children.begin() + static_cast<ptrdiff_t>(best.farther));
        return true;
    }

    const TrunkCylinder& trunk_;
    double spacing_;
    double shortest_;
    std::vector<DelaunayVertex> vertices_;  // the root, then the points
    std::vector<std::vector<int32_t>> children_;
};

}  // namespace

std::vector<DelaunayVertex> simplify_skeleton(const std::vector<Vec3>& points,
                                              const InitialSkeleton& skeleton, const DVec3& root,
                                              const TrunkCylinder& trunk, double spacing, double shortest,
                                              const Progress& progress) {
    Simplifier simplifier(trunk, spacing, shortest);
    simplifier.take(points, skeleton, root);
    simplifier.drop_noise();
    simplifier.merge_adjacent(progress);
    // Strips of one branch's bark that were long before are short where they now leave it.
    simplifier.drop_noise();
    return simplifier.result();
}

void branches_of(const std::vector<DelaunayVertex>& vertices, const TrunkCylinder& trunk, double longest_edge,
                 std::vector<SkeletonBranch>& branches, std::vector<std::vector<Station>>& axes) {
    branches.clear();
    axes.clear();
    const size_t count = vertices.size();
    std::vector<int32_t> goes_on(count, -1);
    for (size_t v = 1; v < count; v++) {
        int32_t& best = goes_on[vertices[v].parent];
        if (best < 0 || vertices[v].weight > vertices[best].weight) best = static_cast<int32_t>(v);
    }
    std::vector<int32_t> branch(count, -1), station(count, -1);
    for (size_t v = 0; v < count; v++) {
        const DelaunayVertex& vertex = vertices[v];
        if (vertex.parent >= 0 && goes_on[vertex.parent] == static_cast<int32_t>(v)) {
            branch[v] = branch[vertex.parent];
        } else {
            branch[v] = static_cast<int32_t>(branches.size());
            SkeletonBranch made;
            if (vertex.parent >= 0) {
                made.parent = branch[vertex.parent];
                made.attach = station[vertex.parent];
            }
            branches.push_back(made);
            axes.emplace_back();
        }
        Station here;
        here.position = vertex.position;
        here.radius = allometric_radius(trunk, vertex.reach);
        here.scatter = trunk.scatter;
        // Only the piece that the cylinder was fitted to.
        here.measured = trunk.measured && branch[v] == 0 &&
                        std::abs(glm::dot(vertex.position - trunk.middle, trunk.axis)) < 2.0 * trunk.radius;
        here.bridged = vertex.parent >= 0 &&
                       glm::distance(vertex.position, vertices[vertex.parent].position) > longest_edge;
        station[v] = static_cast<int32_t>(axes[branch[v]].size());
        branches[branch[v]].slices.push_back(-1);
        axes[branch[v]].push_back(here);
    }
}

}  // namespace treerec
