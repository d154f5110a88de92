// Bark that TreeReconstructor grows on trees (src/growth).
#include <array>
#include <cstring>
#include <exception>
#include <godot_cpp/variant/packed_byte_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

#include "convert.h"
#include "error.h"
#include "growth/grow_bark.h"
#include "growth/lumps.h"
#include "growth/places.h"
#include "growth/presets.h"
#include "growth/recording.h"
#include "mesh/branch_tubes.h"
#include "pipeline/report.h"
#include "tree_reconstructor/scan_points.h"
#include "tree_reconstructor/tree_reconstructor.h"
#include "tree_reconstructor/tree_reconstructor_job.h"

using namespace godot;

// What a recipe calls by name.
static void give_meshes(treerec::GrowthRecipe& p_recipe, const Dictionary& p_meshes) {
    for (treerec::GrowthObstacle& obstacle : p_recipe.obstacles) {
        if (obstacle.mesh.empty()) {
            continue;
        }
        const PackedVector3Array corners = p_meshes.get(to_godot(obstacle.mesh), PackedVector3Array());
        const Vector3* const read = corners.ptr();
        for (int64_t i = 0; i + 2 < corners.size(); i += 3) {
            std::array<treerec::DVec3, 3> triangle;
            for (int64_t k = 0; k < 3; k++) {
                const Vector3& corner = read[i + k];
                triangle[size_t(k)] = treerec::DVec3(corner.x, corner.y, corner.z);
            }
            obstacle.triangles.push_back(triangle);
        }
    }
}

Ref<TreeReconstruction> TreeReconstructor::grow_bark(const Ref<TreeReconstruction>& p_tree,
                                                     const String& p_recipe, bool p_recorded) {
    ERR_FAIL_COND_V_MSG(p_tree.is_null(), Ref<TreeReconstruction>(),
                        "There is no tree that bark could grow on.");
    const Job job(this);
    ERR_FAIL_COND_V_MSG(!job.is_alone(), Ref<TreeReconstruction>(), BUSY);
    try {
        Listener listener(this);
        listener.check();
        // The tree may change meanwhile: what grew is for the wood as it is now.
        Ref<TreeReconstruction> made;
        made.instantiate();
        made->take_tree_of(p_tree);
        made->set_leaf_setting(p_tree->get_leaf_setting());
        made->set_growth_meshes(p_tree->get_growth_meshes());
        const std::shared_ptr<const treerec::Tree> tree = made->get_tree();
        treerec::GrowthRecipe recipe = treerec::read_growth_recipe(*tree, to_std(p_recipe));
        give_meshes(recipe, made->get_growth_meshes());
        treerec::GrowthRecording recording;
        treerec::GrowBarkOptions options;
        options.watcher = p_recorded ? &recording : nullptr;
        const treerec::GrownTree grown = treerec::grow_bark(*tree, recipe, options, &listener);
        listener.check();
        TypedArray<Dictionary> frames;
        for (const treerec::GrowthRecording::Frame& frame : recording.frames()) {
            PackedByteArray bytes;
            bytes.resize(int64_t(frame.bark.size()));
            std::memcpy(bytes.ptrw(), frame.bark.data(), frame.bark.size());
            Dictionary entry;
            entry["step"] = frame.step;
            entry["bark"] = bytes;
            frames.push_back(entry);
        }
        made->set_bark(grown.bark, to_godot(recipe.text));
        const std::lock_guard lock(mutex_);
        growth_frames_ = frames;
        report_json_ = treerec::growth_report_json(grown);
        fraction_ = 1.0;
        return made;
    } catch (const std::exception& error) {
        _fail(error.what());
        return Ref<TreeReconstruction>();
    }
}

TypedArray<Dictionary> TreeReconstructor::get_growth_frames() const {
    const std::lock_guard lock(mutex_);
    return growth_frames_;
}

Array TreeReconstructor::draw_grown_bark(const Ref<TreeReconstruction>& p_tree,
                                         const PackedByteArray& p_bark) {
    ERR_FAIL_COND_V_MSG(p_tree.is_null(), Array(), "There is no tree that bark could be drawn on.");
    return guarded(Array(), [&] {
        const treerec::GrownBark bark = treerec::unpack_grown_bark(
            std::string_view(reinterpret_cast<const char*>(p_bark.ptr()), size_t(p_bark.size())));
        treerec::TubeOptions options;
        options.grown = &bark;
        options.grown_alone = true;
        return to_surface_arrays(treerec::build_branch_tubes(*p_tree->get_tree(), options));
    });
}

String TreeReconstructor::propose_growth(const Ref<TreeReconstruction>& p_tree,
                                         const PackedVector3Array& p_points, const String& p_recipe) {
    ERR_FAIL_COND_V_MSG(p_tree.is_null(), String(), "There is no tree whose scan could show lumps.");
    const Job job(this);
    ERR_FAIL_COND_V_MSG(!job.is_alone(), String(), BUSY);
    try {
        Listener listener(this);
        listener.check();
        const std::shared_ptr<const treerec::Tree> tree = p_tree->get_tree();
        const treerec::GrowthRecipe recipe = treerec::read_growth_recipe(*tree, to_std(p_recipe));
        const treerec::GrowthProposal proposal =
            treerec::propose_growth(*tree, to_cloud(tree->frame(), p_points), recipe, &listener);
        listener.check();
        const std::lock_guard lock(mutex_);
        report_json_ = treerec::growth_proposal_json(proposal);
        fraction_ = 1.0;
        return to_godot(proposal.recipe);
    } catch (const std::exception& error) {
        _fail(error.what());
        return String();
    }
}

TypedArray<Dictionary> TreeReconstructor::get_growth_commands() {
    TypedArray<Dictionary> list;
    for (const treerec::GrowthCommand& command : treerec::growth_commands()) {
        Dictionary entry;
        entry["name"] = to_godot(command.name);
        entry["description"] = to_godot(command.summary);
        entry["parameters"] = to_godot(command.parameters);
        list.push_back(entry);
    }
    return list;
}

TypedArray<Dictionary> TreeReconstructor::get_growth_presets() {
    TypedArray<Dictionary> list;
    for (const treerec::GrowthPreset& preset : treerec::growth_presets()) {
        Dictionary entry;
        entry["name"] = to_godot(std::string(preset.name));
        entry["description"] = to_godot(std::string(preset.title));
        list.push_back(entry);
    }
    return list;
}

String TreeReconstructor::scale_growth_preset(const String& p_name, const Ref<TreeReconstruction>& p_tree) {
    ERR_FAIL_COND_V_MSG(p_tree.is_null(), String(), "There is no tree that bark could grow on.");
    return guarded(String(), [&] {
        const treerec::GrowthPreset& preset = treerec::find_growth_preset(to_std(p_name));
        return to_godot(treerec::preset_recipe(preset, *p_tree->get_tree()));
    });
}

const treerec::BarkPlaces& TreeReconstructor::_places_of(const std::shared_ptr<const treerec::Tree>& p_tree,
                                                         double p_longest, double p_shortest) {
    if (!places_ || places_tree_.lock() != p_tree || places_longest_ != p_longest ||
        places_shortest_ != p_shortest) {
        places_.emplace(*p_tree, p_longest, p_shortest);
        places_tree_ = p_tree;
        places_longest_ = p_longest;
        places_shortest_ = p_shortest;
    }
    return *places_;
}

static Dictionary to_dictionary(const treerec::BarkPlace& p_place) {
    Dictionary found;
    found["node"] = int64_t(p_place.node);
    found["along"] = p_place.along;
    found["around"] = p_place.around;
    found["radius"] = p_place.radius;
    found["position"] = to_godot(p_place.position());
    found["axis"] = to_godot(p_place.axis);
    found["direction"] = to_godot(p_place.direction);
    found["out"] = to_godot(p_place.out);
    return found;
}

// What edges a recipe has if it tells none.
static treerec::GrowthRecipe recipe_of(const treerec::Tree& p_tree, const String& p_text) {
    try {
        return treerec::read_growth_recipe(p_tree, to_std(p_text));
    } catch (const treerec::Error&) {
        // Half written: what is wrong is told by whoever grows it.
        return {};
    }
}

Dictionary TreeReconstructor::pick_bark(const Ref<TreeReconstruction>& p_tree, const Vector3& p_from,
                                        const Vector3& p_way, double p_longest) {
    ERR_FAIL_COND_V_MSG(p_tree.is_null(), Dictionary(), "There is no tree whose bark could be met.");
    ERR_FAIL_COND_V_MSG(!p_way.is_finite() || !p_from.is_finite() || p_way == Vector3() || !(p_longest > 0.0),
                        Dictionary(), "The line of sight needs a place and a direction.");
    const std::shared_ptr<const treerec::Tree> tree = p_tree->get_tree();
    if (tree->empty()) {
        return Dictionary();
    }
    const std::optional<treerec::BarkPlace> found =
        _places_of(tree, p_longest, p_longest * 15.0 / 35.0)
            .pick(treerec::DVec3(p_from.x, p_from.y, p_from.z), treerec::DVec3(p_way.x, p_way.y, p_way.z));
    return found ? to_dictionary(*found) : Dictionary();
}

TypedArray<Dictionary> TreeReconstructor::find_bark(const Ref<TreeReconstruction>& p_tree,
                                                    const String& p_recipe) {
    TypedArray<Dictionary> list;
    ERR_FAIL_COND_V_MSG(p_tree.is_null(), list, "There is no tree whose bark could be looked at.");
    const std::shared_ptr<const treerec::Tree> tree = p_tree->get_tree();
    if (tree->empty()) {
        return list;
    }
    const treerec::GrowthRecipe whole = recipe_of(*tree, p_recipe);
    const treerec::BarkPlaces& places = _places_of(tree, whole.longest, whole.shortest);
    std::istringstream lines(to_std(p_recipe));
    for (std::string line; std::getline(lines, line);) {
        const treerec::GrowthRecipe one = recipe_of(*tree, to_godot(line));
        Dictionary entry;
        std::optional<treerec::BarkPlace> found;
        if (!one.features.empty()) {
            found = places.find(one.features[0]);
        } else if (!one.obstacles.empty()) {
            found = places.find(one.obstacles[0]);
        }
        list.push_back(found ? to_dictionary(*found) : Dictionary());
    }
    return list;
}

// Meshes as one.
static void append(treerec::Mesh& p_all, const treerec::Mesh& p_one) {
    const uint32_t before = uint32_t(p_all.positions.size());
    const auto append = [](auto& p_to, const auto& p_from) {
        p_to.insert(p_to.end(), p_from.begin(), p_from.end());
    };
    append(p_all.positions, p_one.positions);
    append(p_all.normals, p_one.normals);
    append(p_all.tangents, p_one.tangents);
    append(p_all.uvs, p_one.uvs);
    append(p_all.custom0, p_one.custom0);
    for (const uint32_t index : p_one.indices) {
        p_all.indices.push_back(before + index);
    }
}

// What `draw` makes of a recipe's features of one kind, as one surface.
template <typename Draw>
static Array draw_features(const treerec::GrowthRecipe& p_recipe, treerec::GrowthFeature::Kind p_kind,
                           Draw draw) {
    treerec::Mesh all;
    for (const treerec::GrowthFeature& feature : p_recipe.features) {
        if (feature.kind == p_kind) {
            append(all, draw(feature));
        }
    }
    return to_surface_arrays(all);
}

Array TreeReconstructor::sink_bark(const Ref<TreeReconstruction>& p_tree, const String& p_recipe) {
    ERR_FAIL_COND_V_MSG(p_tree.is_null(), Array(), "There is no tree whose bark could sink.");
    const std::shared_ptr<const treerec::Tree> tree = p_tree->get_tree();
    if (tree->empty()) {
        return Array();
    }
    const treerec::GrowthRecipe recipe = recipe_of(*tree, p_recipe);
    const treerec::BarkPlaces& places = _places_of(tree, recipe.longest, recipe.shortest);
    return draw_features(recipe, treerec::GrowthFeature::Kind::kHollow,
                         [&](const treerec::GrowthFeature& hollow) { return places.mouth(hollow); });
}

Array TreeReconstructor::lift_bark(const Ref<TreeReconstruction>& p_tree, const String& p_recipe) {
    ERR_FAIL_COND_V_MSG(p_tree.is_null(), Array(), "There is no tree whose bark could be lifted.");
    const std::shared_ptr<const treerec::Tree> tree = p_tree->get_tree();
    if (tree->empty()) {
        return Array();
    }
    const treerec::GrowthRecipe recipe = recipe_of(*tree, p_recipe);
    const treerec::BarkPlaces& places = _places_of(tree, recipe.longest, recipe.shortest);
    return draw_features(recipe, treerec::GrowthFeature::Kind::kBurl,
                         [&](const treerec::GrowthFeature& burl) { return places.lift(burl, recipe.twist); });
}
