extends "./suite.gd"
## A TreeInstance3D's levels of detail: that they take turns without a gap, and follow the tree.

const Levels := preload("res://addons/tree_reconstruction/nodes/tree_levels.gd")
const BuildJob := preload("res://addons/tree_reconstruction/nodes/tree_build_job.gd")
const LIMIT_FRAMES: int = 2000


func _instance(made: TreeReconstruction) -> TreeInstance3D:
	var instance: TreeInstance3D = TreeInstance3D.new()
	instance.reconstruction = made
	tree.root.add_child(instance)
	return instance


func _settle(instance: TreeInstance3D) -> void:
	for i: int in LIMIT_FRAMES:
		if not instance.is_building_levels():
			await tree.process_frame
			return
		await tree.process_frame
	check(false, "The levels did not end.")


func _part(instance: TreeInstance3D, name: String) -> GeometryInstance3D:
	for child: Node in instance.get_children(true):
		if child.name == name and not child.is_queued_for_deletion():
			return child as GeometryInstance3D
	return null


func _parts(instance: TreeInstance3D) -> int:
	var count: int = 0
	for child: Node in instance.get_children(true):
		count += 1 if child is GeometryInstance3D and not child.is_queued_for_deletion() else 0
	return count


func test_distances_rise_and_keep_what_was_chosen() -> void:
	for count: int in range(1, 7):
		var found: PackedFloat32Array = Levels.distances(12.0, count)
		check_equal(found.size(), count - 1, "the distances")
		for i: int in range(1, found.size()):
			check(found[i] > found[i - 1], "A level has no turn: %s." % found)
	var chosen: PackedFloat32Array = Levels.distances(12.0, 4, [50.0, 20.0])
	check_equal(chosen[0], 50.0, "the first distance")
	check_equal(chosen[1], 50.0, "a distance below the one before")
	check(Levels.margin(40.0) > 0.0 and Levels.margin(40.0) < 8.0, "The margin is out of measure.")


func test_levels_take_turns_with_and_without_threads() -> void:
	for threads: bool in [false, true]:
		TreeInstance3D.threaded = threads
		var instance: TreeInstance3D = _instance(grown_tree(2, 1500))
		await _settle(instance)
		var switches: PackedFloat32Array = Levels.distances(instance.get_tree_height(), 4)
		var before: int = instance.get_triangle_count()
		check(before > 0, "There is no tree.")
		var finest: GeometryInstance3D = _part(instance, "Leaves")
		check_equal(finest.visibility_range_begin, 0.0, "where the finest begins")
		check(finest.visibility_range_end >= switches[0], "The finest ends too early.")
		check_equal(finest.cast_shadow, instance.cast_shadow, "the finest level's own shadow")
		var ends: float = finest.visibility_range_end
		for level: int in range(1, 4):
			var count: int = instance.get_level_triangle_count(level)
			check(count > 0 and count < before, "Level %d has %d triangles." % [level, count])
			before = count
			for suffix: String in ["", "Leaves"]:
				var part: GeometryInstance3D = _part(instance, "Level%d%s" % [level, suffix])
				check(part.visible, "Level %d is hidden." % level)
				# The two that meet overlap by their margins at least.
				var margin: float = 2.0 * Levels.margin(switches[level - 1])
				check(
					ends - part.visibility_range_begin >= margin - 0.01,
					"Level %d comes too late." % level
				)
				check_equal(
					part.cast_shadow,
					GeometryInstance3D.SHADOW_CASTING_SETTING_OFF,
					"the shadow of level %d" % level
				)
				check_equal(part.custom_aabb, (instance.mesh as ArrayMesh).custom_aabb, "the box")
			ends = _part(instance, "Level%d" % level).visibility_range_end
		check_equal(ends, 0.0, "where the last level ends")
		var shadow: GeometryInstance3D = _part(instance, "Shadow")
		check(shadow.visible, "Nothing casts a shadow.")
		check_equal(
			shadow.cast_shadow,
			GeometryInstance3D.SHADOW_CASTING_SETTING_SHADOWS_ONLY,
			"what casts the shadow"
		)
		# Nearer, the finest casts its own; where it gives way, both are there.
		check(shadow.visibility_range_begin > 0.0, "Two levels cast shadows near by.")
		var both: float = finest.visibility_range_end - shadow.visibility_range_begin
		check(both >= 2.0 * Levels.margin(switches[0]) - 0.01, "No shadow falls at the switch.")
		check_equal(shadow.visibility_range_end, 0.0, "where the shadow ends")
		instance.free()
	TreeInstance3D.threaded = true


func test_a_pinned_level_stands_alone() -> void:
	var instance: TreeInstance3D = _instance(grown_tree(2))
	await _settle(instance)
	check(_parts(instance) > 1 + 2 * 3, "There are only %d parts." % _parts(instance))
	instance.lod = 2
	await _settle(instance)
	check_equal(_parts(instance), 1, "what is left beside the pinned level")
	check_equal(_part(instance, "Leaves").visibility_range_end, 0.0, "where it ends")
	check_equal(
		instance.get_leaf_count(),
		_count(instance.reconstruction.build_foliage(2)[0].leaves),
		"the leaves of the pinned level"
	)
	instance.lod = -1
	instance.levels = 2
	await _settle(instance)
	check(instance.get_level_triangle_count(1) > 0, "The second level did not come back.")
	check_equal(instance.get_level_triangle_count(2), 0, "a level that there is not")
	instance.levels = 1
	await _settle(instance)
	check_equal(_parts(instance), 1, "the parts of one level")
	instance.free()


func test_edits_reach_all_levels() -> void:
	var instance: TreeInstance3D = _instance(grown_tree(2, 1500))
	await _settle(instance)
	var before: int = instance.get_level_triangle_count(1)
	var built: Array[int] = [0]
	instance.levels_built.connect(func() -> void: built[0] += 1)
	instance.reconstruction = grown_tree(3, 400)
	await _settle(instance)
	check_equal(built[0], 1, "how often the levels were built")
	check(instance.get_level_triangle_count(1) < before, "The old levels are still there.")
	check(_part(instance, "Level1").visible, "The new ones are hidden.")
	instance.reconstruction = null
	await _settle(instance)
	check_equal(_parts(instance) - 1, 0, "the levels of no tree")
	instance.free()


func test_own_ranges_and_shadows_bound_the_levels() -> void:
	var instance: TreeInstance3D = _instance(grown_tree(2))
	await _settle(instance)
	var switches: PackedFloat32Array = Levels.distances(instance.get_tree_height(), 4)
	instance.set("visibility_range_end", switches[1])
	instance.set("cast_shadow", GeometryInstance3D.SHADOW_CASTING_SETTING_OFF)
	instance.set("layers", 4)
	await tree.process_frame
	check_equal(
		_part(instance, "Level3").visibility_range_end, switches[1], "where the last one ends"
	)
	check(
		_part(instance, "Leaves").visibility_range_end < switches[1],
		"The finest has no end of its own."
	)
	check(not _part(instance, "Shadow").visible, "It casts a shadow.")
	check_equal(_part(instance, "Level2").layers, 4, "the layers")
	instance.set("visibility_range_end", 0.0)
	instance.level_distances = [100.0, 200.0, 300.0]
	await tree.process_frame
	check_near(_part(instance, "Level2").visibility_range_begin, 200.0, 20.0, "a chosen distance")
	instance.free()


func test_budgets_are_kept_or_said_to_be_too_small() -> void:
	var instance: TreeInstance3D = _instance(grown_tree(2, 1500))
	instance.level_budgets = [4000, 1000, 0, 1]
	await _settle(instance)
	check(instance.get_triangle_count() <= 4000, "The finest level has too many triangles.")
	check(instance.get_triangle_count() > 2000, "The finest level has too few triangles.")
	check(instance.get_level_triangle_count(1) <= 1000, "Level 1 has too many triangles.")
	check_equal(instance._get_configuration_warnings().size(), 1, "the warnings")
	check(instance.get_level_triangle_count(3) > 1, "The level with too small a budget is gone.")
	instance.free()


func test_levels_of_a_resource() -> void:
	var made: TreeReconstruction = grown_tree(2, 1500)
	var levels: Array[Dictionary] = made.build_levels([0, 1, 2])
	check_equal(levels[0].bark, made.build_mesh_arrays(0), "the finest bark")
	check_equal(levels[1].leaves, made.build_leaf_buffer(1), "the leaves of level 1")
	check_equal(levels[2].leaves, made.build_foliage(2)[0].leaves, "the leaves of level 2")
	# A bough's card shows many sprays: its material tells it by the rows of its picture.
	check(
		_count(levels[2].leaves) < _count(made.build_leaf_buffer(2)) / 2, "It has too many cards."
	)
	var uvs: PackedVector2Array = levels[2].card[Mesh.ARRAY_TEX_UV]
	check(uvs[0].y > 16.0 and uvs.size() == 4, "Its card shows one spray.")
	check_equal(levels[0].box, levels[2].box, "the boxes")
	check_equal(levels[1].level, 1.0, "the level")
	check_equal(made.build_levels([1], [500])[0].triangles <= 500, true, "the budget")
	expect_error("no level of detail -1")
	check_equal(made.build_levels([-1]).size(), 0, "a negative level")


func test_a_tree_without_leaves_keeps_the_twigs_that_they_hide() -> void:
	var made: TreeReconstruction = grown_tree(2, 1500)
	var hidden: Array = made.build_mesh_arrays(2)
	var bare: Array = made.build_mesh_arrays(2, false, false)
	check(_triangles(bare) > _triangles(hidden), "It has no more twigs than a tree in leaf.")
	var level: Dictionary = made.build_levels([2], [], false, false)[0]
	check_equal(level.bark, bare, "the bark of a level")
	check_equal(_count(level.leaves), 0, "the leaves")
	check_equal(level.triangles, _triangles(bare), "the triangles")
	var instance: TreeInstance3D = _instance(made)
	instance.levels = 4
	await _settle(instance)
	check(instance.get_level_triangle_count(2) > _triangles(hidden), "It bears no leaves.")
	instance.leaves = false
	await _settle(instance)
	check_equal(instance.get_level_triangle_count(2), _triangles(bare), "without leaves")
	instance.lod = 2
	await _settle(instance)
	check_equal(instance.get_triangle_count(), _triangles(bare), "at a level of its own")
	instance.leaves = true
	await _settle(instance)
	check_equal(BuildJob.triangles(instance.mesh), _triangles(hidden), "in leaf again")
	instance.free()


func _triangles(arrays: Array) -> int:
	@warning_ignore("integer_division")
	return (arrays[Mesh.ARRAY_INDEX] as PackedInt32Array).size() / 3


func _count(buffer: PackedFloat32Array) -> int:
	@warning_ignore("integer_division")
	return buffer.size() / 20
