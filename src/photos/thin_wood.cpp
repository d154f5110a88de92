#include "photos/thin_wood.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "geometry/parallel.h"
#include "photos/affine_track.h"
#include "photos/cameras_tell.h"

namespace treerec {

namespace {

constexpr int kCell = 4;            // pixels of a cell of lines
constexpr double kOnLine = 0.75;    // pixels from an epipolar line: lines' places are a pixel or so apart
constexpr double kAcross = 0.3;     // sine of the least angle between a line and the epipolar line
constexpr double kAlong = 1.6;      // pixels along the line, too
constexpr double kSameWay = 0.94;   // cosine of 20 degrees
constexpr double kSameWidth = 1.7;  // one width by the other
constexpr size_t kStates = 6;       // depths of a place that are thought of
constexpr double kJump = 1.5;       // of score: what it costs where depth jumps from a place to the next
constexpr double kFree = 1.5;       // pixels that it may change, seen from the side
constexpr double kNoneGain = 1.6;   // of score: what a place without a depth counts as
constexpr size_t kLeastRow = 3;     // places that follow each other

// A line's place in a photo without distortion, in pixels from the principal point.
struct Mark {
    DVec2 place{0.0}, way{0.0};
    double width = 0.0;
};

// The lines of one photo, without the lens's distortion.
class PhotoLines {
  public:
    PhotoLines(const Photo& photo, const Camera& camera, const std::vector<std::vector<Ridge>>& ridges,
               double scale)
        : centre(photo.centre()), turn(photo.turn()), focal(camera.focal_length() * scale) {
        DVec2 low(1e30), high(-1e30);
        for (const std::vector<Ridge>& row : ridges) {
            std::vector<Mark> marks;
            for (const Ridge& ridge : row) {
                // The model counts from the first pixel's corner.
                const DVec2 at = (ridge.place + 0.5) / scale, beside = at + 2.0 / scale * ridge.way;
                const auto here = camera.ray(at), there = camera.ray(beside);
                if (!here || !there) continue;
                const DVec2 way = focal * DVec2(*there - *here);
                if (!(glm::length(way) > 0.1)) continue;
                marks.push_back(
                    {focal * DVec2(*here), glm::normalize(way), ridge.width * glm::length(way) / 2.0});
                low = glm::min(low, marks.back().place);
                high = glm::max(high, marks.back().place);
            }
            if (!marks.empty()) rows.push_back(std::move(marks));
        }
        if (rows.empty()) return;
        low_ = low - 1.0;
        width_ = static_cast<int>((high.x - low_.x) / kCell) + 2;
        height_ = static_cast<int>((high.y - low_.y) / kCell) + 2;
        starts_.assign(static_cast<size_t>(width_) * static_cast<size_t>(height_) + 1, 0);
        for (const auto& row : rows)
            for (const Mark& mark : row)
                starts_[cell_of(mark.place) + 1]++;
        for (size_t i = 1; i < starts_.size(); i++)
            starts_[i] += starts_[i - 1];
        marks_.resize(starts_.back());
        std::vector<uint32_t> next(starts_.begin(), starts_.end() - 1);
        for (const auto& row : rows)
            for (const Mark& mark : row)
                marks_[next[cell_of(mark.place)]++] = mark;
    }

    DVec3 to_camera(const DVec3& p) const { return turn * (p - centre); }

    // Calls body for each mark in the cells around a place.
    template <typename Body>
    void around(const DVec2& place, const Body& body) const {
        if (starts_.empty()) return;
        const DVec2 at = (place - low_) / static_cast<double>(kCell);
        if (!(at.x > -1.0 && at.y > -1.0 && at.x < width_ + 1 && at.y < height_ + 1)) return;
        // A quarter of a cell covers what is asked for.
        const int left = std::max(static_cast<int>(std::floor(at.x - 0.5)), 0),
                  right = std::min(static_cast<int>(std::floor(at.x + 0.5)), width_ - 1),
                  top = std::max(static_cast<int>(std::floor(at.y - 0.5)), 0),
                  bottom = std::min(static_cast<int>(std::floor(at.y + 0.5)), height_ - 1);
        for (int y = top; y <= bottom; y++)
            for (int x = left; x <= right; x++) {
                const size_t cell =
                    static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
                for (uint32_t i = starts_[cell]; i < starts_[cell + 1]; i++)
                    body(marks_[i]);
            }
    }

    // The part of a straight line, begin to end, where there are lines at all; false where there are none.
    bool clip(DVec2& begin, DVec2& end) const {
        if (starts_.empty()) return false;
        const DVec2 high = low_ + static_cast<double>(kCell) * DVec2(width_, height_);
        double from = 0.0, to = 1.0;
        const DVec2 way = end - begin;
        for (int axis = 0; axis < 2; axis++) {
            if (std::abs(way[axis]) < 1e-9) {
                if (begin[axis] < low_[axis] || begin[axis] > high[axis]) return false;
                continue;
            }
            const double a = (low_[axis] - begin[axis]) / way[axis],
                         b = (high[axis] - begin[axis]) / way[axis];
            from = std::max(from, std::min(a, b));
            to = std::min(to, std::max(a, b));
        }
        if (!(from < to)) return false;
        end = begin + to * way;
        begin += from * way;
        return true;
    }

    DVec3 centre;
    DMat3 turn;
    double focal;
    std::vector<std::vector<Mark>> rows;

  private:
    size_t cell_of(const DVec2& place) const {
        const DVec2 at = (place - low_) / static_cast<double>(kCell);
        return static_cast<size_t>(at.y) * static_cast<size_t>(width_) + static_cast<size_t>(at.x);
    }

    DVec2 low_{0.0};
    int width_ = 0, height_ = 0;
    std::vector<uint32_t> starts_;
    std::vector<Mark> marks_;  // by cell
};

struct Depth {
    double depth = 0.0, score = 0.0;
    DVec3 way{0.0};
    size_t seen = 0;
};

// A photo's lines, looked for in its neighbours.
class Matcher {
  public:
    Matcher(const PhotoLines& own, const std::vector<const PhotoLines*>& others,
            const std::function<DepthRange(const DVec3&, const DVec3&)>& range_of,
            const ThinWoodOptions& options)
        : own_(own), others_(others), range_of_(range_of), options_(options) {}

    // The likeliest depths of a mark, the best first.
    std::vector<Depth> depths_of(const Mark& mark) const {
        const DVec3 seen(mark.place / own_.focal, 1.0);
        const DVec3 along = glm::transpose(own_.turn) * seen;
        const DepthRange range = range_of_(own_.centre, along);
        if (!(range.least < range.most)) return {};
        const DVec3 normal =
            glm::transpose(own_.turn) * glm::cross(seen, DVec3(mark.way, 0.0));  // of the plane through both
        std::vector<Depth> found;
        for (const PhotoLines* other : others_) {
            const DVec3 a = other->to_camera(own_.centre), b = other->turn * along;
            crossings(mark, *other, a, b, range, [&](double depth, const Mark& there) {
                const DVec3 side =
                    glm::cross(glm::transpose(other->turn) * DVec3(there.place / other->focal, 1.0),
                               glm::transpose(other->turn) * DVec3(there.way, 0.0));
                const DVec3 way = glm::cross(normal, side);
                if (glm::length(way) > 1e-9) found.push_back({depth, 0.0, glm::normalize(way), 0});
            });
        }
        std::sort(found.begin(), found.end(),
                  [](const Depth& x, const Depth& y) { return x.depth < y.depth; });
        for (Depth& depth : found)
            score(mark, along, depth);
        std::stable_sort(found.begin(), found.end(),
                         [](const Depth& x, const Depth& y) { return x.score > y.score; });
        std::vector<Depth> best;
        for (const Depth& depth : found) {
            if (depth.seen < options_.least_seen || depth.score < options_.least_score) continue;
            const bool near = std::any_of(best.begin(), best.end(), [&](const Depth& other) {
                return shift(other.depth, depth.depth) < 2.0 * options_.tolerance;
            });
            if (near) continue;
            best.push_back(depth);
            if (best.size() == kStates) break;
        }
        return best;
    }

    // Pixels by which two depths differ, seen 15 degrees from the side.
    double shift(double one, double other) const {
        return 0.26 * own_.focal * std::abs(one - other) / std::min(one, other);
    }

    // What is found from one row of marks.
    void follow(const std::vector<Mark>& row, uint32_t photo, std::vector<ThinPlace>& places) const {
        std::vector<const Mark*> asked;
        std::vector<std::vector<Depth>> states;
        for (size_t i = 0; i < row.size(); i += options_.every) {
            asked.push_back(&row[i]);
            states.push_back(depths_of(row[i]));
        }
        // Viterbi: the last state of each place is that it has no depth.
        std::vector<std::vector<double>> sums(states.size());
        std::vector<std::vector<size_t>> before(states.size());
        for (size_t i = 0; i < states.size(); i++) {
            const size_t count = states[i].size() + 1;
            sums[i].resize(count);
            before[i].assign(count, 0);
            for (size_t s = 0; s < count; s++) {
                const double gain = s + 1 < count ? states[i][s].score : kNoneGain;
                if (i == 0) {
                    sums[i][s] = gain;
                    continue;
                }
                double best = -1e30;
                for (size_t t = 0; t < sums[i - 1].size(); t++) {
                    const bool none = s + 1 == count, was_none = t + 1 == sums[i - 1].size();
                    double cost = 0.0;
                    if (none != was_none)
                        cost = 0.5 * kJump;
                    else if (!none)
                        cost = kJump * std::min(1.0, shift(states[i - 1][t].depth, states[i][s].depth) /
                                                         (kFree * static_cast<double>(options_.every)));
                    if (sums[i - 1][t] - cost > best) {
                        best = sums[i - 1][t] - cost;
                        before[i][s] = t;
                    }
                }
                sums[i][s] = best + gain;
            }
        }
        if (states.empty()) return;
        std::vector<size_t> chosen(states.size());
        chosen.back() = static_cast<size_t>(std::max_element(sums.back().begin(), sums.back().end()) -
                                            sums.back().begin());
        for (size_t i = states.size() - 1; i > 0; i--)
            chosen[i - 1] = before[i][chosen[i]];
        std::vector<ThinPlace> run;
        const auto end_run = [&] {
            if (run.size() >= kLeastRow) places.insert(places.end(), run.begin(), run.end());
            run.clear();
        };
        double last = 0.0;
        for (size_t i = 0; i < states.size(); i++) {
            if (chosen[i] == states[i].size()) {
                end_run();
                continue;
            }
            const Depth& depth = states[i][chosen[i]];
            if (!run.empty() && shift(last, depth.depth) > kFree * static_cast<double>(options_.every))
                end_run();
            last = depth.depth;
            const DVec3 along = glm::transpose(own_.turn) * DVec3(asked[i]->place / own_.focal, 1.0);
            ThinPlace place;
            place.position = own_.centre + depth.depth * along;
            place.way = depth.way;
            place.pixel = depth.depth / own_.focal;
            place.radius = 0.5 * asked[i]->width * place.pixel;
            place.photo = photo;
            run.push_back(place);
        }
        end_run();
    }

  private:
    // Where the other photo's lines cross the mark's epipolar line.
    template <typename Body>
    void crossings(const Mark& mark, const PhotoLines& other, const DVec3& a, const DVec3& b,
                   const DepthRange& range, const Body& body) const {
        DVec3 near = a + range.least * b, far = a + range.most * b;
        if (near.z < 0.05 * range.least || far.z < 0.05 * range.least) return;
        DVec2 begin = other.focal * DVec2(near) / near.z, end = other.focal * DVec2(far) / far.z;
        const DVec2 whole = end - begin;
        const double length = glm::length(whole);
        if (!(length > 1.0) || !other.clip(begin, end)) return;
        const DVec2 way = whole / length, across(-way.y, way.x);
        const double steps = std::ceil(glm::length(end - begin) / (0.5 * kCell));
        if (!(steps < 4000.0)) return;
        double last = -1e30;
        for (int k = 0; k <= static_cast<int>(steps); k++) {
            const DVec2 at = glm::mix(begin, end, std::min(1.0, k / std::max(steps, 1.0)));
            other.around(at, [&](const Mark& there) {
                const DVec2 from = there.place - begin;
                if (std::abs(glm::dot(from, across)) > kOnLine) return;
                // Each cell is met by a few steps; the step that is nearest takes it.
                const double along = glm::dot(there.place - at, way);
                if (!(along > -0.25 * kCell && along <= 0.25 * kCell)) return;
                const double sine = there.way.x * way.y - there.way.y * way.x;
                if (std::abs(sine) < kAcross) return;
                // Where the line itself crosses.
                const double t = glm::dot(from, across) / glm::dot(there.way, across);
                const DVec2 place = there.place - t * there.way;
                const double u =
                    std::abs(b.x - b.z * place.x / other.focal) > std::abs(b.y - b.z * place.y / other.focal)
                        ? (a.z * place.x / other.focal - a.x) / (b.x - b.z * place.x / other.focal)
                        : (a.z * place.y / other.focal - a.y) / (b.y - b.z * place.y / other.focal);
                if (!(u > range.least && u < range.most)) return;
                const double depth = a.z + u * b.z;
                if (!(depth > 0.0)) return;
                const double wide = mark.width * u / own_.focal,
                             other_wide = there.width * depth / other.focal;
                if (wide > kSameWidth * other_wide + depth / other.focal ||
                    other_wide > kSameWidth * wide + depth / other.focal)
                    return;
                const double here = glm::dot(place - begin, way);
                // Of the same line, which has a place at each pixel.
                if (std::abs(here - last) < 0.3) return;
                last = here;
                body(u, there);
            });
        }
    }

    // How many photos see a line where this depth leads, and how well.
    void score(const Mark& mark, const DVec3& along, Depth& depth) const {
        const DVec3 place = own_.centre + depth.depth * along,
                    beside = place + 0.01 * depth.depth * depth.way;
        const double wide = mark.width * depth.depth / own_.focal;
        for (const PhotoLines* other : others_) {
            const DVec3 p = other->to_camera(place), q = other->to_camera(beside);
            if (!(p.z > 0.0 && q.z > 0.0)) continue;
            const DVec2 at = other->focal * DVec2(p) / p.z, next = other->focal * DVec2(q) / q.z;
            const double step = glm::length(next - at);
            // Wood that points at the camera has no way there.
            const bool tells = step > 0.002 * other->focal;
            const DVec2 way = step > 0.0 ? (next - at) / step : DVec2(0.0);
            double best = 0.0;
            other->around(at, [&](const Mark& there) {
                const DVec2 miss = there.place - at;
                const double off = std::abs(miss.x * there.way.y - miss.y * there.way.x) / options_.tolerance;
                if (off >= 1.0 || std::abs(glm::dot(miss, there.way)) > kAlong) return;
                if (tells && std::abs(glm::dot(way, there.way)) < kSameWay) return;
                const double other_wide = there.width * p.z / other->focal, pixel = p.z / other->focal;
                if (wide > kSameWidth * other_wide + pixel || other_wide > kSameWidth * wide + pixel) return;
                best = std::max(best, 1.0 - off * off);
            });
            depth.score += best;
            depth.seen += best > 0.0;
        }
    }

    const PhotoLines& own_;
    const std::vector<const PhotoLines*>& others_;
    const std::function<DepthRange(const DVec3&, const DVec3&)>& range_of_;
    const ThinWoodOptions& options_;
};

}  // namespace

std::vector<ThinPlace> match_lines(
    const PhotoModel& model, const std::vector<std::vector<std::vector<Ridge>>>& ridges,
    std::span<const double> scales, const DVec3& subject,
    const std::function<DepthRange(const DVec3& from, const DVec3& along)>& range_of,
    const ThinWoodOptions& options, Progress* progress) {
    std::vector<PhotoLines> lines;
    for (size_t i = 0; i < model.photos.size(); i++)
        lines.emplace_back(model.photos[i], model.cameras[static_cast<size_t>(model.photos[i].camera)],
                           ridges[i], scales[i]);
    std::vector<std::vector<ThinPlace>> found(lines.size());
    std::atomic<size_t> done = 0;
    parallel_for(lines.size(), 1, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; i++) {
            std::vector<std::pair<double, size_t>> near;
            for (size_t j = 0; j < lines.size(); j++) {
                const double angle = degrees_between(lines[i].centre - subject, lines[j].centre - subject);
                if (j != i && angle >= options.least_angle && angle <= options.most_angle)
                    near.emplace_back(angle, j);
            }
            std::sort(near.begin(), near.end());
            near.resize(std::min(near.size(), options.neighbours));
            std::vector<const PhotoLines*> others;
            for (const auto& [angle, j] : near)
                others.push_back(&lines[j]);
            const Matcher matcher(lines[i], others, range_of, options);
            for (const auto& row : lines[i].rows) {
                if (progress) progress->check();
                matcher.follow(row, static_cast<uint32_t>(i), found[i]);
            }
            if (progress)
                progress->update(static_cast<double>(++done) / static_cast<double>(lines.size()),
                                 "Thin wood");
        }
    });
    std::vector<ThinPlace> all;
    for (const auto& some : found)
        all.insert(all.end(), some.begin(), some.end());
    return all;
}

}  // namespace treerec
