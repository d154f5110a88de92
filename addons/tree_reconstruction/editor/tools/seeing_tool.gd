@tool
extends "tool.gd"
## What tools show and see: where the mouse is, what is under it, and what would be done, as lines
## over the tree and a sentence beside the node.

const Sentences := preload("../translations/sentences.gd")
const NO_NODE: int = TreeReconstruction.NO_NODE
## Wood that would go, wood that would come, and wood that is meant.
const GONE: Color = Color(1.0, 0.27, 0.2)
const MADE: Color = Color(0.45, 1.0, 0.4)
const MEANT: Color = Color(0.4, 0.75, 1.0)
## The mouse goes so many pixels before it drags, at the editor's scale of 1.
const DRAG_FROM: float = 4.0
# The session remembers the camera that the user looked through last, with whatever tool. (A static
# variable would keep the script alive after the plugin.)
const _EYE: StringName = &"eye"

# The camera of the last event, and where the mouse was.
var _eye: Camera3D:
	get = _get_eye
var _pointer: Vector2
var _ghosts: Array = []
# What would be done, in a sentence.
var _hint: String = ""
var _refused: bool = false
# Where that stands.
var _sentence_box: Rect2
# The command that was shown last, if it can be done, and what it would change.
var _foreseen: Array = []


## Whether the mouse drags. The right button ends that.
func is_held() -> bool:
	return false


func draw(overlay: Control) -> void:
	_sentence_box = Rect2()
	if _hint.is_empty() or not is_seen_on(overlay):
		return
	var font: Font = overlay.get_theme_default_font()
	var font_size: int = overlay.get_theme_default_font_size()
	var scale: float = get_scale()
	var width: float = minf(420.0 * scale, overlay.size.x * 0.6)
	var text: TextParagraph = TextParagraph.new()
	text.add_string(_hint, font, font_size)
	text.width = width
	var size: Vector2 = text.get_size()
	if text.get_line_count() == 1:
		size.x = text.get_line_width(0)
	var border: Vector2 = Vector2(8, 5) * scale
	var origin: Vector2 = get_hint_place()
	var at: Vector2 = origin + Vector2(18, 24) * scale
	# It stays inside of the viewport; at its lower border above the place, which it must not hide.
	var box: Vector2 = size + 2.0 * border
	if at.y + box.y > overlay.size.y:
		at.y = origin.y - 24.0 * scale - box.y
	at = at.min(overlay.size - box - Vector2.ONE * 4.0 * scale).max(Vector2.ONE * 4.0 * scale)
	_sentence_box = Rect2(at, box)
	overlay.draw_rect(_sentence_box, Color(0.06, 0.06, 0.07, 0.78))
	var color: Color = Color(1.0, 0.72, 0.6) if _refused else Color(0.95, 0.95, 0.95)
	text.draw(overlay.get_canvas_item(), at + border, color)


func get_sentence_box() -> Rect2:
	return _sentence_box


func get_ghosts() -> Array:
	return _ghosts


## Where on the screen the sentence about what would be done stands: at the node in question, or at
## the mouse.
func get_hint_place() -> Vector2:
	var id: int = session.hovered
	if is_held() or id == NO_NODE or not session.tree.has_node(id):
		return _pointer
	var place: Vector2 = seen_at(session.tree.get_node_position(id))
	return place if place.is_finite() else _pointer


## The node under the mouse, or NO_NODE.
func pick() -> int:
	return session.picker.call(&"pick", _eye, _pointer)


## The place of the tree's space under the mouse, as far away as [param place].
func place_at(position: Vector2, place: Vector3) -> Vector3:
	return session.picker.call(&"ray_plane", _eye, position, place)


## Where a place of the tree's space is seen; infinity where it isn't.
func seen_at(place: Vector3) -> Vector2:
	if _eye == null:
		return Vector2.INF
	return session.picker.call(&"project_place", _eye, place)


## How many pixels a metre is at a place.
func pixels_per_metre(place: Vector3) -> float:
	return session.picker.call(&"pixels_per_metre", _eye, place)


## Whether the overlay lies over the viewport that the mouse is in.
func is_seen_on(overlay: Control) -> bool:
	return _eye != null and session.picker.call(&"get_camera_of", overlay) == _eye


func get_scale() -> float:
	return EditorInterface.get_editor_scale() if Engine.is_editor_hint() else 1.0


## A direction of the view in the tree's space: its right, its up, and the way the eye looks.
func view_direction(of_camera: Vector3) -> Vector3:
	var way: Vector3 = _eye.global_basis * of_camera
	return (session.node.global_basis.inverse() * way).normalized()


## A place or direction in the words of an edit command.
static func words_of(vector: Vector3) -> String:
	return "%s,%s,%s" % [String.num(vector.x, 7), String.num(vector.y, 7), String.num(vector.z, 7)]


## Nodes in the words of an edit command.
static func words_of_nodes(ids: PackedInt32Array) -> String:
	var words: PackedStringArray = []
	for id: int in ids:
		words.append(str(id))
	return ",".join(words)


## Shows what a command would do.
func show_command(command: String) -> void:
	if command.is_empty():
		_clear()
		return
	var preview: Dictionary = session.tree.preview_edit(command)
	var error: String = preview["error"]
	_refused = not error.is_empty()
	_foreseen = []
	if not _refused:
		_foreseen = [command, session.tree, session.tree.get_bark_revision()]
	# The message tells what was done, as if it had been.
	var domain: StringName = session.get_translation_domain()
	_hint = Sentences.translate(error if _refused else preview["message"], domain)
	if not _refused:
		_hint = tr("After a click: %s") % _hint
	set_ghosts(preview["removed"], preview["added"])


## Shows lines: pairs of places in the tree's space.
func set_ghosts(gone: PackedVector3Array, made: PackedVector3Array, made_color := MADE) -> void:
	_ghosts = []
	if gone.size() + made.size() > 0:
		var colors: PackedColorArray = []
		colors.resize(gone.size())
		colors.fill(GONE)
		var more: PackedColorArray = []
		more.resize(made.size())
		more.fill(made_color)
		_ghosts.resize(Mesh.ARRAY_MAX)
		_ghosts[Mesh.ARRAY_VERTEX] = gone + made
		_ghosts[Mesh.ARRAY_COLOR] = colors + more
	changed.emit()


## The segments of nodes as pairs of places.
func get_lines_of(ids: PackedInt32Array) -> PackedVector3Array:
	var lines: Array = session.tree.build_selection_lines(ids)
	return lines[Mesh.ARRAY_VERTEX] if not lines.is_empty() else PackedVector3Array()


func _clear() -> void:
	var had: bool = not _hint.is_empty() or not _ghosts.is_empty()
	_hint = ""
	_refused = false
	_ghosts = []
	if had:
		changed.emit()


func _get_eye() -> Camera3D:
	var camera: Camera3D = instance_from_id(session.get_meta(_EYE, 0)) as Camera3D
	if camera == null and Engine.is_editor_hint():
		camera = EditorInterface.get_editor_viewport_3d(0).get_camera_3d()
	return camera
