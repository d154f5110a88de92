#include "convert.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <godot_cpp/classes/mesh.hpp>
#include <godot_cpp/variant/packed_byte_array.hpp>
#include <godot_cpp/variant/packed_color_array.hpp>
#include <godot_cpp/variant/packed_int64_array.hpp>
#include <godot_cpp/variant/packed_string_array.hpp>
#include <godot_cpp/variant/packed_vector2_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>

#include "error.h"
#include "foliage/leaf_rule_text.h"

using namespace godot;
using treerec::DVec3;
using treerec::NodeId;

const int64_t kSurfaceFlags = (int64_t(Mesh::ARRAY_CUSTOM_RGBA_FLOAT) << Mesh::ARRAY_FORMAT_CUSTOM0_SHIFT) |
                              (int64_t(Mesh::ARRAY_CUSTOM_R_FLOAT) << Mesh::ARRAY_FORMAT_CUSTOM1_SHIFT) |
                              (int64_t(Mesh::ARRAY_CUSTOM_RG_FLOAT) << Mesh::ARRAY_FORMAT_CUSTOM2_SHIFT);

const int64_t kJoinedLeafFlags =
    (int64_t(Mesh::ARRAY_CUSTOM_RGBA_FLOAT) << Mesh::ARRAY_FORMAT_CUSTOM0_SHIFT) |
    (int64_t(Mesh::ARRAY_CUSTOM_RGBA_FLOAT) << Mesh::ARRAY_FORMAT_CUSTOM1_SHIFT) |
    (int64_t(Mesh::ARRAY_CUSTOM_RGBA_FLOAT) << Mesh::ARRAY_FORMAT_CUSTOM2_SHIFT) |
    (int64_t(Mesh::ARRAY_CUSTOM_R_FLOAT) << Mesh::ARRAY_FORMAT_CUSTOM3_SHIFT);

treerec::NodeId node_of(const treerec::Tree& p_tree, int64_t p_id) {
    if (!holds_node(p_tree, p_id)) {
        throw treerec::Error("There is no node " + std::to_string(p_id) + " in this tree.");
    }
    return treerec::NodeId(p_id);
}

std::string to_std(const String& p_text) {
    const CharString bytes = p_text.utf8();
    return std::string(bytes.get_data(), size_t(bytes.length()));
}

// Both sides lay their values out as the same floats or integers.
template <typename Packed, typename T, typename Allocator>
static Packed copy_values(const std::vector<T, Allocator>& p_values) {
    Packed packed;
    static_assert(sizeof(T) % sizeof(*packed.ptr()) == 0 && std::is_trivially_copyable_v<T>);
    packed.resize(int64_t(p_values.size() * (sizeof(T) / sizeof(*packed.ptr()))));
    if (!p_values.empty()) {
        std::memcpy(static_cast<void*>(packed.ptrw()), p_values.data(), p_values.size() * sizeof(T));
    }
    return packed;
}

PackedFloat32Array to_godot(const std::vector<float>& p_values) {
    return copy_values<PackedFloat32Array>(p_values);
}

PackedInt32Array to_godot(const std::vector<NodeId>& p_ids) {
    return copy_values<PackedInt32Array>(p_ids);
}

TypedArray<Dictionary> to_godot(const std::vector<treerec::Parameter>& p_parameters) {
    TypedArray<Dictionary> parameters;
    for (const treerec::Parameter& parameter : p_parameters) {
        PackedStringArray words;
        for (const std::string& word : parameter.words) {
            words.push_back(to_godot(word));
        }
        Dictionary entry;
        entry["name"] = to_godot(parameter.name);
        entry["type"] = treerec::parameter_type_name(parameter.type);
        entry["description"] = to_godot(parameter.help);
        entry["default"] = to_godot(parameter.standard);
        entry["required"] = parameter.required;
        entry["minimum"] = parameter.least;
        entry["maximum"] = parameter.most;
        entry["slider_minimum"] = parameter.from;
        entry["slider_maximum"] = parameter.to;
        entry["words"] = words;
        parameters.push_back(entry);
    }
    return parameters;
}

Array to_surface_arrays(const treerec::Mesh& p_mesh) {
    Array arrays;
    if (p_mesh.indices.empty()) {
        return arrays;
    }
    arrays.resize(Mesh::ARRAY_MAX);
    arrays[Mesh::ARRAY_VERTEX] = copy_values<PackedVector3Array>(p_mesh.positions);
    if (!p_mesh.normals.empty()) {
        arrays[Mesh::ARRAY_NORMAL] = copy_values<PackedVector3Array>(p_mesh.normals);
    }
    if (!p_mesh.tangents.empty()) {
        arrays[Mesh::ARRAY_TANGENT] = copy_values<PackedFloat32Array>(p_mesh.tangents);
    }
    if (!p_mesh.uvs.empty()) {
        arrays[Mesh::ARRAY_TEX_UV] = copy_values<PackedVector2Array>(p_mesh.uvs);
    }
    if (!p_mesh.colors.empty()) {
        arrays[Mesh::ARRAY_COLOR] = copy_values<PackedColorArray>(p_mesh.colors);
    }
    if (!p_mesh.custom0.empty()) {
        arrays[Mesh::ARRAY_CUSTOM0] = copy_values<PackedFloat32Array>(p_mesh.custom0);
    }
    if (!p_mesh.radii.empty()) {
        arrays[Mesh::ARRAY_CUSTOM1] = copy_values<PackedFloat32Array>(p_mesh.radii);
    }
    if (!p_mesh.wind.empty()) {
        arrays[Mesh::ARRAY_CUSTOM2] = copy_values<PackedFloat32Array>(p_mesh.wind);
    }
    PackedInt32Array indices;
    indices.resize(int64_t(p_mesh.indices.size()));
    int32_t* write = indices.ptrw();
    for (size_t i = 0; i + 2 < p_mesh.indices.size(); i += 3) {
        write[i] = int32_t(p_mesh.indices[i]);
        write[i + 1] = int32_t(p_mesh.indices[i + 2]);
        write[i + 2] = int32_t(p_mesh.indices[i + 1]);
    }
    arrays[Mesh::ARRAY_INDEX] = indices;
    return arrays;
}

Array to_surface_arrays(const treerec::JoinedLeaves& p_leaves) {
    Array arrays = to_surface_arrays(p_leaves.mesh);
    if (!arrays.is_empty()) {
        arrays[Mesh::ARRAY_CUSTOM1] = copy_values<PackedFloat32Array>(p_leaves.lengthwise);
        arrays[Mesh::ARRAY_CUSTOM2] = copy_values<PackedFloat32Array>(p_leaves.across);
        arrays[Mesh::ARRAY_CUSTOM3] = copy_values<PackedFloat32Array>(p_leaves.secondary);
    }
    return arrays;
}

// The bits of doubles. Godot's text files print a double that a float can hold with a float's digits, which
// would move a tree at UTM coordinates by centimetres.
static PackedInt64Array to_bits(const std::vector<double>& p_values) {
    return copy_values<PackedInt64Array>(p_values);
}

static std::vector<double> from_bits(const PackedInt64Array& p_bits) {
    std::vector<double> values(size_t(p_bits.size()));
    if (!values.empty()) {
        std::memcpy(values.data(), p_bits.ptr(), values.size() * sizeof(double));
    }
    return values;
}

Dictionary to_dictionary(const treerec::Tree& p_tree, int p_format_version) {
    // Depth first, so that the order of children comes back.
    const std::vector<NodeId> ids = p_tree.empty() ? std::vector<NodeId>() : p_tree.depth_first();
    std::vector<NodeId> parents;
    std::vector<double> positions;
    std::vector<double> radii;
    PackedByteArray flags;
    parents.reserve(ids.size());
    positions.reserve(3 * ids.size());
    radii.reserve(ids.size());
    flags.resize(int64_t(ids.size()));
    uint8_t* write_flags = flags.ptrw();
    for (const NodeId id : ids) {
        const treerec::Node& node = p_tree.node(id);
        parents.push_back(node.parent);
        positions.insert(positions.end(), {node.position.x, node.position.y, node.position.z});
        radii.push_back(node.radius);
        *write_flags++ = node.flags;
    }
    const treerec::ScanFrame& frame = p_tree.frame();
    Dictionary data;
    data["format_version"] = p_format_version;
    data["ids"] = to_godot(ids);
    data["parents"] = to_godot(parents);
    data["positions"] = to_bits(positions);
    data["radii"] = to_bits(radii);
    data["flags"] = flags;
    std::vector<double> place{frame.origin.x, frame.origin.y, frame.origin.z, frame.metres_per_unit};
    if (frame.tilt != DVec3(0.0)) {
        place.insert(place.end(), {frame.tilt.x, frame.tilt.y, frame.tilt.z});
    }
    data["frame"] = to_bits(place);
    data["up_axis"] = treerec::up_axis_name(frame.up);
    if (!p_tree.leaf_rules().empty()) {
        PackedStringArray rules;
        for (const std::string& rule : p_tree.leaf_rules()) {
            rules.push_back(to_godot(rule));
        }
        PackedByteArray numbers;
        numbers.resize(int64_t(ids.size()));
        uint8_t* write = numbers.ptrw();
        for (const NodeId id : ids) {
            *write++ = p_tree.node(id).leaf_rule;
        }
        data["leaf_rules"] = rules;
        data["node_leaf_rules"] = numbers;
    }
    std::vector<NodeId> measured;
    std::vector<float> sections;
    for (const NodeId id : ids) {
        if (const treerec::SectionShape* const section = p_tree.section_of(id)) {
            measured.push_back(id);
            sections.insert(sections.end(), section->cosine.begin(), section->cosine.end());
            sections.insert(sections.end(), section->sine.begin(), section->sine.end());
        }
    }
    if (!measured.empty()) {
        data["section_nodes"] = to_godot(measured);
        data["sections"] = to_godot(sections);
    }
    return data;
}

// The entry of p_data, whose type must be p_type.
static Variant require_entry(const Dictionary& p_data, const char* p_key, Variant::Type p_type) {
    const Variant value = p_data.get(p_key, Variant());
    if (value.get_type() != p_type) {
        throw treerec::Error("The saved tree is damaged: its \"" + std::string(p_key) +
                             "\" is missing or of the wrong type. Reconstruct the tree again.");
    }
    return value;
}

// For each entry of p_parents, which names a parent by its id, the parent's place in p_ids.
static std::vector<NodeId> places_of_parents(const PackedInt32Array& p_ids,
                                             const PackedInt32Array& p_parents) {
    NodeId largest = 0;
    for (const NodeId id : p_ids) {
        if (id < 0 || id > treerec::kLargestId) {
            throw treerec::Error(
                "The saved tree is damaged: a node's id is out of range. Reconstruct the tree again.");
        }
        largest = std::max(largest, id);
    }
    std::vector<NodeId> place(size_t(largest) + 1, treerec::kNoNode);
    NodeId next = 0;
    for (const NodeId id : p_ids) {
        place[size_t(id)] = next++;
    }
    std::vector<NodeId> places;
    places.reserve(size_t(p_parents.size()));
    for (const NodeId parent : p_parents) {
        NodeId found = treerec::kNoNode;
        if (parent != treerec::kNoNode) {
            found = parent >= 0 && parent <= largest ? place[size_t(parent)] : treerec::kNoNode;
            if (found == treerec::kNoNode) {
                throw treerec::Error(
                    "The saved tree is damaged: a node's parent is missing. Reconstruct the tree again.");
            }
        }
        places.push_back(found);
    }
    return places;
}

// What a skeleton keeps of wood with leaves of its own.
static void set_leaf_rules(treerec::Tree& p_tree, const PackedInt32Array& p_ids, const Dictionary& p_data) {
    const PackedStringArray rules = require_entry(p_data, "leaf_rules", Variant::PACKED_STRING_ARRAY);
    const PackedByteArray numbers = require_entry(p_data, "node_leaf_rules", Variant::PACKED_BYTE_ARRAY);
    if (numbers.size() != p_ids.size()) {
        throw treerec::Error(
            "The saved tree is damaged: its lists differ in length. Reconstruct the tree again.");
    }
    std::vector<uint8_t> named{0};
    for (int64_t i = 0; i < rules.size(); i++) {
        named.push_back(p_tree.name_leaf_rule(treerec::plain_leaf_rule(to_std(rules[i]))));
    }
    for (int64_t i = 0; i < numbers.size(); i++) {
        if (numbers[i] >= named.size()) {
            throw treerec::Error(
                "The saved tree is damaged: a node's leaf rule is missing. Reconstruct the tree again.");
        }
        p_tree.set_leaf_rule(p_ids[i], named[numbers[i]]);
    }
}

// What a skeleton keeps of the outlines that were measured.
static void set_sections(treerec::Tree& p_tree, const Dictionary& p_data) {
    const PackedInt32Array nodes = require_entry(p_data, "section_nodes", Variant::PACKED_INT32_ARRAY);
    const PackedFloat32Array numbers = require_entry(p_data, "sections", Variant::PACKED_FLOAT32_ARRAY);
    constexpr size_t kHarmonics = treerec::SectionShape::kHarmonics;
    const size_t count = size_t(nodes.size());
    bool sound = size_t(numbers.size()) == 2 * kHarmonics * count && count <= treerec::kMostSections;
    std::vector<treerec::SectionShape> sections(sound ? count : 0);
    const float* read = numbers.ptr();
    for (treerec::SectionShape& section : sections) {
        std::copy(read, read + kHarmonics, section.cosine.begin());
        std::copy(read + kHarmonics, read + 2 * kHarmonics, section.sine.begin());
        sound = sound && std::all_of(read, read + 2 * kHarmonics, [](float p_value) {
                    return std::abs(p_value) <= treerec::kLargestHarmonic;
                });
        read += 2 * kHarmonics;
    }
    for (const NodeId id : nodes) {
        sound = sound && p_tree.contains(id);
    }
    if (!sound) {
        throw treerec::Error(
            "The saved tree is damaged: its measured sections are none. Reconstruct the tree again.");
    }
    const size_t before = p_tree.add_sections(sections);
    for (size_t i = 0; i < count; i++) {
        p_tree.set_section(nodes[int64_t(i)], before + i + 1);
    }
}

treerec::Tree tree_from_dictionary(const Dictionary& p_data) {
    const PackedInt32Array ids = require_entry(p_data, "ids", Variant::PACKED_INT32_ARRAY);
    const PackedInt32Array parents = require_entry(p_data, "parents", Variant::PACKED_INT32_ARRAY);
    const std::vector<double> positions =
        from_bits(require_entry(p_data, "positions", Variant::PACKED_INT64_ARRAY));
    const std::vector<double> radii = from_bits(require_entry(p_data, "radii", Variant::PACKED_INT64_ARRAY));
    const PackedByteArray flags = require_entry(p_data, "flags", Variant::PACKED_BYTE_ARRAY);
    const std::vector<double> place = from_bits(require_entry(p_data, "frame", Variant::PACKED_INT64_ARRAY));
    const String up = require_entry(p_data, "up_axis", Variant::STRING);

    const size_t count = size_t(ids.size());
    if (size_t(parents.size()) != count || positions.size() != 3 * count || radii.size() != count ||
        size_t(flags.size()) != count || (place.size() != 4 && place.size() != 7)) {
        throw treerec::Error(
            "The saved tree is damaged: its lists differ in length. Reconstruct the tree again.");
    }
    treerec::ScanFrame frame;
    frame.origin = DVec3(place[0], place[1], place[2]);
    frame.metres_per_unit = place[3];
    frame.up = treerec::parse_up_axis(to_std(up));
    if (place.size() == 7) {
        frame.tilt = DVec3(place[4], place[5], place[6]);
    }
    if (!treerec::is_finite(frame.origin) || !std::isfinite(place[3]) || place[3] <= 0.0 ||
        !treerec::is_tilt(frame.tilt)) {
        throw treerec::Error(
            "The saved tree is damaged: its place in the scan isn't finite. Reconstruct the tree again.");
    }
    treerec::Tree tree;
    if (count > 0) {
        std::vector<DVec3> points;
        points.reserve(count);
        for (size_t i = 0; i < count; i++) {
            points.emplace_back(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
        }
        const std::vector<NodeId> node_ids(ids.ptr(), ids.ptr() + count);
        tree = treerec::Tree::from_arrays(places_of_parents(ids, parents), points, radii,
                                          std::vector<uint8_t>(flags.ptr(), flags.ptr() + count), &node_ids);
    }
    tree.set_frame(frame);
    if (p_data.has("leaf_rules")) {
        set_leaf_rules(tree, ids, p_data);
    }
    if (p_data.has("sections") || p_data.has("section_nodes")) {
        set_sections(tree, p_data);
    }
    return tree;
}

constexpr size_t kBytesPerCell = 11;

Dictionary to_dictionary(const treerec::Foliage& p_foliage, int p_format_version) {
    PackedByteArray cells;
    cells.resize(int64_t(p_foliage.cells.size() * kBytesPerCell));
    uint8_t* write = cells.ptrw();
    for (const treerec::FoliageCell& cell : p_foliage.cells) {
        for (const uint16_t number : {cell.x, cell.y, cell.z, cell.points}) {
            *write++ = uint8_t(number & 0xff);
            *write++ = uint8_t(number >> 8);
        }
        write = std::copy(cell.color.begin(), cell.color.end(), write);
    }
    Dictionary data;
    data["format_version"] = p_format_version;
    data["place"] = to_bits(
        {p_foliage.origin.x, p_foliage.origin.y, p_foliage.origin.z, p_foliage.edge, p_foliage.reach});
    data["colored"] = p_foliage.colored;
    data["cells"] = cells;
    return data;
}

treerec::Foliage foliage_from_dictionary(const Dictionary& p_data) {
    const std::vector<double> place = from_bits(require_entry(p_data, "place", Variant::PACKED_INT64_ARRAY));
    const PackedByteArray cells = require_entry(p_data, "cells", Variant::PACKED_BYTE_ARRAY);
    treerec::Foliage foliage;
    foliage.colored = require_entry(p_data, "colored", Variant::BOOL);
    if (place.size() != 5 || size_t(cells.size()) % kBytesPerCell != 0) {
        throw treerec::Error(
            "The saved foliage is damaged: its lists differ in length. Reconstruct the tree again.");
    }
    foliage.origin = DVec3(place[0], place[1], place[2]);
    foliage.edge = place[3];
    foliage.reach = place[4];
    foliage.cells.resize(size_t(cells.size()) / kBytesPerCell);
    const uint8_t* read = cells.ptr();
    for (treerec::FoliageCell& cell : foliage.cells) {
        for (uint16_t* number : {&cell.x, &cell.y, &cell.z, &cell.points}) {
            *number = uint16_t(read[0] | (read[1] << 8));
            read += 2;
        }
        std::copy_n(read, 3, cell.color.begin());
        read += 3;
    }
    treerec::check_foliage(foliage);
    return foliage;
}
