#pragma once

#include <atomic>
#include <functional>
#include <godot_cpp/classes/ref_counted.hpp>
#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/variant/packed_color_array.hpp>
#include <godot_cpp/variant/packed_vector2_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>
#include <godot_cpp/variant/typed_array.hpp>
#include <godot_cpp/variant/vector2i.hpp>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "fidelity/photo_judge.h"
#include "growth/places.h"
#include "l_system.h"
#include "pipeline/reconstruct.h"
#include "pipeline/report.h"
#include "tree_reconstruction/tree_reconstruction.h"
#include "tree_sketch.h"

// Turns scans and photos into trees, in the editor. reconstruct_file(), reconstruct_photos(), load_cloud(),
// save_cloud(), load_photo_views(), load_photo(), load_outlines(), measure_outline(), import_skeleton(),
// export_file(), save_html_report(), save_marker(), sketch_tree(), sketch_with_twigs(), load_sketch(),
// save_sketch(), sketch_branch(), grow_bark() and propose_growth() may run on any thread, one at a time; the
// other methods may be called from any other thread meanwhile.
class TreeReconstructor : public godot::RefCounted {
    GDCLASS(TreeReconstructor, godot::RefCounted)

  public:
    godot::Ref<TreeReconstruction> reconstruct_file(const godot::String& p_path,
                                                    const godot::Dictionary& p_options);
    godot::Ref<TreeReconstruction> reconstruct_photos(const godot::String& p_photos,
                                                      const godot::String& p_folder,
                                                      const godot::Dictionary& p_options);
    bool load_cloud(const godot::Ref<TreeReconstruction>& p_tree, int64_t p_maximum_points);
    godot::Error save_cloud(const godot::Ref<TreeReconstruction>& p_tree, const godot::String& p_path);
    void clear_cache();
    int64_t get_cache_size() const;
    godot::Ref<TreeReconstruction> import_skeleton(const godot::String& p_path,
                                                   const godot::String& p_up_axis, int64_t p_tree_number,
                                                   LSystem::Dialect p_dialect);
    godot::Error export_file(const godot::Ref<TreeReconstruction>& p_tree, const godot::String& p_path,
                             int p_levels = 1, bool p_pictures_beside = false);
    // tree_reconstructor_growth.cpp
    godot::Ref<TreeReconstruction> grow_bark(const godot::Ref<TreeReconstruction>& p_tree,
                                             const godot::String& p_recipe, bool p_recorded = false);
    godot::TypedArray<godot::Dictionary> get_growth_frames() const;
    static godot::Array draw_grown_bark(const godot::Ref<TreeReconstruction>& p_tree,
                                        const godot::PackedByteArray& p_bark);
    godot::String propose_growth(const godot::Ref<TreeReconstruction>& p_tree,
                                 const godot::PackedVector3Array& p_points,
                                 const godot::String& p_recipe = "");
    static godot::TypedArray<godot::Dictionary> get_growth_commands();
    static godot::TypedArray<godot::Dictionary> get_growth_presets();
    static godot::String scale_growth_preset(const godot::String& p_name,
                                             const godot::Ref<TreeReconstruction>& p_tree);
    godot::Dictionary pick_bark(const godot::Ref<TreeReconstruction>& p_tree, const godot::Vector3& p_from,
                                const godot::Vector3& p_way, double p_longest = 0.035);
    godot::TypedArray<godot::Dictionary> find_bark(const godot::Ref<TreeReconstruction>& p_tree,
                                                   const godot::String& p_recipe);
    godot::Array sink_bark(const godot::Ref<TreeReconstruction>& p_tree, const godot::String& p_recipe);
    godot::Array lift_bark(const godot::Ref<TreeReconstruction>& p_tree, const godot::String& p_recipe);
    godot::Ref<TreeReconstruction> sketch_tree(const godot::Ref<TreeSketch>& p_sketch,
                                               const godot::Ref<godot::Resource>& p_twigs_of);
    godot::Ref<TreeSketch> sketch_with_twigs(const godot::Ref<TreeSketch>& p_sketch,
                                             const godot::Ref<godot::Resource>& p_from,
                                             const godot::String& p_title);
    godot::Ref<TreeSketch> load_sketch(const godot::String& p_path);
    godot::Error save_sketch(const godot::Ref<TreeSketch>& p_sketch, const godot::String& p_path);
    static godot::TypedArray<godot::Dictionary> get_sketch_species();
    godot::Dictionary sketch_branch(const godot::Ref<TreeReconstruction>& p_tree,
                                    const godot::Dictionary& p_camera,
                                    const godot::PackedVector2Array& p_stroke,
                                    const godot::PackedVector3Array& p_points = godot::PackedVector3Array(),
                                    const godot::Dictionary& p_options = godot::Dictionary());
    godot::Error save_html_report(const godot::String& p_path,
                                  const godot::Dictionary& p_folders = godot::Dictionary());
    godot::Error save_marker(const godot::String& p_path, int64_t p_id, double p_side);
    godot::TypedArray<godot::Dictionary> load_photo_views(const godot::Ref<TreeReconstruction>& p_tree,
                                                          const godot::String& p_model = "");
    godot::Dictionary load_photo(const godot::Dictionary& p_view, const godot::String& p_folder,
                                 int64_t p_longest = 2560);
    godot::Dictionary load_outlines(const godot::Ref<TreeReconstruction>& p_tree,
                                    const godot::PackedVector3Array& p_points,
                                    const godot::Dictionary& p_folders);
    godot::Dictionary measure_outline(const godot::Ref<TreeReconstruction>& p_tree, bool p_leaves = true);
    static godot::TypedArray<godot::Dictionary> get_option_list();
    static godot::Vector3 get_picture_gain(const godot::PackedByteArray& p_pixels,
                                           const godot::Vector3& p_mean);
    static godot::TypedArray<godot::Dictionary> get_photo_option_list();

    static int64_t find_point(const godot::PackedVector3Array& p_points, const godot::Vector3& p_from,
                              const godot::Vector3& p_way, double p_width, double p_spread);

    void cancel();
    double get_progress() const;
    godot::String get_stage() const;
    godot::Vector2i get_stage_count() const;
    godot::String get_error_message() const;
    godot::Dictionary get_report() const;
    godot::String get_report_json() const;
    godot::PackedVector3Array get_cloud_points() const;
    godot::PackedColorArray get_cloud_colors() const;
    godot::Ref<TreeReconstruction> get_raw_skeleton() const;
    int64_t get_flood_step_count() const;
    godot::Dictionary get_flood_step(int64_t p_index) const;

  protected:
    static void _bind_methods();

  private:
    class Listener;
    class Job;

    struct Task;
    godot::Ref<TreeReconstruction> _reconstruct(const std::function<Task(Listener&)>& p_begin);
    const treerec::BarkPlaces& _places_of(const std::shared_ptr<const treerec::Tree>& p_tree,
                                          double p_longest, double p_shortest);
    void _report_progress(double p_fraction, const char* p_stage);
    void _report_count(size_t p_done, size_t p_all);
    void _fail(const std::string& p_sentence);

    // What the last reconstruct_file() read and cleaned; the running job's alone.
    treerec::ReconstructCache cache_;
    std::atomic<int64_t> cache_bytes_ = 0;

    // Of the main thread alone: what pick_bark(), find_bark() and lift_bark() looked at last.
    std::weak_ptr<const treerec::Tree> places_tree_;
    double places_longest_ = 0.0, places_shortest_ = 0.0;
    std::optional<treerec::BarkPlaces> places_;

    std::atomic<bool> running_ = false;
    std::atomic<bool> cancelled_ = false;

    // Guards all that follows.
    mutable std::mutex mutex_;
    double fraction_ = 0.0;
    std::string stage_;
    godot::TypedArray<godot::Dictionary> growth_frames_;
    godot::Vector2i count_;  // of what the stage goes through, done and in all; 0 where it does not tell
    std::string error_message_;
    std::string report_json_;
    // Of the last reconstruct_file() or reconstruct_photos() that made a tree; both never null.
    std::shared_ptr<const treerec::Reconstruction> result_ = std::make_shared<treerec::Reconstruction>();
    std::shared_ptr<const treerec::ReportDetails> details_ = std::make_shared<treerec::ReportDetails>();
    // Of the last reconstruct_file() or load_cloud(); never null.
    std::shared_ptr<const treerec::PointCloud> cloud_ = std::make_shared<treerec::PointCloud>();
    // Of the last load_outlines(); may be null.
    std::shared_ptr<const treerec::PhotoJudge> judge_;
    std::vector<treerec::FloodStep> steps_;
    double voxel_ = 0.0;
    int64_t last_signal_ms_ = 0;
};
