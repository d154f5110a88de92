#include <cmath>
#include <godot_cpp/core/class_db.hpp>
#include <iterator>
#include <string>

#include "convert.h"
#include "error.h"
#include "tree_reconstructor/reconstruct_options.h"

using namespace godot;

namespace {

struct Option {
    const char* name;
    Variant standard;
    PropertyHint hint;
    const char* hint_string;
    const char* description;
};

// Made when asked for: variants are the engine's.
TypedArray<Dictionary> list_options() {
    const Option options[] = {
        {"time", "normal", PROPERTY_HINT_ENUM, "quick,normal,best",
         "How much is found in each photo: quick to see whether it works, best for twigs, in several times "
         "the time."},
        {"order", "auto", PROPERTY_HINT_ENUM, "auto,sequence,exhaustive",
         "Which photos are compared: sequence takes neighbours by name, exhaustive all with all; auto "
         "compares all "
         "of up to 80."},
        {"matcher", "auto", PROPERTY_HINT_ENUM, "auto,sift,pyrlk,both",
         "How photos are compared: sift takes COLMAP's features, pyrlk tracks corners and is several times "
         "faster where neighbours are near, both joins the two and gives more points; auto takes sift, and "
         "both where that does not place all photos, or places some doubtfully."},
        {"dense", true, PROPERTY_HINT_NONE, "",
         "Matches the photos pixel by pixel; without it the cloud has the few points that placed the "
         "cameras."},
        {"bark", true, PROPERTY_HINT_NONE, "",
         "Takes the bark's pictures out of the photos; without it, or where these are too coarse, the tree "
         "has the drawn bark of its kind."},
        {"leaf_colors", true, PROPERTY_HINT_NONE, "",
         "Gives the leaves the colors that the photos show, by height; without it, or where the photos show "
         "too few leaves, they have the drawn colors of their kind."},
        {"marker_side", 0.0, PROPERTY_HINT_RANGE, "0,10,0.0001,or_greater,suffix:m",
         "The side of the black square of printed markers that the photos show: it sets the tree's size. 0 "
         "is "
         "not known."},
        {"colmap", "", PROPERTY_HINT_GLOBAL_FILE, "",
         "The program COLMAP, or the folder that it is in; empty looks for it."},
    };
    TypedArray<Dictionary> list;
    for (const Option& option : options) {
        Dictionary entry;
        entry["name"] = option.name;
        entry["type"] = int(option.standard.get_type());
        entry["default"] = option.standard;
        entry["hint"] = int(option.hint);
        entry["hint_string"] = option.hint_string;
        entry["description"] = option.description;
        list.push_back(entry);
    }
    return list;
}

}  // namespace

ParsedPhotoOptions parse_photo_options(const Dictionary& p_options) {
    ParsedPhotoOptions options;
    options.of_tree = p_options.duplicate();
    Dictionary values;
    const TypedArray<Dictionary> known = list_options();
    for (int64_t i = 0; i < known.size(); i++) {
        const Dictionary option = known[i];
        const Variant name = option["name"];
        values[name] = option["default"];
        if (!p_options.has(name)) {
            continue;
        }
        const Variant value = p_options[name];
        const bool is_word = value.get_type() == Variant::STRING || value.get_type() == Variant::STRING_NAME;
        const Variant::Type wanted = Variant::Type(int(option["type"]));
        const bool is_number = value.get_type() == Variant::INT && wanted == Variant::FLOAT;
        if (value.get_type() != wanted && !is_number && !(is_word && wanted == Variant::STRING)) {
            throw treerec::Error("The option \"" + to_std(String(name)) + "\" must be of type " +
                                 to_std(Variant::get_type_name(wanted)) + ".");
        }
        values[name] = value;
        options.of_photos[name] = value;
        options.of_tree.erase(name);
    }
    options.tree = parse_reconstruct_options(options.of_tree);
    treerec::PhotosOptions& pipeline = options.pipeline;
    pipeline.colmap.program = to_std(String(values["colmap"]));
    pipeline.colmap.order = treerec::parse_photo_order(to_std(String(values["order"])));
    pipeline.colmap.matcher = treerec::parse_photo_matcher(to_std(String(values["matcher"])));
    pipeline.colmap.effort = treerec::parse_photo_effort(to_std(String(values["time"])));
    pipeline.cloud = treerec::cloud_options_of(pipeline.colmap.effort);
    pipeline.cloud.dense = bool(values["dense"]);
    const double side = values["marker_side"];
    if (!std::isfinite(side) || side < 0.0) {
        throw treerec::Error("The option \"marker_side\" must be a finite number that isn't negative.");
    }
    pipeline.marker_side = side;
    pipeline.bark = bool(values["bark"]);
    pipeline.leaf_colours = bool(values["leaf_colors"]);
    pipeline.reconstruct = options.tree.pipeline;
    return options;
}

TypedArray<Dictionary> list_photo_options() {
    return list_options();
}
