@tool
@icon("../icons/TreeVariantSpawner3D.svg")
class_name TreeVariantSpawner3D
extends Node3D
## Grows a forest of one scanned tree: as many individuals of its kind as you like, at random places
## or at given ones.
##
## Set [member source] and trees stand in a square around this node; in the editor, too. None is a
## copy of the scan: each of the [member variants] is made of the scan's own branches (see [method
## TreeReconstruction.make_variant]) and has its own age, and no two trees are turned, leant and
## toned alike. The same properties give the same forest on every machine.
## [br][br]
## The individuals are built on worker threads ([member threaded]) while the game goes on; [signal
## finished] says when all are there. Trees are drawn cell by cell as multimeshes of whole trees,
## each tree at the level of detail that it needs, and only around the camera. Nothing that is
## built is saved with the scene. What the game takes away and adds is kept through every change of
## the forest; [method get_state] gives it for a saved game or for a player who joins.
## [codeblock]
## var forest := TreeVariantSpawner3D.new()
## forest.source = load("res://oak.res")
## add_child(forest)
## await forest.finished
## forest.take(forest.find_trees(Vector3.ZERO, 10.0)[0]).fell(12)
## [/codeblock]

## Emitted while the forest is made, with the share that is done.
signal progressed(share: float)

## Emitted when all trees stand that are near enough to the camera to be drawn.
signal finished

## Where the trees stand.
enum Placement {
	## At random places in a region that keep their distance.
	SCATTERED,
	## At [member transforms].
	GIVEN,
}

const Checked := preload("checked.gd")
const Forest := preload("spawning/forest.gd")
const Inspecting := preload("spawning/inspecting.gd")
const Listening := preload("spawning/listening.gd")
const Making := preload("spawning/making.gd")
const Navigation := preload("navigation.gd")
const Telling := preload("spawning/telling.gd")
const TreeLevels := preload("tree_levels.gd")
const _MOST_VARIANTS: int = 64
const _FARTHEST: float = 1e6
# How long no property changes before the editor grows the forest again.
const _CALM_SECONDS: float = 0.15

## Whether forests are built on worker threads. Where there are none, as in most web exports, they
## are built on the main thread, a slice per frame.
static var threaded: bool = OS.has_feature("threads")

## The scanned tree that the forest is made of.
@export var source: TreeReconstruction:
	set(value):
		source = value
		_listen()

## Further trees that the forest is made of; each gets its share of the [member variants].
@export var sources: Array[TreeReconstruction] = []:
	set(value):
		sources = value
		_listen()

## How many different individuals there are. Each takes memory once, however many trees it becomes.
@export_range(1, 64) var variants: int = 8:
	set(value):
		variants = clampi(value, 1, _MOST_VARIANTS)
		_change(true)

## How much the individuals differ from their source: 0 is the same tree, 1 as different as its kind
## allows.
@export_range(0.0, 1.0, 0.01) var amount: float = 0.6:
	set(value):
		amount = Checked.number(value, 0.0, 1.0, amount)
		_change(true)

## Another number gives another forest of the same kind.
@warning_ignore("shadowed_global_identifier") @export var seed: int = 1:
	set(value):
		seed = value
		_change(true)

## The ages of the youngest and of the oldest trees, over the source's own.
@export var ages: Vector2 = Vector2(0.6, 1.1):
	set(value):
		ages = Checked.point(value, ages).clamp(Vector2.ONE * 0.2, Vector2.ONE * 1.2)
		_change(true)

## How far the seasons of the earliest and the latest tree are apart (see [member LeafRule.season]).
## It needs a leaf rule.
@export_range(0.0, 0.5, 0.01) var season_spread: float = 0.08:
	set(value):
		season_spread = Checked.number(value, 0.0, 1.0, season_spread)
		_change(true)

@export_group("Places")

## Where the trees stand.
@export var placement: Placement = Placement.SCATTERED:
	set(value):
		placement = value
		notify_property_list_changed()
		_change(false)

## The places of the trees, in this node's frame.
@export var transforms: Array[Transform3D] = []:
	set(value):
		transforms = value
		_change(false)

## The sides of the rectangle around this node that trees stand in, in metres.
@export_custom(PROPERTY_HINT_NONE, "suffix:m") var region_size: Vector2 = Vector2(40.0, 40.0):
	set(value):
		region_size = Checked.point(value, region_size).max(Vector2.ZERO)
		_change(false)

## What trees stand in instead of a rectangle: a [Path3D], whose curve is their edge, or a
## [MeshInstance3D], which is their ground.
@export_node_path("Path3D", "MeshInstance3D") var region: NodePath:
	set(value):
		region = value
		notify_property_list_changed()
		_change(false)

## How many trees there are on 100 square metres, where there is room.
@export_range(0.01, 20.0, 0.01, "or_greater") var density: float = 2.0:
	set(value):
		density = Checked.number(value, 0.0, 1e6, density)
		_change(false)

## How near to each other two trees may stand, in metres.
@export_range(0.0, 20.0, 0.1, "or_greater", "suffix:m") var minimum_distance: float = 3.0:
	set(value):
		minimum_distance = Checked.number(value, 0.0, 1e6, minimum_distance)
		_change(false)

## 0 spreads the trees evenly, 1 leaves glades between thickets.
@export_range(0.0, 1.0, 0.01) var clumping: float = 0.3:
	set(value):
		clumping = Checked.number(value, 0.0, 1.0, clumping)
		_change(false)

## How much smaller and larger than the scan trees are, beside their age.
@export_range(0.0, 0.5, 0.01) var size_variation: float = 0.1:
	set(value):
		size_variation = Checked.number(value, 0.0, 0.9, size_variation)
		_change(false)

## How far trees lean at most, in degrees.
@export_range(0.0, 20.0, 0.1, "degrees") var lean: float = 2.0:
	set(value):
		lean = Checked.number(value, 0.0, 80.0, lean)
		_change(false)

@export_subgroup("Ground", "ground_")

## Whether rays look for the ground: trees stand on the first body above or below the region.
@export var ground_rays: bool = false:
	set(value):
		ground_rays = value
		notify_property_list_changed()
		_change(false)

## The layers of the bodies that rays hit.
@export_flags_3d_physics var ground_mask: int = 1:
	set(value):
		ground_mask = value
		_change(false)

## How far above and below the region rays look, in metres.
@export_range(1.0, 1000.0, 1.0, "or_greater", "suffix:m") var ground_depth: float = 200.0:
	set(value):
		ground_depth = Checked.number(value, 0.0, 1e6, ground_depth)
		_change(false)

## How far trees turn with the ground: 0 stands them upright, 1 at right angles to it.
@export_range(0.0, 1.0, 0.01) var ground_alignment: float = 0.1:
	set(value):
		ground_alignment = Checked.number(value, 0.0, 1.0, ground_alignment)
		_change(false)

## Ground that is steeper bears no tree, in degrees.
@export_range(0.0, 90.0, 1.0, "degrees") var ground_slope_limit: float = 40.0:
	set(value):
		ground_slope_limit = Checked.number(value, 0.0, 180.0, ground_slope_limit)
		_change(false)

## Between which heights of the ground trees stand, in metres of this node's frame.
@export_custom(PROPERTY_HINT_NONE, "suffix:m")
var ground_heights: Vector2 = Vector2(-10000.0, 10000.0):
	set(value):
		ground_heights = value
		_change(false)

@export_group("Looks")

## Whether the trees bear their leaves.
@export var leaves: bool = true:
	set(value):
		leaves = value
		_change(true)

## The bark's material; without one, that of the source's leaf preset.
@export var bark_material: Material:
	set(value):
		bark_material = value
		_change(true)

## The leaves' material; without one, that of the source's leaf preset.
@export var leaf_material: Material:
	set(value):
		leaf_material = value
		_change(true)

## How many levels of detail there are.
@export_range(1, 5) var levels: int = TreeLevels.COUNT:
	set(value):
		levels = clampi(value, 1, TreeLevels.MOST)
		_change(true)

## The distances in metres from which on the next level is shown, one less than there are levels.
## Empty: chosen by the trees' heights.
@export var level_distances: PackedFloat32Array:
	set(value):
		level_distances = value
		_change(true)

## The most triangles that a tree has at each level, the finest first; it becomes as fine as that
## allows. 0: as many as the level has by itself, at most 60,000 for the finest. Those that are
## missing are chosen by the trees' heights.
@export var level_budgets: PackedInt32Array:
	set(value):
		level_budgets = value
		_change(true)

## What stands for trees that are farther away than the last level of detail.
@export var impostor: TreeImpostor:
	set(value):
		impostor = value
		_change(true)

## Trees farther from the camera than this, in metres, are not there.
@export_range(10.0, 2000.0, 1.0, "or_greater", "suffix:m") var view_distance: float = 300.0:
	set(value):
		view_distance = Checked.number(value, 1.0, 1e6, view_distance)
		_change(true)

@export_group("Collision")

## Whether the trees nearest to the camera, or to [member collision_group], have bodies.
@export var collision: bool = false:
	set(value):
		collision = value
		_change(true)

## How near they are, in metres.
@export_range(1.0, 100.0, 0.5, "or_greater", "suffix:m") var collision_distance: float = 20.0:
	set(value):
		collision_distance = Checked.number(value, 0.0, 1e6, collision_distance)
		_change(false)

## Bodies are where the nodes of this group are, such as the players of a game: a server has no
## camera, and a split screen several. Empty: where the camera is.
@export var collision_group: StringName = &""

## How many there are at most.
@export_range(1, 256) var collision_trees: int = 24:
	set(value):
		collision_trees = clampi(value, 0, 4096)
		_change(false)

## How many capsules each has at most.
@export_range(1, 64) var collision_shapes: int = 12:
	set(value):
		collision_shapes = clampi(value, 1, 256)
		_change(true)

## The layers that the bodies are in.
@export_flags_3d_physics var collision_layer: int = 1:
	set(value):
		collision_layer = value
		_change(false)

@export_group("Budgets")

## The megabytes that the meshes may take. Individuals that have no room are not made, and their
## trees take the others' shapes.
@export_range(1, 4096, 1, "or_greater", "suffix:MB") var memory_budget_mb: int = 256:
	set(value):
		memory_budget_mb = maxi(value, 1)
		_change(true)

## The milliseconds that the forest may take of a frame while it is made or the camera moves.
@export_range(0.1, 20.0, 0.1, "suffix:ms") var frame_budget_ms: float = 1.5:
	set(value):
		frame_budget_ms = Checked.number(value, 0.1, 1000.0, frame_budget_ms)

## The camera that the forest is drawn for; without one, that of the viewport.
var camera: Node3D

var _forest: Forest = Forest.new(self)
var _queued: bool = false
var _variants_changed: bool = true
var _calm: float = 0.0
var _telling: Telling = Telling.new()
var _longest: int = 0
var _listening: Listening = Listening.new()


## Makes the forest again, soon. You need it only after changing something that does not say so
## itself, such as the ground.
func rebuild() -> void:
	_change(true)


## Finds the trees' places again, and keeps the individuals.
func rebuild_places() -> void:
	_change(false)


## Whether the forest is being made.
func is_building() -> bool:
	return _queued or _telling.is_busy()


## How many trees stand, near the camera or not.
func get_tree_count() -> int:
	return 0 if _forest.stand == null else _forest.stand.count


## Adds a tree at [param frame], in this node's frame, and returns its id, or [code]-1[/code] with
## an error for a frame that is not finite, or flat. It stays through every change of the forest.
func spawn_at(frame: Transform3D) -> int:
	if not Forest.Stand.can_stand(frame):
		push_error("No tree can stand there: the transform is not finite, or flat.")
		return -1
	return _forest.add(frame)


## Takes the tree [param id] away. It stays away through every change of the forest that leaves its
## place a tree, and ids are never given again.
func remove(id: int) -> void:
	_say(_forest.remove(id), id)


## What the game has done to the forest with [method spawn_at], [method remove] and [method take]:
## numbers, and lists of numbers, which any format saves. Trees keep their ids.
func get_state() -> Dictionary:
	return _forest.changes.to_state()


## Gives the forest back what [method get_state] told, of this machine or of another one that has
## the same forest; an empty dictionary takes all changes back. The places are found again then: see
## [signal finished].
func set_state(state: Dictionary) -> void:
	var wrong: String = _forest.changes.from_state(state)
	if wrong.is_empty():
		rebuild_places()
	else:
		push_error(wrong)


## Takes the tree [param id] out of the forest, and puts a [TreeInstance3D] in its place, which can
## be edited and felled. It is a child of this node.
func take(id: int) -> TreeInstance3D:
	if not _has(id):
		return null
	var made: TreeInstance3D = Making.make_instance(self, id)
	add_child(made)
	_forest.remove(id)
	return made


## Where the tree [param id] stands, in this node's frame.
func get_tree_transform(id: int) -> Transform3D:
	return _forest.stand.frame_of(id) if _has(id) else Transform3D.IDENTITY


## Which individual the tree [param id] is.
func get_tree_variant(id: int) -> int:
	return _forest.individual_of(id) if _has(id) else -1


## The trees within [param distance] metres of a place in this node's frame, the nearest first.
func find_trees(place: Vector3, distance: float) -> PackedInt32Array:
	if _forest.stand == null or not place.is_finite() or is_nan(distance):
		return []
	return _forest.stand.near(place, minf(distance, _FARTHEST))


## The tree whose body this is (see [member collision]), or [code]-1[/code].
func find_tree_of(body: Node) -> int:
	return -1 if body == null or body.get_parent() != self else body.get_meta(Forest.META, -1)


## The individual [param index], 0 to [member variants] - 1, as a tree of its own. It is made anew
## whenever you ask, in some milliseconds.
func get_variant(index: int) -> TreeReconstruction:
	return Making.make_variant(self, index, _forest.seed_of(index), _forest.age_of(index))


## The mesh of an individual that is ready, at a level of detail.
func get_variant_mesh(index: int, level: int = 0) -> ArrayMesh:
	return _forest.get_mesh(index, level)


## All trees that the forest is made of.
func get_all_sources() -> Array[TreeReconstruction]:
	var all: Array[TreeReconstruction] = []
	for one: TreeReconstruction in [source] + sources:
		if one != null and one.get_node_count() > 1 and not all.has(one):
			all.append(one)
	return all


## A number for where all trees stand and which individuals they are: the same on every machine
## that has the same forest, for games on several.
func get_digest() -> String:
	return _forest.get_digest()


## What the forest takes: [code]trees[/code], [code]variants[/code], [code]bytes[/code] of their
## meshes, [code]triangles[/code] of the individuals' levels together, [code]multimeshes[/code] that
## are there, [code]bodies[/code], and [code]longest_ms[/code], the longest time that it took of a
## frame since you asked last.
func get_statistics() -> Dictionary:
	var found: Dictionary = _forest.get_statistics()
	found["longest_ms"] = _longest / 1000.0
	_longest = 0
	return found


func _notification(what: int) -> void:
	Navigation.notify(what)
	match what:
		NOTIFICATION_ENTER_TREE:
			rebuild()
		NOTIFICATION_EXIT_TREE:
			_forest.clear()
			_telling.stop()
		NOTIFICATION_PREDELETE:
			_forest.finish()


func _process(delta: float) -> void:
	var began: int = Time.get_ticks_usec()
	_calm -= delta
	if _queued and _calm <= 0.0:
		_queued = false
		_telling.start()
		_forest.start(_variants_changed, threaded)
		_variants_changed = false
	_forest.go_on(began + int(1000.0 * frame_budget_ms), camera)
	if not _queued:
		_telling.tell(_forest.get_progress(), self)
	_longest = maxi(_longest, Time.get_ticks_usec() - began)


func _validate_property(property: Dictionary) -> void:
	if not Inspecting.is_shown(property.name, self):
		property.usage &= ~PROPERTY_USAGE_EDITOR


func _get_configuration_warnings() -> PackedStringArray:
	return Inspecting.warnings(self, _forest.get_warning())


func _listen() -> void:
	var all: Array[TreeReconstruction] = [source]
	_listening.listen(all + sources, _on_source_changed)
	_change(true)


func _on_source_changed(one: TreeReconstruction) -> void:
	if not _forest.follow_season(one):
		_forest.forget()
		_change(true)


func _change(of_variants: bool) -> void:
	_variants_changed = _variants_changed or of_variants
	_queued = true
	update_configuration_warnings()
	# In the editor a slider that is dragged changes it each frame.
	_calm = _CALM_SECONDS if Engine.is_editor_hint() else 0.0


func _has(id: int) -> bool:
	return _say(_forest.stand != null and _forest.stand.has(id), id)


func _say(has: bool, id: int) -> bool:
	if not has:
		push_error("The forest has no tree %d." % id)
	return has
