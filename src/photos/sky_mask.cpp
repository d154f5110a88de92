#include "photos/sky_mask.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <utility>

#include "geometry/parallel.h"
#include "geometry/quantile.h"
#include "photos/cameras_tell.h"
#include "photos/photo_picture.h"

namespace treerec {

namespace {

constexpr double kAbove = 0.03;       // sine of how far above the horizon sky is looked for
constexpr int kEven = 6;              // grey levels between an even area's neighbours, two pixels apart
constexpr double kLeastArea = 0.01;   // of the picture: an area that is believed
constexpr double kLight = 0.9;        // of the picture's usual grey level: the sky is no darker
constexpr double kLeastAlike = 14.0;  // grey levels of a colour's part
constexpr double kSpreads = 4.0;      // median differences from the polynomial
constexpr double kWider = 1.25;       // than its measured radius wood may be
constexpr size_t kTerms = 6;
constexpr int kRefits = 3;

using Terms = std::array<double, kTerms>;

Terms terms_at(double x, double y) {
    return {1.0, x, y, x * x, x * y, y * y};
}

// Gauss elimination with pivots; false for what has no one solution.
bool solve(std::array<std::array<double, kTerms + 3>, kTerms>& rows) {
    for (size_t step = 0; step < kTerms; step++) {
        size_t best = step;
        for (size_t i = step + 1; i < kTerms; i++)
            if (std::abs(rows[i][step]) > std::abs(rows[best][step])) best = i;
        if (!(std::abs(rows[best][step]) > 1e-9)) return false;
        std::swap(rows[step], rows[best]);
        for (size_t i = 0; i < kTerms; i++) {
            if (i == step) continue;
            const double times = rows[i][step] / rows[step][step];
            for (size_t j = step; j < kTerms + 3; j++)
                rows[i][j] -= times * rows[step][j];
        }
    }
    for (size_t i = 0; i < kTerms; i++)
        for (size_t j = kTerms; j < kTerms + 3; j++)
            rows[i][j] /= rows[i][i];
    return true;
}

int grey_at(const Image& picture, int x, int y) {
    const uint8_t* p = picture.at(x, y);
    return (77 * p[0] + 150 * p[1] + 29 * p[2]) >> 8;
}

// The pixels of even, light areas above the horizon that are large enough.
std::vector<uint8_t> sure_sky(const Image& picture, const std::vector<uint8_t>& above) {
    const int width = picture.width, height = picture.height;
    const auto index = [&](int x, int y) {
        return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
    };
    std::array<size_t, 256> counts{};
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            counts[static_cast<size_t>(grey_at(picture, x, y))]++;
    size_t usual = 0, below = 0;
    for (below = counts[0]; 2 * below < above.size() && usual < 255; below += counts[usual])
        usual++;
    std::vector<uint8_t> even(above.size(), 0);
    for (int y = 1; y + 1 < height; y++)
        for (int x = 1; x + 1 < width; x++) {
            const size_t i = index(x, y);
            even[i] = above[i] && grey_at(picture, x, y) >= kLight * static_cast<double>(usual) &&
                      std::abs(grey_at(picture, x + 1, y) - grey_at(picture, x - 1, y)) <= kEven &&
                      std::abs(grey_at(picture, x, y + 1) - grey_at(picture, x, y - 1)) <= kEven;
        }
    // Areas that hang together.
    std::vector<uint8_t> sure(above.size(), 0);
    std::vector<size_t> area, next;
    const auto least = static_cast<size_t>(kLeastArea * static_cast<double>(above.size()));
    for (size_t first = 0; first < even.size(); first++) {
        if (!even[first]) continue;
        area.clear();
        next.assign(1, first);
        even[first] = 0;
        while (!next.empty()) {
            const size_t i = next.back();
            next.pop_back();
            area.push_back(i);
            // The outermost pixels are never even.
            for (const size_t j :
                 {i - 1, i + 1, i - static_cast<size_t>(width), i + static_cast<size_t>(width)})
                if (even[j]) {
                    even[j] = 0;
                    next.push_back(j);
                }
        }
        if (area.size() > least)
            for (const size_t i : area)
                sure[i] = 1;
    }
    return sure;
}

}  // namespace

PhotoSky::Shown PhotoSky::shown_at(const DVec3& in_camera) const {
    if (mask.empty()) return Shown::kOutside;
    const auto at = camera->project(in_camera);
    if (!at) return Shown::kOutside;
    const DVec2 place = scale * *at;
    if (!(place.x >= 0.0 && place.y >= 0.0 && place.x < width && place.y < height)) return Shown::kOutside;
    const size_t pixel =
        static_cast<size_t>(place.y) * static_cast<size_t>(width) + static_cast<size_t>(place.x);
    return mask[pixel] ? Shown::kSky : Shown::kSomething;
}

PhotoSky sky_in(const LoadedPhoto& loaded, const DVec3& sky, int margin) {
    const Image& picture = loaded.picture;
    const int width = picture.width, height = picture.height;
    PhotoSky found{loaded.photo, loaded.camera, loaded.scale, width, height, {}};
    const size_t all = static_cast<size_t>(width) * static_cast<size_t>(height);
    const double focal = loaded.camera->focal_length() * loaded.scale;
    const auto middle = loaded.camera->project({0.0, 0.0, 1.0});
    if (!(focal > 0.0) || !middle || width < 8 || height < 8) return found;
    const DVec3 up = loaded.photo->turn() * sky;
    std::vector<uint8_t> above(all, 0);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const DVec3 way((x + 0.5 - middle->x * loaded.scale) / focal,
                            (y + 0.5 - middle->y * loaded.scale) / focal, 1.0);
            above[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)] =
                glm::dot(way, up) > kAbove * glm::length(way);
        }
    const std::vector<uint8_t> sure = sure_sky(picture, above);
    const double scale = 2.0 / std::max(width, height);
    std::array<Terms, 3> fit{};
    const auto told = [&](const Terms& terms, size_t part) {
        double sum = 0.0;
        for (size_t k = 0; k < kTerms; k++)
            sum += fit[part][k] * terms[k];
        return sum;
    };
    const auto off_at = [&](int x, int y) {
        const Terms terms = terms_at(scale * x - 1.0, scale * y - 1.0);
        const uint8_t* p = picture.at(x, y);
        double most = 0.0;
        for (size_t part = 0; part < 3; part++)
            most = std::max(most, std::abs(told(terms, part) - p[part]));
        return most;
    };
    double alike = 1e30;
    for (int round = 0; round < kRefits; round++) {
        std::array<std::array<double, kTerms + 3>, kTerms> rows{};
        std::vector<double> offs;
        size_t used = 0;
        for (int y = 0; y < height; y += 2)
            for (int x = 0; x < width; x += 2) {
                if (!sure[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)])
                    continue;
                if (round > 0 && off_at(x, y) > alike) continue;
                const Terms terms = terms_at(scale * x - 1.0, scale * y - 1.0);
                const uint8_t* p = picture.at(x, y);
                for (size_t i = 0; i < kTerms; i++) {
                    for (size_t j = 0; j < kTerms; j++)
                        rows[i][j] += terms[i] * terms[j];
                    for (size_t part = 0; part < 3; part++)
                        rows[i][kTerms + part] += terms[i] * p[part];
                }
                used++;
            }
        if (used < 100 || !solve(rows)) return found;
        for (size_t part = 0; part < 3; part++)
            for (size_t k = 0; k < kTerms; k++)
                fit[part][k] = rows[k][kTerms + part];
        for (int y = 0; y < height; y += 4)
            for (int x = 0; x < width; x += 4)
                if (sure[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)])
                    offs.push_back(off_at(x, y));
        if (offs.empty()) return found;
        alike = std::max(kLeastAlike, kSpreads * quantile(offs, 0.5));
    }
    // Not the sky: 1, and grown by the margin, first along the rows, then along the columns.
    std::vector<uint8_t> other(all), grown(all, 0), shown(all, 0);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const size_t i = static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
            other[i] = !above[i] || off_at(x, y) > alike;
        }
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const size_t row = static_cast<size_t>(y) * static_cast<size_t>(width);
            for (int u = std::max(0, x - margin); u <= std::min(width - 1, x + margin); u++)
                grown[row + static_cast<size_t>(x)] |= other[row + static_cast<size_t>(u)];
        }
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            uint8_t any = 0;
            for (int v = std::max(0, y - margin); v <= std::min(height - 1, y + margin); v++)
                any |= grown[static_cast<size_t>(v) * static_cast<size_t>(width) + static_cast<size_t>(x)];
            shown[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)] = !any;
        }
    DVec3 sum(0.0);
    size_t count = 0;
    for (size_t i = 0; i < all; i++) {
        if (!shown[i]) continue;
        const uint8_t* p = picture.pixels.data() + static_cast<size_t>(picture.channels) * i;
        sum += DVec3(p[0], p[1], p[2]);
        count++;
    }
    if (count > 0) found.colour = sum / static_cast<double>(count);
    found.mask = std::move(shown);
    return found;
}

std::optional<PhotoSky> read_sky(const Photo& photo, const Camera& camera, const std::string& folder,
                                 const DVec3& sky, int most_pixels, int margin) {
    const auto picture = picture_of(photo, camera, folder);
    if (!picture) return {};
    const int times = (std::max(picture->width, picture->height) + most_pixels - 1) / most_pixels;
    return sky_in({&photo, &camera, reduced(*picture, times), 1.0 / times}, sky, margin);
}

SkyCarver::SkyCarver(const PhotoModel& model, std::span<const DVec3> sparse, const std::string& folder,
                     const CarveOptions& options, Progress* progress)
    : options_(options) {
    const auto sky = sky_of(model, sparse);
    if (!sky) return;
    views_.resize(model.photos.size());
    std::atomic<size_t> done = 0;
    parallel_for(views_.size(), 1, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; i++) {
            if (progress) progress->check();
            const Photo& photo = model.photos[i];
            const Camera& camera = model.cameras[static_cast<size_t>(photo.camera)];
            if (auto view = read_sky(photo, camera, folder, *sky, options_.most_pixels, options_.margin))
                views_[i] = std::move(*view);
            if (progress)
                progress->update(static_cast<double>(++done) / static_cast<double>(views_.size()), "Sky");
        }
    });
    std::erase_if(views_, [](const PhotoSky& view) { return view.mask.empty(); });
}

bool SkyCarver::is_sky(const DVec3& p) const {
    size_t shown = 0, sky = 0;
    for (const PhotoSky& view : views_) {
        const PhotoSky::Shown there = view.shown_at(view.photo->to_camera(p));
        shown += there != PhotoSky::Shown::kOutside;
        sky += there == PhotoSky::Shown::kSky;
    }
    return sky >= options_.least_photos &&
           static_cast<double>(sky) > options_.most_sky * static_cast<double>(shown);
}

bool SkyCarver::is_before_sky(const DVec3& p, const DVec3& way, double radius) const {
    size_t shown = 0, sky = 0;
    for (const PhotoSky& view : views_) {
        const DVec3 here = view.photo->to_camera(p);
        if (view.shown_at(here) == PhotoSky::Shown::kOutside) continue;
        const DVec3 across = glm::cross(view.photo->turn() * way, glm::normalize(here));
        // Wood that points at the camera has no sides.
        if (!(glm::length(across) > 0.3)) continue;
        shown++;
        const double pixel = here.z / (view.camera->focal_length() * view.scale);
        const DVec3 aside = (kWider * radius + (options_.margin + 2.0) * pixel) * glm::normalize(across);
        sky += view.shown_at(here - aside) == PhotoSky::Shown::kSky ||
               view.shown_at(here + aside) == PhotoSky::Shown::kSky;
    }
    return sky >= options_.least_photos &&
           static_cast<double>(sky) >= options_.least_beside * static_cast<double>(shown);
}

DVec3 SkyCarver::colour() const {
    DVec3 colour(0.0);
    for (int part = 0; part < 3; part++) {
        std::vector<double> levels;
        for (const PhotoSky& view : views_)
            if (view.colour != DVec3(0.0)) levels.push_back(view.colour[part]);
        if (!levels.empty()) colour[part] = quantile(levels, 0.5);
    }
    return colour;
}

}  // namespace treerec
