extends "./suite.gd"
## What files of tests of the viewport extend: a session whose router gets mouse and key events as
## the editor sends them, without an editor.

const Session := preload("res://addons/tree_reconstruction/editor/session.gd")
const Picker := preload("res://addons/tree_reconstruction/editor/viewport/picker.gd")
const CameraViews := preload("res://addons/tree_reconstruction/editor/viewport/camera_views.gd")
const Shortcuts := preload("res://addons/tree_reconstruction/editor/viewport/shortcuts.gd")
const InputRouter := preload("res://addons/tree_reconstruction/editor/viewport/input_router.gd")
const Actions := preload("res://addons/tree_reconstruction/editor/viewport/actions.gd")
const SkeletonView := preload("res://addons/tree_reconstruction/editor/viewport/skeleton_view.gd")
const ViewState := preload("res://addons/tree_reconstruction/editor/view_state.gd")
const PointView := preload("res://addons/tree_reconstruction/editor/viewport/point_view.gd")
const AxesGrid := preload("res://addons/tree_reconstruction/editor/viewport/axes_grid.gd")
const FreePlace := preload("res://addons/tree_reconstruction/editor/import/free_place.gd")
const AllTools := preload("res://addons/tree_reconstruction/editor/tools/all_tools.gd")
const Select := preload("res://addons/tree_reconstruction/editor/tools/select.gd")

const _SIZE: Vector2i = Vector2i(800, 600)
const PASS: int = EditorPlugin.AFTER_GUI_INPUT_PASS
const STOP: int = EditorPlugin.AFTER_GUI_INPUT_STOP

var _undo: UndoRedo
var _viewport: SubViewport
var _camera: Camera3D
var _session: Session
var _shortcuts: Shortcuts
var _router: InputRouter
var _given_back: Array[InputEvent] = []


# A session with a tree in the view of a camera that looks at it from the front.
func _open(made: TreeReconstruction) -> void:
	_undo = UndoRedo.new()
	_viewport = SubViewport.new()
	_viewport.size = _SIZE
	tree.root.add_child(_viewport)
	_camera = Camera3D.new()
	_viewport.add_child(_camera)
	_camera.look_at_from_position(Vector3(0.3, 2.0, 7.0), Vector3(0.3, 1.9, 0.0))
	var node: TreeInstance3D = TreeInstance3D.new()
	node.reconstruction = made
	_viewport.add_child(node)
	node.transform = Transform3D(
		Basis(Vector3.UP, 0.4).scaled(Vector3.ONE * 1.2), Vector3(0.3, 0, 0)
	)
	_session = Session.new(_undo)
	AllTools.add_to(_session)
	_session.picker = Picker.new(_session)
	_session.edit_node(node)
	_session.choose(&"select")
	(_session.tool as Select).give_back = func(
		press: InputEventMouseButton, release: InputEventMouseButton
	) -> void:
		_given_back.append_array([press, release])
	_shortcuts = Shortcuts.new(_session, null)
	_router = InputRouter.new(_session, _shortcuts)


func _close() -> void:
	_session.shut_down()
	_session.choose(&"")
	_session.tools.clear()
	_session.picker = null
	_undo.clear_history()
	_undo.free()
	_viewport.free()
	# What the closures of a test hold on to.
	_session = null
	_router = null
	_given_back.clear()


func _button(at: Vector2, pressed: bool, double: bool = false) -> InputEventMouseButton:
	var event: InputEventMouseButton = InputEventMouseButton.new()
	event.button_index = MOUSE_BUTTON_LEFT
	event.position = at
	event.pressed = pressed
	event.double_click = double
	return event


func _motion(at: Vector2) -> InputEventMouseMotion:
	var event: InputEventMouseMotion = InputEventMouseMotion.new()
	event.position = at
	event.button_mask = MOUSE_BUTTON_MASK_LEFT
	return event


func _key(code: Key) -> InputEventKey:
	var event: InputEventKey = InputEventKey.new()
	event.keycode = code
	event.pressed = true
	return event


# A node that is seen, with no other one near it.
func _lone_node() -> int:
	for id: int in _session.tree.get_node_ids():
		var at: Vector2 = _session.picker.project(_camera, id)
		var near: PackedInt32Array = _session.picker.pick_rect(
			_camera, Rect2(at - Vector2.ONE * 12.0, Vector2.ONE * 24.0)
		)
		var inner: bool = id > 0 and not _session.tree.get_node_children(id).is_empty()
		if inner and near == PackedInt32Array([id]):
			return id
	return -1


# A place of the screen far from all wood.
func _nothing() -> Vector2:
	return Vector2(790, 590)
