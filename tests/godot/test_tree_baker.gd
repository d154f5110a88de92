extends "./suite.gd"
## Baked trees need nothing of the addon.

# The pixels along each side of the picture in which the charts of a lightmap are looked for.
const _CHARTS: int = 512

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
			"child: OldOak_LOD%d MeshInstance3D <null> %d false true" % [level, triangles]
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
		# By such names, and one mesh of both, tools that scatter meshes know the levels.
		check_equal(String(level.name), "OldOak_LOD%d" % i, "the name of level %d" % i)
		check_equal(level.mesh.resource_name, "OldOak_LOD%d" % i, "the name of its mesh")
		check_equal(level.mesh.get_surface_count(), 2, "surfaces of level %d" % i)
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
		var along: PackedFloat32Array = arrays[Mesh.ARRAY_CUSTOM1]
		check_near(along[at + 1], frame.basis.y.normalized().y, 1e-3, "its way")
		check_equal(along[at + 3], custom[1], "the wind code of its primary branch")
		check_equal(arrays[Mesh.ARRAY_CUSTOM2][at + 3], custom[2], "the hue")
		check_equal(
			arrays[Mesh.ARRAY_CUSTOM3][leaf * each],
			custom[3],
			"the wind code of its secondary branch"
		)


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


# How many rounds of the bark end where no whole number of its picture does.
func _count_seams(arrays: Array) -> int:
	var places: PackedVector3Array = arrays[Mesh.ARRAY_VERTEX]
	var normals: PackedVector3Array = arrays[Mesh.ARRAY_NORMAL]
	var uvs: PackedVector2Array = arrays[Mesh.ARRAY_TEX_UV]
	var rounds: Dictionary[Array, PackedFloat32Array] = {}
	for i: int in places.size():
		var where: Array = [places[i], normals[i], uvs[i].y]
		if not rounds.has(where):
			rounds[where] = PackedFloat32Array()
		rounds[where].append(uvs[i].x)
	var met: int = 0
	var seams: int = 0
	for ends: PackedFloat32Array in rounds.values():
		# The middle of a tip or a cut belongs to all its triangles.
		if ends.size() != 2:
			continue
		met += 1
		if absf(ends[1] - ends[0] - roundf(ends[1] - ends[0])) > 1e-4:
			seams += 1
	check(met > 100, "Only %d rounds were found." % met)
	return seams


func test_bark_has_no_seam_under_a_material_of_the_users_own() -> void:
	var baker: TreeBaker = TreeBaker.new()
	baker.levels = 2
	baker.leaves = false
	baker.collision = false
	var made: TreeReconstruction = _made()
	var usual: TreeBaker.Parts = baker.build(made)
	check(_count_seams(usual.bark[0]) > 100, "The addon's shader has no seam to hide.")
	var own: ShaderMaterial = ShaderMaterial.new()
	own.shader = Shader.new()
	for material: Material in [StandardMaterial3D.new(), own]:
		baker.bark_material = material
		var parts: TreeBaker.Parts = baker.build(made)
		for level: int in 2:
			check_equal(_count_seams(parts.bark[level]), 0, "seams of level %d" % level)
			check_equal(
				parts.bark[level][Mesh.ARRAY_VERTEX] as PackedVector3Array,
				usual.bark[level][Mesh.ARRAY_VERTEX] as PackedVector3Array,
				"the wood of level %d" % level
			)


func test_the_body_is_of_the_kind_that_was_asked_for() -> void:
	var baker: TreeBaker = TreeBaker.new()
	baker.levels = 1
	baker.leaves = false
	baker.bark_material = StandardMaterial3D.new()
	baker.collision_shapes = 12
	baker.collision_minimum_radius = 0.02
	var made: TreeReconstruction = _made()
	for kind: int in TreeInstance3D.CollisionKind.values():
		baker.collision_kind = kind as TreeInstance3D.CollisionKind
		var path: String = folder.path_join("body.scn")
		check_equal(ResourceSaver.save(baker.bake(made), path), OK, "saving")
		var root: Node3D = (
			ResourceLoader.load(path, "", ResourceLoader.CACHE_MODE_IGNORE).instantiate()
		)
		var body: StaticBody3D = root.get_node("Wood")
		var parts: Array[Dictionary]
		if kind == TreeInstance3D.CollisionKind.CAPSULES:
			parts = made.build_capsules(12, 0.02)
		else:
			var trunk: bool = kind == TreeInstance3D.CollisionKind.TRUNK_ONLY
			parts = made.build_convex_parts(12, 0.02, trunk)
		check(parts.size() > 0 and parts.size() <= 12, "%d parts." % parts.size())
		check_equal(body.get_child_count(), parts.size(), "shapes of kind %d" % kind)
		for i: int in body.get_child_count():
			var shape: Shape3D = (body.get_child(i) as CollisionShape3D).shape
			if kind == TreeInstance3D.CollisionKind.CAPSULES:
				check(shape is CapsuleShape3D, "Shape %d is no capsule." % i)
				check_near((shape as CapsuleShape3D).radius, parts[i].radius, 1e-6, "its radius")
			else:
				check(shape is ConvexPolygonShape3D, "Shape %d is no convex part." % i)
				check_equal((shape as ConvexPolygonShape3D).points, parts[i].points, "its points")
		root.free()
	var usual: TreeBaker = TreeBaker.new()
	usual.levels = 1
	usual.leaves = false
	check_equal(usual.build(made).shapes, made.build_capsules(), "what is usual")


func test_leaves_as_a_multimesh_need_no_addon_either() -> void:
	var baker: TreeBaker = TreeBaker.new()
	baker.levels = 2
	baker.form = TreeBaker.Form.MULTIMESH
	baker.collision = false
	var made: TreeReconstruction = _made()
	var path: String = folder.path_join("oak.scn")
	check_equal(ResourceSaver.save(baker.bake(made), path), OK, "saving")
	check_equal(ResourceLoader.get_dependencies(path), PackedStringArray(), "what it depends on")
	var root: Node3D = (load(path) as PackedScene).instantiate()
	var script: String = (root.get_script() as GDScript).source_code
	check(not "TreeReconstruction" in script and not "res://" in script, "It asks for the addon.")
	tree.root.add_child(root)
	root.position = Vector3(3.0, 1.0, -2.0)
	await tree.process_frame
	for i: int in 2:
		var level: MeshInstance3D = root.get_node("%s_LOD%d" % [root.name, i])
		check_equal((level.mesh as ArrayMesh).get_surface_count(), 1, "surfaces of the bark")
		var leaves: MultiMeshInstance3D = level.get_node("Leaves")
		@warning_ignore("integer_division")
		var count: int = made.build_leaf_buffer(i).size() / 20
		check_equal(leaves.multimesh.instance_count, count, "leaves of level %d" % i)
		check_equal(leaves.multimesh.buffer, made.build_leaf_buffer(i), "their places")
		check_equal(leaves.visibility_range_begin, level.visibility_range_begin, "where they begin")
		check_equal(leaves.visibility_range_end, level.visibility_range_end, "where they end")
		check(leaves.custom_aabb.encloses(leaves.multimesh.get_aabb()), "Leaves stick out.")
		var told: Variant = leaves.get_instance_shader_parameter(&"tree_origin")
		check_equal(told, root.position, "where the leaves think that their tree is")
	root.free()


# No two triangles of the bark have a texel in common, and all are in the picture.
func test_charts_of_a_lightmap_do_not_overlap() -> void:
	var baker: TreeBaker = TreeBaker.new()
	baker.levels = 2
	baker.lightmap_uv2 = true
	baker.collision = false
	var made: TreeReconstruction = _made()
	var root: Node3D = baker.bake(made).instantiate()
	for level: int in 2:
		var node: MeshInstance3D = root.get_node("%s_LOD%d" % [root.name, level])
		var leaves: MeshInstance3D = node.get_node("Leaves")
		check_equal(leaves.gi_mode, GeometryInstance3D.GI_MODE_DYNAMIC, "how the leaves are lit")
		var mesh: ArrayMesh = node.mesh as ArrayMesh
		if level > 0:
			# The engine would bake both levels, and each in the other's shadow.
			check_equal(node.gi_mode, GeometryInstance3D.GI_MODE_DYNAMIC, "how it is lit afar")
			check_equal(mesh.lightmap_size_hint, Vector2i.ZERO, "its lightmap")
			continue
		check(mesh.lightmap_size_hint.x > 16, "The lightmap has no size.")
		check_equal(node.gi_mode, GeometryInstance3D.GI_MODE_STATIC, "how the bark is lit")
		var arrays: Array = mesh.surface_get_arrays(0)
		var plain: Array = made.build_mesh_arrays(level)
		check_equal(
			(arrays[Mesh.ARRAY_INDEX] as PackedInt32Array).size(),
			(plain[Mesh.ARRAY_INDEX] as PackedInt32Array).size(),
			"triangles"
		)
		_check_charts(arrays)
		var size: Vector2i = mesh.lightmap_size_hint
		check_equal(_touching(arrays, size), 0, "texels of two charts that touch")
		@warning_ignore("integer_division")
		check(_touching(arrays, size / 8) > 0, "Nothing touches in an eighth of it, either.")
		_check_kept(arrays, plain)
	root.free()


# Light would come in from a chart's neighbour: so at the lightmap's own size, the texels whose
# middle is in a chart have none of another chart beside them. Returns how many have.
func _touching(arrays: Array, size: Vector2i) -> int:
	var uvs: PackedVector2Array = arrays[Mesh.ARRAY_TEX_UV2]
	var indices: PackedInt32Array = arrays[Mesh.ARRAY_INDEX]
	# Which vertex stands for a vertex's chart. The bark's own seam goes through charts: there, two
	# vertices are in one place of both.
	var charts: PackedInt32Array = []
	var known: Dictionary[Array, int] = {}
	for i: int in uvs.size():
		charts.append(known.get_or_add([uvs[i], arrays[Mesh.ARRAY_VERTEX][i]], i))
	for at: int in range(0, indices.size(), 3):
		for i: int in [1, 2]:
			charts[_root(charts, indices[at + i])] = _root(charts, indices[at])
	var owner: PackedInt32Array = []
	owner.resize(size.x * size.y)
	for at: int in range(0, indices.size(), 3):
		var corners: PackedVector2Array = []
		for i: int in 3:
			corners.append(uvs[indices[at + i]] * Vector2(size))
		var box: Rect2 = Rect2(corners[0], Vector2.ZERO).expand(corners[1]).expand(corners[2])
		for y: int in range(floori(box.position.y), ceili(box.end.y)):
			for x: int in range(floori(box.position.x), ceili(box.end.x)):
				if Geometry2D.point_is_inside_triangle(
					Vector2(x + 0.5, y + 0.5), corners[0], corners[1], corners[2]
				):
					owner[y * size.x + x] = _root(charts, indices[at]) + 1
	var touching: int = 0
	for y: int in size.y - 1:
		for x: int in size.x - 1:
			var here: int = owner[y * size.x + x]
			for beside: int in [owner[y * size.x + x + 1], owner[(y + 1) * size.x + x]]:
				if here != 0 and beside != 0 and here != beside:
					touching += 1
	return touching


func _root(charts: PackedInt32Array, vertex: int) -> int:
	while charts[vertex] != vertex:
		charts[vertex] = charts[charts[vertex]]
		vertex = charts[vertex]
	return vertex


func _check_charts(arrays: Array) -> void:
	var uvs: PackedVector2Array = arrays[Mesh.ARRAY_TEX_UV2]
	var indices: PackedInt32Array = arrays[Mesh.ARRAY_INDEX]
	var outside: int = 0
	for uv: Vector2 in uvs:
		if not Rect2(0.0, 0.0, 1.0, 1.0).grow(1e-4).has_point(uv):
			outside += 1
	check_equal(outside, 0, "vertices outside the lightmap")
	var owner: PackedInt32Array = []
	owner.resize(_CHARTS * _CHARTS)
	var covered: int = 0
	var twice: int = 0
	for at: int in range(0, indices.size(), 3):
		# A little smaller, so that neighbours don't share the texels of their edge.
		var corners: PackedVector2Array = []
		var middle: Vector2 = (uvs[indices[at]] + uvs[indices[at + 1]] + uvs[indices[at + 2]]) / 3.0
		for i: int in 3:
			corners.append(_CHARTS * (middle + 0.999 * (uvs[indices[at + i]] - middle)))
		var box: Rect2 = Rect2(corners[0], Vector2.ZERO).expand(corners[1]).expand(corners[2])
		for y: int in range(floori(box.position.y), ceili(box.end.y)):
			for x: int in range(floori(box.position.x), ceili(box.end.x)):
				var point: Vector2 = Vector2(x + 0.5, y + 0.5)
				if not Geometry2D.point_is_inside_triangle(
					point, corners[0], corners[1], corners[2]
				):
					continue
				covered += 1
				if owner[y * _CHARTS + x] != 0:
					twice += 1
				owner[y * _CHARTS + x] = at + 1
	@warning_ignore("integer_division")
	check(covered > _CHARTS * _CHARTS / 20, "Only %d texels are covered." % covered)
	check_equal(twice, 0, "texels covered twice")


# All that the shaders need is still there, vertex by vertex.
func _check_kept(arrays: Array, plain: Array) -> void:
	var mesh: ArrayMesh = ArrayMesh.new()
	mesh.add_surface_from_arrays(
		Mesh.PRIMITIVE_TRIANGLES, plain, [], {}, TreeReconstruction.MESH_FLAGS
	)
	var known: Dictionary[PackedByteArray, bool] = {}
	for vertex: PackedByteArray in _vertices(mesh.surface_get_arrays(0)):
		known[vertex] = true
	var strange: int = 0
	var seen: Dictionary[PackedByteArray, bool] = {}
	for vertex: PackedByteArray in _vertices(arrays):
		if not known.has(vertex):
			strange += 1
		seen[vertex] = true
	check_equal(strange, 0, "vertices that the bark doesn't have")
	check_equal(seen.size(), known.size(), "vertices that it has")


# Each vertex with all that belongs to it, but its place in the lightmap.
func _vertices(arrays: Array) -> Array[PackedByteArray]:
	var places: PackedVector3Array = arrays[Mesh.ARRAY_VERTEX]
	var kinds: Array[int] = []
	for kind: int in Mesh.ARRAY_MAX:
		if arrays[kind] != null and not kind in [Mesh.ARRAY_INDEX, Mesh.ARRAY_TEX_UV2]:
			kinds.append(kind)
	var found: Array[PackedByteArray] = []
	for i: int in places.size():
		var vertex: Array = []
		for kind: int in kinds:
			@warning_ignore("integer_division")
			var each: int = arrays[kind].size() / places.size()
			vertex.append(arrays[kind].slice(each * i, each * i + each))
		found.append(var_to_bytes(vertex))
	return found
