@tool
extends "wood_tool.gd"
## Leaves fewer nodes: of a branch, or of the whole tree.

enum Way { LIGHTEN, MERGE }

var _count: Label
# The settings of the way that is not chosen.
var _hidden: Dictionary[Way, Array] = {}


func get_id() -> StringName:
	return &"simplify"


func get_title() -> String:
	return tr("Simplify")


func get_tooltip() -> String:
	return tr(
		(
			"Click a node to leave fewer nodes in the branch that grows there; how many is told before."
			+ " Enter does it to the selected branches, and the button below to the whole tree."
		)
	)


func get_icon() -> String:
	return "res://addons/tree_reconstruction/icons/tools/simplify.svg"


func get_key() -> Key:
	return KEY_I


func get_defaults() -> Dictionary[StringName, Variant]:
	return {&"way": int(Way.LIGHTEN), &"share": 50.0, &"angle": 15.0, &"distance": 0.05}


func make_settings() -> Control:
	_restore()
	var strip: Strip = Strip.new()
	(
		strip
		. add_choice(
			"",
			tr(
				(
					"Leave out what is seen least, as many as you ask for; or join wood that hardly turns"
					+ " and tips that lie side by side."
				)
			),
			[tr("Leave out the least visible"), tr("Merge neighbours")],
			values[&"way"],
			_on_way_chosen
		)
	)
	_hidden = {
		Way.LIGHTEN:
		[
			strip.add_number(
				tr("Keep (%)"),
				tr("The share of the nodes that stays."),
				2.0,
				95.0,
				1.0,
				values[&"share"],
				set_setting.bind(&"share")
			)
		],
		Way.MERGE:
		[
			strip.add_number(
				tr("Turn (°)"),
				tr("Wood that turns by less becomes one piece."),
				0.0,
				60.0,
				1.0,
				values[&"angle"],
				set_setting.bind(&"angle")
			),
			strip.add_number(
				tr("Tips (m)"),
				tr("Two tips of a fork that are nearer than this become one."),
				0.0,
				0.5,
				0.005,
				values[&"distance"],
				set_setting.bind(&"distance")
			)
		]
	}
	strip.add_button(
		tr("Simplify the whole tree"), tr("Leaves fewer nodes in all branches."), simplify_whole
	)
	_count = strip.add_text("", tr("How many nodes the tree has."))
	_show_way()
	_show_count()
	return strip


func get_command_at(id: int) -> String:
	return "%s below=%d" % [_command(), id]


func get_commands_of_selection() -> PackedStringArray:
	var commands: PackedStringArray = []
	for id: int in get_lowest_selected():
		commands.append(get_command_at(id))
	return commands


## Simplifies all branches.
func simplify_whole() -> void:
	if session.tree != null:
		_finish(session.run(get_title(), _command()))


func _look_again() -> void:
	super()
	_show_count()


func _finish(edit: TreeEdit) -> void:
	super(edit)
	_show_count()


func _command() -> String:
	if values[&"way"] == Way.LIGHTEN:
		return "lighten share=%s" % String.num(values[&"share"] / 100.0, 4)
	return (
		"merge angle=%s distance=%s"
		% [String.num(values[&"angle"], 3), String.num(values[&"distance"], 4)]
	)


func _on_way_chosen(index: int) -> void:
	set_setting(index, &"way")
	_show_way()


func _show_way() -> void:
	for way: Way in _hidden:
		for slider: Variant in _hidden[way]:
			if is_instance_valid(slider):
				((slider as Range).get_parent() as Control).visible = way == values[&"way"]


func _show_count() -> void:
	if is_instance_valid(_count) and session.tree != null:
		_count.text = tr("%d nodes") % session.tree.get_node_count()
