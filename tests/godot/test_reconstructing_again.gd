extends "./suite.gd"
## A TreeReconstructor used again: what it keeps, and how it loads the scan of a tree.


func _kept(reconstructor: TreeReconstructor) -> PackedStringArray:
	var names: PackedStringArray = []
	for stage: Dictionary in reconstructor.get_report()["stages"]:
		if stage.get("kept", false):
			names.append(stage["name"])
	return names


func test_a_second_run_begins_where_the_options_differ() -> void:
	var path: String = write_scan("scan.xyz")
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	check_equal(reconstructor.get_cache_size(), 0, "the cache at first")
	reconstructor.reconstruct_file(path)
	check(_kept(reconstructor).is_empty(), "A first run kept something.")
	check(reconstructor.get_cache_size() > 100000, "Nothing is kept for the next run.")
	var again: TreeReconstruction = reconstructor.reconstruct_file(path, {"minimum_branch": 0.5})
	check_equal(
		_kept(reconstructor),
		PackedStringArray(["Read", "Orient", "Clean", "Leaves"]),
		"what is kept"
	)
	var fresh: TreeReconstruction = TreeReconstructor.new().reconstruct_file(
		path, {"minimum_branch": 0.5}
	)
	check_equal(again.skeleton, fresh.skeleton, "the skeleton")
	check_equal(again.foliage, fresh.foliage, "the foliage")
	reconstructor.reconstruct_file(path, {"minimum_branch": 0.5, "remove_outliers": false})
	check_equal(_kept(reconstructor), PackedStringArray(["Read"]), "with another cleaning")
	reconstructor.clear_cache()
	check_equal(reconstructor.get_cache_size(), 0, "the cache after it was cleared")
	reconstructor.reconstruct_file(path, {"minimum_branch": 0.5})
	check(_kept(reconstructor).is_empty(), "The cache was not cleared.")


func test_the_scan_of_a_tree_is_loaded() -> void:
	var path: String = write_scan("scan.xyz")
	var first: TreeReconstructor = TreeReconstructor.new()
	var made: TreeReconstruction = first.reconstruct_file(path, {"known_height": 7.0})
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	check(reconstructor.load_cloud(made), reconstructor.get_error_message())
	var all: PackedVector3Array = reconstructor.get_cloud_points()
	check_near(all.size(), first.get_cloud_points().size(), 50, "the number of points")
	var box: AABB = made.get_aabb().grow(0.2)
	var outside: int = 0
	for point: Vector3 in all:
		outside += 0 if box.has_point(point) else 1
	check(outside * 100 < all.size(), "%d points lie off the tree." % outside)
	check_equal(reconstructor.get_progress(), 1.0, "the progress")
	check(reconstructor.load_cloud(made, 2000), reconstructor.get_error_message())
	var thin: PackedVector3Array = reconstructor.get_cloud_points()
	check(thin.size() <= 2000 and thin.size() > 1000, "%d points are left." % thin.size())
	check(reconstructor.get_cloud_colors().is_empty(), "Points without colours have some.")
	# What fails leaves the points as they are.
	reconstructor.cancel()
	check(not reconstructor.load_cloud(made), "A cancelled one was loaded.")
	check_equal(reconstructor.get_error_message(), "Cancelled.", "why")
	check(not reconstructor.load_cloud(made, 10), "Ten points are too few.")
	check_sentence(reconstructor.get_error_message(), "too few")
	check_equal(reconstructor.get_cloud_points(), thin, "the points")


func test_a_tree_without_its_scan() -> void:
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	check(not reconstructor.load_cloud(grown_tree(1)), "A scan came from nowhere.")
	check_sentence(reconstructor.get_error_message(), "without a source")
	var made: TreeReconstruction = grown_tree(2)
	made.provenance = {"source": folder.path_join("gone.ply")}
	check(not reconstructor.load_cloud(made), "A missing file was loaded.")
	check("gone.ply" in reconstructor.get_error_message(), reconstructor.get_error_message())
	expect_error("no tree")
	check(not reconstructor.load_cloud(null), "Nothing was loaded.")
	# A skeleton from a file is no cloud.
	var path: String = folder.path_join("tree.txt")
	reconstructor.export_file(made, path)
	var imported: TreeReconstruction = reconstructor.import_skeleton(path)
	check(not reconstructor.load_cloud(imported), "A skeleton was loaded as points.")
	check_sentence(reconstructor.get_error_message(), "a skeleton")
