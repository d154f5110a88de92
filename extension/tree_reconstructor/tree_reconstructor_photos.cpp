// What TreeReconstructor tells of the photos that a tree was made of.
#include <algorithm>
#include <cstring>
#include <exception>
#include <godot_cpp/variant/packed_byte_array.hpp>
#include <godot_cpp/variant/packed_float64_array.hpp>
#include <string>
#include <utility>
#include <vector>

#include "convert.h"
#include "error.h"
#include "file_bytes.h"
#include "photos/leaf_look.h"
#include "photos/pinhole_view.h"
#include "photos/shown_photo.h"
#include "tree_reconstructor/tree_reconstructor.h"
#include "tree_reconstructor/tree_reconstructor_job.h"
#include "tree_reconstructor/tree_reconstructor_photos.h"

using namespace godot;

static Dictionary to_dictionary(const treerec::Photo& p_photo, const treerec::Camera& p_camera,
                                const treerec::PinholeView& p_view) {
    const Basis turn(to_godot(p_view.turn[0]), to_godot(p_view.turn[1]), to_godot(p_view.turn[2]));
    PackedFloat64Array parameters;
    for (const double parameter : p_camera.parameters) {
        parameters.push_back(parameter);
    }
    Dictionary view;
    view["name"] = to_godot(p_photo.name);
    view["transform"] = Transform3D(turn, to_godot(p_view.centre));
    view["focal"] = p_view.focal;
    view["principal"] = Vector2(float(p_view.principal.x), float(p_view.principal.y));
    view["size"] = Vector2i(p_view.width, p_view.height);
    view["lens"] = int(p_camera.model);
    view["lens_parameters"] = parameters;
    return view;
}

// That of load_photo_views(); but a script may hand in anything.
static treerec::Camera to_camera(const Dictionary& p_view, const std::string& p_name) {
    const PackedFloat64Array parameters = p_view.get("lens_parameters", PackedFloat64Array());
    const Vector2i size = p_view.get("size", Vector2i());
    std::vector<double> values;
    for (int64_t i = 0; i < parameters.size(); i++) {
        values.push_back(parameters[i]);
    }
    return treerec::checked_camera(int64_t(p_view.get("lens", -1)), size.x, size.y, values, p_name);
}

TypedArray<Dictionary> TreeReconstructor::load_photo_views(const Ref<TreeReconstruction>& p_tree,
                                                           const String& p_model) {
    TypedArray<Dictionary> views;
    ERR_FAIL_COND_V_MSG(p_tree.is_null(), views, "There is no tree whose photos could be found.");
    const Job job(this);
    ERR_FAIL_COND_V_MSG(!job.is_alone(), views, BUSY);
    try {
        Listener listener(this);
        listener.check();
        listener.update(0.0, "Cameras");
        const treerec::ScanFrame frame = p_tree->get_tree()->frame();
        const std::string folder = find_photo_model(**p_tree, p_model);
        const treerec::PhotoModel model = treerec::read_photo_model(folder, &listener);
        if (model.photos.empty()) {
            throw treerec::Error("The COLMAP model in '" + folder + "' has no photos.");
        }
        TypedArray<Dictionary> found;
        for (const treerec::Photo& photo : model.photos) {
            const treerec::Camera& camera = model.cameras[size_t(photo.camera)];
            found.push_back(to_dictionary(photo, camera, treerec::pinhole_view(photo, camera, frame)));
        }
        listener.update(1.0, "Cameras");
        views = found;
    } catch (const std::exception& error) {
        _fail(error.what());
    }
    return views;
}

Dictionary TreeReconstructor::load_photo(const Dictionary& p_view, const String& p_folder,
                                         int64_t p_longest) {
    constexpr int64_t kLongest = 16384;  // what graphics cards take
    Dictionary picture;
    const Job job(this);
    ERR_FAIL_COND_V_MSG(!job.is_alone(), picture, BUSY);
    try {
        Listener listener(this);
        listener.check();
        listener.update(0.0, "Photos");
        const std::string name = to_std(String(p_view.get("name", "")));
        const treerec::Camera camera = to_camera(p_view, name);
        // Where it was taken from makes no difference.
        treerec::Photo photo;
        photo.name = name;
        const treerec::PinholeView whole = treerec::pinhole_view(photo, camera, {});
        const treerec::PinholeView view =
            treerec::fitted(whole, int(std::clamp<int64_t>(p_longest, 1, kLongest)));
        const std::string path =
            treerec::utf8_of(treerec::path_of(file_path(p_folder)) / treerec::path_of(name));
        const treerec::Image seen = treerec::shown_photo(path, camera, view, &listener);
        PackedByteArray pixels;
        pixels.resize(int64_t(seen.pixels.size()));
        std::memcpy(pixels.ptrw(), seen.pixels.data(), seen.pixels.size());
        picture["size"] = Vector2i(seen.width, seen.height);
        picture["scale"] = view.focal / whole.focal;
        picture["pixels"] = pixels;
        listener.update(1.0, "Photos");
    } catch (const std::exception& error) {
        picture = Dictionary();
        _fail(error.what());
    }
    return picture;
}

Vector3 TreeReconstructor::get_picture_gain(const PackedByteArray& p_pixels, const Vector3& p_mean) {
    ERR_FAIL_COND_V_MSG(p_pixels.is_empty() || p_pixels.size() % 4 != 0, Vector3(1, 1, 1),
                        "A picture's pixels are four bytes each: red, green, blue and alpha.");
    ERR_FAIL_COND_V_MSG(!p_mean.is_finite(), Vector3(1, 1, 1), "The mean must be finite.");
    treerec::Image picture(int(p_pixels.size() / 4), 1, 4);
    std::memcpy(picture.pixels.data(), p_pixels.ptr(), picture.pixels.size());
    return to_godot(treerec::picture_gain(picture, treerec::DVec3(p_mean.x, p_mean.y, p_mean.z)));
}
