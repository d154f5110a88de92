@tool
extends "section.gd"
## Bark that grows around the tree as one surface, with burls: a recipe that is edited here, and the
## growth itself on a thread.

const Recipe := preload("growth_recipe.gd")
const FromScan := preload("bark_from_scan.gd")

# What is shown of a command, in this order; of others all their numbers.
const _SHOWN: Dictionary[String, PackedStringArray] = {
	"burl": ["along", "around", "radius", "growth"],
}
const _NUMBERS: PackedStringArray = ["number", "length", "whole"]
# Metres along the trunk where a burl comes to be, on trees that are high enough.
const _BREAST_HEIGHT: float = 1.3
# Of a burl's radius, over that of the wood.
const _BURL_WIDTH: float = 2.0
const _MINIMUM_BURL: float = 0.05

var list: ItemList = ItemList.new()
var add: Button
var remove: Button
var edge: SpinBox
var grow: Button
var back: Button
var from_scan: FromScan
## The fields of the burl that is selected, by their parameters.
var fields: Dictionary[String, SpinBox] = {}

var _notice: Label
var _form: VBoxContainer = VBoxContainer.new()
var _commands: Dictionary[String, Dictionary] = {}
var _job: Session.Jobs.Job
# Recipes that were edited and not grown yet, by the tree's instance id: what is edited, and the
# tree's own recipe that it began with.
var _drafts: Dictionary[int, Recipe] = {}
var _begun: Dictionary[int, String] = {}
var _recipe: Recipe = Recipe.new()
# The command whose fields are shown.
var _of: String = ""
# The tree that was looked at last, and whether its bark was stale then.
var _watched: TreeReconstruction
var _was_stale: bool = false


func get_id() -> StringName:
	return &"bark"


func close() -> void:
	session.tree_changed.disconnect(_on_tree_changed)
	session.jobs.changed.disconnect(_on_jobs_changed)
	from_scan.close()
	if _job != null:
		session.jobs.cancel(_job)


func _build() -> void:
	title = "Bark Growth"
	tooltip_text = "Bark that grows around the tree as one surface, with burls."
	folded = true
	for command: Dictionary in TreeReconstructor.get_growth_commands():
		_commands[command.name] = command
	_notice = Widgets.sentence()
	_notice.auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
	body.add_child(_notice)
	list.tooltip_text = "The burls that are to grow. Select one to change it."
	list.custom_minimum_size.y = Widgets.px(84)
	list.auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
	list.item_selected.connect(_on_item_selected)
	body.add_child(list)
	add = Widgets.button(
		"Add Burl", "A burl on the branch of the selected node, or else on the trunk.", &"Add"
	)
	add.pressed.connect(add_burl)
	remove = Widgets.button("Remove", "Takes the selected burl out of the recipe.", &"Remove")
	remove.pressed.connect(_on_remove_pressed)
	body.add_child(buttons([add, remove]))
	from_scan = FromScan.new(session, func() -> String: return _recipe.get_text())
	from_scan.proposed.connect(_on_proposed)
	body.add_child(buttons([from_scan.button]))
	body.add_child(_form)
	edge = _make_number(_parameter("edges", "longest"))
	edge.value_changed.connect(_on_edge_changed)
	(
		body
		. add_child(
			(
				Widgets
				. line(
					"Edge Length",
					(
						"How fine the surface is: its edges are split above this length. Half of it takes about"
						+ " eight times as long."
					),
					edge
				)
			)
		)
	)
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
	session.tree_changed.connect(_on_tree_changed)
	session.jobs.changed.connect(_on_jobs_changed)


## Adds a burl to the recipe: on the branch of the selected node, or else on the trunk.
func add_burl() -> void:
	var of: TreeReconstruction = session.tree
	if of == null or of.is_empty():
		return
	var line: Recipe.Line = Recipe.Line.new("burl")
	var id: int = session.get_active()
	var along: float = 0.0
	if id == session.NO_NODE or id == of.get_root():
		id = of.get_root()
		along = minf(_BREAST_HEIGHT, 0.5 * of.get_aabb().size.y)
	else:
		line.values["node"] = str(id)
	var radius: float = maxf(_BURL_WIDTH * of.get_node_radius(id), _MINIMUM_BURL)
	line.values["along"] = _written(along)
	line.values["around"] = "0"
	line.values["radius"] = _written(radius)
	line.values["growth"] = _parameter("burl", "growth").default
	_recipe.lines.append(line)
	_note_draft()
	_show_recipe()
	list.select(list.item_count - 1)
	_show_fields()


## Grows the bark, on a thread.
func start() -> void:
	if session.tree == null or session.tree.is_empty() or _job != null:
		return
	var worker: TreeReconstructor = TreeReconstructor.new()
	# The tree may be edited meanwhile: trees are replaced, never changed, so this takes no time.
	var of: TreeReconstruction = TreeReconstruction.new()
	of.take_tree_of(session.tree)
	_job = session.jobs.start(
		tr("Bark of %s") % session.node.name,
		_grow.bind(worker, of, _recipe.get_text()),
		_on_grown.bind(worker, session.node.get_instance_id()),
		worker
	)
	invalidate()
	update()


static func _grow(
	_running: Session.Jobs.Job, worker: TreeReconstructor, of: TreeReconstruction, recipe: String
) -> TreeReconstruction:
	return worker.grow_bark(of, recipe)


func _on_grown(
	made: TreeReconstruction, _ended: Session.Jobs.Job, worker: TreeReconstructor, node: int
) -> void:
	_job = null
	invalidate()
	if made == null:
		session.say(worker.get_error_message(), session.Kind.ERROR)
		return
	# The node may be gone, so it is known by its instance id.
	if not is_instance_valid(session.node) or session.node.get_instance_id() != node:
		session.say(
			tr("Another tree is selected now, so the bark that grew is left out."),
			session.Kind.WARNING
		)
		return
	session.set_bark(tr("Grow Bark"), made)
	var report: Dictionary = worker.get_report()
	for warning: String in report.warnings:
		session.say(warning, session.Kind.WARNING)
	if session.tree.is_bark_stale():
		session.say(
			tr("The tree was edited while its bark grew, so it shows tubes. Grow the bark again."),
			session.Kind.WARNING
		)


func _refresh() -> void:
	var of: TreeReconstruction = session.tree
	if of == null:
		return
	var id: int = of.get_instance_id()
	# What the tree has now was edited or undone elsewhere: it counts, not the draft.
	if not _drafts.has(id) or _begun[id] != of.growth_recipe:
		_drafts[id] = Recipe.new(of.growth_recipe)
		_begun[id] = of.growth_recipe
	if _recipe != _drafts[id]:
		_recipe = _drafts[id]
		_show_recipe()
	_notice.text = _state_of(of)
	grow.text = "Grow Again" if of.is_bark_stale() else "Grow"
	grow.disabled = _job != null or of.is_empty()
	add.disabled = of.is_empty()
	remove.disabled = _selected() == null
	from_scan.refresh()
	back.disabled = _job != null or (of.grown_bark.is_empty() and of.growth_recipe.is_empty())


func _state_of(of: TreeReconstruction) -> String:
	if of.is_bark_stale():
		return tr("The wood beneath the grown bark has changed, so the tree shows tubes.")
	if not of.has_grown_bark():
		return tr("The tree shows tubes: no bark has grown on it yet.")
	if _recipe.get_text() != of.growth_recipe:
		return tr("The bark was grown by another recipe than this one.")
	return tr("The bark is as this recipe has it.")


func _show_recipe() -> void:
	var chosen: int = -1 if list.get_selected_items().is_empty() else list.get_selected_items()[0]
	list.clear()
	for line: Recipe.Line in _recipe.get_features():
		list.add_item(_title_of(line))
		list.set_item_metadata(list.item_count - 1, line)
	if list.item_count > 0:
		list.select(clampi(chosen, 0, list.item_count - 1))
	var edges: Recipe.Line = _recipe.find("edges")
	var longest: Dictionary = _parameter("edges", "longest")
	var given: String = longest.default
	if edges != null:
		given = edges.values.get("longest", given)
	edge.set_value_no_signal(given.to_float())
	_show_fields()


func _show_fields() -> void:
	var line: Recipe.Line = _selected()
	remove.disabled = line == null
	var command: String = "" if line == null else line.command
	if command != _of:
		_of = command
		fields.clear()
		for child: Node in _form.get_children():
			_form.remove_child(child)
			child.queue_free()
		for parameter: Dictionary in _parameters_of(command):
			var field: SpinBox = _make_number(parameter)
			field.value_changed.connect(_on_field_changed.bind(parameter.name))
			fields[parameter.name] = field
			var words: PackedStringArray = _words_of(parameter)
			_form.add_child(Widgets.line(words[0], words[1], field))
	for name: String in fields:
		var parameter: Dictionary = _parameter(command, name)
		var standard: String = parameter.default
		var value: String = line.values.get(name, standard)
		fields[name].set_value_no_signal(value.to_float())


func _parameters_of(command: String) -> Array[Dictionary]:
	var shown: Array[Dictionary] = []
	if not _commands.has(command):
		return shown
	for parameter: Dictionary in _commands[command].parameters:
		var wanted: bool = (
			parameter.type in _NUMBERS and not (parameter.default as String).is_empty()
		)
		if _SHOWN.has(command):
			wanted = parameter.name in _SHOWN[command]
		if wanted:
			shown.append(parameter)
	return shown


func _parameter(command: String, name: String) -> Dictionary:
	for parameter: Dictionary in _commands[command].parameters:
		if parameter.name == name:
			return parameter
	return {}


# What a parameter is called, and its tooltip.
func _words_of(parameter: Dictionary) -> PackedStringArray:
	match parameter.name:
		"along":
			return [tr("Along"), tr("Along its branch: of the trunk from the ground.")]
		"around":
			return [
				tr("Around"),
				tr("About its branch, counter-clockwise as seen from above; 0° is towards +X.")
			]
		"radius":
			return [tr("Radius"), tr("How far from its middle the burl reaches.")]
		"growth":
			return [
				tr("Growth"),
				tr("How much faster than usual the bark grows there; 1 is twice as fast.")
			]
	var title: String = parameter.name
	return [title.capitalize(), parameter.description]


func _title_of(line: Recipe.Line) -> String:
	if line.command != "burl":
		return line.get_text()
	var along: float = line.values.get("along", _parameter("burl", "along").default).to_float()
	var around: float = line.values.get("around", "0").to_float()
	if line.values.has("node"):
		# As it was found, it has its place with it.
		var node: String = line.values["node"].get_slice("@", 0)
		return tr("Burl by node %s, %.2f m along, %d°") % [node, along, roundi(around)]
	return tr("Burl on the trunk, %.2f m up, %d°") % [along, roundi(around)]


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


static func _written(value: float) -> String:
	return String.num(value, 3)


func _note_draft() -> void:
	if session.tree == null:
		return
	_notice.text = _state_of(session.tree)


func _on_field_changed(value: float, name: String) -> void:
	var line: Recipe.Line = _selected()
	if line == null:
		return
	line.values[name] = _written(value)
	list.set_item_text(list.get_selected_items()[0], _title_of(line))
	_note_draft()


func _on_edge_changed(value: float) -> void:
	var line: Recipe.Line = _recipe.find("edges", true)
	line.values["longest"] = _written(value)
	# The shortest goes with it.
	line.values.erase("shortest")
	_note_draft()


func _on_item_selected(_index: int) -> void:
	_show_fields()


func _on_remove_pressed() -> void:
	var line: Recipe.Line = _selected()
	if line == null:
		return
	_recipe.lines.erase(line)
	_note_draft()
	_show_recipe()


func _on_proposed(lines: String) -> void:
	_recipe.lines.append_array(Recipe.new(lines).lines)
	_note_draft()
	_show_recipe()


func _on_back_pressed() -> void:
	session.set_bark(tr("Back to Tubes"), null)


func _on_jobs_changed() -> void:
	# One that was cancelled ends without a word.
	if _job != null and _job.cancelled and not _job in session.jobs.get_running():
		_job = null
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
