// What physics asks a TreeReconstruction for.
#include "convert.h"
#include "mesh/capsules.h"
#include "tree_reconstruction.h"

using namespace godot;

TypedArray<Dictionary> TreeReconstruction::build_capsules(int p_maximum, double p_minimum_radius) const {
    return guarded(TypedArray<Dictionary>(), [&] {
        treerec::CapsuleOptions options;
        options.maximum = p_maximum;
        options.minimum_radius = p_minimum_radius;
        TypedArray<Dictionary> list;
        for (const treerec::Capsule& capsule : treerec::fit_capsules(*get_tree(), options)) {
            Dictionary entry;
            entry["from"] = to_godot(capsule.from);
            entry["to"] = to_godot(capsule.to);
            entry["radius"] = capsule.radius;
            entry["node"] = int64_t(capsule.node);
            list.push_back(entry);
        }
        return list;
    });
}

void TreeReconstruction::_bind_physics() {
    ClassDB::bind_method(D_METHOD("build_capsules", "maximum", "minimum_radius"),
                         &TreeReconstruction::build_capsules, DEFVAL(32), DEFVAL(0.03));
}
