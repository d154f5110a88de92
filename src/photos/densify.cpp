#include "photos/densify.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>

#include "error.h"
#include "file_bytes.h"
#include "geometry/parallel.h"
#include "geometry/quantile.h"
#include "photos/cameras_tell.h"
#include "photos/free_space.h"
#include "photos/pair_places.h"
#include "photos/photo_picture.h"
#include "photos/sky_mask.h"

namespace treerec {

namespace {

constexpr double kLeastAngle = 1.5;  // degrees between two photos' ways to what they show
constexpr double kBestAngle = 7.0;   // nearer, and depth is unsure; farther, and bark looks otherwise
constexpr double kLargestAngle = 25.0;
constexpr double kTurned = 0.82;     // cosine of 35 degrees between two photos' views
constexpr size_t kLeastSeen = 8;     // sparse points that tell how far a photo looks
constexpr double kNear = 0.7;        // of the nearest sparse points' distance
constexpr double kFar = 1.5;         // of the farthest ones'
constexpr double kOutermost = 0.01;  // share of the sparse points that is not asked
constexpr double kCellPixels = 2.0;
constexpr double kFinePixels = 4.0;     // of the matched pictures', have those that tell parts of a pixel,
constexpr double kMostFine = 400.0;     // megapixels of all photos together at most: three bytes each
constexpr double kCellReach = 1 << 20;  // cells to each side that have a number
constexpr double kSlack = 2.0;          // cells, by which what a photo sees through a point lies behind it

// How far what a photo shows is in front of it, in the model's unit.
struct Depths {
    double least = 0.0, median = 0.0, most = 0.0;
};

struct Pair {
    size_t one, other;
};

// What one pair sees within one cell.
struct Sight {
    uint64_t cell = 0;
    uint32_t pair = 0;
    float weight = 0.0F;
    Vec3 place{0.0F};  // weighted sum, from the cell's corner in cells
    Vec3 colour{0.0F};
};

class Cells {
  public:
    Cells(const DVec3& middle, double size) : middle_(middle), size_(size) {}
    bool has(const DVec3& p) const {
        const DVec3 at = glm::abs(p - middle_) / size_;
        return at.x < kCellReach && at.y < kCellReach && at.z < kCellReach;
    }
    uint64_t of(const DVec3& p) const {
        const DVec3 at = glm::floor((p - middle_) / size_) + kCellReach;
        return static_cast<uint64_t>(at.x) << 42 | static_cast<uint64_t>(at.y) << 21 |
               static_cast<uint64_t>(at.z);
    }
    DVec3 corner(uint64_t cell) const {
        const DVec3 at(static_cast<double>(cell >> 42), static_cast<double>(cell >> 21 & 0x1FFFFF),
                       static_cast<double>(cell & 0x1FFFFF));
        return middle_ + size_ * (at - kCellReach);
    }

  private:
    DVec3 middle_;
    double size_;
};

// What is kept: all, or what is nearer to an upright line than most cameras.
struct Region {
    bool everything = true;
    DVec3 subject{0.0}, sky{0.0};
    double reach = 0.0;

    bool has(const DVec3& p) const { return everything || away_from_line(p, subject, sky) < reach; }
};

Region region_of(const PhotoModel& model, std::span<const DVec3> sparse) {
    Region region;
    const auto subject = subject_of(model);
    const auto sky = sky_of(model, sparse);
    if (!subject || !sky) return region;
    region.everything = false;
    region.subject = *subject;
    region.sky = *sky;
    region.reach = subject_reach(model, *subject, *sky);
    return region;
}

Depths depths_of(const LoadedPhoto& photo, std::span<const DVec3> sparse) {
    std::vector<double> depths;
    for (const DVec3& p : sparse) {
        const DVec3 seen = photo.photo->to_camera(p);
        const auto pixel = photo.camera->project(seen);
        if (pixel && pixel->x >= 0 && pixel->y >= 0 && pixel->x < photo.camera->width &&
            pixel->y < photo.camera->height)
            depths.push_back(seen.z);
    }
    if (depths.size() < kLeastSeen) return {};
    Depths found;
    found.median = quantile(depths, 0.5);
    found.least = kNear * quantile(depths, kOutermost);
    found.most = kFar * quantile(depths, 1.0 - kOutermost);
    return found;
}

// The pairs that tell most: for each photo its neighbours at the best angle.
std::vector<Pair> choose_pairs(const std::vector<PhotoSizes>& photos, const std::vector<Depths>& depths,
                               int neighbours) {
    std::set<std::pair<size_t, size_t>> chosen;
    for (size_t i = 0; i < photos.size(); i++) {
        if (!(depths[i].median > 0.0)) continue;
        const DVec3 here = photos[i].matched.photo->centre(), ahead = photos[i].matched.photo->ahead();
        const DVec3 shown = here + depths[i].median * ahead;
        std::vector<std::pair<double, size_t>> others;
        for (size_t j = 0; j < photos.size(); j++) {
            if (j == i || !(depths[j].median > 0.0)) continue;
            const double angle = degrees_between(here - shown, photos[j].matched.photo->centre() - shown);
            if (!(angle >= kLeastAngle && angle <= kLargestAngle)) continue;
            if (glm::dot(ahead, photos[j].matched.photo->ahead()) < kTurned) continue;
            others.emplace_back(std::abs(std::log(angle / kBestAngle)), j);
        }
        std::sort(others.begin(), others.end());
        for (size_t k = 0; k < std::min(others.size(), static_cast<size_t>(neighbours)); k++)
            chosen.insert(std::minmax(i, others[k].second));
    }
    std::vector<Pair> pairs;
    for (const auto& [one, other] : chosen)
        pairs.push_back({one, other});
    return pairs;
}

// What a pair sees, a sum for each cell, by cell. sky: of the first one. space: gets how far that one looks.
std::vector<Sight> look(const PhotoSizes& one, const PhotoSizes& other, const PhotoSky& sky,
                        const Depths& depths, const Region& region, const Cells& cells, double cell,
                        uint32_t number, FreeSpace& space) {
    std::vector<Sight> sights;
    space = FreeSpace(one.matched);
    for (const PairPlace& seen : places_of_pair(one, other, sky, depths.least, depths.most)) {
        space.add(seen.place, seen.unsure);
        if (!region.has(seen.place) || !cells.has(seen.place)) continue;
        Sight sight;
        sight.cell = cells.of(seen.place);
        sight.pair = number;
        sight.weight = static_cast<float>(cell * cell / (cell * cell + seen.unsure * seen.unsure));
        sight.place = sight.weight * Vec3((seen.place - cells.corner(sight.cell)) / cell);
        sight.colour = sight.weight * Vec3(seen.colour[0], seen.colour[1], seen.colour[2]);
        sights.push_back(sight);
    }
    std::stable_sort(sights.begin(), sights.end(),
                     [](const Sight& a, const Sight& b) { return a.cell < b.cell; });
    size_t kept = 0;
    for (size_t i = 0; i < sights.size(); i++) {
        if (kept > 0 && sights[kept - 1].cell == sights[i].cell) {
            Sight& sum = sights[kept - 1];
            sum.weight += sights[i].weight;
            sum.place += sights[i].place;
            sum.colour += sights[i].colour;
        } else {
            sights[kept++] = sights[i];
        }
    }
    sights.resize(kept);
    return sights;
}

// What enough pairs agree on.
struct Agreed {
    PointCloud cloud;
    std::vector<uint32_t> pairs;  // by point: that see it
};

// The cells that enough pairs see, themselves or right beside; a point for each.
Agreed agreed(const std::vector<Sight>& sights, const Cells& cells, double cell, int agreeing,
              const DVec3& origin) {
    Agreed found;
    PointCloud& cloud = found.cloud;
    cloud.frame.origin = origin;
    std::vector<size_t> starts;
    for (size_t i = 0; i < sights.size(); i++)
        if (i == 0 || sights[i].cell != sights[i - 1].cell) starts.push_back(i);
    starts.push_back(sights.size());
    const size_t count = starts.size() - 1;
    const auto find = [&](uint64_t wanted) {
        const auto at =
            std::lower_bound(starts.begin(), starts.end() - 1, wanted,
                             [&](size_t start, uint64_t value) { return sights[start].cell < value; });
        return at != starts.end() - 1 && sights[*at].cell == wanted ? static_cast<size_t>(at - starts.begin())
                                                                    : count;
    };
    std::vector<uint32_t> by(count, 0);
    parallel_for(count, 4096, [&](size_t begin, size_t end) {
        std::vector<uint32_t> seen;
        for (size_t i = begin; i < end; i++) {
            const uint64_t here = sights[starts[i]].cell;
            seen.clear();
            for (int64_t dx = -1; dx <= 1; dx++)
                for (int64_t dy = -1; dy <= 1; dy++)
                    for (int64_t dz = -1; dz <= 1; dz++) {
                        const auto step =
                            static_cast<uint64_t>(dx * (int64_t{1} << 42) + dy * (int64_t{1} << 21) + dz);
                        const size_t beside = find(here + step);
                        if (beside == count) continue;
                        for (size_t k = starts[beside]; k < starts[beside + 1]; k++)
                            seen.push_back(sights[k].pair);
                    }
            std::sort(seen.begin(), seen.end());
            by[i] = static_cast<uint32_t>(std::unique(seen.begin(), seen.end()) - seen.begin());
        }
    });
    for (size_t i = 0; i < count; i++) {
        if (by[i] < static_cast<uint32_t>(agreeing)) continue;
        found.pairs.push_back(by[i]);
        Vec3 place{0.0F}, colour{0.0F};
        float weight = 0.0F;
        for (size_t k = starts[i]; k < starts[i + 1]; k++) {
            place += sights[k].place;
            colour += sights[k].colour;
            weight += sights[k].weight;
        }
        const DVec3 p = cells.corner(sights[starts[i]].cell) + cell * DVec3(place / weight);
        cloud.positions.emplace_back(p - origin);
        const Vec3 mean = glm::clamp(colour / weight + 0.5F, 0.0F, 255.0F);
        cloud.colors.push_back(
            {static_cast<uint8_t>(mean.x), static_cast<uint8_t>(mean.y), static_cast<uint8_t>(mean.z)});
    }
    return found;
}

// Beside an edge, matching takes what lies behind it for as near as the edge: around a trunk hangs what is
// far behind it. Who looks from elsewhere sees through that.
void drop_seen_through(Agreed& found, const std::vector<FreeSpace>& spaces, double cell,
                       const Progress& progress) {
    std::vector<DVec3> places;
    places.reserve(found.cloud.size());
    for (const Vec3& p : found.cloud.positions)
        places.push_back(found.cloud.frame.origin + DVec3(p));
    const std::vector<uint32_t> through = count_seen_through(places, spaces, kSlack * cell, &progress);
    std::vector<uint8_t> keep(places.size());
    for (size_t i = 0; i < places.size(); i++)
        keep[i] = through[i] <= found.pairs[i];
    found.cloud.keep_only(keep);
}

// By how much a picture's sides are divided to have about so many megapixels.
int times_smaller(const Image& picture, double megapixels) {
    const double pixels = static_cast<double>(picture.width) * picture.height;
    return std::max(1, static_cast<int>(std::lround(std::sqrt(pixels / (1e6 * megapixels)))));
}

std::vector<PhotoSizes> load_photos(const PhotoModel& model, const std::string& folder, double megapixels,
                                    Densified& result, Progress* progress) {
    const double fine_megapixels =
        std::min(kFinePixels * megapixels, kMostFine / static_cast<double>(model.photos.size()));
    std::vector<PhotoSizes> photos;
    for (size_t i = 0; i < model.photos.size(); i++) {
        if (progress) {
            progress->check();
            progress->update(static_cast<double>(i) / static_cast<double>(model.photos.size()), "Photos");
        }
        const Photo& photo = model.photos[i];
        const Camera& camera = model.cameras[static_cast<size_t>(photo.camera)];
        try {
            const std::string path = utf8_of(path_of(folder) / path_of(photo.name));
            const Image picture = read_photo(path);
            if (picture.width != camera.width || picture.height != camera.height)
                throw Error("'" + path + "' is not as large as the model says; it was left out.");
            const int times = times_smaller(picture, megapixels);
            const int fine = times_smaller(picture, fine_megapixels);
            PhotoSizes sizes;
            sizes.matched = {&photo, &camera, reduced(picture, times), 1.0 / times};
            if (fine < times) sizes.fine = {&photo, &camera, reduced(picture, fine), 1.0 / fine};
            photos.push_back(std::move(sizes));
        } catch (const Error& error) {
            result.warnings.emplace_back(error.what());
        }
    }
    result.photos = photos.size();
    return photos;
}

// Two of the pictures' pixels, where what was photographed is.
double usual_cell(const std::vector<PhotoSizes>& photos, const std::vector<Depths>& depths,
                  const Region& region) {
    std::vector<double> cells;
    for (size_t i = 0; i < photos.size(); i++) {
        if (!(depths[i].median > 0.0)) continue;
        const double away = region.everything ? depths[i].median
                                              : glm::dot(region.subject - photos[i].matched.photo->centre(),
                                                         photos[i].matched.photo->ahead());
        const double focal = photos[i].matched.camera->focal_length() * photos[i].matched.scale;
        if (focal > 0.0 && away > 0.0) cells.push_back(kCellPixels * away / focal);
    }
    return cells.empty() ? 0.0 : quantile(cells, 0.5);
}

}  // namespace

Densified densify(const PhotoModel& model, std::span<const DVec3> sparse, const std::string& folder,
                  const DensifyOptions& options, Progress* progress) {
    Densified result;
    SubProgress loading(progress, 0.0, 0.1), matching(progress, 0.1, 0.95);
    const std::vector<PhotoSizes> photos = load_photos(model, folder, options.megapixels, result, &loading);
    const Region region = region_of(model, sparse);
    std::vector<Depths> depths;
    for (const PhotoSizes& photo : photos)
        depths.push_back(depths_of(photo.matched, sparse));
    const std::vector<Pair> pairs = choose_pairs(photos, depths, options.neighbours);
    result.cell = options.cell > 0.0 ? options.cell : usual_cell(photos, depths, region);
    if (pairs.empty() || !(result.cell > 0.0))
        throw Error("No two photos look at the same thing from nearby: take more of them, a step apart.");
    const DVec3 middle = region.everything ? sparse[sparse.size() / 2] : region.subject;
    const Cells cells(middle, result.cell);
    // Beside a twig, matching takes the sky for wood.
    std::vector<PhotoSky> skies(photos.size());
    if (!region.everything)
        parallel_for(photos.size(), 1, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; i++)
                skies[i] = sky_in(photos[i].matched, region.sky, 0);
        });
    std::vector<std::vector<Sight>> seen(pairs.size());
    std::vector<FreeSpace> spaces(pairs.size());
    std::atomic<size_t> done{0};
    parallel_for(pairs.size(), 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++) {
            matching.check();
            const auto [one, other] = pairs[i];
            seen[i] = look(photos[one], photos[other], skies[one], depths[one], region, cells, result.cell,
                           static_cast<uint32_t>(i), spaces[i]);
            matching.update(static_cast<double>(++done) / static_cast<double>(pairs.size()), "Dense points");
        }
    });
    std::vector<Sight> sights;
    for (std::vector<Sight>& some : seen) {
        result.pairs += !some.empty();
        sights.insert(sights.end(), some.begin(), some.end());
        some = {};
    }
    std::stable_sort(sights.begin(), sights.end(),
                     [](const Sight& a, const Sight& b) { return a.cell < b.cell; });
    Agreed found = agreed(sights, cells, result.cell, options.agreeing, middle);
    drop_seen_through(found, spaces, result.cell, matching);
    result.cloud = std::move(found.cloud);
    if (result.cloud.empty()) throw Error("The photos agree on no point: are they sharp, and of one thing?");
    return result;
}

}  // namespace treerec
