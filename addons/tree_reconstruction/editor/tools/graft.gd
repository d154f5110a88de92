@tool
extends "wood_tool.gd"
## Puts a branch onto nodes: the picked one, one of the library, or an L-string, each time varied.

const BranchChoice := preload("branch_choice.gd")

const _VARY: PackedStringArray = ["branches", "segments"]
const _ROLL_STEP: float = 15.0

# Made with the first strip: it reads pictures.
var _library: TwigLibrary
var _seed_box: Range
var _roll_box: Range
var _text: LineEdit
var _choice: Variant


func get_id() -> StringName:
	return &"graft"


func get_title() -> String:
	return tr("Graft")


func get_tooltip() -> String:
	return tr(
		(
			"Hover over a node to see the branch that a click would graft onto it. The wheel shows"
			+ " another one, with Ctrl it turns the branch. Enter grafts one onto each selected node."
		)
	)


func get_icon() -> String:
	return "res://addons/tree_reconstruction/icons/tools/graft.svg"


func get_key() -> Key:
	return KEY_J


func get_defaults() -> Dictionary[StringName, Variant]:
	return {
		&"seed": 1,
		&"angle": 12.0,
		&"stretch": 0.15,
		&"vary": 0,
		&"roll": 0.0,
		&"mirror": false,
		&"clear": false
	}


func make_settings() -> Control:
	_restore()
	var strip: Strip = Strip.new()
	_add_source(strip)
	_seed_box = strip.add_number(
		tr("Seed"),
		tr("Each seed varies the branch in another way. The wheel changes it."),
		1,
		999,
		1,
		values[&"seed"],
		_on_seed_changed
	)
	strip.add_number(
		tr("Bend (°)"),
		tr("How far branches turn and bend by chance, at most."),
		0.0,
		60.0,
		1.0,
		values[&"angle"],
		set_setting.bind(&"angle")
	)
	strip.add_number(
		tr("Stretch"),
		tr("By which share branches become longer or shorter by chance, at most."),
		0.0,
		0.6,
		0.01,
		values[&"stretch"],
		set_setting.bind(&"stretch")
	)
	strip.add_choice(
		tr("Vary"),
		tr("Whole branches bend and stretch, or every segment varies by itself."),
		PackedStringArray([tr("Branches"), tr("Segments")]),
		values[&"vary"],
		set_setting.bind(&"vary")
	)
	_roll_box = strip.add_number(
		tr("Roll (°)"),
		tr("How far the branch is turned about the way it goes. The wheel does it with Ctrl."),
		-180.0,
		180.0,
		1.0,
		values[&"roll"],
		set_setting.bind(&"roll")
	)
	strip.add_switch(
		tr("Mirror"),
		tr("Changes the left and right of the branch."),
		values[&"mirror"],
		set_setting.bind(&"mirror")
	)
	strip.add_switch(
		tr("Keep clear"),
		tr("Tries further seeds until the branch runs into no other one."),
		values[&"clear"],
		set_setting.bind(&"clear")
	)
	return strip


func start() -> void:
	if session.scion.is_empty():
		session.scion = "twig=%s" % _fitting_twig()
	super()


func get_command_at(id: int) -> String:
	return "graft node=%d %s" % [id, _words_of_graft("twig")]


func get_commands_of_selection() -> PackedStringArray:
	var ids: PackedInt32Array = get_selected()
	if ids.size() == 1:
		return [get_command_at(ids[0])]
	return ["graft_many nodes=%s %s" % [words_of_nodes(ids), _words_of_graft("twigs")]]


func _wheel(steps: int, button: InputEventMouseButton) -> bool:
	# Over the sky the wheel is the camera's.
	if session.hovered == NO_NODE:
		return false
	if button.is_command_or_control_pressed():
		values[&"roll"] = wrapf(values[&"roll"] + steps * _ROLL_STEP, -180.0, 180.0)
		_show_value(_roll_box, values[&"roll"])
	else:
		_set_seed(values[&"seed"] + steps)
	_rests = false
	_queue()
	return true


func _finish(edit: TreeEdit) -> void:
	if edit != null:
		# No two alike.
		_set_seed(values[&"seed"] + 1)
	super(edit)


func _look_again() -> void:
	super()
	if is_instance_valid(_choice):
		# The dock chooses twigs, too.
		(_choice as BranchChoice).update()


func _words_of_graft(twig_key: String) -> String:
	var source: String = session.scion
	if source.begins_with("twig="):
		source = "%s=%s" % [twig_key, source.trim_prefix("twig=")]
	else:
		source = 'string="%s"' % _in_one_line(source).replace('"', '""')
	return (
		"%s seed=%d angle=%s stretch=%s vary=%s roll=%s mirror=%s tries=%d"
		% [
			source,
			values[&"seed"],
			String.num(values[&"angle"], 3),
			String.num(values[&"stretch"], 4),
			_VARY[values[&"vary"]],
			String.num(values[&"roll"], 3),
			"yes" if values[&"mirror"] else "no",
			12 if values[&"clear"] else 1
		]
	)


# A command is one line, and comments of an L-string end with theirs.
static func _in_one_line(lstring: String) -> String:
	# But a heading says how the rest is read, and is needed whole.
	if lstring.begins_with("# L-string;"):
		return lstring
	var lines: PackedStringArray = []
	for line: String in lstring.split("\n"):
		lines.append(line.get_slice("#", 0).strip_edges())
	return " ".join(lines)


# The twig that is called like the tree's leaves.
func _fitting_twig() -> String:
	var preset: String = session.tree.leaf_preset if session.tree != null else ""
	for entry: Dictionary in TreeReconstruction.get_twig_library():
		if entry["name"] == preset:
			return preset
	return "generic"


func _add_source(strip: Strip) -> void:
	if _library == null:
		_library = TwigLibrary.presets()
	var choice: BranchChoice = BranchChoice.new(session, _library, get_scale())
	strip.add_labelled(tr("Branch"), tr("What is grafted."), choice)
	choice.item_selected.connect(_on_source_chosen.bind(choice))
	_choice = choice
	_text = LineEdit.new()
	_text.placeholder_text = "!(0.01) F(0.3) [+(40) F(0.2)] F(0.2)"
	_text.tooltip_text = tr("The branch as an L-string. Enter takes it.")
	_text.custom_minimum_size.x = 220.0 * get_scale()
	_text.visible = false
	_text.text_submitted.connect(_on_text_submitted)
	strip.add_child(_text)


func _on_source_chosen(_item: int, choice: BranchChoice) -> void:
	_text.visible = choice.is_written()
	if not choice.get_scion().is_empty():
		session.scion = choice.get_scion()
	_rests = false
	_queue()


func _on_text_submitted(text: String) -> void:
	if not text.strip_edges().is_empty():
		session.scion = text
		_queue()


func _on_seed_changed(value: float) -> void:
	set_setting(int(value), &"seed")


func _set_seed(value: int) -> void:
	values[&"seed"] = wrapi(value, 1, 1000)
	_show_value(_seed_box, values[&"seed"])


func _show_value(box: Variant, value: float) -> void:
	if is_instance_valid(box):
		# Its other half follows, the tool knows already.
		(box as Range).value = value
