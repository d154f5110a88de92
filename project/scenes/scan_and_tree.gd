extends Node3D
## The scan on the left of a line, the tree that was made of it on its right: the slider moves it.
##
## Both halves look at the same world through cameras that stand at the same place. The left one
## lies over the right one, cut off at the line, and sees the points alone.

const DemoTree := preload("demo_tree.gd")
const OrbitCamera := preload("orbit_camera.gd")
const Controls := preload("panel.gd")
const POINTS: Shader = preload("res://demo/points.gdshader")

var _share: float = 0.5
var _material: ShaderMaterial = ShaderMaterial.new()

@onready var _tree: TreeInstance3D = $Tree
@onready var _points: MeshInstance3D = $Points
@onready var _camera: OrbitCamera = $World/Camera
@onready var _panel: Controls = $Panel
@onready var _curtain: Control = $Curtain
@onready var _edge: ColorRect = $Edge
@onready var _viewport: SubViewport = $Curtain/View/Viewport
@onready var _other: Camera3D = $Curtain/View/Viewport/Camera


func _ready() -> void:
	var tree: TreeReconstruction = DemoTree.load_tree()
	_tree.reconstruction = tree
	_camera.turning = 0.1
	_camera.frame(tree.get_aabb())
	# The one on the right does not see the points.
	_camera.cull_mask = 1
	_other.environment = _backdrop()
	_viewport.world_3d = get_viewport().find_world_3d()
	_viewport.msaa_3d = get_viewport().msaa_3d
	_material.shader = POINTS
	_material.set_shader_parameter(&"diameter", 3.0)
	_points.mesh = DemoTree.load_points()
	_points.material_override = _material
	_make_panel(tree)


func _process(_delta: float) -> void:
	var size: Vector2 = get_viewport().get_visible_rect().size
	_viewport.size = Vector2i(size)
	($Curtain/View as Control).size = size
	_curtain.size = Vector2(size.x * _share, size.y)
	_edge.position = Vector2(size.x * _share - 1.0, 0.0)
	_edge.size = Vector2(2.0, size.y)
	_other.global_transform = _camera.global_transform
	_other.fov = _camera.fov
	_other.far = _camera.far


func _make_panel(tree: TreeReconstruction) -> void:
	if _points.mesh == null:
		_panel.begin(
			"Scan and tree",
			"There is no scan here yet: run ./dev demo, or ./dev demo my_scan.ply, then come back."
		)
		_share = 0.0
		return
	_panel.begin("Scan and tree", "Move the line: the scan is on its left, the tree on its right.")
	_panel.slider(
		"Line",
		"How much of the picture shows the scan.",
		Vector3(0.0, 1.0, 0.001),
		_share,
		func(value: float) -> void: _share = value
	)
	_panel.slider(
		"Points",
		"How large the scan's points are drawn, in pixels.",
		Vector3(1.0, 8.0, 0.1),
		3.0,
		func(value: float) -> void: _material.set_shader_parameter(&"diameter", value)
	)
	_panel.check(
		"Leaves", "Whether leaves are shown.", true, func(on: bool) -> void: _tree.leaves = on
	)
	(
		_panel
		. note(
			(
				"%d points, %d nodes"
				% [
					(_points.mesh as ArrayMesh).surface_get_array_len(0),
					tree.get_node_count(),
				]
			)
		)
	)


func _backdrop() -> Environment:
	var paper: Environment = Environment.new()
	paper.background_mode = Environment.BG_COLOR
	paper.background_color = Color(0.91, 0.92, 0.91)
	return paper
