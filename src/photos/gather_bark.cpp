#include <algorithm>
#include <array>
#include <cmath>

#include "error.h"
#include "file_bytes.h"
#include "geometry/parallel.h"
#include "geometry/portable_math.h"
#include "geometry/quantile.h"
#include "photos/even_exposures.h"
#include "photos/photo_picture.h"
#include "photos/seen_bark.h"

namespace treerec {

namespace {

constexpr size_t kSlots = 5;         // photos that are kept of each cell, to compare them
constexpr double kSharp = 0.15;      // see sharpness()
constexpr int kLargestBlur = 8;      // pixels
constexpr double kUnlike = 0.12;     // in natural logarithms: how far photos of one place may differ
constexpr double kUnlikeCost = 6.0;  // for each such step more
constexpr double kSeamCost = 0.2;    // against a neighbour's photo, as a logarithm of the score
constexpr int kSweeps = 8;
constexpr size_t kCells = 8;  // that a thread takes at a time

struct Slot {
    size_t photo = SIZE_MAX;
    double score = 0.0;
    double pixel = 0.0;   // metres
    double detail = 0.0;  // metres
    DVec3 light{0.0};     // the mean of the logarithms of the cell's colours
};

using Slots = std::array<Slot, kSlots>;

struct Patchwork {
    const TrunkChart& chart;
    const BarkSurvey& survey;
    DVec2 texel;
    int width, height;
    std::vector<Slots> slots;        // by cell
    std::array<Image, kSlots> kept;  // colours by slot
    std::vector<int8_t> chosen;      // slot by cell, or -1

    int cell_at(int x, int y) const {
        const int column = std::min(static_cast<int>((x + 0.5) * texel.x / survey.cell), survey.columns - 1);
        const int row = std::min(static_cast<int>((y + 0.5) * texel.y / survey.cell), survey.rows - 1);
        return row * survey.columns + column;
    }
    std::optional<TrunkChart::Spot> spot_at(int x, int y) const {
        return chart.at((x + 0.5) * texel.x - 0.5 * chart.width(), chart.length() - (y + 0.5) * texel.y);
    }
    // The cell's texels: [first, last) of columns and rows.
    std::array<int, 4> texels_of(size_t cell) const {
        const int column = static_cast<int>(cell) % survey.columns,
                  row = static_cast<int>(cell) / survey.columns;
        const auto first = [&](int i, double size) {
            return std::max(0, static_cast<int>(std::ceil(i * survey.cell / size - 0.5)));
        };
        return {first(column, texel.x), std::min(width, first(column + 1, texel.x)), first(row, texel.y),
                std::min(height, first(row + 1, texel.y))};
    }
};

// How much neighbouring pixels differ, over how much pixels four apart do, both squared: 1/16 where all is
// smooth, 1/4 where differences grow as the root of the distance, as on rough bark in focus.
double sharpness(const Image& picture, const std::vector<DVec2>& places) {
    constexpr int kReach = 6, kFar = 4;
    double near = 0.0, far = 0.0;
    for (const DVec2& place : places) {
        const int cx = static_cast<int>(place.x), cy = static_cast<int>(place.y);
        if (cx < kReach || cy < kReach || cx + kReach + kFar >= picture.width ||
            cy + kReach + kFar >= picture.height)
            continue;
        for (int y = cy - kReach; y < cy + kReach; y += 2)
            for (int x = cx - kReach; x < cx + kReach; x += 2) {
                const int here = picture.at(x, y)[1];
                const auto square = [&](int u, int v) {
                    const double d = picture.at(x + u, y + v)[1] - here;
                    return d * d;
                };
                near += square(1, 0) + square(0, 1);
                far += square(kFar, 0) + square(0, kFar);
            }
    }
    return far > 0.0 ? near / far : 0.0;
}

// By what a photo's pixels would have to be larger for it to be sharp.
int blur_of(const Image& picture, const std::vector<DVec2>& places) {
    for (int blur = 1; blur < kLargestBlur; blur *= 2) {
        const Image smaller = reduced(picture, blur);
        std::vector<DVec2> there;
        for (const DVec2& place : places)
            there.push_back(place / static_cast<double>(blur));
        if (sharpness(smaller, there) >= kSharp) return blur;
    }
    return kLargestBlur;
}

// Puts what a photo shows into the cells that it shows better than others do.
void take_photo(size_t p, const Photo& photo, const Camera& camera, const ScanFrame& frame,
                const std::string& folder, const std::vector<std::vector<std::pair<size_t, Glimpse>>>& wanted,
                Patchwork& work) {
    Image picture;
    try {
        picture = read_photo(utf8_of(path_of(folder) / path_of(photo.name)));
    } catch (const Error&) {
        return;  // that it can't be read was said when the cloud was made
    }
    double scale = static_cast<double>(picture.width) / camera.width;
    std::vector<double> pixels;
    for (const auto& [cell, glimpse] : wanted[p])
        pixels.push_back(glimpse.pixel / scale);
    const int times = std::max(1, static_cast<int>(work.texel.x / quantile(pixels, 0.5)));
    picture = reduced(picture, times);
    scale /= times;
    const auto pixel_at = [&](const DVec3& place) -> std::optional<DVec2> {
        const auto at = camera.project(photo.to_camera(frame.to_scan(place)));
        if (!at) return {};
        return *at * scale - 0.5;
    };
    std::vector<DVec2> places;
    for (const auto& [cell, glimpse] : wanted[p]) {
        const std::array<int, 4> texels = work.texels_of(cell);
        const auto spot = work.spot_at((texels[0] + texels[1]) / 2, (texels[2] + texels[3]) / 2);
        const auto at = spot ? pixel_at(spot->place) : std::nullopt;
        if (at) places.push_back(*at);
    }
    const int blur = blur_of(picture, places);
    std::array<double, 256> logarithms{};
    for (int i = 0; i < 256; i++)
        logarithms[static_cast<size_t>(i)] = portable::log((i + 1.0) / 256.0);
    parallel_for(wanted[p].size(), kCells, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++) {
            const auto& [cell, glimpse] = wanted[p][i];
            const double detail = glimpse.pixel / scale * blur;
            // Finer than the texels is as good as they are.
            const double score = glimpse.score * glimpse.pixel / std::max(detail, work.texel.x);
            Slots& slots = work.slots[cell];
            size_t worst = 0;
            for (size_t k = 1; k < kSlots; k++)
                if (slots[k].score < slots[worst].score) worst = k;
            if (slots[worst].score >= score) continue;
            const std::array<int, 4> texels = work.texels_of(cell);
            Image& kept = work.kept[worst];
            DVec3 light(0.0);
            size_t count = 0;
            for (int y = texels[2]; y < texels[3]; y++)
                for (int x = texels[0]; x < texels[1]; x++) {
                    const auto spot = work.spot_at(x, y);
                    const auto at = spot ? pixel_at(spot->place) : std::nullopt;
                    if (!at) continue;
                    const DVec2 inside =
                        glm::clamp(*at, DVec2(0.0), DVec2(picture.width - 1.0, picture.height - 1.0));
                    for (int c = 0; c < 3; c++) {
                        const auto level =
                            static_cast<uint8_t>(std::lround(level_between(picture, inside.x, inside.y, c)));
                        kept.at(x, y)[c] = level;
                        light[c] += logarithms[level];
                    }
                    count++;
                }
            if (count > 0)
                slots[worst] = {p, score, glimpse.pixel / (scale * times), detail,
                                light / static_cast<double>(count)};
        }
    });
}

std::vector<DVec3> gains_of(const Patchwork& work, size_t photos) {
    ExposureOverlaps overlaps;
    for (const Slots& slots : work.slots)
        for (size_t a = 0; a < kSlots; a++)
            for (size_t b = 0; b < kSlots; b++)
                if (a != b && slots[a].photo != SIZE_MAX && slots[b].photo != SIZE_MAX)
                    overlaps.add(slots[a].photo, slots[b].photo, slots[a].light - slots[b].light);
    return overlaps.gains(photos);
}

// The slot of each cell: iterated conditional modes (Besag 1986) over what speaks against each.
void choose(const std::vector<DVec3>& gains, Patchwork& work) {
    const size_t cells = work.slots.size();
    std::vector<std::array<double, kSlots>> costs(cells);
    work.chosen.assign(cells, -1);
    for (size_t i = 0; i < cells; i++) {
        const Slots& slots = work.slots[i];
        std::vector<DVec3> lights;
        double best = 0.0;
        for (const Slot& slot : slots)
            if (slot.photo != SIZE_MAX) {
                lights.push_back(slot.light + gains[slot.photo]);
                best = std::max(best, slot.score);
            }
        if (lights.empty()) continue;
        DVec3 middle(0.0);
        for (int c = 0; c < 3; c++) {
            std::vector<double> values;
            for (const DVec3& light : lights)
                values.push_back(light[c]);
            middle[c] = quantile(values, 0.5);
        }
        double least = 0.0;
        for (size_t k = 0; k < kSlots; k++) {
            const Slot& slot = slots[k];
            if (slot.photo == SIZE_MAX) continue;
            const DVec3 off = glm::abs(slot.light + gains[slot.photo] - middle);
            const double unlike = std::max({off.x, off.y, off.z}) - kUnlike;
            costs[i][k] = portable::log(best / slot.score) + kUnlikeCost * std::max(0.0, unlike) / kUnlike;
            if (work.chosen[i] < 0 || costs[i][k] < least) {
                least = costs[i][k];
                work.chosen[i] = static_cast<int8_t>(k);
            }
        }
    }
    const int columns = work.survey.columns, rows = work.survey.rows;
    for (int sweep = 0; sweep < kSweeps; sweep++)
        for (int y = 0; y < rows; y++)
            for (int x = 0; x < columns; x++) {
                const size_t i = static_cast<size_t>(y * columns + x);
                if (work.chosen[i] < 0) continue;
                double least = 0.0;
                int best = -1;
                for (size_t k = 0; k < kSlots; k++) {
                    const size_t photo = work.slots[i][k].photo;
                    if (photo == SIZE_MAX) continue;
                    double cost = costs[i][k];
                    const int beside[][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
                    for (const auto& step : beside) {
                        const int u = x + step[0], v = y + step[1];
                        if (u < 0 || v < 0 || u >= columns || v >= rows) continue;
                        const size_t j = static_cast<size_t>(v * columns + u);
                        if (work.chosen[j] >= 0 &&
                            work.slots[j][static_cast<size_t>(work.chosen[j])].photo != photo)
                            cost += kSeamCost;
                    }
                    if (best < 0 || cost < least) {
                        least = cost;
                        best = static_cast<int>(k);
                    }
                }
                work.chosen[i] = static_cast<int8_t>(best);
            }
}

// Fades over from photo to photo within about a third of a cell.
void blend(const std::vector<DVec3>& gains, const Patchwork& work, SeenBark& bark) {
    std::vector<DVec3> factors;
    for (const DVec3& gain : gains)
        factors.push_back({portable::exp(gain.x), portable::exp(gain.y), portable::exp(gain.z)});
    const int columns = work.survey.columns, rows = work.survey.rows;
    parallel_for(static_cast<size_t>(work.height), 8, [&](size_t begin, size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); y++)
            for (int x = 0; x < work.width; x++) {
                const size_t own = static_cast<size_t>(work.cell_at(x, y));
                if (work.chosen[own] < 0 || !work.spot_at(x, y)) continue;
                const double u = (x + 0.5) * work.texel.x / work.survey.cell - 0.5;
                const double v = (y + 0.5) * work.texel.y / work.survey.cell - 0.5;
                const int left = static_cast<int>(std::floor(u)), top = static_cast<int>(std::floor(v));
                DVec3 sum(0.0);
                double weights = 0.0;
                for (int k = 0; k < 4; k++) {
                    const int column = left + k % 2, row = top + k / 2;
                    if (column < 0 || row < 0 || column >= columns || row >= rows) continue;
                    const size_t cell = static_cast<size_t>(row * columns + column);
                    if (work.chosen[cell] < 0) continue;
                    const size_t photo = work.slots[cell][static_cast<size_t>(work.chosen[cell])].photo;
                    double weight = (1.0 - std::abs(u - column)) * (1.0 - std::abs(v - row));
                    weight *= weight * weight;
                    for (size_t slot = 0; slot < kSlots; slot++) {
                        if (work.slots[own][slot].photo != photo) continue;
                        const uint8_t* colour = work.kept[slot].at(x, y);
                        sum += weight * factors[photo] * DVec3(colour[0], colour[1], colour[2]);
                        weights += weight;
                    }
                }
                if (!(weights > 0.0)) continue;
                for (int c = 0; c < 3; c++)
                    bark.colours.at(x, y)[c] =
                        static_cast<uint8_t>(std::clamp(std::lround(sum[c] / weights), 0L, 255L));
                bark.seen[static_cast<size_t>(y) * static_cast<size_t>(work.width) + static_cast<size_t>(x)] =
                    1;
            }
    });
}

}  // namespace

SeenBark gather_bark(const TrunkChart& chart, const BarkSurvey& survey, const DVec2& texel,
                     const ScanFrame& frame, const PhotoModel& model, const std::string& folder,
                     Progress* progress) {
    SeenBark bark;
    Patchwork work{chart,
                   survey,
                   texel,
                   static_cast<int>(chart.width() / texel.x),
                   static_cast<int>(chart.length() / texel.y),
                   std::vector<Slots>(survey.glimpses.size()),
                   {},
                   {}};
    if (work.width < 1 || work.height < 1) return bark;
    bark.colours = Image(work.width, work.height, 3);
    bark.seen.assign(static_cast<size_t>(work.width) * static_cast<size_t>(work.height), 0);
    for (Image& kept : work.kept)
        kept = Image(work.width, work.height, 3);
    std::vector<std::vector<std::pair<size_t, Glimpse>>> wanted(model.photos.size());
    for (size_t cell = 0; cell < survey.glimpses.size(); cell++)
        for (const Glimpse& glimpse : survey.glimpses[cell])
            wanted[glimpse.photo].push_back({cell, glimpse});
    for (size_t p = 0; p < model.photos.size(); p++) {
        if (progress) {
            progress->check();
            progress->update(static_cast<double>(p) / static_cast<double>(model.photos.size()), "Bark");
            progress->count(p, model.photos.size());
        }
        if (wanted[p].empty()) continue;
        const Photo& photo = model.photos[p];
        take_photo(p, photo, model.cameras[static_cast<size_t>(photo.camera)], frame, folder, wanted, work);
    }
    const std::vector<DVec3> gains = gains_of(work, model.photos.size());
    choose(gains, work);
    blend(gains, work, bark);
    std::vector<double> pixels, details;
    std::vector<uint8_t> used(model.photos.size(), 0);
    for (size_t i = 0; i < work.slots.size(); i++) {
        if (work.chosen[i] < 0) continue;
        const Slot& slot = work.slots[i][static_cast<size_t>(work.chosen[i])];
        pixels.push_back(slot.pixel);
        details.push_back(slot.detail);
        used[slot.photo] = 1;
    }
    bark.photos = static_cast<size_t>(std::count(used.begin(), used.end(), 1));
    if (!pixels.empty()) {
        bark.pixel = quantile(pixels, 0.5);
        bark.detail = quantile(details, 0.5);
    }
    bark.area = static_cast<double>(std::count(bark.seen.begin(), bark.seen.end(), 1)) * texel.x * texel.y;
    return bark;
}

}  // namespace treerec
