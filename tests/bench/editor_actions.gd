extends SceneTree
## Milliseconds of the main thread that an action in the editor's viewport takes, as
## ./dev bench --editor prints them: the tool's look before a click, the click, undo, and the
## skeleton's lines that follow each. Bark and leaves are built on other threads.

const SIZES: PackedInt32Array = [5000, 50000]
const ROUNDS: int = 12
const SKELETON_VIEW: String = "res://addons/tree_reconstruction/editor/viewport/skeleton_view.gd"

var _suite: RefCounted
var _view: RefCounted


func _init() -> void:
	_measure.call_deferred()


func _measure() -> void:
	var here: String = (get_script() as Script).resource_path.get_base_dir()
	print("| nodes | action | hover | do | undo |\n|---|---|---|---|---|")
	var grown: GDScript = load(here.path_join("../godot/suite.gd").simplify_path())
	for size: int in SIZES:
		var made: TreeReconstruction = grown.call(&"grown_tree", 5, size)
		for tool: StringName in [
			&"move", &"prune", &"cut", &"grow", &"twig_left", &"graft", &"smooth", &"simplify"
		]:
			_suite = load(here.path_join("../godot/tools_suite.gd").simplify_path()).new()
			_suite.set(&"tree", self)
			_suite.call(&"_begin", made.duplicate(), tool)
			_view = load(SKELETON_VIEW).new(_session())
			_view.call(&"update_tree")
			await process_frame
			print("| %d | %s | %s |" % [size, tool, " | ".join(await _time_of(tool))])
			_suite.call(&"_end")
			_view = null
	quit()


func _session() -> RefCounted:
	return _suite.get(&"_session")


# The mean of several: hovering, doing and undoing.
func _time_of(tool: StringName) -> PackedStringArray:
	var made: TreeReconstruction = _suite.get(&"_made")
	var fits: String = "_is_middle" if tool == &"move" else "_has_two_above"
	var id: int = _suite.call(&"_find", Callable(_suite, fits))
	var at: Vector2 = _suite.call(&"_at", id)
	var spent: PackedFloat64Array = [0.0, 0.0, 0.0]
	for round: int in ROUNDS:
		_session().set(&"hovered", TreeReconstruction.NO_NODE)
		await process_frame
		spent[0] += _time(func() -> void: _suite.call(&"_hover", at))
		spent[1] += _time(_do.bind(tool, at, round))
		await process_frame
		spent[2] += _time(func() -> void: _suite.get(&"_undo").undo())
		while (_session().get(&"node") as TreeInstance3D).is_rebuilding():
			await process_frame
		_session().call(&"update")
	assert(made.has_node(id))
	var words: PackedStringArray = []
	for value: float in spent:
		words.append("%.1f" % (value / ROUNDS))
	return words


func _do(tool: StringName, at: Vector2, round: int) -> void:
	if tool != &"move":
		_suite.call(&"_click", at)
		return
	var to: Vector2 = at + Vector2(20 + round, 10)
	_suite.call(&"_button", at, true)
	_suite.call(&"_hover", to, true)
	_suite.call(&"_button", to, false)


# With all that follows in the same frame.
func _time(action: Callable) -> float:
	var began: float = _now()
	action.call()
	_session().get(&"tool").call(&"_look")
	_session().call(&"update")
	_view.call(&"update_tree")
	_view.call(&"update_selection")
	_view.call(&"update_ghosts")
	return _now() - began


# In milliseconds: what this thread has worked, where the system tells, so that a busy machine does
# not count.
func _now() -> float:
	var file: FileAccess = FileAccess.open("/proc/thread-self/schedstat", FileAccess.READ)
	if file == null:
		return Time.get_ticks_usec() / 1e3
	return file.get_line().get_slice(" ", 0).to_int() / 1e6
