// What physics asks a TreeReconstruction for.
#include "convert.h"
#include "mesh/capsules.h"
#include "mesh/convex_parts.h"
#include "mesh/wood_mass.h"
#include "tree_reconstruction/tree_reconstruction.h"

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

TypedArray<Dictionary> TreeReconstruction::build_convex_parts(int p_maximum, double p_minimum_radius,
                                                              bool p_trunk_only) const {
    return guarded(TypedArray<Dictionary>(), [&] {
        treerec::ConvexOptions options;
        options.maximum = p_maximum;
        options.minimum_radius = p_minimum_radius;
        options.trunk_only = p_trunk_only;
        TypedArray<Dictionary> list;
        for (const treerec::ConvexPart& part : treerec::fit_convex_parts(*get_tree(), options)) {
            PackedVector3Array points;
            for (const treerec::DVec3& point : part.points)
                points.push_back(to_godot(point));
            Dictionary entry;
            entry["points"] = points;
            entry["node"] = int64_t(part.node);
            list.push_back(entry);
        }
        return list;
    });
}

Dictionary TreeReconstruction::weigh(double p_density) const {
    return guarded(Dictionary(), [&] {
        const treerec::WoodMass wood = treerec::weigh_wood(*get_tree(), p_density);
        Dictionary entry;
        entry["mass"] = wood.mass;
        entry["center"] = to_godot(wood.centre);
        entry["inertia"] = to_godot(wood.inertia);
        entry["axes"] = Basis(to_godot(wood.axes[0]), to_godot(wood.axes[1]), to_godot(wood.axes[2]));
        return entry;
    });
}

void TreeReconstruction::_bind_physics() {
    ClassDB::bind_method(D_METHOD("build_capsules", "maximum", "minimum_radius"),
                         &TreeReconstruction::build_capsules, DEFVAL(32), DEFVAL(0.03));
    ClassDB::bind_method(D_METHOD("build_convex_parts", "maximum", "minimum_radius", "trunk_only"),
                         &TreeReconstruction::build_convex_parts, DEFVAL(32), DEFVAL(0.03), DEFVAL(false));
    ClassDB::bind_method(D_METHOD("weigh", "density"), &TreeReconstruction::weigh, DEFVAL(800.0));
}
