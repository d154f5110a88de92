extends "./suite.gd"
## TreeReconstruction.complete_branch(): a branch that was cut away is found again in the scan.


func test_finds_what_was_cut_away() -> void:
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	var tree: TreeReconstruction = reconstructor.reconstruct_file(write_scan("scan.xyz"))
	var points: PackedVector3Array = reconstructor.get_cloud_points()
	var whole: float = tree.measure_fidelity(points)["explained"]
	var tip: int = tree.get_leaves()[0]
	var first: int = tip
	while tree.get_node_children(tree.get_node_parent(first)).size() == 1:
		first = tree.get_node_parent(first)
	var joint: int = tree.get_node_parent(first)
	var direction: Vector3 = tree.get_node_position(tip) - tree.get_node_position(joint)
	tree.edit("remove nodes=%d" % first)
	var without: float = tree.measure_fidelity(points)["explained"]
	check(without < whole, "Nothing was lost with the branch.")
	var before: Dictionary = tree.skeleton
	var preview: Dictionary = tree.preview_completion(points, joint, direction)
	check_equal(preview["error"], "", "the preview's error")
	check_equal(tree.skeleton, before, "the tree after a preview")
	var same: TreeEdit = tree.run_script(preview["script"])
	var foreseen: Dictionary = tree.skeleton
	tree.revert_edit(same)
	var edit: TreeEdit = tree.complete_branch(points, joint, direction)
	check_equal(tree.skeleton, foreseen, "what the preview foresaw")
	check_equal(preview["message"], edit.get_message(), "the preview's message")
	check_equal(preview["added"].size(), 2 * edit.get_added_nodes().size(), "the preview's ends")
	check(edit != null, "The branch was not found again.")
	if edit == null:
		return
	check(edit.get_added_nodes().size() > 0, "No node was added.")
	var again: float = tree.measure_fidelity(points)["explained"]
	check(again > without + 0.5 * (whole - without), "%f, %f, then %f" % [whole, without, again])
	var log: String = tree.edit_log
	check(log.contains("grow"), "The log does not have it: %s" % log)
	check_equal(tree.revert_edit(edit), OK, "undo")
	check_equal(tree.skeleton, before, "the tree after undo")
	check_equal(tree.apply_edit(edit), OK, "redo")
	check_equal(tree.edit_log, log, "the log after redo")


func test_says_what_is_wrong() -> void:
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	var tree: TreeReconstruction = reconstructor.reconstruct_file(write_scan("scan.xyz"))
	var points: PackedVector3Array = reconstructor.get_cloud_points()
	var before: Dictionary = tree.skeleton
	expect_error("no node 123456")
	check(tree.complete_branch(points, 123456, Vector3.UP) == null, "There is no such node.")
	expect_error("no length")
	check(tree.complete_branch(points, tree.get_root(), Vector3.ZERO) == null, "No direction.")
	expect_error("No points that the tree does not explain")
	check(tree.complete_branch(points, tree.get_root(), Vector3.DOWN) == null, "Nothing is there.")
	var preview: Dictionary = tree.preview_completion(points, tree.get_root(), Vector3.DOWN)
	check_sentence(preview["error"], "the preview's refusal")
	check_equal(preview["script"], "", "the script of nothing")
	expect_error("no points of wood")
	check(tree.complete_branch([], tree.get_root(), Vector3.UP) == null, "An empty cloud.")
	expect_error("a completion knows")
	check(
		tree.complete_branch(points, tree.get_root(), Vector3.UP, {"reech": 1.0}) == null,
		"A wrong option."
	)
	check_equal(tree.skeleton, before, "the tree")
