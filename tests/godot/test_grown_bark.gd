extends "./suite.gd"
## Bark that grows: TreeReconstructor.grow_bark(), and what a TreeReconstruction makes of it.

const RECIPE: String = "edges longest=0.08\nburl along=0.8 around=0 radius=0.3 growth=0.9\n"


## A trunk as thick as an arm is long, with two branches and a thin branch that stays a tube.
static func stout() -> TreeReconstruction:
	var nodes: Array[Array] = [[-1, 0.0, 0.0, 0.0, 0.16, NODE_TRUNK]]
	for i: int in range(1, 11):
		nodes.append([i - 1, 0.01 * i, 0.2 * i, 0.0, 0.16 - 0.008 * i, NODE_TRUNK])
	for branch: int in 2:
		var way: float = 1.0 - 2.0 * branch
		for i: int in range(1, 5):
			var parent: int = 5 + 3 * branch if i == 1 else nodes.size() - 1
			nodes.append(
				[parent, 0.06 + 0.18 * way * i, 1.0 + 0.6 * branch + 0.12 * i, 0.05 * i, 0.07, 0]
			)
	nodes.append([7, 0.07, 1.5, 0.4, 0.006, 0])
	var made: TreeReconstruction = TreeReconstruction.new()
	made.skeleton = skeleton(nodes)
	made.leaf_preset = "none"
	return made


func _grown(of: TreeReconstruction, recipe: String = RECIPE) -> TreeReconstruction:
	var maker: TreeReconstructor = TreeReconstructor.new()
	var made: TreeReconstruction = maker.grow_bark(of, recipe)
	check(made != null, maker.get_error_message())
	return made


# How far from the trunk's base the bark of a level reaches along +X at a height.
static func _reach(of: TreeReconstruction, height: float, level: int = 0) -> float:
	var arrays: Array = of.build_mesh_arrays(level)
	var places: PackedVector3Array = arrays[Mesh.ARRAY_VERTEX]
	var indices: PackedInt32Array = arrays[Mesh.ARRAY_INDEX]
	var far: float = 0.0
	for i: int in range(0, indices.size(), 3):
		var hit: Variant = Geometry3D.ray_intersects_triangle(
			Vector3(0.0, height, 0.003),
			Vector3.RIGHT,
			places[indices[i]],
			places[indices[i + 1]],
			places[indices[i + 2]]
		)
		if hit is Vector3:
			far = maxf(far, (hit as Vector3).x)
	return far


func test_bark_grows_and_is_drawn_instead_of_tubes() -> void:
	var of: TreeReconstruction = stout()
	var tubes: float = _reach(of, 0.8)
	var maker: TreeReconstructor = TreeReconstructor.new()
	var stages: PackedStringArray = []
	var on_progress: Callable = func(_fraction: float, stage: String) -> void: stages.append(stage)
	maker.progress_changed.connect(on_progress)
	var made: TreeReconstruction = maker.grow_bark(of, RECIPE)
	await tree.process_frame
	check("Growing bark" in stages, "The stages are %s." % stages)
	check(made != null and made.has_grown_bark(), maker.get_error_message())
	check(not made.is_bark_stale(), "It does not fit the tree that it grew on.")
	check(not of.has_grown_bark(), "The tree that was given has changed.")
	check_equal(made.skeleton, of.skeleton, "the wood")
	check_equal(made.leaf_preset, "none", "the leaves")
	var burl: float = _reach(made, 0.8)
	check(burl > tubes + 0.06, "The burl is %f high over a tube of %f m." % [burl - tubes, tubes])
	for lod: int in range(1, 4):
		check_near(_reach(made, 0.8, lod), burl, 0.04, "the burl at level %d" % lod)
	var levels: Array[Dictionary] = made.build_levels([0, 1])
	var finest: Array = levels[0].bark
	check_equal(
		(finest[Mesh.ARRAY_VERTEX] as PackedVector3Array).size(),
		(made.build_mesh_arrays(0)[Mesh.ARRAY_VERTEX] as PackedVector3Array).size(),
		"vertices of the level"
	)
	var box: AABB = levels[0].box
	check(box.end.x >= burl, "The box %s is without the burl." % box)
	var report: Dictionary = maker.get_report()
	check_equal(int(report.branches), 3, "branches that are covered")
	check(report.vertices > 200 and report.triangles == 2 * report.vertices - 4, str(report))
	check_equal(report.warnings, [], "warnings")
	check(maker.get_progress() == 1.0, "The progress ends at %f." % maker.get_progress())
	check_equal(_grown(of).grown_bark, made.grown_bark, "the same bark once more")


func test_it_is_saved_and_loaded() -> void:
	var made: TreeReconstruction = _grown(stout())
	for path: String in [folder.path_join("tree.tres"), folder.path_join("tree.res")]:
		ResourceSaver.save(made, path)
		var back: TreeReconstruction = ResourceLoader.load(
			path, "", ResourceLoader.CACHE_MODE_IGNORE
		)
		check_equal(back.growth_recipe, made.growth_recipe, "the recipe")
		check(back.has_grown_bark() and not back.is_bark_stale(), "There is no bark in %s." % path)
		check_equal(back.build_mesh_arrays(0), made.build_mesh_arrays(0), "the mesh")
	var copy: TreeReconstruction = made.duplicate() as TreeReconstruction
	check_equal(copy.build_mesh_arrays(0), made.build_mesh_arrays(0), "a copy's mesh")
	var vertices: int = (made.build_mesh_arrays(0)[Mesh.ARRAY_VERTEX] as PackedVector3Array).size()
	check(made.grown_bark.size() < 45 * vertices, "It takes %d bytes." % made.grown_bark.size())


func test_an_edit_of_covered_wood_shows_tubes_until_it_is_undone() -> void:
	var made: TreeReconstruction = _grown(stout())
	var grown: Array = made.build_mesh_arrays(0)
	var revision: int = made.get_bark_revision()
	var thin: TreeEdit = made.edit("cut node=19")
	check(not made.is_bark_stale(), "A thin branch's end has made it stale.")
	made.revert_edit(thin)
	var edit: TreeEdit = made.edit("cut node=13")
	check(made.is_bark_stale(), "A branch's end has not made it stale.")
	var bare: TreeReconstruction = made.duplicate() as TreeReconstruction
	bare.grown_bark = []
	check(not bare.has_grown_bark() and not bare.is_bark_stale(), "Without bark it is stale.")
	for lod: int in 3:
		check_equal(
			made.build_mesh_arrays(lod), bare.build_mesh_arrays(lod), "the tubes of level %d" % lod
		)
	check(made.get_bark_revision() != revision, "Nobody is told that the bark is another.")
	made.revert_edit(edit)
	check(not made.is_bark_stale(), "It is stale after undo.")
	check_equal(made.build_mesh_arrays(0), grown, "the mesh after undo")
	made.apply_edit(edit)
	check(made.is_bark_stale(), "It fits after redo.")
	var again: TreeReconstruction = _grown(made, made.growth_recipe)
	check(not again.is_bark_stale(), "It is stale after it has grown again.")


func test_a_node_shows_it_at_all_levels() -> void:
	var made: TreeReconstruction = _grown(stout())
	var tubes: TreeReconstruction = stout()
	var node: TreeInstance3D = TreeInstance3D.new()
	node.reconstruction = made
	tree.root.add_child(node)
	await node.rebuilt
	for lod: int in range(1, 4):
		check(
			_reach(made, 0.8, lod) > _reach(tubes, 0.8, lod) + 0.04,
			"Level %d shows a tube: %f." % [lod, _reach(made, 0.8, lod)]
		)
		var level: Dictionary = made.build_levels([lod])[0]
		var finer: Dictionary = made.build_levels([lod - 1])[0]
		check(level.triangles < 0.6 * finer.triangles, "Level %d: %s" % [lod, level.triangles])
	var budget: Dictionary = made.build_levels([0], [300])[0]
	check(budget.triangles <= 300, "A budget of 300 gives %d." % budget.triangles)
	# Not while it says that it has ended.
	await tree.process_frame
	node.free()


func test_setting_bark_alone_makes_the_tree_anew() -> void:
	var of: TreeReconstruction = stout()
	var made: TreeReconstruction = _grown(of)
	var node: TreeInstance3D = TreeInstance3D.new()
	node.lod = 0
	node.reconstruction = of
	tree.root.add_child(node)
	await node.rebuilt
	var tubes: int = node.get_triangle_count()
	of.grown_bark = made.grown_bark
	await node.rebuilt
	check(node.get_triangle_count() != tubes, "The node still shows tubes.")
	of.grown_bark = []
	await node.rebuilt
	check_equal(node.get_triangle_count(), tubes, "triangles without bark")
	# Not while it says that it has ended.
	await tree.process_frame
	node.free()


func test_variants_and_felled_wood_have_tubes() -> void:
	var made: TreeReconstruction = _grown(stout())
	check(not made.make_variant(1).has_grown_bark(), "A variant has grown bark.")
	var node: TreeInstance3D = TreeInstance3D.new()
	node.reconstruction = made
	tree.root.add_child(node)
	await node.rebuilt
	await tree.process_frame
	var body: RigidBody3D = node.fell(4)
	var top: TreeReconstruction = (body.get_child(0) as TreeInstance3D).reconstruction
	check(not top.has_grown_bark(), "What was felled has grown bark.")
	check(node.reconstruction.is_bark_stale(), "The stump's bark is that of the whole tree.")
	check(not made.is_bark_stale(), "The tree itself has changed.")
	body.free()
	node.free()


func test_bad_recipes_and_trees_get_sentences() -> void:
	var maker: TreeReconstructor = TreeReconstructor.new()
	var wrong: Dictionary[String, String] = {
		"burl along=high": "along",
		"edges longest=0.05\nlump along=1": "Line 2",
		"edges longest=0.05 shortest=0.04": "half",
		"burl node=900": "900",
		"burl radius=0.1 inner=0.2": "inner",
	}
	for recipe: String in wrong:
		check(maker.grow_bark(stout(), recipe) == null, "%s grows bark." % recipe)
		check_sentence(maker.get_error_message(), recipe)
		check(wrong[recipe] in maker.get_error_message(), maker.get_error_message())
	check(maker.grow_bark(TreeReconstruction.new(), RECIPE) == null, "An empty tree grows bark.")
	check_sentence(maker.get_error_message(), "Of an empty tree")
	check(maker.grow_bark(stout(), "edges longest=1") == null, "Bark of too long edges grows.")
	check("thick enough" in maker.get_error_message(), maker.get_error_message())
	expect_error("no tree that bark")
	check(maker.grow_bark(null, RECIPE) == null, "No tree grows bark.")
	# What is left out is told.
	var made: TreeReconstruction = maker.grow_bark(
		stout(), "edges longest=0.08\nburl node=19 along=0.1"
	)
	check(made != null, maker.get_error_message())
	var warnings: Array = maker.get_report().warnings
	check_equal(warnings.size(), 1, "warnings")
	check("stays a tube" in str(warnings), str(warnings))


func test_it_can_be_cancelled() -> void:
	var maker: TreeReconstructor = TreeReconstructor.new()
	var of: TreeReconstruction = stout()
	var task: int = WorkerThreadPool.add_task(
		func() -> void: maker.grow_bark(of, "edges longest=0.012")
	)
	while maker.get_stage() != "Growing bark" or maker.get_progress() <= 0.0:
		await tree.process_frame
	maker.cancel()
	var since: int = Time.get_ticks_msec()
	WorkerThreadPool.wait_for_task_completion(task)
	check(Time.get_ticks_msec() - since < 2000, "It took %d ms." % (Time.get_ticks_msec() - since))
	check_equal(maker.get_error_message(), "Cancelled.", "what is said of it")
	check(maker.grow_bark(of, RECIPE) != null, "It can't grow any more.")


func test_damaged_and_newer_bark() -> void:
	var made: TreeReconstruction = _grown(stout())
	var bytes: PackedByteArray = made.grown_bark
	expect_error("newer version")
	var newer: PackedByteArray = bytes.duplicate()
	newer[12] = 9
	made.grown_bark = newer
	check(not made.has_grown_bark(), "Bark of a newer version is shown.")
	check_equal(made.grown_bark, newer, "what a save keeps of it")
	expect_error("damaged")
	made.grown_bark = bytes.slice(0, 200)
	check(not made.has_grown_bark() and made.grown_bark.is_empty(), "Half of it is bark.")
	made.grown_bark = bytes
	check(made.has_grown_bark() and not made.is_bark_stale(), "It is gone for good.")


func test_another_tree_of_the_scan_keeps_recipe_and_bark() -> void:
	var made: TreeReconstruction = _grown(stout())
	var before: TreeReconstruction = TreeReconstruction.new()
	before.take_tree_of(made)
	made.take_tree_of(grown_tree(4))
	check(made.is_bark_stale(), "The bark of one tree fits another.")
	check(not made.growth_recipe.is_empty(), "The recipe is gone.")
	made.take_tree_of(before)
	check(not made.is_bark_stale(), "It is stale after undo.")


func test_exports_have_it() -> void:
	var made: TreeReconstruction = _grown(stout())
	var maker: TreeReconstructor = TreeReconstructor.new()
	var sizes: PackedInt64Array = []
	for of: TreeReconstruction in [stout(), made] as Array[TreeReconstruction]:
		var path: String = folder.path_join("tree.obj")
		check_equal(maker.export_file(of, path), OK, maker.get_error_message())
		var far: float = 0.0
		for line: String in FileAccess.get_file_as_string(path).split("\n"):
			var words: PackedFloat64Array = line.trim_prefix("v ").split_floats(" ")
			if line.begins_with("v ") and absf(words[1] - 0.8) < 0.15 and absf(words[2]) < 0.1:
				far = maxf(far, words[0])
		sizes.append(roundi(1000.0 * far))
	check(sizes[0] < 200 and sizes[1] > 230, "The burl reaches %s mm." % sizes)
