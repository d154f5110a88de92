extends "./suite.gd"
## TreeReconstructor: from a scan to a tree, and everything that can be wrong with a scan.


func test_reconstructs_a_scan() -> void:
	var path: String = write_scan("scan.xyz")
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	var made: TreeReconstruction = reconstructor.reconstruct_file(
		path, {"seed": 3, "leaves": "oak"}
	)
	check(made != null, "No tree: " + reconstructor.get_error_message())
	if made == null:
		return
	check_equal(reconstructor.get_error_message(), "", "the error message")
	check_equal(reconstructor.get_progress(), 1.0, "the progress")
	check_equal(made.leaf_preset, "oak", "the preset")
	check_equal(made.seed, 3, "the seed")
	check_near(made.measure()["height"], 3.5, 0.2, "the height")
	check_near(made.measure()["dbh"], 0.137, 0.02, "the diameter")
	check(made.get_leaves().size() >= 4, "It has %d tips." % made.get_leaves().size())
	var cloud: PackedVector3Array = reconstructor.get_cloud_points()
	check(cloud.size() > 1000, "The cloud has %d points." % cloud.size())
	var box: AABB = made.get_aabb().grow(0.1)
	var outside: int = 0
	for point: Vector3 in cloud:
		outside += 0 if box.has_point(point) else 1
	check(outside * 100 < cloud.size(), "%d points lie off the tree." % outside)
	check(
		reconstructor.get_raw_skeleton().get_node_count() > made.get_node_count(),
		"Nothing was pruned."
	)
	var report: Dictionary = reconstructor.get_report()
	check(report.get("stages", []).size() > 3, "The report has no stages: %s" % report)
	check_equal(made.provenance["source"], path, "the source")


func test_saves_a_page_to_send_to_somebody() -> void:
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	var page: String = folder.path_join("report.html")
	check_equal(reconstructor.save_html_report(page), FAILED, "a report on nothing")
	check(
		reconstructor.get_error_message().contains("call reconstruct_file() first"), "No sentence."
	)
	reconstructor.reconstruct_file(write_scan("scan.xyz"))
	check_equal(reconstructor.save_html_report(page), OK, "the report")
	var html: String = FileAccess.get_file_as_string(page)
	check(html.begins_with("<!DOCTYPE html>") and html.ends_with("</html>\n"), "No page.")
	check_equal(html.count("data:image/png;base64,"), 6, "the pictures")
	check_equal(reconstructor.get_progress(), 1.0, "the progress")
	check(reconstructor.get_cloud_points().size() > 1000, "The cloud is gone.")
	check_equal(reconstructor.save_html_report("res://none/such/r.html"), FAILED, "in no folder")


func test_the_same_seed_gives_the_same_tree() -> void:
	var path: String = write_scan("scan.xyz")
	var trees: Array[TreeReconstruction] = []
	for i: int in 2:
		trees.append(TreeReconstructor.new().reconstruct_file(path, {"seed": 5}))
	check_equal(trees[0].skeleton, trees[1].skeleton, "the skeleton")


func test_bad_files_get_a_sentence() -> void:
	var garbage: PackedByteArray = []
	for i: int in 5000:
		garbage.append((i * 7919 + i / 13) % 256)
	var contents: Dictionary[String, Variant] = {
		"empty.xyz": "",
		"empty.ply": "",
		"words.txt": "this is not\na point cloud\n",
		"one.xyz": "1 2 3\n",
		"three.xyz": "0 0 0\n0 0 1\n0 0 2\n",
		"nan.xyz": "nan nan nan\n".repeat(100),
		"garbage.ply": garbage,
		"garbage.las": garbage,
		"garbage.xyz": garbage,
		"cut.ply": "ply\nformat ascii 1.0\nelement vertex 1000\nproperty float x\n",
		"scan.unknown": "0 0 0\n",
	}
	for name: String in contents:
		var path: String = folder.path_join(name)
		var file: FileAccess = FileAccess.open(path, FileAccess.WRITE)
		if contents[name] is String:
			file.store_string(contents[name])
		else:
			file.store_buffer(contents[name])
		file.close()
		_check_refusal(path)
	_check_refusal(folder.path_join("missing.ply"))
	_check_refusal(folder)


func _check_refusal(path: String) -> void:
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	var made: TreeReconstruction = reconstructor.reconstruct_file(path)
	check(made == null, "%s became a tree." % path.get_file())
	check_sentence(reconstructor.get_error_message(), path.get_file())


func test_bad_options_get_a_sentence() -> void:
	var path: String = write_scan("scan.xyz", 200)
	for options: Dictionary in [
		{"leaves": "no such leaf"},
		{"no such option": 1},
		{"spacing": NAN},
		{"spacing": -1.0},
		{"up": "sideways"},
		{"seed": "seven"},
		{"scale": -3.0},
		{"tree_number": 0},
		{"tree_position": PackedFloat64Array([1.0, NAN, 2.0])},
		{"known_height": -1.0},
		{"known_height": 5.0, "scale": 1.0},
		{"known_length": PackedFloat64Array([1.0, 2.0, 3.0])},
		{"known_length": PackedFloat64Array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])},
	]:
		var reconstructor: TreeReconstructor = TreeReconstructor.new()
		var made: TreeReconstruction = reconstructor.reconstruct_file(path, options)
		check(made == null, "%s was accepted." % options)
		check_sentence(reconstructor.get_error_message(), str(options))


func test_can_be_cancelled() -> void:
	var path: String = write_scan("scan.xyz", 40000)
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	var made: Array[TreeReconstruction] = [TreeReconstruction.new()]
	var task: int = WorkerThreadPool.add_task(
		func() -> void: made[0] = reconstructor.reconstruct_file(path)
	)
	while reconstructor.get_progress() <= 0.0 and not WorkerThreadPool.is_task_completed(task):
		await tree.process_frame
	reconstructor.cancel()
	WorkerThreadPool.wait_for_task_completion(task)
	check(made[0] == null, "It went on to the end.")
	check("ancelled" in reconstructor.get_error_message(), "It does not say that it was cancelled.")
	await tree.process_frame


func test_a_cancel_before_the_start_is_heard() -> void:
	var path: String = write_scan("scan.xyz")
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	reconstructor.cancel()
	check(reconstructor.reconstruct_file(path) == null, "The cancel was lost.")
	check("ancelled" in reconstructor.get_error_message(), "It does not say that it was cancelled.")
	check(reconstructor.reconstruct_file(path) != null, "The cancel outlived its call.")
	var model: String = folder.path_join("cancelled.glb")
	reconstructor.cancel()
	check_equal(reconstructor.export_file(grown_tree(3), model), FAILED, "a cancelled export")
	check(not FileAccess.file_exists(model), "A cancelled export left a file.")
	check_equal(reconstructor.export_file(grown_tree(3), model), OK, "the export after it")


func test_a_known_size_sets_the_scale() -> void:
	var path: String = write_scan("scan.xyz")
	var length: PackedFloat64Array = [0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 4.0]
	for options: Dictionary in [{"known_height": 7.0}, {"known_length": length}]:
		var reconstructor: TreeReconstructor = TreeReconstructor.new()
		var made: TreeReconstruction = reconstructor.reconstruct_file(path, options)
		check(made != null, "No tree: " + reconstructor.get_error_message())
		if made != null:
			check_near(made.measure()["height"], 7.0, 0.4, "the height with %s" % options)
		check_equal(reconstructor.get_report().get("scale_guessed"), false, "whether it is a guess")


func test_reports_progress() -> void:
	var path: String = write_scan("scan.xyz")
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	var fractions: PackedFloat64Array = []
	var stages: Dictionary[String, bool] = {}
	reconstructor.progress_changed.connect(
		func(fraction: float, stage: String) -> void:
			fractions.append(fraction)
			stages[stage] = true
	)
	var task: int = WorkerThreadPool.add_task(func() -> void: reconstructor.reconstruct_file(path))
	while not WorkerThreadPool.is_task_completed(task):
		await tree.process_frame
	WorkerThreadPool.wait_for_task_completion(task)
	await tree.process_frame
	await tree.process_frame
	check(fractions.size() >= 3, "It told of progress %d times." % fractions.size())
	check(stages.size() >= 3, "It named these stages: %s" % [stages.keys()])
	for i: int in range(1, fractions.size()):
		check(fractions[i] >= fractions[i - 1], "The progress went back.")


func test_exports_and_reads_back() -> void:
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	var made: TreeReconstruction = grown_tree(3)
	for extension: String in ["glb", "gltf", "obj", "ply", "txt", "csv"]:
		var path: String = folder.path_join("tree." + extension)
		check_equal(
			reconstructor.export_file(made, path),
			OK,
			"%s (%s)" % [extension, reconstructor.get_error_message()]
		)
		check(FileAccess.get_file_as_bytes(path).size() > 1000, "%s is too small." % extension)
	for extension: String in ["ply", "txt"]:
		var read: TreeReconstruction = reconstructor.import_skeleton(
			folder.path_join("tree." + extension)
		)
		check(read != null, "%s: %s" % [extension, reconstructor.get_error_message()])
		if read != null:
			check_equal(read.get_node_count(), made.get_node_count(), "the nodes from " + extension)
	check_equal(reconstructor.export_file(made, folder.path_join("tree.blend")), FAILED, "a .blend")
	check_sentence(reconstructor.get_error_message(), "the message for .blend")
	check(
		reconstructor.import_skeleton(folder.path_join("nowhere.txt")) == null, "It read nothing."
	)
	check_sentence(reconstructor.get_error_message(), "the message for a missing file")


func test_reads_skeletons_of_other_programs() -> void:
	var twig: Array[Vector3] = [
		Vector3(0, 0, 0), Vector3(0, 0, 1), Vector3(0.5, 0, 2), Vector3(-0.5, 0, 2)
	]
	var below: Array[int] = [-1, 0, 1, 1]
	var swc: String = "# by hand\n"
	var forest: String = (
		"ID, parentID, startX, startY, startZ, endX, endY, endZ, radius, " + "branchOrder\n"
	)
	var graph: String = (
		"ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
		+ "property float z\nproperty float radius\nelement edge 3\n"
		+ "property list uint32 int vertex_indices\nend_header\n"
	)
	var edges: String = ""
	for i: int in twig.size():
		var at: Vector3 = twig[i]
		swc += "%d 0 %f %f %f 0.1 %d\n" % [i + 1, at.x, at.y, at.z, below[i] + 1 if i > 0 else -1]
		graph += "%f %f %f 0.1\n" % [at.x, at.y, at.z]
		if i > 0:
			var from: Vector3 = twig[below[i]]
			edges += "2 %d %d\n" % [i, below[i]]
			forest += (
				"%d,%d,%f,%f,%f,%f,%f,%f,0.1,0\n"
				% [i - 1, below[i] - 1, from.x, from.y, from.z, at.x, at.y, at.z]
			)
	var files: Dictionary[String, String] = {"a.swc": swc, "b.csv": forest, "c.ply": graph + edges}
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	for file: String in files:
		write_text(file, files[file])
		var read: TreeReconstruction = reconstructor.import_skeleton(folder.path_join(file))
		check(read != null, "%s: %s" % [file, reconstructor.get_error_message()])
		if read != null:
			check_equal(read.get_node_count(), 4, "the nodes of " + file)
			check_equal(read.get_leaves().size(), 2, "the tips of " + file)
			check(absf(read.get_aabb().end.y - 2.0) < 0.2, "%s lies down." % file)
		read = reconstructor.import_skeleton(folder.path_join(file), "x")
		check(read != null and read.get_aabb().size.y < 1.5, "%s does not lie down." % file)
		check(reconstructor.import_skeleton(folder.path_join(file), "up") == null, "No such axis.")
		check_sentence(reconstructor.get_error_message(), "the message for a wrong axis")


func test_reads_the_tree_of_a_file_that_is_asked_for() -> void:
	write_text(
		"two.txt",
		(
			"x,y,z,radius,parent_id\n0,0,0,0.1,-1, 0,0,3,0.1,0\n"
			+ "5,0,0,0.2,-1, 5,0,2,0.1,0, 5,0,4,0.1,1\n"
		)
	)
	var path: String = folder.path_join("two.txt")
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	var nodes: Array[int] = [3, 2, 3]  # the largest, and by number
	for number: int in nodes.size():
		var read: TreeReconstruction = reconstructor.import_skeleton(path, "z", number)
		check_equal(read.get_node_count(), nodes[number], "the nodes of tree %d" % number)
		var report: Dictionary = reconstructor.get_report()
		check_equal(report["trees"], 2.0, "the trees")
		check_equal((report["warnings"] as Array).size(), 1 if number == 0 else 0, "what is said")
	for number: int in [-1, 3]:
		check(reconstructor.import_skeleton(path, "z", number) == null, "There is no such tree.")
		check_sentence(reconstructor.get_error_message(), "the message for tree %d" % number)


# As the command does to the tree that comes without.
func test_long_twigs_are_cut_where_asked() -> void:
	var path: String = write_scan("long_twigs.xyz")
	var plain: TreeReconstruction = TreeReconstructor.new().reconstruct_file(path)
	check_equal(
		TreeReconstructor.new().reconstruct_file(path, {"prune": "none"}).skeleton,
		plain.skeleton,
		"the default"
	)
	for rule: String in ["paper", "leader"]:
		var pruned: TreeReconstruction = TreeReconstructor.new().reconstruct_file(
			path, {"prune": rule}
		)
		check_equal(pruned.provenance["options"]["prune"], rule, "the provenance")
		var expected: TreeReconstruction = plain.duplicate()
		expected.edit("prune spare_leader=" + ("yes" if rule == "leader" else "no"))
		check(expected.get_node_count() < plain.get_node_count(), "%s cuts nothing." % rule)
		check_equal(pruned.get_node_count(), expected.get_node_count(), rule)
		check_equal(pruned.get_aabb(), expected.get_aabb(), "the size by " + rule)
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	check(reconstructor.reconstruct_file(path, {"prune": "some"}) == null, "'some' was taken.")
	check_sentence(reconstructor.get_error_message(), "the message")


func test_options_are_described() -> void:
	var options: Array[Dictionary] = TreeReconstructor.get_option_list()
	check(options.size() > 8, "There are %d options." % options.size())
	for option: Dictionary in options:
		check_sentence(option.get("description", ""), str(option.get("name")))
		check(option.has("default"), "%s has no default." % option.get("name"))
	var path: String = write_scan("scan.xyz")
	var defaults: Dictionary = {}
	for option: Dictionary in options:
		defaults[option["name"]] = option["default"]
	var plain: TreeReconstruction = TreeReconstructor.new().reconstruct_file(path)
	var spelt_out: TreeReconstruction = TreeReconstructor.new().reconstruct_file(path, defaults)
	check_equal(spelt_out.skeleton, plain.skeleton, "the tree with all defaults spelt out")


func test_a_marker_is_saved_to_print() -> void:
	var worker: TreeReconstructor = TreeReconstructor.new()
	var path: String = folder.path_join("marker.png")
	check_equal(worker.save_marker(path, 3, 0.1), OK, "saving a marker")
	check_equal(Image.load_from_file(path).get_size(), Vector2i(2480, 3508), "A4 at 300 dpi")
	check_equal(worker.save_marker(folder.path_join("marker.svg")), OK, "saving the usual one")
	for wrong: Array in [["marker.txt", 0, 0.1], ["marker.svg", 50, 0.1], ["marker.svg", -1, 0.1]]:
		check_equal(
			worker.save_marker(folder.path_join(wrong[0]), wrong[1], wrong[2]), FAILED, str(wrong)
		)
	for side: float in [0.0, -1.0, NAN, INF, 0.7]:
		check_equal(worker.save_marker(path, 0, side), FAILED, "a side of %f" % side)
		check("side is from 20 to 600 mm" in worker.get_error_message(), worker.get_error_message())
