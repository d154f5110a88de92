// What goes into a model file, whatever its format.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "exchange/material_textures.h"
#include "mesh/mesh.h"

namespace treerec {

// What a leaf's picture is multiplied by, as linear light, each 0..1. place: metres, Y up, of the vertex;
// openness: 1 open to the sky, 0 deep in the crown. Empty: leaves are as leaf.gdshader shows the preset's on
// average.
using LeafTint = std::function<Vec3(const Vec3& place, float openness)>;

struct ModelFile {
    const Mesh* bark = nullptr;    // null or without triangles: left out
    const Mesh* leaves = nullptr;  // likewise
    // Coarser levels of detail of the two, the finer first; kept in glTF.
    struct Level {
        const Mesh* bark = nullptr;
        const Mesh* leaves = nullptr;
        double distance = 0.0;  // from which on it is drawn, in heights of the tree
        std::vector<const Mesh*> other_leaves = {};
    };
    std::vector<Level> coarser;
    // Leaves of further kinds, likewise left out where there are none, each with a material of its own:
    // called "leaves_2", "leaves_3", ... by its place.
    struct LeafMaterial {
        std::string rule;                    // foliage/leaf_rule_text.h; kept in glTF
        std::vector<NamedPicture> pictures;  // leaf_albedo and leaf_normal
        LeafTint tint = {};
    };
    std::vector<const Mesh*> other_leaves;
    std::vector<LeafMaterial> other_materials;  // as many
    LeafTint leaf_tint = {};                    // of the tree's own leaves; kept in glTF
    std::string preset = "generic";             // of the textures (foliage/leaves.h)
    // make_pictures(preset) when empty; give them to write several files at the cost of one.
    std::vector<NamedPicture> pictures;
    bool pictures_beside = false;                        // a .glb leaves them out; a .gltf always does
    std::vector<std::pair<std::string, double>> extras;  // kept in glTF: height_m, dbh_m, seed, nodes, ...
};

}  // namespace treerec
