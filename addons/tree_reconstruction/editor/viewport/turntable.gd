@tool
extends RefCounted
## Turns the camera of a viewport around the tree, until the user does anything.
##
## The editor sets its camera only when its own cursor moves. So the camera is moved directly here,
## and put back at the end.

const Session: GDScript = preload("../session.gd")
## Turns in radians per second: a whole one takes twelve seconds.
const SPEED: float = TAU / 12.0

var _session: Session
var _camera: Camera3D
var _before: Transform3D
var _centre: Vector3
var _distance: float
var _angle: float
var _pitch: float


func _init(session: Session) -> void:
	_session = session


func is_turning() -> bool:
	return _camera != null


## Begins, or ends.
func toggle(camera: Camera3D) -> void:
	if is_turning():
		stop()
	elif camera != null:
		start(camera)


func start(camera: Camera3D) -> void:
	_camera = camera
	_before = camera.global_transform
	var box: AABB = _session.node.global_transform * _session.tree.get_aabb()
	_centre = box.get_center()
	var half: float = deg_to_rad(camera.fov) * 0.5
	var size: Vector2 = camera.get_viewport().get_visible_rect().size
	var narrower: float = minf(1.0, size.x / size.y)
	_distance = box.size.length() * 0.5 / (sin(half) * narrower) * 0.95
	var away: Vector3 = _before.basis.z
	_angle = atan2(away.x, away.z)
	_pitch = clampf(asin(clampf(away.normalized().y, -1.0, 1.0)), -0.1, 0.5)


## Puts the camera back.
func stop() -> void:
	if is_instance_valid(_camera):
		_camera.global_transform = _before
	_camera = null


## Whether an event of the viewport ends it.
static func is_ended_by(event: InputEvent) -> bool:
	return not event is InputEventMouseMotion and event.is_pressed()


## To be called once a frame.
func update(delta: float) -> void:
	if not is_turning():
		return
	if not is_instance_valid(_camera) or _session.tree == null:
		_camera = null
		return
	_angle += SPEED * delta
	var away: Vector3 = Vector3(0, 0, 1).rotated(Vector3.RIGHT, -_pitch)
	away = away.rotated(Vector3.UP, _angle)
	var from: Vector3 = _centre + away * _distance
	_camera.global_transform = Transform3D(Basis.IDENTITY, from).looking_at(_centre)
