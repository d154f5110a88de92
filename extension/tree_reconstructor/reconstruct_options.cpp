#include "tree_reconstructor/reconstruct_options.h"

#include <cmath>
#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/variant/packed_float64_array.hpp>
#include <godot_cpp/variant/packed_string_array.hpp>
#include <string>

#include "convert.h"
#include "error.h"
#include "foliage/leaves.h"
#include "tree_reconstruction/tree_reconstruction.h"

using namespace godot;
using Pipeline = treerec::ReconstructOptions;

namespace {

struct Option {
    const char* name;
    Variant (*read)(const ParsedOptions& p_options);
    void (*write)(ParsedOptions& r_options, const Variant& p_value);
    PropertyHint hint;
    const char* hint_string;
    const char* description;
};

// Reads and writes a plain member, such as NUMBER(skeleton.spacing, double).
#define OPTION_MEMBER(m_member, m_type)                                                           \
    [](const ParsedOptions& p_options) { return Variant(m_type(p_options.pipeline.m_member)); },  \
        [](ParsedOptions& r_options, const Variant& p_value) {                                    \
            r_options.pipeline.m_member = decltype(r_options.pipeline.m_member)(m_type(p_value)); \
        }

Variant read_up(const ParsedOptions& p_options) {
    const std::optional<treerec::UpAxis>& up = p_options.pipeline.orient.up;
    return up ? treerec::up_axis_name(*up) : "auto";
}

void write_up(ParsedOptions& r_options, const Variant& p_value) {
    const std::string name = to_std(p_value);
    r_options.pipeline.orient.up.reset();
    if (name != "auto") {
        r_options.pipeline.orient.up = treerec::parse_up_axis(name);
    }
}

Variant read_skeleton(const ParsedOptions& p_options) {
    return treerec::skeleton_method_name(p_options.pipeline.skeleton.method);
}

void write_skeleton(ParsedOptions& r_options, const Variant& p_value) {
    r_options.pipeline.skeleton.method = treerec::parse_skeleton_method(to_std(p_value));
}

Variant read_spanning_tree(const ParsedOptions& p_options) {
    return treerec::spanning_tree_kind_name(p_options.pipeline.skeleton.spanning_tree);
}

void write_spanning_tree(ParsedOptions& r_options, const Variant& p_value) {
    r_options.pipeline.skeleton.spanning_tree = treerec::parse_spanning_tree_kind(to_std(p_value));
}

Variant read_flood(const ParsedOptions& p_options) {
    return treerec::flood_kind_name(p_options.pipeline.skeleton.flood);
}

void write_flood(ParsedOptions& r_options, const Variant& p_value) {
    r_options.pipeline.skeleton.flood = treerec::parse_flood_kind(to_std(p_value));
}

Variant read_radii(const ParsedOptions& p_options) {
    return treerec::radius_rule_name(p_options.pipeline.radii);
}

void write_radii(ParsedOptions& r_options, const Variant& p_value) {
    r_options.pipeline.radii = treerec::parse_radius_rule(to_std(p_value));
}

Variant read_prune(const ParsedOptions& p_options) {
    const std::optional<treerec::PruneOptions>& prune = p_options.pipeline.prune;
    return !prune ? "none" : prune->spare_leader ? "leader" : "paper";
}

void write_prune(ParsedOptions& r_options, const Variant& p_value) {
    const std::string rule = to_std(p_value);
    if (rule != "none" && rule != "paper" && rule != "leader") {
        throw treerec::Error("The option \"prune\" is none, paper or leader, not " +
                             treerec::quote_word(rule) + ".");
    }
    r_options.pipeline.prune.reset();
    if (rule != "none") {
        r_options.pipeline.prune.emplace();
        r_options.pipeline.prune->spare_leader = rule == "leader";
    }
}

Variant read_scale(const ParsedOptions& p_options) {
    return p_options.pipeline.orient.metres_per_unit.value_or(0.0);
}

void write_scale(ParsedOptions& r_options, const Variant& p_value) {
    const double scale = p_value;
    r_options.pipeline.orient.metres_per_unit.reset();
    if (scale != 0.0) {
        r_options.pipeline.orient.metres_per_unit = scale;
    }
}

bool are_finite(const PackedFloat64Array& p_numbers) {
    for (int64_t i = 0; i < p_numbers.size(); i++) {
        if (!std::isfinite(p_numbers[i])) {
            return false;
        }
    }
    return true;
}

Variant read_known_height(const ParsedOptions& p_options) {
    return p_options.pipeline.orient.known_height.value_or(0.0);
}

void write_known_height(ParsedOptions& r_options, const Variant& p_value) {
    const double height = p_value;
    r_options.pipeline.orient.known_height.reset();
    if (height != 0.0) {
        r_options.pipeline.orient.known_height = height;
    }
}

Variant read_known_length(const ParsedOptions& p_options) {
    PackedFloat64Array numbers;
    if (const std::optional<treerec::KnownLength>& known = p_options.pipeline.orient.known_length) {
        for (const treerec::DVec3& end : {known->from, known->to}) {
            for (int axis = 0; axis < 3; axis++) {
                numbers.push_back(end[axis]);
            }
        }
        numbers.push_back(known->metres);
    }
    return numbers;
}

void write_known_length(ParsedOptions& r_options, const Variant& p_value) {
    const PackedFloat64Array numbers = p_value;
    r_options.pipeline.orient.known_length.reset();
    if (numbers.is_empty()) {
        return;
    }
    if (numbers.size() != 7 || !are_finite(numbers)) {
        throw treerec::Error(
            "The option \"known_length\" must be seven numbers: two places in the scan and the metres "
            "between "
            "them.");
    }
    const double* n = numbers.ptr();
    r_options.pipeline.orient.known_length = {{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, n[6]};
}

Variant read_tree_number(const ParsedOptions& p_options) {
    return int64_t(p_options.pipeline.clean.pick.number);
}

void write_tree_number(ParsedOptions& r_options, const Variant& p_value) {
    const int64_t number = p_value;
    if (number < 1) {
        throw treerec::Error("The option \"tree_number\" must be 1, the largest tree, or more.");
    }
    r_options.pipeline.clean.pick.number = size_t(number);
}

Variant read_tree_position(const ParsedOptions& p_options) {
    PackedFloat64Array numbers;
    if (const std::optional<treerec::DVec3>& position = p_options.pipeline.clean.pick.position) {
        for (int axis = 0; axis < 3; axis++) {
            numbers.push_back((*position)[axis]);
        }
    }
    return numbers;
}

void write_tree_position(ParsedOptions& r_options, const Variant& p_value) {
    const PackedFloat64Array numbers = p_value;
    r_options.pipeline.clean.pick.position.reset();
    if (numbers.is_empty()) {
        return;
    }
    if (numbers.size() != 3 || !are_finite(numbers)) {
        throw treerec::Error("The option \"tree_position\" must be three numbers: a place in the scan.");
    }
    r_options.pipeline.clean.pick.position = treerec::DVec3(numbers[0], numbers[1], numbers[2]);
}

Variant read_columns(const ParsedOptions& p_options) {
    PackedStringArray names;
    for (const std::string& name : p_options.pipeline.read.columns) {
        names.push_back(to_godot(name));
    }
    return String(",").join(names);
}

void write_columns(ParsedOptions& r_options, const Variant& p_value) {
    r_options.pipeline.read.columns = treerec::parse_columns(to_std(p_value));
}

Variant read_classes(const ParsedOptions& p_options) {
    const std::optional<std::vector<uint8_t>>& classes = p_options.pipeline.read.classes;
    if (!classes) {
        return String();
    }
    if (classes->size() == 256) {
        return "all";
    }
    PackedStringArray names;
    for (const uint8_t point_class : *classes) {
        names.push_back(to_godot(std::to_string(point_class)));
    }
    return String(",").join(names);
}

void write_classes(ParsedOptions& r_options, const Variant& p_value) {
    r_options.pipeline.read.classes = treerec::parse_classes(to_std(p_value));
}

Variant read_leaves(const ParsedOptions& p_options) {
    return p_options.leaves;
}

void write_leaves(ParsedOptions& r_options, const Variant& p_value) {
    const std::string name = to_std(p_value);
    if (name != "auto") {
        treerec::leaf_preset(name);  // Throws for a name that is none.
    }
    r_options.leaves = p_value;
}

const Option kOptions[] = {
    {"up", read_up, write_up, PROPERTY_HINT_ENUM, "auto,x,y,z,-x,-y,-z",
     "The scan's axis that points to the sky; auto detects it."},
    {"scale", read_scale, write_scale, PROPERTY_HINT_RANGE, "0,1000,0.0001,or_greater",
     "Length of one unit of the scan in metres; 0 takes what the file says, or guesses it from the size."},
    {"known_height", read_known_height, write_known_height, PROPERTY_HINT_RANGE,
     "0,100,0.01,or_greater,suffix:m",
     "The tree's height, which sets the scale of a scan that has none; 0 is not known."},
    {"known_length", read_known_length, write_known_length, PROPERTY_HINT_NONE, "",
     "A length that sets the scale: x, y, z of two places in the scan, and the metres between them. Empty is "
     "not known."},
    {"columns", read_columns, write_columns, PROPERTY_HINT_NONE, "",
     "Text files only: the columns' names in order, such as x,y,z,r,g,b; - skips one. Empty detects them."},
    {"classes", read_classes, write_classes, PROPERTY_HINT_NONE, "",
     "LAS and LAZ files only: the classes of points that are read, such as 2,4-5, or all. Empty leaves out "
     "noise "
     "(7 and 18)."},
    {"remove_extreme_colors", OPTION_MEMBER(clean.remove_extreme_colors, bool), PROPERTY_HINT_NONE, "",
     "Removes points that are nearly white or nearly black."},
    {"white_above", OPTION_MEMBER(clean.white_above, int), PROPERTY_HINT_RANGE, "0,256,1",
     "A point is nearly white when every channel is at least this."},
    {"black_below", OPTION_MEMBER(clean.black_below, int), PROPERTY_HINT_RANGE, "-1,255,1",
     "A point is nearly black when every channel is at most this."},
    {"remove_outliers", OPTION_MEMBER(clean.remove_outliers, bool), PROPERTY_HINT_NONE, "",
     "Removes points far from their neighbours."},
    {"neighbours", OPTION_MEMBER(clean.neighbours, int), PROPERTY_HINT_RANGE, "2,64,1",
     "How many neighbours of a point say whether it is an outlier."},
    {"outlier_deviations", OPTION_MEMBER(clean.outlier_deviations, double), PROPERTY_HINT_RANGE, "0.5,20,0.1",
     "How many standard deviations from the usual distance make an outlier."},
    {"remove_fragments", OPTION_MEMBER(clean.remove_fragments, bool), PROPERTY_HINT_NONE, "",
     "Removes small clusters of points far from the rest."},
    {"remove_ground", OPTION_MEMBER(clean.remove_ground, bool), PROPERTY_HINT_NONE, "",
     "Removes the ground that the tree stands on, and walls and fences beside it."},
    {"separate_trees", OPTION_MEMBER(clean.pick.enabled, bool), PROPERTY_HINT_NONE, "",
     "Takes one tree where the scan holds several; without it everything in the scan is one tree."},
    {"tree_number", read_tree_number, write_tree_number, PROPERTY_HINT_RANGE, "1,100,1,or_greater",
     "Which of several trees: 1 is the largest, 2 the next."},
    {"tree_position", read_tree_position, write_tree_position, PROPERTY_HINT_NONE, "",
     "Which of several trees: the one that stands nearest to this place in the scan (x, y, z). Empty goes by "
     "the number."},
    {"tell_leaves", OPTION_MEMBER(tell_leaves, bool), PROPERTY_HINT_NONE, "",
     "Tells leaves from wood: the skeleton follows the wood, and the leaves become foliage."},
    {"skeleton", read_skeleton, write_skeleton, PROPERTY_HINT_ENUM, "geodesic,delaunay,flood",
     "How the branches are found: geodesic follows the shortest paths through the points, delaunay does it "
     "as AdTree was published, to compare, flood goes through voxels."},
    {"spanning_tree", read_spanning_tree, write_spanning_tree, PROPERTY_HINT_ENUM, "paths,minimum",
     "The tree over the edges of the Delaunay triangulation: minimum is the one of the least length, paths "
     "are "
     "the shortest from the root."},
    {"flood", read_flood, write_flood, PROPERTY_HINT_ENUM, "ours,paper",
     "How the flood is done: ours, or as Zhang 2013 prints it, to compare."},
    {"voxel", OPTION_MEMBER(skeleton.voxel, double), PROPERTY_HINT_RANGE, "0,0.5,0.001,suffix:m",
     "Edge of the flood's voxels; 0 chooses by the cloud."},
    {"flood_steps", OPTION_MEMBER(skeleton.keep_steps, bool), PROPERTY_HINT_NONE, "",
     "Keeps every step of the flood, for get_flood_step()."},
    {"radii", read_radii, write_radii, PROPERTY_HINT_ENUM, "measured,linear,davinci",
     "Where radii come from: the points, or a rule for what branches have of their parent's."},
    {"complete", OPTION_MEMBER(complete, bool), PROPERTY_HINT_NONE, "",
     "Looks again for branches where points are left over that the tree does not explain."},
    {"prune", read_prune, write_prune, PROPERTY_HINT_ENUM, "none,paper,leader",
     "Cuts twigs that are longer than the mean to it at last: paper all of them, leader all but the trunk's "
     "own tip."},
    {"spacing", OPTION_MEMBER(skeleton.spacing, double), PROPERTY_HINT_RANGE, "0,0.5,0.001,suffix:m",
     "Keeps at most one point per cell of this size; 0 chooses by the cloud."},
    {"minimum_branch", OPTION_MEMBER(skeleton.minimum_branch, double), PROPERTY_HINT_RANGE,
     "0,2,0.01,suffix:m", "Shorter end branches are taken for noise; 0 chooses by the tree."},
    {"simplify_distance", OPTION_MEMBER(skeleton.simplify_distance, double), PROPERTY_HINT_RANGE,
     "0,0.5,0.001,suffix:m", "How far a branch may be moved when nodes are saved; 0 chooses by the tree."},
    {"fit_radii", OPTION_MEMBER(skeleton.fit_radii, bool), PROPERTY_HINT_NONE, "",
     "Measures radii where the points allow it; without it all are inferred."},
    {"seed", OPTION_MEMBER(skeleton.seed, int64_t), PROPERTY_HINT_NONE, "",
     "The same scan and seed give the same tree."},
    {"leaves", read_leaves, write_leaves, PROPERTY_HINT_ENUM, "",
     "The leaf preset that the tree gets; auto takes palm for a palm, else generic."},
};

#undef OPTION_MEMBER

ParsedOptions default_options() {
    ParsedOptions options;
    options.leaves = "auto";
    return options;
}

// An int serves for a float, as in GDScript; nothing else stands for another type.
bool fits(const Variant& p_value, Variant::Type p_type) {
    const Variant::Type type = p_value.get_type();
    return type == p_type || (type == Variant::INT && p_type == Variant::FLOAT) ||
           (type == Variant::STRING_NAME && p_type == Variant::STRING);
}

}  // namespace

ParsedOptions parse_reconstruct_options(const Dictionary& p_options) {
    ParsedOptions options = default_options();
    size_t used = 0;
    for (const Option& option : kOptions) {
        if (!p_options.has(option.name)) {
            continue;
        }
        used++;
        const Variant value = p_options[option.name];
        const Variant::Type type = option.read(options).get_type();
        if (!fits(value, type)) {
            throw treerec::Error("The option \"" + std::string(option.name) + "\" must be of type " +
                                 to_std(Variant::get_type_name(type)) + ".");
        }
        if (type == Variant::FLOAT && (!std::isfinite(double(value)) || double(value) < 0.0)) {
            throw treerec::Error("The option \"" + std::string(option.name) +
                                 "\" must be a finite number that isn't negative.");
        }
        option.write(options, value);
    }
    if (used < size_t(p_options.size())) {
        const Array names = p_options.keys();
        for (int64_t i = 0; i < names.size(); i++) {
            bool known = false;
            for (const Option& option : kOptions) {
                known = known || String(names[i]) == String(option.name);
            }
            if (!known) {
                throw treerec::Error("There is no option \"" + to_std(String(names[i])) +
                                     "\"; TreeReconstructor.get_option_list() lists them.");
            }
        }
    }
    return options;
}

TypedArray<Dictionary> list_reconstruct_options() {
    const ParsedOptions defaults = default_options();
    TypedArray<Dictionary> list;
    for (const Option& option : kOptions) {
        const Variant value = option.read(defaults);
        Dictionary entry;
        entry["name"] = option.name;
        entry["type"] = int(value.get_type());
        entry["default"] = value;
        entry["hint"] = int(option.hint);
        entry["hint_string"] =
            option.read == read_leaves
                ? String("auto,") + String(",").join(TreeReconstruction::get_leaf_preset_names())
                : String(option.hint_string);
        entry["description"] = option.description;
        list.push_back(entry);
    }
    return list;
}
