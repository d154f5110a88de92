@tool
extends "wood_tool.gd"
## Paints burls, ridges, hollows and obstacles on the bark, which grows them (docs/bark.md).

const BarkObstacles := preload("../dock/bark_obstacles.gd")
const BarkFeatures := preload("../bark/bark_features.gd")
const BarkPreview := preload("../bark/bark_preview.gd")
const BarkWords := preload("../bark/bark_words.gd")
const BarkWork := preload("../bark/bark_work.gd")
const Recipe := preload("../dock/growth_recipe.gd")

# In pixels at the editor's scale of 1: how near to a handle a click must be, and how large it is.
const _REACH: float = 11.0
const _HANDLE: float = 5.0
# What a step of the wheel makes of a feature's size.
const _STEP: float = 1.12
const _LEAST: float = 0.2
const _MOST: float = 4.0
const _COLORS: Dictionary[String, Color] = {
	"burl": Color(0.98, 0.75, 0.35),
	"hollow": Color(0.95, 0.45, 0.4),
	"obstacle": Color(0.55, 0.85, 1.0),
}
const _BESIDE: Color = Color(0.0, 0.0, 0.0, 0.6)

var _worker: TreeReconstructor = TreeReconstructor.new()
var _preview: BarkPreview = BarkPreview.new()
var _work: BarkWork
# The node that tells when what grew is drawn.
var _node: TreeInstance3D
var _size: Range
# Where the mouse is over the bark; empty where it isn't.
var _over: Dictionary = {}
# What is dragged: a copy of its line, and which of the features it is, NONE for a new one.
var _line: Recipe.Line
var _index: int = BarkWork.NONE
var _pressed_at: Vector2
var _moved: bool = false
# What find_bark() told, and of what.
var _places: Array[Dictionary] = []
var _places_of: Array = []
# The lines that were painted since the bark grew.
var _painted: PackedStringArray = []


func get_id() -> StringName:
	return BarkWork.TOOL


func get_title() -> String:
	return tr("Paint Bark")


func get_tooltip() -> String:
	return tr(
		(
			"Click the bark of the trunk or of a thick branch to put a burl, a ridge, a hollow or an"
			+ " obstacle there: the bark grows it. Drag its handle to move it, turn the wheel over it"
			+ " or press [ and ] to change its size, Delete to take it away."
		)
	)


func get_icon() -> String:
	return "res://addons/tree_reconstruction/icons/tools/paint_bark.svg"


## It sees the bark, wherever the skeleton's nodes are.
func picks_nodes() -> bool:
	return false


func get_key() -> Key:
	return KEY_F3


func get_defaults() -> Dictionary[StringName, Variant]:
	return {&"kind": 0, &"size": 1.0, &"grow": true}


func make_settings() -> Control:
	_restore()
	var strip: Strip = Strip.new()
	strip.add_choice(
		"",
		tr("What a click puts on the bark."),
		BarkWords.new(session.get_translation_domain()).get_titles(),
		values[&"kind"],
		set_setting.bind(&"kind")
	)
	_size = strip.add_number(
		tr("Size"),
		tr("How large it is: 1 goes with the thickness of the wood. [ and ] change it."),
		_LEAST,
		_MOST,
		0.01,
		values[&"size"],
		set_setting.bind(&"size")
	)
	(
		strip
		. add_switch(
			tr("Grow while Painting"),
			tr(
				(
					"The bark grows after each change, coarsely at first. Without it, press Grow in the Tree"
					+ " dock."
				)
			),
			values[&"grow"],
			_on_grow_toggled
		)
	)
	strip.add_button(
		tr("From the Scene…"),
		tr("An obstacle that is a node of this scene, such as a fence: move it there."),
		BarkObstacles.choose.bind(session)
	)
	return strip


func start() -> void:
	_work = BarkWork.of(session) as BarkWork
	super()
	_work.automatic = values[&"grow"]
	_work.changed.connect(_on_work_changed)
	_node = session.node
	_node.rebuilt.connect(_on_work_changed)
	session.tree_changed.connect(_update_preview)
	session.hovered = NO_NODE
	_painted = []
	_update_preview()


func stop() -> void:
	super()
	_preview.clear()
	_over = {}
	_places = []
	_places_of = []
	if _work != null and _work.changed.is_connected(_on_work_changed):
		_work.changed.disconnect(_on_work_changed)
		session.tree_changed.disconnect(_update_preview)
	if is_instance_valid(_node):
		_node.rebuilt.disconnect(_on_work_changed)
	_node = null
	_work = null


func is_busy() -> bool:
	return _line != null


func cancel() -> void:
	_line = null
	_index = BarkWork.NONE
	_moved = false
	_update_preview()
	changed.emit()


func accept() -> bool:
	return false


## The bark under a place of the screen, as [method TreeReconstructor.pick_bark] tells of it.
func pick_place(camera: Camera3D, at: Vector2) -> Dictionary:
	var ray: PackedVector3Array = session.picker.call(&"get_ray", camera, at)
	return _worker.pick_bark(session.tree, ray[0], ray[1], _get_longest())


## Where the handle of a feature is seen; infinity where it isn't.
func get_handle(index: int) -> Vector2:
	var places: Array[Dictionary] = _find_places()
	if index < 0 or index >= places.size() or places[index].is_empty():
		return Vector2.INF
	return seen_at(places[index].position)


func _press(button: InputEventMouseButton) -> bool:
	_pressed_at = button.position
	_moved = false
	var index: int = _find_handle(button.position)
	if index != BarkWork.NONE:
		_work.selected = index
		_index = index
		_line = Recipe.Line.new(_work.get_selected().get_text())
		changed.emit()
		return true
	var place: Dictionary = pick_place(_eye, button.position)
	if place.is_empty():
		_work.selected = BarkWork.NONE
		return false
	_index = BarkWork.NONE
	_line = _make_at(place)
	_update_preview()
	changed.emit()
	return true


func _move(motion: InputEventMouseMotion) -> bool:
	if is_busy() and not motion.button_mask & MOUSE_BUTTON_MASK_LEFT:
		# The button was let go elsewhere.
		cancel()
		return false
	_over = pick_place(_eye, motion.position)
	if is_busy():
		if motion.position.distance_to(_pressed_at) >= DRAG_FROM * get_scale():
			_moved = true
		if _moved and not _over.is_empty():
			_put(_line, _over)
		_update_preview()
	_update_hint()
	changed.emit()
	return is_busy()


func _release(_button: InputEventMouseButton) -> bool:
	if not is_busy():
		return false
	var line: Recipe.Line = _line
	var index: int = _index
	var done: bool = _moved or index == BarkWork.NONE
	_line = null
	_index = BarkWork.NONE
	_moved = false
	if done:
		_commit(
			line,
			index,
			tr("Place on the Bark") if index == BarkWork.NONE else tr("Move on the Bark")
		)
	_update_preview()
	changed.emit()
	return true


func _wheel(steps: int, button: InputEventMouseButton) -> bool:
	if not is_busy():
		var index: int = _find_handle(button.position)
		if index == BarkWork.NONE:
			return false
		_work.selected = index
	_resize(steps)
	return true


func _press_key(key: InputEventKey) -> bool:
	match key.keycode:
		KEY_BRACKETLEFT:
			_resize(-1)
			return true
		KEY_BRACKETRIGHT:
			_resize(1)
			return true
		KEY_DELETE:
			return not is_busy() and remove_selected()
		KEY_ESCAPE:
			if _work.selected != BarkWork.NONE:
				_work.selected = BarkWork.NONE
				return true
	return false


## Takes the selected feature away. Returns whether one is selected.
func remove_selected() -> bool:
	var line: Recipe.Line = _work.get_selected()
	if line == null:
		return false
	_work.get_recipe().lines.erase(line)
	_work.selected = BarkWork.NONE
	_work.commit(tr("Remove from the Bark"))
	return true


func _click(_id: int) -> void:
	pass


func _look_again() -> void:
	_update_hint()
	_update_preview()
	changed.emit()


func draw(overlay: Control) -> void:
	super(overlay)
	if _work == null or session.node == null or not is_seen_on(overlay):
		return
	var features: Array[Recipe.Line] = _work.get_recipe().get_features()
	var places: Array[Dictionary] = _find_places()
	for i: int in features.size():
		if not (is_busy() and i == _index):
			_draw_feature(overlay, features[i], places[i], i == _work.selected)
	if is_busy():
		_draw_feature(overlay, _line, _find_place(_line), true)
	elif not _over.is_empty() and _find_handle(_pointer) == BarkWork.NONE:
		var line: Recipe.Line = _make_at(_over)
		_draw_lines(
			overlay,
			BarkFeatures.outline_of(line, _over, _work.get_default),
			Color(_COLORS[line.command], 0.75),
			1.5
		)


func _draw_feature(on: Control, line: Recipe.Line, place: Dictionary, chosen: bool) -> void:
	if place.is_empty():
		return
	var color: Color = MEANT if chosen else _COLORS.get(line.command, Color.WHITE)
	# On the other side of the wood it is seen through it, faintly.
	var eye: Vector3 = session.node.global_transform.affine_inverse() * _eye.global_position
	if (place.out as Vector3).dot(eye - place.position as Vector3) < 0.0:
		color.a = 0.35
	var wide: float = 2.5 if chosen else 1.5
	if line.command == "obstacle":
		wide = 1.5 if chosen else 1.0
	_draw_lines(on, BarkFeatures.outline_of(line, place, _work.get_default), color, wide)
	var at: Vector2 = seen_at(place.position)
	if at.is_finite():
		var radius: float = _HANDLE * get_scale() * (1.3 if chosen else 1.0)
		on.draw_circle(at, radius + 1.5 * get_scale(), Color(_BESIDE, _BESIDE.a * color.a))
		on.draw_circle(at, radius, color)


func _draw_lines(on: Control, lines: PackedVector3Array, color: Color, width: float) -> void:
	for i: int in range(0, lines.size(), 2):
		var a: Vector2 = seen_at(lines[i])
		var b: Vector2 = seen_at(lines[i + 1])
		if a.is_finite() and b.is_finite():
			on.draw_line(
				a, b, Color(_BESIDE, _BESIDE.a * color.a), (width + 1.5) * get_scale(), true
			)
	for i: int in range(0, lines.size(), 2):
		var a: Vector2 = seen_at(lines[i])
		var b: Vector2 = seen_at(lines[i + 1])
		if a.is_finite() and b.is_finite():
			on.draw_line(a, b, color, width * get_scale(), true)


func _commit(line: Recipe.Line, index: int, title: String, merged: Array = []) -> void:
	var recipe: Recipe = _work.get_recipe()
	if index == BarkWork.NONE:
		recipe.lines.append(line)
		index = recipe.get_features().size() - 1
	else:
		recipe.get_features()[index].values = line.values
	_painted.append(line.get_text())
	_work.commit(title, merged)
	_work.selected = index
	_update_preview()


func _resize(steps: int) -> void:
	var factor: float = pow(_STEP, steps)
	if is_busy():
		_moved = true
		BarkFeatures.scale(_line, factor, _work.get_default)
		_update_preview()
		changed.emit()
		return
	var chosen: Recipe.Line = _work.get_selected()
	if chosen == null:
		values[&"size"] = clampf(values[&"size"] * factor, _LEAST, _MOST)
		if is_instance_valid(_size):
			_size.set_value_no_signal(values[&"size"])
		changed.emit()
		return
	var line: Recipe.Line = Recipe.Line.new(chosen.get_text())
	BarkFeatures.scale(line, factor, _work.get_default)
	var index: int = _work.selected
	_commit(line, index, tr("Resize on the Bark"), [session.tree.get_instance_id(), index])


func _make_at(place: Dictionary) -> Recipe.Line:
	var made: Recipe.Line = BarkFeatures.make(
		BarkFeatures.KINDS[values[&"kind"]], place.radius, values[&"size"]
	)
	_put(made, place)
	return made


func _put(line: Recipe.Line, place: Dictionary) -> void:
	line.values.erase("node")
	line.values.erase("middle")
	if place.node != session.tree.get_root():
		line.values["node"] = str(place.node)
	line.values["along"] = Recipe.written(place.along)
	line.values["around"] = String.num(place.around, 1)


# The places of the recipe's features.
func _find_places() -> Array[Dictionary]:
	var features: Array[Recipe.Line] = _work.get_recipe().get_features()
	var text: String = _head()
	var before: int = text.count("\n")
	for line: Recipe.Line in features:
		text += line.get_text() + "\n"
	var of: Array = [text, session.tree, session.tree.get_bark_revision()]
	if of != _places_of:
		_places_of = of
		_places = _worker.find_bark(session.tree, text).slice(before)
		for i: int in features.size():
			# What is in the scene is moved there.
			if features[i].values.has("mesh") or features[i].values.has("file"):
				_places[i] = {}
	return _places


func _find_place(line: Recipe.Line) -> Dictionary:
	var head: String = _head()
	return _worker.find_bark(session.tree, head + line.get_text())[head.count("\n")]


# What of the recipe is not about one place: its edges and the grain.
func _head() -> String:
	var text: String = ""
	for line: Recipe.Line in _work.get_recipe().lines:
		if line.command in ["edges", "grain"]:
			text += line.get_text() + "\n"
	return text


func _get_longest() -> float:
	var edges: Recipe.Line = _work.get_recipe().find("edges")
	var standard: String = _work.get_default("edges", "longest")
	var given: String = standard if edges == null else edges.values.get("longest", standard)
	return maxf(given.to_float(), 0.001)


func _find_handle(at: Vector2) -> int:
	var nearest: float = _REACH * get_scale()
	var found: int = BarkWork.NONE
	for i: int in _find_places().size():
		var handle: Vector2 = get_handle(i)
		if handle.is_finite() and handle.distance_to(at) <= nearest:
			nearest = handle.distance_to(at)
			found = i
	return found


func _update_hint() -> void:
	_hint = ""
	if not _over.is_empty() and not _rests:
		var words: PackedStringArray = BarkWords.new(session.get_translation_domain()).get_titles()
		var title: String = words[values[&"kind"]]
		if is_busy():
			_hint = tr("%.2f m along, %d°") % [_over.along, roundi(_over.around)]
		elif _find_handle(_pointer) != BarkWork.NONE:
			_hint = tr("Drag to move it, turn the wheel to change its size.")
		else:
			_hint = tr("%s: %.2f m along, %d°") % [title, _over.along, roundi(_over.around)]


# What is dragged, and what was painted and is not grown yet.
func _update_preview() -> void:
	if _work == null or _work.session == null or session.tree == null:
		_preview.clear()
		return
	if _work.is_seen() and not _node.is_rebuilding():
		_painted = []
	var text: String = ""
	if is_busy():
		text = _line.get_text()
	else:
		for line: Recipe.Line in _work.get_recipe().get_features():
			if line.get_text() in _painted:
				text += line.get_text() + "\n"
	_preview.show(session, _worker, "" if text.is_empty() else _head() + text)


func _on_grow_toggled(on: bool) -> void:
	set_setting(on, &"grow")
	_work.automatic = on


func _on_work_changed() -> void:
	_update_preview()
	changed.emit()
