@tool
extends RefCounted
## The materials of a TreeInstance3D, and what their shaders take per tree.

const OwnMaterials := preload("own_materials.gd")
const _PRESETS: String = "res://addons/tree_reconstruction/presets/%s_%s.tres"
const _SEASON_PARAMETERS: Array[StringName] = [&"season_early", &"season_late"]


## [param material], or, without one, that of the tree's leaf preset for its [code]bark[/code] or
## [code]leaf[/code].
static func material_of(of: TreeReconstruction, material: Material, part: String) -> Material:
	if material != null or of == null:
		return material
	if part == "leaf" and of.are_leaves_single():
		part = "blade"
	var path: String = _PRESETS % [of.get_leaf_look(), part]
	if not ResourceLoader.exists(path):
		path = _PRESETS % ["generic", part]
	return load(path) as Material


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
