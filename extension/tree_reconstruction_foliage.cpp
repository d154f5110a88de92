// What TreeReconstruction keeps of the leaves that the scan saw.
#include <godot_cpp/variant/packed_color_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>
#include <utility>

#include "convert.h"
#include "error.h"
#include "tree_reconstruction.h"

using namespace godot;

void TreeReconstruction::set_leaf_density(treerec::Foliage p_foliage) {
    {
        const std::lock_guard lock(mutex_);
        foliage_ = std::make_shared<const treerec::Foliage>(std::move(p_foliage));
    }
    newer_foliage_ = Dictionary();
    emit_changed();
}

std::shared_ptr<const treerec::Foliage> TreeReconstruction::get_leaf_density() const {
    const std::lock_guard lock(mutex_);
    return foliage_;
}

void TreeReconstruction::set_foliage(const Dictionary& p_foliage) {
    treerec::Foliage foliage;
    Dictionary newer;
    const Variant version = p_foliage.get("format_version", 0);
    if (p_foliage.is_empty()) {
        // The default: the scan saw none.
    } else if (version.get_type() != Variant::INT || int64_t(version) < 1) {
        ERR_PRINT(
            "The saved foliage is damaged: it doesn't say its format version. Reconstruct the tree again.");
    } else if (int64_t(version) > FOLIAGE_VERSION) {
        newer = p_foliage;
        ERR_PRINT(vformat(
            "This foliage was saved by a newer version of the addon (format %d; this one reads up to %d), so "
            "the leaves stand by the rules alone. Update the addon to see them.",
            version, int(FOLIAGE_VERSION)));
    } else {
        foliage = guarded(treerec::Foliage(), [&] { return foliage_from_dictionary(p_foliage); });
    }
    set_leaf_density(std::move(foliage));
    newer_foliage_ = newer;
}

Dictionary TreeReconstruction::get_foliage() const {
    if (!newer_foliage_.is_empty()) {
        return newer_foliage_;
    }
    const std::shared_ptr<const treerec::Foliage> foliage = get_leaf_density();
    return foliage->empty() ? Dictionary() : to_dictionary(*foliage, FOLIAGE_VERSION);
}

void TreeReconstruction::set_foliage_followed(bool p_followed) {
    {
        const std::lock_guard lock(mutex_);
        leaf_rules_.follow_foliage = p_followed;
    }
    emit_changed();
}

bool TreeReconstruction::is_foliage_followed() const {
    return get_leaf_rules().follow_foliage;
}

bool TreeReconstruction::has_foliage() const {
    return !get_leaf_density()->empty();
}

PackedVector3Array TreeReconstruction::get_foliage_positions() const {
    const std::shared_ptr<const treerec::Foliage> foliage = get_leaf_density();
    PackedVector3Array positions;
    positions.resize(int64_t(foliage->cells.size()));
    Vector3* write = positions.ptrw();
    for (const treerec::FoliageCell& cell : foliage->cells) {
        *write++ = to_godot(foliage->centre(cell));
    }
    return positions;
}

PackedColorArray TreeReconstruction::get_foliage_colors() const {
    const std::shared_ptr<const treerec::Foliage> foliage = get_leaf_density();
    PackedColorArray colors;
    if (!foliage->colored) {
        return colors;
    }
    colors.resize(int64_t(foliage->cells.size()));
    Color* write = colors.ptrw();
    for (const treerec::FoliageCell& cell : foliage->cells) {
        *write++ = Color(float(cell.color[0]) / 255.0f, float(cell.color[1]) / 255.0f,
                         float(cell.color[2]) / 255.0f);
    }
    return colors;
}
