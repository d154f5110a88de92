@tool
extends RefCounted
## The leaves of one level of a TreeInstance3D: a node for each kind of them that it bears.

const BuildJob := preload("tree_build_job.gd")
const Kinds := preload("leaf_kinds.gd")
const OwnMaterials := preload("own_materials.gd")

## The tree's own kind of leaves stands in the first one, even where there are none of it.
var nodes: Array[MultiMeshInstance3D] = []
## What the leaves of each are like: see [method TreeReconstruction.get_leaf_kinds].
var kinds: Array[Dictionary] = []

var _tree: Node
var _name: String
var _shown: bool


func _init(tree: Node, name: String, shown: bool) -> void:
	_tree = tree
	_name = name
	_shown = shown


## Shows the leaves of [param parts], as tree_build_job.gd draws them.
func fill(parts: Array[Dictionary]) -> void:
	var kept: Array[Dictionary] = []
	for part: Dictionary in parts:
		if kept.is_empty() or part.multimesh != null:
			kept.append(part)
	_resize(kept.size())
	kinds = kept
	for i: int in kept.size():
		nodes[i].multimesh = kept[i].multimesh


## Shows what [param other] shows.
func show_as(other: RefCounted) -> void:
	var shown: Array[MultiMeshInstance3D] = other.nodes
	_resize(shown.size())
	for i: int in shown.size():
		nodes[i].multimesh = shown[i].multimesh
	kinds = (other.kinds as Array[Dictionary]).duplicate()


func set_visible(shown: bool) -> void:
	_shown = shown
	for node: MultiMeshInstance3D in nodes:
		node.visible = shown


func set_box(box: AABB) -> void:
	for node: MultiMeshInstance3D in nodes:
		node.custom_aabb = box


## Draws each kind with its material. [param own] is that of the tree's own leaves;
## [code]null[/code]: the preset's.
func set_materials(own: Material) -> void:
	for i: int in nodes.size():
		var material: Material = own
		if material == null or not Kinds.looks_like(kinds[i], kinds[0]):
			material = load(Kinds.material_path(kinds[i])) as Material
		nodes[i].material_override = material
		OwnMaterials.give(nodes[i], material)


## Sets what the season makes of each kind's colors.
func set_season() -> void:
	for i: int in nodes.size():
		var values: Dictionary[StringName, Variant] = Kinds.season_values(kinds[i].tints)
		for name: StringName in values:
			OwnMaterials.tell(nodes[i], name, values[name])


func get_count() -> int:
	var count: int = 0
	for node: MultiMeshInstance3D in nodes:
		if node.multimesh != null:
			count += node.multimesh.instance_count
	return count


func get_triangle_count() -> int:
	var count: int = 0
	for node: MultiMeshInstance3D in nodes:
		if node.multimesh != null:
			count += node.multimesh.instance_count * BuildJob.triangles(node.multimesh.mesh)
	return count


## There is no tree.
func show_nothing() -> void:
	_resize(mini(nodes.size(), 1))
	kinds = kinds.slice(0, 1)
	for node: MultiMeshInstance3D in nodes:
		node.multimesh = null


func free_nodes() -> void:
	_resize(0)
	kinds.clear()


func _resize(count: int) -> void:
	while nodes.size() > count:
		(nodes.pop_back() as MultiMeshInstance3D).queue_free()
	while nodes.size() < count:
		var node: MultiMeshInstance3D = MultiMeshInstance3D.new()
		node.name = _name if nodes.is_empty() else "%s%d" % [_name, nodes.size() + 1]
		node.visible = _shown
		_tree.add_child(node, false, Node.INTERNAL_MODE_BACK)
		nodes.append(node)
