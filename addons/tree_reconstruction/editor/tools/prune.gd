@tool
extends "wood_tool.gd"
## Cuts away what grows above a node, or the long twigs of the whole tree.

var _shows_whole: bool = false


func get_id() -> StringName:
	return &"prune"


func get_title() -> String:
	return tr("Prune")


func get_tooltip() -> String:
	return tr(
		(
			"Click a node to cut away all that grows above it; what goes is shown in red before."
			+ " Enter does it to the selected nodes, and the button below takes long twigs off"
			+ " the whole tree."
		)
	)


func get_icon() -> String:
	return "res://addons/tree_reconstruction/icons/tools/prune.svg"


func get_key() -> Key:
	return KEY_D


func get_defaults() -> Dictionary[StringName, Variant]:
	return {&"factor": 1.5, &"metres": false, &"spare_leader": true}


func make_settings() -> Control:
	_restore()
	var strip: Strip = Strip.new()
	strip.add_number(
		tr("Twigs longer than"),
		tr("How many times the mean length a twig may have when the whole tree is pruned."),
		0.25,
		5.0,
		0.05,
		values[&"factor"],
		_on_whole_changed.bind(&"factor")
	)
	strip.add_choice(
		tr("× the mean in"),
		tr("How the length of a twig is counted."),
		[tr("nodes"), tr("metres")],
		1 if values[&"metres"] else 0,
		_on_measure_chosen
	)
	strip.add_switch(
		tr("Spare the top"),
		tr("Leave the tip of the trunk itself alone."),
		values[&"spare_leader"],
		_on_whole_changed.bind(&"spare_leader")
	)
	var button: Button = strip.add_button(
		tr("Prune the whole tree"),
		tr("Cuts twigs that are too long to the length on the left. What goes is shown in red."),
		prune_whole
	)
	button.mouse_entered.connect(_show_whole.bind(true))
	button.mouse_exited.connect(_show_whole.bind(false))
	return strip


func get_command_at(id: int) -> String:
	return "prune_below node=%d" % id


func get_commands_of_selection() -> PackedStringArray:
	var words: PackedStringArray = []
	for id: int in get_lowest_selected():
		if not session.tree.get_node_children(id).is_empty():
			words.append("below:%d&!%d" % [id, id])
	if words.is_empty():
		return []
	return ["remove nodes=%s" % ",".join(words)]


func get_idle_command() -> String:
	if _shows_whole:
		return get_whole_command()
	var commands: PackedStringArray = get_commands_of_selection()
	return "" if commands.is_empty() else commands[0]


## The command that prunes the whole tree.
func get_whole_command() -> String:
	return (
		"prune factor=%s by=%s spare_leader=%s"
		% [
			String.num(values[&"factor"], 4),
			"metres" if values[&"metres"] else "nodes",
			"yes" if values[&"spare_leader"] else "no"
		]
	)


func accept() -> bool:
	if get_commands_of_selection().is_empty():
		return false
	return super()


func _move(_motion: InputEventMouseMotion) -> bool:
	_show_whole(false)
	return false


## Prunes the whole tree by the thesis' algorithm 3.
func prune_whole() -> void:
	if session.tree != null:
		_finish(session.run(get_title(), get_whole_command()))


func _show_whole(shows: bool) -> void:
	if _shows_whole != shows:
		_shows_whole = shows
		_rests = false
		_queue()


func _on_whole_changed(value: Variant, key: StringName) -> void:
	_shows_whole = true
	set_setting(value, key)


func _on_measure_chosen(index: int) -> void:
	_shows_whole = true
	set_setting(index == 1, &"metres")
