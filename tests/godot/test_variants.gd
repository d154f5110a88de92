extends "./suite.gd"
## New individuals of a tree's kind.


func test_a_variant_is_a_tree_of_its_own() -> void:
	var made: TreeReconstruction = grown_tree(1)
	made.leaf_preset = "oak"
	made.seed = 4
	made.edit("prune")
	var before: Dictionary = made.skeleton
	var variant: TreeReconstruction = made.make_variant(7, 0.8)
	check(variant != null, "There is no variant.")
	if variant == null:
		return
	check_equal(made.skeleton, before, "the tree itself")
	check(variant.skeleton["positions"] != before["positions"], "It is the same tree.")
	check_equal(variant.skeleton["frame"], before["frame"], "the frame")
	check_equal(variant.leaf_preset, "oak", "the preset")
	check(variant.seed != made.seed and variant.seed >= 0, "The seed is %d." % variant.seed)
	check_near(variant.leaf_size / made.leaf_size, 1.0, 0.081, "the size of the leaves")
	check_equal(variant.edit_log, "", "the log")
	check_equal(variant.provenance, {"variant": {"seed": 7, "amount": 0.8}}, "the provenance")
	check_near(
		variant.measure()["height"] / made.measure()["height"], 1.0, 0.3, "the height's ratio"
	)
	check(variant.build_mesh().get_surface_count() == 1, "It has no bark.")
	check(variant.build_leaves().instance_count > 0, "It has no leaves.")
	check(variant.edit("twig node=%d" % variant.get_leaves()[0]) != null, "It can't be edited.")
	# It can be saved and is the same afterwards.
	var path: String = folder.path_join("variant.res")
	check_equal(ResourceSaver.save(variant, path), OK, "saving")
	var read: TreeReconstruction = (
		ResourceLoader.load(path, "", ResourceLoader.CACHE_MODE_IGNORE) as TreeReconstruction
	)
	check_equal(read.skeleton, variant.skeleton, "the tree read again")


func test_the_same_seed_gives_the_same_variant() -> void:
	var made: TreeReconstruction = grown_tree(2)
	var first: TreeReconstruction = made.make_variant(3)
	check_equal(made.make_variant(3).skeleton, first.skeleton, "the same seed's")
	check(made.make_variant(4).skeleton != first.skeleton, "Another seed gives the same.")
	check(made.make_variant(-3).skeleton != first.skeleton, "A negative seed gives the same.")
	var same: TreeReconstruction = made.make_variant(3, 0.0)
	check_equal(same.skeleton, made.skeleton, "no variation")
	check_equal(same.seed, made.seed, "its seed")
	check_equal(same.leaf_size, made.leaf_size, "its leaves")
	# The tree changes, and its variants with it.
	made.edit("move nodes=%d by=0.3,0.1,0" % made.get_leaves()[0])
	check(made.make_variant(3).skeleton != first.skeleton, "The old tree is varied.")


func test_an_age_makes_it_younger() -> void:
	var made: TreeReconstruction = grown_tree(2)
	var young: TreeReconstruction = made.make_variant(3, 0.5, 0.3)
	check(
		young.measure()["height"] < 0.7 * made.make_variant(3).measure()["height"],
		"It is as high as the tree."
	)
	check_equal(
		young.provenance, {"variant": {"seed": 3, "amount": 0.5, "age": 0.3}}, "the provenance"
	)
	check_equal(made.make_variant(3, 0.5, 0.3).skeleton, young.skeleton, "the same seed's")
	expected_errors = ["The age of a variant must be 0.2 to 1.2"]
	check(made.make_variant(3, 0.5, 0.1) == null, "An age of 0.1 was taken.")


func test_a_leaf_rule_is_shared() -> void:
	var made: TreeReconstruction = grown_tree(3)
	made.leaf_rule = LeafRule.from_preset("maple")
	var variant: TreeReconstruction = made.make_variant(1)
	check_equal(variant.leaf_rule, made.leaf_rule, "the rule")
	var count: Array[int] = [0]
	variant.changed.connect(func() -> void: count[0] += 1)
	made.leaf_rule.season = 0.8
	check_equal(count[0], 1, "changes that the variant tells of")


func test_variants_on_many_threads() -> void:
	var made: TreeReconstruction = grown_tree(4)
	made.leaf_rule = LeafRule.from_preset("oak")
	var wanted: Array[Dictionary] = []
	for i: int in 30:
		wanted.append(made.make_variant(i, 1.0).skeleton)
	var fresh: TreeReconstruction = grown_tree(4)
	fresh.leaf_rule = LeafRule.from_preset("oak")
	var found: Array[Dictionary] = []
	found.resize(30)
	var make: Callable = func(i: int) -> void: found[i] = fresh.make_variant(i, 1.0).skeleton
	var task: int = WorkerThreadPool.add_group_task(make, found.size())
	WorkerThreadPool.wait_for_group_task_completion(task)
	check_equal(found, wanted, "the variants")


func test_what_can_not_be_varied() -> void:
	for amount: float in [-0.5, 1.5, NAN]:
		expect_error("amount")
		check(grown_tree(5, 20).make_variant(1, amount) == null, "%s was taken." % amount)
	check(TreeReconstruction.new().make_variant(1).is_empty(), "An empty tree has a variant.")
