extends "./suite.gd"
## The voxel flood, and its steps to be drawn.


func test_floods_and_tells_every_step() -> void:
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	var options: Dictionary = {"skeleton": "flood", "flood_steps": true, "voxel": 0.04}
	var made: TreeReconstruction = reconstructor.reconstruct_file(write_scan("scan.xyz"), options)
	check(made != null, "No tree: " + reconstructor.get_error_message())
	if made == null:
		return
	check_near(made.measure()["height"], 3.5, 0.2, "the height")
	check_equal(reconstructor.get_report()["voxel_m"], 0.04, "the voxels in the report")
	var count: int = reconstructor.get_flood_step_count()
	check(count > 10, "The flood took %d steps." % count)
	var box: AABB = made.get_aabb().grow(0.2)
	var grown: int = 0
	for i: int in count:
		var step: Dictionary = reconstructor.get_flood_step(i)
		check(box.has_point(step["position"]), "Step %d is off the tree." % i)
		check(step["voxels"].size() > 0, "Step %d has no voxels." % i)
		var directions: int = step["directions"].size()
		for list: String in ["lengths", "radii", "shares", "children"]:
			check_equal(step[list].size(), directions, "%s of step %d" % [list, i])
		for child: int in step["children"]:
			grown += 1 if child >= 0 else 0
	check(grown >= count - 1, "Only %d nodes were grown in %d steps." % [grown, count])
	check_equal(reconstructor.get_flood_step(0)["parent"], -1, "the root's parent")
	check(reconstructor.get_flood_step(count).is_empty(), "There is a step too many.")
	check(reconstructor.get_flood_step(-1).is_empty(), "There is a step before the first.")


func test_other_method_has_no_steps() -> void:
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	reconstructor.reconstruct_file(write_scan("scan.xyz"), {"flood_steps": true})
	check_equal(reconstructor.get_flood_step_count(), 0, "the steps")
	check(not reconstructor.get_report().has("voxel_m"), "There are voxels in the report.")


func test_bad_voxels_get_a_sentence() -> void:
	var path: String = write_scan("scan.xyz")
	for options: Dictionary in [
		{"skeleton": "flood", "voxel": 50.0},
		{"skeleton": "flood", "voxel": 1e-8},
		{"skeleton": "voxels"},
		{"skeleton": 3},
	]:
		var reconstructor: TreeReconstructor = TreeReconstructor.new()
		check(reconstructor.reconstruct_file(path, options) == null, "%s made a tree." % options)
		check_sentence(reconstructor.get_error_message(), str(options))
