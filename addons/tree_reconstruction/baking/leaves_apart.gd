@tool
extends RefCounted
## Trees whose leaves are drawn by a multimesh, without the addon.

const _FLOATS_PER_LEAF: int = 20
# A leaf of a multimesh knows where it is, but not its tree. A plain scene tells it by this.
const _SCRIPT: String = """@tool
extends Node3D
## Tells the leaves, for the wind, where their tree is. Needs nothing else.

## What the leaves' shader takes per tree.
@export var values: Dictionary = {}
## What that of further kinds of leaves takes otherwise, by the names of their nodes.
@export var own_values: Dictionary = {}


func _enter_tree() -> void:
	set_notify_transform(true)
	_tell()


func _notification(what: int) -> void:
	if what == NOTIFICATION_TRANSFORM_CHANGED:
		_tell()


func _tell() -> void:
	for leaves: Node in find_children("Leaves*", "MultiMeshInstance3D", true, false):
		for name: StringName in values:
			leaves.set_instance_shader_parameter(name, values[name])
		for name: StringName in own_values.get(leaves.name, {}):
			leaves.set_instance_shader_parameter(name, own_values[leaves.name][name])
		leaves.set_instance_shader_parameter(&"tree_origin", global_position)
		var height: float = values[&"tree_height"] * global_basis.get_scale().y
		leaves.set_instance_shader_parameter(&"tree_height", height)
"""


## The mesh of a leaf: the [param card] of [method TreeReconstruction.build_leaf_form_arrays].
static func mesh(card: Array, material: Material) -> Mesh:
	var made: ArrayMesh = ArrayMesh.new()
	made.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, card)
	made.surface_set_name(0, "leaves")
	made.surface_set_material(0, material)
	return made


## Makes the multimesh of the [param buffer] of [method TreeReconstruction.build_leaf_buffer] and
## the mesh of a leaf.
static func multimesh(buffer: PackedFloat32Array, leaf: Mesh) -> MultiMesh:
	var made: MultiMesh = MultiMesh.new()
	made.transform_format = MultiMesh.TRANSFORM_3D
	made.use_colors = true
	made.use_custom_data = true
	made.mesh = leaf
	@warning_ignore("integer_division")
	made.instance_count = buffer.size() / _FLOATS_PER_LEAF
	made.buffer = buffer
	return made


## Returns [param box] grown to hold the leaves of [param buffer], however the wind turns them.
static func box_around(box: AABB, buffer: PackedFloat32Array) -> AABB:
	for at: int in range(0, buffer.size(), _FLOATS_PER_LEAF):
		var size: Vector3 = Vector3(buffer[at + 1], buffer[at + 5], buffer[at + 9])
		var place: Vector3 = Vector3(buffer[at + 3], buffer[at + 7], buffer[at + 11])
		var reach: Vector3 = Vector3.ONE * size.length()
		box = box.expand(place - reach).expand(place + reach)
	return box


## Makes [param root] tell its leaves [param values] and where it is, and those of further kinds
## [param own_values], by the names of their nodes.
static func teach(
	root: Node3D, values: Dictionary[StringName, Variant], own_values: Dictionary = {}
) -> void:
	var script: GDScript = GDScript.new()
	script.source_code = _SCRIPT
	script.reload()
	root.set_script(script)
	root.set("values", Dictionary(values))
	root.set("own_values", own_values)
