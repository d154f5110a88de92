@tool
extends "section.gd"
## What leaves the tree bears: the preset, and what one most often changes of it, seen at once.

var preset: OptionButton
var sliders: Dictionary[StringName, HSlider] = {}
var form: OptionButton
var arrangement: OptionButton
var edit_all: Button

var _enabled: CheckBox
var _picture: TextureRect = TextureRect.new()
var _numbers: Dictionary[StringName, Label] = {}
var _formats: Dictionary[StringName, String] = {}
var _pictured: LeafRule
var _whose: Label
var _rules: Label
var _selected: Label


func get_id() -> StringName:
	return &"leaf_rule"


func close() -> void:
	pass


func _build() -> void:
	title = "Leaves"
	tooltip_text = "What leaves the tree bears, and how they stand. Changes are seen at once."
	folded = true
	_enabled = CheckBox.new()
	_enabled.text = "Bears leaves"
	_enabled.tooltip_text = "Without leaves the tree is bare."
	_enabled.toggled.connect(_on_enabled_toggled)
	_picture.custom_minimum_size = Vector2.ONE * Widgets.px(48)
	_picture.expand_mode = TextureRect.EXPAND_IGNORE_SIZE
	_picture.stretch_mode = TextureRect.STRETCH_KEEP_ASPECT_CENTERED
	_picture.tooltip_text = "What a leaf looks like."
	var names: PackedStringArray = TreeReconstruction.get_leaf_preset_names()
	var titles: PackedStringArray = []
	for name: String in names:
		titles.append(name.capitalize())
	preset = Widgets.choice(titles, Array(names))
	preset.tooltip_text = "The kind of tree whose leaves these are. It sets all that is below."
	preset.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	preset.item_selected.connect(_on_preset_selected)
	var head: HBoxContainer = HBoxContainer.new()
	var left: VBoxContainer = VBoxContainer.new()
	left.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	left.add_child(preset)
	left.add_child(_enabled)
	head.add_child(left)
	head.add_child(_picture)
	body.add_child(head)
	_add_slider(
		&"season",
		"Season",
		"From buds through summer (0.4) and autumn (0.7) to bare (1).",
		0.0,
		1.0,
		0.01,
		"%.2f"
	)
	_add_slider(
		&"leaf_size",
		"Size",
		"How long a leaf or a spray of leaves is.",
		0.01,
		1.0,
		0.005,
		"%.1f cm"
	)
	_add_slider(
		&"size_variation",
		"Size varies",
		"By how much leaves differ in size.",
		0.0,
		1.0,
		0.01,
		"%d %%"
	)
	_add_slider(
		&"leaf_area_index",
		"Leaf area",
		"Square meters of leaves over each of the ground: more makes the crown denser.",
		0.0,
		12.0,
		0.1,
		"%.1f"
	)
	_add_slider(
		&"internode",
		"Distance",
		"How far leaves stand apart along a twig, where the leaf area is 0.",
		0.005,
		0.5,
		0.005,
		"%.1f cm"
	)
	_add_slider(
		&"twig_length",
		"On the last",
		"How far from its tip a branch bears leaves.",
		0.05,
		3.0,
		0.05,
		"%.2f m"
	)
	_add_slider(
		&"clustering", "At the tips", "How far leaves gather at the tips.", 0.0, 1.0, 0.01, "%d %%"
	)
	_add_slider(
		&"angle", "Angle", "The angle between a twig and its leaves.", 0.0, 180.0, 1.0, "%d°"
	)
	_add_slider(&"droop", "Droop", "How far leaves hang towards the ground.", 0.0, 90.0, 1.0, "%d°")
	_add_slider(
		&"phototropism",
		"To the light",
		"How far leaves turn to the sky and out of the crown.",
		0.0,
		1.0,
		0.01,
		"%d %%"
	)
	_add_slider(
		&"follow_density",
		"As scanned",
		"How far the scan decides where leaves stand.",
		0.0,
		1.0,
		0.01,
		"%d %%"
	)
	_add_slider(
		&"fold",
		"Fold",
		"How far each half of a leaf is turned about its midrib. At 0 it is flat.",
		-60.0,
		60.0,
		1.0,
		"%d°"
	)
	form = Widgets.choice(
		PackedStringArray(["Spray", "Simple", "Pinnate", "Palmate", "Needles"]),
		[
			LeafRule.FORM_SPRAY,
			LeafRule.FORM_SIMPLE,
			LeafRule.FORM_PINNATE,
			LeafRule.FORM_PALMATE,
			LeafRule.FORM_NEEDLES
		]
	)
	form.item_selected.connect(_on_choice.bind(form, &"form"))
	(
		body
		. add_child(
			(
				Widgets
				. line(
					"Form",
					"What a leaf is drawn as. A spray needs the fewest triangles; the others are for near views.",
					form
				)
			)
		)
	)
	arrangement = Widgets.choice(
		PackedStringArray(["Alternate", "Opposite", "Decussate", "Whorled", "Spiral", "Fascicled"]),
		range(6)
	)
	arrangement.item_selected.connect(_on_choice.bind(arrangement, &"arrangement"))
	body.add_child(
		Widgets.line("Stand", "How leaves follow one another along a twig.", arrangement)
	)
	edit_all = Widgets.button(
		"Edit all in the inspector", "Shows everything that the leaf rule has.", &"Edit"
	)
	edit_all.pressed.connect(_on_edit_all_pressed)
	body.add_child(buttons([edit_all]))
	_whose = Widgets.sentence()
	_whose.auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
	_whose.modulate.a = 0.7
	body.add_child(_whose)
	_rules = Widgets.sentence()
	_selected = Widgets.sentence()
	for label: Label in [_rules, _selected]:
		label.auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
		body.add_child(label)


func _refresh() -> void:
	var tree: TreeReconstruction = session.tree
	if tree == null:
		return
	var rule: LeafRule = shown_rule(tree)
	Widgets.choose(preset, tree.leaf_preset if tree.leaf_rule == null else rule.look)
	_enabled.set_pressed_no_signal(tree.leaves_enabled if tree.leaf_rule == null else rule.enabled)
	for property: StringName in sliders:
		var value: float = rule.get(property)
		sliders[property].set_value_no_signal(value)
		_show_number(property, value)
	(sliders[&"follow_density"].get_parent() as Control).visible = tree.has_foliage()
	(sliders[&"fold"].get_parent() as Control).visible = rule.form != LeafRule.FORM_NEEDLES
	Widgets.choose(form, rule.form)
	Widgets.choose(arrangement, rule.arrangement)
	_whose.visible = tree.leaf_rule != null and _is_file(tree.leaf_rule)
	if _whose.visible:
		_whose.text = tr("The rule is %s. A change gives this tree a copy.") % rule.resource_path
	_show_picture(rule)
	_show_rules_of_wood(tree)


# What wood has leaves of its own, and what the selected wood has.
func _show_rules_of_wood(tree: TreeReconstruction) -> void:
	var lines: PackedStringArray = [tr("Leaf rules in use:")]
	for kind: Dictionary in tree.get_leaf_kinds():
		if kind.nodes > 0:
			lines.append(_describe(kind.rule, kind.nodes))
	_rules.visible = lines.size() > 2
	_rules.text = "\n".join(lines)
	var counts: Dictionary = tree.count_leaf_rules(session.selection)
	lines = [tr("The selected wood has:")]
	for rule: String in counts:
		lines.append(_describe(rule, counts[rule]))
	_selected.visible = lines.size() > 1
	_selected.text = "\n".join(lines)


func _describe(rule: String, nodes: int) -> String:
	if rule.is_empty():
		return tr("the tree's own leaves: %s nodes") % Widgets.grouped(nodes)
	return tr("%s: %s nodes") % [rule, Widgets.grouped(nodes)]


## The rule of a tree; one with the same leaves where it has none.
static func shown_rule(tree: TreeReconstruction) -> LeafRule:
	if tree.leaf_rule != null:
		return tree.leaf_rule
	var rule: LeafRule = LeafRule.from_preset(tree.leaf_preset)
	rule.leaf_size = tree.leaf_size
	rule.size_variation = tree.leaf_size_variation
	rule.internode = tree.leaf_internode * _leaves_at_a_node(tree, rule)
	rule.twig_length = tree.leaf_twig_length
	rule.maximum_radius = tree.leaf_maximum_radius
	rule.angle = tree.leaf_angle
	rule.angle_variation = tree.leaf_angle_variation
	rule.droop = tree.leaf_droop
	rule.maximum_leaves = tree.maximum_leaves
	rule.enabled = tree.leaves_enabled
	if not tree.foliage_followed:
		rule.follow_density = 0.0
		rule.follow_color = 0.0
	return rule


# A tree counts its leaves' distances one by one, a rule those of its nodes. Sets the arrangement,
# too, where it is not the preset's.
static func _leaves_at_a_node(tree: TreeReconstruction, rule: LeafRule) -> float:
	var preset: TreeReconstruction = TreeReconstruction.new()
	preset.leaf_preset = tree.leaf_preset
	if tree.leaf_arrangement == preset.leaf_arrangement:
		return rule.internode / preset.leaf_internode
	if tree.leaf_arrangement == TreeReconstruction.LEAF_ARRANGEMENT_OPPOSITE:
		rule.arrangement = LeafRule.ARRANGEMENT_DECUSSATE
		return 2.0
	rule.arrangement = LeafRule.ARRANGEMENT_SPIRAL
	return 1.0


# Only a rule has all of it: a tree gets one when something of it is changed first.
func _own_rule() -> LeafRule:
	if session.tree.leaf_rule == null:
		session.set_value(
			tr("Give the Tree a Leaf Rule"), session.tree, &"leaf_rule", shown_rule(session.tree)
		)
	return session.tree.leaf_rule


func _change(property: StringName, step: String, value: Variant, merged: bool) -> void:
	if session.tree == null or shown_rule(session.tree).get(property) == value:
		return
	session.set_value(step, _own_rule(), property, value, merged)


func _add_slider(
	property: StringName,
	title: String,
	tip: String,
	low: float,
	high: float,
	step: float,
	format: String
) -> void:
	var slider: HSlider = HSlider.new()
	slider.min_value = low
	slider.max_value = high
	slider.step = step
	slider.allow_greater = true
	slider.value_changed.connect(_on_slider_changed.bind(property))
	slider.size_flags_vertical = Control.SIZE_SHRINK_CENTER
	sliders[property] = slider
	var number: Label = Widgets.figure(tip, 58)
	_numbers[property] = number
	_formats[property] = format
	var line: HBoxContainer = Widgets.line(title, tip, slider)
	(line.get_child(0) as Control).size_flags_stretch_ratio = 1.1
	line.add_child(number)
	body.add_child(line)


func _show_number(property: StringName, value: float) -> void:
	var format: String = _formats[property]
	if "cm" in format or "%%" in format:
		value *= 100.0
	_numbers[property].text = format % (roundi(value) if "%d" in format else value)


func _show_picture(rule: LeafRule) -> void:
	if rule == _pictured or not Engine.is_editor_hint():
		return
	_pictured = rule
	EditorInterface.get_resource_previewer().queue_edited_resource_preview(
		rule, self, &"_on_previewed", null
	)


func _on_previewed(_path: String, preview: Texture2D, _small: Texture2D, _data: Variant) -> void:
	_picture.texture = preview


func _on_slider_changed(value: float, property: StringName) -> void:
	_show_number(property, value)
	_change(property, tr("Change Leaves: %s") % property.capitalize(), value, true)


func _on_choice(_index: int, list: OptionButton, property: StringName) -> void:
	var step: String = tr("Leaf Form") if property == &"form" else tr("Leaf Arrangement")
	_change(property, step, list.get_selected_metadata(), false)


func _on_preset_selected(_index: int) -> void:
	var name: String = preset.get_selected_metadata()
	_pictured = null
	if session.tree.leaf_rule == null:
		session.set_value(tr("Leaf Preset"), session.tree, &"leaf_preset", name)
		return
	session.set_value(tr("Leaf Preset"), session.tree, &"leaf_rule", LeafRule.from_preset(name))


func _on_enabled_toggled(on: bool) -> void:
	if session.tree.leaf_rule == null:
		session.set_value(tr("Bear Leaves"), session.tree, &"leaves_enabled", on)
	else:
		_change(&"enabled", tr("Bear Leaves"), on, false)


func _on_edit_all_pressed() -> void:
	var rule: LeafRule = _own_rule()
	if Engine.is_editor_hint():
		# The inspector alone: the tree stays selected.
		EditorInterface.inspect_object(rule, "", true)


static func _is_file(rule: LeafRule) -> bool:
	return rule.resource_path.begins_with("res://") and not rule.resource_path.contains("::")
