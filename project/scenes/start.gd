extends Node3D
## The list of the demo scenes, in front of the tree that they are about.

const DemoTree := preload("demo_tree.gd")
const OrbitCamera := preload("orbit_camera.gd")
const Controls := preload("panel.gd")

# File, name, and what there is to see.
const _SCENES: Array[Array] = [
	["one_tree", "One tree, every control", "Leaves, season, wind, age, new individuals, detail."],
	[
		"scan_and_tree",
		"The scan beside its tree",
		"A line to move between what was scanned and made."
	],
	["forest", "A forest of one tree", "Thousands of individuals of a single scan, in the wind."],
	["felling", "Felling", "Cut trees where you click, and see them fall."],
]

@onready var _tree: TreeInstance3D = $Tree
@onready var _camera: OrbitCamera = $World/Camera
@onready var _list: Controls = $Scenes


func _ready() -> void:
	var tree: TreeReconstruction = DemoTree.load_tree()
	_tree.reconstruction = tree
	_camera.turning = 0.12
	_camera.frame(tree.get_aabb())
	(
		_list
		. begin(
			"Tree Reconstruction",
			(
				"One scanned tree, and what a game can do with it."
				if DemoTree.is_scanned()
				else "Run ./dev demo to see a scanned tree here; until then one that grew from a grammar."
			),
			false
		)
	)
	for scene: Array in _SCENES:
		_list.button(scene[1], scene[2], _open.bind("res://scenes/%s.tscn" % scene[0]))


func _open(path: String) -> void:
	get_tree().change_scene_to_file(path)
