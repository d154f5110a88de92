extends "./suite.gd"
## Baked trees need nothing of the addon.

# Runs in a project that has never seen the addon.
const _GAME: String = """
extends SceneTree

func _initialize() -> void:
	var root: Node3D = (load("res://oak.scn") as PackedScene).instantiate()
	get_root().add_child(root)
	print("known: ", ClassDB.class_exists(&"TreeReconstruction"))
	for child: Node in root.get_children():
		var words: PackedStringArray = [child.name, child.get_class(), str(child.get_script())]
		if child is MeshInstance3D:
			var mesh: Mesh = child.mesh
			for i: int in mesh.get_surface_count():
				var material: ShaderMaterial = mesh.surface_get_material(i)
				var picture: Texture2D = material.get_shader_parameter("albedo_texture")
				words.append("%d %s %s" % [
					mesh.surface_get_array_index_len(i) / 3,
					material.shader.code.contains("#include"),
					picture.get_size().x > 16.0])
		else:
			words.append(str(child.get_child_count() > 0))
		print("child: ", " ".join(words))
	quit()
"""


func _made() -> TreeReconstruction:
	var made: TreeReconstruction = grown_tree(3)
	made.leaf_preset = "oak"
	made.resource_name = "old oak"
	return made


func test_a_baked_scene_needs_no_addon() -> void:
	var baker: TreeBaker = TreeBaker.new()
	baker.levels = 3
	var made: TreeReconstruction = _made()
	var game: String = folder.path_join("game")
	DirAccess.make_dir_recursive_absolute(game)
	var scene: String = game.path_join("oak.scn")
	check_equal(ResourceSaver.save(baker.bake(made), scene), OK, "saving")
	check_equal(ResourceLoader.get_dependencies(scene), PackedStringArray(), "what it depends on")
	write_text("game/project.godot", 'config_version=5\n[application]\nconfig/name="Game"\n')
	write_text("game/look.gd", _GAME)
	var output: Array = []
	var code: int = OS.execute(
		OS.get_executable_path(),
		["--headless", "--path", game, "--script", "res://look.gd"],
		output,
		true
	)
	var text: String = "".join(output)
	check_equal(code, 0, "the game's exit code")
	check("known: false" in text, "The game knows the addon: " + text)
	for level: int in 3:
		var bark: Array = made.build_mesh_arrays(level)
		@warning_ignore("integer_division")
		var triangles: int = (bark[Mesh.ARRAY_INDEX] as PackedInt32Array).size() / 3
		var wanted: String = (
			"child: Level%d MeshInstance3D <null> %d false true" % [level, triangles]
		)
		check(wanted in text, "No '%s' in: %s" % [wanted, text])
	check("child: Wood StaticBody3D <null> true" in text, "No body in: " + text)
	check(not "ERROR" in text, text)
	for file: String in DirAccess.get_files_at(game):
		DirAccess.remove_absolute(game.path_join(file))
	_remove(game)


# With the engine's own folder in it.
func _remove(path: String) -> void:
	var opened: DirAccess = DirAccess.open(path)
	opened.include_hidden = true
	for inner: String in opened.get_directories():
		_remove(path.path_join(inner))
	for file: String in opened.get_files():
		opened.remove(file)
	DirAccess.remove_absolute(path)


func test_levels_take_turns_and_share_their_box() -> void:
	var baker: TreeBaker = TreeBaker.new()
	baker.distances = PackedFloat32Array([7.0])
	baker.collision = false
	var root: Node3D = baker.bake(_made()).instantiate()
	check_equal(String(root.name), "OldOak", "the name")
	check_equal(root.get_child_count(), 4, "levels")
	var last: float = 0.0
	var box: AABB
	for i: int in root.get_child_count():
		var level: MeshInstance3D = root.get_child(i)
		check_equal(level.visibility_range_begin, last, "where level %d begins" % i)
		last = level.visibility_range_end
		if i == 0:
			box = (level.mesh as ArrayMesh).custom_aabb
			check_equal(last, 7.0, "where it ends")
		check_equal((level.mesh as ArrayMesh).custom_aabb, box, "the box of level %d" % i)
		check(box.encloses((level.mesh as ArrayMesh).get_aabb()), "Level %d sticks out." % i)
		check(last > 0.0 or i == 3, "Level %d has no end." % i)
	check_equal(last, 0.0, "the end of the last one")
	check(box.encloses(_made().get_aabb()), "The tree is not in its box.")
	root.free()


# As a MultiMesh keeps it: row by row.
static func _frame(rows: PackedFloat32Array) -> Transform3D:
	var frame: Transform3D
	for row: int in 3:
		for column: int in 3:
			frame.basis[column][row] = rows[4 * row + column]
		frame.origin[row] = rows[4 * row + 3]
	return frame


func test_all_leaves_are_there() -> void:
	var made: TreeReconstruction = _made()
	var buffer: PackedFloat32Array = made.build_leaf_buffer()
	var card: Array = made.build_leaf_form_arrays()
	var arrays: Array = made.build_joined_leaf_arrays()
	@warning_ignore("integer_division")
	var count: int = buffer.size() / 20
	var each: int = (card[Mesh.ARRAY_VERTEX] as PackedVector3Array).size()
	var places: PackedVector3Array = arrays[Mesh.ARRAY_VERTEX]
	check_equal(places.size(), count * each, "vertices")
	for leaf: int in range(0, count, 7):
		var frame: Transform3D = _frame(buffer.slice(20 * leaf, 20 * leaf + 12))
		for i: int in each:
			var place: Vector3 = frame * (card[Mesh.ARRAY_VERTEX] as PackedVector3Array)[i]
			check(places[leaf * each + i].distance_to(place) < 1e-4, "Leaf %d is elsewhere." % leaf)
		var custom: PackedFloat32Array = buffer.slice(20 * leaf + 16, 20 * leaf + 20)
		var at: int = 4 * leaf * each
		check_near(arrays[Mesh.ARRAY_CUSTOM0][at + 3], custom[0], 1e-3, "the phase")
		var bytes: PackedByteArray = arrays[Mesh.ARRAY_CUSTOM1]
		check_near(bytes.decode_s8(at + 1) / 127.0, frame.basis.y.normalized().y, 0.01, "its way")
		check_near(bytes.decode_s8(at + 3) / 127.0, custom[3], 0.01, "the stiffness")
		bytes = arrays[Mesh.ARRAY_CUSTOM2]
		check_near(bytes.decode_s8(at + 3) / 127.0, custom[2], 0.01, "the hue")


func test_baking_can_be_cancelled() -> void:
	var asked: Array[int] = [0]
	var ended: Callable = func() -> bool:
		asked[0] += 1
		return asked[0] > 2
	check(TreeBaker.new().build(_made(), ended) == null, "It went on.")


func test_a_material_of_the_users_own_stays() -> void:
	var baker: TreeBaker = TreeBaker.new()
	baker.levels = 1
	baker.leaves = false
	baker.bark_material = StandardMaterial3D.new()
	var made: TreeReconstruction = _made()
	var meshes: Array[ArrayMesh] = baker.make_meshes(made, baker.build(made))
	check_equal(meshes[0].get_surface_count(), 1, "surfaces without leaves")
	check_equal(meshes[0].surface_get_material(0), baker.bark_material, "the material")
