extends "./suite.gd"
## Edits by commands: done, undone, logged, replayed on another reconstruction, saved.


func test_an_edit_is_done_undone_and_done_again() -> void:
	var made: TreeReconstruction = grown_tree(3)
	var before: Dictionary = made.skeleton
	var count: Array[int] = [0]
	made.changed.connect(func() -> void: count[0] += 1)
	var edit: TreeEdit = made.edit("prune_order order=1")
	check(edit != null and not edit.is_empty(), "Nothing was pruned.")
	if edit == null:
		return
	check_equal(count[0], 1, "changed signals")
	check_sentence(edit.get_message(), "the message")
	check_equal(edit.get_command(), "prune_order order=1", "the command")
	check(not edit.get_removed_nodes().is_empty(), "No node went.")
	check(edit.get_added_nodes().is_empty(), "Nodes came.")
	check(edit.get_byte_count() > 0, "It takes no memory.")
	for id: int in edit.get_removed_nodes():
		check(not made.has_node(id), "Node %d is still there." % id)
	for id: int in edit.get_changed_nodes():
		check(made.has_node(id), "Node %d went." % id)
	check("prune_order order=1\n" in made.edit_log, "The log is '%s'." % made.edit_log)
	var after: Dictionary = made.skeleton
	check(after != before, "The skeleton is as it was.")
	check_equal(made.revert_edit(edit), OK, "reverting")
	check_equal(made.skeleton, before, "the skeleton after undo")
	check_equal(made.edit_log, "", "the log after undo")
	check_equal(made.apply_edit(edit), OK, "applying")
	check_equal(made.skeleton, after, "the skeleton after redo")
	expect_error("cannot be done again")
	check_equal(made.apply_edit(edit), ERR_INVALID_DATA, "applying twice")
	check_equal(made.skeleton, after, "the skeleton after the refusal")


func test_removed_wood_is_handed_over() -> void:
	var made: TreeReconstruction = grown_tree(4)
	var tip: int = made.get_leaves()[0]
	var place: Vector3 = made.get_node_position(tip)
	var edit: TreeEdit = made.edit("cut node=%d" % tip)
	var pieces: Array = edit.get_removed_wood()
	check_equal(pieces.size(), 1, "pieces")
	var piece: TreeReconstruction = pieces[0]
	check_equal(piece.get_node_count(), 2, "nodes of the piece")
	check_equal(piece.get_node_position(piece.get_leaves()[0]), place, "where it was")


func test_edits_merge() -> void:
	var made: TreeReconstruction = grown_tree(5)
	var before: Dictionary = made.skeleton
	var one: TreeEdit = made.edit("prune factor=0.5")
	var two: TreeEdit = made.edit("prune_radius radius=0.01")
	var both: TreeEdit = one.merged_with(two)
	var after: Dictionary = made.skeleton
	check_equal(made.revert_edit(both), OK, "reverting both")
	check_equal(made.skeleton, before, "the skeleton")
	check_equal(made.edit_log, "", "the log")
	check_equal(made.apply_edit(both), OK, "applying both")
	check_equal(made.skeleton, after, "the skeleton again")
	expect_error("do not follow each other")
	check(two.merged_with(one) == null, "They merged in the wrong order.")


func test_what_changes_nothing_is_not_logged() -> void:
	var made: TreeReconstruction = grown_tree(11)
	var real: TreeEdit = made.edit("prune_order order=2")
	var log: String = made.edit_log
	var empty: TreeEdit = made.edit("prune_order order=2")
	check(empty.is_empty(), "It changed something.")
	check_equal(empty.get_command(), "prune_order order=2", "the command")
	check_equal(made.edit_log, log, "the log")
	check_equal(made.revert_edit(real), OK, "reverting the one before")
	check_equal(made.edit_log, "", "the log after undo")


func test_works_with_undo_redo() -> void:
	var made: TreeReconstruction = grown_tree(6)
	var undo: UndoRedo = UndoRedo.new()
	var states: Array[Dictionary] = [made.skeleton]
	for command: String in ["prune", "prune_order order=2", "prune_side place=0,3,0 towards=0,1,0"]:
		var edit: TreeEdit = made.edit(command)
		undo.create_action(command)
		undo.add_do_method(made.apply_edit.bind(edit))
		undo.add_undo_method(made.revert_edit.bind(edit))
		undo.commit_action(false)
		states.append(made.skeleton)
	for i: int in [2, 1, 0]:
		check(undo.undo(), "There is nothing to undo.")
		check_equal(made.skeleton, states[i], "undone to %d" % i)
	for i: int in [1, 2, 3]:
		check(undo.redo(), "There is nothing to redo.")
		check_equal(made.skeleton, states[i], "redone to %d" % i)
	undo.free()


func test_a_log_is_saved_and_replayed() -> void:
	var made: TreeReconstruction = grown_tree(7)
	var again: TreeReconstruction = grown_tree(7)
	made.edit("prune factor=0.8")
	made.edit("cut node=%d" % made.get_leaves()[3])
	var path: String = folder.path_join("edited.tres")
	check_equal(ResourceSaver.save(made, path), OK, "saving")
	var read: TreeReconstruction = (
		ResourceLoader.load(path, "", ResourceLoader.CACHE_MODE_IGNORE) as TreeReconstruction
	)
	check_equal(read.edit_log, made.edit_log, "the log")
	check_equal(read.skeleton, made.skeleton, "the edited tree")
	var result: Dictionary = again.replay(read.edit_log)
	check_equal(result.done, 2, "commands done")
	check(result.left_out.is_empty(), "Left out: %s." % [result.left_out])
	check_equal(again.skeleton, made.skeleton, "the replayed tree")
	check_equal(again.edit_log, made.edit_log, "the log of the replayed tree")
	check_equal(again.revert_edit(result.edit), OK, "reverting the replay")
	check_equal(again.skeleton, grown_tree(7).skeleton, "the tree before")
	check_equal(again.edit_log, "", "the log before")


func test_what_does_not_fit_is_told_and_kept() -> void:
	var made: TreeReconstruction = grown_tree(8)
	var log: String = "prune factor=0.9\ncut node=5@900:900:900:0:0:1:0.1\nprune_order order=4\n"
	var result: Dictionary = made.replay(log)
	check_equal(result.done, 2, "commands done")
	check_equal(result.left_out.size(), 1, "commands left out")
	check_equal(result.left_out[0].line, 2, "the line")
	check_sentence(result.left_out[0].reason, "the reason")
	check("#? cut node=5@900:900:900:0:0:1:0.1\n" in made.edit_log, "It is lost: " + made.edit_log)
	var other: TreeReconstruction = grown_tree(8)
	check_equal(other.replay(made.edit_log).left_out.size(), 1, "left out again")
	check_equal(other.edit_log, made.edit_log, "the log")


func test_scripts_and_errors() -> void:
	var made: TreeReconstruction = grown_tree(9)
	var before: Dictionary = made.skeleton
	expect_error("Line 3, column 14: 'factor' must be a number")
	check(made.run_script("# two\nprune\nprune factor=x") == null, "It ran.")
	check_equal(made.skeleton, before, "the skeleton after a failed script")
	check_equal(made.edit_log, "", "the log after a failed script")
	check(made.run_script("prune\nprune_order order=2") != null, "The script failed.")
	expect_error("There is no command 'plant'.")
	check(made.edit("plant") == null, "It ran.")
	check_sentence(made.check_edit("plant"), "why not")
	check_equal(made.check_edit("prune"), "", "why not")
	expect_error("The tree is empty")
	check(TreeReconstruction.new().edit("prune") == null, "An empty tree was edited.")


func test_selections() -> void:
	var made: TreeReconstruction = grown_tree(10)
	check_equal(made.select_nodes("all").size(), made.get_node_count(), "all nodes")
	check_equal(made.select_nodes("all"), made.get_node_ids(), "their order")
	check_equal(made.select_nodes("trunk"), made.get_trunk_nodes(), "the trunk")
	for id: int in made.select_nodes("radius:..0.02&!leaves"):
		check(made.get_node_radius(id) <= 0.02, "Node %d is thick." % id)
		check(made.get_node_kind(id) != TreeReconstruction.NODE_KIND_LEAF, "%d is a leaf." % id)
	expect_error("There is no selection 'wood:'")
	check(made.select_nodes("wood:3").is_empty(), "Something was selected.")


func test_commands_describe_themselves() -> void:
	var names: PackedStringArray = []
	for command: Dictionary in TreeReconstruction.get_edit_commands():
		names.append(command.name)
		check_sentence(command.description, command.name)
		for parameter: Dictionary in command.parameters:
			check(not parameter.description.is_empty(), "%s %s" % [command.name, parameter.name])
	check("prune" in names and "cut" in names, "Commands are missing: %s." % names)
