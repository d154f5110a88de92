extends "./suite.gd"
## TreeReconstructor.sketch_branch(): a branch that was cut away is drawn anew over its scan.

const BranchScan := preload("./branch_scan.gd")
const _FROM: Vector3 = Vector3(0.4, 0.1, 1.0)


func test_a_branch_is_drawn_where_it_was() -> void:
	var given: BranchScan = BranchScan.new(write_scan("scan.xyz"))
	var camera: Dictionary = given.look(_FROM)
	var before: Dictionary = given.tree.skeleton
	var without: float = given.tree.measure_fidelity(given.points)["explained"]
	check(without < given.explained - 0.02, "Hardly anything was lost with the branch.")
	var maker: TreeReconstructor = TreeReconstructor.new()
	var branch: Dictionary = maker.sketch_branch(
		given.tree, camera, given.stroke(camera), given.points
	)
	check(not branch.is_empty(), maker.get_error_message())
	if branch.is_empty():
		return
	check_equal(given.tree.skeleton, before, "the tree before the edit")
	check_equal(maker.get_progress(), 1.0, "the progress in the end")
	var axis: PackedVector3Array = branch["axis"]
	check(axis.size() > 3, "The axis has %d places." % axis.size())
	check_equal((branch["radii"] as PackedFloat32Array).size(), axis.size(), "the number of radii")
	var shown: PackedByteArray = branch["shown"]
	check_equal(shown.size(), axis.size(), "the number of marks")
	for i: int in axis.size():
		if shown[i] == 1:
			var off: float = given.distance_to(axis[i])
			check(off < 0.05, "Place %d lies %.3f m beside the branch." % [i, off])
	check(branch["measured"] > 0.6, "Only %.2f of it is measured." % branch["measured"])
	check(
		absf(branch["length"] - BranchScan._length(given.axis)) < 0.25, "It is as long as it was."
	)
	check(
		branch["host"] == given.joint or given.tree.has_node(branch["host"]),
		"It grows from nothing."
	)
	var as_ever: Dictionary = maker.draw_limb(
		given.tree, camera, given.stroke(camera), given.points
	)
	check_equal(as_ever, branch, "what the method of the old name makes")
	# One ordinary edit.
	var edit: TreeEdit = given.tree.edit(branch["command"])
	check(edit != null and not edit.is_empty(), "The command does nothing.")
	var after: Dictionary = given.tree.skeleton
	var log: String = given.tree.edit_log
	var again: float = given.tree.measure_fidelity(given.points)["explained"]
	check(
		again > without + 0.6 * (given.explained - without),
		"%f was explained, %f without it, %f again" % [given.explained, without, again]
	)
	check_equal(given.tree.revert_edit(edit), OK, "undo")
	check_equal(given.tree.skeleton, before, "the tree after undo")
	check_equal(given.tree.apply_edit(edit), OK, "redo")
	check_equal(given.tree.skeleton, after, "the tree after redo")
	check_equal(given.tree.edit_log, log, "the log after redo")


func test_options_say_how() -> void:
	var given: BranchScan = BranchScan.new(write_scan("scan.xyz"))
	var camera: Dictionary = given.look(_FROM)
	var line: PackedVector2Array = given.stroke(camera)
	var maker: TreeReconstructor = TreeReconstructor.new()
	var bare: Dictionary = maker.sketch_branch(
		given.tree, camera, line, given.points, {"twigs": false, "seed": 3, "jitter": 4}
	)
	check_equal(bare.get("twigs"), 0, "twigs")
	# The principal point is the middle unless it is told, and a size may have fractions.
	camera["principal"] = Vector2(camera["size"] as Vector2i) * 0.5
	camera["size"] = Vector2(camera["size"] as Vector2i)
	camera["focal"] = 900
	var same: Dictionary = maker.sketch_branch(
		given.tree, camera, line, given.points, {"twigs": false, "seed": 3, "jitter": 4}
	)
	check_equal(same, bare, "the branch with a principal point")
	var guessed: Dictionary = maker.sketch_branch(given.tree, camera, line)
	check_equal(guessed.get("measured"), 0.0, "what is measured without a scan")
	check("There is no scan" in str(guessed.get("remarks")), "It is not said that it is a guess.")


func test_says_what_is_wrong() -> void:
	var given: BranchScan = BranchScan.new(write_scan("scan.xyz"))
	var camera: Dictionary = given.look(_FROM)
	var line: PackedVector2Array = given.stroke(camera)
	var cases: Array[Array] = [
		[{}, line, {}, 'has no "transform"'],
		[_with(camera, "transform", Vector3.ONE), line, {}, 'has no "transform"'],
		[_with(camera, "focal", "wide"), line, {}, 'has no "focal"'],
		[_with(camera, "size", 800), line, {}, 'has no "size"'],
		[_with(camera, "principal", []), line, {}, 'has no "principal"'],
		[_with(camera, "focal", NAN), line, {}, "is no camera"],
		[_with(camera, "focal", 0.0), line, {}, "is no camera"],
		[_with(camera, "size", Vector2(INF, NAN)), line, {}, "is no camera"],
		[_with(camera, "size", Vector2i(0, 10)), line, {}, "is no camera"],
		[
			_with(camera, "transform", Transform3D(Basis.from_scale(Vector3(1, 2, 1)))),
			line,
			{},
			"is no camera"
		],
		[_with(camera, "transform", Transform3D(Basis.FLIP_X)), line, {}, "is no camera"],
		[camera, PackedVector2Array(), {}, "no points"],
		[camera, PackedVector2Array([Vector2(400, NAN)]), {}, "no place in the picture"],
		[camera, PackedVector2Array([Vector2(400, 400)]), {}, "too short"],
		[camera, _moved(line, Vector2(5000, 0)), {}, "outside of the picture"],
		[camera, _moved(line, Vector2(-300, 0)), {}, "near no wood"],
		[_with(camera, "transform", _turned(camera)), line, {}, "behind the camera"],
		[camera, line, {"jitter": 0.0}, "jitter"],
		[camera, line, {"tolerance": 2.0}, "tolerance"],
		[camera, line, {"seed": "one"}, "of another type"],
		[camera, line, {"twigs": 1.5}, "of another type"],
		[camera, line, {"leaves": true}, "There is no option"],
	]
	var before: Dictionary = given.tree.skeleton
	var maker: TreeReconstructor = TreeReconstructor.new()
	for case: Array in cases:
		var branch: Dictionary = maker.sketch_branch(
			given.tree, case[0], case[1], given.points, case[2]
		)
		check_equal(branch, {}, "what came of '%s'" % case[3])
		var sentence: String = maker.get_error_message()
		check_sentence(sentence, case[3])
		check(case[3] in sentence, "'%s' is said for '%s'." % [sentence, case[3]])
	var nowhere: PackedVector3Array = [Vector3(0, NAN, 0)]
	check_equal(
		maker.sketch_branch(given.tree, camera, line, nowhere), {}, "a point that is nowhere"
	)
	check("is nowhere" in maker.get_error_message(), maker.get_error_message())
	check_equal(given.tree.skeleton, before, "the tree")
	check_equal(maker.sketch_branch(TreeReconstruction.new(), camera, line), {}, "no tree")
	check_sentence(maker.get_error_message(), "an empty tree")
	expect_error("There is no tree to hang a branch on.")
	check_equal(maker.sketch_branch(null, camera, line), {}, "none at all")


func test_it_can_be_cancelled() -> void:
	var given: BranchScan = BranchScan.new(write_scan("scan.xyz"))
	var camera: Dictionary = given.look(_FROM)
	var line: PackedVector2Array = given.stroke(camera)
	var maker: TreeReconstructor = TreeReconstructor.new()
	maker.cancel()
	check_equal(
		maker.sketch_branch(given.tree, camera, line, given.points), {}, "what was cancelled"
	)
	check("ancel" in maker.get_error_message(), maker.get_error_message())
	check(
		not maker.sketch_branch(given.tree, camera, line, given.points).is_empty(),
		"The cancel was not over with that call."
	)


static func _with(camera: Dictionary, key: String, value: Variant) -> Dictionary:
	var other: Dictionary = camera.duplicate()
	other[key] = value
	return other


static func _moved(line: PackedVector2Array, by: Vector2) -> PackedVector2Array:
	return Transform2D(0.0, by) * line


static func _turned(camera: Dictionary) -> Transform3D:
	var pose: Transform3D = camera["transform"]
	return pose.rotated_local(Vector3.UP, PI)
