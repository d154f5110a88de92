#include "fidelity/photo_fidelity.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "error.h"
#include "fidelity/photo_hits.h"
#include "file_bytes.h"
#include "geometry/parallel.h"
#include "geometry/portable_math.h"
#include "photos/photo_picture.h"

namespace treerec {

namespace {

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

}  // namespace

double photo_information(size_t photos, double ratio) {
    return 1.0 - portable::pow(ratio, static_cast<double>(photos));
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

void check_mask(const Photo& photo, const Camera& camera, const Image& mask) {
    if (mask.width == camera.width && mask.height == camera.height && mask.channels == 1) return;
    throw Error("The mask of " + quote_word(photo.name) + " has " + size_text(mask.width, mask.height) +
                " pixels, but the photo has " + size_text(camera.width, camera.height) +
                ": they must be the same.");
}

void check_masks(const PhotoModel& model, const std::vector<Image>& masks) {
    if (model.photos.empty()) throw Error("There are no photos to compare with.");
    if (masks.size() != model.photos.size())
        throw Error("There are " + std::to_string(model.photos.size()) + " photos, but " +
                    std::to_string(masks.size()) + " masks: each photo needs one.");
    for (size_t i = 0; i < masks.size(); i++) {
        const Photo& photo = model.photos[i];
        check_mask(photo, model.cameras[static_cast<size_t>(photo.camera)], masks[i]);
    }
}

std::vector<std::string> mask_files(const std::string& folder, const PhotoModel& model) {
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
    return paths;
}

std::vector<Image> read_masks(const std::string& folder, const PhotoModel& model, const Progress* progress) {
    const std::vector<std::string> paths = mask_files(folder, model);
    std::vector<Image> masks(paths.size());
    parallel_for(paths.size(), 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++) {
            if (progress) progress->check();
            masks[i] = read_mask(paths[i]);
        }
    });
    return masks;
}

PhotoFidelity sum_up_photos(std::vector<PhotoHits> photos, double information) {
    PhotoFidelity result;
    result.information = information;
    for (const PhotoHits& photo : photos) {
        const auto count = static_cast<double>(photos.size());
        const size_t seen = photo.inside + photo.outside - photo.unseen;
        result.reconstruction += photo.share / count;
        if (seen > 0) result.seen += static_cast<double>(photo.inside) / static_cast<double>(seen) / count;
    }
    result.photos = std::move(photos);
    return result;
}

PhotoFidelity measure_photos(const PointCloud& cloud, const PhotoModel& model,
                             const std::vector<Image>& masks, double ratio, const Progress* progress) {
    if (cloud.empty()) throw Error("The point cloud is empty; there is nothing to see in the photos.");
    check_masks(model, masks);
    std::vector<PhotoHits> hits;
    for (size_t i = 0; i < masks.size(); i++) {
        const Photo& photo = model.photos[i];
        const Camera& camera = model.cameras[static_cast<size_t>(photo.camera)];
        hits.push_back(count_hits(cloud, photo, camera, masks[i], progress));
    }
    return sum_up_photos(std::move(hits), photo_information(masks.size(), ratio));
}

PhotoFidelity measure_photos(const PointCloud& cloud, const std::string& model, const std::string& masks,
                             const Progress* progress) {
    const PhotoModel photos = read_photo_model(model);
    return measure_photos(cloud, photos, read_masks(masks, photos, progress), kInformationRatio, progress);
}

}  // namespace treerec
