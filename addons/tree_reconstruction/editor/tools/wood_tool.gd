@tool
extends "seeing_tool.gd"
## What the tools that change wood have in common: settings that a project keeps, commands that are
## shown before they are done, and what a click, Enter and Escape do.

const Strip := preload("strip.gd")

const _SECTION: String = "tree_reconstruction"

## What the settings strip sets.
var values: Dictionary[StringName, Variant] = {}

var _queued: bool = false
# What get_lowest_selected() found, and of what.
var _lowest: PackedInt32Array
var _lowest_of: Array = []
# Since the last edit, and where the mouse was then.
var _rests: bool = false
var _rested_at: Vector2
var _restored: bool = false


## The settings that it begins with.
func get_defaults() -> Dictionary[StringName, Variant]:
	return {}


## The edit command of a click on a node; empty if there is none.
func get_command_at(_id: int) -> String:
	return ""


## The edit commands, in a row, that Enter, or the tool's own key, does to the selected nodes.
func get_commands_of_selection() -> PackedStringArray:
	var commands: PackedStringArray = []
	for id: int in get_selected():
		commands.append(get_command_at(id))
	return commands


## What to show while the mouse is over no node; empty for nothing.
func get_idle_command() -> String:
	return ""


func start() -> void:
	_restore()
	_rests = false
	session.hover_changed.connect(_queue)
	session.selection_changed.connect(_queue)
	session.tree_changed.connect(_queue)
	_queue()


func stop() -> void:
	if session.hover_changed.is_connected(_queue):
		session.hover_changed.disconnect(_queue)
		session.selection_changed.disconnect(_queue)
		session.tree_changed.disconnect(_queue)
	cancel()
	_clear()
	_lowest_of = []
	_keep()


func input(camera: Camera3D, event: InputEvent) -> bool:
	if session.tree == null or session.picker == null:
		return false
	session.set_meta(_EYE, camera.get_instance_id())
	var button: InputEventMouseButton = event as InputEventMouseButton
	if button != null:
		_pointer = button.position
		return _on_button(button)
	var motion: InputEventMouseMotion = event as InputEventMouseMotion
	if motion != null:
		if _rests and motion.position.distance_to(_rested_at) >= DRAG_FROM * get_scale():
			_rests = false
			_queue()
		_pointer = motion.position
		return _move(motion)
	var key: InputEventKey = event as InputEventKey
	return key != null and key.pressed and _on_key(key)


## The left button went down. Returns whether it was taken.
func _press(_button: InputEventMouseButton) -> bool:
	var id: int = pick()
	if id == NO_NODE:
		return false
	_click(id)
	return true


## The left button went up.
func _release(_button: InputEventMouseButton) -> bool:
	return false


## The mouse moved.
func _move(_motion: InputEventMouseMotion) -> bool:
	return false


## The wheel turned by [param steps], upwards counting above zero.
func _wheel(_steps: int, _button: InputEventMouseButton) -> bool:
	return false


## Another key than Enter, Escape and the tool's own.
func _press_key(_key: InputEventKey) -> bool:
	return false


## A node was clicked.
func _click(id: int) -> void:
	var command: String = get_command_at(id)
	if not command.is_empty():
		_finish(_run(command))


## Enter, or the tool's button: does it to the selected nodes.
func accept() -> bool:
	if session.tree == null or get_selected().is_empty():
		return false
	_finish(run_all(get_commands_of_selection()))
	return true


## The tool's own key, while it is chosen already.
func _press_own_key() -> bool:
	return accept()


## Whether anything is half done. Escape ends that.
func is_busy() -> bool:
	return false


## Whether the mouse drags. The right button ends that.
func is_held() -> bool:
	return is_busy()


## Forgets what is half done.
func cancel() -> void:
	pass


## An edit was done, or refused ([code]null[/code]). What was done is looked at, without what would
## be done next, until the mouse moves.
func _finish(edit: TreeEdit) -> void:
	if edit == null:
		return
	_rests = true
	_rested_at = _pointer
	_clear()


## Does several commands as one step. A single refused one refuses all.
func run_all(commands: PackedStringArray) -> TreeEdit:
	if commands.size() == 1:
		return session.run(get_title(), commands[0])
	for command: String in commands:
		var sentence: String = session.tree.check_edit(command)
		if not sentence.is_empty():
			session.say(sentence, session.Kind.ERROR)
			return null
	var script: String = "\n".join(commands)
	return session.run_edit(
		get_title(), func(of: TreeReconstruction) -> TreeEdit: return of.run_script(script)
	)


## The selected nodes that the tree still has: until the frame ends, the selection may be older.
func get_selected() -> PackedInt32Array:
	var ids: PackedInt32Array = []
	for id: int in session.selection:
		if session.tree.has_node(id):
			ids.append(id)
	return ids


## Of the selected nodes those that don't grow from another one of them.
func get_lowest_selected() -> PackedInt32Array:
	# Asked for again with every node that the mouse comes over, and thousands may be selected.
	var of: Array = [session.tree, session.tree.get_bark_revision(), session.selection]
	if _lowest_of != of:
		_lowest_of = of
		_lowest = get_lowest_of(get_selected())
	return _lowest


## Of some nodes those that don't grow from another one of them. What the tree no longer has is left
## out.
func get_lowest_of(ids: PackedInt32Array) -> PackedInt32Array:
	var selected: Dictionary[int, bool] = {}
	for id: int in ids:
		if session.tree.has_node(id):
			selected[id] = true
	# By node: whether it or one below it is selected.
	var known: Dictionary[int, bool] = {}
	var lowest: PackedInt32Array = []
	var root: int = session.tree.get_root()
	for id: int in selected:
		var way: PackedInt32Array = []
		var at: int = id
		var covered: bool = false
		while at != root and not covered:
			at = session.tree.get_node_parent(at)
			if known.has(at):
				covered = known[at]
				break
			way.append(at)
			covered = selected.has(at)
		for passed: int in way:
			known[passed] = covered
		if not covered:
			lowest.append(id)
	return lowest


## Shows anew what a click would do. Called at most once a frame.
func _look_again() -> void:
	var id: int = session.hovered
	show_command(get_command_at(id) if session.tree.has_node(id) else get_idle_command())


## Sets what the strip shows, and looks again.
func set_setting(value: Variant, key: StringName) -> void:
	if values.get(key) != value:
		values[key] = value
		_rests = false
		_queue()


# What was shown is known not to be refused: a large tree need not try it once more.
func _run(command: String) -> TreeEdit:
	var now: Array = [command, session.tree, session.tree.get_bark_revision()]
	if _foreseen != now:
		return session.run(get_title(), command)
	return session.run_edit(
		get_title(), func(of: TreeReconstruction) -> TreeEdit: return of.edit(command)
	)


func _queue() -> void:
	if not _queued and not _rests:
		_queued = true
		_look.call_deferred()


func _look() -> void:
	_queued = false
	if not _rests and session.tool == self and session.tree != null and session.picker != null:
		_look_again()


func _on_button(button: InputEventMouseButton) -> bool:
	match button.button_index:
		MOUSE_BUTTON_LEFT:
			# With Alt the editor turns its camera.
			if button.pressed:
				return not button.alt_pressed and _press(button)
			return _release(button)
		MOUSE_BUTTON_RIGHT:
			if button.pressed and is_held():
				cancel()
				return true
		MOUSE_BUTTON_WHEEL_UP:
			return button.pressed and _wheel(1, button)
		MOUSE_BUTTON_WHEEL_DOWN:
			return button.pressed and _wheel(-1, button)
	return false


func _on_key(key: InputEventKey) -> bool:
	if key.keycode == KEY_ESCAPE and is_busy():
		cancel()
		return true
	if key.keycode in [KEY_ENTER, KEY_KP_ENTER] and not key.echo:
		return accept()
	if is_own_key(key) and not key.echo and not is_busy():
		return _press_own_key()
	# An undo in the middle of a drag would take back what came before it.
	return _press_key(key) or is_held()


## Whether a key is the one that chooses this tool.
func is_own_key(key: InputEventKey) -> bool:
	if Engine.is_editor_hint():
		var path: String = "tree_reconstruction/tool_%s" % get_id()
		var settings: EditorSettings = EditorInterface.get_editor_settings()
		if settings.has_shortcut(path):
			return settings.get_shortcut(path).matches_event(key)
	return get_key() != KEY_NONE and key.keycode == get_key() and key.get_modifiers_mask() == 0


func _restore() -> void:
	if _restored:
		return
	_restored = true
	values = get_defaults()
	if not Engine.is_editor_hint():
		return
	var kept: Dictionary = EditorInterface.get_editor_settings().get_project_metadata(
		_SECTION, "tool_%s" % get_id(), {}
	)
	for key: StringName in values:
		if typeof(kept.get(String(key))) == typeof(values[key]):
			values[key] = kept[String(key)]


func _keep() -> void:
	if not _restored or not Engine.is_editor_hint() or values.is_empty():
		return
	var kept: Dictionary = {}
	for key: StringName in values:
		kept[String(key)] = values[key]
	var settings: EditorSettings = EditorInterface.get_editor_settings()
	var name: String = "tool_%s" % get_id()
	if settings.get_project_metadata(_SECTION, name, {}) != kept:
		settings.set_project_metadata(_SECTION, name, kept)
