@tool
extends ColorRect
## Shows the scene and a photo of it, one over the other, from where the photo was taken. The wheel
## goes nearer to what is under the mouse, a drag moves what is seen, and a double-click shows all.
##
## A viewport of its own looks into the scene: the editor's camera stays where it is.

## What lies over what.
enum Mode { BEHIND, IN_FRONT, DIFFERENCE }

const PhotoCamera: GDScript = preload("photo_camera.gd")
const BuriedFoot: GDScript = preload("buried_foot.gd")
const OVERLAY: Shader = preload("overlay.gdshader")
## What is seen where there is nothing.
const GROUND: Color = Color(0.13, 0.14, 0.15)
## The photo is drawn at most so many times as large as it is when all of it is seen.
const MOST_ZOOM: float = 40.0
const _STEP: float = 1.25
# Of the scene's layers: without those of the editor's grid, gizmos and arrows.
const _LAYERS: int = ((1 << 20) - 1) | BuriedFoot.LAYER

var mode: Mode = Mode.BEHIND:
	set(value):
		mode = value
		_update_overlay()
## How much of the photo is seen, from 0 to 1.
var opacity: float = 1.0:
	set(value):
		opacity = value
		_update_overlay()
## Whether a photo is on its way, which is said.
var waiting: bool = false:
	set(value):
		waiting = value
		_waiting.visible = value
## What sees the scene.
var camera: Camera3D = Camera3D.new()

var _viewport: SubViewport = SubViewport.new()
# What lies under the stage, where nobody sees it.
var _covered: SubViewport
var _feet: Array[BuriedFoot] = []
var _overlay: ShaderMaterial = ShaderMaterial.new()
var _waiting: Label = Label.new()
var _view: Dictionary = {}
# What was shown last, and how.
var _seen: Array = []
var _picture: Texture2D
# Pixels of the picture to one of the photo.
var _scale: float = 1.0
# What of the photo is in the middle, in its pixels, and how much larger than wholly it is drawn.
var _middle: Vector2
var _zoom: float = 1.0


func _init(domain: StringName) -> void:
	set_translation_domain(domain)
	name = &"PhotoStage"
	focus_mode = Control.FOCUS_ALL
	mouse_default_cursor_shape = Control.CURSOR_CROSS
	_overlay.shader = OVERLAY
	material = _overlay
	_viewport.transparent_bg = true
	_viewport.render_target_update_mode = SubViewport.UPDATE_WHEN_PARENT_VISIBLE
	camera.cull_mask = _LAYERS
	_viewport.add_child(camera)
	add_child(_viewport)
	_overlay.set_shader_parameter(&"ground", GROUND)
	_waiting.text = tr("Reading…")
	_waiting.visible = false
	add_child(_waiting)
	_waiting.set_anchors_and_offsets_preset(
		Control.PRESET_CENTER_BOTTOM, Control.PRESET_MODE_MINSIZE, 12
	)
	_update_overlay()


func _exit_tree() -> void:
	if not is_instance_valid(_covered):
		return
	# While its container is hidden it is off, and switched on when that is shown again.
	var holder: SubViewportContainer = _covered.get_parent() as SubViewportContainer
	if holder == null or holder.is_visible_in_tree():
		_covered.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	_covered = null


## Looks into the scene that [param editor], a viewport of the editor under this stage, shows, as
## finely as it does. That one is not drawn for as long.
func look_into(editor: SubViewport) -> void:
	_covered = editor
	_viewport.world_3d = editor.find_world_3d()
	_viewport.msaa_3d = editor.msaa_3d
	_viewport.screen_space_aa = editor.screen_space_aa
	_viewport.scaling_3d_mode = editor.scaling_3d_mode
	_viewport.scaling_3d_scale = editor.scaling_3d_scale
	_viewport.mesh_lod_threshold = editor.mesh_lod_threshold
	var from: Camera3D = editor.get_camera_3d()
	if from != null:
		camera.near = from.near
		camera.far = from.far
	camera.environment = _without_background(_viewport.world_3d)
	camera.make_current()
	_overlay.set_shader_parameter(&"scene", _viewport.get_texture())


## Leaves out what of the feet of [param trees] is in the ground. To be called once a frame.
func hide_feet(trees: Array[TreeInstance3D]) -> void:
	while _feet.size() < trees.size():
		var foot: BuriedFoot = BuriedFoot.new()
		_viewport.add_child(foot)
		_feet.append(foot)
	for i: int in _feet.size():
		_feet[i].follow(trees[i] if i < trees.size() else null)


## Stands where [param view] says, one of [method TreeReconstructor.load_photo_views]. All of
## another photo is shown.
func stand(view: Dictionary) -> void:
	var other: bool = view["name"] != _view.get("name")
	_view = view
	if other:
		show_whole()


## Shows a picture of the photo, or none with [code]null[/code]. [param scale] is how many of its
## pixels are one of the photo.
func show_picture(picture: Texture2D, scale: float) -> void:
	_picture = picture
	_scale = scale
	_update_overlay()


## Shows all of the photo again.
func show_whole() -> void:
	_zoom = 1.0
	if not _view.is_empty():
		_middle = Vector2(_view["size"] as Vector2i) * 0.5


## What of the photo is seen, in its pixels: more than all of it where the stage is wider or higher.
func get_shown() -> Rect2:
	var pixel: float = _get_pixel()
	return Rect2(_middle - size * pixel * 0.5, size * pixel)


## To be called once a frame, with where the tree stands in the scene. Returns whether something
## else is seen than before: if not, nothing is set anew, which would have the editor draw.
func update(frame: Transform3D) -> bool:
	# Here, since its container switches it on whenever the 3D view comes back.
	if (
		is_instance_valid(_covered)
		and _covered.render_target_update_mode != SubViewport.UPDATE_DISABLED
	):
		_covered.render_target_update_mode = SubViewport.UPDATE_DISABLED
	if _view.is_empty() or size.x < 1.0 or size.y < 1.0:
		return false
	var shown: Rect2 = get_shown()
	var seen: Array = [frame, size, shown, _view, _picture, _scale]
	if seen == _seen:
		return false
	_seen = seen
	if _viewport.size != Vector2i(size):
		_viewport.size = Vector2i(size)
	PhotoCamera.place(camera, _view, frame, shown)
	if _picture == null:
		return true
	var part: Vector2 = Vector2.ONE * _scale / _picture.get_size()
	var corner: Vector2 = shown.position * part
	var across: Vector2 = shown.size * part
	_overlay.set_shader_parameter(&"shown", Vector4(corner.x, corner.y, across.x, across.y))
	return true


func _gui_input(event: InputEvent) -> void:
	var button: InputEventMouseButton = event as InputEventMouseButton
	var motion: InputEventMouseMotion = event as InputEventMouseMotion
	var pinch: InputEventMagnifyGesture = event as InputEventMagnifyGesture
	var swipe: InputEventPanGesture = event as InputEventPanGesture
	if motion != null:
		if motion.button_mask & (MOUSE_BUTTON_MASK_LEFT | MOUSE_BUTTON_MASK_MIDDLE):
			_middle -= motion.relative * _get_pixel()
	elif pinch != null:
		_go_nearer(pinch.position, pinch.factor)
	elif swipe != null:
		_middle += swipe.delta * 10.0 * _get_pixel()
	elif button != null and button.pressed:
		grab_focus()
		if button.button_index == MOUSE_BUTTON_WHEEL_UP:
			_go_nearer(button.position, _STEP)
		elif button.button_index == MOUSE_BUTTON_WHEEL_DOWN:
			_go_nearer(button.position, 1.0 / _STEP)
		elif button.double_click and button.button_index == MOUSE_BUTTON_LEFT:
			show_whole()
	else:
		return
	accept_event()


# What is under the mouse stays there.
func _go_nearer(at: Vector2, factor: float) -> void:
	var off: Vector2 = at - size * 0.5
	var before: float = _get_pixel()
	_zoom = clampf(_zoom * factor, 1.0, MOST_ZOOM)
	_middle += off * (before - _get_pixel())
	if _zoom == 1.0:
		show_whole()


# What of the photo a pixel of the stage is.
func _get_pixel() -> float:
	if _view.is_empty():
		return 1.0
	var whole: Vector2 = Vector2(_view["size"] as Vector2i)
	return maxf(whole.x / maxf(size.x, 1.0), whole.y / maxf(size.y, 1.0)) / _zoom


# Without a photo there is nothing to see the difference to.
func _update_overlay() -> void:
	var seen: bool = _picture != null
	_overlay.set_shader_parameter(&"photo", _picture)
	_overlay.set_shader_parameter(&"mode", mode if seen else Mode.BEHIND)
	_overlay.set_shader_parameter(&"opacity", opacity if seen else 0.0)


# The light of a world, with nothing behind what stands in it.
static func _without_background(world: World3D) -> Environment:
	var light: Environment = world.environment
	if light == null:
		light = world.fallback_environment
	var bare: Environment = Environment.new()
	if light != null:
		bare = light.duplicate() as Environment
	var sky_lights: bool = bare.sky != null and bare.background_mode == Environment.BG_SKY
	if bare.ambient_light_source == Environment.AMBIENT_SOURCE_BG and sky_lights:
		bare.ambient_light_source = Environment.AMBIENT_SOURCE_SKY
	if bare.reflected_light_source == Environment.REFLECTION_SOURCE_BG and sky_lights:
		bare.reflected_light_source = Environment.REFLECTION_SOURCE_SKY
	bare.background_mode = Environment.BG_CLEAR_COLOR
	# They would lie over the photo, too.
	bare.fog_enabled = false
	bare.volumetric_fog_enabled = false
	bare.glow_enabled = false
	return bare
