#include "tree_reconstructor/tree_reconstructor.h"

#include <algorithm>
#include <godot_cpp/classes/json.hpp>
#include <godot_cpp/classes/time.hpp>
#include <utility>

#include "error.h"
#include "exchange/tree_files.h"
#include "file_bytes.h"
#include "photos/marker_code.h"
#include "photos/marker_page.h"
#include "pipeline/export.h"
#include "pipeline/marker_file.h"
#include "pipeline/photos.h"
#include "pipeline/report.h"
#include "tree_reconstructor/reconstruct_options.h"
#include "tree_reconstructor/tree_reconstructor_job.h"

using namespace godot;

void TreeReconstructor::_report_progress(double p_fraction, const char* p_stage) {
    constexpr int64_t kSignalEveryMs = 30;
    const int64_t now = int64_t(Time::get_singleton()->get_ticks_msec());
    {
        const std::lock_guard lock(mutex_);
        const bool new_stage = stage_ != p_stage;
        fraction_ = p_fraction;
        if (new_stage) {
            stage_ = p_stage;
            count_ = Vector2i();
        }
        if (!new_stage && now - last_signal_ms_ < kSignalEveryMs) {
            return;
        }
        last_signal_ms_ = now;
    }
    call_deferred("emit_signal", "progress_changed", p_fraction, String::utf8(p_stage));
}

void TreeReconstructor::_report_count(size_t p_done, size_t p_all) {
    const std::lock_guard lock(mutex_);
    count_ = Vector2i(int32_t(p_done), int32_t(p_all));
}

void TreeReconstructor::_fail(const std::string& p_sentence) {
    const std::lock_guard lock(mutex_);
    error_message_ = p_sentence;
}

// What to reconstruct, and how.
struct TreeReconstructor::Task {
    ParsedOptions options;
    Dictionary provenance;  // its source is the scan
    std::function<treerec::Reconstruction(treerec::Progress*, treerec::ReportDetails&)> run;
};

static void fill_details(treerec::ReportDetails& r_details, const treerec::Reconstruction& p_result,
                         const ParsedOptions& p_options, const treerec::Progress& p_progress) {
    r_details.options = p_options.pipeline;
    r_details.leaves = treerec::chosen_leaves(to_std(p_options.leaves), p_result);
    r_details.seed = p_options.pipeline.skeleton.seed;
    treerec::ExportOptions look;
    look.leaves = treerec::suited_leaves(r_details.leaves, p_result);
    look.seed = r_details.seed;
    look.foliage = p_result.foliage;
    treerec::TreeExporter counter(p_result.tree, look, &p_progress);
    r_details.triangles = counter.triangles();
    r_details.leaf_count = counter.leaves();
}

Ref<TreeReconstruction> TreeReconstructor::_reconstruct(const std::function<Task(Listener&)>& p_begin) {
    constexpr double kReportBegins = 0.97;
    const Job job(this);
    ERR_FAIL_COND_V_MSG(!job.is_alone(), Ref<TreeReconstruction>(), BUSY);
    try {
        Listener listener(this);
        {
            const std::lock_guard lock(mutex_);
            report_json_.clear();
            result_ = std::make_shared<treerec::Reconstruction>();
            cloud_ = std::make_shared<treerec::PointCloud>();
            steps_.clear();
        }
        listener.check();
        Task task = p_begin(listener);
        treerec::SubProgress reconstructing(&listener, 0.0, kReportBegins);
        treerec::ReportDetails details;
        treerec::Reconstruction result = task.run(&reconstructing, details);
        listener.update(kReportBegins, "Reporting");
        details.scan_path = to_std(String(task.provenance["source"]));
        if (details.sized_by_gps || details.sized_by_marker) {
            // The cloud alone does not tell it when the tree is made again.
            Dictionary options = task.provenance["options"];
            options["scale"] = result.orient.metres_per_unit;
            task.provenance["options"] = options;
        }
        fill_details(details, result, task.options, listener);
        const std::string report = treerec::report_json(result, details);

        Ref<TreeReconstruction> made;
        made.instantiate();
        made->set_seed(int64_t(details.seed));
        made->set_leaf_preset(to_godot(details.leaves));
        made->set("leaf_size", treerec::suited_leaves(details.leaves, result).leaf_size);
        made->set_tree(result.tree);
        made->set_leaf_density(result.foliage);
        task.provenance["report"] = JSON::parse_string(to_godot(report));
        made->set_provenance(task.provenance);
        listener.check();

        const std::lock_guard lock(mutex_);
        report_json_ = report;
        steps_ = std::move(result.steps);
        voxel_ = result.voxel;
        result_ = std::make_shared<treerec::Reconstruction>(std::move(result));
        cloud_ = std::shared_ptr<const treerec::PointCloud>(result_, &result_->cloud);
        details_ = std::make_shared<treerec::ReportDetails>(details);
        fraction_ = 1.0;
        return made;
    } catch (const std::exception& error) {
        _fail(error.what());
        return Ref<TreeReconstruction>();
    }
}

Ref<TreeReconstruction> TreeReconstructor::reconstruct_file(const String& p_path,
                                                            const Dictionary& p_options) {
    return _reconstruct([&](Listener&) {
        Task task;
        task.options = parse_reconstruct_options(p_options);
        task.provenance["source"] = p_path;
        task.provenance["options"] = p_options.duplicate();
        const std::string path = file_path(p_path);
        task.run = [this, path, pipeline = task.options.pipeline](treerec::Progress* p_progress,
                                                                  treerec::ReportDetails&) {
            return treerec::reconstruct_file(path, pipeline, p_progress, &cache_);
        };
        return task;
    });
}

Ref<TreeReconstruction> TreeReconstructor::reconstruct_photos(const String& p_photos, const String& p_folder,
                                                              const Dictionary& p_options) {
    return _reconstruct([&](Listener&) {
        Task task;
        const ParsedPhotoOptions options = parse_photo_options(p_options);
        task.options = options.tree;
        task.provenance["source"] = p_folder.path_join("cloud.ply");
        task.provenance["options"] = options.of_tree;
        task.provenance["photos"] = p_photos;
        task.provenance["photo_options"] = options.of_photos;
        if (p_photos.is_empty() || p_folder.is_empty()) {
            throw treerec::Error(
                "reconstruct_photos() needs a folder of photos, and another one to work in.");
        }
        const std::string photos = file_path(p_photos), folder = file_path(p_folder);
        task.run = [photos, folder, pipeline = options.pipeline](treerec::Progress* p_progress,
                                                                 treerec::ReportDetails& r_details) {
            treerec::PhotosResult made = treerec::reconstruct_photos(photos, folder, pipeline, p_progress);
            r_details.photos = std::move(made.photos);
            r_details.photo_pairs = made.made.pairs;
            r_details.marker = std::move(made.marker);
            r_details.sized_by_marker = made.sized_by_marker;
            r_details.sized_by_gps = made.sized_by_gps;
            r_details.bark = std::move(made.bark);
            r_details.leaf_colours = std::move(made.leaf_colours);
            return std::move(made.tree);
        };
        return task;
    });
}

void TreeReconstructor::clear_cache() {
    const Job job(this);
    ERR_FAIL_COND_MSG(!job.is_alone(), BUSY);
    cache_ = {};
}

int64_t TreeReconstructor::get_cache_size() const {
    return cache_bytes_;
}

Ref<TreeReconstruction> TreeReconstructor::import_skeleton(const String& p_path, const String& p_up_axis,
                                                           int64_t p_tree_number,
                                                           LSystem::Dialect p_dialect) {
    const Job job(this);
    ERR_FAIL_COND_V_MSG(!job.is_alone(), Ref<TreeReconstruction>(), BUSY);
    Ref<TreeReconstruction> made;
    try {
        if (p_tree_number < 0) {
            throw treerec::Error("The number of a tree in a file is 1 or more, or 0 for the largest.");
        }
        treerec::SkeletonChoice choice(treerec::parse_up_axis(to_std(p_up_axis)), size_t(p_tree_number));
        const treerec::LStringOptions string = LSystem::read_options(p_dialect);
        if (string.dialect_is_told) {
            choice.dialect = string.dialect;
        }
        treerec::SkeletonReport report;
        treerec::Tree tree = treerec::read_skeleton(file_path(p_path), choice, &report);
        {
            const std::lock_guard lock(mutex_);
            report_json_ = treerec::skeleton_report_json(report);
        }
        made.instantiate();
        made->set_tree(std::move(tree));
        made->set_leaf_density(std::move(report.foliage));
        Dictionary provenance;
        provenance["source"] = p_path;
        made->set_provenance(provenance);
    } catch (const std::exception& error) {
        made.unref();
        _fail(error.what());
    }
    return made;
}

Error TreeReconstructor::export_file(const Ref<TreeReconstruction>& p_tree, const String& p_path,
                                     int p_levels, bool p_pictures_beside) {
    ERR_FAIL_COND_V_MSG(p_tree.is_null(), ERR_INVALID_PARAMETER, "There is no tree to export.");
    const Job job(this);
    ERR_FAIL_COND_V_MSG(!job.is_alone(), ERR_BUSY, BUSY);
    try {
        const Listener listener(this);
        listener.check();
        const std::shared_ptr<const treerec::Tree> tree = p_tree->get_tree();
        const std::shared_ptr<const treerec::GrownBark> bark = p_tree->get_bark_on(tree);
        treerec::export_tree(file_path(p_path), *tree, p_tree->get_leaf_rules(), uint64_t(p_tree->get_seed()),
                             to_std(p_tree->get_leaf_look()), &listener, *p_tree->get_leaf_density(),
                             p_levels, p_pictures_beside, bark.get());
        return OK;
    } catch (const std::exception& error) {
        _fail(error.what());
        return FAILED;
    }
}

Error TreeReconstructor::save_marker(const String& p_path, int64_t p_id, double p_side) {
    const Job job(this);
    ERR_FAIL_COND_V_MSG(!job.is_alone(), ERR_BUSY, BUSY);
    try {
        // No id that is none becomes one.
        const int id = p_id < 0 ? -1 : int(std::min<int64_t>(p_id, treerec::kMarkerCount));
        const std::string path = file_path(p_path);
        treerec::require_marker_format(path);
        treerec::require_writable(path);
        treerec::write_marker(path, id, p_side);
        return OK;
    } catch (const std::exception& error) {
        _fail(error.what());
        return FAILED;
    }
}

TypedArray<Dictionary> TreeReconstructor::get_option_list() {
    return list_reconstruct_options();
}

TypedArray<Dictionary> TreeReconstructor::get_photo_option_list() {
    return list_photo_options();
}

void TreeReconstructor::cancel() {
    cancelled_ = true;
}

double TreeReconstructor::get_progress() const {
    const std::lock_guard lock(mutex_);
    return fraction_;
}

String TreeReconstructor::get_stage() const {
    const std::lock_guard lock(mutex_);
    return to_godot(stage_);
}

Vector2i TreeReconstructor::get_stage_count() const {
    const std::lock_guard lock(mutex_);
    return count_;
}

String TreeReconstructor::get_error_message() const {
    const std::lock_guard lock(mutex_);
    return to_godot(error_message_);
}

String TreeReconstructor::get_report_json() const {
    const std::lock_guard lock(mutex_);
    return to_godot(report_json_);
}

Dictionary TreeReconstructor::get_report() const {
    const String text = get_report_json();
    return text.is_empty() ? Dictionary() : Dictionary(JSON::parse_string(text));
}

Ref<TreeReconstruction> TreeReconstructor::get_raw_skeleton() const {
    Ref<TreeReconstruction> skeleton;
    skeleton.instantiate();
    const std::lock_guard lock(mutex_);
    skeleton->set_tree(result_->raw);
    return skeleton;
}

void TreeReconstructor::_bind_methods() {
    ClassDB::bind_method(D_METHOD("reconstruct_file", "path", "options"),
                         &TreeReconstructor::reconstruct_file, DEFVAL(Dictionary()));
    ClassDB::bind_method(D_METHOD("reconstruct_photos", "photos", "folder", "options"),
                         &TreeReconstructor::reconstruct_photos, DEFVAL(Dictionary()));
    ClassDB::bind_method(D_METHOD("load_cloud", "tree", "maximum_points"), &TreeReconstructor::load_cloud,
                         DEFVAL(500000));
    ClassDB::bind_method(D_METHOD("save_cloud", "tree", "path"), &TreeReconstructor::save_cloud);
    ClassDB::bind_method(D_METHOD("clear_cache"), &TreeReconstructor::clear_cache);
    ClassDB::bind_method(D_METHOD("get_cache_size"), &TreeReconstructor::get_cache_size);
    ClassDB::bind_method(D_METHOD("import_skeleton", "path", "up_axis", "tree_number", "dialect"),
                         &TreeReconstructor::import_skeleton, DEFVAL("z"), DEFVAL(0),
                         DEFVAL(int(LSystem::DIALECT_TOLD)));
    ClassDB::bind_method(D_METHOD("export_file", "tree", "path", "levels", "pictures_beside"),
                         &TreeReconstructor::export_file, DEFVAL(1), DEFVAL(false));
    ClassDB::bind_method(D_METHOD("save_html_report", "path", "folders"),
                         &TreeReconstructor::save_html_report, DEFVAL(Dictionary()));
    ClassDB::bind_method(D_METHOD("save_marker", "path", "id", "side"), &TreeReconstructor::save_marker,
                         DEFVAL(0), DEFVAL(treerec::kUsualMarkerSide));
    ClassDB::bind_method(D_METHOD("grow_bark", "tree", "recipe", "recorded"), &TreeReconstructor::grow_bark,
                         DEFVAL(false));
    ClassDB::bind_method(D_METHOD("get_growth_frames"), &TreeReconstructor::get_growth_frames);
    ClassDB::bind_static_method("TreeReconstructor", D_METHOD("draw_grown_bark", "tree", "bark"),
                                &TreeReconstructor::draw_grown_bark);
    ClassDB::bind_method(D_METHOD("propose_growth", "tree", "points", "recipe"),
                         &TreeReconstructor::propose_growth, DEFVAL(""));
    ClassDB::bind_static_method("TreeReconstructor", D_METHOD("get_growth_presets"),
                                &TreeReconstructor::get_growth_presets);
    ClassDB::bind_static_method("TreeReconstructor", D_METHOD("scale_growth_preset", "name", "tree"),
                                &TreeReconstructor::scale_growth_preset);
    ClassDB::bind_method(D_METHOD("pick_bark", "tree", "from", "way", "longest"),
                         &TreeReconstructor::pick_bark, DEFVAL(0.035));
    ClassDB::bind_method(D_METHOD("find_bark", "tree", "recipe"), &TreeReconstructor::find_bark);
    ClassDB::bind_method(D_METHOD("sink_bark", "tree", "recipe"), &TreeReconstructor::sink_bark);
    ClassDB::bind_method(D_METHOD("lift_bark", "tree", "recipe"), &TreeReconstructor::lift_bark);
    ClassDB::bind_static_method("TreeReconstructor", D_METHOD("get_growth_commands"),
                                &TreeReconstructor::get_growth_commands);
    ClassDB::bind_method(D_METHOD("sketch_tree", "sketch", "twigs_of"), &TreeReconstructor::sketch_tree,
                         DEFVAL(Variant()));
    ClassDB::bind_method(D_METHOD("sketch_with_twigs", "sketch", "from", "title"),
                         &TreeReconstructor::sketch_with_twigs, DEFVAL(""));
    ClassDB::bind_method(D_METHOD("load_sketch", "path"), &TreeReconstructor::load_sketch);
    ClassDB::bind_method(D_METHOD("save_sketch", "sketch", "path"), &TreeReconstructor::save_sketch);
    for (const char* name : {"sketch_branch", "draw_limb"}) {  // the old word
        ClassDB::bind_method(D_METHOD(name, "tree", "camera", "stroke", "points", "options"),
                             &TreeReconstructor::sketch_branch, DEFVAL(PackedVector3Array()),
                             DEFVAL(Dictionary()));
    }
    ClassDB::bind_static_method("TreeReconstructor", D_METHOD("get_sketch_species"),
                                &TreeReconstructor::get_sketch_species);
    ClassDB::bind_static_method("TreeReconstructor", D_METHOD("get_option_list"),
                                &TreeReconstructor::get_option_list);
    ClassDB::bind_static_method("TreeReconstructor", D_METHOD("get_picture_gain", "pixels", "mean"),
                                &TreeReconstructor::get_picture_gain);
    ClassDB::bind_static_method("TreeReconstructor", D_METHOD("get_photo_option_list"),
                                &TreeReconstructor::get_photo_option_list);
    ClassDB::bind_static_method("TreeReconstructor",
                                D_METHOD("find_point", "points", "from", "way", "width", "spread"),
                                &TreeReconstructor::find_point, DEFVAL(0.0), DEFVAL(0.0));
    ClassDB::bind_method(D_METHOD("load_photo_views", "tree", "model"), &TreeReconstructor::load_photo_views,
                         DEFVAL(""));
    ClassDB::bind_method(D_METHOD("load_photo", "view", "folder", "longest"), &TreeReconstructor::load_photo,
                         DEFVAL(2560));
    ClassDB::bind_method(D_METHOD("load_outlines", "tree", "points", "folders"),
                         &TreeReconstructor::load_outlines, DEFVAL(Dictionary()));
    ClassDB::bind_method(D_METHOD("measure_outline", "tree", "leaves"), &TreeReconstructor::measure_outline,
                         DEFVAL(true));
    ClassDB::bind_method(D_METHOD("cancel"), &TreeReconstructor::cancel);
    ClassDB::bind_method(D_METHOD("get_progress"), &TreeReconstructor::get_progress);
    ClassDB::bind_method(D_METHOD("get_stage"), &TreeReconstructor::get_stage);
    ClassDB::bind_method(D_METHOD("get_stage_count"), &TreeReconstructor::get_stage_count);
    ClassDB::bind_method(D_METHOD("get_error_message"), &TreeReconstructor::get_error_message);
    ClassDB::bind_method(D_METHOD("get_report"), &TreeReconstructor::get_report);
    ClassDB::bind_method(D_METHOD("get_report_json"), &TreeReconstructor::get_report_json);
    ClassDB::bind_method(D_METHOD("get_cloud_points"), &TreeReconstructor::get_cloud_points);
    ClassDB::bind_method(D_METHOD("get_cloud_colors"), &TreeReconstructor::get_cloud_colors);
    ClassDB::bind_method(D_METHOD("get_raw_skeleton"), &TreeReconstructor::get_raw_skeleton);
    ClassDB::bind_method(D_METHOD("get_flood_step_count"), &TreeReconstructor::get_flood_step_count);
    ClassDB::bind_method(D_METHOD("get_flood_step", "index"), &TreeReconstructor::get_flood_step);
    ADD_SIGNAL(MethodInfo("progress_changed", PropertyInfo(Variant::FLOAT, "fraction"),
                          PropertyInfo(Variant::STRING, "stage")));
}
