@tool
extends RefCounted
## The levels of detail of a TreeInstance3D beyond its own mesh: builds them once the tree has come
## to rest, and lets them take turns by distance.

## Emitted when all levels match the tree again, with the box that they share, at rest.
signal built(box: AABB)

const Levels := preload("tree_levels.gd")
const BuildJob := preload("tree_build_job.gd")
const Card := preload("tree_impostor_card.gd")
const OwnMaterials := preload("own_materials.gd")
const LeafNodes := preload("tree_leaf_nodes.gd")
# In the editor, the further levels wait until nothing has changed for so many milliseconds: what is
# seen from near comes first.
const _QUIET: int = 500
# What all parts take over from the tree's node.
const _SHARED: PackedStringArray = [
	"layers", "gi_mode", "transparency", "lod_bias", "ignore_occlusion_culling"
]
const _OFF := GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
const _ONLY := GeometryInstance3D.SHADOW_CASTING_SETTING_SHADOWS_ONLY

## The finest level's leaves.
var finest_leaves: LeafNodes
var _tree: TreeInstance3D
# The further levels, finest first, and what casts the shadows of all but the finest.
var _parts: Array[Part] = []
var _shadow: Part
# What is shown beyond the last level, if the tree has it.
var _card: Card
var _job: LevelsJob
var _made: Array[Dictionary] = []
var _due: int = -1
var _ready: bool = false
var _listening: bool = false


func _init(tree: TreeInstance3D) -> void:
	_tree = tree


## Hides all levels but the tree's own mesh, which has changed or is about to.
func reset() -> void:
	_ready = false
	_due = -1
	_made.clear()
	if _job != null:
		_job.stale = true
	update()


## Builds the levels anew, as the tree is now.
func begin() -> void:
	reset()
	if not is_wanted():
		clear()
		return
	if TreeInstance3D.threaded:
		_due = Time.get_ticks_msec() + (_QUIET if Engine.is_editor_hint() else 0)
		_listen()
		return
	var job: LevelsJob = _new_job()
	job.run()
	_made = job.made
	while not _made.is_empty():
		_apply_next()


## Whether levels are waited for.
func is_building() -> bool:
	return _due >= 0 or _job != null or not _made.is_empty()


## Whether the tree is to be shown in levels.
func is_wanted() -> bool:
	return (
		_tree.lod < 0
		and _tree.levels > 1
		and _tree.mesh != null
		and _tree.reconstruction != null
		and _tree.reconstruction.get_node_count() > 0
	)


## Whether levels take turns now.
func is_shown() -> bool:
	return _ready and is_wanted() and _tree.cast_shadow != _ONLY


## The number of triangles of the level at [param level], from 1 on; 0 if it is not there.
func get_triangle_count(level: int) -> int:
	if level < 1 or level > _parts.size() or not _ready:
		return 0
	return _parts[level - 1].triangles


## A sentence for each budget that could not be kept.
func get_warnings() -> PackedStringArray:
	var warnings: PackedStringArray = []
	for part: Part in _parts:
		if not part.warning.is_empty():
			warnings.append(part.warning)
	return warnings


## What is drawn of the bark of the further levels and their shadow.
func get_barks() -> Array[GeometryInstance3D]:
	var found: Array[GeometryInstance3D] = []
	for part: Part in _all():
		found.append(part.bark)
	return found


## What is drawn of their leaves.
func get_foliage() -> Array[LeafNodes]:
	var found: Array[LeafNodes] = []
	for part: Part in _all():
		found.append(part.leaves)
	return found


## Ends what is under way and frees all parts.
func clear() -> void:
	_ready = false
	_due = -1
	_made.clear()
	if _job != null:
		WorkerThreadPool.wait_for_task_completion(_job.task)
		_job = null
	_stop_listening()
	for part: Part in _all():
		part.free_nodes()
	_parts.clear()
	_shadow = null


## Waits for the worker, so that nothing runs on after the tree's node, which frees the parts.
func end() -> void:
	if _job != null:
		WorkerThreadPool.wait_for_task_completion(_job.task)
		_job = null
	_stop_listening()


## Sets where each level is seen, and what casts shadows.
func update() -> void:
	if not _tree.is_inside_tree():
		return
	var shown: bool = is_shown()
	var count: int = _parts.size() + 1
	var switches: PackedFloat32Array = Levels.distances(
		_tree.get_tree_height(), count + (1 if _tree.impostor != null else 0), _tree.level_distances
	)
	# From near, leaves lie in the shadow of just those that are seen: those of another level, larger
	# or elsewhere, would leave dark blotches on them.
	var finest: Vector4 = _turn_of(0, switches) if shown else Vector4.ZERO
	_show(_tree, _tree.cast_shadow, finest)
	for part: GeometryInstance3D in finest_leaves.nodes:
		_show(part, _tree.cast_shadow, finest)
	for level: int in _parts.size():
		_parts[level].set_visible(shown)
		for part: GeometryInstance3D in _parts[level].get_nodes():
			_share(part)
			_show(part, _OFF, _turn_of(level + 1, switches))
	_update_card(shown and _tree.impostor != null, switches)
	if _shadow != null:
		_shadow.set_visible(shown and _tree.cast_shadow != _OFF)
		for part: GeometryInstance3D in _shadow.get_nodes():
			_share(part)
			part.gi_mode = GeometryInstance3D.GI_MODE_DISABLED
			# The finest level and the card cast their own.
			var first: Vector4 = _turn_of(1, switches)
			var last: Vector4 = _turn_of(_parts.size(), switches)
			_show(part, _ONLY, Vector4(first.x, first.y, last.z, last.w))


func _update_card(shown: bool, switches: PackedFloat32Array) -> void:
	if not shown:
		if _card != null:
			_card.queue_free()
			_card = null
		return
	if _card == null:
		_card = Card.new()
		_card.name = &"Impostor"
		_tree.add_child(_card, false, Node.INTERNAL_MODE_BACK)
	_card.show_for(_tree)
	_share(_card)
	_show(_card, _tree.cast_shadow, _turn_of(_parts.size() + 1, switches))


func _share(part: GeometryInstance3D) -> void:
	for property: String in _SHARED:
		part.set(property, _tree.get(property))


# Where a level begins and ends, each with its margin; 0 where it has no such end.
func _turn_of(level: int, switches: PackedFloat32Array) -> Vector4:
	var turn: Vector4 = Vector4.ZERO
	if level > 0:
		turn.x = switches[level - 1]
		turn.y = Levels.margin(turn.x)
	if level < switches.size():
		turn.z = switches[level]
		turn.w = Levels.margin(turn.z)
	return turn


# Lets the engine draw it wherever its shader shows some of it, within what the node is set to.
func _show(
	part: GeometryInstance3D, shadow: GeometryInstance3D.ShadowCastingSetting, turn: Vector4
) -> void:
	var mixed: bool = _tree.mesh != null and _mixes(part)
	if not mixed:
		turn.y = 0.0
		turn.w = 0.0
	# The engine measures from the middle of the box, the shader from half the tree's height.
	var slack: float = _slack() if mixed else 0.0
	var begin: float = maxf(turn.x - turn.y - slack, 0.0)
	var end: float = turn.z + turn.w + slack if turn.z > 0.0 else 0.0
	var begin_margin: float = 0.0
	var end_margin: float = 0.0
	if _tree.visibility_range_begin > begin:
		begin = _tree.visibility_range_begin
		begin_margin = _tree.visibility_range_begin_margin
	if _tree.visibility_range_end > 0.0 and (end == 0.0 or _tree.visibility_range_end < end):
		end = _tree.visibility_range_end
		end_margin = _tree.visibility_range_end_margin
	OwnMaterials.tell(part, &"tree_levels", turn)
	if part == _tree:
		# Its own properties are the user's.
		var server: Object = RenderingServer
		server.instance_geometry_set_cast_shadows_setting(part.get_instance(), shadow)
		server.instance_geometry_set_visibility_range(
			part.get_instance(),
			begin,
			end,
			begin_margin,
			end_margin,
			_tree.visibility_range_fade_mode
		)
		return
	part.cast_shadow = shadow
	part.visibility_range_begin = begin
	part.visibility_range_begin_margin = begin_margin
	part.visibility_range_end = end
	part.visibility_range_end_margin = end_margin
	part.visibility_range_fade_mode = _tree.visibility_range_fade_mode


# How far the middle of the box is from half the tree's height above its base, in metres.
func _slack() -> float:
	var height: float = _tree.get_tree_height()
	var middle: Vector3 = _tree.global_position + Vector3(0.0, 0.5 * height, 0.0)
	return middle.distance_to(_tree.global_transform * _tree.mesh.get_aabb().get_center())


# Whether its material knows how to mix levels.
func _mixes(part: GeometryInstance3D) -> bool:
	var material: Material = part.material_override
	if part == _tree and material == null and _tree.mesh != null:
		if _tree.mesh.get_surface_count() > 0:
			material = _tree.mesh.surface_get_material(0)
	var shaded: ShaderMaterial = material as ShaderMaterial
	return shaded != null and shaded.shader != null and "tree_levels" in shaded.shader.code


func _new_job() -> LevelsJob:
	var job: LevelsJob = LevelsJob.new()
	job.source = _tree.reconstruction
	job.leaves = _tree.leaves
	for level: int in range(1, _tree.levels):
		job.numbers.append(level)
		job.budgets.append(_tree.get_level_budget(level))
	return job


func _listen() -> void:
	if not _listening:
		_listening = true
		(Engine.get_main_loop() as SceneTree).process_frame.connect(_poll)


func _stop_listening() -> void:
	if _listening:
		_listening = false
		(Engine.get_main_loop() as SceneTree).process_frame.disconnect(_poll)


func _poll() -> void:
	if _job != null:
		if not WorkerThreadPool.is_task_completed(_job.task):
			return
		WorkerThreadPool.wait_for_task_completion(_job.task)
		if not _job.stale:
			_made = _job.made
		_job = null
	elif not _made.is_empty():
		# One a frame, so that no frame is long.
		_apply_next()
	elif _due >= 0 and not is_wanted():
		_due = -1
	elif _due >= 0:
		if Time.get_ticks_msec() >= _due:
			_due = -1
			_job = _new_job()
			_job.task = WorkerThreadPool.add_task(_job.run, false, "Levels of %s" % _tree.name)
	else:
		_stop_listening()


func _apply_next() -> void:
	var wanted: int = _tree.levels - 1
	var level: int = wanted - _made.size()
	var made: Dictionary = _made.pop_front()
	LevelsJob.draw(made)
	while _parts.size() > wanted:
		var last: Part = _parts.pop_back()
		last.free_nodes()
	if level == _parts.size():
		_parts.append(Part.new(_tree, "Level%d" % (level + 1)))
	_parts[level].fill(made)
	if not _made.is_empty():
		return
	_fill_shadow()
	_ready = true
	built.emit(made.box)


func _fill_shadow() -> void:
	if _shadow == null:
		_shadow = Part.new(_tree, "Shadow")
	var level: int = clampi(_tree.shadow_level, 0, _parts.size())
	if level == 0:
		_shadow.bark.mesh = _tree.mesh
		_shadow.leaves.show_as(finest_leaves)
	else:
		_shadow.bark.mesh = _parts[level - 1].bark.mesh
		_shadow.leaves.show_as(_parts[level - 1].leaves)


func _all() -> Array[Part]:
	var all: Array[Part] = _parts.duplicate()
	if _shadow != null:
		all.append(_shadow)
	return all


# The nodes of one level.
class Part:
	extends RefCounted

	var bark: MeshInstance3D = MeshInstance3D.new()
	var leaves: LeafNodes
	var triangles: int = 0
	var warning: String = ""

	func _init(tree: Node, name: String) -> void:
		bark.name = name
		bark.visible = false
		tree.add_child(bark, false, Node.INTERNAL_MODE_BACK)
		leaves = LeafNodes.new(tree, name + "Leaves", false)

	func fill(made: Dictionary) -> void:
		bark.mesh = made.bark
		leaves.fill(made.foliage)
		triangles = made.triangles
		warning = made.warning

	func set_visible(shown: bool) -> void:
		bark.visible = shown
		leaves.set_visible(shown)

	func get_nodes() -> Array[GeometryInstance3D]:
		var nodes: Array[GeometryInstance3D] = [bark]
		nodes.append_array(leaves.nodes)
		return nodes

	func free_nodes() -> void:
		bark.queue_free()
		leaves.free_nodes()


# What a worker thread needs and makes.
class LevelsJob:
	extends RefCounted

	var source: TreeReconstruction
	var numbers: PackedInt32Array
	var budgets: PackedInt32Array
	var leaves: bool
	var task: int = -1
	var stale: bool = false
	var made: Array[Dictionary] = []

	func run() -> void:
		made = source.build_levels(numbers, budgets, false, leaves)
		if BuildJob.may_workers_draw():
			for level: Dictionary in made:
				draw(level)

	## Makes what is drawn of a level, where [method run] has not done so.
	static func draw(level: Dictionary) -> void:
		if level.bark is Array:
			level.bark = BuildJob.bark_mesh(level.bark)
		level.foliage = BuildJob.draw_leaves(level.foliage)
