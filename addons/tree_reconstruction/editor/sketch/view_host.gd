@tool
extends RefCounted
## Lets a sketch be drawn right in the editor's 3D viewports, and over photos that the scene is
## compared with.

const Session := preload("../session.gd")
const SketchPanel := preload("sketch_panel.gd")
const Widgets := preload("../dock/widgets.gd")
const ViewLook := preload("view_look.gd")
const ViewScan := preload("view_scan.gd")
const SceneAdder := preload("../import/scene_adder.gd")

const _VIEWPORTS: int = 4
# The paper's least size at the editor's scale of 1: beside a view that is drawn on it may be small.
const _PAPER: float = 320.0
const _SMALL_PAPER: float = 190.0
# So near to a place of the view what was found there has to be seen, in its pixels.
const _FOUND: float = 2.0

var _plugin: EditorPlugin
var _session: Session
var _panel: SketchPanel
var _scan: ViewScan
# Whether the plugin hears of the viewports also where no tree is selected.
var _hears: bool = false
# Of the window, before it made room.
var _size: Vector2i
# By the camera's viewport: what the editor takes its events from, and where the camera was.
var _surfaces: Dictionary[Viewport, Control] = {}
var _seen_from: Dictionary[Viewport, Transform3D] = {}
# What shows the photos, and what is drawn over them.
var _stage: Control
var _over_stage: Control


func enter(plugin: EditorPlugin, session: Session, panel: SketchPanel) -> void:
	_plugin = plugin
	_session = session
	_panel = panel
	_scan = ViewScan.new(session)
	_panel.view.find_ground = _find_ground
	_panel.view.changed.connect(_redraw)
	_panel.bar.in_view_chosen.connect(_on_chosen)


func exit() -> void:
	_panel.bar.in_view_chosen.disconnect(_on_chosen)
	_panel.view.changed.disconnect(_redraw)
	_panel.view.find_ground = Callable()
	_leave_stage()
	_scan.leave()
	_surfaces.clear()
	_seen_from.clear()
	_panel = null
	_session = null
	_plugin = null


## Takes an event of the 3D viewport, or leaves it to the editor.
func input(camera: Camera3D, event: InputEvent) -> int:
	if not _panel.view.enabled:
		return EditorPlugin.AFTER_GUI_INPUT_PASS
	var size: Vector2 = _session.picker.call(&"get_size", camera)
	if not _panel.view.input(camera, size, event) and not _take_key(event):
		return EditorPlugin.AFTER_GUI_INPUT_PASS
	var surface: Control = _surfaces.get(camera.get_viewport())
	if event is InputEventKey and surface != null:
		# The engine would look for the key among the shortcuts of its own.
		surface.accept_event()
	return EditorPlugin.AFTER_GUI_INPUT_STOP


func draw_always(overlay: Control) -> void:
	if not _panel.view.enabled:
		return
	var camera: Camera3D = _session.picker.call(&"get_camera_of", overlay)
	if camera != null:
		_surfaces[camera.get_viewport()] = overlay
		ViewLook.draw(overlay, camera, _panel.view)


## To be called once a frame.
func update() -> void:
	if _session.view.stage != _stage:
		_leave_stage()
		_join_stage()
	_scan.update(_panel.view.get_over())
	if not _panel.view.enabled:
		return
	# The engine draws over a viewport when it is told to.
	for i: int in _VIEWPORTS:
		var viewport: SubViewport = EditorInterface.get_editor_viewport_3d(i)
		var camera: Camera3D = viewport.get_camera_3d()
		if camera != null and _seen_from.get(viewport) != camera.global_transform:
			_seen_from[viewport] = camera.global_transform
			_plugin.update_overlays()
	if _over_stage != null:
		_over_stage.queue_redraw()


func _on_chosen(enabled: bool) -> void:
	_make_room(enabled)
	if not enabled:
		return
	if not _hears:
		_hears = true
		_plugin.set_input_event_forwarding_always_enabled()
		_plugin.set_force_draw_over_forwarding_enabled()
	EditorInterface.set_main_screen_editor("3D")
	_redraw()


# The window is as small as it can be while the view behind it is drawn on.
func _make_room(enabled: bool) -> void:
	var window: Window = _panel.get_window()
	var side: float = Widgets.px(_SMALL_PAPER if enabled else _PAPER)
	_panel.canvas.custom_minimum_size = Vector2(side, side)
	if enabled:
		_size = window.size
		window.reset_size()
	elif _size != Vector2i.ZERO:
		window.size = _size


func _redraw() -> void:
	_plugin.update_overlays()


# Undoing concerns also strokes that no tree was made of yet, of which the editor knows nothing.
func _take_key(event: InputEvent) -> bool:
	if not event is InputEventKey:
		return false
	for redo: bool in [false, true]:
		if event.is_action_pressed(&"ui_redo" if redo else &"ui_undo", true, true):
			# Not within this event: a key of the editor's own is sent for it.
			_panel.step.call_deferred(redo)
			return true
	return false


func _find_ground(camera: Camera3D, size: Vector2, at: Vector2) -> Variant:
	# The viewport may be drawn at half its size.
	var in_viewport: Vector2 = at * camera.get_viewport().get_visible_rect().size / size
	var place: Vector3 = SceneAdder.place_under(camera, in_viewport)
	# Where there is no ground, it names one ahead.
	if camera.is_position_behind(place):
		return null
	var off: float = camera.unproject_position(place).distance_to(in_viewport)
	return place if off < _FOUND else null


# --- over photos ----------------------------------------------------------------------------------


func _join_stage() -> void:
	_stage = _session.view.stage
	if _stage == null:
		return
	_stage.gui_input.connect(_on_stage_input)
	_over_stage = Control.new()
	_over_stage.mouse_filter = Control.MOUSE_FILTER_IGNORE
	_over_stage.draw.connect(_draw_over_stage)
	_stage.add_child(_over_stage)
	_over_stage.set_anchors_and_offsets_preset(Control.PRESET_FULL_RECT)


func _leave_stage() -> void:
	if is_instance_valid(_stage):
		if _panel.view.camera == _stage.get(&"camera"):
			_panel.view.cancel()
		_stage.gui_input.disconnect(_on_stage_input)
		_over_stage.queue_free()
	_stage = null
	_over_stage = null


func _on_stage_input(event: InputEvent) -> void:
	if not _panel.view.enabled or not is_instance_valid(_stage) or not _stage.is_inside_tree():
		return
	var camera: Camera3D = _stage.get(&"camera")
	if _panel.view.input(camera, _stage.size, event) or _take_key(event):
		_stage.accept_event()


func _draw_over_stage() -> void:
	if _panel.view.enabled:
		ViewLook.draw(_over_stage, _stage.get(&"camera") as Camera3D, _panel.view)
