extends "./suite.gd"
## What of impostors needs no picture: render_impostor.gd looks at them.

const Views := preload("res://addons/tree_reconstruction/baking/impostor_views.gd")
const SHADER: Shader = preload("res://addons/tree_reconstruction/shaders/impostor.gdshader")
const Shaders := preload("res://addons/tree_reconstruction/baking/impostor_shaders.gd")


func test_without_a_window_it_says_so() -> void:
	var baker: TreeImpostorBaker = TreeImpostorBaker.new()
	check(await baker.bake(grown_tree(3)) == null, "It baked without a renderer.")
	check_sentence(baker.get_error_message(), "the reason")
	check("--headless" in baker.get_error_message(), baker.get_error_message())
	check(await baker.bake(null) == null, "It baked nothing.")
	check_sentence(baker.get_error_message(), "the reason without a tree")


func test_views_are_all_around() -> void:
	for full_sphere: bool in [false, true]:
		for views: int in [3, 8, 12]:
			var seen: Dictionary[Vector3, bool] = {}
			var least: float = 1.0
			for cell: int in views * views:
				@warning_ignore("integer_division")
				var way: Vector3 = Views.direction(cell % views, cell / views, views, full_sphere)
				check_near(way.length(), 1.0, 1e-5, "the length of a direction")
				least = minf(least, way.y)
				seen[way.snapped(Vector3.ONE * 1e-4)] = true
				var axes: Basis = Views.axes(way)
				check(axes.is_conformal(), "The camera's axes are crooked.")
				check(axes.z.is_equal_approx(way), "The camera looks elsewhere.")
				check_near(axes.determinant(), 1.0, 1e-4, "the determinant of the axes")
			# Folded over the whole sphere, each half of the square's edges meets the other half.
			var twice: int = 2 * (views - 1) + 1 if full_sphere else 0
			check(
				seen.size() >= views * views - twice, "%d views, %d differ." % [views, seen.size()]
			)
			check_near(least, -1.0 if full_sphere else 0.0, 1e-4, "the lowest view")


func test_any_spatial_shader_can_be_drawn_without_light() -> void:
	var codes: PackedStringArray = [
		"shader_type spatial;\nvoid fragment() {\n\tALBEDO = vec3(1.0);\n}\n",
		"shader_type spatial;\nrender_mode cull_disabled;\n",
		"""shader_type spatial; // {
render_mode unshaded;
void fragment() { if (true) { ALPHA = 0.5; } /* } */ ALPHA_SCISSOR_THRESHOLD = 0.4; }
void light() { DIFFUSE_LIGHT += ALBEDO; }
""",
	]
	for code: String in codes:
		var changed: String = Shaders.changed(code)
		check_equal(changed.count("unshaded"), 1, "unshaded in " + changed)
		check_equal(changed.count("{"), changed.count("}"), "braces in " + changed)
		check("impostor_shown" in changed, "Nothing is shown by " + changed)
		var shader: Shader = Shader.new()
		shader.code = changed
		check_equal(shader.get_mode(), Shader.MODE_SPATIAL, "its kind")
		var discards: bool = "discard" in changed
		check_equal(discards, "SCISSOR" in code, "whether it cuts out")


func test_it_knows_its_tree() -> void:
	var made: TreeReconstruction = grown_tree(4)
	made.leaf_rule = LeafRule.from_preset("oak")
	var impostor: TreeImpostor = TreeImpostor.new()
	impostor.fingerprint = TreeImpostor.fingerprint_of(made)
	check(impostor.is_of(made), "It is of another tree.")
	check(impostor.is_of(made.duplicate() as TreeReconstruction), "It is not of its copy.")
	made.leaf_rule.leaf_size *= 1.5
	check(not impostor.is_of(made), "Larger leaves are the same.")
	made.leaf_rule.leaf_size /= 1.5
	made.edit("prune_order order=1")
	check(not impostor.is_of(made), "A pruned tree is the same.")


func test_a_newer_one_is_refused() -> void:
	expect_error("newer version")
	var impostor: TreeImpostor = TreeImpostor.new()
	impostor.format_version = TreeImpostor.FORMAT_VERSION + 1


func test_the_card_lies_in_the_box() -> void:
	var impostor: TreeImpostor = TreeImpostor.new()
	impostor.material = ShaderMaterial.new()
	impostor.box = AABB(Vector3(-2.0, -0.1, -1.5), Vector3(4.0, 6.0, 3.0))
	impostor.height = 5.5
	var mesh: ArrayMesh = impostor.get_mesh()
	check(impostor.box.grow(1e-4).encloses(mesh.get_aabb()), "It sticks out.")
	check(mesh.custom_aabb.encloses(impostor.box), "It is culled too early.")
	check_equal(impostor.get_mesh(), mesh, "the mesh asked for again")
	check_equal(mesh.surface_get_array_index_len(0), 24, "indices")
	impostor.height = 7.0
	check(impostor.get_mesh() != mesh, "It is the mesh of another height.")


func test_a_baked_scene_ends_in_the_card() -> void:
	var made: TreeReconstruction = grown_tree(3)
	var impostor: TreeImpostor = TreeImpostor.new()
	impostor.material = ShaderMaterial.new()
	impostor.material.shader = SHADER
	var texture: PortableCompressedTexture2D = PortableCompressedTexture2D.new()
	texture.keep_compressed_buffer = true
	texture.create_from_image(
		Image.create_empty(16, 16, true, Image.FORMAT_RGBA8),
		PortableCompressedTexture2D.COMPRESSION_MODE_LOSSLESS
	)
	impostor.material.set_shader_parameter(&"albedo_texture", texture)
	impostor.box = made.get_aabb()
	var own: String = folder.path_join("oak.impostor.res")
	check_equal(ResourceSaver.save(impostor, own), OK, "saving the impostor")
	var baker: TreeBaker = TreeBaker.new()
	baker.levels = 2
	baker.leaves = false
	baker.collision = false
	baker.impostor = load(own) as TreeImpostor
	var path: String = folder.path_join("oak.scn")
	check_equal(ResourceSaver.save(baker.bake(made), path), OK, "saving the scene")
	check_equal(ResourceLoader.get_dependencies(path), PackedStringArray(), "what it depends on")
	var root: Node3D = (load(path) as PackedScene).instantiate()
	check_equal(root.get_child_count(), 3, "levels")
	var last: MeshInstance3D = root.get_child(1)
	var card: MeshInstance3D = root.get_child(2)
	check_equal(String(card.name), "%s_LOD2" % root.name, "the name")
	check_equal(card.visibility_range_begin, last.visibility_range_end, "where it begins")
	check(card.visibility_range_begin > 10.0, "It begins at once.")
	check_equal(card.visibility_range_end, 0.0, "where it ends")
	check_equal(
		(card.mesh as ArrayMesh).custom_aabb, (last.mesh as ArrayMesh).custom_aabb, "its box"
	)
	var material: ShaderMaterial = card.mesh.surface_get_material(0) as ShaderMaterial
	check("#define TREE_BAKED" in material.shader.code, "It is not a baked one.")
	check(not "#include" in material.shader.code, "It needs the addon.")
	check(material.get_shader_parameter(&"albedo_texture") is Texture2D, "It lost its picture.")
	root.free()


func test_a_tree_shows_it_beyond_its_last_level() -> void:
	var impostor: TreeImpostor = TreeImpostor.new()
	impostor.material = ShaderMaterial.new()
	impostor.material.shader = SHADER
	var made: TreeReconstruction = grown_tree(3)
	impostor.box = made.get_aabb()
	var node: TreeInstance3D = TreeInstance3D.new()
	node.levels = 2
	node.level_distances = PackedFloat32Array([10.0, 30.0])
	node.reconstruction = made
	node.impostor = impostor
	tree.root.add_child(node)
	while node.is_building_levels():
		await tree.process_frame
	var card: MeshInstance3D = node.find_child("Impostor", false, false)
	check(card != null, "There is no card.")
	if card == null:
		return
	check_equal(card.mesh, impostor.get_mesh(), "what it shows")
	check_equal(card.custom_aabb, node.mesh.custom_aabb, "its box")
	check(card.visible, "It is hidden.")
	check(
		card.visibility_range_begin > 20.0 and card.visibility_range_begin < 30.0,
		"It begins at %.1f m." % card.visibility_range_begin
	)
	check_equal(card.visibility_range_end, 0.0, "where it ends")
	var last: MeshInstance3D = node.find_child("Level1", false, false)
	check(
		last.visibility_range_end > card.visibility_range_begin,
		"The last level ends at %.1f m." % last.visibility_range_end
	)
	node.lod = 1
	while node.is_building_levels():
		await tree.process_frame
	await tree.process_frame
	check(node.find_child("Impostor", false, false) == null, "A pinned level has a card.")
	node.lod = -1
	while node.is_building_levels():
		await tree.process_frame
	check(node.find_child("Impostor", false, false) != null, "It does not come back.")
	node.impostor = null
	await tree.process_frame
	check(node.find_child("Impostor", false, false) == null, "It stays without an impostor.")
	last = node.find_child("Level1", false, false)
	check_equal(last.visibility_range_end, 0.0, "the end of the last level without it")
	node.free()
