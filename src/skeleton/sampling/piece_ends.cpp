#include "skeleton/sampling/piece_ends.h"

#include <algorithm>
#include <limits>

#include "geometry/parallel.h"
#include "skeleton/branches/run.h"

namespace treerec {

namespace {

constexpr size_t kLeastPiece = 12;  // points: fewer run nowhere
constexpr float kLonger = 2.0F;     // gaps: a piece that ends there is at least so long
constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
constexpr double kAside = 0.28;  // of the way: what still lies ahead

class PieceEnds {
  public:
    PieceEnds(const std::vector<Vec3>& points, const PointTree& tree, const std::vector<uint32_t>& piece)
        : points_(points),
          tree_(tree),
          piece_(piece),
          members_(points.size(), 0),
          piece_of_node_(names_of_nodes(tree, piece)) {
        for (const uint32_t p : piece)
            members_[p]++;
    }

    std::vector<PointEdge> links(const Progress& progress) const {
        std::vector<std::vector<uint32_t>> pieces = large_pieces();
        std::vector<std::vector<PointEdge>> found(pieces.size());
        parallel_for(pieces.size(), 16, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; i++) {
                progress.check();
                found[i] = links_of(pieces[i]);
            }
        });
        std::vector<PointEdge> edges;
        for (const std::vector<PointEdge>& some : found)
            edges.insert(edges.end(), some.begin(), some.end());
        std::sort(edges.begin(), edges.end());
        edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
        return edges;
    }

  private:
    std::vector<std::vector<uint32_t>> large_pieces() const {
        std::vector<uint32_t> number(points_.size(), kNone);
        std::vector<std::vector<uint32_t>> pieces;
        for (uint32_t v = 0; v < points_.size(); v++) {
            const uint32_t p = piece_[v];
            if (members_[p] < kLeastPiece) continue;
            if (number[p] == kNone) {
                number[p] = static_cast<uint32_t>(pieces.size());
                pieces.emplace_back();
                pieces.back().reserve(members_[p]);
            }
            pieces[number[p]].push_back(v);
        }
        return pieces;
    }

    uint32_t farthest(const std::vector<uint32_t>& piece, const DVec3& from) const {
        return *std::max_element(piece.begin(), piece.end(), [&](uint32_t a, uint32_t b) {
            return glm::distance(DVec3(points_[a]), from) < glm::distance(DVec3(points_[b]), from);
        });
    }

    std::vector<PointEdge> links_of(const std::vector<uint32_t>& piece) const {
        DVec3 middle(0.0);
        for (const uint32_t v : piece)
            middle += DVec3(points_[v]);
        const uint32_t first = farthest(piece, middle / static_cast<double>(piece.size()));
        const uint32_t second = farthest(piece, DVec3(points_[first]));
        const float length = glm::distance(points_[first], points_[second]);
        std::vector<PointEdge> links;
        for (const uint32_t end : {first, second}) {
            std::vector<uint32_t> around;
            for (const uint32_t v : piece)
                if (glm::distance(points_[v], points_[end]) <= 0.5F * length) around.push_back(v);
            const Run run = run_of(points_, around, DVec3(points_[end]));
            if (!run.known) continue;
            const auto ahead = [&](uint32_t v) {
                return piece_[v] != piece_[end] && members_[piece_[v]] >= kLeastPiece &&
                       run.aside(DVec3(points_[v])) <= kAside;
            };
            const float most = length / kLonger;
            Straightest best{points_, run, most * most, ahead};
            tree_.search(points_[end], best,
                         [&](uint32_t node) { return piece_of_node_[node] != piece_[end]; });
            if (best.found()) links.emplace_back(std::min(end, best.to), std::max(end, best.to));
        }
        return links;
    }

    const std::vector<Vec3>& points_;
    const PointTree& tree_;
    const std::vector<uint32_t>& piece_;
    std::vector<uint32_t> members_;        // by piece
    std::vector<uint32_t> piece_of_node_;  // of tree_
};

}  // namespace

void link_piece_ends(const std::vector<Vec3>& points, const PointTree& tree, const LocalScale& scale,
                     PointGraph& graph, const Progress& progress) {
    const std::vector<uint32_t> piece = pieces_of(graph, scale);
    std::vector<PointEdge> edges = PieceEnds(points, tree, piece).links(progress);
    std::erase_if(edges, [&](const PointEdge& edge) { return find_edge(graph, edge).has_value(); });
    if (!edges.empty()) add_edges(graph, points, std::move(edges));
}

}  // namespace treerec
