extends "./forest_suite.gd"
## The season of a forest is its shaders': no tree is built again.


func _oaks() -> TreeVariantSpawner3D:
	var forest: TreeVariantSpawner3D = _forest()
	forest.source.leaf_rule = LeafRule.from_preset("oak")
	forest.source.leaf_rule.season = 0.4
	forest.season_spread = 0.1
	return forest


func _leaves_of(forest: TreeVariantSpawner3D, index: int, level: int) -> ShaderMaterial:
	var mesh: ArrayMesh = forest.get_variant_mesh(index, level)
	var surface: int = mesh.surface_find_by_name("leaves")
	check(surface >= 0, "Level %d of individual %d has no leaves." % [level, index])
	return mesh.surface_get_material(surface) as ShaderMaterial


func _check_values(forest: TreeVariantSpawner3D, season: float) -> void:
	var rule: LeafRule = forest.source.leaf_rule.duplicate() as LeafRule
	for index: int in forest.variants:
		for level: int in forest.levels:
			var leaves: ShaderMaterial = _leaves_of(forest, index, level)
			for end: int in 2:
				rule.season = season + (end - 0.5) * forest.season_spread
				var tint: Color = rule.get_season_tints()[0].srgb_to_linear()
				var name: StringName = [&"season_early", &"season_early_after"][end]
				var given: Vector4 = leaves.get_shader_parameter(name)
				check(
					given.is_equal_approx(Vector4(tint.r, tint.g, tint.b, tint.a)),
					"%s is %s in %s." % [name, given, season]
				)
				var standing: Vector2 = leaves.get_shader_parameter(&"season_standing")
				check_near(standing[end], rule.get_standing_share(), 1e-5, "leaves that stand")
				var unfolded: Vector2 = leaves.get_shader_parameter(&"season_unfolded")
				check_near(unfolded[end], rule.get_unfolded_share(), 1e-5, "how far they are open")


func _meshes(forest: TreeVariantSpawner3D) -> Array[Mesh]:
	var meshes: Array[Mesh] = []
	for part: MultiMeshInstance3D in _parts(forest):
		meshes.append(part.multimesh.mesh)
	return meshes


func test_a_tween_of_the_season_is_seen_in_each_frame() -> void:
	var forest: TreeVariantSpawner3D = _oaks()
	await _plant(forest)
	_check_values(forest, 0.4)
	var before: Array[Mesh] = _meshes(forest)
	check(not before.is_empty(), "Nothing is drawn.")
	var tween: Tween = tree.create_tween()
	tween.tween_property(forest.source.leaf_rule, "season", 1.0, 0.5)
	var seen: Dictionary[Vector2, bool] = {}
	while tween.is_running():
		await tree.process_frame
		check_equal(_meshes(forest), before, "what is drawn at %s" % forest.source.leaf_rule.season)
		check(not forest.is_building(), "It is built again.")
		var leaves: ShaderMaterial = _leaves_of(forest, 0, 0)
		seen[leaves.get_shader_parameter(&"season_standing")] = true
	_check_values(forest, 1.0)
	check(seen.size() > 5, "Only %d values were seen." % seen.size())
	check_equal(_leaves_of(forest, 0, 0).get_shader_parameter(&"season_standing").y, 0.0, "leaves")
	_clear()


# However late a forest begins, its leaves come back in spring.
func test_a_forest_of_winter_becomes_green() -> void:
	var summer: TreeVariantSpawner3D = _oaks()
	await _plant(summer)
	var forest: TreeVariantSpawner3D = _oaks()
	forest.source.leaf_rule.season = 1.0
	await _plant(forest)
	forest.source.leaf_rule.season = 0.4
	_check_values(forest, 0.4)
	check(not forest.is_building(), "It is built again.")
	for index: int in forest.variants:
		for level: int in forest.levels:
			var counts: PackedInt32Array = []
			for of: TreeVariantSpawner3D in [summer, forest]:
				var mesh: ArrayMesh = of.get_variant_mesh(index, level)
				counts.append(mesh.surface_get_array_len(mesh.surface_find_by_name("leaves")))
			check_equal(counts[1], counts[0], "vertices of the leaves")
	_clear()


# At any moment of its making.
func test_the_season_changes_while_a_forest_is_made() -> void:
	for frames: int in [0, 1, 2, 3, 5, 8]:
		var forest: TreeVariantSpawner3D = _oaks()
		_world = Node3D.new()
		tree.root.add_child(_world)
		_world.add_child(forest)
		for i: int in frames:
			await tree.process_frame
		forest.source.leaf_rule.season = 0.9
		await _grown(forest)
		_check_values(forest, 0.9)
		_clear()


# Anything else of a rule, and any material that knows no season, builds trees again.
func test_other_changes_build_again() -> void:
	var forest: TreeVariantSpawner3D = _oaks()
	await _plant(forest)
	var rule: LeafRule = forest.source.leaf_rule
	var changes: Array[Callable] = [
		func() -> void: rule.leaf_size *= 1.1,
		func() -> void: rule.evergreen = not rule.evergreen,
		func() -> void: forest.source.leaf_rule = LeafRule.from_preset("birch"),
		func() -> void: forest.source.edit("prune"),
	]
	for i: int in changes.size():
		changes[i].call()
		check(forest.is_building(), "Change %d is not heard." % i)
		await _grown(forest)
	forest.leaf_material = StandardMaterial3D.new()
	await _grown(forest)
	forest.source.leaf_rule.season = 0.95
	check(forest.is_building(), "A material of its own can't know the season.")
	await _grown(forest)
	_clear()


# Two sources that share a rule, and two forests that share a tree.
func test_what_is_shared_follows_once() -> void:
	var forest: TreeVariantSpawner3D = _oaks()
	var second: TreeReconstruction = grown_tree(5, 60)
	second.leaf_rule = forest.source.leaf_rule
	forest.sources = [second]
	forest.variants = 4
	await _plant(forest)
	var other: TreeVariantSpawner3D = _forest()
	other.source = forest.source
	other.season_spread = 0.1
	await _plant(other)
	forest.source.leaf_rule.season = 0.6
	for one: TreeVariantSpawner3D in [forest, other]:
		check(not one.is_building(), "It is built again.")
		_check_values(one, 0.6)
	_clear()
