@tool
extends RefCounted
## Moves the editor's camera to show the whole tree from one side, or a part of it.
##
## The camera follows a cursor of the editor's own, which scripts cannot reach: a direction, a place
## and a distance. So it is led there as a user would lead it, all within one frame: the viewport's
## menu turns it to a side and centres it on the node, and a pinch of the touchpad sets the
## distance. Where that is missed, as where another engine has other limits, a second pinch mends
## it as soon as the camera rests.

const Session: GDScript = preload("../session.gd")

## The item of the viewport's menu by the action, as the editor names its shortcut.
const _ITEMS: Dictionary[StringName, String] = {
	&"view_front": "spatial_editor/front_view",
	&"view_rear": "spatial_editor/rear_view",
	&"view_right": "spatial_editor/right_view",
	&"view_left": "spatial_editor/left_view",
	&"view_top": "spatial_editor/top_view",
	&"view_bottom": "spatial_editor/bottom_view",
	&"view_home": "spatial_editor/front_view",
}
const _CENTRE: String = "spatial_editor/focus_selection"
const _PERSPECTIVE: String = "spatial_editor/switch_perspective_orthogonal"
# How the home view turns from the front: each is 15 degrees.
const _HOME: Dictionary[String, int] = {
	"spatial_editor/orbit_view_right": 2,
	"spatial_editor/orbit_view_up": 1,
}
# Where the camera of each view stands: its pitch and its yaw, in degrees.
const _ANGLES: Dictionary[StringName, Vector2] = {
	&"view_front": Vector2(0, 0),
	&"view_rear": Vector2(0, 180),
	&"view_right": Vector2(0, 90),
	&"view_left": Vector2(0, -90),
	&"view_top": Vector2(-90, 0),
	&"view_bottom": Vector2(90, 0),
	&"view_home": Vector2(-15, 30),
}
# How much of the picture stays free around the tree, also for its leaves, and how many of its nodes
# are looked at for that.
const _MARGIN: float = 1.15
const _PLACES: int = 4000
# Where the editor's camera stands in a scene in which nobody has moved it yet.
const _UNTOUCHED: Vector3 = Vector3(1.682942, 1.917702, 3.080605)
# How much of the picture's narrower side a part of the tree takes that is brought into view; how
# small it may be to be seen well, and how near to the border.
const _SHARE: float = 0.7
const _LEAST_SHARE: float = 0.25
const _BORDER: float = 0.1
# Seconds after which the camera is left where it is.
const _PATIENCE: float = 3.0

var _session: Session
# Called with the events for the viewport's surface, past our own keys: (surface, events).
var _send: Callable
var _camera: Camera3D
# Where the camera is led to look at, and from how far.
var _target: Vector3
var _distance: float
var _last: Transform3D
var _left: float = 0.0


func _init(session: Session) -> void:
	set_translation_domain(session.get_translation_domain())
	_session = session


## Sets what events for the editor go through.
func set_sender(send: Callable) -> void:
	_send = send


## Whether nobody has moved a camera of the editor since its scene was made: a tree is mostly above
## what it sees then.
static func is_untouched(camera: Camera3D) -> bool:
	return camera.global_position.distance_to(_UNTOUCHED) < 0.01


## Looks at the tree from the side that [param action] names (see actions.gd).
func look(action: StringName, camera: Camera3D) -> void:
	var menu: PopupMenu = _get_menu(camera)
	if menu == null:
		return
	_choose(menu, _ITEMS[action])
	if action == &"view_home":
		_turn_home(menu, camera)
	var angles: Vector2 = _ANGLES[action]
	var turned: Basis = Basis.from_euler(Vector3(deg_to_rad(angles.x), deg_to_rad(angles.y), 0.0))
	_lead(menu, camera, _get_box().get_center(), _distance_for(turned, camera))


## Shows the whole tree, with its leaves, from where the camera looks now.
func frame(camera: Camera3D) -> void:
	var menu: PopupMenu = _get_menu(camera)
	if menu == null:
		return
	var turned: Basis = camera.global_basis.orthonormalized()
	_lead(menu, camera, _get_box().get_center(), _distance_for(turned, camera))


## Whether the whole tree is inside of the picture, and large enough to be looked at.
func is_framed(camera: Camera3D) -> bool:
	var size: Vector2 = _session.picker.call(&"get_size", camera)
	var seen: Rect2 = Rect2()
	for corner: int in 8:
		var place: Vector3 = _session.tree.get_aabb().get_endpoint(corner)
		var at: Vector2 = _session.picker.call(&"project_place", camera, place)
		if not at.is_finite() or not Rect2(Vector2.ZERO, size).has_point(at):
			return false
		seen = Rect2(at, Vector2.ZERO) if corner == 0 else seen.expand(at)
	return maxf(seen.size.x / size.x, seen.size.y / size.y) > _LEAST_SHARE


## Brings a part of the tree into view, from where the camera looks now: what is in [param box], in
## the tree's space. What is seen well already stays where it is.
func bring(box: AABB, camera: Camera3D) -> void:
	if is_well_seen(box, camera):
		return
	var menu: PopupMenu = _get_menu(camera)
	if menu == null:
		return
	var around: float = get_reach(box) * _session.node.global_basis.get_scale().y
	var shape: Vector2 = camera.get_viewport().get_visible_rect().size
	var narrower: float = minf(1.0, shape.x / shape.y) * tan(deg_to_rad(camera.fov) * 0.5)
	var to: Vector3 = _session.node.global_transform * box.get_center()
	_lead(menu, camera, to, around / (narrower * _SHARE))


## Whether what is in [param box] is inside of the picture and large enough to be looked at.
func is_well_seen(box: AABB, camera: Camera3D) -> bool:
	var at: Vector2 = _session.picker.call(&"project_place", camera, box.get_center())
	if not at.is_finite():
		return false
	var size: Vector2 = _session.picker.call(&"get_size", camera)
	var reach: float = _session.picker.call(&"pixels_per_metre", camera, box.get_center())
	reach *= get_reach(box)
	var side: float = minf(size.x, size.y)
	var picture: Rect2 = Rect2(Vector2.ZERO, size).grow(-_BORDER * side - reach)
	return picture.has_area() and picture.has_point(at) and 2.0 * reach > _LEAST_SHARE * side


## How far around the middle of [param box] the picture goes, in metres of the tree: also around a
## single node so much that it is seen what it belongs to.
func get_reach(box: AABB) -> float:
	return maxf(0.5 * box.size.length(), 0.05 * _session.tree.get_aabb().size.length())


## To be called once a frame.
func update(delta: float) -> void:
	if _left <= 0.0:
		return
	_left -= delta
	if not is_instance_valid(_camera) or _session.tree == null:
		_left = 0.0
		return
	var now: Transform3D = _camera.global_transform
	if not now.is_equal_approx(_last):
		_last = now
		return
	_left = 0.0
	var reached: float = now.origin.distance_to(_target)
	if _camera.projection == Camera3D.PROJECTION_ORTHOGONAL:
		reached = _camera.size / (2.0 * tan(deg_to_rad(_camera.fov) * 0.5))
	if absf(reached / _distance - 1.0) > 0.02:
		_pinch(_camera, reached / _distance)


## Nothing more is to be mended: the user moves the camera.
func stop() -> void:
	_left = 0.0


# The menu of the camera's viewport; where there is none, that is said.
func _get_menu(camera: Camera3D) -> PopupMenu:
	var editor: Control = camera.get_viewport().get_parent().get_parent() as Control
	var menu: PopupMenu = _find_menu(editor)
	if menu == null:
		_session.say(
			tr("This version of the editor has no menu of views that could be used."),
			Session.Kind.WARNING
		)
	return menu


# Leads the camera until it looks at a place of the scene from so far, in the direction that it has.
func _lead(menu: PopupMenu, camera: Camera3D, target: Vector3, distance: float) -> void:
	_target = target
	_distance = distance
	_centre(menu)
	# As near as the editor lets it, which is known, and out again from there.
	_pinch(camera, 1e6)
	_pinch(camera, maxf(camera.near * 4.0, 0.01) / _distance)
	_camera = camera
	_last = Transform3D()
	_left = _PATIENCE


# How far off its centre the camera must be for the whole tree to be seen, which it looks at from
# there turned so.
func _distance_for(turned: Basis, camera: Camera3D) -> float:
	var orthogonal: bool = camera.projection == Camera3D.PROJECTION_ORTHOGONAL
	var to_camera: Transform3D = Transform3D(turned, _get_box().get_center()).affine_inverse()
	to_camera *= _session.node.global_transform
	var shape: Vector2 = camera.get_viewport().get_visible_rect().size
	var up: float = tan(deg_to_rad(camera.fov) * 0.5)
	var aside: float = up * shape.x / shape.y
	var leaf: float = _get_leaf_length()
	var places: PackedVector3Array = _session.tree.get_positions()
	var distance: float = 0.1
	@warning_ignore("integer_division")
	for i: int in range(0, places.size(), maxi(1, places.size() / _PLACES)):
		var place: Vector3 = to_camera * places[i]
		var needed: float = maxf((absf(place.y) + leaf) / up, (absf(place.x) + leaf) / aside)
		needed *= _MARGIN
		distance = maxf(distance, needed if orthogonal else needed + place.z)
	return distance


# How far leaves reach beyond the wood, in the scene's metres.
func _get_leaf_length() -> float:
	if not _session.view.leaves or not _session.node.leaves:
		return 0.0
	var tree: TreeReconstruction = _session.tree
	var rule: LeafRule = tree.leaf_rule
	var length: float = tree.leaf_size if rule == null else rule.leaf_size
	var enabled: bool = tree.leaves_enabled if rule == null else rule.enabled
	return length * _session.node.global_basis.get_scale().y if enabled else 0.0


# The tree's box in the scene.
func _get_box() -> AABB:
	return _session.node.global_transform * _session.tree.get_aabb()


func _turn_home(menu: PopupMenu, camera: Camera3D) -> void:
	var settings: EditorSettings = EditorInterface.get_editor_settings()
	for path: String in _HOME:
		var shortcut: Shortcut = settings.get_shortcut(path)
		if shortcut == null or not shortcut.has_valid_event():
			continue
		for i: int in _HOME[path]:
			var event: InputEvent = shortcut.events[0].duplicate()
			event.set(&"pressed", true)
			_send.call(camera, [event] as Array[InputEvent])
	if camera.projection == Camera3D.PROJECTION_ORTHOGONAL:
		_choose(menu, _PERSPECTIVE)


# The editor centres on the node's origin, which is the tree's base: so the node is lifted while it
# does. Nobody sees it.
func _centre(menu: PopupMenu) -> void:
	var node: TreeInstance3D = _session.node
	var before: Transform3D = node.transform
	node.global_position = _target
	_choose(menu, _CENTRE)
	node.transform = before


func _pinch(camera: Camera3D, factor: float) -> void:
	var event: InputEventMagnifyGesture = InputEventMagnifyGesture.new()
	event.factor = factor
	event.position = camera.get_viewport().get_visible_rect().size * 0.5
	_send.call(camera, [event] as Array[InputEvent])


static func _choose(menu: PopupMenu, path: String) -> void:
	var shortcut: Shortcut = EditorInterface.get_editor_settings().get_shortcut(path)
	for i: int in menu.item_count:
		if shortcut != null and menu.get_item_shortcut(i) == shortcut:
			menu.id_pressed.emit(menu.get_item_id(i))
			return


# The menu in the viewport's corner that says 'Perspective'.
static func _find_menu(editor: Control) -> PopupMenu:
	var wanted: Shortcut = EditorInterface.get_editor_settings().get_shortcut(_CENTRE)
	for button: Node in editor.find_children("*", "MenuButton", true, false):
		var menu: PopupMenu = (button as MenuButton).get_popup()
		for i: int in menu.item_count:
			if menu.get_item_shortcut(i) == wanted:
				return menu
	return null
