#include "skeleton/twigs.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "geometry/parallel.h"
#include "skeleton/bark.h"
#include "skeleton/heap.h"

namespace treerec {

namespace {

constexpr double kTolerance = 0.12;        // point spacings off the bark: still explained by it
constexpr double kLeastTolerance = 0.005;  // metres
constexpr double kMostTolerance = 0.02;
constexpr double kBarkRelief = 0.2;  // of the radius, likewise
constexpr int kStumpSteps = 12;      // stations back that the end of thick wood is looked for
constexpr double kStumpEnd = 1.5;    // radii: so long it is
constexpr double kGapFactor = 3.0;   // reaches: no twig crosses a wider gap
constexpr int kSmoothings = 3;
constexpr double kMostMove = 0.003;  // metres: about a twig's radius, so that its points stay on its bark
constexpr double kSharpest = 0.0;    // cosine of the sharpest turn of a twig
constexpr double kFoot = 4.0;        // radii of the stem: up there roots and ground lie around it, and
constexpr double kFootEscape = 4.0;  // what reaches less far out is one of them
constexpr size_t kLeastPoints = 3;   // of a twig on measured wood: where that is seen, so are its twigs
constexpr size_t kShootPoints = 4;   // of a short shoot; fewer may be strays
constexpr double kShortest = 0.7;    // of the shortest branch, where that many points show a shoot
constexpr double kShootLength =
    1.07;  // of it, that a shoot has from the parent's axis on: simplification takes some
constexpr float kStrayFactor = 5.0f;  // reaches of the wood on the near side: nor this one,
constexpr float kStrayWood = 0.2f;    // of the gap: with less wood beyond it
constexpr float kGather = 0.5f;       // point spacings: points so near to a path are one with it

class TwigFinder {
  public:
    TwigFinder(const std::vector<Vec3>& points, const PointGraph& graph, const LocalScale& scale,
               const PathTree& paths, const TwigOptions& options, std::vector<Limb>& limbs,
               std::vector<std::vector<Station>>& axes)
        : points_(points),
          graph_(graph),
          scale_(scale),
          paths_(paths),
          options_(options),
          limbs_(limbs),
          axes_(axes),
          bark_(limbs, axes),
          line_(points.size(), -1),
          station_(points.size(), 0),
          outside_(points.size(), 0.0f),
          surface_(points.size(), 0.0f),
          nearest_(points.size(), -1) {}

    void take_slices(const Slices& slices) {
        auto take = [&](int32_t slice, int32_t limb, int32_t at) {
            for (const uint32_t v : slices.points_of(static_cast<size_t>(slice)))
                claim(v, bark_.on_limb(limb, at, DVec3(points_[v])));
        };
        parallel_for(limbs_.size(), 16, [&](size_t begin, size_t end) {
            for (size_t l = begin; l < end; l++) {
                const Limb& limb = limbs_[l];
                const int32_t index = static_cast<int32_t>(l);
                for (size_t i = 0; i < limb.slices.size(); i++)
                    take(limb.slices[i], index, static_cast<int32_t>(i));
                for (size_t m = 0; m < limb.merged.size(); m++)
                    take(limb.merged[m], index, limb.merged_at[m]);
                for (size_t a = 0; a < limb.absorbed.size(); a++)
                    take(limb.absorbed[a], index, limb.absorbed_at[a]);
            }
        });
        find_others();
        while (foot_end_ + 1 < static_cast<int32_t>(axes_[0].size()) &&
               glm::distance(axes_[0][foot_end_].position, axes_[0][0].position) < kFoot * axes_[0][0].radius)
            foot_end_++;
        // A path starts on wood.
        for (const uint32_t v : paths_.order)
            if (paths_.parent[v] < 0 && line_[v] < 0) {
                line_[v] = 0;
                station_[v] = place_near(axes_[0], 0, DVec3(points_[v])).station;
            }
    }

    // Around a fork, a slice of one limb has points on the bark of another.
    void find_others() {
        parallel_for(points_.size(), 1024, [&](size_t begin, size_t end) {
            for (size_t v = begin; v < end; v++) {
                if (line_[v] >= 0) continue;
                const BarkPlace place = bark_.nearest(points_[v]);
                if (place.limb < 0) continue;
                claim(static_cast<uint32_t>(v), place);
                if (line_[v] < 0) claim_stump(static_cast<uint32_t>(v), place);
                outside_[v] = static_cast<float>(place.outside());
                surface_[v] = static_cast<float>(place.radius);
            }
        });
    }

    void run(Progress& progress) {
        std::vector<float> outside(points_.size(), 0.0f);
        std::vector<uint8_t> may(points_.size(), 0);  // something on the way from the wood may escape it
        // The farthest first. The bits of positive floats are in the order of their values; all bits turned,
        // the largest number becomes the least.
        const auto entry = [](float length, uint32_t vertex) {
            return ~((static_cast<uint64_t>(std::bit_cast<uint32_t>(length)) << 32) | vertex);
        };
        std::vector<uint64_t> entries;
        for (const uint32_t v : paths_.order)
            if (line_[v] < 0) {
                outside[v] = outside[paths_.parent[v]] + paths_.step[v];
                // Paths only grow shorter, so what cannot escape now never will.
                may[v] = may[paths_.parent[v]] != 0 || may_escape(v) ? 1 : 0;
                if (may[v] != 0) entries.push_back(entry(outside[v], v));
            }
        LeastFirst queue(std::move(entries));
        size_t looked = 0;
        while (!queue.empty()) {
            if (++looked % 1024 == 0) progress.check();
            const uint64_t top = queue.pop();
            const uint32_t v = static_cast<uint32_t>(~top);
            if (line_[v] >= 0) continue;
            const float now = path_to(v);
            if (entry(now, v) > top) {
                queue.push(entry(now, v));
                continue;
            }
            if (!path_.empty()) add_twig();
        }
    }

    PointPlaces places() && { return {std::move(line_), std::move(station_)}; }

  private:
    // Notes that the point lies on the bark of the limb, if it does.
    void claim(uint32_t v, const BarkPlace& place) {
        if (place.distance > (1.0 + kBarkRelief) * place.radius + tolerance(v)) return;
        line_[v] = place.limb;
        station_[v] = place.station;
    }

    // Where thick wood ends in thinner limbs, or is cut off, its end stands around them: a point straight
    // ahead of the thicker stations behind its place lies on that.
    void claim_stump(uint32_t v, const BarkPlace& place) {
        const DVec3 p(points_[v]);
        int32_t limb = place.limb;
        int32_t at = place.station;
        for (int step = 0; step < kStumpSteps; step++) {
            const std::vector<Station>& line = axes_[limb];
            const double radius = line[at].radius;
            if (at > 0) {
                int32_t behind = at - 1;
                while (behind > 0 && glm::distance(line[at].position, line[behind].position) < radius)
                    behind--;
                const DVec3 along = normalized_or(line[at].position - line[behind].position, DVec3(0, 1, 0));
                const DVec3 offset = p - line[at].position;
                const double ahead = glm::dot(offset, along);
                if (std::abs(ahead) <= kStumpEnd * radius &&
                    glm::length(offset - ahead * along) <= (1.0 + kBarkRelief) * radius + tolerance(v)) {
                    line_[v] = limb;
                    station_[v] = at;
                    return;
                }
            }
            if (at == 0 && limbs_[limb].parent < 0) return;
            const int32_t next = at > 0 ? at - 1 : limbs_[limb].attach;
            if (at == 0) limb = limbs_[limb].parent;
            at = next;
        }
    }

    double tolerance(uint32_t v) const {
        return std::clamp(kTolerance * scale_.spacing[v], kLeastTolerance, kMostTolerance);
    }

    // Whether the limbs given leave the point free; twigs may still explain it.
    bool may_escape(uint32_t v) const {
        return outside_[v] >= required_escape(options_.least_escape, surface_[v]);
    }

    // Fills path_, from the base to v; its first vertex hangs on foot_. Empty where it would cross a gap, or
    // nothing of it can escape the bark.
    float path_to(uint32_t v) {
        path_.clear();
        float length = 0.0f;
        bool gap = false;
        bool may = false;
        while (line_[v] < 0) {
            const uint32_t next = static_cast<uint32_t>(paths_.parent[v]);
            const float step = paths_.step[v];
            gap = gap || step > kGapFactor * edge_reach(scale_, v, next) ||
                  (length < kStrayWood * step && step > kStrayFactor * scale_.reach[next]);
            path_.push_back(v);
            may = may || may_escape(v);
            length += step;
            v = next;
        }
        foot_ = v;
        std::reverse(path_.begin(), path_.end());
        if (gap || !may) path_.clear();
        return length;
    }

    void add_twig() {
        const int32_t parent = line_[foot_];
        int32_t station = station_[foot_];
        bool escapes = false;
        const bool at_foot = parent == 0 && station < foot_end_;
        for (size_t i = 0; i < path_.size() && !escapes; i++) {
            const uint32_t v = path_[i];
            const BarkPlace place = place_near(axes_[parent], station, DVec3(points_[v]));
            station = place.station;
            const double outside = std::min<double>(outside_[v], place.distance - place.radius);
            const double thickest = std::max<double>(surface_[v], place.radius);
            const double required = std::max(required_escape(options_.least_escape, thickest),
                                             at_foot ? kFootEscape * axes_[0][0].radius : 0.0);
            escapes = outside >= required;
        }
        if (!escapes) return;

        gather();
        Limb twig;
        twig.parent = parent;
        twig.attach = station_[foot_];
        std::vector<Station> line = smooth_line(axes_[parent][twig.attach].position);
        twig.attach = fork_station(axes_[parent], twig.attach, line);
        straighten(line, axes_[parent][twig.attach].position);
        double outer = 0.0;
        for (size_t i = 1; i < line.size(); i++)
            outer += glm::distance(line[i].position, line[i - 1].position);
        for (const uint32_t v : near_)
            nearest_[v] = -1;
        twig.attach = long_enough(axes_[parent], twig.attach, line.front().position, outer);
        if (twig.attach < 0) return;
        if (axes_[parent][twig.attach].measured && near_.size() < kLeastPoints) return;

        const int32_t index = static_cast<int32_t>(limbs_.size());
        limbs_.push_back(std::move(twig));
        axes_.push_back(std::move(line));
        // Fewer stations than points may be left.
        const size_t last = axes_[index].size() - 1;
        size_t at = 0;
        for (const uint32_t v : path_) {
            const DVec3 p(points_[v]);
            while (at < last && glm::distance(p, axes_[index][at + 1].position) <=
                                    glm::distance(p, axes_[index][at].position))
                at++;
            // What straightening has left aside may bear a twig of its own.
            const BarkPlace place = place_near(axes_[index], static_cast<int32_t>(at), p);
            if (v != path_.back() && place.distance > place.radius + kMostMove + tolerance(v)) continue;
            line_[v] = index;
            station_[v] = place.station;
        }
        for (const uint32_t v : path_)
            if (line_[v] == index) mark_around(v, index, station_[v], 2);
    }

    // A twig leaves at an angle: so far back along its parent as it starts outside of the parent's bark, if
    // that makes its start straighter.
    static int32_t fork_station(const std::vector<Station>& parent, int32_t near,
                                const std::vector<Station>& twig) {
        const DVec3& first = twig.front().position;
        const BarkPlace place = place_near(parent, near, first);
        const DVec3 ahead = twig.size() > 1 ? twig[1].position - first : DVec3(0.0);
        int32_t best = place.station;
        double straightest = -2.0;
        double back = 0.0;
        for (int32_t i = place.station; i >= 0 && back <= std::max(0.0, place.outside()); i--) {
            const DVec3 way = normalized_or(first - parent[i].position, DVec3(0.0));
            const DVec3 on = i + 1 < static_cast<int32_t>(parent.size())
                                 ? parent[i + 1].position - parent[i].position
                                 : DVec3(0.0);
            const double straight = glm::dot(way, normalized_or(ahead, DVec3(0.0))) +
                                    glm::dot(way, normalized_or(on, DVec3(0.0)));
            if (straight > straightest + 1e-6) {
                straightest = straight;
                best = i;
            }
            if (i > 0) back += glm::distance(parent[i].position, parent[i - 1].position);
        }
        return best;
    }

    // Where on the parent a twig leaves that is `outer` metres long from its first station on; -1 for none,
    // if it is too short. A short shoot that several points show is wood all the same, and nobody sees how it
    // runs under the bark: it leaves the axis as much further back as makes it a branch.
    int32_t long_enough(const std::vector<Station>& parent, int32_t attach, const DVec3& first,
                        double outer) const {
        const auto length = [&](int32_t from) { return glm::distance(parent[from].position, first) + outer; };
        const double found = length(attach);
        if (found >= 1.01 * options_.minimum_branch) return attach;
        if (near_.size() < kShootPoints || found < kShortest * options_.minimum_branch) return -1;
        double back = 0.0;
        while (length(attach) < kShootLength * options_.minimum_branch) {
            // Further back than it is long, it would lie along its parent.
            if (attach == 0 || parent[attach].bridged || back >= found) return -1;
            back += glm::distance(parent[attach].position, parent[attach - 1].position);
            attach--;
        }
        return attach;
    }

    // Takes out the stations where the twig would turn sharply.
    static void straighten(std::vector<Station>& line, const DVec3& base) {
        for (size_t i = 0; i + 1 < line.size();) {
            const DVec3& before = i > 0 ? line[i - 1].position : base;
            const DVec3 to = normalized_or(line[i].position - before, DVec3(0.0));
            const DVec3 from = normalized_or(line[i + 1].position - line[i].position, DVec3(0.0));
            if (glm::dot(to, from) >= kSharpest) {
                i++;
                continue;
            }
            line.erase(line.begin() + static_cast<ptrdiff_t>(i));
            if (i > 0) i--;
        }
    }

    void mark_around(uint32_t v, int32_t index, int32_t at, int hops) {
        for (uint32_t e = graph_.begin[v]; e < graph_.begin[v + 1]; e++) {
            const uint32_t n = graph_.neighbour[e];
            if (line_[n] >= 0) continue;
            const BarkPlace place = place_near(axes_[index], at, DVec3(points_[n]));
            if (place.distance > place.radius + tolerance(n)) continue;
            line_[n] = index;
            station_[n] = place.station;
            if (hops > 1) mark_around(n, index, place.station, hops - 1);
        }
    }

    // The free points around the path, each with the vertex of the path that it is nearest to.
    void gather() {
        near_.clear();
        for (size_t i = 0; i < path_.size(); i++) {
            near_.push_back(path_[i]);
            nearest_[path_[i]] = static_cast<int32_t>(i);
        }
        for (size_t i = 0; i < path_.size(); i++) {
            const uint32_t v = path_[i];
            for (uint32_t e = graph_.begin[v]; e < graph_.begin[v + 1]; e++) {
                const uint32_t n = graph_.neighbour[e];
                if (line_[n] >= 0 || graph_.length[e] > kGather * scale_.spacing[v]) continue;
                if (nearest_[n] < 0) {
                    near_.push_back(n);
                    nearest_[n] = static_cast<int32_t>(i);
                } else if (path_[nearest_[n]] != n &&
                           glm::distance(points_[n], points_[path_[nearest_[n]]]) > graph_.length[e]) {
                    nearest_[n] = static_cast<int32_t>(i);
                }
            }
        }
    }

    std::vector<Station> smooth_line(const DVec3& base) {
        std::vector<Station> line(path_.size());
        std::vector<double>& weight = weight_;
        weight.assign(path_.size(), 0.0);
        for (const uint32_t v : near_) {
            line[nearest_[v]].position += DVec3(points_[v]);
            weight[nearest_[v]] += 1.0;
        }
        for (size_t i = 0; i < line.size(); i++)
            line[i].position /= weight[i];
        std::vector<DVec3>& seen = seen_;
        seen.clear();
        for (const Station& station : line)
            seen.push_back(station.position);
        for (int round = 0; round < kSmoothings; round++) {
            DVec3 before = base;
            for (size_t i = 0; i + 1 < line.size(); i++) {
                const DVec3 here = line[i].position;
                DVec3 move = 0.25 * before + 0.5 * here + 0.25 * line[i + 1].position - seen[i];
                const double most = kMostMove;
                if (glm::length(move) > most) move *= most / glm::length(move);
                line[i].position = seen[i] + move;
                before = here;
            }
        }
        // The points' distances, by station.
        std::vector<size_t>& begin = begin_;
        begin.assign(line.size() + 1, 0);
        for (const uint32_t v : near_)
            begin[static_cast<size_t>(nearest_[v]) + 1]++;
        for (size_t i = 0; i < line.size(); i++)
            begin[i + 1] += begin[i];
        std::vector<double>& distances = distances_;
        distances.resize(near_.size());
        std::vector<size_t>& fill = fill_;
        fill.assign(begin.begin(), begin.end() - 1);
        for (const uint32_t v : near_)
            distances[fill[static_cast<size_t>(nearest_[v])]++] =
                place_near(line, nearest_[v], DVec3(points_[v])).distance;
        // place_near looks at positions alone, so the radii can be set behind it.
        for (size_t i = 0; i < line.size(); i++) {
            const size_t count = begin[i + 1] - begin[i];
            if (count < 2) continue;
            const auto first = distances.begin() + static_cast<ptrdiff_t>(begin[i]);
            const auto middle = first + static_cast<ptrdiff_t>(count / 2);
            std::nth_element(first, middle, first + static_cast<ptrdiff_t>(count));
            line[i].radius = *middle;
        }
        return line;
    }

    const std::vector<Vec3>& points_;
    const PointGraph& graph_;
    const LocalScale& scale_;
    const PathTree& paths_;
    const TwigOptions& options_;
    std::vector<Limb>& limbs_;
    std::vector<std::vector<Station>>& axes_;
    const Bark bark_;               // of the limbs that are given
    std::vector<int32_t> line_;     // by point: the limb whose bark it lies on, -1 for none
    std::vector<int32_t> station_;  // and the station there
    std::vector<float> outside_;    // by free point: metres from the nearest limb's bark, twigs left aside
    std::vector<float> surface_;    // and that limb's radius there
    int32_t foot_end_ = 0;          // of the first limb: the first station above the foot
    std::vector<int32_t> nearest_;  // scratch of gather()
    std::vector<uint32_t> near_;
    std::vector<uint32_t> path_;
    std::vector<double> weight_, distances_;  // scratch of smooth_line()
    std::vector<DVec3> seen_;
    std::vector<size_t> begin_, fill_;
    uint32_t foot_ = 0;
};

}  // namespace

PointPlaces add_twigs(const std::vector<Vec3>& points, const PointGraph& graph, const LocalScale& scale,
                      const PathTree& paths, const Slices& slices, const TwigOptions& options,
                      std::vector<Limb>& limbs, std::vector<std::vector<Station>>& axes, Progress& progress) {
    TwigFinder finder(points, graph, scale, paths, options, limbs, axes);
    finder.take_slices(slices);
    finder.run(progress);
    return std::move(finder).places();
}

}  // namespace treerec
