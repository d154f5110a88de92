#include "photos/find_markers.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "geometry/quantile.h"
#include "photos/marker_code.h"
#include "photos/marker_outlines.h"
#include "photos/photo_picture.h"

namespace treerec {

namespace {

constexpr double kLeastContrast = 18.0;  // grey levels between black and white
constexpr int kMostWrongBorder = 1;      // cells of the black border that are not, of 20
constexpr int kRounds = 4;               // of fitting the edges
// How far a cell is from its kind's mean, by the contrast: of 36 cells the root of the mean square. Leaves
// and grain that happen to have a marker's code have .2 and more, a marker that is just large and sharp
// enough .19, and with a wrong cell .16.
constexpr double kMostUneven = 0.19, kMostUnevenMended = 0.16;

// From the unit square to the outline (P. Heckbert, "Fundamentals of texture mapping and image warping",
// 1989, 2.2.3).
DMat3 square_to(const Outline& q) {
    const DVec2 d1 = q[1] - q[2], d2 = q[3] - q[2], s = q[0] - q[1] + q[2] - q[3];
    const double under = d1.x * d2.y - d2.x * d1.y;
    const double g = (s.x * d2.y - d2.x * s.y) / under, h = (d1.x * s.y - s.x * d1.y) / under;
    const DVec2 u = q[1] - q[0] + g * q[1], v = q[3] - q[0] + h * q[3];
    return {DVec3(u, g), DVec3(v, h), DVec3(q[0], 1.0)};
}

DVec2 through(const DMat3& matrix, double u, double v) {
    const DVec3 p = matrix * DVec3(u, v, 1.0);
    return DVec2(p) / p.z;
}

// The grey level at a place, in pixels from the corner of the first one; the border's beyond it.
double level_at(const GreyPicture& picture, const DVec2& place) {
    const double x = std::clamp(place.x - 0.5, 0.0, picture.width - 1.01);
    const double y = std::clamp(place.y - 0.5, 0.0, picture.height - 1.01);
    return static_cast<double>(picture.at(static_cast<float>(x), static_cast<float>(y)));
}

struct EdgeLine {
    DVec2 middle{0.0};
    DVec2 way{0.0};
    double step = 0.0;  // grey levels that it becomes lighter outward, the median
};

// The line along the places where it becomes lighter outward, within `reach` pixels of the edge from a to b.
std::optional<EdgeLine> fit_edge(const GreyPicture& picture, const DVec2& a, const DVec2& b, double reach) {
    constexpr double kCorner = 0.12;  // of the edge at each end, where the other edge is near
    constexpr double kStep = 0.25;    // pixels
    constexpr int kMostSamples = 96;
    const double length = glm::distance(a, b);
    const DVec2 way = (b - a) / length, out(way.y, -way.x);
    const int count = std::clamp(static_cast<int>(length * (1.0 - 2.0 * kCorner)), 6, kMostSamples);
    const int steps = static_cast<int>(std::ceil(reach / kStep));
    struct Place {
        double along, off, weight;
    };
    std::vector<Place> places;
    std::vector<double> rises;
    for (int i = 0; i < count; i++) {
        const double along = length * (kCorner + (1.0 - 2.0 * kCorner) * (i + 0.5) / count);
        const DVec2 on = a + along * way;
        double sum = 0.0, moment = 0.0, rise = 0.0;
        double before = level_at(picture, on - out * (kStep * (steps + 0.5)));
        for (int k = -steps; k <= steps; k++) {
            const double after = level_at(picture, on + out * (kStep * (k + 0.5)));
            const double up = after - before;
            before = after;
            rise += up;
            if (up > 0.0) {
                sum += up;
                moment += up * kStep * k;
            }
        }
        rises.push_back(rise);
        if (rise > 0.25 * kLeastContrast) places.push_back({along, moment / sum, rise});
    }
    if (places.size() * 2 < static_cast<size_t>(count) || places.size() < 4) return {};
    EdgeLine line;
    line.step = quantile(rises, 0.5);
    double offset = 0.0, slope = 0.0;
    for (int round = 0; round < 3; round++) {
        double w = 0.0, s = 0.0, ss = 0.0, o = 0.0, so = 0.0;
        for (const Place& place : places) {
            const double x = place.along - 0.5 * length;
            w += place.weight;
            s += place.weight * x;
            ss += place.weight * x * x;
            o += place.weight * place.off;
            so += place.weight * x * place.off;
        }
        const double under = w * ss - s * s;
        if (!(under > 1e-9 * w * w)) return {};
        slope = (w * so - s * o) / under;
        offset = (o - slope * s) / w;
        // What lies before the edge, and cells of the code that are seen through a narrow border.
        std::vector<double> offs;
        for (const Place& place : places)
            offs.push_back(std::abs(place.off - offset - slope * (place.along - 0.5 * length)));
        const double most = std::max(0.1, 3.0 * quantile(offs, 0.5));
        std::erase_if(places, [&](const Place& place) {
            return std::abs(place.off - offset - slope * (place.along - 0.5 * length)) > most;
        });
        if (places.size() < 4) return {};
    }
    line.middle = a + 0.5 * length * way + offset * out;
    line.way = way + slope * out;
    return line;
}

struct Edges {
    Outline outline{};
    double step = 0.0;  // the weakest edge's
};

// The same outline with its edges where the picture has them.
std::optional<Edges> refine(const GreyPicture& picture, const Outline& rough, double uncertain) {
    Edges edges{rough, 0.0};
    for (int round = 0; round < kRounds; round++) {
        std::array<EdgeLine, 4> lines;
        edges.step = INFINITY;
        for (size_t k = 0; k < 4; k++) {
            const DVec2 &a = edges.outline[k], &b = edges.outline[(k + 1) % 4];
            const DVec2 &c = edges.outline[(k + 2) % 4], &d = edges.outline[(k + 3) % 4];
            const double length = glm::distance(a, b);
            if (!(length > 3.0)) return {};
            const DVec2 way = (b - a) / length, in(-way.y, way.x);
            const double cell = 0.5 * (glm::dot(c - a, in) + glm::dot(d - a, in)) / kMarkerCells;
            if (!(cell > 0.5)) return {};
            const double wanted = round == 0 ? uncertain : 4.0;
            const std::optional<EdgeLine> line =
                fit_edge(picture, a, b, std::clamp(wanted, 1.0, std::max(1.0, 0.6 * cell)));
            if (!line) return {};
            lines[k] = *line;
            edges.step = std::min(edges.step, line->step);
        }
        Outline next;
        for (size_t k = 0; k < 4; k++) {
            const EdgeLine &before = lines[(k + 3) % 4], &after = lines[k];
            if (!meet(before.middle, before.way, after.middle, after.way, next[k])) return {};
            if (!(glm::distance(next[k], rough[k]) < 2.0 * uncertain + 0.2 * mean_side(rough))) return {};
        }
        if (!is_convex(next)) return {};
        edges.outline = next;
    }
    return edges;
}

using Cells = std::array<std::array<double, kMarkerCells>, kMarkerCells>;

Cells read_cells(const GreyPicture& picture, const DMat3& square, double side) {
    constexpr double kPart = 0.5;  // of a cell, around its middle
    const int count = std::clamp(static_cast<int>(side / kMarkerCells * kPart), 2, 6);
    Cells cells{};
    for (int y = 0; y < kMarkerCells; y++)
        for (int x = 0; x < kMarkerCells; x++) {
            double sum = 0.0;
            for (int v = 0; v < count; v++)
                for (int u = 0; u < count; u++)
                    sum += level_at(
                        picture, through(square, (x + 0.5 + kPart * ((u + 0.5) / count - 0.5)) / kMarkerCells,
                                         (y + 0.5 + kPart * ((v + 0.5) / count - 0.5)) / kMarkerCells));
            cells[static_cast<size_t>(y)][static_cast<size_t>(x)] = sum / (count * count);
        }
    return cells;
}

// Between the two kinds of cells (N. Otsu, "A threshold selection method from gray-level histograms", 1979).
double threshold_of(const Cells& cells, double& contrast) {
    std::vector<double> levels;
    for (const auto& row : cells)
        levels.insert(levels.end(), row.begin(), row.end());
    std::sort(levels.begin(), levels.end());
    double all = 0.0, below = 0.0, best = -1.0, threshold = levels[0];
    for (const double level : levels)
        all += level;
    const double count = static_cast<double>(levels.size());
    contrast = 0.0;
    for (size_t i = 1; i < levels.size(); i++) {
        below += levels[i - 1];
        const double low = static_cast<double>(i), high = count - low;
        const double apart = (all - below) / high - below / low;
        if (low * high * apart * apart > best) {
            best = low * high * apart * apart;
            threshold = 0.5 * (levels[i - 1] + levels[i]);
            contrast = apart;
        }
    }
    return threshold;
}

// The code where the black border is one. step: how much lighter it is around it.
std::optional<ReadCode> read_code(const Cells& cells, double step) {
    double contrast = 0.0;
    const double threshold = threshold_of(cells, contrast);
    // The white around is as white as that of the code.
    if (contrast < kLeastContrast || step < 0.3 * contrast) return {};
    int wrong = 0;
    unsigned code = 0;
    std::array<double, 2> sums{}, squares{}, counts{};
    for (size_t y = 0; y < kMarkerCells; y++)
        for (size_t x = 0; x < kMarkerCells; x++) {
            const bool white = cells[y][x] > threshold;
            sums[white] += cells[y][x];
            squares[white] += cells[y][x] * cells[y][x];
            counts[white] += 1.0;
            const bool border = x == 0 || y == 0 || x == kMarkerCells - 1 || y == kMarkerCells - 1;
            if (border)
                wrong += white;
            else
                code = code << 1 | (white ? 1U : 0U);
        }
    if (wrong > kMostWrongBorder) return {};
    const std::optional<ReadCode> read = identify_marker(static_cast<uint16_t>(code));
    // One wrong cell is mended in an otherwise faultless marker alone: leaves look like anything.
    const int all_wrong = wrong + (read ? read->mended : 0);
    if (!read || all_wrong > 1) return {};
    double off = 0.0;
    for (const size_t kind : {0, 1})
        off += squares[kind] - sums[kind] * sums[kind] / counts[kind];
    const double uneven = std::sqrt(std::max(0.0, off) / (kMarkerCells * kMarkerCells)) / contrast;
    if (uneven > (all_wrong > 0 ? kMostUnevenMended : kMostUneven)) return {};
    return read;
}

// The light falls off evenly over a marker: the border's own levels tell how (a plane fitted to them).
Cells in_even_light(const Cells& cells) {
    constexpr double kMiddle = 0.5 * (kMarkerCells - 1);
    double sum = 0.0, across = 0.0, down = 0.0, square = 0.0, count = 0.0;
    for (size_t y = 0; y < kMarkerCells; y++)
        for (size_t x = 0; x < kMarkerCells; x++) {
            if (x != 0 && y != 0 && x != kMarkerCells - 1 && y != kMarkerCells - 1) continue;
            const double u = static_cast<double>(x) - kMiddle, v = static_cast<double>(y) - kMiddle;
            sum += cells[y][x];
            across += u * cells[y][x];
            down += v * cells[y][x];
            square += u * u;
            count += 1.0;
        }
    Cells even = cells;
    const double mean = std::max(1.0, sum / count);
    for (size_t y = 0; y < kMarkerCells; y++)
        for (size_t x = 0; x < kMarkerCells; x++) {
            const double light = mean + across / square * (static_cast<double>(x) - kMiddle) +
                                 down / square * (static_cast<double>(y) - kMiddle);
            even[y][x] *= mean / std::max(0.2 * mean, light);
        }
    return even;
}

std::optional<FoundMarker> read_marker(const GreyPicture& picture, const Outline& rough, double uncertain) {
    const std::optional<Edges> edges = refine(picture, rough, uncertain);
    if (!edges) return {};
    const Cells cells = read_cells(picture, square_to(edges->outline), mean_side(edges->outline));
    std::optional<ReadCode> code = read_code(cells, edges->step);
    if (!code) code = read_code(in_even_light(cells), edges->step);
    if (!code) return {};
    FoundMarker marker;
    marker.id = code->id;
    marker.mended = code->mended;
    for (size_t k = 0; k < 4; k++)
        marker.corners[k] = edges->outline[(k + static_cast<size_t>(code->turns)) % 4];
    return marker;
}

bool has_inside(const Outline& outline, const DVec2& place) {
    for (size_t k = 0; k < 4; k++) {
        const DVec2 edge = outline[(k + 1) % 4] - outline[k], to = place - outline[k];
        // The corners' order may start anywhere, and runs clockwise.
        if (edge.x * to.y - edge.y * to.x < 0.0) return false;
    }
    return true;
}

GreyPicture reduced_by(const GreyPicture& picture, int times) {
    Image whole(picture.width, picture.height, 1);
    whole.pixels = picture.pixels;
    Image small = reduced(whole, times);
    GreyPicture made;
    made.width = small.width;
    made.height = small.height;
    made.pixels = std::move(small.pixels);
    return made;
}

}  // namespace

double FoundMarker::mean_side() const {
    return treerec::mean_side(corners);
}

std::vector<FoundMarker> find_markers(const GreyPicture& picture, const MarkerOptions& options,
                                      const Progress* progress) {
    std::vector<FoundMarker> found, markers;
    if (picture.width < 3 || picture.height < 3) return markers;
    const double longer = std::max(picture.width, picture.height);
    const int times = std::max(1, static_cast<int>(std::lround(longer / std::max(64, options.most_pixels))));
    const std::vector<Outline> outlines =
        times == 1 ? dark_outlines(picture, options.least_side, progress)
                   : dark_outlines(reduced_by(picture, times), options.least_side, progress);
    for (Outline outline : outlines) {
        if (progress) progress->check();
        for (DVec2& corner : outline)
            corner *= times;
        const std::optional<FoundMarker> marker = read_marker(picture, outline, 1.5 * times + 0.5);
        if (!marker) continue;
        found.push_back(*marker);
    }
    // The largest first: cells of a marker may happen to look like another one, and the same one is found in
    // windows of several sizes.
    std::stable_sort(found.begin(), found.end(), [](const FoundMarker& a, const FoundMarker& b) {
        return a.mended != b.mended ? a.mended < b.mended : a.mean_side() > b.mean_side();
    });
    for (const FoundMarker& marker : found)
        if (std::none_of(markers.begin(), markers.end(), [&](const FoundMarker& other) {
                return has_inside(other.corners, marker.centre()) ||
                       has_inside(marker.corners, other.centre());
            }))
            markers.push_back(marker);
    std::stable_sort(markers.begin(), markers.end(), [](const FoundMarker& a, const FoundMarker& b) {
        return a.id != b.id ? a.id < b.id : a.centre().x < b.centre().x;
    });
    return markers;
}

}  // namespace treerec
