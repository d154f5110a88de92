@tool
extends RefCounted
## What of a forest is drawn: for each cell near enough, each individual in it and each level of
## detail a multimesh of whole trees. They come and go with the camera, a few per frame.

const Stand := preload("stand.gd")
# How much earlier a cell is made than it is seen, in metres and by its size.
const _AHEAD: float = 4.0
const _AHEAD_SHARE: float = 0.25
# Nodes that wait to be used again.
const _MOST_SPARE: int = 256


## One level of detail of one individual: where it begins and ends, in metres.
class Turn:
	extends RefCounted
	var mesh: Mesh
	var begin: float = 0.0
	var end: float = 0.0
	var begin_margin: float = 0.0
	var end_margin: float = 0.0
	## How far the wind moves what stands there beyond its box, in metres at its usual size.
	var reach: float = 0.0
	## Over the size of what stands there.
	var scale: float = 1.0
	var shadow: bool = true
	## Whether each tree knows for itself when it is its turn; else its cell does.
	var by_tree: bool = false


## A cell of one level that is there, or is being made.
class Shown:
	extends RefCounted
	var parts: Dictionary[int, MultiMeshInstance3D] = {}


## What is to be made: these individuals of a cell of a level.
class Task:
	extends RefCounted
	var level: int
	var key: Vector2i
	var places: PackedInt32Array
	var done: int = 0


## The node that bears what is drawn.
var parent: Node3D
var stand: Stand
## By individual, then by level.
var turns: Array[Array] = []
## How far a level reaches, by level: the farthest of all individuals'.
var ends: PackedFloat32Array = []
var begins: PackedFloat32Array = []

## How many multimeshes are drawn at most.
var count: int = 0

var _shown: Array[Dictionary] = []
# The nearest last.
var _queue: Array[Task] = []
var _goners: Array[MultiMeshInstance3D] = []
var _spare: Array[MultiMeshInstance3D] = []
# Of the stand before: they have meshes that may not be there for long.
var _old: Array[MultiMeshInstance3D] = []
var _viewer: Vector3 = Vector3.INF


## Begins anew with another stand; what was shown goes, a few per frame.
func start(of: Stand, individuals: int) -> void:
	for level: Dictionary in _shown:
		for shown: Shown in level.values():
			_old.append_array(shown.parts.values())
	_old.append_array(_goners + _spare)
	_goners = []
	_spare = []
	_shown = []
	_queue = []
	_viewer = Vector3.INF
	count = 0
	stand = of
	turns = []
	for i: int in individuals:
		turns.append([])
	begins = []
	ends = []
	for i: int in stand.grids.size():
		_shown.append({})
		begins.append(INF)
		ends.append(0.0)


## Frees all that is drawn.
func clear() -> void:
	for level: Dictionary in _shown:
		for shown: Shown in level.values():
			for part: MultiMeshInstance3D in shown.parts.values():
				part.queue_free()
	for part: MultiMeshInstance3D in _goners + _spare + _old:
		part.queue_free()
	_shown = []
	_queue = []
	_goners = []
	_spare = []
	_old = []
	_viewer = Vector3.INF
	stand = null
	count = 0


## An individual is ready: these are its levels of detail, the finest first.
func add_individual(place: int, mine: Array[Turn]) -> void:
	for level: int in mine.size():
		# A forest that ends before a level begins has none of it.
		if mine[level].begin < mine[level].end:
			begins[level] = minf(begins[level], mine[level].begin - mine[level].begin_margin)
			ends[level] = maxf(ends[level], mine[level].end + mine[level].end_margin)
	turns[place] = mine
	var cells: Array[Array] = []
	for level: int in _shown.size():
		for key: Vector2i in _shown[level]:
			cells.append([_away(level, key), level, key])
	_enqueue(cells, PackedInt32Array([place]))
	_viewer = Vector3.INF


## Which individual stands for another one: those that the budget had no room for share the others'.
func stand_in(individual: int) -> int:
	return individual % maxi(turns.size(), 1)


## All of a tree's cells are made again: it is new, or gone.
func touch(at: Vector3, individual: int) -> void:
	for level: int in _shown.size():
		var key: Vector2i = stand.grids[level].cell_at(at)
		if _shown[level].has(key):
			_add_task(level, key, PackedInt32Array([stand_in(individual)]))
	_viewer = Vector3.INF


## Decides what should be there for a camera at [param viewer].
func look_from(viewer: Vector3) -> void:
	if stand == null or viewer.distance_to(_viewer) < 0.5 * _AHEAD:
		return
	_viewer = viewer
	var cells: Array[Array] = []
	for level: int in _shown.size():
		_look_at(level, cells)
	var places: PackedInt32Array = []
	for place: int in turns.size():
		if not turns[place].is_empty():
			places.append(place)
	_enqueue(cells, places)


## Makes what is missing until [param deadline] (see [method Time.get_ticks_usec]); returns whether
## all is there.
func work(deadline: int) -> bool:
	while not is_done():
		if Time.get_ticks_usec() >= deadline:
			return false
		if not _old.is_empty():
			(_old.pop_back() as MultiMeshInstance3D).queue_free()
			continue
		if not _goners.is_empty():
			_drop(_goners.pop_back())
			continue
		var next: Task = _queue.back()
		if next.done < next.places.size():
			next.done += 1
			_make(next.level, next.key, next.places[next.done - 1])
		else:
			_queue.pop_back()
	return true


func is_done() -> bool:
	return _queue.is_empty() and _goners.is_empty() and _old.is_empty()


## All that is drawn, for tests.
func get_parts() -> Array[MultiMeshInstance3D]:
	var parts: Array[MultiMeshInstance3D] = []
	for level: Dictionary in _shown:
		for shown: Shown in level.values():
			for part: MultiMeshInstance3D in shown.parts.values():
				parts.append(part)
	return parts


# What comes from far to near is taken from the end.
func _enqueue(cells: Array[Array], places: PackedInt32Array) -> void:
	cells.sort_custom(func(a: Array, b: Array) -> bool: return a[0] > b[0])
	for cell: Array in cells:
		_add_task(cell[1], cell[2], places)


func _add_task(level: int, key: Vector2i, places: PackedInt32Array) -> void:
	var task: Task = Task.new()
	task.level = level
	task.key = key
	task.places = places
	_queue.append(task)


# Adds the cells that are new to `cells`: how far away, level, cell.
func _look_at(level: int, cells: Array[Array]) -> void:
	var grid: Stand.Grid = stand.grids[level]
	var shown: Dictionary = _shown[level]
	var ahead: float = _AHEAD + _AHEAD_SHARE * grid.size
	var reach: float = ends[level] + ahead + grid.size
	var wanted: Dictionary[Vector2i, bool] = {}
	if reach > 0.0 and ends[level] > begins[level]:
		var low: Vector2i = grid.cell_at(_viewer - Vector3.ONE * reach)
		var high: Vector2i = grid.cell_at(_viewer + Vector3.ONE * reach)
		for key: Vector2i in Stand.keys_between(grid, low, high):
			var box: AABB = grid.cells[key].box
			var away: float = box.get_center().distance_to(_viewer)
			var half: float = 0.5 * box.size.length() + ahead
			if away - half < ends[level] and away + half > begins[level]:
				wanted[key] = true
				if not shown.has(key):
					shown[key] = Shown.new()
					cells.append([away, level, key])
	for key: Vector2i in shown.keys():
		if not wanted.has(key):
			for part: MultiMeshInstance3D in (shown[key] as Shown).parts.values():
				part.visible = false
				_goners.append(part)
				count -= 1
			shown.erase(key)


func _away(level: int, key: Vector2i) -> float:
	var cell: Stand.Cell = stand.grids[level].cells.get(key)
	return INF if cell == null else cell.box.get_center().distance_to(_viewer)


func _make(level: int, key: Vector2i, place: int) -> void:
	var shown: Shown = _shown[level].get(key)
	if shown == null or turns[place].size() <= level:
		return
	var buffer: PackedFloat32Array = []
	var box: AABB
	var cell: Stand.Cell = stand.grids[level].cells.get(key)
	var kinds: Array = cell.rows.keys() if cell != null else []
	for kind: int in kinds:
		if stand_in(kind) != place:
			continue
		for row: int in cell.rows[kind]:
			var at: int = Stand.FLOATS * row
			var base: Vector3 = stand.place_of_row(row)
			box = box.expand(base) if not buffer.is_empty() else AABB(base, Vector3.ZERO)
			buffer.append_array(stand.buffer.slice(at, at + Stand.FLOATS))
	var scale: float = turns[place][level].scale
	if scale != 1.0:
		for at: int in buffer.size():
			# The axes, not the place.
			if at % Stand.FLOATS < 12 and at % 4 < 3:
				buffer[at] *= scale
	var part: MultiMeshInstance3D = shown.parts.get(place)
	if buffer.is_empty():
		if part != null:
			shown.parts.erase(place)
			_goners.append(part)
			count -= 1
		return
	if part == null:
		part = _take_part()
		shown.parts[place] = part
		count += 1
	_fill(part, buffer, turns[place][level], box)


func _fill(part: MultiMeshInstance3D, buffer: PackedFloat32Array, turn: Turn, bases: AABB) -> void:
	var multimesh: MultiMesh = part.multimesh
	multimesh.mesh = turn.mesh
	@warning_ignore("integer_division")
	multimesh.instance_count = buffer.size() / Stand.FLOATS
	multimesh.buffer = buffer
	# Trees turn about their bases and grow by their scale.
	var mesh_box: AABB = (turn.mesh as ArrayMesh).custom_aabb
	var wide: float = 0.0
	for i: int in 8:
		var corner: Vector3 = mesh_box.get_endpoint(i)
		wide = maxf(wide, Vector2(corner.x, corner.z).length())
	var largest: float = stand.largest * turn.scale
	wide *= largest
	var low: float = maxf(-mesh_box.position.y, 0.0) * largest
	var high: float = mesh_box.end.y * largest
	var box: AABB = AABB(
		bases.position - Vector3(wide, low, wide),
		bases.size + Vector3(2.0 * wide, low + high, 2.0 * wide)
	)
	multimesh.custom_aabb = box
	part.custom_aabb = box
	part.extra_cull_margin = turn.reach * stand.largest
	# The engine measures to the middle of the box.
	var off: float = 0.0
	if turn.by_tree:
		off = 0.5 * bases.size.length() + bases.get_center().distance_to(box.get_center())
	part.visibility_range_begin = maxf(turn.begin - turn.begin_margin - off, 0.0)
	part.visibility_range_end = turn.end + turn.end_margin + off
	if not turn.by_tree:
		part.visibility_range_begin = turn.begin
		part.visibility_range_end = turn.end
	part.cast_shadow = (
		GeometryInstance3D.SHADOW_CASTING_SETTING_ON
		if turn.shadow
		else GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
	)
	part.visible = true


func _take_part() -> MultiMeshInstance3D:
	if not _spare.is_empty():
		return _spare.pop_back()
	var part: MultiMeshInstance3D = MultiMeshInstance3D.new()
	part.multimesh = MultiMesh.new()
	part.multimesh.transform_format = MultiMesh.TRANSFORM_3D
	part.multimesh.use_colors = true
	part.multimesh.use_custom_data = true
	part.gi_mode = GeometryInstance3D.GI_MODE_DISABLED
	parent.add_child(part, false, Node.INTERNAL_MODE_BACK)
	return part


func _drop(part: MultiMeshInstance3D) -> void:
	if _spare.size() >= _MOST_SPARE:
		part.queue_free()
		return
	part.visible = false
	# It keeps its mesh: the renderer forgets none.
	part.multimesh.instance_count = 0
	_spare.append(part)
