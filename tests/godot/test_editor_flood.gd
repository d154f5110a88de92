extends "./session_suite.gd"
## The tool that shows how the flood works.

const Flood := preload("res://addons/tree_reconstruction/editor/tools/flood.gd")


func _tool_of(session: Session) -> Flood:
	var tool: Flood = Flood.new()
	tool.session = session
	session.tools[tool.get_id()] = tool
	session.choose(tool.get_id())
	return tool


func _put_away(session: Session, tool: Flood) -> void:
	session.choose(&"")
	session.tools.clear()
	_end(session)
	tool.session = null


func test_shows_the_steps_of_the_edited_trees_scan() -> void:
	var made: TreeReconstruction = TreeReconstructor.new().reconstruct_file(
		write_scan("scan.xyz"), {}
	)
	var before: Dictionary = made.skeleton
	var session: Session = _session_with(made)
	var tool: Flood = _tool_of(session)
	var strip: Control = tool.make_settings()
	tree.root.add_child(strip)
	check(tool.get_ghosts().is_empty(), "Something is shown before it ran.")
	tool.run()
	while not session.jobs.get_running().is_empty():
		await tree.process_frame
		session.update()
	check_equal(_said, PackedStringArray(), "what was said")
	check(tool.get_step_count() > 10, "There are %d steps." % tool.get_step_count())
	var box: AABB = made.get_aabb().grow(0.2)
	for step: int in [0, 5, tool.get_step_count() - 1]:
		tool.set_step(step)
		var points: PackedVector3Array = tool.get_ghosts()[Mesh.ARRAY_VERTEX]
		check(points.size() >= 2, "Step %d shows nothing." % step)
		# Two for each node that has grown, all in the tree's space.
		for i: int in mini(2 * step, points.size()):
			check(box.has_point(points[i]), "Step %d: %v is off the tree." % [step, points[i]])
	check_equal(made.skeleton, before, "the skeleton")
	check_equal(_undo.get_history_count(), 0, "steps of the history")
	strip.free()
	_put_away(session, tool)


func test_a_tree_without_a_scan_gets_a_sentence() -> void:
	var session: Session = _session_with(grown_tree(2))
	var tool: Flood = _tool_of(session)
	tool.run()
	check_equal(_said.size(), 1, "sentences")
	check_sentence(_said[0], "the refusal")
	_put_away(session, tool)


func test_places_of_the_scan_lie_in_the_tree() -> void:
	var made: TreeReconstruction = TreeReconstructor.new().reconstruct_file(
		write_scan("scan.xyz"), {}
	)
	for id: int in made.get_node_ids():
		var place: Vector3 = made.get_position_in_tree(made.get_node_scan_position(id))
		check(
			place.distance_to(made.get_node_position(id)) < 1e-5, "Node %d is at %v." % [id, place]
		)
	expect_error("three coordinates")
	made.get_position_in_tree([1.0, 2.0])
