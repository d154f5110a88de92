// Branches drawn over a scan.
#include <exception>
#include <godot_cpp/variant/packed_byte_array.hpp>
#include <godot_cpp/variant/packed_float32_array.hpp>
#include <godot_cpp/variant/packed_string_array.hpp>
#include <godot_cpp/variant/packed_vector2_array.hpp>
#include <memory>
#include <string>

#include "convert.h"
#include "error.h"
#include "sketch/sketch_branch.h"
#include "tree_reconstructor/scan_points.h"
#include "tree_reconstructor/tree_reconstructor.h"
#include "tree_reconstructor/tree_reconstructor_job.h"

using namespace godot;

namespace {

treerec::DVec3 to_core(const Vector3& p_vector) {
    return treerec::DVec3(p_vector.x, p_vector.y, p_vector.z);
}

// The entry of a camera. Throws treerec::Error where it is missing or of another type.
Variant camera_entry(const Dictionary& p_camera, const char* p_name, Variant::Type p_type,
                     Variant::Type p_other) {
    const Variant value = p_camera.get(p_name, Variant());
    if (value.get_type() != p_type && value.get_type() != p_other) {
        throw treerec::Error(std::string("The camera of a drawn branch has no \"") + p_name +
                             "\" as TreeReconstructor.sketch_branch() wants it: it has a transform, a focal "
                             "length and a size.");
    }
    return value;
}

treerec::PinholeView to_view(const Dictionary& p_camera) {
    const Transform3D pose = camera_entry(p_camera, "transform", Variant::TRANSFORM3D, Variant::TRANSFORM3D);
    const Vector2 size = camera_entry(p_camera, "size", Variant::VECTOR2I, Variant::VECTOR2);
    treerec::PinholeView view;
    for (int i = 0; i < 3; i++) {
        view.turn[i] = to_core(pose.basis.get_column(i));
    }
    view.centre = to_core(pose.origin);
    view.focal = camera_entry(p_camera, "focal", Variant::FLOAT, Variant::INT);
    // What is no number, or beyond any picture, becomes a size that the core refuses.
    const bool sized = size.x >= 1.0f && size.y >= 1.0f && size.x < 1e6f && size.y < 1e6f;
    view.width = sized ? int(size.x) : 0;
    view.height = sized ? int(size.y) : 0;
    view.principal = treerec::DVec2(0.5 * size.x, 0.5 * size.y);
    if (p_camera.has("principal")) {
        const Vector2 principal = camera_entry(p_camera, "principal", Variant::VECTOR2, Variant::VECTOR2I);
        view.principal = treerec::DVec2(principal.x, principal.y);
    }
    return view;
}

treerec::SketchedBranchOptions to_options(const Dictionary& p_options) {
    treerec::SketchedBranchOptions options;
    const Array names = p_options.keys();
    for (int64_t i = 0; i < names.size(); i++) {
        const std::string name = to_std(String(names[i]));
        const Variant value = p_options[names[i]];
        const Variant::Type type = value.get_type();
        const bool number = type == Variant::FLOAT || type == Variant::INT;
        if (name == "seed" && type == Variant::INT) {
            options.seed = uint64_t(int64_t(value));
        } else if (name == "twigs" && type == Variant::BOOL) {
            options.twigs = bool(value);
        } else if (name == "jitter" && number) {
            options.jitter = double(value);
        } else if (name == "tolerance" && number) {
            options.tolerance = double(value);
        } else if (name == "seed" || name == "twigs" || name == "jitter" || name == "tolerance") {
            throw treerec::Error("The option \"" + name +
                                 "\" of a drawn branch has a value of another type: seed is a whole number, "
                                 "twigs is true or false, jitter and tolerance are numbers.");
        } else {
            throw treerec::Error("There is no option \"" + name +
                                 "\"; a drawn branch knows seed, twigs, jitter and tolerance.");
        }
    }
    return options;
}

Dictionary describe(const treerec::SketchedBranch& p_branch) {
    PackedVector3Array axis;
    PackedFloat32Array radii;
    PackedByteArray shown;
    for (const treerec::BranchPlace& place : p_branch.axis) {
        axis.push_back(to_godot(place.position));
        radii.push_back(float(place.radius));
        shown.push_back(place.measured ? 1 : 0);
    }
    PackedStringArray remarks;
    for (const std::string& remark : p_branch.remarks) {
        remarks.push_back(to_godot(remark));
    }
    Dictionary told;
    told["command"] = to_godot(p_branch.command);
    told["host"] = int64_t(p_branch.host);
    told["axis"] = axis;
    told["radii"] = radii;
    told["shown"] = shown;
    told["length"] = p_branch.length;
    told["measured"] = p_branch.measured;
    told["twigs"] = int64_t(p_branch.twigs);
    told["remarks"] = remarks;
    return told;
}

}  // namespace

Dictionary TreeReconstructor::sketch_branch(const Ref<TreeReconstruction>& p_tree, const Dictionary& p_camera,
                                            const PackedVector2Array& p_stroke,
                                            const PackedVector3Array& p_points, const Dictionary& p_options) {
    ERR_FAIL_COND_V_MSG(p_tree.is_null(), Dictionary(), "There is no tree to hang a branch on.");
    const Job job(this);
    ERR_FAIL_COND_V_MSG(!job.is_alone(), Dictionary(), BUSY);
    try {
        Listener listener(this);
        listener.check();
        listener.update(0.0, "Branch");
        const std::shared_ptr<const treerec::Tree> tree = p_tree->get_tree();
        treerec::BranchStroke stroke;
        stroke.view = to_view(p_camera);
        stroke.points.reserve(size_t(p_stroke.size()));
        for (const Vector2& point : p_stroke) {
            stroke.points.emplace_back(point.x, point.y);
        }
        const treerec::SketchedBranchOptions options = to_options(p_options);
        const treerec::PointCloud cloud = to_cloud(tree->frame(), p_points);
        const treerec::SketchedBranch branch = treerec::sketch_branch(
            *tree, p_points.is_empty() ? nullptr : &cloud, stroke, options, {}, &listener);
        return describe(branch);
    } catch (const std::exception& error) {
        _fail(error.what());
        return Dictionary();
    }
}
