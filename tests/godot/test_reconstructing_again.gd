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


func test_the_cleaned_cloud_is_saved() -> void:
	# Far away, with a patch of ground and two strays in the air.
	var rows: PackedStringArray = []
	for row: String in FileAccess.get_file_as_string(write_scan("near.xyz")).split("\n"):
		var near: PackedFloat64Array = row.split_floats(" ")
		rows.append("%.5f %.5f %.5f" % [near[0] + 431455.0, near[1] + 5812345.0, near[2] + 60.0])
	var wood: int = rows.size()
	rows.append_array(
		["431461.25000 5812345.50000 63.00000", "431448.50000 5812342.25000 61.00000"]
	)
	var scan: String = write_text("far.xyz", "\n".join(rows))
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	var made: TreeReconstruction = reconstructor.reconstruct_file(scan, {"up": "z", "scale": 1.0})
	# An edit is no matter.
	made.edit("prune_order order=1")
	var text: String = folder.path_join("clean.xyz")
	check_equal(reconstructor.save_cloud(made, text), OK, reconstructor.get_error_message())
	check_equal(reconstructor.get_progress(), 1.0, "the progress")
	var known: Dictionary[String, bool] = {}
	for row: String in rows:
		known[_rounded(row)] = true
	var saved: PackedStringArray = FileAccess.get_file_as_string(text).strip_edges().split("\n")
	check(saved.size() <= wood and saved.size() > wood * 9 / 10, "%d are left" % saved.size())
	var strange: int = 0
	for row: String in saved:
		strange += 0 if known.has(_rounded(row)) else 1
	check_equal(strange, 0, "points that are not the scan's")
	check(not "431461.25" in " ".join(saved), "A stray is left.")
	# The program knows a PLY of ours by its header.
	var ply: String = folder.path_join("clean.ply")
	check_equal(TreeReconstructor.new().save_cloud(made, ply), OK, "a PLY")
	var header: String = FileAccess.get_file_as_bytes(ply).slice(0, 200).get_string_from_ascii()
	check("comment cleaned by treerec\nelement vertex %d\n" % saved.size() in header, header)
	# It is a scan again.
	var again: TreeReconstruction = reconstructor.reconstruct_file(ply, {"up": "z", "scale": 1.0})
	check(again != null, reconstructor.get_error_message())


func _rounded(row: String) -> String:
	var place: PackedFloat64Array = row.split_floats(" ")
	return "%.5f %.5f %.5f" % [place[0], place[1], place[2]]


func test_a_cleaned_cloud_that_can_t_be_saved() -> void:
	var scan: String = write_scan("scan.xyz")
	var before: String = FileAccess.get_file_as_string(scan)
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	var made: TreeReconstruction = reconstructor.reconstruct_file(scan)
	var why: Dictionary[String, String] = {
		scan: "the scan itself",
		folder.path_join("clean.glb"): "no name for a point cloud",
		folder.path_join("no/such/clean.ply"): "no folder",
	}
	for path: String in why:
		check_equal(reconstructor.save_cloud(made, path), FAILED, path)
		check(why[path] in reconstructor.get_error_message(), reconstructor.get_error_message())
		check_sentence(reconstructor.get_error_message(), path)
	check_equal(FileAccess.get_file_as_string(scan), before, "the scan")
	var clean: String = folder.path_join("clean.ply")
	reconstructor.cancel()
	check_equal(reconstructor.save_cloud(made, clean), FAILED, "a cancelled one")
	check_equal(reconstructor.get_error_message(), "Cancelled.", "why")
	check_equal(reconstructor.save_cloud(grown_tree(1), clean), FAILED, "without a source")
	check_sentence(reconstructor.get_error_message(), "without a source")
	expect_error("no tree")
	check_equal(reconstructor.save_cloud(null, clean), ERR_INVALID_PARAMETER, "no tree")
	check(not FileAccess.file_exists(clean), "Something was written.")


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
