#include "photos/feature_tracks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <unordered_map>

namespace treerec {

namespace {

// The places of one photo, those that are near each other as one.
class Places {
  public:
    explicit Places(double same) : same_(same) {}

    uint32_t number_of(const DVec2& place) {
        const DVec2 cell = glm::floor(place / same_);
        double nearest = same_;
        uint32_t found = UINT32_MAX;
        for (int v = -1; v <= 1; v++)
            for (int u = -1; u <= 1; u++) {
                const auto at = cells_.find(key(cell + DVec2(u, v)));
                if (at == cells_.end()) continue;
                for (const uint32_t i : at->second) {
                    const double away = glm::distance(first_[i], place);
                    if (away < nearest || (away == nearest && i < found)) {
                        nearest = away;
                        found = i;
                    }
                }
            }
        if (found == UINT32_MAX) {
            found = static_cast<uint32_t>(first_.size());
            first_.push_back(place);
            sums_.push_back(DVec2(0.0));
            counts_.push_back(0.0);
            cells_[key(cell)].push_back(found);
        }
        sums_[found] += place;
        counts_[found] += 1.0;
        return found;
    }
    size_t count() const { return first_.size(); }
    DVec2 mean(uint32_t i) const { return sums_[i] / counts_[i]; }

  private:
    static uint64_t key(const DVec2& cell) {
        return static_cast<uint64_t>(static_cast<uint32_t>(static_cast<int64_t>(cell.x))) << 32 |
               static_cast<uint32_t>(static_cast<int64_t>(cell.y));
    }

    double same_;
    std::vector<DVec2> first_, sums_;
    std::vector<double> counts_;
    std::unordered_map<uint64_t, std::vector<uint32_t>> cells_;
};

struct Edge {
    uint32_t one = 0, other = 0;  // places, counted through all photos
    double weight = 0.0;
};

// Places that are the same one of the scene, no two of them in one photo.
class Groups {
  public:
    explicit Groups(const std::vector<uint32_t>& photo_of)
        : above_(photo_of.size()), photos_(photo_of.size()) {
        std::iota(above_.begin(), above_.end(), 0U);
        for (size_t i = 0; i < photo_of.size(); i++)
            photos_[i] = {photo_of[i]};
    }
    uint32_t top(uint32_t i) {
        while (above_[i] != i)
            i = above_[i] = above_[above_[i]];
        return i;
    }
    // False where that would put two places of a photo together.
    bool join(uint32_t a, uint32_t b) {
        a = top(a);
        b = top(b);
        if (a == b) return true;
        if (photos_[a].size() < photos_[b].size()) std::swap(a, b);
        std::vector<uint32_t> all;
        all.reserve(photos_[a].size() + photos_[b].size());
        std::set_union(photos_[a].begin(), photos_[a].end(), photos_[b].begin(), photos_[b].end(),
                       std::back_inserter(all));
        if (all.size() < photos_[a].size() + photos_[b].size()) return false;
        photos_[a] = std::move(all);
        photos_[b] = {};
        above_[b] = a;
        return true;
    }
    size_t size(uint32_t top) const { return photos_[top].size(); }

  private:
    std::vector<uint32_t> above_;
    std::vector<std::vector<uint32_t>> photos_;  // of a top, sorted
};

}  // namespace

FeatureTracks join_tracks(size_t photos, const std::vector<PhotoPlaceMatches>& pairs,
                          const TrackOptions& options) {
    std::vector<Places> places(photos, Places(options.same));
    struct Found {
        size_t one, other;
        uint32_t a, b;
        double weight;
    };
    std::vector<Found> found;
    for (const PhotoPlaceMatches& pair : pairs)
        for (const PlaceMatch& match : pair.matches)
            found.push_back({pair.one, pair.other, places[pair.one].number_of(match.one),
                             places[pair.other].number_of(match.other), match.weight});
    std::vector<uint32_t> starts(photos + 1, 0), photo_of;
    for (size_t i = 0; i < photos; i++) {
        starts[i + 1] = starts[i] + static_cast<uint32_t>(places[i].count());
        photo_of.resize(starts[i + 1], static_cast<uint32_t>(i));
    }
    std::vector<Edge> edges;
    edges.reserve(found.size());
    for (const Found& one : found)
        edges.push_back({starts[one.one] + one.a, starts[one.other] + one.b, one.weight});
    std::stable_sort(edges.begin(), edges.end(),
                     [](const Edge& a, const Edge& b) { return a.weight > b.weight; });
    FeatureTracks result;
    Groups groups(photo_of);
    for (const Edge& edge : edges)
        result.conflicts += !groups.join(edge.one, edge.other);

    // A keypoint for each place that is in a track.
    result.keypoints.resize(photos);
    std::map<uint32_t, std::vector<std::pair<uint32_t, uint32_t>>> tracks;  // by top: photos and keypoints
    for (uint32_t i = 0; i < photo_of.size(); i++) {
        const uint32_t top = groups.top(i);
        if (groups.size(top) < 2) continue;
        const uint32_t photo = photo_of[i];
        tracks[top].emplace_back(photo, static_cast<uint32_t>(result.keypoints[photo].size()));
        result.keypoints[photo].push_back(places[photo].mean(i - starts[photo]));
    }
    result.tracks = tracks.size();
    std::map<std::pair<size_t, size_t>, std::vector<std::pair<uint32_t, uint32_t>>> shared;
    for (const auto& [top, track] : tracks)
        for (size_t a = 0; a < track.size(); a++)
            for (size_t b = a + 1; b < track.size(); b++)
                shared[{track[a].first, track[b].first}].emplace_back(track[a].second, track[b].second);
    std::vector<std::pair<size_t, size_t>> compared;
    for (const PhotoPlaceMatches& pair : pairs)
        compared.push_back(std::minmax(pair.one, pair.other));
    std::sort(compared.begin(), compared.end());
    for (auto& [pair, keypoints] : shared)
        if (keypoints.size() >= options.least_shared ||
            std::binary_search(compared.begin(), compared.end(), pair))
            result.pairs.push_back({pair.first, pair.second, std::move(keypoints)});
    return result;
}

}  // namespace treerec
