extends Node3D
## One tree with every control on screen: its leaves, season and wind, how fine it is drawn, and how
## far a new individual strays from the scanned one.

const DemoTree := preload("demo_tree.gd")
const OrbitCamera := preload("orbit_camera.gd")
const Controls := preload("panel.gd")

var _scanned: TreeReconstruction
var _rule: LeafRule
var _seed: int = 1
var _amount: float = 0.0
var _age: float = 1.0
# A variant is grown by a worker, one at a time: the last wish counts.
var _task: int = -1
var _wanted: bool = false
var _grown: TreeReconstruction

@onready var _tree: TreeInstance3D = $Tree
@onready var _camera: OrbitCamera = $World/Camera
@onready var _panel: Controls = $Panel


func _ready() -> void:
	_scanned = DemoTree.load_tree()
	_rule = LeafRule.from_preset(_scanned.leaf_preset)
	_show(_scanned)
	_camera.turning = 0.12
	_camera.frame(_scanned.get_aabb())
	_tree.rebuilt.connect(_count)
	_make_panel()


func _exit_tree() -> void:
	if _task >= 0:
		WorkerThreadPool.wait_for_task_completion(_task)


func _process(_delta: float) -> void:
	if _task >= 0 and WorkerThreadPool.is_task_completed(_task):
		WorkerThreadPool.wait_for_task_completion(_task)
		_task = -1
		_show(_grown)
	if _wanted and _task < 0:
		_wanted = false
		_task = WorkerThreadPool.add_task(_grow.bind(_seed, _amount, _age))


func _make_panel() -> void:
	_panel.begin(
		"One tree",
		(
			"This one was scanned. Drag to go round it, turn the wheel to come nearer."
			if DemoTree.is_scanned()
			else "Run ./dev demo to have a scanned tree here. This one grew from a grammar."
		)
	)
	var kinds: PackedStringArray = TreeReconstruction.get_leaf_preset_names()
	_panel.choice(
		"Leaves",
		"What kind of leaves and bark it has.",
		kinds,
		kinds.find(_scanned.leaf_preset),
		func(i: int) -> void: _choose_leaves(kinds[i])
	)
	_panel.check(
		"Bears leaves", "Whether leaves are shown.", true, func(on: bool) -> void: _tree.leaves = on
	)
	_panel.slider(
		"Season",
		"0 is the first day of spring, 0.4 summer, 0.7 autumn; what is left in winter follows.",
		Vector3(0.0, 1.0, 0.01),
		_rule.season,
		func(value: float) -> void: _rule.season = value
	)
	_panel.slider(
		"Leaf size",
		"The length of a leaf card in metres.",
		Vector3(0.05, 0.6, 0.01),
		_rule.leaf_size,
		func(value: float) -> void: _rule.leaf_size = value
	)
	_panel.slider(
		"Wind",
		"How hard it blows: 0 is calm, 1 a strong breeze.",
		Vector3(0.0, 2.0, 0.01),
		1.0,
		_blow
	)
	_panel.slider(
		"Seed",
		"Another seed, another individual. Raise Variation to see it.",
		Vector3(1, 100, 1),
		_seed,
		func(value: float) -> void: _vary(int(value), maxf(_amount, 0.5), _age)
	)
	_panel.slider(
		"Variation",
		"How far the individual is from the scanned tree: 0 is the scan itself.",
		Vector3(0.0, 1.0, 0.01),
		_amount,
		func(value: float) -> void: _vary(_seed, value, _age)
	)
	_panel.slider(
		"Age",
		"1 is as old as the scanned tree.",
		Vector3(0.25, 1.2, 0.01),
		_age,
		func(value: float) -> void: _vary(_seed, _amount, value)
	)
	_panel.choice(
		"Detail",
		"The level of detail: by distance, or one that you choose.",
		["By distance", "0 (finest)", "1", "2", "3"],
		0,
		func(i: int) -> void: _tree.lod = i - 1
	)
	_count()


func _vary(seed_number: int, amount: float, age: float) -> void:
	_seed = seed_number
	_amount = amount
	_age = age
	_wanted = true


func _grow(seed_number: int, amount: float, age: float) -> void:
	_grown = _scanned.make_variant(seed_number, amount, age)


func _show(tree: TreeReconstruction) -> void:
	# A copy, so that nothing of the demo's tree changes.
	if tree == _scanned:
		tree = _scanned.duplicate() as TreeReconstruction
	tree.leaf_rule = _rule
	_tree.reconstruction = tree


func _choose_leaves(kind: String) -> void:
	var season: float = _rule.season
	_rule = LeafRule.from_preset(kind)
	_rule.season = season
	_tree.reconstruction.leaf_rule = _rule


func _blow(strength: float) -> void:
	RenderingServer.global_shader_parameter_set(&"tree_wind_strength", strength)


func _count() -> void:
	var tree: TreeReconstruction = _tree.reconstruction
	(
		_panel
		. note(
			(
				"%d nodes, %d triangles, %d leaves\nbuilt in %.1f + %.1f ms (bark, leaves), on a worker"
				% [
					tree.get_node_count(),
					_tree.get_triangle_count(),
					_tree.get_leaf_count(),
					_tree.get_bark_build_time(),
					_tree.get_leaf_build_time(),
				]
			)
		)
	)
