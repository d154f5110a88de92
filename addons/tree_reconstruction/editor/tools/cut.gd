@tool
extends "wood_tool.gd"
## Cuts a branch off, at its joint or where it is clicked.


func get_id() -> StringName:
	return &"cut"


func get_title() -> String:
	return tr("Cut")


func get_tooltip() -> String:
	return tr(
		(
			"Click a branch to saw it off where it grows from another one; what falls is shown in red."
			+ " Enter cuts the selected nodes off. A stub may be left, as a real saw leaves it."
		)
	)


func get_icon() -> String:
	return "ActionCut"


func get_key() -> Key:
	return KEY_C


func get_defaults() -> Dictionary[StringName, Variant]:
	return {&"here": false, &"stub": 0.0}


func make_settings() -> Control:
	_restore()
	var strip: Strip = Strip.new()
	strip.add_choice(
		"",
		tr("Where a click cuts."),
		[tr("The whole branch"), tr("At the clicked node")],
		1 if values[&"here"] else 0,
		_on_place_chosen
	)
	strip.add_number(
		tr("Stub (m)"),
		tr("How much of the branch stays at its joint."),
		0.0,
		0.5,
		0.005,
		values[&"stub"],
		set_setting.bind(&"stub")
	)
	return strip


func get_command_at(id: int) -> String:
	return "cut node=%d stub=%s" % [_first_of(id), String.num(values[&"stub"], 4)]


func get_commands_of_selection() -> PackedStringArray:
	var lowest: PackedInt32Array = get_lowest_selected()
	if values[&"stub"] == 0.0 and lowest.size() > 1:
		return ["remove nodes=%s" % words_of_nodes(lowest)]
	var commands: PackedStringArray = []
	for id: int in lowest:
		commands.append("cut node=%d stub=%s" % [id, String.num(values[&"stub"], 4)])
	return commands


func get_idle_command() -> String:
	var lowest: PackedInt32Array = get_lowest_selected()
	return "" if lowest.is_empty() else "remove nodes=%s" % words_of_nodes(lowest)


func _finish(edit: TreeEdit) -> void:
	if edit != null:
		session.select(edit.get_result_nodes())
	super(edit)


# Where the branch of a node begins. The trunk has no joint: it is cut where it is clicked.
func _first_of(id: int) -> int:
	if values[&"here"]:
		return id
	var branch: PackedInt32Array = session.tree.select_nodes("branch:%d" % id)
	return id if branch.is_empty() or branch[0] == session.tree.get_root() else branch[0]


func _on_place_chosen(index: int) -> void:
	set_setting(index == 1, &"here")
