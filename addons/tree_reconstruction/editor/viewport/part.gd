@tool
extends RefCounted
## The viewport's part of the plugin: draws the edited tree's skeleton, finds nodes under the mouse,
## hands events to the tools, and brings the toolbar, the menu and the strip around the viewport.

const Session: GDScript = preload("../session.gd")
const Gizmo: GDScript = preload("skeleton_gizmo.gd")
const SkeletonView: GDScript = preload("skeleton_view.gd")
const PointView: GDScript = preload("point_view.gd")
const VoxelView: GDScript = preload("voxel_view.gd")
const Legend: GDScript = preload("legend.gd")
const AxesGrid: GDScript = preload("axes_grid.gd")
const Visibility: GDScript = preload("visibility.gd")
const WindRest: GDScript = preload("wind_rest.gd")
const Picker: GDScript = preload("picker.gd")
const Shortcuts: GDScript = preload("shortcuts.gd")
const InputRouter: GDScript = preload("input_router.gd")
const Actions: GDScript = preload("actions.gd")
const TransformTools: GDScript = preload("transform_tools.gd")
const Overlay: GDScript = preload("overlay.gd")
const Toolbar: GDScript = preload("toolbar.gd")
const ViewMenu: GDScript = preload("view_menu.gd")
const Strip: GDScript = preload("strip.gd")
const AllTools: GDScript = preload("../tools/all_tools.gd")

# Our keys over a photo.
const _OVER_PHOTOS: Array[StringName] = [
	&"compare_photos",
	&"show_mesh",
	&"show_leaves",
	&"screenshot",
	&"tool_draw_branch",
	&"tool_select"
]

var _plugin: EditorPlugin
var _session: Session
var _gizmo: Gizmo
var _skeleton: SkeletonView
var _points: PointView
var _voxels: VoxelView
var _legend: Legend
var _axes: AxesGrid
var _visibility: Visibility
var _wind_rest: WindRest
var _picker: Picker
var _shortcuts: Shortcuts
var _router: InputRouter
var _actions: Actions
var _overlay: Overlay
var _transform_tools: TransformTools = TransformTools.new()
var _toolbar: Toolbar
var _menu: ViewMenu
var _strip: Strip
# By the camera's viewport: what the editor takes its events from.
var _surfaces: Dictionary[Viewport, Control] = {}
# Whether the skeleton was edited when the editor was last told of it.
var _was_editing: bool = false
# Whether the camera may have to be led to the tree as soon as its viewport is drawn.
var _home_due: bool = false


func enter(plugin: EditorPlugin, session: Session) -> void:
	_plugin = plugin
	_session = session
	AllTools.add_to(session)
	_make_views()
	_make_input()
	_make_controls()
	_session.node_changed.connect(_on_node_changed)
	_session.tree_changed.connect(_on_tree_changed)
	_session.selection_changed.connect(_on_selection_changed)
	_session.hover_changed.connect(_plugin.update_overlays)
	_session.tool_changed.connect(_on_tool_changed)
	_session.view_changed.connect(_on_view_changed)
	_session.scan_changed.connect(_on_scan_changed)
	_session.scan.fidelity_changed.connect(_on_scan_changed)
	_session.view_wanted.connect(_on_view_wanted)
	_plugin.get_tree().process_frame.connect(_update)
	_on_tool_changed()
	_on_node_changed()


func exit() -> void:
	_plugin.get_tree().process_frame.disconnect(_update)
	_session.view_wanted.disconnect(_on_view_wanted)
	_session.scan.fidelity_changed.disconnect(_on_scan_changed)
	_session.scan_changed.disconnect(_on_scan_changed)
	_session.view_changed.disconnect(_on_view_changed)
	_session.tool_changed.disconnect(_on_tool_changed)
	_session.hover_changed.disconnect(_plugin.update_overlays)
	_session.selection_changed.disconnect(_on_selection_changed)
	_session.tree_changed.disconnect(_on_tree_changed)
	_session.node_changed.disconnect(_on_node_changed)
	_remove_controls()
	_remove_input()
	_remove_views()
	_session.choose(&"")
	_session.tools.clear()
	_session = null
	_plugin = null


## Takes an event of the 3D viewport, or leaves it to the editor.
func input(camera: Camera3D, event: InputEvent) -> int:
	if _actions.turntable.is_turning() and Actions.Turntable.is_ended_by(event):
		_actions.turntable.stop()
		if event is InputEventKey:
			_take_key(camera)
			return EditorPlugin.AFTER_GUI_INPUT_STOP
	if not event is InputEventMouseMotion and event.is_pressed():
		_actions.views.stop()
	var answer: int = _router.input(camera, event)
	if answer == EditorPlugin.AFTER_GUI_INPUT_STOP and event is InputEventKey:
		_take_key(camera)
	return answer


func draw_over(overlay: Control) -> void:
	var camera: Camera3D = _picker.get_camera_of(overlay)
	if camera == null or _session.tree == null:
		return
	# Another scene is shown already, and its nodes are told of next.
	if not is_instance_valid(_session.node) or not _session.node.is_inside_tree():
		return
	_surfaces[camera.get_viewport()] = overlay
	_axes.draw(overlay, camera, _picker)
	_legend.draw(overlay)
	if not _session.view.editing or _actions.turntable.is_turning():
		return
	var taken: Rect2 = Rect2()
	if _session.tool != null:
		_session.tool.call(&"draw", overlay)
		taken = _session.tool.call(&"get_sentence_box")
	_overlay.draw(overlay, camera, _picker, camera == _router.camera, taken)


# --- making and unmaking --------------------------------------------------------------------------


func _make_views() -> void:
	_picker = Picker.new(_session)
	_session.picker = _picker
	_skeleton = SkeletonView.new(_session)
	_points = PointView.new(_session)
	_voxels = VoxelView.new(_session)
	_voxels.built.connect(_redraw)
	_legend = Legend.new(_session, _points)
	_axes = AxesGrid.new(_session)
	_visibility = Visibility.new(_session)
	_wind_rest = WindRest.new()
	_overlay = Overlay.new(_session)
	_gizmo = Gizmo.new()
	_gizmo.set_session(_session)
	_gizmo.layers.append_array(_axes.layers)
	_gizmo.layers.append(_points.layer)
	_gizmo.layers.append(_voxels.layer)
	_gizmo.layers.append_array(_skeleton.layers)
	_plugin.add_node_3d_gizmo_plugin(_gizmo)
	_gizmo.join(EditorInterface.get_edited_scene_root())


func _remove_views() -> void:
	_visibility.take(null)
	_wind_rest.leave()
	_gizmo.take(null)
	_plugin.remove_node_3d_gizmo_plugin(_gizmo)
	_gizmo.set_session(null)
	_gizmo.leave()
	_gizmo = null
	_session.picker = null
	_surfaces.clear()


func _make_input() -> void:
	var settings: EditorSettings = EditorInterface.get_editor_settings()
	Actions.Screenshot.add_setting(settings)
	_shortcuts = Shortcuts.new(_session, settings)
	_router = InputRouter.new(_session, _shortcuts)
	_actions = Actions.new(_session)
	_actions.views.set_sender(_send)
	_actions.photos.press = _press_over_photos
	_router.asked.connect(_on_asked)
	_router.missed.connect(_give_back)
	for id: StringName in _session.tools:
		_session.tools[id].changed.connect(_on_tool_wants)
	for id: StringName in [&"select", &"draw_branch"]:
		if _session.tools.has(id):
			_session.tools[id].set(&"give_back", _give_back)
	_picker.set(&"are_arrows_shown", _transform_tools.are_shown)
	if _session.tool == null:
		_session.choose(&"select")


func _remove_input() -> void:
	_transform_tools.bring_back()
	_actions.turntable.stop()
	_actions.photos.leave()
	_actions.photos.press = Callable()
	for id: StringName in _session.tools:
		_session.tools[id].changed.disconnect(_on_tool_wants)


func _make_controls() -> void:
	_toolbar = Toolbar.new(_session, _shortcuts)
	_menu = ViewMenu.new(_session, _shortcuts)
	_menu.asked.connect(_on_asked)
	_strip = Strip.new(_session)
	_actions.photos.left.connect(_strip.forget)
	_plugin.add_control_to_container(EditorPlugin.CONTAINER_SPATIAL_EDITOR_SIDE_LEFT, _toolbar)
	_plugin.add_control_to_container(EditorPlugin.CONTAINER_SPATIAL_EDITOR_MENU, _menu)
	_plugin.add_control_to_container(EditorPlugin.CONTAINER_SPATIAL_EDITOR_BOTTOM, _strip)


func _remove_controls() -> void:
	_plugin.remove_control_from_container(EditorPlugin.CONTAINER_SPATIAL_EDITOR_BOTTOM, _strip)
	_plugin.remove_control_from_container(EditorPlugin.CONTAINER_SPATIAL_EDITOR_MENU, _menu)
	_plugin.remove_control_from_container(EditorPlugin.CONTAINER_SPATIAL_EDITOR_SIDE_LEFT, _toolbar)
	for control: Control in [_strip, _menu, _toolbar]:
		control.queue_free()


# --- following the session ------------------------------------------------------------------------


func _update() -> void:
	var delta: float = _plugin.get_process_delta_time()
	_router.update()
	_let_hovered_go()
	_visibility.update()
	_wind_rest.update(is_instance_valid(_session.node) and _session.view.wind)
	_actions.turntable.update(delta)
	_actions.views.update(delta)
	_actions.photos.update()
	_strip.update(delta)
	if _home_due:
		_look_home()


# The mouse has left the viewport.
func _let_hovered_go() -> void:
	if _session.hovered == _session.NO_NODE or not is_instance_valid(_router.camera):
		return
	var surface: Control = _surfaces.get(_router.camera.get_viewport())
	if surface == null or not surface.is_visible_in_tree():
		return
	if not Rect2(Vector2.ZERO, surface.size).has_point(surface.get_local_mouse_position()):
		_session.hovered = _session.NO_NODE


func _on_node_changed() -> void:
	_actions.turntable.stop()
	_actions.photos.note_node()
	_show_controls()
	_home_due = _session.tree != null
	_visibility.take(_session.node)
	_take_in_hand()
	_on_tree_changed()


# While a sketch is drawn in the view, its size must not change by what is selected: all would be
# seen elsewhere than where it was drawn.
func _show_controls() -> void:
	for control: Control in [_strip, _menu, _toolbar]:
		control.visible = _session.node != null and not _session.view.drawing


func _on_tree_changed() -> void:
	_actions.photos.note_edit()
	_skeleton.update_tree()
	_axes.update()
	_points.update()
	_voxels.update()
	_legend.update()
	_on_selection_changed()


func _on_selection_changed() -> void:
	_skeleton.update_selection()
	_on_tool_wants()


func _on_tool_wants() -> void:
	_skeleton.update_ghosts()
	_redraw()


func _on_tool_changed() -> void:
	_toolbar.update()
	_strip.update_tool()
	_on_tool_wants()


func _on_view_changed() -> void:
	_router.look_again()
	if _session.view.editing != _was_editing:
		_take_in_hand()
	_visibility.update()
	_show_controls()
	_toolbar.update()
	_menu.update()
	_strip.update_tool()
	_strip.update_view()
	_on_tree_changed()


# What of the editor's own changes while a skeleton is edited.
func _take_in_hand() -> void:
	_was_editing = _session.view.editing
	var editing: bool = _session.node != null and _session.view.editing
	_gizmo.take(_session.node)
	_transform_tools.find(EditorInterface.get_editor_viewport_3d(0))
	if editing:
		_transform_tools.put_away()
	else:
		_transform_tools.bring_back()


func _on_scan_changed() -> void:
	_points.rebuild()
	_points.update()
	_voxels.update()
	_legend.update()
	_strip.update_view()
	_redraw()


func _redraw() -> void:
	_gizmo.update_layers()
	_plugin.update_overlays()
	_actions.photos.redraw()


# --- the editor's viewports -----------------------------------------------------------------------


# That of the viewport in which the mouse was last.
func _get_camera() -> Camera3D:
	if is_instance_valid(_router.camera) and _router.camera.is_visible_in_tree():
		return _router.camera
	return EditorInterface.get_editor_viewport_3d(0).get_camera_3d()


func _on_view_wanted(box: AABB) -> void:
	_actions.turntable.stop()
	_actions.photos.leave()
	_actions.views.bring(box, _get_camera())


# A method, since a function made where it is connected would keep all of this alive.
func _on_asked(action: StringName) -> void:
	_actions.run(action, _get_camera())


# Of our keys, those that show and hide what the photos are compared with, keep a picture of it,
# draw over it, or end it.
func _press_over_photos(event: InputEventKey) -> bool:
	var action: StringName = _shortcuts.find(event)
	if action not in _OVER_PHOTOS:
		return false
	_on_asked(action)
	return true


func _give_back(press: InputEventMouseButton, release: InputEventMouseButton) -> void:
	var node: TreeInstance3D = _session.node
	_send(_router.camera, [press, release])
	var selected: EditorSelection = EditorInterface.get_selection()
	if selected.get_selected_nodes().is_empty() and is_instance_valid(node):
		# There was nothing at all. To lose the tree by a click beside a thin twig would be a
		# nuisance, so that only what was selected of it is let go.
		selected.add_node(node)
		EditorInterface.edit_node(node)
		if _session.tool == _session.tools.get(&"select"):
			_session.clear_selection()


# A tree that is edited in a new scene is shown wholly; elsewhere the camera stays where the user
# has left it, unless a tree was just added that is not seen from there.
func _look_home() -> void:
	var camera: Camera3D = EditorInterface.get_editor_viewport_3d(0).get_camera_3d()
	if _session.tree == null or camera == null or not camera.is_visible_in_tree():
		_home_due = false
	elif _surfaces.has(camera.get_viewport()):
		_home_due = false
		var added: bool = _session.view.take_wanted(_session.node)
		if _session.view.drawing:
			# It is seen where it was drawn.
			return
		if Actions.CameraViews.is_untouched(camera):
			_actions.views.look(&"view_home", camera)
		elif added and not _actions.views.is_framed(camera):
			_actions.views.frame(camera)


# Sends events to the editor, past our own keys and tools.
func _send(camera: Camera3D, events: Array[InputEvent]) -> void:
	var surface: Control = _surfaces.get(camera.get_viewport())
	if surface != null:
		_router.give_back(surface, events)


# The engine would look for the key among the shortcuts of its own.
func _take_key(camera: Camera3D) -> void:
	var surface: Control = _surfaces.get(camera.get_viewport())
	if surface != null:
		surface.accept_event()
