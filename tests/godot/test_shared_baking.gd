extends "./suite.gd"
## Baked trees of a kind share files, which any number of programs may make.


func _made(seed: int, name: String) -> TreeReconstruction:
	var made: TreeReconstruction = grown_tree(seed)
	made.leaf_preset = "oak"
	made.resource_name = name
	return made


func _bake(into: String, name: String, seed: int) -> String:
	var baker: TreeBaker = TreeBaker.new()
	baker.form = TreeBaker.Form.MULTIMESH
	baker.levels = 3
	baker.shared_folder = into.path_join("shared")
	var path: String = into.path_join("trees/%s.scn" % name)
	DirAccess.make_dir_recursive_absolute(path.get_base_dir())
	var scene: PackedScene = baker.bake(_made(seed, name))
	check_equal(ResourceSaver.save(scene, path, ResourceSaver.FLAG_COMPRESS), OK, "saving")
	check_equal(baker.get_error_message(), "", "the baker's sentence")
	return path


func test_trees_of_a_kind_share_their_files() -> void:
	var wood: String = folder.path_join("wood")
	var paths: PackedStringArray = [_bake(wood, "oak", 3)]
	var before: PackedStringArray = DirAccess.get_files_at(wood.path_join("shared"))
	paths.append(_bake(wood, "old_oak", 5))
	var after: PackedStringArray = DirAccess.get_files_at(wood.path_join("shared"))
	check(before.size() > 8, "Too little is shared: %s" % before)
	check_equal(after, before, "what a second tree of the kind adds")
	var materials: Dictionary[Material, bool] = {}
	var cards: Dictionary[Mesh, bool] = {}
	for path: String in paths:
		for needed: String in ResourceLoader.get_dependencies(path):
			check("/wood/shared/" in needed, "%s needs %s." % [path, needed])
		var shown: Node3D = (load(path) as PackedScene).instantiate()
		shown.position = Vector3(5.0, 1.0, 2.0)
		shown.scale = 2.0 * Vector3.ONE
		tree.root.add_child(shown)
		for part: Node in shown.find_children("*", "GeometryInstance3D", true, false):
			var mesh: Mesh = null
			if part is MultiMeshInstance3D:
				mesh = (part as MultiMeshInstance3D).multimesh.mesh
				cards[mesh] = true
			else:
				mesh = (part as MeshInstance3D).mesh
			var material: ShaderMaterial = mesh.surface_get_material(0)
			materials[material] = true
			check(not "#include" in material.shader.code, "A shader needs the addon.")
			check_equal(material.get_shader_parameter(&"tree_height"), null, "a shared height")
		# Its own copies know what the shared ones do not.
		var height: float = (shown.get("values") as Dictionary)[&"tree_height"]
		var leaves: Array = shown.get("_leaves")
		var bark: Array = shown.get("_bark")
		check_equal([leaves.size(), bark.size()], [1, 1], "copies of leaves' and barks' materials")
		var leaf: ShaderMaterial = leaves[0]
		check_equal(leaf.get_shader_parameter(&"tree_origin"), shown.position, "where it stands")
		check_near(leaf.get_shader_parameter(&"tree_height"), 2.0 * height, 1e-4, "its height")
		check_equal(bark[0].get_shader_parameter(&"tree_height"), height, "the bark's height")
		shown.position = Vector3(-4.0, 0.0, 9.0)
		# The engine tells of a move before it draws.
		await tree.process_frame
		await tree.process_frame
		check_equal(leaf.get_shader_parameter(&"tree_origin"), shown.position, "where it went")
		shown.free()
	check_equal(materials.size(), 2, "materials of two trees")
	check_equal(cards.size(), 3, "leaf cards of three levels")
	_remove(wood)


func test_the_same_files_whichever_tree_came_first() -> void:
	var digests: Array[Dictionary] = []
	for turn: int in 2:
		var wood: String = folder.path_join("turn_%d" % turn)
		for seed: int in [[3, 5], [5, 3]][turn]:
			_bake(wood, "tree_%d" % seed, seed)
		var found: Dictionary = {}
		var shared: String = wood.path_join("shared")
		for file: String in DirAccess.get_files_at(shared):
			found[file] = FileAccess.get_sha256(shared.path_join(file))
			if file.ends_with(".tres"):
				var text: String = FileAccess.get_file_as_string(shared.path_join(file))
				check(not folder in text, "%s names its folder." % file)
		digests.append(found)
		_remove(wood)
	check(digests[0].size() > 8, "There are too few files.")
	check_equal(digests[1], digests[0], "the files' digests")


func test_a_folder_that_cannot_be_written_is_said() -> void:
	write_text("no_folder", "a file")
	var baker: TreeBaker = TreeBaker.new()
	baker.form = TreeBaker.Form.MULTIMESH
	baker.levels = 1
	baker.shared_folder = folder.path_join("no_folder/shared")
	expect_error("Could not create directory")
	baker.bake(_made(3, "oak"))
	check("cannot be written" in baker.get_error_message(), "it says " + baker.get_error_message())
	check_sentence(baker.get_error_message(), "The baker's word")


func _remove(path: String) -> void:
	for inner: String in DirAccess.get_directories_at(path):
		_remove(path.path_join(inner))
	for file: String in DirAccess.get_files_at(path):
		DirAccess.remove_absolute(path.path_join(file))
	DirAccess.remove_absolute(path)
