@tool
extends RefCounted
## Draws over the viewport: the node under the mouse with its figures.

const Session: GDScript = preload("../session.gd")
const Picker: GDScript = preload("picker.gd")
const NO_NODE: int = TreeReconstruction.NO_NODE
const _RING: Color = Color(1.0, 0.95, 0.4)
# How far down the viewport's own buttons reach, in pixels at the editor's scale of 1.
const _BUTTONS: float = 50.0
# Between a label and what is beside it.
const _GAP: float = 6.0

var _session: Session
# The figures, and what they are of: they are made once and drawn often.
var _text: String
var _text_of: Array = []


func _init(session: Session) -> void:
	set_translation_domain(session.get_translation_domain())
	_session = session


## Draws into an overlay over the viewport of [param camera]; [param mouse_in] says whether the
## mouse is over it, and [param taken] where a tool has written there.
func draw(overlay: Control, camera: Camera3D, picker: Picker, mouse_in: bool, taken: Rect2) -> void:
	var id: int = _session.hovered
	if id == NO_NODE or _session.tree == null or not _session.tree.has_node(id):
		return
	var at: Vector2 = picker.project(camera, id)
	if not at.is_finite():
		return
	var scale: float = Picker.get_scale()
	var place: Vector3 = _session.tree.get_node_position(id)
	var wood: float = _session.tree.get_node_radius(id) * picker.pixels_per_metre(camera, place)
	var ring: float = clampf(wood, 9.0 * scale, 60.0 * scale)
	overlay.draw_arc(at, ring, 0.0, TAU, 48, Color(0, 0, 0, 0.6), 4.0 * scale, true)
	overlay.draw_arc(at, ring, 0.0, TAU, 48, _RING, 2.0 * scale, true)
	if mouse_in:
		_draw_label(overlay, at, ring * 0.8 + 2.0 * scale, scale, taken)


## Where a label of such a [param size] stands in a viewport of the size [param room]: so far off
## the place [param at] that it hides neither that nor what is next to it, below [param top], where
## the viewport has its own buttons, and clear of what is [param taken].
static func place_label(
	at: Vector2, off: float, size: Vector2, room: Vector2, top: float, taken: Rect2
) -> Rect2:
	# Above and to the right; further left where that ends outside.
	var box: Rect2 = Rect2(at + Vector2(off, -off - size.y), size)
	box.position.x = clampf(box.position.x, _GAP, room.x - size.x - _GAP)
	if box.position.y < top:
		box.position.y = at.y + off
	if box.intersects(taken):
		box.position.y = taken.position.y - size.y - _GAP
		if box.position.y < top:
			box.position.y = taken.end.y + _GAP
	return box


func _draw_label(overlay: Control, at: Vector2, off: float, scale: float, taken: Rect2) -> void:
	var text: String = _describe()
	var font: Font = overlay.get_theme_default_font()
	var size: int = overlay.get_theme_default_font_size()
	var margin: Vector2 = Vector2(6.0, 3.0) * scale
	var needed: Vector2 = font.get_string_size(text, HORIZONTAL_ALIGNMENT_LEFT, -1, size)
	var box: Rect2 = place_label(
		at, off, needed + margin * 2.0, overlay.size, _BUTTONS * scale, taken
	)
	overlay.draw_rect(box, Color(0.08, 0.09, 0.1, 0.82))
	overlay.draw_string(
		font,
		box.position + margin + Vector2(0.0, font.get_ascent(size)),
		text,
		HORIZONTAL_ALIGNMENT_LEFT,
		-1,
		size,
		Color(0.95, 0.95, 0.92)
	)


func _describe() -> String:
	var tree: TreeReconstruction = _session.tree
	var id: int = _session.hovered
	var of: Array = [tree, id, tree.get_bark_revision()]
	if of != _text_of:
		_text_of = of
		var order: int = tree.get_node_order(id)
		_text = (
			tr("Node %d · radius %.1f cm · %.2f m up · %s")
			% [
				id,
				tree.get_node_radius(id) * 100.0,
				tree.get_node_position(id).y,
				tr("trunk") if order == 0 else tr("branch of order %d") % order
			]
		)
		if tree.is_guess(id):
			_text += tr(" · guessed")
	return _text
