@tool
extends "wood_tool.gd"
## The leaves: which kind, how many, how large, and at what time of the year.

## By property: its slider.
var _sliders: Dictionary[StringName, Variant] = {}
var _presets: Variant
var _enabled: Variant
var _showing: bool = false


func get_id() -> StringName:
	return &"leaf_rule"


func get_title() -> String:
	return tr("Leaf rule")


func get_tooltip() -> String:
	return tr(
		(
			"Choose a kind of leaves below and change how many there are, how large, and in which season."
			+ " The tree follows at once. The mouse selects nothing meanwhile."
		)
	)


func get_icon() -> String:
	return "res://addons/tree_reconstruction/icons/tools/leaf_rule.svg"


func get_key() -> Key:
	return KEY_F2


func make_settings() -> Control:
	var strip: Strip = Strip.new()
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
		&"internode":
		strip.add_number(
			tr("Distance (m)"),
			tr("How far leaves stand apart along a twig: less makes the crown denser."),
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


## Shows the rule's values, whoever changed them.
func _look_again() -> void:
	_show_values()


func accept() -> bool:
	return false


## Gives the tree the leaves of a preset.
func choose_preset(name: String) -> void:
	if session.tree == null:
		return
	session.set_value(tr("Leaf rule"), session.tree, &"leaf_rule", LeafRule.from_preset(name))
	_queue()


## Sets a property of the tree's rule. Changes that follow each other quickly become one step.
func set_rule(property: StringName, value: Variant) -> void:
	if session.tree == null:
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
	if rule == null:
		rule = LeafRule.from_preset(session.tree.leaf_preset)
	_showing = true
	(_enabled as CheckBox).button_pressed = rule.enabled
	var names: PackedStringArray = TreeReconstruction.get_leaf_preset_names()
	(_presets as OptionButton).select(names.find(rule.look))
	for property: StringName in _sliders:
		(_sliders[property] as Range).value = rule.get(property)
	_showing = false


func _titles_of_presets() -> PackedStringArray:
	var titles: PackedStringArray = []
	for name: String in TreeReconstruction.get_leaf_preset_names():
		titles.append(name.capitalize())
	return titles


func _on_preset_chosen(index: int) -> void:
	choose_preset(TreeReconstruction.get_leaf_preset_names()[index])


func _on_value_changed(value: Variant, property: StringName) -> void:
	if not _showing:
		set_rule(property, value)


func _on_inspect_pressed() -> void:
	if session.tree == null:
		return
	if session.tree.leaf_rule == null:
		choose_preset(session.tree.leaf_preset)
	if Engine.is_editor_hint():
		EditorInterface.inspect_object(session.tree.leaf_rule)
