@tool
extends RefCounted
## What a [TreeVariantSpawner3D] does: builds the individuals, finds the places, and draws the trees
## around a camera.

const Changes := preload("changes.gd")
const Individual := preload("individual.gd")
const LeafKinds := preload("../leaf_kinds.gd")
const Individuals := preload("individuals.gd")
const Leftovers := preload("leftovers.gd")
const Materials := preload("materials.gd")
const Reading := preload("reading.gd")
const Scatter := preload("scatter.gd")
const Seasons := preload("seasons.gd")
const Stand := preload("stand.gd")
const Cells := preload("cells.gd")
const Bodies := preload("bodies.gd")
const Region := preload("region.gd")
const TreeLevels := preload("../tree_levels.gd")
## Where a body keeps the id of its tree.
const META: StringName = Bodies.META
# Cells over the distance at which their level ends.
const _CELL_SHARE: float = 0.45
# Likewise over the view's distance, of cells that all levels share.
const _SHARED_CELL: float = 0.15
const _LEAST_CELL: float = 6.0
# How deep the bases of trees are in the ground, in metres.
const _SINK: float = 0.03
const _MEGABYTE: int = 1_000_000
# What the individuals are of the work where they are built, too.
const _INDIVIDUALS_SHARE: float = 0.8
# Places of the spawner's enumeration.
const _GIVEN: int = 1

## The trees, as soon as their places are known.
var stand: Stand
## What the game has done to them.
var changes: Changes = Changes.new()

# A TreeVariantSpawner3D: its settings are read when the forest starts.
var _node: Node3D
var _individuals: Individuals = Individuals.new()
var _cells: Cells = Cells.new()
var _bodies: Bodies = Bodies.new()
var _reading: Reading = Reading.new()
var _seasons: Seasons = Seasons.new()
var _region: Region
# Materials of the cards, by individual.
var _cards: Dictionary[int, Material] = {}
var _with_individuals: bool = true
# Whether each tree knows its level of detail; else a cell shows one.
var _by_tree: bool = false
var _threaded: bool = true


func _init(node: Node3D) -> void:
	_node = node
	_cells.parent = node
	_bodies.parent = node


## Begins anew; with other individuals, too, or with those that there are.
func start(with_individuals: bool, threaded: bool) -> void:
	var from: Array[TreeReconstruction] = _node.get_all_sources()
	if from.is_empty():
		clear()
		return
	# What is drawn stays until there is something else.
	_threaded = threaded
	_leave_places()
	_with_individuals = with_individuals or _individuals.ready.is_empty()
	if _with_individuals:
		_individuals.stop()
		_individuals.threaded = threaded
		_individuals.budget = _node.memory_budget_mb * _MEGABYTE
		var others: Array[Material] = []
		if _has_card():
			others.append(_node.impostor.material)
		_seasons.start(from, _node.season_spread)
		_reading.start(_plans(from), others)
	_region = _make_region(_sizes(from))
	_region.start(threaded)


## Builds and draws until [param deadline] (see [method Time.get_ticks_usec]), for [param camera]
## or, without one, for that of the viewport.
func go_on(deadline: int, camera: Node3D) -> void:
	Leftovers.tidy()
	if _reading.is_busy():
		var plans: Array[Individual] = _reading.poll()
		if not plans.is_empty():
			_start_individuals(plans)
	var fresh: PackedInt32Array = _individuals.poll(deadline)
	if not _reading.is_busy() and _region != null and _region.poll(deadline):
		stand = _region.stand
		_region.tell()
		_region = null
		changes.apply(stand)
		_start_cells()
	elif stand != null:
		# Where the budget ended, others stand for those that it had no room for.
		if _cells.turns.size() > maxi(_individuals.accepted, 1):
			_start_cells()
		else:
			_add_to_cells(fresh)
	if stand == null:
		return
	var viewer: Vector3 = _find_viewer(camera)
	_cells.look_from(viewer)
	_cells.work(deadline)
	if _node.collision and not Engine.is_editor_hint():
		_bodies.reach = _node.collision_distance
		_bodies.most = _node.collision_trees
		_bodies.layer = _node.collision_layer
		_bodies.look_from(_find_bodied(viewer), stand)
		while Time.get_ticks_usec() < deadline and _bodies.make_next(stand, _ready_of):
			pass


## Ends what is under way.
func stop() -> void:
	_reading.stop()
	_individuals.stop()
	if _region != null:
		_region.stop()
		_region = null


## Ends for good, and waits for the workers.
func finish() -> void:
	stop()
	Leftovers.wait()


## Takes all away.
func clear() -> void:
	stop()
	_leave_places()
	_cells.clear()


## What was built of a tree that has changed is not used again.
func forget() -> void:
	Individuals.forget()


## The share of the work that is done, from 0: 1 when all is there.
func get_progress() -> float:
	var placed: bool = stand != null or (_region == null and _individuals.ready.is_empty())
	if (
		placed
		and not _reading.is_busy()
		and (_individuals.is_done() or _node.get_all_sources().is_empty())
		and _cells.is_done()
	):
		return 1.0
	var built: float = _INDIVIDUALS_SHARE if _with_individuals else 0.0
	var rest: float = 0.5 * (1.0 - built) if placed else 0.0
	return built * (0.0 if _reading.is_busy() else _individuals.progress()) + rest


## The leaves of a tree's individuals follow its season, if the change of it that was just heard of
## is one of the season and their materials know it; [code]false[/code] where they have to be built
## again.
func follow_season(of: TreeReconstruction) -> bool:
	if not _seasons.follow(of):
		return false
	var values: Array[Dictionary] = _seasons.get_values(of)
	for index: int in _individuals.get_all().size():
		var one: Individual = _individuals.get_all()[index]
		if one.source != of:
			continue
		if not one.set_season(values):
			return false
		if _cards.has(index):
			Materials.set_values(_cards[index], values[0])
	return true


## Adds a tree; returns its id.
func add(frame: Transform3D) -> int:
	var id: int = changes.add(frame)
	if stand != null:
		stand.add_again(id, frame)
		_cells.touch(frame.origin, stand.individual_of(id))
		_bodies.touch()
	return id


## Takes a tree away, at once or, while the places are looked for, when they are there;
## [code]false[/code] where there is none.
func remove(id: int) -> bool:
	if stand == null:
		if _region == null and not changes.has_added(id):
			return false
		changes.remove_later(id)
		return true
	if not stand.has(id):
		return false
	var individual: int = stand.individual_of(id)
	var place: Vector3 = stand.place_of(id)
	changes.remove(id, place)
	stand.remove(id)
	_cells.touch(place, individual)
	_bodies.touch()
	return true


## Which individual a tree is.
func individual_of(id: int) -> int:
	return _cells.stand_in(stand.individual_of(id))


## The seed of an individual.
func seed_of(index: int) -> int:
	return Scatter.mix(_node.seed, index) & 0x7fffffff


## The age of an individual. Ages are spread evenly.
func age_of(index: int) -> float:
	var share: float = index + Scatter.share(Scatter.mix(_node.seed, 1000 + index))
	return snappedf(lerpf(_node.ages.x, _node.ages.y, share / _node.variants), 0.001)


## How many individuals are ready.
func get_ready_count() -> int:
	var count: int = 0
	for one: Individual in _individuals.ready:
		count += 1 if one != null else 0
	return count


## A sentence where a budget of triangles could not be kept, of one individual.
func get_warning() -> String:
	for one: Individual in _individuals.ready:
		if one != null and not one.warning.is_empty():
			return one.warning
	return ""


## A mesh of an individual that is ready.
func get_mesh(index: int, level: int) -> ArrayMesh:
	if index < 0 or index >= _individuals.ready.size() or _individuals.ready[index] == null:
		return null
	var meshes: Array[ArrayMesh] = _individuals.ready[index].meshes
	return meshes[level] if level >= 0 and level < meshes.size() else null


## See [method TreeVariantSpawner3D.get_digest].
func get_digest() -> String:
	var all: HashingContext = HashingContext.new()
	all.start(HashingContext.HASH_SHA256)
	for index: int in _node.variants:
		all.update(var_to_bytes([seed_of(index), _node.amount, age_of(index)]))
	if stand != null:
		stand.add_to(all)
	return all.finish().hex_encode()


## See [method TreeVariantSpawner3D.get_statistics].
func get_statistics() -> Dictionary:
	var triangles: PackedInt32Array = []
	triangles.resize(_node.levels)
	for one: Individual in _individuals.ready:
		if one != null:
			for level: int in mini(one.triangles.size(), triangles.size()):
				triangles[level] += one.triangles[level]
	return {
		"trees": 0 if stand == null else stand.count,
		"variants": get_ready_count(),
		"bytes": _individuals.bytes,
		"triangles": triangles,
		"multimeshes": _cells.count,
		"bodies": _bodies.get_count()
	}


func _leave_places() -> void:
	if _region != null:
		_region.stop()
		_region = null
	stand = null
	_bodies.clear()


func _start_individuals(plans: Array[Individual]) -> void:
	for plan: Individual in plans:
		if Materials.knows_seasons(plan.looks[0].material):
			plan.summer_rule = Seasons.summer_rule(plan.source)
	_individuals.start(plans)
	# Some may be another forest's, which has heard of the season later.
	for one: Individual in _individuals.get_all():
		one.set_season(_seasons.get_values(one.source))


func _start_cells() -> void:
	_cards = {}
	var before: Array = [_cells.stand]
	_cells.start(stand, maxi(_individuals.accepted, 1))
	if before[0] != stand:
		Leftovers.drop(before, _threaded)
	var ready: PackedInt32Array = []
	for index: int in _individuals.accepted:
		if _individuals.ready[index] != null:
			ready.append(index)
	_add_to_cells(ready)


func _add_to_cells(ready: PackedInt32Array) -> void:
	for index: int in ready:
		_cells.add_individual(index, _turns(index))
		_bodies.touch()


# The levels of an individual, and the card that stands for it where it is far away.
func _turns(index: int) -> Array[Cells.Turn]:
	var one: Individual = _individuals.ready[index]
	var turns: Array[Cells.Turn] = []
	for level: int in one.turns.size():
		var turn: Cells.Turn = Cells.Turn.new()
		turn.begin = one.turns[level].x
		turn.begin_margin = one.turns[level].y
		turn.end = one.turns[level].z
		turn.end_margin = one.turns[level].w
		turn.by_tree = _by_tree
		turn.reach = one.reach
		if level < one.meshes.size():
			turn.mesh = one.meshes[level]
		else:
			turn.scale = one.height / _node.impostor.height
			turn.mesh = _make_card(index)
			turn.by_tree = _by_tree and Materials.knows_levels(_node.impostor.material)
		turns.append(turn)
	return turns


func _make_card(index: int) -> ArrayMesh:
	var one: Individual = _individuals.ready[index]
	var impostor: TreeImpostor = _node.impostor
	var values: Dictionary[StringName, Variant] = {
		&"tree_height": impostor.height, &"tree_wind": 1.0, &"tree_levels": one.turns.back()
	}
	values.merge(one.looks[0].season)
	_cards[index] = Materials.for_trees(impostor.material, values)
	var card: ArrayMesh = impostor.make_mesh(_cards[index])
	card.custom_aabb = impostor.box
	return card


func _plans(from: Array[TreeReconstruction]) -> Array[Individual]:
	var plans: Array[Individual] = []
	for index: int in _node.variants:
		var plan: Individual = Individual.new()
		plan.source = from[index % from.size()]
		plan.number = seed_of(index)
		plan.amount = _node.amount
		plan.age = age_of(index)
		plan.turn_count = _count_levels()
		plan.levels = mini(_node.levels, plan.turn_count)
		plan.level_distances = _node.level_distances
		plan.level_budgets = _node.level_budgets
		plan.farthest = _node.view_distance
		plan.leaves = _node.leaves
		plan.capsules_wanted = _node.collision_shapes if _node.collision else 0
		plan.bark_material = _node.bark_material
		if plan.bark_material == null:
			plan.bark_path = LeafKinds.preset_path(plan.source.get_leaf_look(), "bark")
		var kinds: Array[Dictionary] = plan.source.get_leaf_kinds()
		for i: int in kinds.size():
			var look: Individual.Look = Individual.Look.new()
			look.season = _seasons.get_values(plan.source)[i]
			look.material = _node.leaf_material
			if look.material == null or not LeafKinds.looks_like(kinds[i], kinds[0]):
				look.material = null
				look.path = LeafKinds.material_path(kinds[i])
			plan.looks.append(look)
		plan.key = str(
			[
				plan.source.get_instance_id(),
				plan.number,
				plan.amount,
				plan.age,
				plan.levels,
				plan.turn_count,
				plan.level_distances,
				plan.level_budgets,
				plan.farthest,
				plan.leaves,
				plan.capsules_wanted,
				plan.bark_material,
				_node.leaf_material,
				_node.season_spread
			]
		)
		plans.append(plan)
	return plans


# With the card.
func _count_levels() -> int:
	return mini(_node.levels + (1 if _has_card() else 0), TreeLevels.MOST)


func _has_card() -> bool:
	return _node.impostor != null and _node.impostor.material != null


# How large the cells of each level are.
func _sizes(from: Array[TreeReconstruction]) -> PackedFloat32Array:
	var height: float = 0.0
	for one: TreeReconstruction in from:
		height = maxf(height, one.get_aabb().end.y)
	var distances: PackedFloat32Array = TreeLevels.distances(
		height, _count_levels(), _node.level_distances
	)
	_by_tree = true
	for material: Material in [_node.bark_material, _node.leaf_material]:
		if material != null and not Materials.knows_levels(material):
			_by_tree = false
	var sizes: PackedFloat32Array = []
	for level: int in _count_levels():
		var end: float = distances[level] if level < distances.size() else _node.view_distance
		# Where a cell shows one level, all levels have the same cells.
		if not _by_tree and not distances.is_empty():
			end = maxf(distances[0], _SHARED_CELL * _node.view_distance)
		sizes.append(maxf(_CELL_SHARE * minf(end, _node.view_distance), _LEAST_CELL))
	return sizes


func _make_region(sizes: PackedFloat32Array) -> Region:
	var made: Region = Region.new()
	made.stand = Stand.new(sizes)
	made.stand.number = _node.seed
	made.stand.variety = _node.variants
	made.stand.smallest_scale = 1.0 - _node.size_variation
	made.stand.largest_scale = 1.0 + _node.size_variation
	made.stand.lean = tan(deg_to_rad(_node.lean))
	made.stand.alignment = _node.ground_alignment
	made.stand.sink = _SINK
	made.is_given = _node.placement == _GIVEN
	made.given = _node.transforms.duplicate()
	made.scatter.number = _node.seed
	made.scatter.density = _node.density
	made.scatter.distance = _node.minimum_distance
	made.scatter.clumping = _node.clumping
	made.scatter.size = _node.region_size
	made.scatter.steepest = deg_to_rad(_node.ground_slope_limit)
	made.scatter.lowest = _node.ground_heights.x
	made.scatter.highest = _node.ground_heights.y
	made.rays = _node.ground_rays
	made.ray_mask = _node.ground_mask
	made.ray_depth = _node.ground_depth
	var place: Node3D = _node.get_node_or_null(_node.region) as Node3D
	made.read_scene(_node, place)
	if place is Path3D and not (place as Path3D).curve_changed.is_connected(_node.rebuild_places):
		(place as Path3D).curve_changed.connect(_node.rebuild_places)
	return made


# The individual of a tree, if it is ready.
func _ready_of(id: int) -> Individual:
	var index: int = individual_of(id)
	return _individuals.ready[index] if index < _individuals.ready.size() else null


func _find_viewer(camera: Node3D) -> Vector3:
	var from: Node3D = camera if is_instance_valid(camera) else null
	if from == null and Engine.is_editor_hint():
		from = _get_editor_camera()
	if from == null:
		from = _node.get_viewport().get_camera_3d()
	if from == null or not from.is_inside_tree():
		return Vector3.ZERO
	return Stand.into(_node.global_transform) * from.global_position


# Around what trees have bodies.
func _find_bodied(viewer: Vector3) -> PackedVector3Array:
	if _node.collision_group.is_empty():
		return [viewer]
	var found: PackedVector3Array = []
	var here: Transform3D = Stand.into(_node.global_transform)
	for node: Node in _node.get_tree().get_nodes_in_group(_node.collision_group):
		if node is Node3D:
			found.append(here * (node as Node3D).global_position)
	return found


# The class is the editor's own: no game has it.
static func _get_editor_camera() -> Camera3D:
	if not Engine.has_singleton(&"EditorInterface"):
		return null
	var viewport: SubViewport = Engine.get_singleton(&"EditorInterface").call(
		&"get_editor_viewport_3d", 0
	)
	return viewport.get_camera_3d() if viewport != null else null
