extends "./tools_suite.gd"
## The tool that sets the scale by a length that is known.

const Stages := preload("res://addons/tree_reconstruction/editor/dock/stages.gd")

var _stages: Stages


func _open() -> void:
	_begin(TreeReconstructor.new().reconstruct_file(write_scan("scan.xyz")), &"length")
	_stages = Stages.new(_session)
	tree.root.add_child(_stages)
	while _session.scan.points.is_empty():
		await _frame()


func _shut() -> void:
	_stages.close()
	_stages.free()
	_end()


# A point of the scan that nothing hides, near a height.
func _point_at(height: float) -> Vector3:
	var best: Vector3 = Vector3.INF
	for point: Vector3 in _session.scan.points:
		if absf(point.y - height) > 0.02:
			continue
		var eye: Vector3 = _session.node.global_transform.affine_inverse() * _camera.global_position
		if not best.is_finite() or point.distance_to(eye) < best.distance_to(eye):
			best = point
	return best


func test_two_clicks_and_a_length_set_the_scale() -> void:
	await _open()
	var settings: Control = _session.tool.make_settings()
	tree.root.add_child(settings)
	var places: PackedVector3Array = [_point_at(0.3), _point_at(1.2)]
	for place: Vector3 in places:
		var taken: bool = _click(_session.picker.project_place(_camera, place))
		check(taken, "The click was left to the editor.")
	check_equal(_session.tool.places.size(), 2, "places")
	for i: int in 2:
		check_near(_session.tool.places[i].distance_to(places[i]), 0.0, 0.05, "how far off")
	check(_session.tool._apply.disabled, "It takes no length for one.")
	var length: float = _session.tool.get_length()
	check_near(length, 0.9, 0.1, "the length")
	check(not _click(Vector2(3, 3)), "A click on nothing was taken.")
	var height: float = _session.tree.measure()["height"]
	var old: TreeReconstruction = _session.tree
	_session.tool._known.value = 3.0 * length
	check(not _session.tool._apply.disabled, "It can't be set.")
	_session.tool.apply()
	while not _session.jobs.get_running().is_empty():
		await _frame()
	await _frame()
	check_near(_session.tree.measure()["height"] / height, 3.0, 0.05, "how much higher the tree is")
	check_equal(_session.tool.places.size(), 0, "places of the old size")
	_undo.undo()
	check_near(_session.tree.measure()["height"], height, 1e-4, "the height after undo")
	check(old != null, "There was no tree.")
	settings.free()
	_shut()


func test_the_first_point_on_the_line_is_meant() -> void:
	var points: PackedVector3Array = [
		Vector3(0, 0, -9),
		Vector3(0.02, 0, -5),
		Vector3(0.01, 0, -5.05),
		Vector3(2, 0, -3),
		Vector3(0, 0, 4)
	]
	var ahead: Vector3 = Vector3(0, 0, -2)
	check_equal(TreeReconstructor.find_point(points, Vector3.ZERO, ahead, 0.1), 2, "the point")
	check_equal(
		TreeReconstructor.find_point(points, Vector3.ZERO, ahead, 0.0, 0.002), 2, "by distance"
	)
	check_equal(TreeReconstructor.find_point(points, Vector3.ZERO, Vector3.UP, 0.1), -1, "of none")
	check_equal(TreeReconstructor.find_point([], Vector3.ZERO, ahead, 0.1), -1, "of an empty cloud")
	expect_error("line of sight")
	check_equal(
		TreeReconstructor.find_point(points, Vector3.ZERO, Vector3.ZERO), -1, "without a way"
	)
