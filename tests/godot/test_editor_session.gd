extends "./session_suite.gd"
## The editor's session on a plain undo history: edits, drags, values, imported trees.


func test_an_edit_is_one_step() -> void:
	var made: TreeReconstruction = grown_tree(3)
	var before: Dictionary = made.skeleton
	var session: Session = _session_with(made)
	var edit: TreeEdit = session.run("Prune", "prune_order order=1")
	check(edit != null, "Nothing was pruned.")
	var after: Dictionary = made.skeleton
	check_equal(_undo.get_history_count(), 1, "steps")
	check_equal(_undo.get_current_action_name(), "Prune", "the step's name")
	_undo.undo()
	check_equal(made.skeleton, before, "the skeleton after undo")
	_undo.redo()
	check_equal(made.skeleton, after, "the skeleton after redo")
	_end(session)


func test_a_refused_edit_is_no_step_and_says_why() -> void:
	var session: Session = _session_with(grown_tree(3))
	check(session.run("Cut", "cut node=999999") == null, "It was done.")
	check_equal(_undo.get_history_count(), 0, "steps")
	check_equal(_said.size(), 1, "sentences")
	check_sentence(_said[0], "the refusal")
	_end(session)


func test_a_drag_is_one_step() -> void:
	var made: TreeReconstruction = grown_tree(4)
	var before: Dictionary = made.skeleton
	var session: Session = _session_with(made)
	var tip: int = made.get_leaves()[0]
	var start: Vector3 = made.get_node_position(tip)
	session.begin_drag("Move")
	for i: int in range(1, 6):
		check(session.drag("move nodes=%d by=%s,0,0" % [tip, i * 0.1]), "The drag was refused.")
	check(not session.drag("move nodes=999999 by=1,0,0"), "An impossible drag was taken.")
	check_equal(made.skeleton, before, "the skeleton after an impossible drag")
	check(session.drag("move nodes=%d by=0.5,0,0" % tip), "The drag was refused.")
	session.end_drag()
	check_near(made.get_node_position(tip).x - start.x, 0.5, 1e-5, "the way of the tip")
	check_equal(_undo.get_history_count(), 1, "steps")
	_undo.undo()
	check_equal(made.skeleton, before, "the skeleton after undo")
	session.begin_drag("Move")
	session.drag("move nodes=%d by=0.5,0,0" % tip)
	session.cancel_drag()
	check_equal(made.skeleton, before, "the skeleton after a cancelled drag")
	check(not session.is_dragging(), "It still drags.")
	check_equal(made.edit_log, "", "the log")
	_end(session)


func test_what_is_said_follows_undo() -> void:
	var made: TreeReconstruction = grown_tree(3)
	var session: Session = _session_with(made)
	session.update()
	session.run("Prune", "prune_order order=1")
	session.run("Smooth", "smooth_radii")
	check_equal(_undo.get_history_count(), 2, "steps")
	session.update()
	_said.clear()
	session.update()
	check(_said.is_empty(), "%s is said of nothing." % [_said])
	for wanted: String in ["Undone: Smooth", "Undone: Prune"]:
		_undo.undo()
		session.update()
		check_equal(_said[-1], wanted, "what is said")
	for wanted: String in ["Done again: Prune", "Done again: Smooth"]:
		_undo.redo()
		session.update()
		check_equal(_said[-1], wanted, "what is said")
	check_equal(_said.size(), 4, "sentences")
	# A step that has nothing to do with the tree is not this addon's to tell of.
	_undo.create_action("Move Node")
	_undo.add_do_property(session.node, &"position", Vector3.ONE)
	_undo.add_undo_property(session.node, &"position", Vector3.ZERO)
	_undo.commit_action()
	session.update()
	_undo.undo()
	session.update()
	check_equal(_said.size(), 4, "sentences after a step of another kind")
	_end(session)


func test_a_value_and_what_it_sets_with_it_are_undone() -> void:
	var made: TreeReconstruction = grown_tree(4)
	var session: Session = _session_with(made)
	var size: float = made.leaf_size
	session.set_value("Leaves", made, &"leaf_preset", "pine")
	var pine: float = made.leaf_size
	check(pine != size, "The preset has the same leaves.")
	_undo.undo()
	check_equal(made.leaf_preset, "generic", "the preset after undo")
	check_equal(made.leaf_size, size, "the size after undo")
	_undo.redo()
	check_equal(made.leaf_size, pine, "the size after redo")
	_end(session)


func test_another_reconstruction_takes_its_place() -> void:
	var made: TreeReconstruction = grown_tree(4)
	var session: Session = _session_with(made)
	# Another node that shows the same tree shows the new one, too.
	var first: TreeEdit = session.run("Prune", "prune_order order=1")
	check(first != null, "Nothing was pruned.")
	var before: Dictionary = made.skeleton
	var other: TreeReconstruction = grown_tree(5)
	session.replace_tree("Reconstruct again", other)
	check_equal(session.tree, made, "the resource")
	check_equal(made.skeleton, other.skeleton, "the wood")
	check_equal(made.edit_log, other.edit_log, "the log")
	_undo.undo()
	check_equal(made.skeleton, before, "the wood after undo")
	_undo.undo()
	check(made.get_node_count() > (before["ids"] as Array).size(), "The pruning was not undone.")
	_undo.redo()
	check_equal(made.skeleton, before, "the wood after redo")
	_undo.redo()
	check_equal(made.skeleton, other.skeleton, "the wood after all was redone")
	_end(session)


func test_a_copy_shares_nothing_that_is_edited() -> void:
	var made: TreeReconstruction = grown_tree(6)
	# Ids with gaps must stay.
	made.edit("prune_order order=2")
	var copy: TreeReconstruction = Session.LocalTrees.copy_of(made)
	check_equal(copy.skeleton, made.skeleton, "the copy's skeleton")
	check_equal(copy.get_node_ids(), made.get_node_ids(), "the copy's ids")
	check_equal(copy.edit_log, made.edit_log, "the copy's log")
	var before: Dictionary = made.skeleton
	copy.edit("prune_order order=1")
	check_equal(made.skeleton, before, "the first one's skeleton")


func test_the_selection_follows_the_wood() -> void:
	var made: TreeReconstruction = grown_tree(7)
	var session: Session = _session_with(made)
	check(session.select_by("leaves"), "The selection was refused.")
	check_equal(session.selection, made.select_nodes("leaves"), "the tips")
	session.run("Remove", "remove nodes=%s" % session.get_selection_words())
	session.update()
	check(session.selection.is_empty(), "What went is still selected.")
	check(not session.select_by("nonsense:"), "Nonsense was understood.")
	check_sentence(_said[-1], "the refusal")
	var root: int = made.get_root()
	session.select([root])
	session.grow_selection()
	check_equal(session.selection.size(), 1 + made.get_node_children(root).size(), "after growing")
	check_equal(session.get_active(), root, "the active node")
	session.select([root])
	session.select_subtree()
	check_equal(session.selection.size(), made.get_node_count(), "the whole tree")
	session.shrink_selection()
	check_equal(
		session.selection.size(),
		made.get_node_count() - made.get_leaves().size(),
		"all but the tips"
	)
	session.select([root], Session.How.TOGGLE)
	check(not root in session.selection, "The toggled node is still selected.")
	_end(session)


func test_jobs_end_on_the_main_thread_or_not_at_all() -> void:
	var session: Session = _session_with(grown_tree(2))
	var got: Array = []
	var work: Callable = func(_job: Session.Jobs.Job) -> int: return 7
	var done: Callable = func(result: int, _job: Session.Jobs.Job) -> void: got.append(result)
	session.jobs.start("Seven", work, done)
	while not session.jobs.get_running().is_empty():
		await tree.process_frame
		session.update()
	check_equal(got, [7], "results")
	var job: Session.Jobs.Job = session.jobs.start("Seven", work, done)
	session.jobs.cancel(job)
	while not session.jobs.get_running().is_empty():
		await tree.process_frame
		session.update()
	check_equal(got, [7], "results after a cancelled job")
	_end(session)
