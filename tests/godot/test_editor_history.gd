extends "./suite.gd"
## The editor's session and its history under random edits of all kinds, undone and redone in random
## walks: at every place of the history everything is what it was there, bit for bit.

const Session := preload("res://addons/tree_reconstruction/editor/session.gd")
const FOLDER: String = "res://.godot/tree_reconstruction_walks"
const RULE: String = "res://addons/tree_reconstruction/presets/%s_rule.tres"
const PRESETS: PackedStringArray = ["generic", "oak", "birch", "pine", "willow", "cherry"]
# With a node's id, another's, a length, and a number.
const COMMANDS: PackedStringArray = [
	"prune factor=1.3",
	"prune_below node={node}",
	"cut node={node} stub={length}",
	"delete node={node}",
	"remove nodes={node},{other}",
	"prune_order order=4",
	"prune_radius radius=0.0022",
	"move nodes={node} by={length},0.1,-{length} falloff=0.3",
	"move nodes={node},{other} by=0,{length},0 with=alone",
	"turn node={node} axis=0,1,0 angle={number}",
	"scale node={node} factor=1.1",
	"mirror node={node} normal=1,0,0",
	"grow node={node} count=3",
	"attach node={node} to={other} bring=yes",
	"insert node={node}",
	"thicken nodes=branch:{node} factor=1.2",
	"set_radius nodes={node} radius=0.01",
	"smooth_radii nodes=branch:{node}",
	"smooth_paths nodes=branch:{node}",
	"relax",
	"straighten node={node}",
	"sag nodes=below:{node} weight=0.5",
	"twig node={node} side=left view=0,0,-1",
	"graft node={node} twig=oak seed={number}",
	"graft node={node} from={other} seed={number}",
]
const VALUES: Dictionary[StringName, Array] = {
	&"leaf_preset": ["generic", "oak", "birch", "pine"],
	&"leaf_size": [0.02, 0.05, 0.11],
	&"seed": [1, 2, 3],
}
const RULE_VALUES: Dictionary[StringName, Array] = {
	&"leaf_size": [0.03, 0.06, 0.12],
	&"seed": [4, 5],
}
const NODE_VALUES: Dictionary[StringName, Array] = {
	&"lod": [-1, 0, 2], &"leaves": [true, false], &"wind": [true, false]
}

var _random: RandomNumberGenerator = RandomNumberGenerator.new()
var _undo: UndoRedo
var _session: Session
var _node: TreeInstance3D
# What is there after each step of the history; the first one is before them all. And the words by
# which a failure can be told.
var _states: Array[Dictionary] = []
var _story: PackedStringArray = []
var _failed: bool = false
# How often each kind of thing became a step, or was undone or redone.
var _done: Dictionary[String, int] = {}


func test_random_walks_on_a_tree_of_ones_own() -> void:
	for walk: int in 25:
		_walk(walk, false)
	_check_that_much_happened()


func test_random_walks_on_an_imported_tree() -> void:
	for walk: int in 25:
		_walk(100 + walk, true)
	_check_that_much_happened()


func _check_that_much_happened() -> void:
	for kind: String in ["run", "drag", "set", "rule", "replace", "undo", "redo"]:
		check(_done.get(kind, 0) >= 15, "Too little happened: %s" % _done)


func _walk(random_seed: int, imported: bool) -> void:
	if _failed:
		return
	_random.seed = random_seed
	_begin(grown_tree(random_seed, 120), imported)
	_states = [_state()]
	_story = ["walk %d" % random_seed]
	for i: int in 60:
		if _random.randf() < 0.6:
			_act()
		else:
			_wander(_random.randi_range(1, 4), _random.randf() < 0.6)
		if _failed:
			break
	# All the way back, and all the way on.
	_wander(1000, true)
	_wander(1000, false)
	_end()


func _begin(made: TreeReconstruction, imported: bool) -> void:
	DirAccess.make_dir_recursive_absolute(FOLDER)
	_empty()
	if imported:
		for file: String in ["elm.ply", "elm.ply.import"]:
			FileAccess.open(FOLDER.path_join(file), FileAccess.WRITE).store_string("for a test")
		made.take_over_path(FOLDER.path_join("elm.ply"))
		made.provenance = {"source": FOLDER.path_join("elm.ply")}
	else:
		ResourceSaver.save(made, FOLDER.path_join("elm.res"))
		made.take_over_path(FOLDER.path_join("elm.res"))
	_undo = UndoRedo.new()
	_node = TreeInstance3D.new()
	_node.reconstruction = made
	tree.root.add_child(_node)
	_session = Session.new(_undo)
	_session.edit_node(_node)


func _end() -> void:
	_session.shut_down()
	_undo.clear_history()
	_undo.free()
	_session = null
	_node.free()
	_empty()


func _empty() -> void:
	for file: String in DirAccess.get_files_at(FOLDER):
		DirAccess.remove_absolute(FOLDER.path_join(file))


# One thing that a user does. It makes one step or none, or goes on with the one before.
func _act() -> void:
	var place: int = _undo.get_current_action()
	match _random.randi_range(0, 9):
		0, 1, 2, 3:
			var command: String = _command()
			_tell("run " + command)
			_session.run("Edit", command)
		4:
			_drag(_random.randf() < 0.7)
		5:
			_change(_session.tree, VALUES)
			place = _undo.get_current_action()
		6:
			if _session.tree.leaf_rule != null:
				_change(_session.tree.leaf_rule, RULE_VALUES)
			place = _undo.get_current_action()
		7:
			_change(_node, NODE_VALUES)
			place = _undo.get_current_action()
		8:
			var rule: LeafRule = load(RULE % _any(PRESETS)) as LeafRule
			_tell("rule %s" % rule.resource_path)
			_session.set_value("Rule", _session.tree, &"leaf_rule", rule)
		9:
			_rare()
	_session.update()
	_note(place)


# What happens less often.
func _rare() -> void:
	if _random.randf() < 0.5:
		var other: TreeReconstruction = grown_tree(_random.randi_range(500, 999), 80)
		other.provenance = _session.tree.provenance
		_tell("replace")
		_session.replace_tree("Reconstruct", other)
		return
	_tell("save")
	check_equal(_session.local_trees.save(), PackedStringArray(), "failures to save")
	check_equal(_session.local_trees.get_unsaved(), PackedStringArray(), "unsaved files")
	var path: String = _session.tree.resource_path
	# The scan itself is a few words here.
	if path.get_extension() == "res":
		var saved: TreeReconstruction = (
			ResourceLoader.load(path, "", ResourceLoader.CACHE_MODE_IGNORE_DEEP)
			as TreeReconstruction
		)
		_compare(_of_tree(saved), _of_tree(_session.tree), "The file %s" % path)


func _drag(to_end: bool) -> void:
	var id: int = _any(_session.tree.get_node_ids())
	_tell("drag %d%s" % [id, "" if to_end else ", cancelled"])
	_session.begin_drag("Move")
	for i: int in range(1, _random.randi_range(2, 5)):
		_session.drag("move nodes=%d by=%s,0,%s" % [id, 0.03 * i, 0.02])
	if to_end:
		_session.end_drag()
	else:
		_session.cancel_drag()


func _change(object: Object, values: Dictionary[StringName, Array]) -> void:
	var property: StringName = _any(values.keys())
	var merged: bool = _random.randf() < 0.5
	# As a slider does.
	for i: int in 4 if merged else 1:
		var value: Variant = _any(values[property])
		var place: int = _undo.get_current_action()
		_tell("set %s to %s%s" % [property, value, ", merged" if merged else ""])
		_session.set_value("Set %s" % property, object, property, value, merged)
		_session.update()
		_note(place)
		if object is LeafRule:
			# It may have become a rule of the tree's own.
			object = _session.tree.leaf_rule


func _command() -> String:
	var words: Dictionary = {
		"node": _any(_session.tree.get_node_ids()),
		"other": _any(_session.tree.get_node_ids()),
		"length": "%.3f" % _random.randf_range(0.0, 0.1),
		"number": _random.randi_range(1, 50),
	}
	return (_any(COMMANDS) as String).format(words)


# After an action: the history has one step more, or as many as before.
func _note(place: int) -> void:
	var now: int = _undo.get_current_action()
	if not check_that(now == place or now == place + 1, "%d steps at once" % (now - place)):
		return
	if now == place + 1:
		# What could have been redone is gone.
		_states.resize(now + 1)
		_states.append(_state())
		_count(_story[-1])
	elif place >= 0 and _story[-1].ends_with(", merged"):
		# It may have become part of the step before.
		_states[place + 1] = _state()
	_compare(_state(), _states[now + 1], "No step, but it")


func _wander(count: int, back: bool) -> void:
	for i: int in count:
		if _failed or not (_undo.has_undo() if back else _undo.has_redo()):
			return
		_tell("undo" if back else "redo")
		if back:
			_undo.undo()
		else:
			_undo.redo()
		if _random.randf() < 0.5:
			_session.update()
		_count(_story[-1])
		var place: int = _undo.get_current_action() + 1
		_compare(_state(), _states[place], "Place %d of the history" % place)


func _count(what: String) -> void:
	var kind: String = what.get_slice(" ", 0)
	_done[kind] = _done.get(kind, 0) + 1


func _tell(what: String) -> void:
	_story.append(what)


func _any(of: Variant) -> Variant:
	return of[_random.randi_range(0, of.size() - 1)]


# --- states ---------------------------------------------------------------------------------------


func _state() -> Dictionary:
	var state: Dictionary = _of_tree(_node.reconstruction)
	state["which tree"] = _node.reconstruction.get_instance_id()
	state["file"] = _node.reconstruction.resource_path
	for property: StringName in NODE_VALUES:
		state["node's " + property] = _node.get(property)
	return state


func _of_tree(of: TreeReconstruction) -> Dictionary:
	var values: Dictionary = {}
	_add_values(of, "", values)
	return values


func _add_values(of: Resource, prefix: String, values: Dictionary) -> void:
	for property: Dictionary in of.get_property_list():
		var name: String = property.name
		if not property.usage & PROPERTY_USAGE_STORAGE or name.begins_with("resource_"):
			continue
		var value: Variant = of.get(name)
		if value is Resource:
			_add_values(value as Resource, prefix + name + ".", values)
		elif typeof(value) != TYPE_OBJECT:
			values[prefix + name] = var_to_bytes(value)


func _compare(given: Dictionary, wanted: Dictionary, what: String) -> void:
	for key: String in wanted:
		var same: bool = given.get(key) == wanted[key]
		if not check_that(same, "%s differs in '%s'" % [what, key]):
			return
	check_that(given.size() == wanted.size(), "%s has other properties" % what)


func check_that(condition: bool, message: String) -> bool:
	if not condition and not _failed:
		_failed = true
		check(false, "%s, after: %s" % [message, "; ".join(_story.slice(-30))])
	return condition
