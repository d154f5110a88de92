@tool
extends "wood_tool.gd"
## Takes a branch as an L-string: to read it, to edit it, and to graft it elsewhere.

# What was taken last, for the strip.
var _taken: String = ""
var _taken_label: Label


func get_id() -> StringName:
	return &"pick"


func get_title() -> String:
	return tr("Pick a branch")


func get_tooltip() -> String:
	return tr(
		(
			"Click a node to copy the branch that begins there. The dock shows it as an L-string,"
			+ " and the Graft tool puts it onto other nodes. The tree stays as it is."
		)
	)


func get_icon() -> String:
	return "ColorPick"


func get_key() -> Key:
	return KEY_K


func make_settings() -> Control:
	var strip: Strip = Strip.new()
	_taken_label = strip.add_text(_taken if not _taken.is_empty() else tr("No branch is picked."))
	strip.add_button(
		tr("Graft it"), tr("Takes the Graft tool, with the picked branch."), _on_graft_pressed
	)
	return strip


func _click(id: int) -> void:
	if session.tree.get_node_count() < 2:
		session.say(
			"The tree is a single node: there is no branch on it to take.", session.Kind.WARNING
		)
		return
	var lstring: String = session.tree.take_branch(id)
	if lstring.is_empty():
		return
	session.take_scion(lstring)
	var measures: Dictionary = TreeReconstruction.measure_branch(lstring)
	_taken = (
		tr("Picked a branch of %d nodes, %.2f m long and %.1f cm thick at its base.")
		% [measures["node_count"], measures["length"], measures["base_radius"] * 200.0]
	)
	if is_instance_valid(_taken_label):
		_taken_label.text = _taken
	session.select([id])
	session.string_picked.emit(lstring, id)
	session.say(_taken)


func accept() -> bool:
	if session.tree == null or session.get_active() == NO_NODE:
		return false
	_click(session.get_active())
	return true


func _look_again() -> void:
	if not session.tree.has_node(session.hovered):
		_clear()
		return
	var branch: PackedInt32Array = session.tree.select_nodes("below:%d" % session.hovered)
	_refused = false
	_hint = tr("A branch of %d nodes.") % branch.size()
	set_ghosts([], get_lines_of(branch), MEANT)


func _on_graft_pressed() -> void:
	session.choose(&"graft")
