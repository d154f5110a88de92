#include "photos/quilt.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "error.h"
#include "geometry/parallel.h"
#include "geometry/vec.h"

namespace treerec {

namespace {

constexpr std::array<int, 4> kPieces = {3, 4, 6, 8};
constexpr double kRoom = 1.0;        // places for a piece, over its pixels
constexpr double kLeastRoom = 0.05;  // likewise, for the smallest ones
constexpr int kStride = 6;           // pixels between the places, and the pixels, that are looked at first
constexpr double kFaultCost = 1.5;   // in variances of the source
constexpr double kAgainCost = 2.0;   // for the same piece once more
constexpr double kFeather = 3.0;     // pixels on either side of a cut
constexpr size_t kRows = 4;

// Sums over rectangles.
class SummedArea {
  public:
    template <typename Value>
    SummedArea(int width, int height, Value value)
        : stride_(static_cast<size_t>(width) + 1), sums_(stride_ * (static_cast<size_t>(height) + 1), 0.0) {
        for (int y = 0; y < height; y++) {
            double row = 0.0;
            for (int x = 0; x < width; x++) {
                row += value(x, y);
                sums_[index(x + 1, y + 1)] = sums_[index(x + 1, y)] + row;
            }
        }
    }
    double of(int x, int y, int width, int height) const {
        return sums_[index(x + width, y + height)] - sums_[index(x, y + height)] -
               sums_[index(x + width, y)] + sums_[index(x, y)];
    }

  private:
    size_t index(int x, int y) const { return static_cast<size_t>(y) * stride_ + static_cast<size_t>(x); }

    size_t stride_;
    std::vector<double> sums_;
};

struct PieceSize {
    int step_x, step_y;        // at most
    int overlap_x, overlap_y;  // pixels
    int width() const { return step_x + overlap_x; }
    int height() const { return step_y + overlap_y; }
};

PieceSize size_of(int pieces, const QuiltOptions& options) {
    const auto step = [&](int size) { return (size + pieces - 1) / pieces; };
    PieceSize size{step(options.width), step(options.height), 0, 0};
    size.overlap_x = std::max(2, static_cast<int>(options.overlap * size.step_x));
    size.overlap_y = std::max(2, static_cast<int>(options.overlap * size.step_y));
    return size;
}

struct Piece {
    int x = 0, y = 0;  // in the source
};

class Quilt {
  public:
    Quilt(const Image& source, const std::vector<float>& fault, int pieces, const QuiltOptions& options)
        : source_(source),
          pieces_(pieces),
          size_(size_of(pieces, options)),
          width_(options.width),
          height_(options.height),
          barred_(source.width, source.height,
                  [&](int x, int y) { return fault[pixel(x, y)] >= 1.0f ? 1.0 : 0.0; }),
          faults_(source.width, source.height,
                  [&](int x, int y) { return static_cast<double>(std::min(fault[pixel(x, y)], 1.0f)); }) {
        soften();
        colours_.assign(static_cast<size_t>(width_) * static_cast<size_t>(height_), DVec3(0.0));
        from_.assign(colours_.size(), -1);
        measure_variance(fault);
    }

    Image make(const Progress* progress) {
        for (int row = 0; row < pieces_; row++)
            for (int column = 0; column < pieces_; column++) {
                if (progress) progress->check();
                lay(column, row, choose(column, row));
            }
        Image picture(width_, height_, 3);
        for (size_t i = 0; i < colours_.size(); i++)
            for (int c = 0; c < 3; c++)
                picture.pixels[3 * i + static_cast<size_t>(c)] =
                    static_cast<uint8_t>(std::clamp(std::lround(colours_[i][c]), 0L, 255L));
        return picture;
    }

  private:
    size_t pixel(int x, int y) const {
        return static_cast<size_t>(y) * static_cast<size_t>(source_.width) + static_cast<size_t>(x);
    }
    size_t made(int x, int y) const {
        return static_cast<size_t>(y % height_) * static_cast<size_t>(width_) +
               static_cast<size_t>(x % width_);
    }
    int start_x(int column) const { return column * width_ / pieces_; }
    int start_y(int row) const { return row * height_ / pieces_; }

    // The source as it is compared: without its grain.
    void soften() {
        soft_.resize(static_cast<size_t>(source_.width) * static_cast<size_t>(source_.height));
        parallel_for(static_cast<size_t>(source_.height), 16, [&](size_t begin, size_t end) {
            for (int y = static_cast<int>(begin); y < static_cast<int>(end); y++)
                for (int x = 0; x < source_.width; x++) {
                    Vec3 sum(0.0f);
                    for (int v = -1; v <= 1; v++)
                        for (int u = -1; u <= 1; u++) {
                            const uint8_t* level = source_.at(std::clamp(x + u, 0, source_.width - 1),
                                                              std::clamp(y + v, 0, source_.height - 1));
                            sum += Vec3(level[0], level[1], level[2]);
                        }
                    soft_[pixel(x, y)] = sum / 9.0f;
                }
        });
    }

    void measure_variance(const std::vector<float>& fault) {
        DVec3 sum(0.0), squares(0.0);
        double count = 0.0;
        for (size_t i = 0; i < soft_.size(); i++) {
            if (fault[i] >= 1.0f) continue;
            const DVec3 level(soft_[i]);
            sum += level;
            squares += level * level;
            count += 1.0;
        }
        if (count == 0.0) return;
        const DVec3 spread = squares / count - (sum / count) * (sum / count);
        variance_ = std::max(1.0, spread.x + spread.y + spread.z);
    }

    // Which sides of a piece lie on pieces that were laid before: left, right, above, below.
    std::array<bool, 4> sides(int column, int row) const {
        return {column > 0, column == pieces_ - 1, row > 0, row == pieces_ - 1};
    }

    struct Sample {
        int x, y;     // in the piece
        Vec3 colour;  // what lies there
    };
    std::vector<Sample> samples(int column, int row, int stride) const {
        const std::array<bool, 4> on = sides(column, row);
        const int step_x = start_x(column + 1) - start_x(column), step_y = start_y(row + 1) - start_y(row);
        std::vector<Sample> list;
        for (int y = 0; y < step_y + size_.overlap_y; y += stride)
            for (int x = 0; x < step_x + size_.overlap_x; x += stride) {
                const bool overlaps = (on[0] && x < size_.overlap_x) || (on[1] && x >= step_x) ||
                                      (on[2] && y < size_.overlap_y) || (on[3] && y >= step_y);
                const int32_t from = from_[made(start_x(column) + x, start_y(row) + y)];
                if (overlaps && from >= 0) list.push_back({x, y, soft_[static_cast<size_t>(from)]});
            }
        return list;
    }

    // How unlike what is there, how faulty, and how often seen a piece is, in variances.
    double cost_of(const Piece& piece, const std::vector<Sample>& list) const {
        const double area = static_cast<double>(size_.width()) * size_.height();
        double cost = kFaultCost * faults_.of(piece.x, piece.y, size_.width(), size_.height()) / area;
        for (const Piece& used : used_) {
            const double over_x = std::max(0, size_.width() - std::abs(piece.x - used.x));
            const double over_y = std::max(0, size_.height() - std::abs(piece.y - used.y));
            cost += kAgainCost * std::max(0.0, over_x * over_y / area - options_free());
        }
        if (list.empty()) return cost;
        double sum = 0.0;
        for (const Sample& sample : list) {
            const Vec3 off = soft_[pixel(piece.x + sample.x, piece.y + sample.y)] - sample.colour;
            sum += static_cast<double>(glm::dot(off, off));
        }
        return cost + sum / static_cast<double>(list.size()) / variance_;
    }
    // The share of a piece that goes on as the source does beside it.
    double options_free() const { return static_cast<double>(size_.overlap_x) / size_.width(); }

    bool fits(int x, int y) const {
        return x >= 0 && y >= 0 && x + size_.width() <= source_.width &&
               y + size_.height() <= source_.height && barred_.of(x, y, size_.width(), size_.height()) < 0.5;
    }

    Piece choose(int column, int row) {
        struct Best {
            double cost = std::numeric_limits<double>::max();
            Piece piece{-1, -1};
        };
        const std::vector<Sample> coarse = samples(column, row, kStride);
        const int rows = std::max(0, (source_.height - size_.height()) / kStride + 1);
        std::vector<Best> by_row(static_cast<size_t>(rows));
        parallel_for(by_row.size(), kRows, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; i++) {
                const int y = static_cast<int>(i) * kStride;
                for (int x = 0; x + size_.width() <= source_.width; x += kStride) {
                    if (!fits(x, y)) continue;
                    const double cost = cost_of({x, y}, coarse);
                    if (cost < by_row[i].cost) by_row[i] = {cost, {x, y}};
                }
            }
        });
        Best best;
        for (const Best& one : by_row)
            if (one.cost < best.cost) best = one;
        if (best.piece.x < 0)
            throw Error("The bark that the photos show has no room for a piece of a picture.");
        const Piece middle = best.piece;
        const std::vector<Sample> fine = samples(column, row, kStride / 2);
        best.cost = std::numeric_limits<double>::max();
        for (int y = middle.y - kStride; y <= middle.y + kStride; y++)
            for (int x = middle.x - kStride; x <= middle.x + kStride; x++) {
                if (!fits(x, y)) continue;
                const double cost = cost_of({x, y}, fine);
                if (cost < best.cost) best = {cost, {x, y}};
            }
        used_.push_back(best.piece);
        return best.piece;
    }

    // Where a strip of `across` pixels is best cut along its `along`: the place of the cut in each of its
    // rows. end: where it has to end; -1 for anywhere.
    template <typename Difference>
    static std::vector<int> cut(int across, int along, Difference difference, int end = -1) {
        const auto index = [&](int t, int s) {
            return static_cast<size_t>(t) * static_cast<size_t>(across) + static_cast<size_t>(s);
        };
        // There has to be room to fade on either side.
        const int margin = std::min(static_cast<int>(kFeather), (across - 1) / 2);
        const double barrier = 1e9;
        std::vector<double> sums(static_cast<size_t>(across) * static_cast<size_t>(along));
        for (int t = 0; t < along; t++)
            for (int s = 0; s < across; s++) {
                double before = 0.0;
                if (t > 0) {
                    before = sums[index(t - 1, s)];
                    if (s > 0) before = std::min(before, sums[index(t - 1, s - 1)]);
                    if (s + 1 < across) before = std::min(before, sums[index(t - 1, s + 1)]);
                }
                const bool beside = s < margin || s >= across - margin;
                sums[index(t, s)] = before + difference(s, t) + (beside ? barrier : 0.0);
            }
        std::vector<int> path(static_cast<size_t>(along));
        int s = std::max(0, end);
        for (int i = 1; i < across && end < 0; i++)
            if (sums[index(along - 1, i)] < sums[index(along - 1, s)]) s = i;
        for (int t = along - 1; t >= 0; t--) {
            if (t < along - 1) {
                const int last = s;
                for (int i = std::max(0, last - 1); i <= std::min(across - 1, last + 1); i++)
                    if (sums[index(t, i)] < sums[index(t, s)]) s = i;
            }
            path[static_cast<size_t>(t)] = s;
        }
        return path;
    }

    void lay(int column, int row, const Piece& piece) {
        const std::array<bool, 4> on = sides(column, row);
        const int left = start_x(column), top = start_y(row);
        const int step_x = start_x(column + 1) - left, step_y = start_y(row + 1) - top;
        const int width = step_x + size_.overlap_x, height = step_y + size_.overlap_y;
        const auto differs = [&](int x, int y) {
            const int32_t from = from_[made(left + x, top + y)];
            if (from < 0) return 0.0;
            const Vec3 off = soft_[pixel(piece.x + x, piece.y + y)] - soft_[static_cast<size_t>(from)];
            return static_cast<double>(glm::dot(off, off));
        };
        std::array<std::vector<int>, 4> cuts;
        if (on[0]) cuts[0] = cut(size_.overlap_x, height, [&](int s, int t) { return differs(s, t); });
        if (on[1])
            cuts[1] = cut(size_.overlap_x, height, [&](int s, int t) { return differs(step_x + s, t); });
        // Around the picture's border they go on as those of the row's first piece began.
        const auto across = [&](std::vector<int>& first, const auto& difference) {
            if (column + 1 < pieces_) {
                std::vector<int> path = cut(size_.overlap_y, width, difference);
                if (column == 0) first = path;
                return path;
            }
            std::vector<int> path = cut(size_.overlap_y, step_x, difference, first[0]);
            path.insert(path.end(), first.begin(), first.begin() + size_.overlap_x);
            return path;
        };
        if (on[2]) cuts[2] = across(first_top_, [&](int s, int t) { return differs(t, s); });
        if (on[3]) cuts[3] = across(first_bottom_, [&](int s, int t) { return differs(t, step_y + s); });
        const auto share = [](double inside) { return std::clamp(0.5 + 0.5 * inside / kFeather, 0.0, 1.0); };
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) {
                double weight = 1.0;
                if (on[0]) weight *= share(x - cuts[0][static_cast<size_t>(y)]);
                if (on[1]) weight *= share(step_x + cuts[1][static_cast<size_t>(y)] - x);
                if (on[2]) weight *= share(y - cuts[2][static_cast<size_t>(x)]);
                if (on[3]) weight *= share(step_y + cuts[3][static_cast<size_t>(x)] - y);
                const size_t here = made(left + x, top + y);
                if (from_[here] < 0) weight = 1.0;
                const uint8_t* level = source_.at(piece.x + x, piece.y + y);
                colours_[here] += weight * (DVec3(level[0], level[1], level[2]) - colours_[here]);
                if (weight >= 0.5) from_[here] = static_cast<int32_t>(pixel(piece.x + x, piece.y + y));
            }
    }

    const Image& source_;
    int pieces_;
    PieceSize size_;
    int width_, height_;
    SummedArea barred_, faults_;
    std::vector<Vec3> soft_;
    double variance_ = 1.0;
    std::vector<DVec3> colours_;  // of the picture
    std::vector<int32_t> from_;   // its pixels in the source, -1 where nothing lies yet
    std::vector<Piece> used_;
    std::vector<int> first_top_, first_bottom_;  // cuts of the row's first piece
};

}  // namespace

std::optional<int> pieces_of(const Image& source, const std::vector<float>& fault,
                             const QuiltOptions& options) {
    const SummedArea barred(source.width, source.height, [&](int x, int y) {
        return fault[static_cast<size_t>(y) * static_cast<size_t>(source.width) + static_cast<size_t>(x)] >=
                       1.0f
                   ? 1.0
                   : 0.0;
    });
    for (const int pieces : kPieces) {
        const PieceSize size = size_of(pieces, options);
        double places = 0.0;
        for (int y = 0; y + size.height() <= source.height; y += kStride)
            for (int x = 0; x + size.width() <= source.width; x += kStride)
                if (barred.of(x, y, size.width(), size.height()) < 0.5) places += kStride * kStride;
        const double room = pieces == kPieces.back() ? kLeastRoom : kRoom;
        if (places >= room * size.width() * size.height()) return pieces;
    }
    return {};
}

Image quilt(const Image& source, const std::vector<float>& fault, int pieces, const QuiltOptions& options,
            const Progress* progress) {
    return Quilt(source, fault, pieces, options).make(progress);
}

}  // namespace treerec
