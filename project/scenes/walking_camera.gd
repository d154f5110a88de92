extends Camera3D
## Walks through a landscape: W, A, S, D or the arrow keys, drag to look around, Shift to run, the
## wheel to rise above the ground and to come down again.

const _SPEED: float = 3.0
const _RUN: float = 6.0
const _LEAST: float = 1.7
const _MOST: float = 80.0

## Says how high the ground is at a place (x, z).
var ground: Callable
## Walks on by itself, in metres a second, until a key or a button is pressed.
var strolling: float = 0.8
var _yaw: float = 0.0
var _pitch: float = -0.02
var _height: float = _LEAST


func _ready() -> void:
	_yaw = rotation.y


## Looks that way, an angle about the vertical in radians.
func turn_to(yaw: float) -> void:
	_yaw = yaw


func _process(delta: float) -> void:
	var step: Vector2 = Input.get_vector(&"ui_left", &"ui_right", &"ui_up", &"ui_down")
	step.x += (
		float(Input.is_physical_key_pressed(KEY_D)) - float(Input.is_physical_key_pressed(KEY_A))
	)
	step.y += (
		float(Input.is_physical_key_pressed(KEY_S)) - float(Input.is_physical_key_pressed(KEY_W))
	)
	if step != Vector2.ZERO:
		strolling = 0.0
	var speed: float = _SPEED * sqrt(_height / _LEAST)
	if Input.is_key_pressed(KEY_SHIFT):
		speed *= _RUN
	var way: Vector3 = Basis(Vector3.UP, _yaw) * Vector3(step.x, 0.0, step.y).limit_length() * speed
	way += Basis(Vector3.UP, _yaw) * Vector3.FORWARD * strolling
	position += way * delta
	if ground.is_valid():
		var wanted: float = _height + (ground.call(position.x, position.z) as float)
		position.y = lerpf(position.y, wanted, 1.0 - exp(-8.0 * delta))
	basis = Basis.from_euler(Vector3(_pitch, _yaw, 0.0))


func _unhandled_input(event: InputEvent) -> void:
	var motion: InputEventMouseMotion = event as InputEventMouseMotion
	if motion != null and motion.button_mask != 0:
		strolling = 0.0
		_yaw -= motion.relative.x * 0.004
		_pitch = clampf(_pitch - motion.relative.y * 0.004, -1.4, 1.4)
	var button: InputEventMouseButton = event as InputEventMouseButton
	if button != null and button.pressed:
		if button.button_index == MOUSE_BUTTON_WHEEL_UP:
			_height = minf(_height * 1.15, _MOST)
		elif button.button_index == MOUSE_BUTTON_WHEEL_DOWN:
			_height = maxf(_height / 1.15, _LEAST)
