// Grafting on TreeReconstruction: commands (tree_reconstruction_editing.cpp) made from typed arguments, and
// what an editor asks before and after. See src/edit/graft/graft.h.
#include <algorithm>
#include <godot_cpp/variant/typed_array.hpp>

#include "convert.h"
#include "edit/collide.h"
#include "edit/commands/command_text.h"
#include "edit/graft/scion.h"
#include "edit/graft/twig_library.h"
#include "edit/graft/twig_picture.h"
#include "error.h"
#include "l_system.h"
#include "lsystem/lstring.h"
#include "tree_edit.h"
#include "tree_reconstruction/tree_reconstruction.h"

using namespace godot;
using treerec::NodeId;

// A value of a Dictionary as a command says it.
static std::string command_value(const Variant& p_value) {
    switch (p_value.get_type()) {
        case Variant::BOOL:
            return bool(p_value) ? "yes" : "no";
        case Variant::INT:
            return std::to_string(int64_t(p_value));
        case Variant::FLOAT:
            return treerec::number_text(double(p_value));
        case Variant::VECTOR3: {
            const Vector3 v = p_value;
            return treerec::vector_text(treerec::DVec3(v.x, v.y, v.z));
        }
        case Variant::PACKED_INT32_ARRAY: {
            std::string text;
            const PackedInt32Array ids = p_value;
            for (int64_t i = 0; i < ids.size(); i++) {
                text += (i == 0 ? "" : ",") + std::to_string(ids[i]);
            }
            return text;
        }
        case Variant::ARRAY:
        case Variant::PACKED_STRING_ARRAY: {
            std::string text;
            const Array parts = p_value;
            for (int64_t i = 0; i < parts.size(); i++) {
                text += (i == 0 ? "" : ",") + command_value(parts[i]);
            }
            return text;
        }
        default:
            return to_std(String(p_value));
    }
}

Ref<TreeEdit> TreeReconstruction::_edit_with(const char* p_command, const Variant& p_where,
                                             const Dictionary& p_options) {
    return guarded(Ref<TreeEdit>(), [&] {
        std::string line = p_command;
        const bool many = p_where.get_type() == Variant::PACKED_INT32_ARRAY;
        treerec::append_word(line, many ? "nodes" : "node", command_value(p_where));
        const Array keys = p_options.keys();
        for (int64_t i = 0; i < keys.size(); i++) {
            // What is null was not given.
            if (p_options[keys[i]].get_type() != Variant::NIL) {
                treerec::append_word(line, to_std(String(keys[i])), command_value(p_options[keys[i]]));
            }
        }
        return _edit(to_godot(line));
    });
}

Ref<TreeEdit> TreeReconstruction::make_twig(int64_t p_id, const Dictionary& p_options) {
    return _edit_with("twig", p_id, p_options);
}

Ref<TreeEdit> TreeReconstruction::graft(int64_t p_id, const Dictionary& p_options) {
    return _edit_with("graft", p_id, p_options);
}

Ref<TreeEdit> TreeReconstruction::graft_many(const PackedInt32Array& p_ids, const Dictionary& p_options) {
    ERR_FAIL_COND_V_MSG(p_ids.is_empty(), Ref<TreeEdit>(), "There is no node to graft onto.");
    return _edit_with("graft_many", p_ids, p_options);
}

String TreeReconstruction::take_branch(int64_t p_id) const {
    return guarded(String(), [&] {
        const std::shared_ptr<const treerec::Tree> tree = _editable_tree();
        const treerec::Tree scion = treerec::take_scion(*tree, node_of(*tree, p_id));
        treerec::LStringOptions options;
        options.flags = false;
        return to_godot(treerec::write_lstring(scion, scion.root(), options));
    });
}

TypedArray<Dictionary> TreeReconstruction::find_collisions(int64_t p_id, double p_clearance) const {
    return guarded(TypedArray<Dictionary>(), [&] {
        TypedArray<Dictionary> list;
        const std::shared_ptr<const treerec::Tree> tree = _editable_tree();
        for (const treerec::Collision& one :
             treerec::find_collisions(*tree, node_of(*tree, p_id), p_clearance)) {
            Dictionary entry;
            entry["node"] = one.grafted;
            entry["other"] = one.other;
            entry["depth"] = one.depth;
            entry["position"] = to_godot(one.place);
            list.push_back(entry);
        }
        return list;
    });
}

static Dictionary describe_branch(std::string_view p_string,
                                  LSystem::Dialect p_dialect = LSystem::DIALECT_TOLD) {
    const treerec::Tree scion = treerec::read_lstring(p_string, LSystem::read_options(p_dialect));
    treerec::require_scion(scion);
    Dictionary entry;
    entry["length"] = treerec::scion_length(scion);
    entry["base_radius"] = scion.node(scion.root()).radius;
    entry["node_count"] = int64_t(scion.size());
    return entry;
}

static Dictionary measure_branch(const String& p_lstring, LSystem::Dialect p_dialect) {
    return guarded(Dictionary(), [&] { return describe_branch(to_std(p_lstring), p_dialect); });
}

static PackedByteArray draw_branch(const String& p_lstring, int p_size, LSystem::Dialect p_dialect) {
    return guarded(PackedByteArray(), [&] {
        const treerec::Tree scion =
            treerec::read_lstring(to_std(p_lstring), LSystem::read_options(p_dialect));
        const treerec::Image image = treerec::draw_twig(scion, p_size);
        PackedByteArray pixels;
        pixels.resize(int64_t(image.pixels.size()));
        std::copy(image.pixels.begin(), image.pixels.end(), pixels.ptrw());
        return pixels;
    });
}

TypedArray<Dictionary> TreeReconstruction::get_twig_library() {
    return guarded(TypedArray<Dictionary>(), [] {
        TypedArray<Dictionary> list;
        for (const treerec::LibraryTwig& twig : treerec::twig_library()) {
            Dictionary entry = describe_branch(twig.string);
            entry["name"] = to_godot(std::string(twig.name));
            entry["description"] = to_godot(std::string(twig.title));
            entry["lstring"] = to_godot(std::string(twig.string));
            list.push_back(entry);
        }
        return list;
    });
}

void TreeReconstruction::_bind_grafting() {
    ClassDB::bind_method(D_METHOD("make_twig", "id", "options"), &TreeReconstruction::make_twig,
                         DEFVAL(Dictionary()));
    ClassDB::bind_method(D_METHOD("graft", "id", "options"), &TreeReconstruction::graft,
                         DEFVAL(Dictionary()));
    ClassDB::bind_method(D_METHOD("graft_many", "ids", "options"), &TreeReconstruction::graft_many,
                         DEFVAL(Dictionary()));
    ClassDB::bind_method(D_METHOD("take_branch", "id"), &TreeReconstruction::take_branch);
    ClassDB::bind_method(D_METHOD("find_collisions", "id", "clearance"), &TreeReconstruction::find_collisions,
                         DEFVAL(0.0));
    ClassDB::bind_static_method("TreeReconstruction", D_METHOD("measure_branch", "lstring", "dialect"),
                                &measure_branch, DEFVAL(int(LSystem::DIALECT_TOLD)));
    ClassDB::bind_static_method("TreeReconstruction", D_METHOD("draw_branch", "lstring", "size", "dialect"),
                                &draw_branch, DEFVAL(128), DEFVAL(int(LSystem::DIALECT_TOLD)));
    ClassDB::bind_static_method("TreeReconstruction", D_METHOD("get_twig_library"),
                                &TreeReconstruction::get_twig_library);
}
