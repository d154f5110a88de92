#include "photos/photo_markers.h"

#include <algorithm>
#include <atomic>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "file_bytes.h"
#include "geometry/parallel.h"
#include "photos/count_done.h"
#include "photos/photo_folder.h"
#include "photos/photo_picture.h"
#include "photos/run_stage.h"

namespace treerec {

namespace {

using json = nlohmann::json;

constexpr const char* kMethod = "markers 1";  // another number where others are found

// In the camera's pixels. Nothing for a photo that can't be read.
std::optional<std::vector<FoundMarker>> look_at(const std::string& path, const Camera& camera,
                                                const Progress* progress) {
    std::optional<Image> picture;
    try {
        picture = decode_picture(read_file(path).view(), 1);
    } catch (const Error&) {
        return {};
    }
    if (!picture || picture->width < 1 || picture->height < 1) return {};
    GreyPicture grey;
    grey.width = picture->width;
    grey.height = picture->height;
    grey.pixels = std::move(picture->pixels);
    const DVec2 scale(static_cast<double>(camera.width) / grey.width,
                      static_cast<double>(camera.height) / grey.height);
    std::vector<FoundMarker> markers = find_markers(grey, {}, progress);
    for (FoundMarker& marker : markers)
        for (DVec2& corner : marker.corners)
            corner *= scale;
    return markers;
}

json as_json(const SeenMarkers& seen, const PhotoModel& model) {
    json note = {{"unreadable", seen.unreadable}, {"photos", json::array()}};
    for (const PhotoMarkers& photo : seen.photos)
        for (const FoundMarker& marker : photo.markers) {
            json entry = {
                {"name", model.photos[photo.photo].name}, {"id", marker.id}, {"mended", marker.mended}};
            for (const DVec2& corner : marker.corners)
                entry["corners"].push_back({corner.x, corner.y});
            note["photos"].push_back(std::move(entry));
        }
    return note;
}

// What a mark of the same photos keeps; nothing for a damaged one.
std::optional<SeenMarkers> from_json(const std::string& text, const PhotoModel& model) {
    try {
        const json note = json::parse(text);
        SeenMarkers seen;
        seen.unreadable = note.at("unreadable").get<size_t>();
        for (const json& entry : note.at("photos")) {
            const std::string name = entry.at("name").get<std::string>();
            const auto photo = std::find_if(model.photos.begin(), model.photos.end(),
                                            [&](const Photo& one) { return one.name == name; });
            if (photo == model.photos.end()) return {};
            FoundMarker marker;
            marker.id = entry.at("id").get<int>();
            marker.mended = entry.at("mended").get<int>();
            for (size_t k = 0; k < 4; k++)
                marker.corners[k] = {entry.at("corners").at(k).at(0).get<double>(),
                                     entry.at("corners").at(k).at(1).get<double>()};
            const auto index = static_cast<size_t>(photo - model.photos.begin());
            if (seen.photos.empty() || seen.photos.back().photo != index) seen.photos.push_back({index, {}});
            seen.photos.back().markers.push_back(marker);
        }
        return seen;
    } catch (const json::exception&) {
        return {};
    }
}

std::string basis_of(const PhotoModel& model, const std::string& folder) {
    json basis = {kMethod, photos_as_text(list_photos(folder)), json::array()};
    for (const Photo& photo : model.photos) {
        const Camera& camera = model.cameras[static_cast<size_t>(photo.camera)];
        basis[2].push_back({photo.name, camera.width, camera.height});
    }
    return basis.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

SeenMarkers markers_of_photos(const PhotoModel& model, const std::string& folder, const std::string& mark,
                              Progress* progress) {
    RunStage stage(mark, basis_of(model, folder));
    if (stage.done())
        if (const std::optional<SeenMarkers> kept = from_json(stage.note(), model)) return *kept;
    if (progress) progress->update(0.0, "Markers");
    stage.begin();
    std::vector<std::vector<FoundMarker>> found(model.photos.size());
    std::atomic<size_t> unreadable = 0;
    CountDone counter(progress, 0.0, 1.0, "Markers", model.photos.size());
    parallel_for(model.photos.size(), 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++) {
            if (progress) progress->check();
            const Photo& photo = model.photos[i];
            std::optional<std::vector<FoundMarker>> markers =
                look_at(utf8_of(path_of(folder) / path_of(photo.name)),
                        model.cameras[static_cast<size_t>(photo.camera)], progress);
            if (markers)
                found[i] = std::move(*markers);
            else
                unreadable++;
            counter.add(1);
        }
    });
    SeenMarkers seen;
    seen.unreadable = unreadable;
    for (size_t i = 0; i < found.size(); i++)
        if (!found[i].empty()) seen.photos.push_back({i, std::move(found[i])});
    stage.finish(as_json(seen, model).dump(-1, ' ', false, json::error_handler_t::replace));
    return seen;
}

}  // namespace treerec
