@tool
extends "section.gd"
## Bark that grows around the tree as one surface, with burls, hollows and obstacles: a recipe that
## is edited here, or painted in the view.

const BarkFeatures := preload("../bark/bark_features.gd")
const BarkWork := preload("../bark/bark_work.gd")
const BarkWords := preload("../bark/bark_words.gd")
const Obstacles := preload("bark_obstacles.gd")
const Timeline := preload("bark_timeline.gd")
const Recipe := preload("growth_recipe.gd")
const FromScan := preload("bark_from_scan.gd")
const Surface := preload("bark_surface.gd")

# Of the presets in the menu, after the features.
const _PRESETS: int = 100
# Metres along the trunk where a burl comes to be, on trees that are high enough.
const _BREAST_HEIGHT: float = 1.3
# Of a burl's radius, over that of the wood.
const _BURL_WIDTH: float = 2.0
const _MINIMUM_BURL: float = 0.05

var list: ItemList = ItemList.new()
var add: Button
var remove: Button
var surface: Surface
var grow: Button
var back: Button
var from_scan: FromScan
var obstacles: Obstacles
var timeline: Timeline
## The fields of the burl that is selected, by their parameters.
var fields: Dictionary[String, SpinBox] = {}

var more: MenuButton
## Those of its fields that are no numbers.
var choices: Dictionary[String, Control] = {}

var _notice: Label
var _form: VBoxContainer = VBoxContainer.new()
var _commands: Dictionary[String, Dictionary] = {}
var _work: BarkWork
var _words: BarkWords
# The recipe that is shown.
var _recipe: Recipe = Recipe.new()
# The fields that are shown: the command, and what they depend on.
var _of: String = ""
# The tree that was looked at last, and whether its bark was stale then.
var _watched: TreeReconstruction
var _was_stale: bool = false


func get_id() -> StringName:
	return &"bark"


func close() -> void:
	session.tree_changed.disconnect(_on_tree_changed)
	from_scan.close()
	timeline.close()
	_work.changed.disconnect(_on_work_changed)


func _build() -> void:
	title = "Bark Growth"
	tooltip_text = "Bark that grows around the tree as one surface, with burls and hollows."
	folded = true
	_work = BarkWork.of(session) as BarkWork
	_words = BarkWords.new(session.get_translation_domain())
	for command: Dictionary in TreeReconstructor.get_growth_commands():
		_commands[command.name] = command
	_notice = Widgets.sentence()
	_notice.auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
	body.add_child(_notice)
	_build_surface()
	_build_list()
	session.tree_changed.connect(_on_tree_changed)
	_work.changed.connect(_on_work_changed)


# What is about the whole surface; first, so that it is seen however many fields a feature has.
func _build_surface() -> void:
	grow = Widgets.button(
		"Grow",
		"Grows bark by this recipe around all wood that is thick enough. You can go on meanwhile.",
		&"Play"
	)
	grow.pressed.connect(start)
	back = Widgets.button(
		"Back to Tubes", "Takes the grown bark and its recipe off the tree.", &"Clear"
	)
	back.pressed.connect(_on_back_pressed)
	body.add_child(buttons([grow, back]))
	timeline = Timeline.new(session, _work)
	body.add_child(timeline)
	surface = Surface.new(
		func(command: String, name: String) -> SpinBox:
			return _make_number(_parameter(command, name)),
		_work.get_default
	)
	surface.changed.connect(_on_surface_changed)
	body.add_child(surface)


# The features, and the fields of the one that is selected.
func _build_list() -> void:
	list.tooltip_text = (
		"The burls that are to grow, hollows, and what stands in their way. Select one to"
		+ " change it."
	)
	list.custom_minimum_size.y = Widgets.px(84)
	list.auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
	list.item_selected.connect(_on_item_selected)
	body.add_child(list)
	add = Widgets.button(
		"Add Burl", "A burl on the branch of the selected node, or else on the trunk.", &"Add"
	)
	add.pressed.connect(add_burl)
	remove = Widgets.button("", "Takes what is selected out of the recipe.", &"Remove")
	remove.pressed.connect(_on_remove_pressed)
	more = MenuButton.new()
	more.text = "Add Other"
	more.tooltip_text = (
		"A ridge, a hollow or an obstacle, likewise; or one of the presets instead of this"
		+ " recipe."
	)
	more.flat = false
	_fill_menu(more.get_popup())
	from_scan = FromScan.new(session, func() -> String: return _work.get_recipe().get_text())
	from_scan.proposed.connect(_on_proposed)
	body.add_child(buttons([add, more, remove]))
	obstacles = Obstacles.new(session, list)
	body.add_child(buttons([from_scan.button, obstacles.button]))
	body.add_child(_form)
	body.add_child(surface.switches)


## Adds a burl to the recipe: on the branch of the selected node, or else on the trunk.
func add_burl() -> void:
	if session.tree == null or session.tree.is_empty():
		return
	var line: Recipe.Line = Recipe.Line.new("burl")
	var id: int = _place(line)
	var radius: float = maxf(_BURL_WIDTH * session.tree.get_node_radius(id), _MINIMUM_BURL)
	line.values["around"] = "0"
	line.values["radius"] = Recipe.written(radius)
	line.values["growth"] = _parameter("burl", "growth").default
	_add(line)


## Likewise another feature: one of [code]BarkFeatures.KINDS[/code].
func add_feature(kind: StringName) -> void:
	if session.tree == null or session.tree.is_empty():
		return
	var placed: Recipe.Line = Recipe.Line.new("burl")
	var radius: float = session.tree.get_node_radius(_place(placed))
	var line: Recipe.Line = BarkFeatures.make(kind, radius)
	line.values.merge(placed.values, true)
	_add(line)


## Writes one of [method TreeReconstructor.get_growth_presets], made for this trunk, instead of the
## features and the grain. Edges that the recipe had stay.
func take_preset(name: String) -> void:
	if session.tree == null or session.tree.is_empty():
		return
	_recipe = _work.get_recipe()
	var kept: Recipe.Line = _recipe.find("edges")
	_recipe.lines = Recipe.new(TreeReconstructor.scale_growth_preset(name, session.tree)).lines
	if kept != null:
		_recipe.lines.erase(_recipe.find("edges"))
		_recipe.lines.push_front(kept)
	_work.selected = 0
	_note_draft(tr("Bark Preset"))
	_show_recipe()


## Grows the bark, on a thread.
func start() -> void:
	_work.grow()
	invalidate()
	update()


func _refresh() -> void:
	var of: TreeReconstruction = session.tree
	timeline.refresh()
	if of == null:
		return
	if _recipe != _work.get_recipe():
		_recipe = _work.get_recipe()
		_show_recipe()
	_notice.text = _state_of(of)
	grow.text = "Grow Again" if of.is_bark_stale() else "Grow"
	grow.disabled = _work.is_growing() or of.is_empty()
	add.disabled = of.is_empty()
	more.disabled = of.is_empty()
	obstacles.button.disabled = of.is_empty()
	remove.disabled = _selected() == null
	from_scan.refresh()
	back.disabled = (
		_work.is_growing() or (of.grown_bark.is_empty() and of.growth_recipe.is_empty())
	)


func _state_of(of: TreeReconstruction) -> String:
	if of.is_bark_stale():
		return tr("The wood beneath the grown bark has changed, so the tree shows tubes.")
	var moved: String = _work.scene.get_notice(_work.get_recipe())
	if not moved.is_empty():
		return moved
	if not of.has_grown_bark():
		return tr("The tree shows tubes: no bark has grown on it yet.")
	if of.growth_pending or _work.get_recipe().get_text() != of.growth_recipe:
		return tr("The bark was grown by another recipe than this one.")
	return tr("The bark is as this recipe has it.")


func _show_recipe() -> void:
	list.clear()
	for line: Recipe.Line in _recipe.get_features():
		list.add_item(_words.title_of(line, _work.get_default))
		list.set_item_metadata(list.item_count - 1, line)
	_select()
	surface.show_recipe(_recipe)
	_show_fields()


# What is selected in the list is what is in the view.
func _select() -> void:
	if list.item_count == 0:
		return
	var chosen: PackedInt32Array = list.get_selected_items()
	var before: int = 0 if chosen.is_empty() else chosen[0]
	var now: int = before if _work.selected < 0 else _work.selected
	list.select(clampi(now, 0, list.item_count - 1))


func _show_fields() -> void:
	var line: Recipe.Line = _selected()
	remove.disabled = line == null
	var of: String = "" if line == null else "%s %s" % [line.command, BarkFeatures.kind_of(line)]
	if of != _of:
		_of = of
		fields.clear()
		choices.clear()
		for child: Node in _form.get_children():
			_form.remove_child(child)
			child.queue_free()
		if line != null:
			for name: String in BarkWords.get_shown(line):
				_add_field(line.command, _parameter(line.command, name))
	for name: String in fields:
		var value: String = line.values.get(name, _work.get_default(line.command, name))
		fields[name].set_value_no_signal(value.to_float())
	for name: String in choices:
		var value: String = line.values.get(name, _work.get_default(line.command, name))
		if choices[name] is CheckBox:
			(choices[name] as CheckBox).set_pressed_no_signal(value in ["yes", "true", "1"])
		else:
			Widgets.choose(choices[name] as OptionButton, value)


func _add_field(command: String, parameter: Dictionary) -> void:
	if parameter.is_empty():
		return
	var name: String = parameter.name
	var words: PackedStringArray = _words.words_of(command, parameter)
	var control: Control
	if parameter.type == "switch":
		var box: CheckBox = CheckBox.new()
		box.toggled.connect(func(on: bool) -> void: _on_written("yes" if on else "no", name))
		control = box
		choices[name] = box
	elif parameter.type == "word":
		var shapes: Array = _words.get_shapes()
		var options: OptionButton = Widgets.choice(
			shapes[0] as PackedStringArray, shapes[1] as Array
		)
		options.auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
		options.item_selected.connect(
			func(_index: int) -> void: _on_written(options.get_selected_metadata(), name)
		)
		control = options
		choices[name] = options
	else:
		var field: SpinBox = _make_number(parameter)
		field.value_changed.connect(_on_field_changed.bind(name))
		control = field
		fields[name] = field
	_form.add_child(Widgets.line(words[0], words[1], control))


func _parameter(command: String, name: String) -> Dictionary:
	for parameter: Dictionary in _commands[command].parameters:
		if parameter.name == name:
			return parameter
	return {}


# Puts a line where a feature begins: on the branch of the selected node, or on the trunk at breast
# height. Returns the node.
func _place(line: Recipe.Line) -> int:
	var id: int = session.get_active()
	var along: float = 0.0
	if id == session.NO_NODE or id == session.tree.get_root():
		id = session.tree.get_root()
		along = minf(_BREAST_HEIGHT, 0.5 * session.tree.get_aabb().size.y)
	else:
		line.values["node"] = str(id)
	line.values["along"] = Recipe.written(along)
	return id


func _add(line: Recipe.Line) -> void:
	_recipe = _work.get_recipe()
	_recipe.lines.append(line)
	_work.selected = _recipe.get_features().size() - 1
	_note_draft(tr("Place on the Bark"))
	_show_recipe()


func _fill_menu(menu: PopupMenu) -> void:
	var titles: PackedStringArray = _words.get_titles()
	menu.auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
	for i: int in range(1, titles.size()):
		menu.add_item(titles[i], i)
	menu.add_separator(tr("Presets"))
	var presets: Array[Dictionary] = TreeReconstructor.get_growth_presets()
	for i: int in presets.size():
		menu.add_item(_words.name_of_preset(presets[i].name), _PRESETS + i)
		menu.set_item_tooltip(menu.item_count - 1, _words.tip_of_preset(presets[i].name))
	menu.id_pressed.connect(_on_more_chosen)


func _make_number(parameter: Dictionary) -> SpinBox:
	var arrow: float = 0.05
	var step: float = 0.01
	var suffix: String = ""
	if parameter.type == "whole":
		arrow = 1.0
		step = 1.0
	elif parameter.type == "length":
		arrow = 0.05 if parameter.slider_maximum > 1.0 else 0.005
		step = 0.001
		suffix = "m"
	elif parameter.name == "around":
		arrow = 5.0
		step = 1.0
		suffix = "°"
	var made: SpinBox = Widgets.number(
		parameter.slider_minimum, parameter.slider_maximum, step, suffix
	)
	made.custom_arrow_step = arrow
	made.allow_greater = parameter.maximum > parameter.slider_maximum
	made.allow_lesser = parameter.minimum < parameter.slider_minimum
	return made


func _selected() -> Recipe.Line:
	var chosen: PackedInt32Array = list.get_selected_items()
	return null if chosen.is_empty() else list.get_item_metadata(chosen[0]) as Recipe.Line


# What was written is a draft until it grows; while bark is painted it is a step, and grows.
func _note_draft(title: String, merged: Array = []) -> void:
	if session.tree == null:
		return
	if _work.is_painting():
		_work.commit(title, merged)
		_recipe = _work.get_recipe()
	_notice.text = _state_of(session.tree)


func _on_field_changed(value: float, name: String) -> void:
	_on_written(Recipe.written(value), name)


func _on_written(value: String, name: String) -> void:
	var line: Recipe.Line = _selected()
	if line == null:
		return
	var index: int = list.get_selected_items()[0]
	line.values[name] = value
	list.set_item_text(index, _words.title_of(line, _work.get_default))
	_work.selected = index
	_note_draft(tr("Change on the Bark"), [session.tree.get_instance_id(), index, name])
	if choices.has(name) or _work.is_painting():
		_show_recipe.call_deferred()


func _on_surface_changed(about: Array) -> void:
	var merged: Array = [] if about.is_empty() else [session.tree.get_instance_id()] + about
	_note_draft(tr("Change on the Bark"), merged)


func _on_more_chosen(id: int) -> void:
	if id >= _PRESETS:
		take_preset(TreeReconstructor.get_growth_presets()[id - _PRESETS].name)
	else:
		add_feature(BarkFeatures.KINDS[id])


func _on_item_selected(index: int) -> void:
	_work.selected = index
	_show_fields()


func _on_remove_pressed() -> void:
	var line: Recipe.Line = _selected()
	if line == null:
		return
	_recipe.lines.erase(line)
	_note_draft(tr("Remove from the Bark"))
	_show_recipe()


func _on_proposed(lines: String) -> void:
	_recipe = _work.get_recipe()
	var found: Recipe = Recipe.new(lines)
	# Outlines and a twist of an earlier time would count beside the new ones.
	for command: String in ["section", "grain"]:
		if found.find(command) != null:
			_recipe.lines = _recipe.lines.filter(
				func(line: Recipe.Line) -> bool: return line.command != command
			)
	_recipe.lines.append_array(found.lines)
	_note_draft(tr("From the Scan"))
	_show_recipe()


func _on_back_pressed() -> void:
	session.set_bark(tr("Back to Tubes"), null)


func _on_work_changed() -> void:
	if is_visible_in_tree() and _recipe == _work.get_recipe():
		if list.item_count != _recipe.get_features().size():
			_show_recipe()
		_select()
		_show_fields()
	invalidate()
	update()


# An edit of the wood beneath is told at once, also while the section is folded.
func _on_tree_changed() -> void:
	var stale: bool = session.tree != null and session.tree.is_bark_stale()
	if stale and not _was_stale and session.tree == _watched:
		(
			session
			. say(
				tr(
					(
						"The wood beneath the grown bark has changed, so the tree shows tubes. Grow the bark"
						+ " again in the Tree dock."
					)
				),
				session.Kind.WARNING
			)
		)
	_watched = session.tree
	_was_stale = stale
