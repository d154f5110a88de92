extends RefCounted
## A wood of individuals of some scans on a meadow, and a path through it.

const Stage := preload("./stage.gd")
const _SIDE: float = 320.0
const _WALK: float = 14.0

var stage: Stage

var _trees: TreeVariantSpawner3D = TreeVariantSpawner3D.new()
var _from: Vector3


func _init(on: Stage) -> void:
	stage = on
	stage.light_up(46.0, 0.0)
	stage.meadow.density = 24.0
	stage.air.fog_depth_begin = 18.0
	stage.air.fog_depth_end = 330.0
	stage.air.fog_light_color = Color(0.74, 0.82, 0.83)
	# From ahead, aside: leaves glow.
	stage.sun.rotation_degrees = Vector3(-34.0, 214.0, 0.0)
	stage.sun.directional_shadow_max_distance = 120.0


func plant(trees: Array[TreeReconstruction]) -> void:
	_trees.sources = trees
	_trees.region_size = Vector2.ONE * _SIDE
	_trees.density = 1.5
	_trees.minimum_distance = 4.5
	_trees.clumping = 0.35
	_trees.variants = 12
	_trees.amount = 0.7
	_trees.ages = Vector2(0.35, 1.2)
	_trees.size_variation = 0.15
	_trees.season_spread = 0.12
	_trees.view_distance = 400.0
	_trees.seed = 4
	stage.viewport.add_child(_trees)
	if _trees.is_building() or _trees.get_tree_count() == 0:
		await _trees.finished
	# A path: what stands in its way goes.
	for z: int in range(-40, 24, 3):
		var bend: float = 2.2 * sin(z / 11.0)
		for id: int in _trees.find_trees(Vector3(bend, 0.0, z), 2.6):
			_trees.remove(id)


## On the path, at a share of the way.
func stand(share: float) -> void:
	var z: float = 22.0 - _WALK * share
	var at: Vector3 = Vector3(2.2 * sin(z / 11.0), 1.65, z)
	var on: float = z - 14.0
	stage.look(at, Vector3(2.2 * sin(on / 11.0), 3.7, on), 54.0)
