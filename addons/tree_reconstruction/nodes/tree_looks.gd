@tool
extends RefCounted
## The materials of a TreeInstance3D, and what their shaders take per tree.

const Materials := preload("spawning/materials.gd")
const OwnMaterials := preload("own_materials.gd")
const _SEASON_PARAMETERS: Array[StringName] = [&"season_early", &"season_late"]


## [param material], or, without one, that of the tree's leaf preset for its [code]bark[/code] or
## [code]leaf[/code].
static func material_of(of: TreeReconstruction, material: Material, part: String) -> Material:
	if material != null or of == null:
		return material
	return load(Materials.preset_path(of, part)) as Material


## Where the materials are that a tree needs beside those that it is given.
static func paths_of(of: TreeReconstruction, bark: Material, leaf: Material) -> PackedStringArray:
	var paths: PackedStringArray = []
	if bark == null:
		paths.append(Materials.preset_path(of, "bark"))
	if leaf == null:
		paths.append(Materials.preset_path(of, "leaf"))
	return paths


## What the shaders of any part take. It is set in the server, so that scenes stay free of it.
static func tell_place(part: GeometryInstance3D, tree: TreeInstance3D) -> void:
	OwnMaterials.tell(part, &"tree_height", tree.get_tree_height())
	OwnMaterials.tell(part, &"tree_wind", 1.0 if tree.wind else 0.0)
	OwnMaterials.tell(part, &"tree_origin", tree.global_position)


## What the season makes of the leaves' colour: of those that are early, and late, in it.
static func tell_season(part: GeometryInstance3D, of: TreeReconstruction) -> void:
	var tints: PackedColorArray = [Color(1.0, 1.0, 1.0, 0.0), Color(1.0, 1.0, 1.0, 0.0)]
	if of != null and of.leaf_rule != null:
		tints = of.leaf_rule.get_season_tints()
	for i: int in 2:
		# Colors would be converted by some renderers and not by others.
		var tint: Color = tints[i].srgb_to_linear()
		OwnMaterials.tell(part, _SEASON_PARAMETERS[i], Vector4(tint.r, tint.g, tint.b, tint.a))
