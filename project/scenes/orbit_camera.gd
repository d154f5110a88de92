extends Camera3D
## Goes round a point: drag to turn, wheel to come nearer, drag with the right button to shift.

## The point that it looks at.
@export var target: Vector3 = Vector3(0.0, 3.0, 0.0)
## Metres from there.
@export var distance: float = 12.0
## Radians around the point, and up.
@export var yaw: float = 0.6
@export var pitch: float = 0.12
## Turns by itself, in radians a second, until somebody drags.
@export var turning: float = 0.0

var _nearest: float = 0.5
var _farthest: float = 400.0


## Looks at a whole box from where it is, and from all around.
func frame(box: AABB) -> void:
	target = box.get_center()
	var half: Vector2 = 0.55 * Vector2(Vector2(box.size.x, box.size.z).length(), box.size.y)
	var screen: Vector2 = get_viewport().get_visible_rect().size
	var slope: float = tan(deg_to_rad(fov) * 0.5)
	distance = maxf(maxf(half.y, half.x * screen.y / screen.x) / slope + 0.5 * half.x, 1.0)
	_nearest = 0.04 * distance
	_place()


func _ready() -> void:
	_place()


func _process(delta: float) -> void:
	if turning != 0.0:
		yaw += turning * delta
		_place()


func _unhandled_input(event: InputEvent) -> void:
	var motion: InputEventMouseMotion = event as InputEventMouseMotion
	if motion != null and motion.button_mask & MOUSE_BUTTON_MASK_LEFT:
		turning = 0.0
		yaw -= motion.relative.x * 0.006
		pitch = clampf(pitch + motion.relative.y * 0.006, -0.2, 1.5)
		_place()
	elif motion != null and motion.button_mask & MOUSE_BUTTON_MASK_RIGHT:
		var metres: float = distance * tan(deg_to_rad(fov) * 0.5) * 2.0
		var shift: Vector2 = motion.relative * (metres / get_viewport().get_visible_rect().size.y)
		target += basis.y * shift.y - basis.x * shift.x
		target.y = maxf(target.y, 0.0)
		_place()
	var button: InputEventMouseButton = event as InputEventMouseButton
	if button != null and button.pressed:
		if button.button_index == MOUSE_BUTTON_WHEEL_UP:
			distance = maxf(distance * 0.9, _nearest)
			_place()
		elif button.button_index == MOUSE_BUTTON_WHEEL_DOWN:
			distance = minf(distance / 0.9, _farthest)
			_place()


func _place() -> void:
	var way: Vector3 = Basis.from_euler(Vector3(-pitch, yaw, 0.0)).z
	var eye: Vector3 = target + way * distance
	# Never under the ground.
	eye.y = maxf(eye.y, 0.15)
	if not eye.is_equal_approx(target):
		look_at_from_position(eye, target)
