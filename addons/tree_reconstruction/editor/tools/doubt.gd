@tool
extends "wood_tool.gd"
## Goes through the places where tree and scan disagree: branches that the scan hardly supports, and
## points that no branch explains.

enum Kind { DOUBTFUL, MISSING }

const Search := preload("branch_search.gd")

const _DOUBTFUL_COLOR: Color = Color(1.0, 0.65, 0.1)
# Fewer points are noise, and more places nobody goes through.
const _LEAST_POINTS: int = 40
const _MOST_MISSING: int = 100
const _DRAWN_POINTS: int = 400


## A place to look at.
class Place:
	extends RefCounted
	var kind: Kind
	## The branch's first node, or the one that the missing branch would grow from.
	var node: int
	var at: Vector3
	var direction: Vector3
	## Indices of the points that nothing explains, in the scan's wood.
	var points: PackedInt32Array
	var text: String

	## The same for the same place after another measurement.
	func get_key() -> String:
		return "d%d" % node if kind == Kind.DOUBTFUL else "m%v" % at.snappedf(0.1)


var _places: Array[Place] = []
var _at: int = -1
# By Place.get_key(): what the user has decided upon.
var _decided: Dictionary[String, bool] = {}
var _decided_of: TreeReconstruction
var _was_measured: bool = false
var _measured: bool = false
var _search: Search
var _label: Label


func get_id() -> StringName:
	return &"doubt"


func get_title() -> String:
	return tr("Doubtful places")


func get_tooltip() -> String:
	return tr(
		(
			"Brings into view, one by one, the branches that the scan hardly supports and the points"
			+ " that no branch explains. Enter keeps such a branch or finds the missing one,"
			+ " Backspace removes it or skips the points, and the tool's key goes on without deciding."
		)
	)


func get_icon() -> String:
	return "res://addons/tree_reconstruction/icons/tools/doubt.svg"


func get_key() -> Key:
	return KEY_Y


func make_settings() -> Control:
	var strip: Strip = Strip.new()
	strip.add_button(
		tr("Accept"), tr("Keeps the doubtful branch, or finds the missing one (Enter)."), accept
	)
	strip.add_button(
		tr("Reject"), tr("Removes the doubtful branch, or skips the points (Backspace)."), reject
	)
	strip.add_button(tr("Next"), tr("Goes on without deciding."), _press_own_key)
	_label = strip.add_text("")
	_show_count()
	return strip


func start() -> void:
	super()
	if _search == null:
		_search = Search.new(session)
		_search.ended.connect(_on_search_ended)
	if _decided_of != session.tree:
		_decided_of = session.tree
		_decided.clear()
	_was_measured = session.scan.fidelity != null
	session.scan.fidelity_changed.connect(_on_fidelity_changed)
	session.scan.measure()
	if _was_measured:
		_on_fidelity_changed()


func stop() -> void:
	if session.scan.fidelity_changed.is_connected(_on_fidelity_changed):
		session.scan.fidelity_changed.disconnect(_on_fidelity_changed)
		if not _was_measured:
			session.scan.stop_measuring()
	_places.clear()
	_at = -1
	_measured = false
	super()


func is_busy() -> bool:
	return _search != null and _search.is_busy()


func is_held() -> bool:
	return false


func cancel() -> void:
	if _search != null:
		_search.cancel()


## The mouse picks nothing: the place at hand stays selected.
func _press(_button: InputEventMouseButton) -> bool:
	return false


func _press_key(key: InputEventKey) -> bool:
	if key.keycode != KEY_BACKSPACE or key.echo:
		return false
	reject()
	return true


## Goes on without deciding.
func _press_own_key() -> bool:
	if not _places.is_empty():
		_go_to((_at + 1) % _places.size())
	return true


## Keeps the doubtful branch, or finds the missing one.
func accept() -> bool:
	var place: Place = get_place()
	if place == null or is_busy():
		return false
	if place.kind == Kind.DOUBTFUL:
		_decide(true)
	else:
		_search.find(tr("Find a missing branch"), place.node, place.direction, {"reach": 0.0})
	return true


## Removes the doubtful branch, or skips the points.
func reject() -> void:
	var place: Place = get_place()
	if place == null or is_busy():
		return
	if place.kind == Kind.DOUBTFUL:
		if session.run(tr("Remove a doubtful branch"), "remove nodes=%d" % place.node) == null:
			return
	_decide(place.kind == Kind.MISSING)


## The place at hand, or [code]null[/code].
func get_place() -> Place:
	return _places[_at] if _at >= 0 and _at < _places.size() else null


## Where a place is, in the tree's space, with what the branch grows from.
func get_box(place: Place) -> AABB:
	if place.kind == Kind.DOUBTFUL:
		return session.get_box_of(session.tree.select_nodes("below:%d" % place.node))
	var box: AABB = AABB(place.at, Vector3.ZERO).expand(session.tree.get_node_position(place.node))
	for point: int in place.points:
		box = box.expand(session.scan.wood[point])
	return box


## The number of places that nothing was decided about.
func get_left() -> int:
	return _places.size()


func _look_again() -> void:
	var place: Place = get_place()
	_refused = false
	_hint = "" if place == null else place.text
	if place == null or not session.tree.has_node(place.node):
		_clear()
	elif place.kind == Kind.DOUBTFUL:
		set_ghosts(
			[], get_lines_of(session.tree.select_nodes("below:%d" % place.node)), _DOUBTFUL_COLOR
		)
	else:
		set_ghosts([], _lines_of_missing(place), MEANT)
	_show_count()


func draw(overlay: Control) -> void:
	super(overlay)
	if get_place() == null or not is_seen_on(overlay):
		return
	var middle: Vector2 = overlay.size / 2.0
	var seen: Vector2 = seen_at(get_place().at)
	if not seen.is_finite():
		# Behind the eye.
		seen = middle + Vector2(0.0, overlay.size.y)
	if Rect2(Vector2.ZERO, overlay.size).has_point(seen):
		return
	# It is out of sight: an arrow points there.
	var scale: float = get_scale()
	var way: Vector2 = (seen - middle).normalized()
	var reach: Vector2 = (middle - Vector2.ONE * 30.0 * scale) / way.abs().max(Vector2.ONE * 1e-6)
	var tip: Vector2 = middle + way * minf(reach.x, reach.y)
	var side: Vector2 = way.orthogonal() * 9.0 * scale
	var back: Vector2 = tip - way * 20.0 * scale
	overlay.draw_colored_polygon([tip, back + side, back - side], _DOUBTFUL_COLOR)


func get_hint_place() -> Vector2:
	var place: Place = get_place()
	var seen: Vector2 = seen_at(place.at) if place != null else _pointer
	return seen.max(Vector2.ZERO) if seen.is_finite() else _pointer


func _go_to(index: int) -> void:
	_at = index
	var place: Place = get_place()
	if place != null and session.tree.has_node(place.node):
		session.select([place.node])
		session.view_wanted.emit(get_box(place))
		session.say(tr("Place %d of %d: %s") % [_at + 1, _places.size(), place.text])
	_queue()


# The place at hand is done with: the next one takes its number. One that the user wants as it is
# does not come back; what was removed or found does, if that is undone.
func _decide(stays: bool) -> void:
	if stays:
		_decided[get_place().get_key()] = true
	_places.remove_at(_at)
	if _places.is_empty():
		_at = -1
		session.say(tr("That was the last doubtful place."))
		_queue()
	else:
		_go_to(_at % _places.size())


func _on_fidelity_changed() -> void:
	var here: String = get_place().get_key() if get_place() != null else ""
	_measured = true
	_places = _list_places()
	_at = -1 if _places.is_empty() else mini(maxi(_at, 0), _places.size() - 1)
	for i: int in _places.size():
		if _places[i].get_key() == here:
			_at = i
			_queue()
			return
	if _places.is_empty():
		session.say(tr("The tree and its scan agree: there is no doubtful place left."))
		_queue()
	else:
		_go_to(_at)


func _list_places() -> Array[Place]:
	var places: Array[Place] = []
	if session.scan.fidelity == null or session.tree == null:
		return places
	for entry: Dictionary in session.scan.fidelity.get_doubtful():
		var place: Place = Place.new()
		place.kind = Kind.DOUBTFUL
		place.node = entry["node"]
		if not session.tree.has_node(place.node):
			continue
		place.at = session.tree.get_node_position(place.node)
		place.text = (
			tr("A doubtful branch of %.2f m: %s.")
			% [
				entry["length"],
				Sentences.translate_list(entry["reasons"], session.get_translation_domain())
			]
		)
		_add(places, place)
	var missing: int = 0
	for entry: Dictionary in session.scan.fidelity.get_unexplained():
		var place: Place = Place.new()
		place.kind = Kind.MISSING
		place.points = entry["points"]
		place.node = entry["joint"]
		if place.points.size() < _LEAST_POINTS or not session.tree.has_node(place.node):
			continue
		place.at = entry["center"]
		place.direction = entry["direction"]
		place.text = (
			tr("%d points of the scan, %.2f m wide, that no branch explains.")
			% [place.points.size(), entry["size"]]
		)
		if missing < _MOST_MISSING and _add(places, place):
			missing += 1
	return places


func _add(places: Array[Place], place: Place) -> bool:
	if _decided.has(place.get_key()):
		return false
	places.append(place)
	return true


# Small crosses at some of the points, and the way to them.
func _lines_of_missing(place: Place) -> PackedVector3Array:
	var lines: PackedVector3Array = [session.tree.get_node_position(place.node), place.at]
	var arm: float = 0.01
	if _eye != null:
		arm = 4.0 * get_scale() / maxf(pixels_per_metre(place.at), 1e-6)
	var step: int = maxi(place.points.size() / _DRAWN_POINTS, 1)
	for i: int in range(0, place.points.size(), step):
		var at: Vector3 = session.scan.wood[place.points[i]]
		for axis: Vector3 in [Vector3.RIGHT, Vector3.UP]:
			lines.append(at - axis * arm)
			lines.append(at + axis * arm)
	return lines


func _on_search_ended(added: PackedInt32Array) -> void:
	if get_place() == null:
		return
	if added.is_empty():
		# What was said tells why. It stays until the user skips it.
		_queue()
	else:
		_decide(false)
		session.select(added)


func _show_count() -> void:
	if not is_instance_valid(_label):
		return
	if session.tree == null or not _measured:
		_label.text = tr("The tree is compared with its scan…")
	elif _places.is_empty():
		_label.text = tr("No doubtful place is left.")
	else:
		_label.text = tr("Place %d of %d") % [_at + 1, _places.size()]
