#include "fidelity/photo_judge.h"

#include <algorithm>
#include <atomic>
#include <optional>
#include <utility>

#include "error.h"
#include "fidelity/photo_hits.h"
#include "geometry/parallel.h"
#include "photos/cameras_tell.h"
#include "photos/sky_mask.h"

namespace treerec {

namespace {

constexpr int kSkyPixels = 1600;  // of a photo's longer side, for its sky
constexpr int kSkyMargin = 1;     // pixels of these beside something that are not taken for sky

void check_asked(const PhotoModel& model, const PointCloud& cloud) {
    if (cloud.empty()) throw Error("The point cloud is empty; there is nothing to see in the photos.");
    if (model.photos.empty()) throw Error("There are no photos to compare with.");
}

// Of the cloud, in the model's coordinates: enough to tell what is above the cameras.
std::vector<DVec3> some_places(const PointCloud& cloud) {
    constexpr size_t kSome = 4096;
    std::vector<DVec3> places;
    const size_t step = std::max<size_t>(1, cloud.size() / kSome);
    for (size_t i = 0; i < cloud.size(); i += step)
        places.push_back(cloud.frame.to_scan(DVec3(cloud.positions[i])));
    return places;
}

// What one photo says.
struct Judged {
    PhotoHits hits;
    OutlineMask mask;
};

// Calls judge(i) for each photo, on several threads; in the photos' order. Nothing for those that don't
// judge.
template <typename Judge>
std::vector<std::optional<Judged>> judge_all(size_t count, const char* stage, Progress* progress,
                                             Judge judge) {
    std::vector<std::optional<Judged>> all(count);
    std::atomic<size_t> done = 0;
    if (progress) progress->update(0.0, stage);
    parallel_for(count, 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++) {
            if (progress) progress->check();
            all[i] = judge(i);
            if (progress) progress->update(static_cast<double>(++done) / static_cast<double>(count), stage);
        }
    });
    return all;
}

// White where the photo shows something.
Image not_sky(const PhotoSky& sky) {
    Image mask(sky.width, sky.height, 1);
    std::transform(sky.mask.begin(), sky.mask.end(), mask.pixels.begin(),
                   [](uint8_t is_sky) { return static_cast<uint8_t>(is_sky ? 0 : 255); });
    return mask;
}

}  // namespace

PhotoJudge PhotoJudge::by_masks(const PhotoModel& model, const std::string& masks, const PointCloud& cloud,
                                Progress* progress) {
    check_asked(model, cloud);
    const std::vector<std::string> files = mask_files(masks, model);
    auto all = judge_all(files.size(), "Masks", progress, [&](size_t i) {
        const Photo& photo = model.photos[i];
        const Camera& camera = model.cameras[static_cast<size_t>(photo.camera)];
        const Image mask = read_mask(files[i]);
        check_mask(photo, camera, mask);
        return Judged{count_hits(cloud, photo, camera, mask, progress), outline_mask(photo, camera, mask)};
    });
    PhotoJudge judge;
    std::vector<PhotoHits> hits;
    for (std::optional<Judged>& one : all) {
        hits.push_back(std::move(one->hits));
        judge.masks_.push_back(std::move(one->mask));
    }
    judge.cloud_ = sum_up_photos(std::move(hits), photo_information(model.photos.size()));
    return judge;
}

PhotoJudge PhotoJudge::by_sky(const PhotoModel& model, const std::string& photos, const PointCloud& cloud,
                              Progress* progress) {
    check_asked(model, cloud);
    const std::optional<DVec3> up = sky_of(model, some_places(cloud));
    if (!up) throw Error("The photos don't agree on where up is, so that their sky can't be told.");
    std::atomic<size_t> unread = 0;
    auto all = judge_all(model.photos.size(), "Sky", progress, [&](size_t i) -> std::optional<Judged> {
        const Photo& photo = model.photos[i];
        const Camera& camera = model.cameras[static_cast<size_t>(photo.camera)];
        const std::optional<PhotoSky> sky = read_sky(photo, camera, photos, *up, kSkyPixels, kSkyMargin);
        if (!sky) {
            unread++;
            return std::nullopt;
        }
        if (sky->mask.empty()) return std::nullopt;
        const auto shown = [&](const DVec3& in_camera) { return sky->shown_at(in_camera); };
        return Judged{count_hits(cloud, photo, shown, progress), outline_mask(photo, camera, not_sky(*sky))};
    });
    PhotoJudge judge;
    judge.source_ = OutlineSource::kSky;
    std::vector<PhotoHits> hits;
    for (std::optional<Judged>& one : all) {
        if (!one) continue;
        hits.push_back(std::move(one->hits));
        judge.masks_.push_back(std::move(one->mask));
    }
    if (hits.empty() && unread == model.photos.size())
        throw Error("None of the photos in '" + photos + "' can be read.");
    if (hits.empty())
        throw Error("No sky is sure in any of the photos, so that only masks of them can judge the tree.");
    judge.cloud_ = sum_up_photos(std::move(hits), photo_information(model.photos.size()));
    return judge;
}

OutlineOverlap PhotoJudge::judge(std::span<const OutlinePart> parts, const ScanFrame& frame,
                                 const Progress* progress) const {
    OutlineOverlap found = measure_overlap(parts, frame, masks_, progress);
    if (source_ == OutlineSource::kMasks) return found;
    found.mean.recall = found.mean.iou = 0.0;
    for (PhotoOverlap& photo : found.photos)
        photo.overlap.recall = photo.overlap.iou = 0.0;
    return found;
}

const char* outline_source_name(OutlineSource source) {
    return source == OutlineSource::kMasks ? "masks" : "sky";
}

}  // namespace treerec
