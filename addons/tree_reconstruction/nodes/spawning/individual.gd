@tool
extends RefCounted
## One individual of a forest: how a worker builds it, step by step, and its meshes.

const Materials := preload("materials.gd")
const Collision := preload("../tree_collision.gd")
const TreeLevels := preload("../tree_levels.gd")
# How far the wind moves a tree beyond its box, over its height.
const _SWAY: float = 0.15
# Of one vertex, as the engine keeps it, and of one index.
const _BARK_BYTES: int = 60
const _LEAF_BYTES: int = 68
const _INDEX_BYTES: int = 4


## What leaves of one kind are drawn with.
class Look:
	extends RefCounted
	var material: Material
	## Where the material is read from; empty where it is given.
	var path: String
	## What it takes on (see seasons.gd).
	var season: Dictionary[StringName, Variant] = {}


## A surface that is built and waits to be given to the engine.
class Surface:
	extends RefCounted
	var level: int
	## Of leaves: their kind's place in [member looks]; -1 for bark.
	var kind: int
	var arrays: Array
	var flags: int
	var material: Material
	var name: String
	var bytes: int


## What it is made of.
var source: TreeReconstruction
var number: int = 0
var amount: float = 0.5
var age: float = 1.0
var levels: int = 4
var leaves: bool = true
## How many capsules, and of which branches; none for no bodies.
var capsules_wanted: int = 0
var capsule_radius: float = 0.03
var bark_material: Material
## Where it is read from; empty where it is given.
var bark_path: String
## Of each kind of leaves, the tree's own first.
var looks: Array[Look] = []
## The rule of all leaves of a year, where the material knows the season; else [code]null[/code],
## and the leaves are those of the source's season.
var summer_rule: LeafRule
## How many levels take turns, with those of other meshes that come after these, and where.
var turn_count: int = 4
var level_distances: PackedFloat32Array = []
## The most triangles of each level (see [member TreeVariantSpawner3D.level_budgets]).
var level_budgets: PackedInt32Array = []
## Where the last one ends, in metres.
var farthest: float = 300.0
## What others that would be the same have in common with it.
var key: String

## Set to end its building early.
var stale: bool = false

## What was built.
var surfaces: Array[Surface] = []
var meshes: Array[ArrayMesh] = []
## By level: where it begins, how far before and after that it mixes with the one before, and the
## same for where it ends, in metres.
var turns: Array[Vector4] = []
var triangles: PackedInt32Array = []
## A sentence where a budget could not be kept.
var warning: String = ""
var capsules: Array[Dictionary] = []
## At rest.
var box: AABB
## How far the wind moves it beyond its box, in metres.
var reach: float = 0.0
var height: float = 0.1
var bytes: int = 0

var _tree: TreeReconstruction
var _step: int = 0
var _added: int = 0


## Builds all, for a worker.
func build() -> void:
	while not stale and step():
		pass


## Builds the next part; [code]false[/code] after the last one.
func step() -> bool:
	if _step == 0:
		_tree = source.make_variant(number, amount, age)
		if summer_rule != null:
			_tree.leaf_rule = summer_rule
		if capsules_wanted > 0:
			capsules = Collision.gather(
				_tree, Collision.Kind.CAPSULES, capsules_wanted, capsule_radius
			)
	elif leaves and _step <= levels:
		_add_leaves(_step - 1, _tree.build_joined_foliage(_step - 1))
	elif _step <= (2 if leaves else 1) * levels:
		# Bark has what they leave of its triangles.
		var level: int = _step - (levels if leaves else 0) - 1
		var taken: int = triangles[level] if leaves else 0
		_add(-1, level, _tree.build_mesh_arrays(level, false, leaves, taken))
	elif _step <= (3 if leaves else 2) * levels:
		_fit(_step - (2 if leaves else 1) * levels - 1)
	else:
		_finish()
		return false
	_step += 1
	return true


## Makes the meshes, still empty, and their materials: on the main thread, whose renderer says what
## is in a shader.
func prepare() -> void:
	var distances: PackedFloat32Array = TreeLevels.distances(height, turn_count, level_distances)
	for level: int in turn_count:
		var turn: Vector4 = Vector4.ZERO
		turn.x = distances[level - 1] if level > 0 else 0.0
		turn.z = distances[level] if level < distances.size() else farthest
		turns.append(
			Vector4(
				turn.x, TreeLevels.margin(turn.x), minf(turn.z, farthest), TreeLevels.margin(turn.z)
			)
		)
	for level: int in levels:
		var mesh: ArrayMesh = ArrayMesh.new()
		mesh.custom_aabb = box
		meshes.append(mesh)
		# What each tree needs to know is the material's, not the instance's: in Compatibility there is
		# room for the values of 256 instances.
		var values: Dictionary[StringName, Variant] = {
			&"tree_height": height, &"tree_wind": 1.0, &"tree_levels": turns[level]
		}
		for surface: Surface in surfaces:
			if surface.level == level and surface.kind < 0:
				surface.material = Materials.for_trees(bark_material, values)
			elif surface.level == level:
				var own: Dictionary[StringName, Variant] = values.duplicate()
				own.merge(_season_of(surface.kind))
				surface.material = Materials.for_trees(looks[surface.kind].material, own)


## Gives the engine the next surface. [code]false[/code] after the last one.
func give_surface() -> bool:
	if _added == surfaces.size():
		return false
	var next: Surface = surfaces[_added]
	var mesh: ArrayMesh = meshes[next.level]
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, next.arrays, [], {}, next.flags)
	mesh.surface_set_name(mesh.get_surface_count() - 1, next.name)
	mesh.surface_set_material(mesh.get_surface_count() - 1, next.material)
	next.arrays = []
	_added += 1
	return _added < surfaces.size()


## How many bytes the next surface has.
func next_bytes() -> int:
	return surfaces[_added].bytes if _added < surfaces.size() else 0


## Whether the engine has all of it.
func is_given() -> bool:
	return not meshes.is_empty() and _added == surfaces.size()


## Lets its leaves follow the season, that of each kind as seasons.gd has it; [code]false[/code]
## where its material can't.
func set_season(values: Array[Dictionary]) -> bool:
	for kind: int in mini(looks.size(), values.size()):
		looks[kind].season = values[kind]
	if not leaves:
		return true
	if summer_rule == null:
		return false
	# Before, a worker may be at the surfaces; they get it when they are prepared.
	if not meshes.is_empty():
		for surface: Surface in surfaces:
			if surface.kind >= 0:
				Materials.set_values(surface.material, looks[surface.kind].season)
	return true


# What the material of a kind takes of its season.
func _season_of(kind: int) -> Dictionary[StringName, Variant]:
	if summer_rule != null:
		return looks[kind].season
	# The leaves are those of the season: no shader needs to take away any.
	var colors: Dictionary[StringName, Variant] = looks[kind].season.duplicate()
	colors.erase(&"season_standing")
	colors.erase(&"season_unfolded")
	return colors


# Makes a level that has more triangles than it may have as fine as it may be.
func _fit(level: int) -> void:
	var budget: int = TreeLevels.budget(_tree.get_aabb().end.y, level, level_budgets)
	if budget <= 0 or triangles[level] <= budget:
		return
	for place: int in range(surfaces.size() - 1, -1, -1):
		if surfaces[place].level == level:
			bytes -= surfaces[place].bytes
			surfaces.remove_at(place)
	triangles[level] = 0
	for made: Dictionary in _tree.build_levels([level], [budget], true, leaves):
		_add(-1, level, made.bark)
		_add_leaves(level, made.joined_foliage)
		if warning.is_empty():
			warning = made.warning


func _add_leaves(level: int, kinds: Array[Dictionary]) -> void:
	if triangles.size() <= level:
		triangles.append(0)
	for kind: int in mini(kinds.size(), looks.size()):
		_add(kind, level, kinds[kind].arrays)


func _add(kind: int, level: int, arrays: Array) -> void:
	if triangles.size() <= level:
		triangles.append(0)
	if arrays.is_empty():
		return
	var made: Surface = Surface.new()
	made.level = level
	made.kind = kind
	var bark: bool = kind < 0
	made.name = "bark" if bark else "leaves" if kind == 0 else "leaves_%d" % (kind + 1)
	made.arrays = arrays
	made.flags = (TreeReconstruction.MESH_FLAGS if bark else TreeReconstruction.JOINED_LEAF_FLAGS)
	var places: PackedVector3Array = arrays[Mesh.ARRAY_VERTEX]
	var indices: int = (arrays[Mesh.ARRAY_INDEX] as PackedInt32Array).size()
	made.bytes = places.size() * (_BARK_BYTES if bark else _LEAF_BYTES) + indices * _INDEX_BYTES
	bytes += made.bytes
	@warning_ignore("integer_division")
	triangles[level] += indices / 3
	surfaces.append(made)


func _finish() -> void:
	# In each mesh bark comes first.
	surfaces.sort_custom(
		func(a: Surface, b: Surface) -> bool:
			return a.level < b.level or (a.level == b.level and a.kind < b.kind)
	)
	var rest: AABB = _tree.get_aabb()
	height = maxf(rest.end.y, 0.1)
	box = rest
	for surface: Surface in surfaces:
		# The finest level's leaves reach as far as any.
		if surface.level == 0:
			for place: Vector3 in surface.arrays[Mesh.ARRAY_VERTEX] as PackedVector3Array:
				box = box.expand(place)
	reach = _SWAY * height
	_tree = null
