#include "photos/leaf_colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "error.h"
#include "file_bytes.h"
#include "geometry/parallel.h"
#include "geometry/portable_math.h"
#include "geometry/quantile.h"
#include "photos/depth_picture.h"
#include "photos/even_exposures.h"
#include "photos/photo_picture.h"
#include "photos/sky_mask.h"
#include "textures/linear_light.h"

namespace treerec {

namespace {

constexpr int kDepthEdge = 480;       // pixels of the depth pictures
constexpr double kBall = 0.6;         // a point's radius in them, over the points' spacing
constexpr double kBehind = 2.5;       // in spacings: what is that far before a point hides it
constexpr int kSkyEdge = 1600;        // pixels that the sky is looked for in
constexpr int kWindow = 1;            // pixels around a point that its colour is the mean of
constexpr int kBleached = 250;        // levels: more is no colour any more
constexpr double kDarkest = 0.002;    // linear light that counts as black
constexpr size_t kMostGlimpses = 12;  // photos that each point is looked for in, the nearest
constexpr size_t kBands = 5;
constexpr size_t kLeastInBand = 2 * kBands;  // of the least points, one over this
constexpr double kEnds = 0.02;               // share of the points above and below the bands
constexpr double kKeptTone = 0.5;            // of the luminance's course over height
constexpr double kMostTone = 0.25;           // in natural logarithms, from one end to the other
constexpr double kMostHue = 0.35;            // likewise, of each channel beside the luminance
constexpr size_t kPoints = 256;              // that a thread takes at a time

// What a photo shows of a point: logarithms of linear light.
struct Look {
    size_t photo = 0;
    double far = 0.0;  // metres
    DVec3 light{0.0};
};

DVec3 exp_of(const DVec3& v) {
    return {portable::exp(v.x), portable::exp(v.y), portable::exp(v.z)};
}

DVec3 log_of(const DVec3& v) {
    return {portable::log(v.x), portable::log(v.y), portable::log(v.z)};
}

// The mean of the pixels around a place, as linear light; nothing where they are the picture's border or
// bleached.
std::optional<DVec3> light_at(const Image& picture, const DVec2& place) {
    const int cx = static_cast<int>(std::floor(place.x)), cy = static_cast<int>(std::floor(place.y));
    if (cx < kWindow || cy < kWindow || cx + kWindow >= picture.width || cy + kWindow >= picture.height)
        return {};
    DVec3 sum(0.0);
    for (int y = cy - kWindow; y <= cy + kWindow; y++)
        for (int x = cx - kWindow; x <= cx + kWindow; x++) {
            const uint8_t* pixel = picture.at(x, y);
            if (std::max({pixel[0], pixel[1], pixel[2]}) >= kBleached) return {};
            sum += linear_of(pixel);
        }
    return sum / ((2.0 * kWindow + 1.0) * (2.0 * kWindow + 1.0));
}

// Whether the photo shows the sky at a pixel of the camera's or beside it.
bool at_the_sky(const PhotoSky& sky, const DVec2& at) {
    if (sky.mask.empty()) return false;
    const int cx = static_cast<int>(std::floor(at.x * sky.scale)),
              cy = static_cast<int>(std::floor(at.y * sky.scale));
    for (int y = cy - 1; y <= cy + 1; y++)
        for (int x = cx - 1; x <= cx + 1; x++)
            if (x >= 0 && y >= 0 && x < sky.width && y < sky.height &&
                sky.mask[static_cast<size_t>(y) * static_cast<size_t>(sky.width) + static_cast<size_t>(x)])
                return true;
    return false;
}

// Adds what one photo shows of the leaves.
void look(size_t p, const std::vector<DVec3>& leaves, const ScanFrame& frame, const PhotoModel& model,
          const std::string& folder, const SeenThings& things, std::vector<std::vector<Look>>& looks) {
    const Photo& photo = model.photos[p];
    const Camera& camera = model.cameras[static_cast<size_t>(photo.camera)];
    Image picture;
    PinholeView whole;
    try {
        whole = pinhole_view(photo, camera, frame);
        picture = read_photo(utf8_of(path_of(folder) / path_of(photo.name)));
    } catch (const Error&) {
        return;  // a lens without a middle, or a damaged file: that was said when the cloud was made
    }
    const double scale = static_cast<double>(picture.width) / camera.width;
    const int times = (std::max(picture.width, picture.height) + kSkyEdge - 1) / kSkyEdge;
    const PhotoSky sky = sky_in({&photo, &camera, reduced(picture, times), scale / times},
                                frame.turn_to_scan({0.0, 1.0, 0.0}), 1);
    DepthPicture depth(fitted(whole, kDepthEdge));
    for (const DVec3& place : things.places)
        depth.put(place, kBall * things.spacing, 0.7);
    const double to_depth = depth.view().focal / whole.focal;
    const DVec3 ahead = -whole.turn[2];
    parallel_for(leaves.size(), kPoints, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++) {
            const double far = glm::dot(ahead, leaves[i] - whole.centre);
            const auto straight = whole.project(leaves[i]);
            const auto at = camera.project(photo.to_camera(frame.to_scan(leaves[i])));
            if (!straight || !at || !(far > 0.0)) continue;
            if (!(at->x >= 0.0 && at->y >= 0.0 && at->x < camera.width && at->y < camera.height)) continue;
            if (depth.hides(*straight * to_depth, 0.0, far - kBehind * things.spacing)) continue;
            if (at_the_sky(sky, *at)) continue;
            const auto light = light_at(picture, *at * scale);
            if (!light) continue;
            std::vector<Look>& known = looks[i];
            auto place = known.begin();
            while (place != known.end() && place->far <= far)
                ++place;
            known.insert(place, {p, far, log_of(glm::max(*light, DVec3(kDarkest)))});
            if (known.size() > kMostGlimpses) known.pop_back();
        }
    });
}

std::vector<DVec3> even_gains(const std::vector<std::vector<Look>>& looks, size_t photos) {
    ExposureOverlaps overlaps;
    for (const std::vector<Look>& known : looks)
        for (size_t a = 0; a < known.size(); a++)
            for (size_t b = 0; b < known.size(); b++)
                if (a != b) overlaps.add(known[a].photo, known[b].photo, known[a].light - known[b].light);
    std::vector<DVec3> gains = overlaps.gains(photos);
    // The exposures' mean over the photos that show leaves stays.
    std::vector<uint8_t> used(photos, 0);
    for (const std::vector<Look>& known : looks)
        for (const Look& one : known)
            used[one.photo] = 1;
    DVec3 mean(0.0);
    double count = 0.0;
    for (size_t p = 0; p < photos; p++)
        if (used[p]) mean += gains[p], count += 1.0;
    for (DVec3& gain : gains)
        gain -= mean / std::max(count, 1.0);
    return gains;
}

// A leaf point's colour, as the photos agree on it.
struct SeenLeaf {
    double height = 0.0;  // metres
    DVec3 colour{0.0};    // linear light
    double luminance = 0.0;
};

std::vector<SeenLeaf> seen_leaves(const std::vector<DVec3>& leaves,
                                  const std::vector<std::vector<Look>>& looks,
                                  const std::vector<DVec3>& gains) {
    std::vector<SeenLeaf> seen;
    std::vector<double> values;
    for (size_t i = 0; i < leaves.size(); i++) {
        if (looks[i].empty()) continue;
        DVec3 middle(0.0);
        for (int c = 0; c < 3; c++) {
            values.clear();
            for (const Look& one : looks[i])
                values.push_back(one.light[c] + gains[one.photo][c]);
            middle[c] = quantile(values, 0.5);
        }
        const DVec3 colour = exp_of(middle);
        seen.push_back({leaves[i].y, colour, luminance_of(colour)});
    }
    return seen;
}

DVec3 mean_colour(const std::vector<SeenLeaf>& leaves) {
    DVec3 sum(0.0);
    for (const SeenLeaf& leaf : leaves)
        sum += leaf.colour;
    return sum / static_cast<double>(leaves.size());
}

// Those that the light falls on. leaves: not empty.
std::vector<SeenLeaf> lit(const std::vector<SeenLeaf>& leaves, const LeafColourOptions& options) {
    std::vector<double> values;
    for (const SeenLeaf& leaf : leaves)
        values.push_back(leaf.luminance);
    const double least = quantile(values, options.shade_share),
                 most = quantile(values, 1.0 - options.gloss_share);
    std::vector<SeenLeaf> kept;
    for (const SeenLeaf& leaf : leaves)
        if (leaf.luminance >= least && leaf.luminance <= most) kept.push_back(leaf);
    return kept;
}

// Excess green (2 g - r - b) / (r + g + b) (Woebbecke et al. 1995).
double green_of(const DVec3& colour) {
    return (2.0 * colour.y - colour.x - colour.z) / (colour.x + colour.y + colour.z);
}

void find_hues(std::vector<SeenLeaf> leaves, LeafColours& found) {
    std::stable_sort(leaves.begin(), leaves.end(), [](const SeenLeaf& a, const SeenLeaf& b) {
        return green_of(a.colour) < green_of(b.colour);
    });
    const size_t third = std::max<size_t>(1, leaves.size() / 3);
    const double luminance = luminance_of(found.albedo);
    const auto as_light = [&](const DVec3& colour) { return colour * (luminance / luminance_of(colour)); };
    found.least_green =
        as_light(mean_colour({leaves.begin(), leaves.begin() + static_cast<std::ptrdiff_t>(third)}));
    found.greenest = as_light(mean_colour({leaves.end() - static_cast<std::ptrdiff_t>(third), leaves.end()}));
}

// The lit leaves of each height: those of a band that has too few go to the one below.
std::vector<LeafBand> bands_of(const std::vector<SeenLeaf>& seen, const LeafColourOptions& options,
                               std::vector<SeenLeaf>& all_lit, double& spread) {
    std::vector<double> heights;
    for (const SeenLeaf& leaf : seen)
        heights.push_back(leaf.height);
    const double low = quantile(heights, kEnds), high = quantile(heights, 1.0 - kEnds);
    std::array<std::vector<SeenLeaf>, kBands> parts;
    for (const SeenLeaf& leaf : seen) {
        const double share = high > low ? (leaf.height - low) / (high - low) : 0.0;
        parts[static_cast<size_t>(std::clamp(share, 0.0, 0.999) * kBands)].push_back(leaf);
    }
    std::vector<LeafBand> bands;
    double squares = 0.0, count = 0.0;
    for (size_t k = 0; k < kBands; k++) {
        if (parts[k].size() < std::max<size_t>(1, options.least_points / kLeastInBand)) continue;
        const std::vector<SeenLeaf> light = lit(parts[k], options);
        const double edge = (high - low) / kBands;
        bands.push_back({low + edge * static_cast<double>(k), low + edge * static_cast<double>(k + 1),
                         mean_colour(light), light.size()});
        const double middle = portable::log(luminance_of(bands.back().colour));
        for (const SeenLeaf& leaf : light) {
            const double off = portable::log(leaf.luminance) - middle;
            squares += off * off;
            count += 1.0;
        }
        all_lit.insert(all_lit.end(), light.begin(), light.end());
    }
    spread = count > 0.0 ? std::sqrt(squares / count) : 0.0;
    return bands;
}

// Each with a part of its neighbours.
void smooth(std::vector<LeafBand>& bands) {
    const std::vector<LeafBand> before = bands;
    for (size_t k = 0; k < bands.size(); k++) {
        DVec3 sum = 2.0 * static_cast<double>(before[k].points) * before[k].colour;
        double weight = 2.0 * static_cast<double>(before[k].points);
        for (const size_t j : {k - 1, k + 1})
            if (j < before.size()) {
                sum += static_cast<double>(before[j].points) * before[j].colour;
                weight += static_cast<double>(before[j].points);
            }
        bands[k].colour = sum / weight;
    }
}

// The straight line through the bands' logarithms.
void find_course(LeafColours& found) {
    const std::vector<LeafBand>& bands = found.bands;
    found.low_height = bands.front().low;
    found.high_height = bands.back().high;
    if (bands.size() < 2) return;
    double weights = 0.0, height = 0.0;
    DVec3 level(0.0);
    const auto middle = [](const LeafBand& band) { return 0.5 * (band.low + band.high); };
    for (const LeafBand& band : bands) {
        const double weight = static_cast<double>(band.points);
        weights += weight;
        height += weight * middle(band);
        level += weight * log_of(band.colour);
    }
    height /= weights;
    level /= weights;
    double squares = 0.0;
    DVec3 products(0.0);
    for (const LeafBand& band : bands) {
        const double off = middle(band) - height, weight = static_cast<double>(band.points);
        squares += weight * off * off;
        products += weight * off * (log_of(band.colour) - level);
    }
    const DVec3 rise = products / squares * (found.high_height - found.low_height);
    // Of the luminance, as colours near the mean have it.
    const DVec3 share = kLuminance * found.albedo / luminance_of(found.albedo);
    const double tone = glm::dot(share, rise);
    const DVec3 hue = glm::clamp(rise - tone, -kMostHue, kMostHue);
    const DVec3 kept = hue + std::clamp(kKeptTone * tone, -kMostTone, kMostTone);
    const double from = (height - found.low_height) / (found.high_height - found.low_height);
    found.low = exp_of(-from * kept);
    found.high = exp_of((1.0 - from) * kept);
}

}  // namespace

LeafColours leaf_colours_of_photos(const std::vector<DVec3>& leaves, const ScanFrame& frame,
                                   const PhotoModel& model, const std::string& folder,
                                   const SeenThings& things, const LeafColourOptions& options,
                                   Progress* progress) {
    LeafColours found;
    const size_t step = (leaves.size() + options.most_points - 1) / options.most_points;
    std::vector<DVec3> chosen;
    for (size_t i = 0; i < leaves.size(); i += std::max<size_t>(1, step))
        chosen.push_back(leaves[i]);
    if (chosen.empty()) {
        found.why_not = "No leaves were found in the photos.";
        return found;
    }
    if (chosen.size() < options.least_points) {
        found.why_not = "The photos show too few leaves: " + std::to_string(chosen.size()) +
                        " points of them, and colors need " + std::to_string(options.least_points) + ".";
        return found;
    }
    std::vector<std::vector<Look>> looks(chosen.size());
    for (size_t p = 0; p < model.photos.size(); p++) {
        if (progress) {
            progress->check();
            progress->update(static_cast<double>(p) / static_cast<double>(model.photos.size()),
                             "Leaf colors");
            progress->count(p, model.photos.size());
        }
        look(p, chosen, frame, model, folder, things, looks);
    }
    std::vector<uint8_t> used(model.photos.size(), 0);
    for (const std::vector<Look>& known : looks)
        for (const Look& one : known)
            used[one.photo] = 1;
    found.photos = static_cast<size_t>(std::count(used.begin(), used.end(), 1));
    const std::vector<SeenLeaf> seen = seen_leaves(chosen, looks, even_gains(looks, model.photos.size()));
    found.points = seen.size();
    if (seen.size() < options.least_points || found.photos < options.least_photos) {
        found.why_not = "The photos show too few leaves: " + std::to_string(seen.size()) +
                        " points of them in " + std::to_string(found.photos) + " photos, and colors need " +
                        std::to_string(options.least_points) + " in " + std::to_string(options.least_photos) +
                        ".";
        return found;
    }
    std::vector<SeenLeaf> all_lit;
    found.bands = bands_of(seen, options, all_lit, found.tone_spread);
    found.as_seen = mean_colour(all_lit);
    const double luminance = luminance_of(found.as_seen);
    const double factor = std::clamp(luminance, options.darkest, options.lightest) / luminance;
    found.albedo = factor * found.as_seen;
    for (LeafBand& band : found.bands)
        band.colour *= factor;
    find_hues(all_lit, found);
    smooth(found.bands);
    find_course(found);
    return found;
}

}  // namespace treerec
