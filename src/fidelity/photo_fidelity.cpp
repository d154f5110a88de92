#include "fidelity/photo_fidelity.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "error.h"
#include "file_bytes.h"
#include "geometry/parallel.h"
#include "geometry/portable_math.h"
#include "photos/photo_picture.h"

namespace treerec {

namespace {

constexpr size_t kChunk = 8192;
constexpr int kBright = 128;

std::string size_text(int width, int height) {
    return std::to_string(width) + " x " + std::to_string(height);
}

bool is_file(const std::string& path) {
    std::error_code failure;
    return std::filesystem::is_regular_file(path_of(path), failure);
}

// The mask of a photo in the folder; empty where there is none.
std::string mask_path(const std::string& folder, const std::string& photo) {
    const std::filesystem::path base = path_of(folder);
    const auto in_folder = [&](const std::string& name) { return utf8_of(base / path_of(name)); };
    if (const std::string path = in_folder(photo + ".png"); is_file(path)) return path;
    const size_t dot = photo.find_last_of("./");
    const std::string stem = dot == std::string::npos || photo[dot] == '/' ? photo : photo.substr(0, dot);
    for (const char* extension : {".png", ".jpg", ".jpeg", ".bmp", ".tga"})
        if (const std::string path = in_folder(stem + extension); is_file(path)) return path;
    return {};
}

Image read_mask(const std::string& path) {
    std::optional<Image> picture = decode_picture(read_file(path).view(), 1);
    if (!picture)
        throw Error("The mask '" + path + "' is no picture that can be read (PNG, JPEG, BMP or TGA).");
    Image mask = std::move(*picture);
    for (uint8_t& pixel : mask.pixels)
        pixel = pixel >= kBright ? 255 : 0;
    return mask;
}

}  // namespace

double photo_information(size_t photos, double ratio) {
    return 1.0 - portable::pow(ratio, static_cast<double>(photos));
}

void check_masks(const PhotoModel& model, const std::vector<Image>& masks) {
    if (model.photos.empty()) throw Error("There are no photos to compare with.");
    if (masks.size() != model.photos.size())
        throw Error("There are " + std::to_string(model.photos.size()) + " photos, but " +
                    std::to_string(masks.size()) + " masks: each photo needs one.");
    for (size_t i = 0; i < masks.size(); i++) {
        const Photo& photo = model.photos[i];
        const Camera& camera = model.cameras[static_cast<size_t>(photo.camera)];
        if (masks[i].width != camera.width || masks[i].height != camera.height || masks[i].channels != 1)
            throw Error("The mask of " + quote_word(photo.name) + " has " +
                        size_text(masks[i].width, masks[i].height) + " pixels, but the photo has " +
                        size_text(camera.width, camera.height) + ": they must be the same.");
    }
}

std::vector<Image> read_masks(const std::string& folder, const PhotoModel& model, const Progress* progress) {
    std::error_code failure;
    if (!std::filesystem::is_directory(path_of(folder), failure))
        throw Error("There is no folder '" + folder + "' with the photos' masks.");
    std::vector<std::string> paths;
    std::string missing;
    size_t count = 0;
    for (const Photo& photo : model.photos) {
        paths.push_back(mask_path(folder, photo.name));
        if (!paths.back().empty()) continue;
        constexpr size_t kNamed = 3;
        if (count++ < kNamed)
            missing += (missing.empty() ? "" : ", ") + quote_word(photo.name);
        else if (count == kNamed + 1)
            missing += ", ...";
    }
    if (count > 0)
        throw Error(std::to_string(count) + " of " + std::to_string(model.photos.size()) +
                    " photos have no mask in '" + folder + "': " + missing +
                    ". A mask is called like its photo, with .png after it, and is white where the tree is.");
    std::vector<Image> masks(paths.size());
    parallel_for(paths.size(), 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++) {
            if (progress) progress->check();
            masks[i] = read_mask(paths[i]);
        }
    });
    return masks;
}

PhotoFidelity measure_photos(const PointCloud& cloud, const PhotoModel& model,
                             const std::vector<Image>& masks, double ratio, const Progress* progress) {
    if (cloud.empty()) throw Error("The point cloud is empty; there is nothing to see in the photos.");
    check_masks(model, masks);
    PhotoFidelity result;
    for (size_t i = 0; i < masks.size(); i++) {
        const Photo& photo = model.photos[i];
        const Camera& camera = model.cameras[static_cast<size_t>(photo.camera)];
        struct Hits {
            size_t inside = 0, seen = 0;
        };
        std::vector<Hits> hits((cloud.size() + kChunk - 1) / kChunk);
        parallel_for(cloud.size(), kChunk, [&](size_t begin, size_t end) {
            if (progress) progress->check();
            Hits here;
            for (size_t k = begin; k < end; k++) {
                const DVec3 world = cloud.frame.to_scan(DVec3(cloud.positions[k]));
                const std::optional<DVec2> at = camera.project(photo.to_camera(world));
                if (!at || !(at->x >= 0.0 && at->y >= 0.0 && at->x < camera.width && at->y < camera.height))
                    continue;
                here.seen++;
                here.inside += *masks[i].at(static_cast<int>(at->x), static_cast<int>(at->y)) != 0;
            }
            hits[begin / kChunk] = here;
        });
        PhotoHits photo_hits;
        photo_hits.name = photo.name;
        size_t seen = 0;
        for (const Hits& chunk : hits) {
            photo_hits.inside += chunk.inside;
            seen += chunk.seen;
        }
        photo_hits.outside = cloud.size() - photo_hits.inside;
        photo_hits.unseen = cloud.size() - seen;
        const auto inside = static_cast<double>(photo_hits.inside);
        photo_hits.share = inside / static_cast<double>(cloud.size());
        result.reconstruction += photo_hits.share / static_cast<double>(masks.size());
        if (seen > 0) result.seen += inside / static_cast<double>(seen) / static_cast<double>(masks.size());
        result.photos.push_back(std::move(photo_hits));
    }
    result.information = photo_information(masks.size(), ratio);
    return result;
}

PhotoFidelity measure_photos(const PointCloud& cloud, const std::string& model, const std::string& masks,
                             const Progress* progress) {
    const PhotoModel photos = read_photo_model(model);
    return measure_photos(cloud, photos, read_masks(masks, photos, progress), kInformationRatio, progress);
}

}  // namespace treerec
