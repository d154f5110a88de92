// Trees of strokes.
#include <exception>
#include <godot_cpp/classes/json.hpp>
#include <memory>
#include <string>
#include <utility>

#include "convert.h"
#include "error.h"
#include "file_bytes.h"
#include "pipeline/sketch_report.h"
#include "sketch/read_sketch.h"
#include "sketch/read_twigs.h"
#include "sketch/sketch.h"
#include "sketch/species.h"
#include "sketch/twig_stock.h"
#include "tree_reconstructor/tree_reconstructor.h"
#include "tree_reconstructor/tree_reconstructor_job.h"

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
    if (!p_sketch.get_twigs().is_empty()) {
        sketch.twigs = std::make_shared<const treerec::TwigStock>(
            treerec::parse_twig_stock(to_std(p_sketch.get_twigs()), "The sketch's own twigs"));
    }
    return sketch;
}

treerec::SketchOptions to_options(const TreeSketch& p_sketch) {
    treerec::SketchOptions options;
    options.depth = treerec::SketchDepth(p_sketch.get_depth());
    options.crown = treerec::SketchCrown(p_sketch.get_crown());
    options.trunk_radius = p_sketch.get_trunk_radius();
    options.density = p_sketch.get_density();
    if (p_sketch.get_leaf_rule().is_valid()) {
        // What it looks like in winter is no matter of its wood.
        options.leaves = p_sketch.get_leaf_rule()->get_plain_rules();
    }
    return options;
}

// The twigs of a library, which is a script's resource.
treerec::TwigStock library_stock(const Ref<Resource>& p_library, const std::string& p_title) {
    const Variant listed = p_library->get("twigs");
    if (listed.get_type() != Variant::ARRAY) {
        throw treerec::Error("This has no twigs: give a TwigLibrary or a TreeReconstruction.");
    }
    const Array twigs = listed;
    std::vector<std::string> strings;
    for (int64_t i = 0; i < twigs.size(); i++) {
        const Ref<Resource> twig = twigs[i];
        if (twig.is_null()) {
            continue;
        }
        const std::string string = to_std(twig->get("lstring"));
        const Variant dialect = twig->get("dialect");
        strings.push_back(
            treerec::with_dialect(string, dialect.get_type() == Variant::INT ? int(int64_t(dialect)) : -1));
    }
    return treerec::stock_of_twigs(strings, p_title);
}

// A copy of the sketch with these twigs. Throws treerec::Error.
Ref<TreeSketch> with_twigs(const Ref<TreeSketch>& p_sketch, const Ref<Resource>& p_from,
                           const String& p_title) {
    const String file = p_from->get_path().contains("::") ? String() : p_from->get_path();
    const String name = !p_title.is_empty()              ? p_title
                        : !p_from->get_name().is_empty() ? p_from->get_name()
                                                         : file.get_file().get_basename();
    const Ref<TreeSketch> copy = p_sketch->duplicate();
    const TreeReconstruction* tree = Object::cast_to<TreeReconstruction>(p_from.ptr());
    if (tree) {
        const std::shared_ptr<const treerec::Tree> wood = tree->get_tree();
        copy->set_twigs(::to_godot(treerec::twig_stock_json(treerec::stock_of_tree(*wood, to_std(name)))));
        const LeafSetting setting = tree->get_leaf_setting();
        copy->set_species(setting.preset);
        copy->set_leaf_rule(setting.rule.is_valid() ? Ref<LeafRule>(setting.rule->duplicate())
                                                    : Ref<LeafRule>());
    } else {
        copy->set_twigs(::to_godot(treerec::twig_stock_json(library_stock(p_from, to_std(name)))));
    }
    return copy;
}

Ref<TreeSketch> to_godot(const treerec::Sketch& p_sketch, const treerec::SketchOptions& p_options) {
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
    made->set_depth(TreeSketch::Depth(p_options.depth));
    made->set_crown(TreeSketch::Crown(p_options.crown));
    made->set_trunk_radius(p_options.trunk_radius);
    made->set_density(p_options.density);
    if (p_sketch.twigs) {
        made->set_twigs(::to_godot(treerec::twig_stock_json(*p_sketch.twigs)));
    }
    return made;
}

}  // namespace

Ref<TreeReconstruction> TreeReconstructor::sketch_tree(const Ref<TreeSketch>& p_sketch,
                                                       const Ref<Resource>& p_twigs_of) {
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
        // What is drawn on later is not what this tree was made of.
        const Ref<TreeSketch> own = p_twigs_of.is_valid() ? with_twigs(p_sketch, p_twigs_of, String())
                                                          : Ref<TreeSketch>(p_sketch->duplicate());
        const treerec::Sketch sketch = to_sketch(**own);
        treerec::SketchedTree sketched = treerec::sketch_tree(sketch, to_options(**own), &listener);
        const std::string report = treerec::sketch_report_json(sketch, sketched);

        Ref<TreeReconstruction> made;
        made.instantiate();
        made->set_seed(own->get_seed());
        made->set_leaf_preset(::to_godot(sketched.species));
        // Its own: what is changed on the tree's leaves is no matter of the sketch.
        if (own->get_leaf_rule().is_valid()) {
            made->set_leaf_rule(own->get_leaf_rule()->duplicate());
        }
        made->set_tree(std::move(sketched.tree));
        Dictionary provenance;
        provenance["source"] = "sketch";
        provenance["sketch"] = own;
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

Ref<TreeSketch> TreeReconstructor::sketch_with_twigs(const Ref<TreeSketch>& p_sketch,
                                                     const Ref<Resource>& p_from, const String& p_title) {
    ERR_FAIL_COND_V_MSG(p_sketch.is_null(), Ref<TreeSketch>(), "There are no strokes: give a TreeSketch.");
    ERR_FAIL_COND_V_MSG(p_from.is_null(), Ref<TreeSketch>(),
                        "There are no twigs: give a TwigLibrary or a TreeReconstruction.");
    const Job job(this);
    ERR_FAIL_COND_V_MSG(!job.is_alone(), Ref<TreeSketch>(), BUSY);
    try {
        return with_twigs(p_sketch, p_from, p_title);
    } catch (const std::exception& error) {
        _fail(error.what());
        return Ref<TreeSketch>();
    }
}

Ref<TreeSketch> TreeReconstructor::load_sketch(const String& p_path) {
    const Job job(this);
    ERR_FAIL_COND_V_MSG(!job.is_alone(), Ref<TreeSketch>(), BUSY);
    try {
        treerec::SketchOptions options;
        const treerec::Sketch sketch = treerec::read_sketch(file_path(p_path), &options);
        return to_godot(sketch, options);
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
        treerec::write_file(file_path(p_path),
                            treerec::sketch_json(to_sketch(**p_sketch), to_options(**p_sketch)));
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
