extends "./forest_suite.gd"
## What a game does to a forest stays done, and can be saved.


# Takes three trees, adds two and takes one of these again; returns the two ids that were added.
func _change(forest: TreeVariantSpawner3D) -> PackedInt32Array:
	forest.remove(0)
	forest.remove(5)
	forest.take(7).free()
	var ids: PackedInt32Array = []
	for i: int in 2:
		ids.append(forest.spawn_at(Transform3D(Basis(Vector3.UP, i), Vector3(90.0 + i, 2.0, i))))
	forest.remove(ids[0])
	return ids


func _places(forest: TreeVariantSpawner3D) -> PackedVector3Array:
	var places: PackedVector3Array = []
	for id: int in forest.find_trees(Vector3.ZERO, 1e5):
		places.append(forest.get_tree_transform(id).origin)
	places.sort()
	return places


func test_no_rebuild_brings_felled_trees_back() -> void:
	var forest: TreeVariantSpawner3D = _forest()
	forest.source.leaf_rule = LeafRule.from_preset("oak")
	await _plant(forest)
	var before: int = forest.get_tree_count()
	var ids: PackedInt32Array = _change(forest)
	check_equal(forest.get_tree_count(), before - 2, "trees")
	var wanted: PackedVector3Array = _places(forest)
	var changes: Dictionary[String, Callable] = {
		"the places": forest.rebuild_places,
		"all": forest.rebuild,
		"another amount": func() -> void: forest.amount = 0.2,
		"another season": func() -> void: forest.source.leaf_rule.season = 0.8,
		"another number of kinds": func() -> void: forest.variants = 2,
		"another wood": func() -> void: forest.source.edit("prune"),
	}
	for what: String in changes:
		changes[what].call()
		await _grown(forest)
		check_equal(_places(forest), wanted, "where trees stand after " + what)
		expect_error("The forest has no tree 0.")
		forest.remove(0)
		check_equal(
			forest.get_tree_transform(ids[1]).origin, Vector3(91.0, 2.0, 1.0), "what was added"
		)
	_world.remove_child(forest)
	_world.add_child(forest)
	await _grown(forest)
	check_equal(_places(forest), wanted, "where trees stand after the scene was left")
	_clear()


# More trees or fewer, and ground that rises under them: those that still stand keep their fate.
func test_trees_are_known_by_their_places() -> void:
	var forest: TreeVariantSpawner3D = _forest()
	await _plant(forest)
	var gone: PackedVector3Array = []
	for id: int in [1, 4, 6]:
		gone.append(forest.get_tree_transform(id).origin)
		forest.remove(id)
	forest.density = 1.6
	forest.size_variation = 0.3
	await _grown(forest)
	for place: Vector3 in gone:
		check(forest.find_trees(place, 0.2).is_empty(), "One is back at %s." % place)
	forest.density = 0.2
	await _grown(forest)
	forest.density = 1.0
	await _grown(forest)
	for place: Vector3 in gone:
		check(forest.find_trees(place, 0.2).is_empty(), "One is back at %s at last." % place)
	# Given ones in another order.
	forest.placement = TreeVariantSpawner3D.Placement.GIVEN
	forest.set_state({})
	for i: int in 6:
		forest.transforms.append(Transform3D(Basis(), Vector3(4.0 * i, 0.0, 0.0)))
	await _grown(forest)
	forest.remove(2)
	var others: Array[Transform3D] = forest.transforms.duplicate()
	others.reverse()
	for i: int in 6:
		others[i].origin.y += 3.0
	forest.transforms = others
	await _grown(forest)
	check_equal(forest.get_tree_count(), 5, "trees")
	check(forest.find_trees(Vector3(8.0, 3.0, 0.0), 0.5).is_empty(), "It is back.")
	_clear()


func test_a_state_is_saved_in_any_format() -> void:
	var forest: TreeVariantSpawner3D = _forest()
	await _plant(forest)
	var untouched: String = forest.get_digest()
	var ids: PackedInt32Array = _change(forest)
	var digest: String = forest.get_digest()
	check(digest != untouched, "The digest knows of no change.")
	var state: Dictionary = forest.get_state()
	var forms: Dictionary[String, Dictionary] = {
		"bytes": bytes_to_var(var_to_bytes(state)),
		"words": str_to_var(var_to_str(state)),
		"JSON": JSON.parse_string(JSON.stringify(state, "", true, true)),
	}
	forest.set_state({})
	await _grown(forest)
	check_equal(forest.get_digest(), untouched, "the forest without its changes")
	for form: String in forms:
		# Another machine's, which is told before its forest is there.
		var other: TreeVariantSpawner3D = _forest()
		other.set_state(forms[form])
		await _plant(other)
		check_equal(other.get_digest(), digest, "the forest of a state as " + form)
		check_equal(other.get_state(), state, "its state as " + form)
		var next: int = other.spawn_at(Transform3D(Basis(), Vector3(50.0, 0.0, 0.0)))
		check(next > ids[1], "An id was given again.")
		other.free()
	_clear()


# Calls of other machines come at any moment, and on all in the same order.
func test_what_is_done_while_a_forest_is_made_again_is_not_lost() -> void:
	var digests: Dictionary[String, bool] = {}
	for wait: int in [-1, 0, 1, 2, 4]:
		var forest: TreeVariantSpawner3D = _forest()
		await _plant(forest)
		if wait >= 0:
			forest.rebuild()
		for frame: int in wait:
			await tree.process_frame
		forest.remove(3)
		var id: int = forest.spawn_at(Transform3D(Basis(), Vector3(70.0, 1.0, 2.0)))
		forest.remove(8)
		var again: int = forest.spawn_at(Transform3D(Basis(), Vector3(75.0, 1.0, 2.0)))
		forest.remove(id)
		check(again != id, "One id for two trees.")
		var halfway: Dictionary = JSON.parse_string(
			JSON.stringify(forest.get_state(), "", true, true)
		)
		await _grown(forest)
		digests[forest.get_digest()] = true
		forest.set_state(halfway)
		await _grown(forest)
		digests[forest.get_digest()] = true
		_clear()
	check_equal(digests.size(), 1, "different forests")


func test_what_is_no_state_is_refused_with_a_sentence() -> void:
	var forest: TreeVariantSpawner3D = _forest()
	await _plant(forest)
	_change(forest)
	var digest: String = forest.get_digest()
	var good: Dictionary = forest.get_state()
	var bad: Dictionary[String, Variant] = {
		"removed": "all", "added_at": [1.0, 2.0], "removed_at": [NAN], "added": [3], "next": 5
	}
	for name: String in bad:
		var state: Dictionary = good.duplicate(true)
		state[name] = bad[name]
		expect_error("This state of a forest is damaged")
		forest.set_state(state)
	expect_error("doesn't say its format_version")
	forest.set_state({"removed": [1]})
	expect_error("Update the addon")
	forest.set_state({"format_version": 2})
	await _grown(forest)
	check_equal(forest.get_digest(), digest, "the forest afterwards")
	check_equal(forest.get_state(), good, "its state afterwards")
	_clear()


func test_what_no_forest_can_do_is_said() -> void:
	var forest: TreeVariantSpawner3D = _forest()
	await _plant(forest)
	var count: int = forest.get_tree_count()
	for id: int in [-1, 1 << 30, 1 << 31, 1 << 40, -(1 << 40), (1 << 32) + 1]:
		expect_error("The forest has no tree %d." % id)
		forest.remove(id)
		check(forest.take(id) == null, "Tree %d was taken." % id)
		check_equal(forest.get_tree_variant(id), -1, "the individual of %d" % id)
	for frame: Transform3D in [
		Transform3D(Basis(), Vector3(NAN, 0.0, 0.0)),
		Transform3D(Basis(), Vector3(0.0, INF, 0.0)),
		Transform3D(Basis.from_scale(Vector3.ZERO), Vector3.ZERO),
		Transform3D(Basis.from_scale(Vector3(1.0, 0.0, 1.0)), Vector3.ZERO),
	]:
		expect_error("not finite, or flat")
		check_equal(forest.spawn_at(frame), -1, "the id of no tree")
	check_equal(forest.get_tree_count(), count, "trees")
	check_equal(forest.find_trees(Vector3.ZERO, INF).size(), count, "all trees")
	for distance: float in [NAN, -1.0]:
		check(forest.find_trees(Vector3.ZERO, distance).is_empty(), "Trees within %s." % distance)
	check(forest.find_trees(Vector3.ONE * NAN, 10.0).is_empty(), "Trees around nowhere.")
	expect_error("no individual")
	check(forest.get_variant(1 << 40) == null, "There is an individual.")
	check(forest.get_variant_mesh(1 << 40) == null, "There is a mesh.")
	check_equal(forest.find_tree_of(null), -1, "the tree of no body")
	_clear()


func test_a_forest_of_any_numbers_ends() -> void:
	var forest: TreeVariantSpawner3D = _forest()
	forest.frame_budget_ms = 0.0
	check_equal(forest.frame_budget_ms, 0.1, "the least budget")
	forest.variants = 100_000
	check_equal(forest.variants, 64, "the most individuals")
	forest.variants = 2
	for property: String in [
		"amount",
		"season_spread",
		"density",
		"minimum_distance",
		"clumping",
		"size_variation",
		"lean",
		"ground_depth",
		"ground_alignment",
		"ground_slope_limit",
		"view_distance",
		"collision_distance",
		"frame_budget_ms",
	]:
		var before: float = forest.get(property)
		forest.set(property, NAN)
		check_equal(forest.get(property), before, property)
	forest.ages = Vector2(NAN, 1.0)
	forest.region_size = Vector2(INF, 10.0)
	check(forest.region_size.is_finite() and forest.ages.is_finite(), "They are not finite.")
	forest.collision_trees = -4
	forest.collision_shapes = 0
	await _plant(forest)
	check(forest.get_tree_count() > 3, "There are %d trees." % forest.get_tree_count())
	forest.placement = TreeVariantSpawner3D.Placement.GIVEN
	forest.transforms = [
		Transform3D(),
		Transform3D(Basis(), Vector3(NAN, 0.0, 0.0)),
		Transform3D(Basis.from_scale(Vector3.ZERO), Vector3.ONE),
		Transform3D(Basis(), Vector3(6.0, 0.0, 0.0)),
	]
	expect_error("2 of the forest's 4 transforms bear no tree")
	await _grown(forest)
	check_equal(forest.get_tree_count(), 2, "trees")
	check_equal(forest.get_tree_transform(3).origin.x, 6.0, "where the last one stands")
	# A forest that is tweened up from nothing.
	forest.scale = Vector3.ZERO
	forest.transforms = [Transform3D()]
	await _grown(forest)
	check_equal(forest.get_tree_count(), 1, "trees of a flat forest")
	_clear()


func test_progress_rises_from_nothing() -> void:
	var forest: TreeVariantSpawner3D = _forest()
	var told: PackedFloat32Array = []
	forest.progressed.connect(func(share: float) -> void: told.append(share))
	var changes: Array[Callable] = [
		func() -> void: pass,
		forest.rebuild_places,
		func() -> void: forest.amount = 0.3,
		forest.rebuild,
	]
	for i: int in changes.size():
		told.clear()
		if i == 0:
			await _plant(forest)
		else:
			changes[i].call()
			await _grown(forest)
		check(told.size() > 1, "Only %s is told." % [told])
		check_equal(told[0], 0.0, "what is told first")
		check_equal(told[-1], 1.0, "what is told last")
		for j: int in range(1, told.size()):
			check(told[j] > told[j - 1], "It falls: %s" % [told])
	_clear()
