@tool
extends "wood_tool.gd"
## The leaves: which kind, how many, how large, and at what time of the year. Of the whole tree, or
## of some of its wood: then what is chosen makes a rule (docs/editing.md) that the command
## [code]leaves[/code] gives to the selected branches and twigs, or to the one that is clicked.

# A slider has come to rest after so many seconds: what it did becomes one step.
const _REST: float = 0.35

## By property: its slider.
var _sliders: Dictionary[StringName, Variant] = {}
var _presets: Variant
var _enabled: Variant
var _showing: bool = false
var _wood: CheckBox
# The rule for wood; empty: the tree's own leaves.
var _rule: String = ""
var _of_wood: bool = false
var _waiting: SceneTreeTimer


func get_id() -> StringName:
	return &"leaf_rule"


func get_title() -> String:
	return tr("Leaf rule")


func get_tooltip() -> String:
	return tr(
		(
			"Choose a kind of leaves below and change how many there are, how large, and in which season."
			+ " The tree follows at once. With wood selected, or with Selected wood on, only that wood"
			+ " gets the leaves: the selected branches, or the one that you click."
		)
	)


func get_icon() -> String:
	return "res://addons/tree_reconstruction/icons/tools/leaf_rule.svg"


func get_key() -> Key:
	return KEY_F2


func start() -> void:
	_of_wood = session.tree != null and not get_selected().is_empty()
	_take_rule_of_selection()
	super()
	_show_values()


func stop() -> void:
	_settle()
	super()


func make_settings() -> Control:
	var strip: Strip = Strip.new()
	_wood = (
		strip
		. add_switch(
			tr("Selected wood"),
			tr(
				(
					"Whether the leaves below are for some wood alone: for the selected branches and twigs,"
					+ " with all that grows from them, or for the one that you click."
				)
			),
			_of_wood,
			_on_wood_toggled
		)
	)
	_enabled = strip.add_switch(
		tr("Leaves"), tr("Whether the tree bears leaves."), true, _on_value_changed.bind(&"enabled")
	)
	_presets = strip.add_choice(
		tr("Kind"),
		tr("The kind of leaves. Choosing one sets all values."),
		_titles_of_presets(),
		-1,
		_on_preset_chosen
	)
	_sliders = {
		&"leaf_area_index":
		strip.add_number(
			tr("Leaf area"),
			tr("Square meters of leaves over each of the ground: more makes the crown denser."),
			0.0,
			12.0,
			0.1,
			4.5,
			_on_value_changed.bind(&"leaf_area_index")
		),
		&"internode":
		strip.add_number(
			tr("Distance (m)"),
			tr("How far leaves stand apart along a twig, where the leaf area is 0."),
			0.005,
			0.5,
			0.005,
			0.05,
			_on_value_changed.bind(&"internode")
		),
		&"leaf_size":
		strip.add_number(
			tr("Size (m)"),
			tr("The length of a leaf, or of the spray that stands for several."),
			0.01,
			2.0,
			0.005,
			0.25,
			_on_value_changed.bind(&"leaf_size")
		),
		&"season":
		strip.add_number(
			tr("Season"),
			tr("0 the buds open, 0.1 spring, 0.4 summer, 0.7 autumn, 1 bare."),
			0.0,
			1.0,
			0.01,
			0.4,
			_on_value_changed.bind(&"season")
		),
		&"droop":
		strip.add_number(
			tr("Droop (°)"),
			tr("How far leaves hang down."),
			0.0,
			90.0,
			1.0,
			20.0,
			_on_value_changed.bind(&"droop")
		),
	}
	strip.add_button(
		tr("All values"), tr("Shows the whole leaf rule in the inspector."), _on_inspect_pressed
	)
	_show_values()
	return strip


## Shows the rule's values, whoever changed them, and the wood that a click would give them to.
func _look_again() -> void:
	_show_values()
	if not _of_wood or not session.tree.has_node(session.hovered):
		_clear()
		return
	var branch: PackedInt32Array = session.tree.select_nodes("below:%d" % session.hovered)
	_refused = false
	_hint = tr("Gives these leaves to a branch of %d nodes.") % branch.size()
	set_ghosts([], get_lines_of(branch), MEANT)


func get_command_at(id: int) -> String:
	return _command_for("below:%d" % id) if _of_wood else ""


## Whether what is chosen is for some wood alone.
func is_of_wood() -> bool:
	return _of_wood


## Turns that on or off.
func set_of_wood(on: bool) -> void:
	if _of_wood == on:
		return
	_settle()
	_of_wood = on
	_take_rule_of_selection()
	_queue()
	_show_values()


## Gives the rule to the selected wood, as one step.
func accept() -> bool:
	if not _of_wood or session.tree == null or get_selected().is_empty():
		return false
	_drop_timer()
	var words: PackedStringArray = []
	for id: int in get_lowest_selected():
		words.append("below:%d" % id)
	_finish(session.run(get_title(), _command_for(",".join(words))))
	return true


## Gives the tree, or the selected wood, the leaves of a preset; wood also [code]default[/code], the
## tree's own.
func choose_preset(name: String) -> void:
	if session.tree == null:
		return
	if _of_wood:
		_rule = "" if name == "default" else name
		accept()
		_queue()
		return
	session.set_value(tr("Leaf rule"), session.tree, &"leaf_rule", LeafRule.from_preset(name))
	_queue()


## Sets a property of the tree's rule, or of the wood's. Changes that follow each other quickly
## become one step.
func set_rule(property: StringName, value: Variant) -> void:
	if session.tree == null:
		return
	# The season is that of the whole tree.
	if _of_wood and property != &"season":
		_rule = _changed_rule(_rule, property, value)
		_wait()
		return
	var rule: LeafRule = session.tree.leaf_rule
	if rule == null:
		rule = LeafRule.from_preset(session.tree.leaf_preset)
		rule.set(property, value)
		session.set_value(tr("Leaf rule"), session.tree, &"leaf_rule", rule)
	else:
		session.set_value(_title_of(property), rule, property, value, true)


func _title_of(property: StringName) -> String:
	match property:
		&"internode":
			return tr("Distance of the leaves")
		&"leaf_size":
			return tr("Leaf size")
		&"season":
			return tr("Season")
		&"droop":
			return tr("Droop of the leaves")
	return tr("Leaves")


func _show_values() -> void:
	if session.tree == null or not is_instance_valid(_presets):
		return
	var rule: LeafRule = session.tree.leaf_rule
	if _of_wood:
		rule = session.tree.resolve_leaf_rule("default" if _rule.is_empty() else _rule)
	elif rule == null:
		rule = LeafRule.from_preset(session.tree.leaf_preset)
	_showing = true
	_wood.button_pressed = _of_wood
	(_enabled as CheckBox).button_pressed = rule.enabled
	var names: PackedStringArray = TreeReconstruction.get_leaf_preset_names()
	var preset: String = rule.look
	if _of_wood:
		preset = _rule.get_slice(" ", 0)
	var chosen: int = names.find(preset)
	# What is no preset is a change of the tree's own.
	(_presets as OptionButton).select(names.size() if _of_wood and chosen < 0 else chosen)
	(_presets as OptionButton).set_item_disabled(names.size(), not _of_wood)
	for property: StringName in _sliders:
		(_sliders[property] as Range).value = rule.get(property)
	_showing = false


func _titles_of_presets() -> PackedStringArray:
	var titles: PackedStringArray = []
	for name: String in TreeReconstruction.get_leaf_preset_names():
		titles.append(name.capitalize())
	titles.append(tr("As the tree's own"))
	return titles


func _on_preset_chosen(index: int) -> void:
	var names: PackedStringArray = TreeReconstruction.get_leaf_preset_names()
	choose_preset(names[index] if index < names.size() else "default")


func _on_value_changed(value: Variant, property: StringName) -> void:
	if not _showing:
		set_rule(property, value)


func _on_wood_toggled(on: bool) -> void:
	if not _showing:
		set_of_wood(on)


func _command_for(where: String) -> String:
	return 'leaves where=%s rule="%s"' % [where, "default" if _rule.is_empty() else _rule]


# That of the node selected last.
func _take_rule_of_selection() -> void:
	_rule = ""
	if _of_wood and not get_selected().is_empty():
		var rules: Dictionary = session.tree.count_leaf_rules(get_selected().slice(-1))
		_rule = rules.keys()[0]


# A rule with another value of one of its properties.
static func _changed_rule(rule: String, property: StringName, value: Variant) -> String:
	if property == &"enabled":
		return "" if value else "none"
	var words: PackedStringArray = []
	for word: String in rule.split(" ", false):
		if word != "none" and not word.begins_with("%s=" % property):
			words.append(word)
	words.append("%s=%s" % [property, String.num(value, 5)])
	return " ".join(words)


# What a slider does is given to the wood when it has come to rest.
func _wait() -> void:
	_drop_timer()
	_waiting = (Engine.get_main_loop() as SceneTree).create_timer(_REST)
	_waiting.timeout.connect(_settle)


func _settle() -> void:
	if _waiting != null:
		accept()
	_drop_timer()


func _drop_timer() -> void:
	if _waiting != null:
		_waiting.timeout.disconnect(_settle)
		_waiting = null


func _on_inspect_pressed() -> void:
	if session.tree == null:
		return
	if session.tree.leaf_rule == null:
		choose_preset(session.tree.leaf_preset)
	if Engine.is_editor_hint():
		EditorInterface.inspect_object(session.tree.leaf_rule)
