extends Node3D
## Three trees to be felled: a click cuts where it hits, and what is above falls.

const DemoTree := preload("demo_tree.gd")
const OrbitCamera := preload("orbit_camera.gd")
const Controls := preload("panel.gd")

const _TREES: int = 3
# What is cut gets a push in the direction in which one looks: metres and radians a second.
const _PUSH: float = 0.25
const _TURN: float = 0.12
# A drag shorter than this many pixels is a click.
const _CLICK: float = 6.0

var _source: TreeReconstruction
var _pressed_at: Vector2
var _density: float = 800.0
var _fallen: int = 0

@onready var _trees: Node3D = $Trees
@onready var _camera: OrbitCamera = $World/Camera
@onready var _panel: Controls = $Panel


func _ready() -> void:
	_source = DemoTree.load_tree()
	_panel.begin("Felling", "Click wood to cut it there. What was cut can be cut again.")
	_panel.slider(
		"Density",
		"Of green wood, in kilograms per cubic metre.",
		Vector3(300, 1200, 10),
		_density,
		func(value: float) -> void: _density = value
	)
	_panel.button("New trees", "Clears the place and plants three others.", _plant)
	_plant()


func _plant() -> void:
	for child: Node in _trees.get_children():
		child.queue_free()
	_fallen = 0
	var height: float = _source.get_aabb().size.y
	for i: int in _TREES:
		var tree: TreeInstance3D = TreeInstance3D.new()
		tree.reconstruction = _source.make_variant(randi(), 0.0 if i == 1 else 0.7)
		tree.collision = true
		tree.collision_shapes = 64
		tree.position.x = (i - 1) * 0.75 * height
		_trees.add_child(tree)
	_camera.frame(AABB(Vector3(-height, 0.0, -0.3 * height), Vector3(2.0, 1.0, 0.6) * height))
	_tell()


func _unhandled_input(event: InputEvent) -> void:
	var button: InputEventMouseButton = event as InputEventMouseButton
	if button == null or button.button_index != MOUSE_BUTTON_LEFT:
		return
	if button.pressed:
		_pressed_at = button.position
	elif button.position.distance_to(_pressed_at) < _CLICK:
		_cut(button.position)


func _cut(at: Vector2) -> void:
	var from: Vector3 = _camera.project_ray_origin(at)
	var way: Vector3 = _camera.project_ray_normal(at)
	var ray: PhysicsRayQueryParameters3D = PhysicsRayQueryParameters3D.create(
		from, from + way * _camera.far
	)
	var hit: Dictionary = get_world_3d().direct_space_state.intersect_ray(ray)
	var tree: TreeInstance3D = _tree_of(hit.get("collider") as Node)
	if tree == null:
		_panel.note("There is no wood that can be cut: try the trunk or a stout branch.")
		return
	var where: Vector3 = tree.global_transform.affine_inverse() * (hit["position"] as Vector3)
	var node: int = _nearest_node(tree.reconstruction, where)
	if tree.reconstruction.get_node_parent(node) == TreeReconstruction.NO_NODE:
		_panel.note("That is the base of it: cut a little higher.")
		return
	var body: RigidBody3D = tree.fell(node, _density, true)
	if body == null:
		return
	_fallen += 1
	# By its velocity: Godot's own physics learns of a new body's mass a step later.
	var ahead: Vector3 = Vector3(way.x, 0.0, way.z).normalized()
	body.linear_velocity += ahead * _PUSH
	body.angular_velocity += Vector3.UP.cross(ahead) * _TURN
	_tell(body)


# The tree whose body was hit: the body is its child while it stands, and its parent once it fell.
static func _tree_of(collider: Node) -> TreeInstance3D:
	if collider == null:
		return null
	if collider.get_parent() is TreeInstance3D:
		return collider.get_parent() as TreeInstance3D
	for child: Node in collider.get_children():
		if child is TreeInstance3D:
			return child as TreeInstance3D
	return null


static func _nearest_node(tree: TreeReconstruction, where: Vector3) -> int:
	var places: PackedVector3Array = tree.get_positions()
	var ids: PackedInt32Array = tree.get_node_ids()
	var radii: PackedFloat32Array = tree.get_radii()
	var best: int = 0
	var least: float = INF
	for i: int in places.size():
		var away: float = absf(places[i].distance_to(where) - radii[i])
		if away < least:
			least = away
			best = i
	return ids[best]


func _tell(body: RigidBody3D = null) -> void:
	if body == null:
		_panel.note("Nothing is cut yet.")
		return
	_panel.note("%d cut, the last one weighs %.0f kg." % [_fallen, body.mass])
