// Trees of strokes.
#include <exception>
#include <godot_cpp/classes/json.hpp>
#include <string>
#include <utility>

#include "convert.h"
#include "error.h"
#include "file_bytes.h"
#include "pipeline/sketch_report.h"
#include "sketch/read_sketch.h"
#include "sketch/sketch.h"
#include "sketch/species.h"
#include "tree_reconstructor.h"
#include "tree_reconstructor_job.h"

using namespace godot;

namespace {

treerec::Sketch to_sketch(const TreeSketch& p_sketch) {
    treerec::Sketch sketch;
    const Vector2 canvas = p_sketch.get_canvas_size();
    sketch.canvas = treerec::DVec2(canvas.x, canvas.y);
    sketch.species = to_std(p_sketch.get_species());
    sketch.height = p_sketch.get_height();
    sketch.seed = uint64_t(p_sketch.get_seed());
    const TypedArray<Dictionary> strokes = p_sketch.get_strokes();
    for (int64_t i = 0; i < strokes.size(); i++) {
        const Dictionary given = strokes[i];
        const PackedVector2Array points = given["points"];
        const PackedFloat32Array pressure = given["pressure"];
        treerec::Stroke stroke;
        stroke.id = uint32_t(int64_t(given["id"]));
        stroke.role = treerec::StrokeRole(int64_t(given["role"]));
        stroke.points.reserve(size_t(points.size()));
        for (int64_t k = 0; k < points.size(); k++) {
            stroke.points.emplace_back(points[k].x, points[k].y);
        }
        for (int64_t k = 0; k < pressure.size(); k++) {
            stroke.pressure.push_back(pressure[k]);
        }
        sketch.strokes.push_back(std::move(stroke));
    }
    return sketch;
}

Ref<TreeSketch> to_godot(const treerec::Sketch& p_sketch) {
    Ref<TreeSketch> made;
    made.instantiate();
    made->set_canvas_size(Vector2(float(p_sketch.canvas.x), float(p_sketch.canvas.y)));
    made->set_species(::to_godot(p_sketch.species));
    made->set_height(p_sketch.height);
    made->set_seed(int64_t(p_sketch.seed));
    TypedArray<Dictionary> strokes;
    for (const treerec::Stroke& stroke : p_sketch.strokes) {
        PackedVector2Array points;
        for (const treerec::DVec2& point : stroke.points) {
            points.push_back(Vector2(float(point.x), float(point.y)));
        }
        PackedFloat32Array pressure;
        for (const float value : stroke.pressure) {
            pressure.push_back(value);
        }
        Dictionary given;
        given["id"] = int64_t(stroke.id);
        given["role"] = int64_t(stroke.role);
        given["points"] = points;
        given["pressure"] = pressure;
        strokes.push_back(given);
    }
    made->set_strokes(strokes);
    return made;
}

}  // namespace

Ref<TreeReconstruction> TreeReconstructor::sketch_tree(const Ref<TreeSketch>& p_sketch) {
    ERR_FAIL_COND_V_MSG(p_sketch.is_null(), Ref<TreeReconstruction>(),
                        "There are no strokes: give a TreeSketch.");
    const Job job(this);
    ERR_FAIL_COND_V_MSG(!job.is_alone(), Ref<TreeReconstruction>(), BUSY);
    try {
        Listener listener(this);
        {
            const std::lock_guard lock(mutex_);
            report_json_.clear();
        }
        listener.check();
        const treerec::Sketch sketch = to_sketch(**p_sketch);
        treerec::SketchOptions options;
        options.depth = treerec::SketchDepth(p_sketch->get_depth());
        options.crown = treerec::SketchCrown(p_sketch->get_crown());
        options.trunk_radius = p_sketch->get_trunk_radius();
        options.density = p_sketch->get_density();
        treerec::SketchedTree sketched = treerec::sketch_tree(sketch, options, &listener);
        const std::string report = treerec::sketch_report_json(sketch, sketched);

        Ref<TreeReconstruction> made;
        made.instantiate();
        made->set_seed(p_sketch->get_seed());
        made->set_leaf_preset(::to_godot(sketched.species));
        made->set_tree(std::move(sketched.tree));
        Dictionary provenance;
        provenance["source"] = "sketch";
        // What is drawn on later is not what this tree was made of.
        provenance["sketch"] = p_sketch->duplicate();
        made->set_provenance(provenance);
        listener.check();

        const std::lock_guard lock(mutex_);
        report_json_ = report;
        fraction_ = 1.0;
        return made;
    } catch (const std::exception& error) {
        _fail(error.what());
        return Ref<TreeReconstruction>();
    }
}

Ref<TreeSketch> TreeReconstructor::load_sketch(const String& p_path) {
    const Job job(this);
    ERR_FAIL_COND_V_MSG(!job.is_alone(), Ref<TreeSketch>(), BUSY);
    try {
        return to_godot(treerec::read_sketch(file_path(p_path)));
    } catch (const std::exception& error) {
        _fail(error.what());
        return Ref<TreeSketch>();
    }
}

Error TreeReconstructor::save_sketch(const Ref<TreeSketch>& p_sketch, const String& p_path) {
    ERR_FAIL_COND_V_MSG(p_sketch.is_null(), ERR_INVALID_PARAMETER,
                        "There are no strokes: give a TreeSketch.");
    const Job job(this);
    ERR_FAIL_COND_V_MSG(!job.is_alone(), ERR_BUSY, BUSY);
    try {
        treerec::write_file(file_path(p_path), treerec::sketch_json(to_sketch(**p_sketch)));
        return OK;
    } catch (const std::exception& error) {
        _fail(error.what());
        return ERR_CANT_CREATE;
    }
}

TypedArray<Dictionary> TreeReconstructor::get_sketch_species() {
    TypedArray<Dictionary> list;
    for (const std::string& name : treerec::sketch_species_names()) {
        const treerec::SketchSpecies& species = treerec::sketch_species(name);
        Dictionary entry;
        entry["name"] = ::to_godot(species.name);
        entry["title"] = ::to_godot(species.title);
        entry["height"] = species.height;
        list.push_back(entry);
    }
    return list;
}
