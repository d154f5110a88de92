@tool
@icon("../icons/TreeInstance3D.svg")
class_name TreeInstance3D
extends MeshInstance3D
## Shows a [TreeReconstruction]: its bark as this node's mesh, its leaves as a multimesh.
##
## Set [member reconstruction] and the tree appears as soon as a worker thread has built it; [signal
## rebuilt] says when. The tree is built again when the reconstruction or a property changes, at
## most once a frame. The mesh is never saved with the scene: the reconstruction is, and the tree is
## built again on load.

## Emitted when the mesh and the leaves match the properties again.
signal rebuilt
## Emitted when the further levels of detail do so, too.
signal levels_built

## What other bodies collide with: see [member collision_kind].
enum CollisionKind {
	## Capsules along the trunk and the stout branches: the cheapest.
	CAPSULES,
	## Tapered prisms along them, with flat ends: a cut trunk stands on its cut.
	CONVEX_PARTS,
	## Tapered prisms along the trunk alone.
	TRUNK_ONLY,
}

const Checked := preload("checked.gd")
const Body := preload("tree_body.gd")
const Felling := preload("tree_felling.gd")
const BuildJob := preload("tree_build_job.gd")
const LevelNodes := preload("tree_level_nodes.gd")
const Navigation := preload("navigation.gd")
const OwnMaterials := preload("own_materials.gd")
const LeafNodes := preload("tree_leaf_nodes.gd")
const Levels := preload("tree_levels.gd")
const Looks := preload("tree_looks.gd")
const Reading := preload("spawning/reading.gd")
# What the leaves and the levels take over from this node.
const _SHARED: PackedStringArray = [
	"layers",
	"cast_shadow",
	"gi_mode",
	"transparency",
	"lod_bias",
	"ignore_occlusion_culling",
	"visibility_range_begin",
	"visibility_range_begin_margin",
	"visibility_range_end",
	"visibility_range_end_margin",
	"visibility_range_fade_mode",
]
# Bark of more triangles at level 0, or _FEWER times fewer per level, may give way to leaves.
const _MUCH_BARK: float = 30000.0
const _FEWER: float = 4.65

## Whether trees are built on worker threads. Turn it off to find errors more easily: then they are
## built on the main thread, at the end of the frame.
static var threaded: bool = true

## The tree to show.
@export var reconstruction: TreeReconstruction:
	set(value):
		if reconstruction == value:
			return
		if reconstruction != null:
			reconstruction.changed.disconnect(rebuild)
		reconstruction = value
		if reconstruction != null:
			reconstruction.changed.connect(rebuild)
		update_configuration_warnings()
		rebuild()

## -1: the level of detail that suits the distance is shown. Else always this one: 0 is the finest,
## each further one has about a quarter of the triangles and fewer, larger leaves.
@export_range(-1, 4) var lod: int = -1:
	set(value):
		lod = clampi(value, -1, Levels.MOST - 1)
		rebuild()

## Whether the tree bears its leaves.
@export var leaves: bool = true:
	set(value):
		leaves = value
		rebuild()

## Whether the wind moves this tree. How strongly it blows is set in the materials.
@export var wind: bool = true:
	set(value):
		wind = value
		_set_box(_rest)
		_update_instances()

@export_group("Levels of Detail")
## How many levels take turns by distance, where [member lod] is -1. The first is this node's mesh.
@export_range(1, 5) var levels: int = Levels.COUNT:
	set(value):
		levels = clampi(value, 1, Levels.MOST)
		_levels.begin()

## The distances in metres from which on the next level is shown, one less than there are levels.
## Those that are missing are chosen by the tree's height.
@export var level_distances: PackedFloat32Array:
	set(value):
		level_distances = value
		_update_instances()

## The most triangles that each level may have, the finest first: it becomes as fine as that allows.
## 0, or none: as many as the level has by itself, which are 60,000 for the finest at most. A larger
## budget lifts that.
@export var level_budgets: PackedInt32Array:
	set(value):
		level_budgets = value
		rebuild()

## The level that casts the shadow from the first switch on, so that it doesn't change with the
## others. Nearer, the finest level casts its own, and each leaf is shaded by those that are seen.
@export_range(0, 4) var shadow_level: int = 1:
	set(value):
		shadow_level = clampi(value, 0, Levels.MOST - 1)
		_levels.begin()

## What is shown beyond the last of several levels: see [TreeImpostorBaker].
@export var impostor: TreeImpostor:
	set(value):
		impostor = value
		_update_instances()

@export_group("Materials")
## The bark's material. Without one, the preset of the reconstruction's leaves chooses it.
@export var bark_material: Material:
	set(value):
		bark_material = value
		_update_materials()

## The leaves' material. Without one, the preset of the reconstruction's leaves chooses it.
@export var leaf_material: Material:
	set(value):
		leaf_material = value
		_update_materials()

@export_group("Collision")
## Whether other bodies collide with the trunk and the stout branches. A ray hits a [StaticBody3D]
## whose parent is this node.
@export var collision: bool = false:
	set(value):
		collision = value
		rebuild()

## What the body is made of.
@export var collision_kind: CollisionKind = CollisionKind.CAPSULES:
	set(value):
		collision_kind = value
		rebuild()

## How many shapes the body has at most. They go where they are worth most.
@export_range(1, 256) var collision_shapes: int = 32:
	set(value):
		collision_shapes = clampi(value, 1, 256)
		rebuild()

## Branches thinner than this, in metres from their middle, let everything through.
@export_range(0.0, 1.0, 0.005, "or_greater", "suffix:m") var collision_minimum_radius: float = 0.03:
	set(value):
		collision_minimum_radius = Checked.number(value, 0.0, 1e3, collision_minimum_radius)
		rebuild()

## The layers that the body is in.
@export_flags_3d_physics var collision_layer: int = 1:
	set(value):
		collision_layer = value
		_body.update()

## The layers that the body looks for. A body that does not move needs none.
@export_flags_3d_physics var collision_mask: int = 1:
	set(value):
		collision_mask = value
		_body.update()

## Whether this is wood that was felled: then the [RigidBody3D] that it is a child of gets its
## shapes when it comes into a scene without any, as after loading.
@export_storage var fallen: bool = false

var _foliage: LeafNodes = LeafNodes.new(self, "Leaves", true)
# What own_materials.gd draws this node with.
var _own_material: RefCounted
var _levels: LevelNodes = LevelNodes.new(self)
var _body: Body = Body.new(self)
# The last that it can stand at.
var _place: Transform3D
var _queued: bool = false
var _job: BuildJob
var _reading: Reading = Reading.new()
var _height: float = 1.0
var _rest: AABB
var _budget_warning: String = ""
# The reconstruction, its revision and the level that the mesh was built of.
var _bark_of: Array = []
var _bark_time: float = 0.0
var _leaf_time: float = 0.0


## Builds the tree again, once, before the next frame is drawn or as soon as a build that is under
## way has ended. You need it only after changing something that does not say so itself.
func rebuild() -> void:
	if _queued:
		return
	_queued = true
	_start.call_deferred()


## Cuts the tree at node [param id] and lets what grows above it fall: it becomes a [RigidBody3D]
## beside this node, with its own wood, leaves, weight and moments, and is returned. This tree keeps
## what is below, in a copy of its own of [member reconstruction]; others that share it stay whole.
## With [param stump_body] that collides, too. A tree that is a fallen piece already can be cut
## again: then both halves are bodies, and keep their motion. [param density] is that of green wood
## in kg per cubic metre. Returns [code]null[/code], with an error, where nothing can be cut.
func fell(id: int, density: float = 800.0, stump_body: bool = false) -> RigidBody3D:
	return Felling.fell(self, id, density, stump_body)


## Puts this tree into a [RigidBody3D] in its place, with the weight, the moments and the shapes of
## its wood (see [method fell]), and returns that; of a tree that is in one already, the body gets
## them again. So wood that was saved by itself can fall. [param density] is that of green wood in
## kg per cubic metre. Returns [code]null[/code], with an error, where there is nothing to fall.
func make_body(density: float = 800.0) -> RigidBody3D:
	return Felling.make_body(self, density)


## Gives this tree's body the shapes of its [member reconstruction] as it is now, without waiting
## for the build that a change starts.
func update_collision_now() -> void:
	var parts: Array[Dictionary] = []
	if collision and reconstruction != null:
		parts = Body.Collision.gather(
			reconstruction, collision_kind, collision_shapes, collision_minimum_radius
		)
	_body.fill(parts)


## Whether a build is waiting or under way.
func is_rebuilding() -> bool:
	return _queued or _job != null


## Whether the further levels of detail are waited for.
func is_building_levels() -> bool:
	return is_rebuilding() or _levels.is_building()


## The number of triangles of the bark and the leaves of this node's own mesh, the finest level.
func get_triangle_count() -> int:
	return BuildJob.triangles(mesh) + _foliage.get_triangle_count()


## The number of triangles of a level of detail; 0 where it isn't shown or not built yet.
func get_level_triangle_count(level: int) -> int:
	return get_triangle_count() if level == 0 else _levels.get_triangle_count(level)


## The number of leaf cards of the finest level.
func get_leaf_count() -> int:
	return _foliage.get_count()


## The tree's height in metres of the world, from its wood.
func get_tree_height() -> float:
	return _height * (absf(global_basis.get_scale().y) if is_inside_tree() else 1.0)


## The most triangles that a level may have, or 0.
func get_level_budget(level: int) -> int:
	return maxi(level_budgets[level], 0) if level in range(level_budgets.size()) else 0


## The milliseconds that the bark took when it was built last.
func get_bark_build_time() -> float:
	return _bark_time


## The milliseconds that the leaves took when they grew last.
func get_leaf_build_time() -> float:
	return _leaf_time


func _init() -> void:
	set_notify_local_transform(true)
	_levels.finest_leaves = _foliage
	_levels.built.connect(_on_levels_built)


func _notification(what: int) -> void:
	Navigation.notify(what)
	match what:
		NOTIFICATION_PREDELETE:
			_drop_job()
			_levels.end()
			_body.free_body()
		NOTIFICATION_ENTER_TREE:
			set_notify_transform(true)
			_body.follow()
			_update_instances()
			if fallen:
				# The body can't take children before it is in the scene, too.
				_restore_shapes.call_deferred()
		NOTIFICATION_LOCAL_TRANSFORM_CHANGED:
			_check_place()
			_body.follow()
		NOTIFICATION_TRANSFORM_CHANGED:
			_body.follow()
			_update_instances()


# Before the engine draws it there, and its body collides there.
func _check_place() -> void:
	if transform.is_finite():
		_place = transform
		return
	transform = _place
	push_error(
		"The tree '%s' can't stand at a place that is no number: it stays where it was." % name
	)


func _restore_shapes() -> void:
	Felling.restore_shapes(self)


# The engine asks the script first: so the leaves learn of the properties that they share.
func _set(property: StringName, _value: Variant) -> bool:
	if property in _SHARED:
		_update_instances.call_deferred()
	elif property == &"material_override":
		_update_materials.call_deferred()
	elif property == &"extra_cull_margin":
		_update_margin.call_deferred()
	return false


func _validate_property(property: Dictionary) -> void:
	# The mesh is built, so neither saved nor edited.
	if property.name == &"mesh":
		property.usage = PROPERTY_USAGE_NONE


func _get_configuration_warnings() -> PackedStringArray:
	if reconstruction == null:
		return ["Give this node a TreeReconstruction to show."]
	var warnings: PackedStringArray = _levels.get_warnings()
	if not _budget_warning.is_empty():
		warnings.insert(0, _budget_warning)
	return warnings


func _start() -> void:
	_queued = false
	if reconstruction == null or reconstruction.get_node_count() == 0:
		_drop_job()
		mesh = null
		_bark_of = []
		_levels.clear()
		_foliage.show_nothing()
		_body.fill([])
		rebuilt.emit()
		return
	if _job != null:
		# Its result is out of date already; the next one starts when it has ended.
		_job.stale = true
		return
	var job: BuildJob = BuildJob.new()
	job.take(self)
	# A change of the leaves alone keeps the bark, unless they come or go, or leave it more or less of
	# the level's triangles.
	job.with_bark = (
		mesh == null
		or job.budget > 0
		or BuildJob.triangles(mesh) > _MUCH_BARK / pow(_FEWER, job.lod)
		or _bark_of != [reconstruction, job.revision, job.lod, job.budget, job.leaves]
	)
	if not threaded:
		job.run()
		_apply(job)
		return
	_job = job
	# What the tree is seen with comes meanwhile, a piece per frame.
	_reading.start_paths(Looks.paths_of(reconstruction, bark_material, leaf_material))
	job.task = WorkerThreadPool.add_task(job.run, false, "Build the tree of %s" % name)
	(Engine.get_main_loop() as SceneTree).process_frame.connect(_poll)


func _poll() -> void:
	if (
		_job == null
		or not _reading.poll_paths()
		or not WorkerThreadPool.is_task_completed(_job.task)
	):
		return
	var job: BuildJob = _job
	_drop_job()
	if job.stale:
		rebuild()
	else:
		_apply(job)


# Waits for the worker, so that nothing runs on after this node.
func _drop_job() -> void:
	if _job == null:
		return
	(Engine.get_main_loop() as SceneTree).process_frame.disconnect(_poll)
	WorkerThreadPool.wait_for_task_completion(_job.task)
	_job = null


func _apply(job: BuildJob) -> void:
	job.draw()
	if job.with_bark:
		_apply_bark(job)
		_bark_time = job.bark_time
	_leaf_time = job.leaf_time
	_foliage.fill(job.foliage)
	var box: AABB = AABB() if mesh == null else mesh.get_aabb()
	_set_box(box.merge(job.leaf_box) if job.leaf_box.has_volume() else box)
	_body.fill(job.capsules)
	_budget_warning = job.warning
	_levels.begin()
	_update_materials()
	_update_instances()
	rebuilt.emit()


func _apply_bark(job: BuildJob) -> void:
	var bark: ArrayMesh = job.bark
	_height = maxf(bark.get_aabb().end.y, 0.1)
	mesh = bark
	_bark_of = [job.source, job.revision, job.lod, job.budget, job.leaves]


# Of all that is drawn, at rest. Where the wind may move it is the margin's.
func _set_box(rest: AABB) -> void:
	_rest = rest
	if mesh == null:
		return
	mesh.custom_aabb = rest
	var reach: float = Looks.get_reach(self)
	var parts: Array[GeometryInstance3D] = _levels.get_barks()
	for foliage: LeafNodes in _levels.get_foliage() + [_foliage]:
		parts.append_array(foliage.nodes)
	for part: GeometryInstance3D in parts:
		part.custom_aabb = rest
		part.extra_cull_margin = reach
	_update_margin()


# The property is the user's, who may want more.
func _update_margin() -> void:
	RenderingServer.instance_set_extra_visibility_margin(
		get_instance(), maxf(extra_cull_margin, Looks.get_reach(self))
	)


# All levels share one box.
func _on_levels_built(box: AABB) -> void:
	_set_box(box)
	_update_materials()
	_update_instances()
	update_configuration_warnings()
	levels_built.emit()


func _update_materials() -> void:
	var bark: Material = Looks.bark_of(reconstruction, bark_material)
	if mesh != null and mesh.get_surface_count() > 0:
		mesh.surface_set_material(0, bark)
	_foliage.set_materials(leaf_material)
	OwnMaterials.give(self, bark if material_override == null else material_override)
	for node: GeometryInstance3D in _levels.get_barks():
		node.material_override = bark
		OwnMaterials.give(node, bark)
	for foliage: LeafNodes in _levels.get_foliage():
		foliage.set_materials(leaf_material)
	_levels.update()


# The values that the shaders take per instance.
func _update_instances() -> void:
	if not is_inside_tree():
		return
	var wood: Array[GeometryInstance3D] = _levels.get_barks()
	wood.append(self)
	for node: MultiMeshInstance3D in _foliage.nodes:
		for property: String in _SHARED:
			node.set(property, get(property))
	for foliage: LeafNodes in _levels.get_foliage() + [_foliage]:
		wood.append_array(foliage.nodes)
		foliage.set_season()
	for node: GeometryInstance3D in wood:
		Looks.tell_place(node, self)
	_levels.update()
