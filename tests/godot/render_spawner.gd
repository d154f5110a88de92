extends "./picture_suite.gd"
## A forest in the renderer that this run uses: it is made anew without an error of the renderer's.


func test_a_forest_is_made_again_and_again() -> void:
	_open_stage(Vector2i(64, 64))
	_camera.position = Vector3(0.0, 2.0, 12.0)
	var forest: TreeVariantSpawner3D = TreeVariantSpawner3D.new()
	forest.source = grown_tree(3, 60)
	forest.variants = 2
	forest.levels = 2
	forest.region_size = Vector2(30.0, 30.0)
	_viewport.add_child(forest)
	await forest.finished
	check(_summary(await _picture())[0] > 0.002, "No tree is to be seen.")
	for i: int in 2:
		forest.seed += 1
		await forest.finished
		check(_summary(await _picture())[0] > 0.002, "No tree is to be seen any longer.")
	_viewport.free()


# In the very frame in which the season is set: leaves turn, fall, and come back.
func test_leaves_fall_without_another_build() -> void:
	_open_stage(Vector2i(128, 128))
	_camera.position = Vector3(0.0, 2.0, 9.0)
	var forest: TreeVariantSpawner3D = TreeVariantSpawner3D.new()
	forest.source = grown_tree(3, 120)
	forest.source.leaf_rule = LeafRule.from_preset("maple")
	forest.source.leaf_rule.season = 0.4
	forest.variants = 2
	forest.levels = 2
	forest.season_spread = 0.0
	forest.region_size = Vector2(8.0, 8.0)
	forest.density = 20.0
	forest.minimum_distance = 1.5
	forest.clumping = 0.0
	# A gust turns leaves, which changes what they cover.
	var still: TreeWind = TreeWind.new()
	still.strength = 0.0
	_viewport.add_child(still)
	_viewport.add_child(forest)
	await forest.finished
	var summer: Image = await _picture()
	forest.source.leaf_rule.season = 0.68
	var autumn: Image = await _picture()
	forest.source.leaf_rule.season = 1.0
	var winter: Image = await _picture()
	forest.source.leaf_rule.season = 0.4
	var again: Image = await _picture()
	check(not forest.is_building(), "It was built again.")
	var full: float = _summary(summer)[0]
	check(full > 0.02, "Only %s of the picture is tree." % full)
	check_near(_summary(autumn)[0], full, 0.1 * full, "what leaves cover in autumn")
	var green: Color = _summary(summer)[1]
	var red: Color = _summary(autumn)[1]
	check(red.r / red.g > 1.2 * green.r / green.g, "They turned from %s to %s." % [green, red])
	check(_summary(winter)[0] < 0.7 * full, "The leaves have not fallen.")
	check(_summary(winter)[0] > 0.0, "The trees have gone, too.")
	check_near(_summary(again)[0], full, 0.02 * full, "what leaves cover at last")
	_viewport.free()


# Compatibility reads whatever is at hand for the colours of a multimesh that has none, and the
# meshes' own colours are multiplied by it: normals of leaves and shade of bark.
func test_trees_have_their_meshes_colours() -> void:
	_open_stage(Vector2i(160, 160))
	var shader: Shader = Shader.new()
	shader.code = """shader_type spatial;
render_mode unshaded, cull_disabled;
void fragment() {
	ALBEDO = vec3(COLOR.r, 0.5 + 0.5 * COLOR.g, 0.5 * COLOR.a);
}"""
	var shown: ShaderMaterial = ShaderMaterial.new()
	shown.shader = shader
	var forest: TreeVariantSpawner3D = TreeVariantSpawner3D.new()
	forest.source = grown_tree(3, 120)
	forest.bark_material = shown
	forest.leaf_material = shown
	forest.variants = 2
	forest.levels = 1
	forest.placement = TreeVariantSpawner3D.Placement.GIVEN
	for i: int in 5:
		forest.transforms.append(
			Transform3D(Basis(Vector3.UP, i), Vector3(3.0 * (i - 2), 0.0, 0.0))
		)
	var box: AABB = forest.source.get_aabb()
	_camera.position = box.get_center() + Vector3(0.0, 0.0, 16.0 + box.size.z)
	_viewport.add_child(forest)
	await forest.finished
	var drawn: Image = await _picture()
	forest.visible = false
	for id: int in 5:
		var single: MeshInstance3D = MeshInstance3D.new()
		single.mesh = forest.get_variant_mesh(forest.get_tree_variant(id))
		single.transform = forest.get_tree_transform(id)
		for surface: int in single.mesh.get_surface_count():
			single.set_surface_override_material(surface, shown)
		_viewport.add_child(single)
	var wanted: Image = await _picture()
	check(_summary(wanted)[0] > 0.02, "No tree is to be seen.")
	var difference: float = _difference(drawn, wanted)
	check(difference < 0.005, "A pixel differs by %.4f." % difference)
	_viewport.free()
