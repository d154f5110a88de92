#include "skeleton/cylinders/refine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "geometry/bounds.h"
#include "geometry/parallel.h"
#include "skeleton/cylinders/one_sided.h"
#include "skeleton/cylinders/radii.h"

namespace treerec {

namespace {

constexpr int kRounds = 2;
constexpr int kNearSegments =
    3;  // to each side of a point's own station, where its nearest one is looked for
constexpr int kNearStations = 3;      // between a side branch and the points that may belong to it
constexpr int kFirstSegments = 6;     // of a side branch, which may hold points of its parent
constexpr size_t kWantedPoints = 16;  // per window
constexpr size_t kLeastPoints = 5;
constexpr int kWidestWindow = 4;  // stations to each side, where points are few
constexpr double kWindow = 1.0;   // radii to each side
constexpr double kTukey = 4.685;  // 95 % efficiency for normal noise
constexpr double kMadToSigma = 1.4826;
constexpr double kRidge = 4.0;        // points' worth of belief that the axis is right
constexpr double kRadiusRidge = 0.5;  // and the radius
constexpr double kMostShift = 0.5;    // radii, in one round
constexpr size_t kRoundPoints = 8;
constexpr double kRoundScatter = 0.2;    // median deviation over radius
constexpr double kRoundCoverage = 0.62;  // of the directions
constexpr double kRoundDensity = 4.0;    // points in a length of one radius
constexpr double kAboveNoise = 2.5;      // standard deviations
constexpr double kAlike = 0.25;
constexpr size_t kPointsPerCheck = 8192;
constexpr double kThinTwig = 0.003;  // metres
constexpr double kThinnest = 0.001;  // metres
constexpr double kRounding = 1e-6;   // metres, more than that of what is compared with a box

// A point as its branch sees it.
struct Sample {
    float x;  // unit vector from the axis to the point, in the station's frame
    float y;
    float distance;  // metres from the axis
};

// How far a point is from the surface of the segment from a to b.
struct Hit {
    double off = 0.0;  // distance to the axis less the radius
    double distance = 0.0;
    double t = 0.0;  // 0 at a, 1 at b
    DVec3 offset{0.0};
};

// Only the squared distance to the axis, and where: for the many segments that turn out not to be the
// nearest.
double square_to_segment(const DVec3& p, const DVec3& a, const DVec3& b, double& t) {
    const DVec3 ab = b - a;
    const DVec3 ap = p - a;
    const double along = glm::dot(ap, ab);
    const double square = glm::dot(ab, ab);
    t = along <= 0.0 ? 0.0 : along >= square ? 1.0 : along / square;
    const DVec3 offset = ap - t * ab;
    return glm::dot(offset, offset);
}

Hit hit_segment(const DVec3& p, const DVec3& a, double radius_a, const DVec3& b, double radius_b) {
    Hit hit;
    hit.distance = std::sqrt(square_to_segment(p, a, b, hit.t));
    hit.offset = p - (a + hit.t * (b - a));
    hit.off = hit.distance - (radius_a + hit.t * (radius_b - radius_a));
    return hit;
}

// The normal equations of a shift (x, y) of the axis and a change of the radius.
struct Normal {
    double xx = 0.0, xy = 0.0, yy = 0.0, x = 0.0, y = 0.0, w = 0.0, rx = 0.0, ry = 0.0, r = 0.0;

    void add(const Sample& s, double weight, double residual) {
        xx += weight * s.x * s.x;
        xy += weight * s.x * s.y;
        yy += weight * s.y * s.y;
        x += weight * s.x;
        y += weight * s.y;
        w += weight;
        rx += weight * residual * s.x;
        ry += weight * residual * s.y;
        r += weight * residual;
    }

    DVec3 solve() const {
        const double a = xx + kRidge;
        const double d = yy + kRidge;
        const double f = w + kRadiusRidge;
        const double c00 = d * f - y * y;
        const double c01 = x * y - xy * f;
        const double c02 = xy * y - d * x;
        const double det = a * c00 + xy * c01 + x * c02;  // positive: the ridge makes it positive definite
        return DVec3(rx * c00 + ry * c01 + r * c02, rx * c01 + ry * (a * f - x * x) + r * (x * xy - a * y),
                     rx * c02 + ry * (xy * x - a * y) + r * (a * d - xy * xy)) /
               det;
    }
};

// A box around the bark of the stations [first, last] of a line, those of them that there are. What lies
// farther outside of it than `off` lies farther than that from the bark.
Bounds around_bark(const std::vector<Station>& line, int first, int last) {
    Bounds box;
    last = std::min(last, static_cast<int>(line.size()) - 1);
    for (int i = std::max(first, 0); i <= last; i++)
        box.add(line[i].position, line[i].radius);
    return box;
}

bool is_near(const Bounds& box, const DVec3& p, double off) {
    off += kRounding;
    return p.x >= box.min.x - off && p.x <= box.max.x + off && p.y >= box.min.y - off &&
           p.y <= box.max.y + off && p.z >= box.min.z - off && p.z <= box.max.z + off;
}

template <typename T>
T median_of(std::vector<T>& values) {
    const auto middle = values.begin() + static_cast<ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// Indices by the branch that they belong to, ascending.
struct Members {
    std::vector<uint32_t> begin;
    std::vector<int32_t> index;

    // branch: by index, -1 for none.
    Members(std::span<const int32_t> branch, size_t branches) : begin(branches + 1, 0) {
        for (const int32_t l : branch)
            if (l >= 0) begin[static_cast<size_t>(l) + 1]++;
        for (size_t l = 0; l < branches; l++)
            begin[l + 1] += begin[l];
        index.resize(begin.back());
        std::vector<uint32_t> fill(begin.begin(), begin.end() - 1);
        for (size_t i = 0; i < branch.size(); i++)
            if (branch[i] >= 0) index[fill[static_cast<size_t>(branch[i])]++] = static_cast<int32_t>(i);
    }

    std::span<int32_t> of(size_t branch) {
        return std::span(index).subspan(begin[branch], begin[branch + 1] - begin[branch]);
    }
};

// What branches refined one after another take turns with.
struct Scratch {
    explicit Scratch(const Progress& p) : progress(p) {}

    const Progress& progress;
    std::vector<std::array<DVec3, 2>> frame;
    std::vector<std::pair<int, Sample>> found;
    std::vector<size_t> begin, fill;
    std::vector<Sample> samples;
    std::vector<float> values, across;
    std::vector<Vec2> offsets;
    std::vector<uint8_t> round;
    std::vector<DVec3> shift;
};

// One branch in one round. Reads the axes of the round before.
class BranchRefiner {
  public:
    BranchRefiner(size_t index, const std::vector<std::vector<Station>>& axes,
                  const std::vector<SkeletonBranch>& branches, std::span<const int32_t> sides,
                  const std::vector<Bounds>& bases, const PointPlaces& places,
                  std::span<const int32_t> own_points, const std::vector<Vec3>& points, double noise,
                  double least_noise, PassSet left_out, Scratch& scratch)
        : axes_(axes),
          branches_(branches),
          branch_(branches[index]),
          sides_(sides),
          bases_(bases),
          places_(places),
          own_points_(own_points),
          points_(points),
          noise_(noise),
          section_noise_(noise > 0.0 ? std::max(noise, least_noise) : 0.0),
          line_(axes[index]),
          count_(static_cast<int>(line_.size())),
          left_out_(left_out),
          scratch_(scratch) {}

    std::vector<Station> run() {
        if (count_ < 2) return line_;
        lay_frames();
        if (branch_.parent >= 0)
            parent_bark_ = around_bark(axes_[branch_.parent], branch_.attach - kNearStations - 1,
                                       branch_.attach + 1 + kNearStations);
        collect();
        round_.assign(line_.size(), 0);
        std::vector<Station> result = line_;
        std::vector<DVec3>& shift = scratch_.shift;
        shift.assign(line_.size(), DVec3(0.0));
        for (int i = 0; i < count_; i++)
            refine_station(i, result[i], shift[i]);
        if (!left_out_.has(Pass::kRoundStations)) believe_round(result);
        for (int i = 0; i < count_; i++) {
            if (stays(i)) continue;
            DVec3 sum = 2.0 * shift[i];
            sum += i > 0 && !line_[i].bridged ? shift[i - 1] : shift[i];
            sum += i + 1 < count_ && !line_[i + 1].bridged ? shift[i + 1] : shift[i];
            result[i].position += 0.25 * sum;
        }
        return result;
    }

  private:
    bool stays(int i) const {
        return line_[i].bridged || (i + 1 < count_ && line_[i + 1].bridged) || (i == 0 && branch_.parent < 0);
    }

    DVec3 direction(int i) const {
        const DVec3 along = line_[std::min(i + 1, count_ - 1)].position - line_[std::max(i - 1, 0)].position;
        return normalized_or(along, DVec3(0, 1, 0));
    }

    // Frames that turn as little as possible, so that neighbours' samples can be put together.
    void lay_frames() {
        frame_.resize(line_.size());
        DVec3 u = any_perpendicular(direction(0));
        for (int i = 0; i < count_; i++) {
            const DVec3 along = direction(i);
            u -= glm::dot(u, along) * along;
            u = glm::length(u) > 1e-6 ? glm::normalize(u) : any_perpendicular(along);
            frame_[i] = {u, glm::cross(along, u)};
        }
    }

    // The segment with the nearest axis among [first, last] of a line, where segment j ends at station j. (To
    // choose by the surface would lead points inside of it to far segments, and make the branch seem
    // thicker.)
    static Hit nearest(const DVec3& p, const std::vector<Station>& line, int first, int last, int& at) {
        first = std::max(first, 1);
        last = std::min(last, static_cast<int>(line.size()) - 1);
        double best = std::numeric_limits<double>::max();
        for (int j = first; j <= last; j++) {
            double t;
            const double square = square_to_segment(p, line[j - 1].position, line[j].position, t);
            if (square >= best) continue;
            best = square;
            at = j;
        }
        if (first > last) {
            Hit none;
            none.off = std::numeric_limits<double>::max();
            return none;
        }
        return hit_segment(p, line[at - 1].position, line[at - 1].radius, line[at].position, line[at].radius);
    }

    // Whether a point belongs to the parent or to a side branch rather than to this one.
    bool is_foreign(const DVec3& p, int station, double off) const {
        int ignored = 0;
        if (branch_.parent >= 0 && station <= kNearStations && is_near(parent_bark_, p, off)) {
            const Hit hit = nearest(p, axes_[branch_.parent], branch_.attach - kNearStations,
                                    branch_.attach + 1 + kNearStations, ignored);
            if (std::abs(hit.off) < off) return true;
        }
        for (auto it =
                 std::lower_bound(sides_.begin(), sides_.end(), station - kNearStations,
                                  [&](int32_t side, int from) { return branches_[side].attach < from; });
             it != sides_.end() && branches_[*it].attach <= station + kNearStations; ++it) {
            if (!is_near(bases_[*it], p, off)) continue;
            const std::vector<Station>& side = axes_[*it];
            const Station& fork = line_[branches_[*it].attach];
            const Hit base = hit_segment(p, fork.position, side[0].radius, side[0].position, side[0].radius);
            if (std::abs(base.off) < off) return true;
            if (std::abs(nearest(p, side, 1, kFirstSegments, ignored).off) < off) return true;
        }
        return false;
    }

    void add_point(uint32_t v, int station, std::vector<std::pair<int, Sample>>& found) const {
        const DVec3 p(points_[v]);
        int at = 0;
        const Hit hit = nearest(p, line_, station - kNearSegments + 1, station + kNearSegments, at);
        if (at == 0 || hit.distance <= 0.0) return;
        // Beyond the ends, the distance says nothing about the radius.
        if ((at == 1 && hit.t <= 0.0) || (at == count_ - 1 && hit.t >= 1.0)) return;
        if (!left_out_.has(Pass::kForeignPoints) && is_foreign(p, station, std::abs(hit.off))) return;
        const int own = hit.t < 0.5 ? at - 1 : at;
        const DVec3 n = hit.offset / hit.distance;
        found.emplace_back(
            own, Sample{static_cast<float>(glm::dot(n, frame_[own][0])),
                        static_cast<float>(glm::dot(n, frame_[own][1])), static_cast<float>(hit.distance)});
    }

    // The samples, by station.
    void collect() {
        std::vector<std::pair<int, Sample>>& found = scratch_.found;
        found.clear();
        size_t looked = 0;
        for (const int32_t v : own_points_) {
            if (++looked % kPointsPerCheck == 0) scratch_.progress.check();
            add_point(static_cast<uint32_t>(v), places_.station[v], found);
        }
        begin_.assign(line_.size() + 1, 0);
        for (const auto& [station, sample] : found)
            begin_[station + 1]++;
        for (size_t i = 0; i < line_.size(); i++)
            begin_[i + 1] += begin_[i];
        samples_.resize(found.size());
        std::vector<size_t>& fill = scratch_.fill;
        fill.assign(begin_.begin(), begin_.end() - 1);
        for (const auto& [station, sample] : found)
            samples_[fill[station]++] = sample;
    }

    // The stations whose points speak for station i.
    std::pair<int, int> window(int i) const {
        int first = i;
        int last = i;
        const double reach = kWindow * line_[i].radius;
        double before = 0.0;
        double after = 0.0;
        for (bool grew = true; grew;) {
            grew = false;
            const bool few = begin_[last + 1] - begin_[first] < kWantedPoints;
            if (first > 0 && !line_[first].bridged) {
                const double step = glm::distance(line_[first].position, line_[first - 1].position);
                if (before + step <= reach || (few && i - first < kWidestWindow)) {
                    before += step;
                    first--;
                    grew = true;
                }
            }
            if (last + 1 < count_ && !line_[last + 1].bridged) {
                const double step = glm::distance(line_[last].position, line_[last + 1].position);
                if (after + step <= reach || (few && last - i < kWidestWindow)) {
                    after += step;
                    last++;
                    grew = true;
                }
            }
        }
        return {first, last};
    }

    // The share of eight directions from which points on the surface are seen.
    double coverage(size_t begin, size_t end, double radius, double scale) const {
        std::array<bool, 8> seen{};
        for (size_t s = begin; s < end; s++) {
            const Sample& sample = samples_[s];
            if (std::abs(sample.distance - radius) > scale) continue;
            seen[(sample.x < 0.0f ? 4 : 0) | (sample.y < 0.0f ? 2 : 0) |
                 (std::abs(sample.y) > std::abs(sample.x) ? 1 : 0)] = true;
        }
        return static_cast<double>(std::count(seen.begin(), seen.end(), true)) / 8.0;
    }

    double seen_radius(size_t begin, size_t end, double median) const {
        if (left_out_.has(Pass::kOneSided)) return median;
        scratch_.offsets.clear();
        for (size_t s = begin; s < end; s++)
            scratch_.offsets.push_back(samples_[s].distance * Vec2(samples_[s].x, samples_[s].y));
        return radius_across(scratch_.offsets, median, section_noise_, scratch_.across);
    }

    // Where the points surround the axis at one distance, that is the radius, even if they are too few or too
    // noisy for a circle of their own. A station that none of its neighbours confirms is an accident.
    void believe_round(std::vector<Station>& result) const {
        for (int i = 0; i < count_; i++) {
            if (result[i].measured || !round_[i]) continue;
            bool confirmed = false;
            for (int j = std::max(0, i - 2); j <= std::min(count_ - 1, i + 2); j++)
                confirmed =
                    confirmed || (j != i && (round_[j] || line_[j].measured) &&
                                  std::abs(result[j].radius - result[i].radius) < kAlike * result[i].radius);
            result[i].measured = confirmed;
        }
    }

    void refine_station(int i, Station& station, DVec3& shift) {
        const auto [first, last] = window(i);
        const size_t begin = begin_[first];
        const size_t end = begin_[last + 1];
        station.scatter = 0.0;
        if (end - begin < kLeastPoints) {
            if (!station.measured) station.radius = 0.0;
            return;
        }
        values_.clear();
        for (size_t s = begin; s < end; s++)
            values_.push_back(samples_[s].distance);
        const double median = median_of(values_);
        const double middle = station.measured ? median : seen_radius(begin, end, median);
        const double radius = station.measured ? station.radius : middle;
        for (float& value : values_)
            value = std::abs(value - static_cast<float>(radius));
        const double deviation = median_of(values_);
        const double scale = kTukey * (kMadToSigma * deviation + 1e-6 * radius + 1e-9);
        Normal normal;
        for (size_t s = begin; s < end; s++) {
            const double residual = samples_[s].distance - radius;
            const double t = residual / scale;
            if (std::abs(t) < 1.0) normal.add(samples_[s], (1.0 - t * t) * (1.0 - t * t), residual);
        }
        const DVec3 step = normal.solve();
        DVec2 move(step.x, step.y);
        const double most = kMostShift * std::max(line_[i].radius, kThinTwig);
        if (glm::length(move) > most) move *= most / glm::length(move);
        shift = move.x * frame_[i][0] + move.y * frame_[i][1];
        station.scatter = deviation;
        station.radius = station.measured ? std::max(kThinnest, radius + step.z) : middle;
        round_[i] = end - begin >= kRoundPoints && deviation <= kRoundScatter * radius && noise_ > 0.0 &&
                    radius >= kAboveNoise * noise_ &&
                    static_cast<double>(end - begin) * radius >=
                        kRoundDensity * glm::distance(line_[first].position, line_[last].position) &&
                    coverage(begin, end, radius, scale) >= kRoundCoverage;
    }

    const std::vector<std::vector<Station>>& axes_;
    const std::vector<SkeletonBranch>& branches_;
    const SkeletonBranch& branch_;
    std::span<const int32_t> sides_;  // by attach
    const std::vector<Bounds>& bases_;
    Bounds parent_bark_;  // where the branch begins
    const PointPlaces& places_;
    std::span<const int32_t> own_points_;
    const std::vector<Vec3>& points_;
    double noise_;
    double section_noise_;  // 0 where nothing is known
    const std::vector<Station>& line_;
    int count_;
    PassSet left_out_;
    Scratch& scratch_;
    std::vector<std::array<DVec3, 2>>& frame_ = scratch_.frame;
    std::vector<size_t>& begin_ = scratch_.begin;
    std::vector<Sample>& samples_ = scratch_.samples;
    std::vector<float>& values_ = scratch_.values;
    std::vector<uint8_t>& round_ = scratch_.round;  // by station
};

// By branch: around the bark that may hold points of its parent, from the fork on.
std::vector<Bounds> bark_of_bases(const std::vector<std::vector<Station>>& axes,
                                  const std::vector<SkeletonBranch>& branches) {
    std::vector<Bounds> bases(axes.size());
    for (size_t l = 0; l < axes.size(); l++) {
        if (branches[l].parent < 0) continue;
        bases[l] = around_bark(axes[l], 0, kFirstSegments);
        bases[l].add(axes[branches[l].parent][branches[l].attach].position, axes[l][0].radius);
    }
    return bases;
}

}  // namespace

void refine_axes(std::vector<std::vector<Station>>& axes, const std::vector<SkeletonBranch>& branches,
                 const PointPlaces& places, const std::vector<Vec3>& points, Progress& progress,
                 double least_noise, PassSet left_out) {
    Members own_points(places.branch, branches.size());
    std::vector<int32_t> parent(branches.size());
    for (size_t l = 0; l < branches.size(); l++)
        parent[l] = branches[l].parent;
    Members sides(parent, branches.size());
    for (int round = 0; round < (left_out.has(Pass::kSecondRefinement) ? 1 : kRounds); round++) {
        const double noise = noise_of(axes);
        const std::vector<Bounds> bases = bark_of_bases(axes, branches);
        std::vector<std::vector<Station>> next(axes.size());
        parallel_for(axes.size(), 16, [&](size_t from, size_t to) {
            Scratch scratch(progress);
            for (size_t l = from; l < to; l++) {
                progress.check();
                const std::span<int32_t> own_sides = sides.of(l);
                if (round == 0)
                    std::sort(own_sides.begin(), own_sides.end(), [&](int32_t a, int32_t b) {
                        return std::pair(branches[a].attach, a) < std::pair(branches[b].attach, b);
                    });
                next[l] = BranchRefiner(l, axes, branches, own_sides, bases, places, own_points.of(l), points,
                                        noise, least_noise, left_out, scratch)
                              .run();
            }
        });
        axes.swap(next);
    }
}

}  // namespace treerec
