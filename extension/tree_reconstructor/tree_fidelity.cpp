#include "tree_reconstructor/tree_fidelity.h"

#include <cmath>
#include <godot_cpp/classes/array_mesh.hpp>
#include <godot_cpp/classes/project_settings.hpp>
#include <godot_cpp/variant/packed_float32_array.hpp>
#include <godot_cpp/variant/packed_int32_array.hpp>
#include <utility>

#include "completion/unexplained.h"
#include "convert.h"
#include "error.h"
#include "fidelity/doubtful.h"
#include "fidelity/picture.h"
#include "mesh/branch_tubes.h"
#include "tree/branches.h"
#include "tree_reconstructor/scan_points.h"

using namespace godot;

static String file_path(const String& p_path) {
    return ProjectSettings::get_singleton()->globalize_path(p_path);
}

static Dictionary to_dictionary(const treerec::FidelityPart& p_part) {
    Dictionary part;
    part["points"] = int64_t(p_part.points);
    part["explained"] = p_part.explained;
    part["median"] = p_part.median;
    part["p95"] = p_part.p95;
    part["mean"] = p_part.mean;
    part["length"] = p_part.length;
    part["bark"] = p_part.bark;
    part["coverage"] = p_part.coverage;
    return part;
}

static Dictionary to_dictionary(const treerec::Fidelity& p_fidelity) {
    Dictionary result = to_dictionary(p_fidelity.all);
    result["tolerance"] = p_fidelity.tolerance;
    result["skeleton"] = p_fidelity.skeleton;
    result["skeleton_strict"] = p_fidelity.skeleton_strict;
    TypedArray<Dictionary> orders;
    for (const treerec::FidelityPart& part : p_fidelity.by_order) {
        orders.push_back(to_dictionary(part));
    }
    result["orders"] = orders;
    return result;
}

static Color to_color(const treerec::Rgb& p_color) {
    return Color(float(p_color[0]) / 255.0f, float(p_color[1]) / 255.0f, float(p_color[2]) / 255.0f);
}

Dictionary TreeReconstruction::measure_fidelity(const PackedVector3Array& p_points,
                                                double p_tolerance) const {
    return guarded(Dictionary(), [&] {
        const std::shared_ptr<const treerec::Tree> tree = get_tree();
        treerec::FidelityOptions options;
        options.tolerance = p_tolerance;
        return to_dictionary(treerec::measure_fidelity(*tree, to_cloud(tree->frame(), p_points), options));
    });
}

bool TreeFidelity::set_cloud(const Ref<TreeReconstruction>& p_tree, const PackedVector3Array& p_points,
                             double p_tolerance) {
    ERR_FAIL_COND_V_MSG(p_tree.is_null(), false, "There is no tree to tell where the cloud lies.");
    return guarded(false, [&] {
        treerec::FidelityOptions options;
        options.tolerance = p_tolerance;
        treerec::PointCloud cloud = to_cloud(p_tree->get_tree()->frame(), p_points);
        auto tracker = std::make_unique<treerec::FidelityTracker>(cloud, options);
        const std::lock_guard lock(mutex_);
        cloud_ = std::move(cloud);
        options_ = options;
        tracker_ = std::move(tracker);
        tree_.reset();
        return true;
    });
}

Dictionary TreeFidelity::update(const Ref<TreeReconstruction>& p_tree) {
    ERR_FAIL_COND_V_MSG(p_tree.is_null(), Dictionary(), "There is no tree to measure.");
    const std::lock_guard lock(mutex_);
    return guarded(Dictionary(), [&] {
        if (!tracker_) {
            throw treerec::Error("There is no cloud to measure the tree against; call set_cloud() first.");
        }
        std::shared_ptr<const treerec::Tree> tree = p_tree->get_tree();
        Dictionary result = to_dictionary(tracker_->update(*tree));
        tree_ = std::move(tree);
        return result;
    });
}

const treerec::Fidelity& TreeFidelity::_current() const {
    if (!tree_) {
        throw treerec::Error("Nothing has been measured yet; call update() first.");
    }
    return tracker_->current();
}

Dictionary TreeFidelity::get_current() const {
    const std::lock_guard lock(mutex_);
    return tree_ ? to_dictionary(tracker_->current()) : Dictionary();
}

Dictionary TreeFidelity::get_previous() const {
    const std::lock_guard lock(mutex_);
    return tree_ && tracker_->previous() ? to_dictionary(*tracker_->previous()) : Dictionary();
}

int64_t TreeFidelity::get_points_measured() const {
    const std::lock_guard lock(mutex_);
    return tree_ ? int64_t(tracker_->points_measured()) : 0;
}

PackedFloat32Array TreeFidelity::get_point_errors() const {
    const std::lock_guard lock(mutex_);
    return guarded(PackedFloat32Array(), [&] { return to_godot(_current().point_error); });
}

PackedInt32Array TreeFidelity::get_point_nodes() const {
    const std::lock_guard lock(mutex_);
    return guarded(PackedInt32Array(), [&] { return to_godot(_current().point_node); });
}

PackedColorArray TreeFidelity::get_point_colors() const {
    const std::lock_guard lock(mutex_);
    return guarded(PackedColorArray(), [&] {
        const std::vector<float>& errors = _current().point_error;
        PackedColorArray colors;
        colors.resize(int64_t(errors.size()));
        Color* write = colors.ptrw();
        for (const float error : errors) {
            *write++ = to_color(treerec::heat_color(std::abs(double(error)), options_.tolerance));
        }
        return colors;
    });
}

PackedFloat32Array TreeFidelity::get_node_errors() const {
    const std::lock_guard lock(mutex_);
    return guarded(PackedFloat32Array(), [&] {
        const treerec::Fidelity& fidelity = _current();
        PackedFloat32Array errors;
        for (const treerec::NodeId id : tree_->depth_first()) {
            errors.push_back(fidelity.node_points[size_t(id)] > 0 ? fidelity.node_error[size_t(id)] : -1.0f);
        }
        return errors;
    });
}

PackedColorArray TreeFidelity::get_node_colors() const {
    const std::lock_guard lock(mutex_);
    return guarded(PackedColorArray(), [&] {
        const treerec::Fidelity& fidelity = _current();
        PackedColorArray colors;
        for (const treerec::NodeId id : tree_->depth_first()) {
            const double error = fidelity.node_error[size_t(id)];
            colors.push_back(fidelity.node_points[size_t(id)] > 0
                                 ? to_color(treerec::heat_color(error, options_.tolerance))
                                 : to_color(treerec::kUnseenWood));
        }
        return colors;
    });
}

Array TreeFidelity::build_heat_mesh_arrays(int p_lod) const {
    ERR_FAIL_COND_V_MSG(p_lod < 0, Array(),
                        vformat("There is no level of detail %d; 0 is the finest.", p_lod));
    const std::lock_guard lock(mutex_);
    return guarded(Array(), [&] {
        const treerec::Fidelity& fidelity = _current();
        treerec::TubeOptions options;
        options.level = p_lod;
        const treerec::Mesh bark = treerec::build_branch_tubes(*tree_, options);
        PackedColorArray colors;
        for (const treerec::Rgb& color : treerec::bark_heat(*tree_, fidelity, bark)) {
            colors.push_back(to_color(color));
        }
        Array arrays = to_surface_arrays(bark);
        arrays[Mesh::ARRAY_COLOR] = colors;
        return arrays;
    });
}

TypedArray<Dictionary> TreeFidelity::get_branches() const {
    const std::lock_guard lock(mutex_);
    return guarded(TypedArray<Dictionary>(), [&] {
        const treerec::Fidelity& fidelity = _current();
        const treerec::BranchList list = treerec::list_branches(*tree_);
        TypedArray<Dictionary> result;
        for (size_t i = 0; i < list.branches.size(); i++) {
            const treerec::Branch& branch = list.branches[i];
            Dictionary entry = to_dictionary(fidelity.branches[i]);
            entry["node"] = list.nodes_of(branch).front();
            entry["order"] = branch.order;
            result.push_back(entry);
        }
        return result;
    });
}

TypedArray<Dictionary> TreeFidelity::get_levels(int p_count) const {
    ERR_FAIL_COND_V_MSG(p_count < 1 || p_count > 12, TypedArray<Dictionary>(),
                        vformat("There are 1 to 12 levels of detail, not %d.", p_count));
    const std::lock_guard lock(mutex_);
    return guarded(TypedArray<Dictionary>(), [&] {
        _current();
        TypedArray<Dictionary> result;
        for (const treerec::LevelFidelity& level :
             treerec::measure_levels(*tree_, cloud_, p_count, options_)) {
            Dictionary entry = to_dictionary(level.all);
            entry["nodes"] = int64_t(level.nodes);
            entry["skeleton"] = level.skeleton;
            result.push_back(entry);
        }
        return result;
    });
}

TypedArray<Dictionary> TreeFidelity::get_unexplained() const {
    const std::lock_guard lock(mutex_);
    return guarded(TypedArray<Dictionary>(), [&] {
        TypedArray<Dictionary> result;
        for (const treerec::UnexplainedCluster& cluster :
             treerec::find_unexplained(*tree_, cloud_, _current())) {
            std::vector<treerec::NodeId> points(cluster.points.begin(), cluster.points.end());
            Dictionary entry;
            entry["points"] = to_godot(points);
            entry["center"] = to_godot(cluster.centre);
            entry["size"] = cluster.size;
            entry["joint"] = cluster.joint;
            entry["gap"] = cluster.gap;
            entry["direction"] = to_godot(cluster.direction);
            result.push_back(entry);
        }
        return result;
    });
}

TypedArray<Dictionary> TreeFidelity::get_doubtful() const {
    const std::lock_guard lock(mutex_);
    return guarded(TypedArray<Dictionary>(), [&] {
        const treerec::Fidelity& fidelity = _current();
        TypedArray<Dictionary> result;
        for (const treerec::DoubtfulBranch& branch : treerec::find_doubtful(*tree_, fidelity)) {
            Dictionary entry;
            entry["node"] = branch.node;
            entry["attach"] = branch.attach;
            entry["reasons"] = to_godot(treerec::doubt_text(branch.reasons));
            entry["doubt"] = branch.doubt;
            entry["length"] = branch.length;
            entry["points"] = int64_t(branch.points);
            entry["bridged"] = branch.bridged;
            entry["angle"] = branch.angle;
            result.push_back(entry);
        }
        return result;
    });
}

TypedArray<Dictionary> list_hits(const treerec::PhotoFidelity& p_found) {
    TypedArray<Dictionary> photos;
    for (const treerec::PhotoHits& photo : p_found.photos) {
        Dictionary entry;
        entry["name"] = to_godot(photo.name);
        entry["inside"] = int64_t(photo.inside);
        entry["outside"] = int64_t(photo.outside);
        photos.push_back(entry);
    }
    return photos;
}

Dictionary TreeFidelity::measure_photos(const String& p_model, const String& p_masks) const {
    const std::lock_guard lock(mutex_);
    return guarded(Dictionary(), [&] {
        const treerec::Fidelity& fidelity = _current();
        const treerec::PhotoFidelity found =
            treerec::measure_photos(cloud_, to_std(file_path(p_model)), to_std(file_path(p_masks)));
        Dictionary result;
        result["information"] = found.information;
        result["reconstruction"] = found.reconstruction;
        result["skeleton"] = fidelity.skeleton;
        result["fidelity"] = treerec::modelling_fidelity(found, fidelity);
        result["photos"] = list_hits(found);
        return result;
    });
}

void TreeFidelity::_bind_methods() {
    ClassDB::bind_method(D_METHOD("set_cloud", "tree", "points", "tolerance"), &TreeFidelity::set_cloud,
                         DEFVAL(0.02));
    ClassDB::bind_method(D_METHOD("update", "tree"), &TreeFidelity::update);
    ClassDB::bind_method(D_METHOD("get_current"), &TreeFidelity::get_current);
    ClassDB::bind_method(D_METHOD("get_previous"), &TreeFidelity::get_previous);
    ClassDB::bind_method(D_METHOD("get_points_measured"), &TreeFidelity::get_points_measured);
    ClassDB::bind_method(D_METHOD("get_point_errors"), &TreeFidelity::get_point_errors);
    ClassDB::bind_method(D_METHOD("get_point_nodes"), &TreeFidelity::get_point_nodes);
    ClassDB::bind_method(D_METHOD("get_point_colors"), &TreeFidelity::get_point_colors);
    ClassDB::bind_method(D_METHOD("get_node_errors"), &TreeFidelity::get_node_errors);
    ClassDB::bind_method(D_METHOD("get_node_colors"), &TreeFidelity::get_node_colors);
    ClassDB::bind_method(D_METHOD("build_heat_mesh_arrays", "lod"), &TreeFidelity::build_heat_mesh_arrays,
                         DEFVAL(0));
    ClassDB::bind_method(D_METHOD("get_branches"), &TreeFidelity::get_branches);
    ClassDB::bind_method(D_METHOD("get_levels", "count"), &TreeFidelity::get_levels, DEFVAL(4));
    ClassDB::bind_method(D_METHOD("get_unexplained"), &TreeFidelity::get_unexplained);
    ClassDB::bind_method(D_METHOD("get_doubtful"), &TreeFidelity::get_doubtful);
    ClassDB::bind_method(D_METHOD("measure_photos", "model", "masks"), &TreeFidelity::measure_photos);
}
