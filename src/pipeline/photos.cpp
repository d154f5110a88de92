#include "pipeline/photos.h"

#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <utility>

#include "error.h"
#include "exchange/material_textures.h"
#include "file_bytes.h"
#include "photos/film_frames.h"
#include "photos/heic_photos.h"
#include "photos/photo_folder.h"
#include "photos/run_stage.h"
#include "pipeline/label_photo_leaves.h"
#include "pipeline/wood_outlines.h"
#include "scan/formats/read_cloud.h"

namespace treerec {

namespace {

constexpr const char* kMethod = "points 10";  // another number where another cloud comes out
constexpr double kFilmEnd = 0.1;
constexpr double kHeicEnd = 0.05;
constexpr double kColmapEnd = 0.6;
constexpr double kPointsEnd = 0.85;  // of the cloud's part
constexpr double kMarkersEnd = 0.62;
constexpr double kCloudEnd = 0.93;
constexpr double kTreeEnd = 0.96;
constexpr double kBarkEnd = 0.985;

using json = nlohmann::json;

// Everything that the cloud depends on.
std::string basis_of(const std::string& folder, const std::string& model, const MakeCloudOptions& options) {
    json basis = {kMethod,
                  photos_as_text(list_photos(folder)),
                  options.least_track,
                  options.most_error,
                  options.dense,
                  options.hold_out,
                  options.densify.megapixels,
                  options.densify.neighbours,
                  options.densify.agreeing,
                  options.densify.cell,
                  options.thin_wood.most_pixels,
                  options.carve.most_pixels};
    for (const char* name : {"cameras.bin", "images.bin", "points3D.bin"}) {
        std::error_code failure;
        const std::filesystem::path file = path_of(model) / name;
        basis.push_back(std::filesystem::file_size(file, failure));
        basis.push_back(std::filesystem::last_write_time(file, failure).time_since_epoch().count());
    }
    return basis.dump();
}

// What the note of a cloud tells; nothing for a damaged one.
std::optional<MadeCloud> read_note(const std::string& text) {
    try {
        const json note = json::parse(text);
        MadeCloud made;
        made.points = note.at("points").get<size_t>();
        made.left_out = note.at("left_out").get<size_t>();
        made.pairs = note.at("pairs").get<size_t>();
        made.thin = note.at("thin").get<size_t>();
        made.outlines = note.at("outlines").get<size_t>();
        made.leafy = note.at("leafy").get<bool>();
        made.cell = note.at("cell").get<double>();
        made.warnings = note.at("warnings").get<std::vector<std::string>>();
        return made;
    } catch (const json::exception&) {
        return {};
    }
}

// Puts what a first tree lets the photos tell into the cloud: which points are leaves, and how thick the wood
// is. That there is no such tree yet, as where it has to be told which, is no reason for a cloud to fail.
void tell_more(const PhotosResult& result, const std::string& folder, size_t hold_out, MadeCloud& made,
               Progress* progress) {
    SubProgress growing(progress, 0.0, 0.5), looking(progress, 0.5, 1.0);
    Reconstruction first;
    try {
        first = reconstruct_tree(result.cloud, {}, &growing);
    } catch (const Cancelled&) {
        throw;
    } catch (const Error&) {
        // The tree that is made next says so.
        return;
    }
    PointCloud cloud = read_cloud(result.cloud);
    const PhotoModel model = without_held_out(read_photo_model(result.photos.model, &looking), hold_out);
    made.leafy = label_photo_leaves(cloud, first.tree, made.sky, &looking);
    made.outlines = measure_outlines(cloud, first.tree, model, folder, &looking);
    if (made.leafy || made.outlines > 0) write_cloud(result.cloud, cloud, {}, &looking);
}

// The cloud that is there from the same, or a new one.
MadeCloud make_or_take_cloud(const std::string& folder, const std::string& out, const PhotosResult& result,
                             const MakeCloudOptions& options, Progress* progress) {
    RunStage stage(utf8_of(path_of(out) / "colmap" / "cloud.json"),
                   basis_of(folder, result.photos.model, options));
    std::error_code failure;
    if (stage.done() && std::filesystem::is_regular_file(path_of(result.cloud), failure))
        if (const std::optional<MadeCloud> made = read_note(stage.note())) return *made;
    stage.begin();
    SubProgress pointing(progress, 0.0, kPointsEnd), measuring(progress, kPointsEnd, 1.0);
    MadeCloud made = make_cloud(result.photos.model, folder, result.cloud, options, &pointing);
    if (made.pairs > 0) tell_more(result, folder, options.hold_out, made, &measuring);
    const json note = {{"points", made.points}, {"left_out", made.left_out}, {"pairs", made.pairs},
                       {"thin", made.thin},     {"cell", made.cell},         {"outlines", made.outlines},
                       {"leafy", made.leafy},   {"warnings", made.warnings}};
    stage.finish(note.dump(-1, ' ', false, json::error_handler_t::replace));
    return made;
}

// All that the cloud has, what was cleaned away of it too.
SeenThings things_of(const PhotosResult& result, Progress* progress) {
    const ScanFrame& frame = result.tree.tree.frame();
    const PointCloud cloud = read_cloud(result.cloud);
    if (progress) progress->check();
    SeenThings things{{}, result.made.cell * frame.metres_per_unit};
    things.places.reserve(cloud.size());
    for (const Vec3& position : cloud.positions)
        things.places.push_back(frame.to_tree(cloud.frame.to_scan(DVec3(position))));
    return things;
}

// That there is none is no reason for a tree to fail.
PhotoBark look_at_bark(const PhotosResult& result, size_t hold_out, Progress* progress) {
    PhotoBark none;
    none.why_not =
        "The photos were not matched pixel by pixel, so that it is not known what stands before the trunk.";
    if (result.made.pairs == 0) return none;
    try {
        const PhotoModel model = without_held_out(read_photo_model(result.photos.model, progress), hold_out);
        return bark_of_photos(result.tree.tree, model, result.photos_folder, things_of(result, progress), {},
                              progress);
    } catch (const Cancelled&) {
        throw;
    } catch (const Error& error) {
        none.why_not = error.what();
        return none;
    }
}

// The points of leaves, without what grows around the base, in the tree's frame.
std::vector<DVec3> leaf_places(const Reconstruction& tree) {
    std::vector<Vec3> points;
    for (size_t i = 0; i < tree.wood.size(); i++)
        if (!tree.wood[i]) points.push_back(tree.cloud.positions[i]);
    std::vector<uint8_t> outside(points.size(), 0);
    for (const int32_t i : points_outside(tree.foliage, points))
        outside[static_cast<size_t>(i)] = 1;
    std::vector<DVec3> places;
    for (size_t i = 0; i < points.size(); i++)
        if (!outside[i]) places.emplace_back(points[i]);
    return places;
}

// As look_at_bark().
LeafColours look_at_leaves(const PhotosResult& result, size_t hold_out, Progress* progress) {
    LeafColours none;
    none.why_not =
        "The photos were not matched pixel by pixel, so that it is not known where they show leaves.";
    if (result.made.pairs == 0) return none;
    try {
        const PhotoModel model = without_held_out(read_photo_model(result.photos.model, progress), hold_out);
        return leaf_colours_of_photos(leaf_places(result.tree), result.tree.tree.frame(), model,
                                      result.photos_folder, things_of(result, progress), {}, progress);
    } catch (const Cancelled&) {
        throw;
    } catch (const Error& error) {
        none.why_not = error.what();
        return none;
    }
}

// What the photos' printed markers are in the model.
MarkerScale ask_markers(const PhotosResult& result, const std::string& out, const PhotosOptions& options,
                        Progress* progress) {
    const PhotoModel model =
        without_held_out(read_photo_model(result.photos.model, progress), options.cloud.hold_out);
    const SeenMarkers seen = markers_of_photos(model, result.photos_folder,
                                               utf8_of(path_of(out) / "colmap" / "markers.json"), progress);
    MarkerScale scale = measure_markers(model, seen.photos, options.marker_side);
    scale.unreadable = seen.unreadable;
    return scale;
}

// The tree's size by what the user told, by markers or by GPS, the first of these that there is, and what is
// to be said of the others. told: the user has given a scale; tree: has the one that was taken.
std::vector<std::string> size_sentences(const PhotosResult& result, bool told) {
    std::vector<std::string> sentences;
    const MarkerScale& marker = result.marker;
    const GpsScale& gps = result.photos.gps;
    const double scale = result.tree.orient.metres_per_unit;
    if (const std::string sentence = marker_sentence(marker, told); !sentence.empty())
        sentences.push_back(sentence);
    if (!told && !result.sized_by_marker && gps.photos > 0)
        sentences.push_back(gps_sentence(gps, result.tree.measured.height));
    const auto compare = [&](const char* one, const char* other, double other_scale) {
        if (const std::string sentence = disagreement(one, scale, other, other_scale); !sentence.empty())
            sentences.push_back(sentence);
    };
    // What GPS may well be off by is no disagreement.
    const bool gps_differs =
        gps.usable() && std::abs(scale / gps.metres_per_unit - 1.0) > 2.0 * gps.relative_error;
    const double by_gps = gps_differs ? gps.metres_per_unit : 0.0;
    if (told) {
        compare("the size that was told", "the printed marker", marker.metres_per_unit());
        compare("the size that was told", "the photos' GPS", by_gps);
    } else if (result.sized_by_marker) {
        compare("the printed marker", "the photos' GPS", by_gps);
    }
    return sentences;
}

// Its pictures, or none: not those of another time either.
void write_bark(const std::optional<PhotoBark>& bark, const std::string& folder) {
    const bool made = bark && bark->textures;
    if (made) make_folder(folder);
    for (const auto& [name, picture] : std::initializer_list<std::pair<const char*, Image BarkTextures::*>>{
             {"albedo.png", &BarkTextures::albedo},
             {"normal.png", &BarkTextures::normal},
             {"roughness.png", &BarkTextures::roughness}}) {
        const std::filesystem::path path = path_of(folder) / name;
        std::error_code failure;
        if (!made) {
            std::filesystem::remove(path, failure);
            if (failure) throw Error("'" + utf8_of(path) + "', of another time, can't be deleted.");
            continue;
        }
        write_png(utf8_of(path), (*bark->textures).*picture);
    }
}

}  // namespace

MakeCloudOptions cloud_options_of(PhotoEffort effort) {
    MakeCloudOptions options;
    switch (effort) {
        case PhotoEffort::kQuick:
            options.densify = {.megapixels = 0.15, .neighbours = 2};
            options.thin_wood.most_pixels = 1200;
            break;
        case PhotoEffort::kBest:
            options.densify = {.megapixels = 0.6, .neighbours = 6};
            options.thin_wood.most_pixels = 3600;
            break;
        case PhotoEffort::kNormal:
            break;
    }
    return options;
}

PhotosResult reconstruct_photos(const std::string& photos, const std::string& out,
                                const PhotosOptions& options, Progress* progress) {
    PhotosResult result;
    std::string folder = photos;
    ColmapOptions colmap = options.colmap;
    std::vector<std::string> left_out;
    double begin = 0.0;
    if (const std::optional<std::string> film = film_of(photos)) {
        begin = kFilmEnd;
        SubProgress taking(progress, 0.0, kFilmEnd);
        folder = photos_of_film(*film, out, &taking).folder;
        // Frames are in the order of the walk.
        if (colmap.order == PhotoOrder::kAuto) colmap.order = PhotoOrder::kSequence;
    } else {
        SubProgress converting(progress, 0.0, kHeicEnd);
        const ReadablePhotos readable = readable_photos(photos, out, &converting);
        if (readable.converted > 0) begin = kHeicEnd;
        folder = readable.folder;
        left_out = readable.warnings;
    }
    SubProgress placing(progress, begin, kColmapEnd), marking(progress, kColmapEnd, kMarkersEnd),
        making(progress, kMarkersEnd, kCloudEnd), growing(progress, kCloudEnd, kTreeEnd),
        looking(progress, kTreeEnd, kBarkEnd), tinting(progress, kBarkEnd, 1.0);
    result.photos = run_colmap(folder, out, colmap, &placing);
    result.photos_folder = folder;
    result.photos.warnings.insert(result.photos.warnings.begin(), left_out.begin(), left_out.end());
    result.marker = ask_markers(result, out, options, &marking);
    making.update(0.0, "Cloud");
    result.cloud = utf8_of(path_of(out) / "cloud.ply");
    result.made = make_or_take_cloud(folder, out, result, options.cloud, &making);
    making.check();
    ReconstructOptions reconstruct = options.reconstruct;
    const GpsScale& gps = result.photos.gps;
    const OrientOptions& orient = reconstruct.orient;
    const bool has_scale = orient.metres_per_unit || orient.known_height || orient.known_length;
    result.sized_by_marker = !has_scale && result.marker.usable();
    result.sized_by_gps = !has_scale && !result.sized_by_marker && gps.usable();
    if (result.sized_by_marker) reconstruct.orient.metres_per_unit = result.marker.metres_per_unit();
    if (result.sized_by_gps) reconstruct.orient.metres_per_unit = gps.metres_per_unit;
    result.tree = reconstruct_file(result.cloud, reconstruct, &growing);
    for (const std::string& sentence : size_sentences(result, has_scale))
        result.tree.warnings.push_back(sentence);
    if (options.bark) result.bark = look_at_bark(result, options.cloud.hold_out, &looking);
    if (result.bark && !result.bark->textures)
        result.tree.warnings.push_back("The tree has drawn bark. " + result.bark->why_not);
    if (options.leaf_colours) result.leaf_colours = look_at_leaves(result, options.cloud.hold_out, &tinting);
    // Bare trees bear drawn leaves, too. Without dense points, the bark says why.
    if (result.leaf_colours && !result.leaf_colours->seen() && result.made.pairs > 0)
        result.tree.warnings.push_back("The leaves have drawn colors. " + result.leaf_colours->why_not);
    write_bark(result.bark, utf8_of(path_of(out) / "bark"));
    std::vector<std::string> before = result.photos.warnings;
    before.insert(before.end(), result.made.warnings.begin(), result.made.warnings.end());
    result.tree.warnings.insert(result.tree.warnings.begin(), before.begin(), before.end());
    return result;
}

}  // namespace treerec
