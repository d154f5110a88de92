@tool
extends Control
## Lies over a 3D viewport while a twig is dragged, and grafts it where it is dropped.

const Session := preload("../session.gd")
const TwigList := preload("twig_list.gd")

var _session: Session
var _viewport: SubViewport


func _init(session: Session, viewport: SubViewport) -> void:
	_session = session
	_viewport = viewport
	set_anchors_preset(Control.PRESET_FULL_RECT)
	mouse_filter = Control.MOUSE_FILTER_IGNORE
	visible = false
	tooltip_text = "Drop the twig on the branch that shall bear it."


func _notification(what: int) -> void:
	if what == NOTIFICATION_DRAG_BEGIN:
		var dragged: bool = is_twig(get_viewport().gui_get_drag_data())
		visible = dragged and _session.tree != null and _session.picker != null
		mouse_filter = Control.MOUSE_FILTER_STOP if visible else Control.MOUSE_FILTER_IGNORE
	elif what == NOTIFICATION_DRAG_END:
		if visible:
			_session.hovered = _session.NO_NODE
		visible = false
		mouse_filter = Control.MOUSE_FILTER_IGNORE


## Whether a drag carries a twig.
static func is_twig(data: Variant) -> bool:
	return data is Dictionary and data.get("type", "") == TwigList.DRAG


## Grafts a twig at a node, as one step.
static func graft(session: Session, scion: String, id: int) -> TreeEdit:
	var what: String = scion if scion.begins_with("twig=") else 'string="%s"' % scion
	var edit: TreeEdit = session.run(
		session.tr("Graft Twig"), "graft node=%d %s seed=%d" % [id, what, session.tree.seed]
	)
	if edit != null and not edit.get_result_nodes().is_empty():
		session.select(edit.get_result_nodes())
	return edit


func _can_drop_data(at: Vector2, data: Variant) -> bool:
	if not is_twig(data) or _session.tree == null:
		return false
	_session.hovered = _pick(at)
	return _session.hovered != _session.NO_NODE


func _drop_data(at: Vector2, data: Variant) -> void:
	var id: int = _pick(at)
	if id != _session.NO_NODE:
		graft(_session, data.scion, id)


func _pick(at: Vector2) -> int:
	var camera: Camera3D = _viewport.get_camera_3d()
	if camera == null or size.x <= 0.0 or _session.picker == null:
		return _session.NO_NODE
	# The viewport may be drawn at a lower resolution than it is shown at.
	return _session.picker.call(&"pick", camera, at * (Vector2(_viewport.size) / size))
