extends "./tools_suite.gd"
## The tools that compare a tree with its scan: Complete, and the way through the doubtful places.

const Doubt := preload("res://addons/tree_reconstruction/editor/tools/doubt.gd")


# A tree of a scan that lacks one of its branches. Returns where that grew, and the way it went.
func _incomplete_tree() -> Array:
	var made: TreeReconstruction = TreeReconstructor.new().reconstruct_file(write_scan("scan.xyz"))
	var tip: int = made.get_leaves()[0]
	var first: int = tip
	while made.get_node_children(made.get_node_parent(first)).size() == 1:
		first = made.get_node_parent(first)
	var joint: int = made.get_node_parent(first)
	var way: Vector3 = made.get_node_position(tip) - made.get_node_position(joint)
	made.edit("remove nodes=%d" % first)
	return [made, joint, way]


func _wait_for_jobs() -> void:
	for i: int in 3000:
		await tree.create_timer(0.01).timeout
		_session.update()
		if _session.jobs.get_running().is_empty():
			return
	check(false, "The work did not end.")


func _points_of(ids: PackedInt32Array) -> PackedVector3Array:
	var places: PackedVector3Array = []
	for id: int in ids:
		places.append(_made.get_node_position(id))
	return places


# As the scan of a leafy tree has it: not all of its points are wood.
func _hide_wood_among_leaves() -> void:
	var leaves: PackedVector3Array = []
	leaves.resize(5000)
	leaves.fill(Vector3(50, 50, 50))
	_session.scan.points = leaves + _session.scan.points


func test_a_branch_is_found_where_the_mouse_points() -> void:
	var given: Array = _incomplete_tree()
	_begin(given[0], &"complete")
	var joint: int = given[1]
	var place: Vector3 = _made.get_node_position(joint)
	var seen: Vector2 = _at(joint)
	var to: Vector2 = _session.picker.project_place(_camera, place + given[2])
	check_equal(_session.picker.pick(_camera, seen), joint, "the node to drag from")
	var log: String = _made.edit_log
	check(_button(seen, true), "The press was left.")
	check(_hover(to, true), "The drag was left.")
	while _session.scan.is_loading():
		await _frame()
	_session.scan.points = PackedVector3Array([Vector3.ZERO])
	check(_button(to, false), "The release was left.")
	check_equal(_made.skeleton, _before, "the tree before it is found")
	await _wait_for_jobs()
	check(_made.get_node_count() > given[0].get_node_count() - 1, "Nothing was found.")
	_check_one_step("a completion")
	check(_made.edit_log.begins_with(log), "The log forgot what was before.")
	check(not _session.selection.is_empty(), "The new wood isn't selected.")
	# Down there is nothing: a sentence, and no step.
	var count: int = _undo.get_history_count()
	var after: Dictionary = _made.skeleton
	_button(_at(joint), true)
	_hover(_at(joint) + Vector2(0, 120), true)
	_button(_at(joint) + Vector2(0, 120), false)
	await _wait_for_jobs()
	check_equal(_undo.get_history_count(), count, "steps after nothing was found")
	check_equal(_made.skeleton, after, "the tree after nothing was found")
	check_sentence(_said[-1], "what is said when nothing is found")
	# Escape while it looks.
	_button(_at(joint), true)
	_hover(_at(joint) + Vector2(80, -80), true)
	_button(_at(joint) + Vector2(80, -80), false)
	check(_key(KEY_ESCAPE), "Escape was left.")
	await _wait_for_jobs()
	check_equal(_made.skeleton, after, "the tree after Escape")
	_end()


func test_a_tree_without_a_scan_says_so() -> void:
	_begin(grown_tree(20), &"complete")
	check_sentence(_said[-1], "what is said")
	var id: int = _find(_is_middle)
	_button(_at(id), true)
	_hover(_at(id) + Vector2(80, -80), true)
	_button(_at(id) + Vector2(80, -80), false)
	await _wait_for_jobs()
	check(not _key(KEY_ESCAPE), "It still waits.")
	_check_untouched("a completion without a scan")
	_end()


func test_doubtful_places_are_gone_through() -> void:
	var given: Array = _incomplete_tree()
	var with_false: TreeReconstruction = given[0]
	# A branch that the scan knows nothing of.
	var host: int = with_false.select_nodes("!leaves&!forks&order:1..")[0]
	var false_branch: TreeEdit = with_false.edit(
		"grow node=%d direction=0.2,0.1,-1 length=1.2 count=8" % host
	)
	var first: int = false_branch.get_added_nodes()[0]
	_begin(with_false, &"doubt")
	await _wait_for_jobs()
	await _frame()
	var tool: Doubt = _session.tool as Doubt
	var kinds: Array = []
	var seen: int = tool.get_left()
	_hide_wood_among_leaves()
	check(seen >= 2, "Only %d places were found." % seen)
	var doubtful: bool = false
	var missing: bool = false
	var wanted: Array[AABB] = []
	_session.view_wanted.connect(func(box: AABB) -> void: wanted.append(box))
	for i: int in seen:
		var place: Doubt.Place = tool.get_place()
		kinds.append(place.kind)
		check_sentence(place.text, "what is told of a place")
		await _frame()
		check(not (tool.get_ghosts() as Array).is_empty(), "Nothing is shown of place %d." % i)
		var shown: PackedVector3Array = tool.get_ghosts()[Mesh.ARRAY_VERTEX]
		for at: Vector3 in shown:
			check(at.distance_to(place.at) < 3.0, "%v is shown for %v." % [at, place.at])
		check_equal(_session.get_active(), place.node, "the selected node")
		if place.kind == Doubt.Kind.DOUBTFUL and _made.has_node(first):
			doubtful = doubtful or first in _made.select_nodes("below:%d" % place.node)
		missing = missing or place.kind == Doubt.Kind.MISSING
		check(_key(KEY_Y), "The tool's key was left.")
		# The next one is to be brought into view.
		check_equal(wanted.size(), i + 1, "views that were asked for")
		var next: Doubt.Place = tool.get_place()
		var joint: int = _made.get_node_parent(next.node)
		check(wanted[-1].grow(1e-4).has_point(next.at), "The place is out of view.")
		check(
			(
				next.kind == Doubt.Kind.MISSING
				or wanted[-1].grow(1e-4).has_point(_made.get_node_position(joint))
			),
			"What it grows from is out of view."
		)
	check(doubtful, "The false branch isn't doubtful.")
	check(missing, "The missing branch isn't missed.")
	check_equal(tool.get_left(), seen, "places after having looked")
	_check_untouched("looking")
	# The false branch goes, the missing one comes.
	for i: int in seen:
		if tool.get_place().kind != Doubt.Kind.DOUBTFUL:
			_key(KEY_Y)
	var node: int = tool.get_place().node
	check(_key(KEY_BACKSPACE), "Backspace was left.")
	check(not _made.has_node(node), "The doubtful branch stays.")
	_check_one_step("a rejection")
	_undo.undo()
	await _wait_for_jobs()
	check_equal(tool.get_left(), seen, "places after the rejection was undone")
	_undo.redo()
	await _wait_for_jobs()
	check_equal(tool.get_left(), seen - 1, "places after a rejection")
	for i: int in tool.get_left():
		if tool.get_place() != null and tool.get_place().kind != Doubt.Kind.MISSING:
			check(_key(KEY_ENTER), "Enter was left.")
	var before: int = _made.get_node_count()
	check(tool.get_place() != null, "The missing branch is no longer missed.")
	if tool.get_place() != null:
		check(_key(KEY_ENTER), "Enter was left.")
		await _wait_for_jobs()
		check(_made.get_node_count() > before, "The missing branch did not come: %s" % _said[-1])
		check_equal(_undo.get_history_count(), 2, "steps")
	_end()
