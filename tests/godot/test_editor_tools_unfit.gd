extends "./tools_suite.gd"
## The way through the edits that did not fit when a scan was imported again.

const CUT: String = "cut node=5@0:0:5000:0:0:1:0.1 stub=0.01"
const REASON: String = "There is no wood within 4 cm of the place of node 5."

var _wanted: Array[AABB] = []


func _log_of(commands: PackedStringArray) -> String:
	var lines: PackedStringArray = ["# treerec edit log 1"]
	for command: String in commands:
		lines.append("# This did not fit: " + REASON)
		lines.append("#? " + command)
	return "\n".join(lines) + "\n"


func _start(commands: PackedStringArray, seed: int = 3) -> void:
	var made: TreeReconstruction = grown_tree(seed)
	made.edit_log = _log_of(commands)
	_wanted = []
	_begin(made, &"select")
	_session.view_wanted.connect(func(box: AABB) -> void: _wanted.append(box))
	_session.choose(&"unfit")


func _left() -> int:
	return _made.get_unfit_edits().size()


func test_the_view_goes_to_where_each_edit_was() -> void:
	_start([CUT, "remove nodes=7@0:0:1000:0:0:1:0.1,8@1:0:1000:0:0:1:0.1"])
	await _frame()
	check_equal(_session.tool.call(&"get_left"), 2, "edits")
	check_equal(_wanted.size(), 1, "places that were shown")
	check(_wanted[0].has_point(_made.get_unfit_edits()[0]["places"][0]), "It is another place.")
	check("This cut" in _said[0] and REASON in _said[0], "It says: %s" % _said[0])
	check(not (_session.tool.call(&"get_ghosts") as Array).is_empty(), "Nothing is drawn there.")
	check(_key(KEY_ENTER), "Enter was not taken.")
	check_equal(_wanted.size(), 2, "places that were shown then")
	check_equal(_made.get_unfit_edits()[1]["places"].size(), 2, "places of the second")
	check_equal(_left(), 2, "edits after going on")
	_check_untouched("going through them")
	_end()


func test_a_click_does_it_there_as_one_step() -> void:
	for seed: int in 6:
		_start([CUT, "prune_radius radius=0.001"], seed)
		await _frame()
		var log: String = _made.edit_log
		var id: int = _find(_has_two_above)
		if id == NO_NODE:
			_end()
			continue
		var direct: TreeReconstruction = _made.duplicate() as TreeReconstruction
		direct.edit("cut node=%d stub=0.01" % id)
		check(_click(_at(id)), "The click was not taken.")
		check_equal(_made.skeleton, direct.skeleton, "the tree")
		check_equal(_left(), 1, "edits that are left")
		check("cut node=%d@" % id in _made.edit_log, "The log does not tell of it.")
		_undo.undo()
		check_equal(_made.edit_log, log, "the log after undo")
		_undo.redo()
		_check_one_step("a cut at another node")
		_end()


func test_backspace_forgets() -> void:
	_start([CUT])
	await _frame()
	var log: String = _made.edit_log
	check(_key(KEY_BACKSPACE), "Backspace was not taken.")
	check_equal(_left(), 0, "edits that are left")
	check_equal(_made.skeleton, _before, "the wood")
	check(not _key(KEY_ENTER), "There is something to go on to.")
	_undo.undo()
	check_equal(_made.edit_log, log, "the log after undo")
	await _frame()
	check_equal(_session.tool.call(&"get_left"), 1, "edits after undo")
	_end()


func test_what_speaks_of_several_places_is_not_done_elsewhere() -> void:
	_start(
		["hang node=5@0:0:9:0:0:1:0.1 on=6@0:0:8:0:0:1:0.1", "remove nodes=7@0:0:9,below:8@0:0:7"]
	)
	await _frame()
	var id: int = _find(_is_middle)
	check_equal(_session.tool.call(&"get_command_at", id), "", "the command of two places")
	_key(KEY_ENTER)
	check_equal(
		_session.tool.call(&"get_command_at", id), "remove nodes=%d" % id, "the command of a list"
	)
	_end()
