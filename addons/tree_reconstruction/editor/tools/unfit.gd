@tool
extends "wood_tool.gd"
## Goes through the edits that did not fit when the scan was imported again: shows where each one
## was, and lets the user do it elsewhere, keep it for the next import, or forget it.

const LocalTrees := preload("../local_trees.gd")

# Half as long as the piece of wood that marks a place, in metres, and in diameters of the wood.
const _LEAST_REACH: float = 0.1
const _REACH: float = 3.0
# How much around a place is shown, in metres.
const _AROUND: float = 0.6
const _NODES: String = "(^| )(node|nodes|at)=\\S+"

var _edits: Array[Dictionary] = []
var _at: int = -1
var _edits_of: String = ""
var _label: Label


func get_id() -> StringName:
	return &"unfit"


func get_title() -> String:
	return tr("Edits that no longer fit")


func get_tooltip() -> String:
	return tr(
		(
			"Shows in red where the edits were that did not fit when the scan was imported again. Click"
			+ " the wood that is meant to do an edit there. Enter goes on to the next one and keeps it"
			+ " for the next import, Backspace forgets it."
		)
	)


func get_icon() -> String:
	return "res://addons/tree_reconstruction/icons/tools/unfit.svg"


func get_key() -> Key:
	return KEY_R


func make_settings() -> Control:
	var strip: Strip = Strip.new()
	strip.add_button(
		tr("Next"), tr("Keeps this edit for the next import and goes on (Enter)."), accept
	)
	strip.add_button(tr("Forget"), tr("Does not try this edit again (Backspace)."), forget)
	_label = strip.add_text("")
	_show_count()
	return strip


func start() -> void:
	super()
	_list()
	if not _edits.is_empty():
		_go_to(0)


func stop() -> void:
	_edits = []
	_edits_of = ""
	_at = -1
	super()


## The edit at hand, as [method TreeReconstruction.get_unfit_edits] tells it, or an empty one.
func get_edit() -> Dictionary:
	return _edits[_at] if _at >= 0 and _at < _edits.size() else {}


## The number of edits that fit nowhere.
func get_left() -> int:
	return _edits.size()


## The edit at hand, done at another node: empty where it speaks of more than one place.
func get_command_at(id: int) -> String:
	var edit: Dictionary = get_edit()
	if edit.is_empty():
		return ""
	var command: String = edit["command"]
	var nodes: RegEx = RegEx.create_from_string(_NODES)
	var found: Array[RegExMatch] = nodes.search_all(command)
	if found.size() != 1 or "@" in nodes.sub(command, ""):
		return ""
	var place: String = "node=%d" % id
	if found[0].get_string(2) == "nodes":
		# All that grows from a node goes with it by itself.
		place = ("nodes=%d" if command.begins_with("remove ") else "nodes=below:%d") % id
	return nodes.sub(command, "$1" + place)


## Goes on; the edit is tried again at the next import.
func accept() -> bool:
	if _edits.is_empty():
		return false
	_go_to((_at + 1) % _edits.size())
	return true


## Does not try the edit at hand again.
func forget() -> void:
	var edit: Dictionary = get_edit()
	if edit.is_empty():
		return
	var of: TreeReconstruction = session.tree
	session.begin_step(tr("Forget an edit"), of, of)
	session.history.add_property(
		of, &"edit_log", of.get_edit_log_without(edit["index"]), of.edit_log
	)
	session.history.commit()
	_go_on()


func _click(id: int) -> void:
	var command: String = get_command_at(id)
	if command.is_empty():
		return
	var of: TreeReconstruction = session.tree
	var sentence: String = of.check_edit(command)
	if not sentence.is_empty():
		session.say(sentence, Session.Kind.ERROR)
		return
	var index: int = get_edit()["index"]
	var before: String = of.edit_log
	var without: String = of.get_edit_log_without(index)
	of.edit_log = without
	var edit: TreeEdit = of.run_script(_frame_of(before, index) + "\n" + command)
	if edit == null or edit.is_empty():
		of.edit_log = before
		return
	session.begin_step(get_title(), of, of)
	session.history.add_property(of, &"edit_log", without, before)
	session.history.add_method(of, &"apply_edit", [edit], &"revert_edit", [edit])
	session.history.commit(false)
	session.say(edit.get_message())
	_go_on()


func _press_key(key: InputEventKey) -> bool:
	if key.keycode != KEY_BACKSPACE or key.echo:
		return false
	forget()
	return true


## Where the edit was, in the tree's space.
func get_box(edit: Dictionary) -> AABB:
	var places: PackedVector3Array = edit["places"]
	if places.is_empty():
		return session.tree.get_aabb()
	var box: AABB = AABB(places[0], Vector3.ZERO)
	for place: Vector3 in places:
		box = box.expand(place)
	return box.grow(_AROUND)


func _look_again() -> void:
	_list()
	var edit: Dictionary = get_edit()
	if edit.is_empty():
		_clear()
	elif session.tree.has_node(session.hovered) and not get_command_at(session.hovered).is_empty():
		show_command(get_command_at(session.hovered))
	else:
		_refused = false
		_hint = _text_of(edit)
		set_ghosts(_lines_of(edit), [])
	_show_count()


func get_hint_place() -> Vector2:
	var edit: Dictionary = get_edit()
	if edit.is_empty() or session.tree.has_node(session.hovered):
		return super()
	var seen: Vector2 = seen_at(get_box(edit).get_center())
	return seen.max(Vector2.ZERO) if seen.is_finite() else _pointer


# After every change of the log, by whomever.
func _list() -> void:
	if session.tree == null or LocalTrees.is_foreign(session.tree, session.node):
		_edits = []
	elif session.tree.edit_log != _edits_of:
		_edits_of = session.tree.edit_log
		_edits = session.tree.get_unfit_edits()
	_at = mini(maxi(_at, 0), _edits.size() - 1)


func _go_to(index: int) -> void:
	_at = index
	var edit: Dictionary = get_edit()
	if not edit.is_empty():
		session.view_wanted.emit(get_box(edit))
		session.say(tr("Edit %d of %d: %s") % [_at + 1, _edits.size(), _text_of(edit)])
	_queue()


# The one at hand is done with: the next one takes its number.
func _go_on() -> void:
	_list()
	if _edits.is_empty():
		session.say(tr("All edits fit the scan."))
		_queue()
	else:
		_go_to(_at)


func _text_of(edit: Dictionary) -> String:
	var reason: String = Sentences.translate(edit["reason"], session.get_translation_domain())
	return "%s %s" % [_name_of((edit["command"] as String).get_slice(" ", 0)), reason]


func _name_of(command: String) -> String:
	for known: Dictionary in TreeReconstruction.get_edit_commands():
		if known["name"] == command:
			match known["group"]:
				"prune":
					return tr("This cut does not fit any more.")
				"graft":
					return tr("This graft does not fit any more.")
				"shape", "smooth":
					return tr("This change of shape does not fit any more.")
	return tr("This edit (%s) does not fit any more.") % command


# A piece of wood and a cross, square to it, at each place.
func _lines_of(edit: Dictionary) -> PackedVector3Array:
	var lines: PackedVector3Array = []
	var places: PackedVector3Array = edit["places"]
	for i: int in places.size():
		var along: Vector3 = edit["directions"][i]
		if along == Vector3.ZERO:
			along = Vector3.UP
		var reach: float = maxf(_REACH * edit["radii"][i], _LEAST_REACH)
		var side: Vector3 = along.cross(Vector3.UP if absf(along.y) < 0.9 else Vector3.RIGHT)
		side = side.normalized()
		for arm: Vector3 in [along, 0.5 * side, 0.5 * along.cross(side)]:
			lines.append(places[i] - arm * reach)
			lines.append(places[i] + arm * reach)
	return lines


func _show_count() -> void:
	if not is_instance_valid(_label):
		return
	if _edits.is_empty():
		_label.text = tr("All edits fit the scan.")
	else:
		_label.text = tr("Edit %d of %d") % [_at + 1, _edits.size()]


# In which frame the log tells the places and lengths of one of its edits.
static func _frame_of(log: String, index: int) -> String:
	var frame: String = ""
	var count: int = -1
	for line: String in log.split("\n"):
		if line.begins_with("frame "):
			frame = line
		elif line.begins_with("#? ") or not (line.begins_with("#") or line.is_empty()):
			count += 1
			if count == index:
				break
	return frame
