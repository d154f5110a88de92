extends "./suite.gd"
## TreeFidelity and TreeReconstruction.measure_fidelity().


func test_a_tree_is_faithful_to_points_on_its_bark() -> void:
	var made: TreeReconstruction = _stem()
	var points: PackedVector3Array = _ring_points(0.1, 2.0)
	var found: Dictionary = made.measure_fidelity(points)
	check_equal(found["points"], points.size(), "the points")
	check_equal(found["explained"], 1.0, "the share explained")
	check_equal(found["skeleton"], 1.0, "the share within the skeleton")
	check_near(found["coverage"], 1.0, 1e-6, "the coverage")
	check_equal(found["orders"].size(), 1, "the orders")
	var thick: Dictionary = made.measure_fidelity(_ring_points(0.15, 2.0))
	check_equal(thick["explained"], 0.0, "the share explained 5 cm away")
	check_near(thick["median"], 0.05, 1e-5, "the median")
	check_equal(made.measure_fidelity(_ring_points(0.15, 2.0), 0.06)["explained"], 1.0, "with 6 cm")


func test_it_follows_edits() -> void:
	var made: TreeReconstruction = _stem()
	var points: PackedVector3Array = _ring_points(0.1, 2.0)
	points.append_array(_side_points())
	var fidelity: TreeFidelity = TreeFidelity.new()
	check(fidelity.set_cloud(made, points), "The cloud was refused.")
	var before: Dictionary = fidelity.update(made)
	check_equal(fidelity.get_points_measured(), points.size(), "the points measured")
	check_equal(fidelity.get_previous(), {}, "the figures before the first")
	check_equal(fidelity.get_current(), before, "the figures")
	var missing: Array[Dictionary] = fidelity.get_unexplained()
	check_equal(missing.size(), 1, "the clusters")
	check(missing[0]["direction"].x > 0.9, "Its direction is %s." % missing[0]["direction"])
	check(fidelity.get_doubtful().is_empty(), "A branch is doubtful.")
	var data: Dictionary = made.skeleton.duplicate()
	var with_branch: TreeReconstruction = _stem(true)
	var after: Dictionary = fidelity.update(with_branch)
	check(after["explained"] > before["explained"], "The branch explains nothing.")
	check_equal(fidelity.get_previous(), before, "the figures before")
	check(fidelity.get_points_measured() < points.size(), "All was measured again.")
	check_equal(after, with_branch.measure_fidelity(points), "the figures measured at once")
	check(fidelity.get_unexplained().is_empty(), "Something is still missing.")
	check_equal(made.skeleton, data, "the tree")
	check_equal(fidelity.get_point_errors().size(), points.size(), "the errors")
	check_equal(fidelity.get_point_nodes().size(), points.size(), "the points' nodes")
	check_equal(fidelity.get_point_colors().size(), points.size(), "the colors")
	var nodes: int = with_branch.get_node_count()
	check_equal(fidelity.get_node_errors().size(), nodes, "the nodes' errors")
	check_equal(fidelity.get_node_colors().size(), nodes, "the nodes' colors")
	check_equal(fidelity.get_node_errors()[0], -1.0, "the root's error")
	check_equal(fidelity.get_branches().size(), 2, "the branches")
	var arrays: Array = fidelity.build_heat_mesh_arrays()
	var heat: PackedColorArray = arrays[Mesh.ARRAY_COLOR]
	check_equal(heat.size(), arrays[Mesh.ARRAY_VERTEX].size(), "the colors of the bark")
	check(heat[heat.size() / 2].b > heat[heat.size() / 2].r, "Bark on its points is not blue.")
	check_equal(fidelity.get_branches()[1]["order"], 1, "the order")
	var levels: Array[Dictionary] = fidelity.get_levels(2)
	check_equal(levels[0]["nodes"], nodes, "the nodes of the finest level")


func test_mistakes_get_a_sentence() -> void:
	var fidelity: TreeFidelity = TreeFidelity.new()
	expect_error("call set_cloud() first")
	check_equal(fidelity.update(_stem()), {}, "without a cloud")
	expect_error("call update() first")
	check(fidelity.get_point_errors().is_empty(), "There are errors of nothing.")
	expect_error("The point cloud is empty")
	check(not fidelity.set_cloud(_stem(), PackedVector3Array()), "An empty cloud was taken.")
	expect_error("no finite number")
	check(not fidelity.set_cloud(_stem(), [Vector3(NAN, 0, 0)]), "A point nowhere was taken.")
	expect_error("The tolerance of a fidelity")
	check(not fidelity.set_cloud(_stem(), [Vector3.ZERO], -1.0), "A negative tolerance was taken.")
	expect_error("no wood")
	check_equal(
		TreeReconstruction.new().measure_fidelity([Vector3.ZERO]), {}, "of a tree without wood"
	)
	check(fidelity.set_cloud(_stem(), _ring_points(0.1, 2.0)), "The cloud was refused.")
	fidelity.update(_stem())
	expect_error("There is no COLMAP model")
	check_equal(fidelity.measure_photos("res://nowhere", "res://nowhere"), {}, "without photos")
	expect_error("1 to 12 levels")
	fidelity.get_levels(0)


# A stem of 2 m and 10 cm of radius, with a branch to the right on request.
func _stem(branch: bool = false) -> TreeReconstruction:
	var nodes: Array[Array] = []
	for i: int in 11:
		nodes.append([i - 1, 0.0, 0.2 * i, 0.0, 0.1, NODE_TRUNK])
	if branch:
		nodes.append([5, 1.0, 1.0, 0.0, 0.03, 0])
	var made: TreeReconstruction = TreeReconstruction.new()
	made.skeleton = skeleton(nodes)
	return made


func _ring_points(radius: float, height: float) -> PackedVector3Array:
	var points: PackedVector3Array = []
	for row: int in int(height * 50):
		for k: int in 40:
			var angle: float = TAU * k / 40
			points.append(Vector3(radius * cos(angle), 0.01 + 0.02 * row, radius * sin(angle)))
	return points


func _side_points() -> PackedVector3Array:
	var points: PackedVector3Array = []
	for x: int in 80:
		for k: int in 10:
			var angle: float = TAU * k / 10
			points.append(Vector3(0.2 + 0.01 * x, 1 + 0.03 * cos(angle), 0.03 * sin(angle)))
	return points
