@tool
@icon("../icons/TreeReconstruction.svg")
class_name TreeImpostor
extends Resource
## A tree as one card with pictures of it from all sides, for where it is too far away for more.
##
## [TreeImpostorBaker] makes it, and the button [i]Bake impostor…[/i] of the editor's dock. Show it
## by itself, as one mesh or as that of a [MultiMesh]:
## [codeblock]
## var card := MeshInstance3D.new()
## card.mesh = impostor.get_mesh()
## [/codeblock]
## It takes 8 triangles. Lights, shadows, seasons and the wind reach it as they do the tree.
## [br][br]
## A card follows one rule of season, that of the tree's own leaves. Leaves of further kinds, which
## some of the wood has by a rule of its own, stay as they were when it was baked.

## The version of what is saved. A file of a newer one is refused.
const FORMAT_VERSION: int = 1
# How far the wind moves a tree beyond its box, over its height.
const _SWAY: float = 0.15
# The card bends in the wind at so many heights.
const _ROWS: int = 4

## The version that this one was saved with.
@export_storage var format_version: int = FORMAT_VERSION:
	set(value):
		format_version = value
		if value > FORMAT_VERSION:
			push_error(
				(
					"This impostor is of a newer version of Tree Reconstruction."
					+ " Update the addon, or bake it again."
				)
			)

## What the card is drawn with: the pictures, and what they are of.
@export var material: ShaderMaterial:
	set(value):
		material = value
		_mesh = null
		emit_changed()

## The tree's box at rest, in metres.
@export var box: AABB:
	set(value):
		box = value
		_mesh = null
		emit_changed()

## How high the tree's wood reaches, in metres.
@export_range(0.1, 100.0, 0.01, "or_greater", "suffix:m") var height: float = 10.0:
	set(value):
		height = value
		_mesh = null
		emit_changed()

## What tells whether the tree is still the one that this was baked of: see [method is_of].
@export_storage var fingerprint: int = 0

var _mesh: ArrayMesh


## The card, with its material. It lies flat in the tree's box and stands up where it is drawn.
func get_mesh() -> ArrayMesh:
	if _mesh == null:
		_mesh = make_mesh(material)
	return _mesh


## As [method get_mesh], but a new one with another material.
func make_mesh(with: Material) -> ArrayMesh:
	var arrays: Array = []
	arrays.resize(Mesh.ARRAY_MAX)
	var places: PackedVector3Array = []
	var uvs: PackedVector2Array = []
	var indices: PackedInt32Array = []
	for row: int in _ROWS + 1:
		for side: int in 2:
			var at: Vector2 = Vector2(side, float(row) / _ROWS)
			uvs.append(at)
			places.append(box.position + box.size * Vector3(at.x, at.y, 0.5))
	for row: int in _ROWS:
		var first: int = 2 * row
		indices.append_array(
			PackedInt32Array([first, first + 2, first + 1, first + 1, first + 2, first + 3])
		)
	arrays[Mesh.ARRAY_VERTEX] = places
	arrays[Mesh.ARRAY_TEX_UV] = uvs
	arrays[Mesh.ARRAY_INDEX] = indices
	var made: ArrayMesh = ArrayMesh.new()
	made.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
	made.surface_set_name(0, "impostor")
	made.surface_set_material(0, with)
	made.custom_aabb = box.grow(_SWAY * maxf(height, 0.1))
	return made


## Whether it was baked of [param tree] as it is now: its wood, its leaves and their looks, though
## not how its season colors them, which the card follows.
func is_of(tree: TreeReconstruction) -> bool:
	return tree != null and fingerprint == fingerprint_of(tree)


## What [method is_of] compares.
static func fingerprint_of(tree: TreeReconstruction) -> int:
	var rule: Dictionary[StringName, String] = {}
	if tree.leaf_rule != null:
		for property: Dictionary in tree.leaf_rule.get_property_list():
			var stored: bool = property.usage & PROPERTY_USAGE_STORAGE
			if stored and not "season" in property.name and not "resource" in property.name:
				# Words, since objects are told apart by what differs from run to run.
				rule[property.name] = var_to_str(tree.leaf_rule.get(property.name))
		rule[&"season"] = "%.2f" % tree.leaf_rule.get_standing_share()
	var all: Array = [tree.skeleton, tree.get_leaf_look(), tree.are_leaves_single(), rule]
	for kind: Dictionary in tree.get_leaf_kinds():
		# The card does not follow what the season makes of other kinds.
		if kind.look != tree.get_leaf_look():
			for tint: Color in kind.tints as PackedColorArray:
				all.append(tint if tint.a > 0.0 else Color.TRANSPARENT)
	return hash(all)
