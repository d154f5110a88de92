// Bark that was grown on a TreeReconstruction (src/growth): kept as plain data, shown while it fits the wood.
#include <cstring>
#include <godot_cpp/variant/packed_byte_array.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "convert.h"
#include "error.h"
#include "mesh/grown_bark.h"
#include "tree_reconstruction/tree_reconstruction.h"

using namespace godot;
using treerec::GrownBark;

static std::string_view view_of(const PackedByteArray& p_bytes) {
    return {reinterpret_cast<const char*>(p_bytes.ptr()), size_t(p_bytes.size())};
}

void TreeReconstruction::set_growth_recipe(const String& p_recipe) {
    growth_recipe_ = p_recipe;
    emit_changed();
}

void TreeReconstruction::set_growth_meshes(const Dictionary& p_meshes) {
    growth_meshes_ = p_meshes;
    emit_changed();
}

void TreeReconstruction::set_growth_pending(bool p_pending) {
    if (growth_pending_ != p_pending) {
        growth_pending_ = p_pending;
        emit_changed();
    }
}

void TreeReconstruction::set_grown_bark(const PackedByteArray& p_bark) {
    auto bark = std::make_shared<GrownBark>();
    PackedByteArray kept = p_bark;
    if (!p_bark.is_empty()) {
        try {
            *bark = treerec::unpack_grown_bark(view_of(p_bark));
        } catch (const std::exception& error) {
            ERR_PRINT(to_godot(std::string(error.what())));
            // What a newer version wrote is kept, so that saving loses nothing.
            if (treerec::packed_bark_version(view_of(p_bark)) <= treerec::kGrownBarkVersion) {
                kept = PackedByteArray();
            }
        }
    }
    packed_bark_ = kept;
    parts_.replace([&](SharedParts::Parts& r_parts) { r_parts.bark = bark; });
    emit_changed();
}

std::shared_ptr<const GrownBark> TreeReconstruction::get_bark_on(
    const std::shared_ptr<const treerec::Tree>& p_tree) const {
    return bark_fit_.take(parts_.get().bark, p_tree);
}

bool TreeReconstruction::has_grown_bark() const {
    return !parts_.get().bark->empty();
}

bool TreeReconstruction::is_bark_stale() const {
    return has_grown_bark() && !get_bark_on(get_tree());
}

void TreeReconstruction::set_bark(const GrownBark& p_bark, const String& p_recipe) {
    const std::string packed = treerec::pack_grown_bark(p_bark);
    PackedByteArray bytes;
    bytes.resize(int64_t(packed.size()));
    std::memcpy(bytes.ptrw(), packed.data(), packed.size());
    growth_recipe_ = p_recipe;
    growth_pending_ = false;
    // As a file would give it back, so that it looks the same before it is saved and after.
    set_grown_bark(bytes);
}

void TreeReconstruction::take_bark_of(const Ref<TreeReconstruction>& p_other) {
    ERR_FAIL_COND_MSG(p_other.is_null(), "There is no bark to take over.");
    if (p_other.ptr() == this) {
        return;
    }
    const std::shared_ptr<const GrownBark> bark = p_other->parts_.get().bark;
    growth_recipe_ = p_other->growth_recipe_;
    growth_meshes_ = p_other->growth_meshes_;
    growth_pending_ = p_other->growth_pending_;
    packed_bark_ = p_other->packed_bark_;
    parts_.replace([&](SharedParts::Parts& r_parts) { r_parts.bark = bark; });
    emit_changed();
}

void TreeReconstruction::_bind_bark() {
    ClassDB::bind_method(D_METHOD("take_bark_of", "other"), &TreeReconstruction::take_bark_of);
    ClassDB::bind_method(D_METHOD("set_growth_pending", "pending"), &TreeReconstruction::set_growth_pending);
    ClassDB::bind_method(D_METHOD("is_growth_pending"), &TreeReconstruction::is_growth_pending);
    ClassDB::bind_method(D_METHOD("has_grown_bark"), &TreeReconstruction::has_grown_bark);
    ClassDB::bind_method(D_METHOD("is_bark_stale"), &TreeReconstruction::is_bark_stale);
    ClassDB::bind_method(D_METHOD("set_growth_recipe", "recipe"), &TreeReconstruction::set_growth_recipe);
    ClassDB::bind_method(D_METHOD("get_growth_recipe"), &TreeReconstruction::get_growth_recipe);
    ClassDB::bind_method(D_METHOD("set_growth_meshes", "meshes"), &TreeReconstruction::set_growth_meshes);
    ClassDB::bind_method(D_METHOD("get_growth_meshes"), &TreeReconstruction::get_growth_meshes);
    ClassDB::bind_method(D_METHOD("set_grown_bark", "bark"), &TreeReconstruction::set_grown_bark);
    ClassDB::bind_method(D_METHOD("get_grown_bark"), &TreeReconstruction::get_grown_bark);
    ADD_PROPERTY(PropertyInfo(Variant::STRING, "growth_recipe", PROPERTY_HINT_MULTILINE_TEXT, "",
                              PROPERTY_USAGE_STORAGE),
                 "set_growth_recipe", "get_growth_recipe");
    ADD_PROPERTY(
        PropertyInfo(Variant::DICTIONARY, "growth_meshes", PROPERTY_HINT_NONE, "", PROPERTY_USAGE_STORAGE),
        "set_growth_meshes", "get_growth_meshes");
    ADD_PROPERTY(PropertyInfo(Variant::PACKED_BYTE_ARRAY, "grown_bark", PROPERTY_HINT_NONE, "",
                              PROPERTY_USAGE_STORAGE),
                 "set_grown_bark", "get_grown_bark");
    ADD_PROPERTY(
        PropertyInfo(Variant::BOOL, "growth_pending", PROPERTY_HINT_NONE, "", PROPERTY_USAGE_STORAGE),
        "set_growth_pending", "is_growth_pending");
}
