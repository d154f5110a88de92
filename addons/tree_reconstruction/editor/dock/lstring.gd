@tool
extends "section.gd"
## The tree, or the branch that begins at the selected node, as a string that can be edited.

## A longer string is not shown until the user asks: it would be written and laid out anew after
## every edit, which takes longer than a frame.
const MOST: int = 10_000
# A node takes about so many characters.
const _EACH: int = 36
const _DIALECTS: PackedStringArray = ["turtle", "paper"]
# How a text begins that says by itself how it is read.
const _HEADING: String = "# L-string;"

var text: CodeEdit = CodeEdit.new()
var apply: Button
var revert: Button
var anyway: Button
var dialect: OptionButton
## Every segment varies by so many degrees and by this share of its length, at random by the seed.
var vary_angle: SpinBox
var vary_length: SpinBox
var vary_seed: SpinBox

var _what: Label
var _error: Label
var _tree: TreeReconstruction
var _node: int = -1
var _revision: int
var _edited: bool = false
# The user wants the long one.
var _forced: bool = false


func get_id() -> StringName:
	return &"lstring"


func close() -> void:
	session.string_picked.disconnect(_on_string_picked)


func _build() -> void:
	title = "L-string"
	tooltip_text = "The selected branch as text: a turtle that walks by it draws the branch."
	folded = true
	_what = Widgets.sentence()
	_what.auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
	body.add_child(_what)
	text.custom_minimum_size.y = Widgets.px(160)
	text.wrap_mode = TextEdit.LINE_WRAPPING_BOUNDARY
	text.auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
	text.tooltip_text = "F is wood, ! its radius, + - & ^ / \\ turn, [ and ] enclose a branch."
	text.text_changed.connect(_on_text_changed)
	text.add_theme_font_override(&"font", _code_font())
	text.delimiter_comments = ["#"]
	body.add_child(text)
	_error = Widgets.sentence()
	_error.auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
	_error.visible = false
	body.add_child(_error)
	dialect = Widgets.choice(PackedStringArray(["Turtle", "Paper"]), Array(_DIALECTS) as Array)
	dialect.tooltip_text = "Turtle: angles from the wood below. Paper: absolute angles, no radii."
	dialect.custom_minimum_size.x = Widgets.px(90)
	dialect.item_selected.connect(_on_dialect_selected)
	apply = Widgets.button(
		"Apply", "Puts the branch that this text draws in the selected one's place.", &"ImportCheck"
	)
	apply.pressed.connect(_on_apply_pressed)
	revert = Widgets.button("Revert", "Shows the branch as it is again.", &"Reload")
	revert.pressed.connect(_on_revert_pressed)
	anyway = Widgets.button("Show it anyway", "Shows the whole text. Typing in it may be slow.")
	anyway.pressed.connect(_on_anyway_pressed)
	vary_angle = Widgets.number(0.0, 90.0, 0.5, "°")
	vary_length = Widgets.number(0.0, 0.9, 0.01)
	vary_seed = Widgets.number(1, 999, 1)
	var fields: Array[SpinBox] = [vary_angle, vary_length, vary_seed]
	for field: SpinBox in fields:
		field.value_changed.connect(_on_vary_changed)
	body.add_child(
		Widgets.line(
			"Vary angles",
			"How far every segment turns by chance, at most, when applied.",
			vary_angle
		)
	)
	body.add_child(
		Widgets.line(
			"Vary lengths",
			"By which share every segment becomes longer or shorter by chance, when applied.",
			vary_length
		)
	)
	body.add_child(Widgets.line("Seed", "Each seed varies the branch in another way.", vary_seed))
	body.add_child(buttons([dialect, apply, revert, anyway]))
	session.string_picked.connect(_on_string_picked)


func _refresh() -> void:
	var tree: TreeReconstruction = session.tree
	if tree == null or tree.is_empty():
		_tree = null
		text.text = ""
		text.editable = false
		return
	var gone: bool = _node != tree.get_root() and not tree.has_node(_node)
	# What the user types stays until it is applied, unless its branch is no more.
	if _edited and tree == _tree and not gone:
		_show_edited()
		return
	var node: int = session.get_active()
	if node == session.NO_NODE:
		node = tree.get_root()
	if tree == _tree and node == _node and tree.get_bark_revision() == _revision and not _edited:
		return
	_forced = _forced and node == _node
	_show_branch(node)


func _show_branch(node: int) -> void:
	_tree = session.tree
	_node = node
	_revision = _tree.get_bark_revision()
	_edited = false
	var whole: bool = node == _tree.get_root()
	var count: int = (
		_tree.get_node_count() if whole else _tree.select_nodes("below:%d" % node).size()
	)
	var long: bool = count * _EACH > MOST and not _forced
	anyway.visible = long
	if long:
		_what.text = (
			tr("This branch is a text of about %s characters. Select a smaller one.")
			% Widgets.grouped(count * _EACH)
		)
		text.text = ""
	else:
		_what.text = tr("The whole tree:") if whole else tr("The branch at node %d:") % node
		var lines: String = broken_into_lines(LSystem.write_string(_tree, node, dialect.selected))
		# To lay it out anew takes longer than all else.
		if text.text != lines:
			text.text = lines
	text.editable = not long
	_show_edited()
	_show_error("", -1)


func _show_edited() -> void:
	apply.disabled = not _edited and not (_varies() and text.editable)
	revert.disabled = not _edited


## An L-string with each of its branches on lines of its own. Blanks mean nothing in it.
static func broken_into_lines(lstring: String) -> String:
	var parts: PackedStringArray = lstring.split("[")
	var lines: PackedStringArray = [parts[0]]
	var depth: int = 0
	for part: String in parts.slice(1):
		depth += 1
		var ends: PackedStringArray = part.split("]")
		lines.append("  ".repeat(depth) + "[" + ends[0] + ("]" if ends.size() > 1 else ""))
		for i: int in range(1, ends.size()):
			depth -= 1
			if i + 1 < ends.size() or not ends[i].is_empty():
				lines.append("  ".repeat(depth) + ends[i] + ("]" if i + 1 < ends.size() else ""))
	return "\n".join(lines)


## The text on one line, each character at its place, and without comments.
static func on_one_line(lines: String) -> String:
	var flat: PackedStringArray = []
	for line: String in lines.split("\n"):
		var code: String = line.get_slice("#", 0)
		flat.append(code.rpad(line.length()))
	return " ".join(flat).replace("\t", " ").replace("\r", " ").replace('"', " ")


func _on_text_changed() -> void:
	_edited = true
	_show_error("", -1)
	_show_edited()


func _varies() -> bool:
	return vary_angle.value > 0.0 or vary_length.value > 0.0


func _on_vary_changed(_value: float) -> void:
	_show_edited()


func _on_dialect_selected(_index: int) -> void:
	if _tree != null and _tree == session.tree and _tree.has_node(_node):
		_show_branch(_node)


func _on_apply_pressed() -> void:
	if session.tree == null or not session.tree.has_node(_node):
		return
	# A heading is needed whole, and says which dialect it is.
	var headed: bool = text.text.begins_with(_HEADING)
	var flat: String = text.text.replace('"', '""') if headed else on_one_line(text.text)
	var words: String = "root" if _node == session.tree.get_root() else str(_node)
	var command: String = 'lstring node=%s string="%s"' % [words, flat]
	if dialect.selected == LSystem.DIALECT_PAPER and not headed:
		command += " dialect=paper"
	if _varies():
		command += (
			" vary_angle=%s vary_length=%s seed=%d"
			% [String.num(vary_angle.value, 3), String.num(vary_length.value, 4), vary_seed.value]
		)
	var sentence: String = session.tree.check_edit(command)
	if not sentence.is_empty():
		_show_error(sentence, _column_in(sentence))
		return
	var edit: TreeEdit = session.run(tr("Edit L-string"), command)
	if edit == null:
		return
	_edited = false
	if _varies():
		# No two alike.
		vary_seed.value = wrapi(int(vary_seed.value) + 1, 1, 1000)
	var made: PackedInt32Array = edit.get_result_nodes()
	if not made.is_empty():
		session.select([made[0]])
	elif not session.tree.has_node(_node):
		session.clear_selection()
	_show_branch(session.get_active() if session.get_active() != -1 else session.tree.get_root())


func _on_revert_pressed() -> void:
	_edited = false
	_tree = null
	invalidate()
	update()


func _on_anyway_pressed() -> void:
	_forced = true
	_show_branch(_node)


func _on_string_picked(_lstring: String, id: int) -> void:
	if session.tree != null and session.tree.has_node(id):
		folded = false
		_show_branch(id)


# Where an error of a text on one line is.
static func _column_in(sentence: String) -> int:
	var place: RegEx = RegEx.create_from_string("line 1, column (\\d+)")
	var found: RegExMatch = place.search(sentence)
	return -1 if found == null else found.get_string(1).to_int() - 1


func _show_error(sentence: String, offset: int) -> void:
	_error.visible = not sentence.is_empty()
	_error.text = sentence
	if sentence.is_empty():
		return
	if has_theme_color(&"error_color", &"Editor"):
		_error.add_theme_color_override(&"font_color", get_theme_color(&"error_color", &"Editor"))
	if offset < 0:
		return
	# The user's text has lines.
	var before: PackedStringArray = text.text.left(offset).split("\n")
	var row: int = before.size() - 1
	var column: int = before[-1].length()
	_error.text = sentence.replace(
		"line 1, column %d" % (offset + 1), "line %d, column %d" % [row + 1, column + 1]
	)
	text.set_caret_line(row)
	text.set_caret_column(column)
	text.center_viewport_to_caret()


static func _code_font() -> Font:
	if Engine.is_editor_hint():
		return EditorInterface.get_editor_theme().get_font(&"source", &"EditorFonts")
	return ThemeDB.fallback_font
