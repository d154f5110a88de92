@tool
extends RefCounted
## The materials of a TreeInstance3D, and what their shaders take per tree.

const Kinds := preload("leaf_kinds.gd")
const OwnMaterials := preload("own_materials.gd")

# How far the wind moves a tree beyond its box, over its height.
const _SWAY: float = 0.15


## How far the wind moves [param tree] beyond its box, in metres of its own space. What is drawn of
## it is culled that much later, by a margin: its box is that of the tree at rest.
static func get_reach(tree: TreeInstance3D) -> float:
	if not tree.wind or tree.mesh == null:
		return 0.0
	return _SWAY * maxf(tree.mesh.get_aabb().end.y, 0.1)


## [param material], or, without one, that of the tree's leaf preset for its bark.
static func bark_of(of: TreeReconstruction, material: Material) -> Material:
	if material != null or of == null:
		return material
	return load(Kinds.preset_path(of.get_leaf_look(), "bark")) as Material


## Where the materials are that a tree needs beside those that it is given.
static func paths_of(of: TreeReconstruction, bark: Material, leaf: Material) -> PackedStringArray:
	var paths: PackedStringArray = []
	if bark == null:
		paths.append(Kinds.preset_path(of.get_leaf_look(), "bark"))
	var kinds: Array[Dictionary] = of.get_leaf_kinds()
	for kind: Dictionary in kinds:
		if leaf == null or not Kinds.looks_like(kind, kinds[0]):
			paths.append(Kinds.material_path(kind))
	return paths


## What the shaders of any part take. It is set in the server, so that scenes stay free of it.
static func tell_place(part: GeometryInstance3D, tree: TreeInstance3D) -> void:
	OwnMaterials.tell(part, &"tree_height", tree.get_tree_height())
	OwnMaterials.tell(part, &"tree_wind", 1.0 if tree.wind else 0.0)
	OwnMaterials.tell(part, &"tree_origin", tree.global_position)
