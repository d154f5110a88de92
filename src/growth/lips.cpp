#include "growth/lips.h"

#include <CGAL/boost/graph/iterator.h>

#include <algorithm>
#include <limits>

namespace treerec::growth {

namespace {

// Cosine to the normal: what lies farther behind the bark is grown over, and turns it no more.
constexpr double kBehind = -0.7;

}  // namespace

void Lips::find(const Surface& surface, const std::vector<Feature>& features, const Obstacles* obstacles) {
    sources_.clear();
    grid_.reset();
    reach_ = 0.0;
    const SurfaceMesh& mesh = surface.mesh;
    for (const Vertex v : mesh.vertices()) {
        const Cell& cell = surface.cells[v];
        if (cell.tissue == Tissue::kDecayed) {
            const Lip& lip = features[static_cast<size_t>(cell.hollow)].lip;
            bool rim = false;
            for (const Vertex other : CGAL::vertices_around_target(mesh.halfedge(v), mesh))
                if (surface.cells[other].tissue == Tissue::kCambium) {
                    rim = true;
                    sources_.push_back({surface.place(other), &lip, Kind::kRim});
                }
            if (rim) sources_.push_back({surface.place(v), &lip, Kind::kWood});
        } else if (cell.touched >= 0 && cell.tissue == Tissue::kCambium) {
            sources_.push_back(
                {surface.place(v), &obstacles->lips()[static_cast<size_t>(cell.touched)], Kind::kContact});
        }
    }
    for (const Source& source : sources_)
        reach_ = std::max({reach_, source.lip->radius, source.lip->band});
    if (!(reach_ > 0.0)) return;
    grid_.emplace(reach_);
    for (size_t i = 0; i < sources_.size(); i++)
        grid_->add(static_cast<uint32_t>(i), Box{sources_[i].place, sources_[i].place});
}

Lips::Growth Lips::at(const DVec3& place, const DVec3& normal) const {
    Growth growth;
    if (!grid_) return growth;
    // Of wood and of contacts: equation 9's and 10's sums, and the nearest's lip.
    DVec3 sum[2] = {DVec3(0.0), DVec3(0.0)};
    double nearest[2] = {std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
    double wrap[2] = {}, extra[2] = {};
    bool within[2] = {};
    const auto take = [&](uint32_t item) {
        const Source& source = sources_[item];
        const DVec3 way = source.place - place;
        const double distance = glm::length(way);
        const int which = source.kind == Kind::kContact ? 1 : 0;
        const Lip& lip = *source.lip;
        if (source.kind != Kind::kWood)
            extra[which] = std::max(extra[which], burl_growth(lip.radius, lip.inner, lip.growth, distance));
        if (source.kind == Kind::kRim || distance > lip.band || !(distance > 0.0)) return;
        if (glm::dot(way, normal) < kBehind * distance) return;
        sum[which] += way / distance;
        within[which] = true;
        if (distance >= nearest[which]) return;
        nearest[which] = distance;
        wrap[which] = lip.wrap;
    };
    // A bucket may come twice, where two cells share it: each source must count once.
    std::vector<uint32_t> found;
    grid_->visit(Box{place - reach_, place + reach_}, [&](uint32_t item) { found.push_back(item); });
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    for (const uint32_t item : found)
        take(item);
    growth.callus = extra[0] > 0.0 || within[0];
    for (int which = 0; which < 2; which++) {
        growth.extra += extra[which];
        if (within[which]) growth.wrap += wrap[which] * normalized_or(sum[which], DVec3(0.0));
    }
    return growth;
}

}  // namespace treerec::growth
