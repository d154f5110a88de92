@tool
extends "wood_tool.gd"
## Evens out radii, ways and kinks of branches.

enum What { RADII, PATHS, KINKS }


func get_id() -> StringName:
	return &"smooth"


func get_title() -> String:
	return tr("Smooth")


func get_tooltip() -> String:
	return tr(
		(
			"Click a node to even out the branch that grows there, as much as the slider below says."
			+ " Enter does it to the selected nodes."
		)
	)


func get_icon() -> String:
	return "res://addons/tree_reconstruction/icons/tools/smooth.svg"


func get_key() -> Key:
	return KEY_M


func get_defaults() -> Dictionary[StringName, Variant]:
	return {&"what": int(What.PATHS), &"amount": 0.5}


func make_settings() -> Control:
	_restore()
	var strip: Strip = Strip.new()
	strip.add_choice(
		tr("Even out"),
		tr(
			(
				"How thick branches are along their way, how they run, or only where they turn too"
				+ " sharply."
			)
		),
		[tr("the thickness"), tr("the way"), tr("kinks")],
		values[&"what"],
		set_setting.bind(&"what")
	)
	strip.add_number(
		tr("Amount"),
		tr("From a little to as much as there is."),
		0.05,
		1.0,
		0.05,
		values[&"amount"],
		set_setting.bind(&"amount")
	)
	strip.add_button(
		tr("Smooth the selected nodes"),
		tr("Evens out the selected nodes alone, as Enter does."),
		accept
	)
	strip.add_button(
		tr("Smooth the whole tree"), tr("Evens out all branches of the tree."), smooth_whole
	)
	return strip


func get_command_at(id: int) -> String:
	return _command("below:%d" % id)


func get_commands_of_selection() -> PackedStringArray:
	return [_command(words_of_nodes(get_selected()))]


## Evens out all branches.
func smooth_whole() -> void:
	if session.tree != null:
		_finish(session.run(get_title(), _command("all")))


func _command(nodes: String) -> String:
	var amount: float = values[&"amount"]
	match values[&"what"]:
		What.RADII:
			return (
				"smooth_radii nodes=%s strength=%s rounds=%d"
				% [nodes, String.num(minf(0.3 + amount, 1.0), 3), ceili(amount * 10.0)]
			)
		What.PATHS:
			return (
				"smooth_paths nodes=%s strength=%s rounds=%d"
				% [nodes, String.num(minf(0.2 + amount, 0.7), 3), ceili(amount * 10.0)]
			)
	return (
		"relax nodes=%s angle=%s rounds=%d"
		% [nodes, String.num(lerpf(70.0, 10.0, amount), 2), ceili(amount * 10.0)]
	)
