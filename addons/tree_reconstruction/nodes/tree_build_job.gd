@tool
extends RefCounted
## One build of a TreeInstance3D's level: what a worker thread needs and what it makes, up to the
## meshes that are drawn, so that the main thread has little left to do. The builders see the
## reconstruction as it was when they began, so it may change meanwhile.

const Collision := preload("tree_collision.gd")
const FLOATS_PER_LEAF: int = 20

var source: TreeReconstruction
var lod: int
## The triangles that it may have; 0: as many as the level has by itself.
var budget: int = 0
var leaves: bool
var task: int = -1
## Whether something has changed since it began.
var stale: bool = false
var with_bark: bool = true
var revision: int
## The bark, where [member with_bark] wants it and [method draw] has made it.
var bark: ArrayMesh
## The leaves, by kind, as [method draw_leaves] makes them; none without any.
var foliage: Array[Dictionary] = []
## All that the leaves may take.
var leaf_box: AABB
var warning: String = ""
var capsules_wanted: int = 0
var capsule_radius: float
## What of TreeInstance3D.CollisionKind they are.
var capsule_kind: int
var capsules: Array[Dictionary] = []
var bark_time: float
var leaf_time: float
# The arrays of the bark.
var _wood: Array = []


## Takes what it needs of [param tree].
func take(tree: TreeInstance3D) -> void:
	source = tree.reconstruction
	capsules_wanted = tree.collision_shapes if tree.collision else 0
	capsule_radius = tree.collision_minimum_radius
	capsule_kind = tree.collision_kind
	lod = maxi(tree.lod, 0)
	budget = tree.get_level_budget(lod)
	leaves = tree.leaves
	revision = source.get_bark_revision()


func run() -> void:
	if capsules_wanted > 0:
		capsules = Collision.gather(source, capsule_kind, capsules_wanted, capsule_radius)
	var started: int = Time.get_ticks_usec()
	if budget == 0 and leaves:
		foliage = source.build_foliage(lod)
		for part: Dictionary in foliage:
			var box: AABB = part.box
			leaf_box = leaf_box.merge(box) if leaf_box.has_volume() else box
	var leafed: int = Time.get_ticks_usec()
	leaf_time = (leafed - started) / 1000.0
	if budget > 0:
		for made: Dictionary in source.build_levels([lod], [budget], false, leaves):
			_wood = made.bark
			warning = made.warning
			foliage = made.foliage
			if leaves:
				leaf_box = made.box
	elif with_bark:
		_wood = source.build_mesh_arrays(lod, false, leaves, leaf_triangles(foliage))
	bark_time = (Time.get_ticks_usec() - leafed) / 1000.0
	if may_workers_draw():
		draw()


## Makes what is drawn of what was built; nothing where [method run] has done so.
func draw() -> void:
	if with_bark and bark == null:
		bark = bark_mesh(_wood)
	foliage = draw_leaves(foliage)


## Whether workers may make meshes. Without a window the engine's lists of them have no lock, so
## that a worker's meshes would get into the places of the game's.
static func may_workers_draw() -> bool:
	return DisplayServer.get_name() != "headless"


## Makes the [code]multimesh[/code] of each kind of leaves in [param kinds] (see [method
## TreeReconstruction.build_foliage]); [code]null[/code] where it has none. Those that are made
## stay.
static func draw_leaves(kinds: Array[Dictionary]) -> Array[Dictionary]:
	for kind: Dictionary in kinds:
		if kind.has("multimesh"):
			continue
		kind.multimesh = leaf_multimesh(kind.leaves, kind.card)
		kind.erase("leaves")
		kind.erase("card")
	return kinds


## The multimesh of [param places] (see [method TreeReconstruction.build_leaf_buffer]), or
## [code]null[/code] where there are none.
static func leaf_multimesh(places: PackedFloat32Array, arrays: Array) -> MultiMesh:
	if places.is_empty():
		return null
	var multimesh: MultiMesh = MultiMesh.new()
	multimesh.transform_format = MultiMesh.TRANSFORM_3D
	multimesh.use_colors = true
	multimesh.use_custom_data = true
	var mesh: ArrayMesh = ArrayMesh.new()
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
	multimesh.mesh = mesh
	@warning_ignore("integer_division")
	multimesh.instance_count = places.size() / FLOATS_PER_LEAF
	multimesh.buffer = places
	return multimesh


## The triangles of all kinds of leaves of a level, as [method TreeReconstruction.build_foliage] or
## [method TreeReconstruction.build_joined_foliage] have made them.
static func leaf_triangles(kinds: Array[Dictionary]) -> int:
	var indices: int = 0
	for kind: Dictionary in kinds:
		var joined: bool = kind.has("arrays")
		var arrays: Array = kind.arrays if joined else kind.card
		if arrays.is_empty():
			continue
		var count: int = (arrays[Mesh.ARRAY_INDEX] as PackedInt32Array).size()
		@warning_ignore("integer_division")
		indices += count * (1 if joined else kind.leaves.size() / FLOATS_PER_LEAF)
	@warning_ignore("integer_division")
	return indices / 3


## The mesh of surface arrays of bark.
static func bark_mesh(arrays: Array) -> ArrayMesh:
	var mesh: ArrayMesh = ArrayMesh.new()
	if not arrays.is_empty():
		mesh.add_surface_from_arrays(
			Mesh.PRIMITIVE_TRIANGLES, arrays, [], {}, TreeReconstruction.MESH_FLAGS
		)
	return mesh


## The number of triangles of [param mesh].
static func triangles(mesh: Mesh) -> int:
	var count: int = 0
	if mesh is ArrayMesh:
		for surface: int in mesh.get_surface_count():
			@warning_ignore("integer_division")
			count += (mesh as ArrayMesh).surface_get_array_index_len(surface) / 3
	return count
