@tool
extends "seeing_tool.gd"
## Sets the scale of a scan that has none, as one of photos, by a length that the user knows:
## between two places of its points or of the tree.

const Strip := preload("strip.gd")
const Widgets := preload("../dock/widgets.gd")

# How far off a click may be, in pixels at the editor's scale of 1.
const _REACH: float = 12.0
const _LEAST: float = 1e-4

## The two places, in the tree's space, as far as they are clicked.
var places: PackedVector3Array = []

var _known: SpinBox
var _apply: Button
var _label: Label


func get_id() -> StringName:
	return &"length"


func get_title() -> String:
	return tr("Known length")


func get_tooltip() -> String:
	return tr(
		(
			"Click two places of the scan between which you know the length, such as the base of the"
			+ " trunk and a mark on it, and type it below the viewport: the tree gets its true size."
			+ " Photos have no scale."
		)
	)


func get_icon() -> String:
	return "Ruler"


func get_key() -> Key:
	return KEY_A


func start() -> void:
	places = []
	session.tree_changed.connect(_forget)
	if not Session.ScanData.source_of(session.tree).is_empty():
		session.view.points = true
		session.scan.request()


func stop() -> void:
	if session.tree_changed.is_connected(_forget):
		session.tree_changed.disconnect(_forget)
	places = []
	_clear()


func make_settings() -> Control:
	var strip: Strip = Strip.new()
	_label = strip.add_text("")
	_known = Widgets.number(0.0, 1000.0, 0.001, "m")
	_known.allow_greater = true
	_known.value_changed.connect(_tell.unbind(1))
	strip.add_labelled(tr("True length"), tr("How long that is in truth, in metres."), _known)
	_apply = (
		strip
		. add_button(
			tr("Set the Scale"),
			tr(
				"Reconstructs the scan again so that the two places are that far apart. You can undo it."
			),
			apply
		)
	)
	_tell()
	return strip


## How far apart the two places are now, in metres; 0 without two.
func get_length() -> float:
	return places[0].distance_to(places[1]) if places.size() == 2 else 0.0


## Reconstructs with the scale that makes the length [member _known]'s.
func apply() -> void:
	var length: float = get_length()
	if session.tree == null or length < _LEAST or _known.value <= 0.0:
		return
	var report: Dictionary = session.tree.provenance.get("report", {})
	var metres: float = report.get("metres_per_unit", 0.0)
	if metres <= 0.0:
		session.say(
			tr("This tree wasn't made of a scan, so it can't be made again in another scale."),
			Session.Kind.WARNING
		)
		return
	var changed: Dictionary = {
		"scale": metres * _known.value / length, "known_height": null, "known_length": null
	}
	session.reconstruction_wanted.emit(changed)


func input(camera: Camera3D, event: InputEvent) -> bool:
	if session.tree == null or session.picker == null:
		return false
	session.set_meta(_EYE, camera.get_instance_id())
	var button: InputEventMouseButton = event as InputEventMouseButton
	if button == null or button.button_index != MOUSE_BUTTON_LEFT or not button.pressed:
		return false
	_pointer = button.position
	var place: Vector3 = find_place(camera, button.position)
	if not place.is_finite():
		return false
	if places.size() == 2:
		places = []
	places.append(place)
	_tell()
	set_ghosts([], places if places.size() == 2 else PackedVector3Array(), MEANT)
	return true


## The place of the scan that is seen at [param position], or of the tree where no point is;
## infinity where there is nothing.
func find_place(camera: Camera3D, position: Vector2) -> Vector3:
	var ray: PackedVector3Array = session.picker.call(&"get_ray", camera, position)
	var ahead: Vector3 = ray[0] + ray[1]
	var reach: float = (
		_REACH * get_scale() / float(session.picker.call(&"pixels_per_metre", camera, ahead))
	)
	var by_distance: bool = camera.projection == Camera3D.PROJECTION_PERSPECTIVE
	var index: int = (
		TreeReconstructor
		. find_point(
			session.scan.points,
			ray[0],
			ray[1],
			0.0 if by_distance else reach,
			# At one metre of the world ahead.
			reach / ray[1].length() if by_distance else 0.0
		)
	)
	if index >= 0:
		return session.scan.points[index]
	var id: int = session.picker.call(&"pick", camera, position)
	return Vector3.INF if id == NO_NODE else session.tree.get_node_position(id)


func draw(overlay: Control) -> void:
	if not is_seen_on(overlay):
		return
	var seen: PackedVector2Array = []
	for place: Vector3 in places:
		var at: Vector2 = seen_at(place)
		if at.is_finite():
			overlay.draw_circle(at, 4.0 * get_scale(), MEANT)
			overlay.draw_arc(at, 6.0 * get_scale(), 0.0, TAU, 24, Color.BLACK, get_scale())
			seen.append(at)
	if seen.size() < 2:
		return
	overlay.draw_line(seen[0], seen[1], MEANT, 2.0 * get_scale(), true)
	var font: Font = overlay.get_theme_default_font()
	var size: int = overlay.get_theme_default_font_size()
	var middle: Vector2 = (seen[0] + seen[1]) * 0.5 + Vector2(10, 4) * get_scale()
	var text: String = "%.3f m" % get_length()
	overlay.draw_string_outline(
		font,
		middle,
		text,
		HORIZONTAL_ALIGNMENT_LEFT,
		-1,
		size,
		roundi(4.0 * get_scale()),
		Color.BLACK
	)
	overlay.draw_string(font, middle, text, HORIZONTAL_ALIGNMENT_LEFT, -1, size, MEANT)


# The tree is another one now.
func _forget() -> void:
	places = []
	_clear()
	_tell()


func _tell() -> void:
	changed.emit()
	if not is_instance_valid(_label):
		return
	match places.size():
		0:
			_label.text = tr("Click the first of two places.")
		1:
			_label.text = tr("Click the other place.")
		_:
			_label.text = tr("%.3f m between the two places.") % get_length()
	_apply.disabled = get_length() < _LEAST or _known.value <= 0.0
