extends "./suite.gd"
## TreeInstance3D: what it shows, when it builds, what it saves.

const BuildJob := preload("res://addons/tree_reconstruction/nodes/tree_build_job.gd")
const LIMIT_FRAMES: int = 2000


# Counts once a frame: who awaits process_frame comes before or after its other listeners, in turn.
class PerFrame:
	extends Node
	var count: Callable
	var counts: PackedInt64Array = []

	func _process(_delta: float) -> void:
		counts.append(count.call() as int)


func _instance(made: TreeReconstruction) -> TreeInstance3D:
	var instance: TreeInstance3D = TreeInstance3D.new()
	instance.reconstruction = made
	tree.root.add_child(instance)
	return instance


func _settle(instance: TreeInstance3D) -> void:
	for i: int in LIMIT_FRAMES:
		if not instance.is_rebuilding():
			return
		await tree.process_frame
	check(false, "The build did not end.")


func _settle_levels(instance: TreeInstance3D) -> void:
	for i: int in LIMIT_FRAMES:
		if not instance.is_building_levels():
			return
		await tree.process_frame
	check(false, "The levels did not end.")


func _leaves_of(instance: TreeInstance3D) -> MultiMeshInstance3D:
	for child: Node in instance.get_children(true):
		if child is MultiMeshInstance3D:
			return child
	return null


func _leaf_nodes(instance: TreeInstance3D) -> int:
	var count: int = 0
	for child: Node in instance.get_children(true):
		count += 1 if child is MultiMeshInstance3D else 0
	return count


func test_shows_bark_and_leaves_with_and_without_threads() -> void:
	for threads: bool in [false, true]:
		TreeInstance3D.threaded = threads
		var made: TreeReconstruction = grown_tree(2)
		var instance: TreeInstance3D = _instance(made)
		await _settle(instance)
		check(instance.mesh != null and instance.mesh.get_surface_count() == 1, "There is no bark.")
		check_equal(instance.get_leaf_count(), made.build_leaves().instance_count, "the leaves")
		check(instance.get_triangle_count() > 100, "There are too few triangles.")
		check(instance.mesh.surface_get_material(0) is ShaderMaterial, "The bark has no material.")
		check(
			_leaves_of(instance).material_override is ShaderMaterial, "The leaves have no material."
		)
		check_equal(instance.get_child_count(), 0, "the number of visible children")
		instance.free()
	TreeInstance3D.threaded = true


func test_many_changes_make_one_build() -> void:
	for threads: bool in [false, true]:
		TreeInstance3D.threaded = threads
		var instance: TreeInstance3D = _instance(grown_tree(2))
		await _settle(instance)
		var count: Array[int] = [0]
		instance.rebuilt.connect(func() -> void: count[0] += 1)
		for i: int in 5:
			instance.reconstruction.seed = i
			instance.lod = i % 2
		check_equal(count[0], 0, "the builds before the frame ends")
		await _settle(instance)
		check_equal(count[0], 1, "the builds")
		instance.free()
	TreeInstance3D.threaded = true


func test_a_change_during_a_build_starts_another() -> void:
	var instance: TreeInstance3D = _instance(grown_tree(2, 3000))
	await tree.process_frame
	var other: TreeReconstruction = grown_tree(7)
	instance.reconstruction = other
	await _settle(instance)
	check_equal(
		instance.mesh.surface_get_array_len(0),
		other.build_mesh().surface_get_array_len(0),
		"the vertices shown"
	)
	instance.free()


func test_can_be_freed_or_removed_while_building() -> void:
	for i: int in 10:
		var instance: TreeInstance3D = _instance(grown_tree(i, 2000))
		for frame: int in i % 3:
			await tree.process_frame
		instance.free()
	var removed: TreeInstance3D = _instance(grown_tree(1, 2000))
	await tree.process_frame
	tree.root.remove_child(removed)
	await _settle(removed)
	check(removed.mesh != null, "A removed node was not built.")
	tree.root.add_child(removed)
	check(removed.get_leaf_count() > 0, "Its leaves are gone.")
	removed.queue_free()
	await tree.process_frame


func test_nothing_to_show() -> void:
	var instance: TreeInstance3D = _instance(grown_tree(2))
	await _settle(instance)
	instance.reconstruction = null
	await _settle(instance)
	check(instance.mesh == null and instance.get_leaf_count() == 0, "The old tree is still there.")
	check_equal(instance._get_configuration_warnings().size(), 1, "the warnings")
	instance.reconstruction = TreeReconstruction.new()
	await _settle(instance)
	check_equal(instance.get_triangle_count(), 0, "an empty tree's triangles")
	instance.free()


func test_leaves_switch_and_level() -> void:
	var instance: TreeInstance3D = _instance(grown_tree(2))
	await _settle(instance)
	var full: int = instance.get_triangle_count()
	instance.leaves = false
	await _settle(instance)
	check_equal(instance.get_leaf_count(), 0, "the leaves")
	instance.leaves = true
	instance.lod = 2
	await _settle(instance)
	check(instance.get_leaf_count() > 0, "The leaves did not come back.")
	check(instance.get_triangle_count() < full, "Level 2 is as heavy as level 0.")
	instance.free()


func test_own_materials() -> void:
	var instance: TreeInstance3D = _instance(grown_tree(2))
	var bark: StandardMaterial3D = StandardMaterial3D.new()
	var leaf: StandardMaterial3D = StandardMaterial3D.new()
	instance.bark_material = bark
	instance.leaf_material = leaf
	await _settle(instance)
	check(instance.mesh.surface_get_material(0) == bark, "The bark has another material.")
	check(_leaves_of(instance).material_override == leaf, "The leaves have another material.")
	instance.bark_material = null
	check(instance.mesh.surface_get_material(0) is ShaderMaterial, "The preset did not come back.")
	instance.free()


func test_every_preset_has_materials() -> void:
	for name: String in TreeReconstruction.get_leaf_preset_names():
		var made: TreeReconstruction = grown_tree(2)
		made.leaf_preset = name
		var instance: TreeInstance3D = _instance(made)
		await _settle(instance)
		var bark: ShaderMaterial = instance.mesh.surface_get_material(0)
		for texture: String in ["albedo_texture", "normal_texture", "roughness_texture"]:
			check(
				bark.get_shader_parameter(texture) is Texture2D,
				"%s bark has no %s." % [name, texture]
			)
		if _leaves_of(instance) != null:
			var leaf: ShaderMaterial = _leaves_of(instance).material_override
			for texture: String in ["albedo_texture", "normal_texture"]:
				check(
					leaf.get_shader_parameter(texture) is Texture2D,
					"%s leaves have no %s." % [name, texture]
				)
		instance.free()


func test_duplicates_do_not_double_the_leaves() -> void:
	var instance: TreeInstance3D = _instance(grown_tree(2))
	await _settle(instance)
	await _settle_levels(instance)
	var copy: TreeInstance3D = instance.duplicate() as TreeInstance3D
	tree.root.add_child(copy)
	await _settle_levels(copy)
	check_equal(_leaf_nodes(copy), _leaf_nodes(instance), "the copy's leaf nodes")
	check_equal(copy.get_leaf_count(), instance.get_leaf_count(), "the copy's leaves")
	copy.leaves = false
	await _settle(copy)
	check_equal(copy.get_leaf_count(), 0, "the copy's leaves")
	check(instance.get_leaf_count() > 0, "The original lost its leaves.")
	copy.free()
	instance.free()


# Bark has what leaves leave of a level's triangles: much of it is built again with them.
func test_bark_gives_way_to_leaves() -> void:
	var oak: LSystem = LSystem.new()
	oak.grammar = LSystem.get_preset("oak")
	var made: TreeReconstruction = oak.grow()
	made.leaf_rule = LeafRule.new()
	var instance: TreeInstance3D = _instance(made)
	var counts: PackedInt64Array = []
	for area: float in [0.2, 8.0, 0.2]:
		made.leaf_rule.leaf_area_index = area
		await tree.process_frame
		await _settle(instance)
		check(
			instance.get_triangle_count() <= 60000, "%d triangles" % instance.get_triangle_count()
		)
		var bark: PackedInt32Array = instance.mesh.surface_get_arrays(0)[Mesh.ARRAY_INDEX]
		counts.append(bark.size() / 3)
	check(counts[0] > counts[1] + 3000, "The bark has %s triangles." % counts)
	check_equal(counts[2], counts[0], "triangles with few leaves again")
	instance.free()


func test_scenes_hold_the_tree_but_not_its_mesh() -> void:
	var instance: TreeInstance3D = TreeInstance3D.new()
	instance.name = "Tree"
	instance.reconstruction = grown_tree(2)
	tree.root.add_child(instance)
	await _settle(instance)
	var scene: PackedScene = PackedScene.new()
	check_equal(scene.pack(instance), OK, "packing")
	var path: String = folder.path_join("tree.tscn")
	check_equal(ResourceSaver.save(scene, path), OK, "saving")
	var text: String = FileAccess.get_file_as_string(path)
	for word: String in ["ArrayMesh", "MultiMesh", "mesh =", "shader_parameter", "Leaves"]:
		check(not word in text, "The scene holds %s." % word)
	check("TreeReconstruction" in text, "The scene lacks the tree.")
	var read: PackedScene = ResourceLoader.load(path, "", ResourceLoader.CACHE_MODE_IGNORE)
	var again: TreeInstance3D = read.instantiate() as TreeInstance3D
	tree.root.add_child(again)
	await _settle(again)
	check_equal(again.get_triangle_count(), instance.get_triangle_count(), "the triangles")
	check_equal(again.get_leaf_count(), instance.get_leaf_count(), "the leaves")
	again.free()
	instance.free()


# The box of the bark and of the leaves that stand on it, by their vertices.
func _drawn_box(made: TreeReconstruction, lod: int) -> AABB:
	var places: PackedVector3Array = made.build_mesh_arrays(lod)[Mesh.ARRAY_VERTEX]
	for part: Dictionary in made.build_joined_foliage(lod):
		if not (part.arrays as Array).is_empty():
			places.append_array(part.arrays[Mesh.ARRAY_VERTEX])
	var box: AABB = AABB(places[0], Vector3.ZERO)
	for place: Vector3 in places:
		box = box.expand(place)
	return box


# With leaves and without, in the wind and in still air, at a level of its own.
func test_the_box_of_a_level_is_tight_around_bark_and_leaves() -> void:
	for trial: int in 6:
		var made: TreeReconstruction = grown_tree(trial + 2)
		made.leaf_preset = ["oak", "birch", "none"][trial % 3]
		var instance: TreeInstance3D = _instance(made)
		instance.lod = trial % 3
		instance.wind = trial % 2 == 0
		await _settle(instance)
		var drawn: AABB = _drawn_box(made, instance.lod)
		var box: AABB = (instance.mesh as ArrayMesh).custom_aabb
		check(box.grow(1e-4).encloses(drawn), "%s has no room for %s." % [box, drawn])
		var most: float = 0.0 if made.leaf_preset == "none" else 0.05 * instance.get_tree_height()
		check(drawn.grow(most + 1e-4).encloses(box), "%s is wider than %s." % [box, drawn])
		check(drawn.grow(1e-4).encloses(instance.get_aabb()), "The bark is not in its box.")
		instance.free()


# What is drawn has the box of the tree at rest, and a margin for the wind before it is culled.
func test_bounds_are_the_trees_own() -> void:
	var made: TreeReconstruction = grown_tree(2)
	made.leaf_preset = "oak"
	var instance: TreeInstance3D = _instance(made)
	for wind: bool in [true, false, true]:
		instance.wind = wind
		while instance.is_building_levels():
			await tree.process_frame
		var rest: AABB = made.build_levels([0])[0].box
		var room: float = 0.15 * instance.get_tree_height() if wind else 0.0
		for child: Node in instance.get_children(true):
			var part: GeometryInstance3D = child as GeometryInstance3D
			check(
				part.custom_aabb.is_equal_approx(rest),
				"%s has %s of %s, wind %s." % [part.name, part.custom_aabb, rest, wind]
			)
			check_near(part.extra_cull_margin, room, 1e-4, "the margin of %s" % part.name)
		check((instance.mesh as ArrayMesh).custom_aabb.is_equal_approx(rest), "The bark's.")
		check_equal(instance.extra_cull_margin, 0.0, "the property that is the user's")
	instance.free()


# As the inspector compares: by value and by type.
func test_a_fresh_node_has_nothing_to_revert() -> void:
	var nodes: Array[Node] = [
		TreeInstance3D.new(), TreeVariantSpawner3D.new(), TreeWind.new(), TreePusher3D.new()
	]
	for node: Node in nodes:
		tree.root.add_child(node)
		await tree.process_frame
		for property: Dictionary in node.get_property_list():
			if not property.usage & PROPERTY_USAGE_EDITOR or property.name == "script":
				continue
			var usual: Variant = (node.get_script() as Script).get_property_default_value(
				property.name
			)
			if not property.usage & PROPERTY_USAGE_SCRIPT_VARIABLE:
				usual = ClassDB.class_get_property_default_value(node.get_class(), property.name)
			var now: Variant = node.get(property.name)
			check(
				typeof(now) == typeof(usual) and now == usual,
				"%s of a fresh node is %s, not %s." % [property.name, now, usual]
			)
		var scene: PackedScene = PackedScene.new()
		scene.pack(node)
		for i: int in scene.get_state().get_node_property_count(0):
			check_equal(
				scene.get_state().get_node_property_name(0, i), &"script", "what is saved of it"
			)
		node.free()


func test_leaves_share_what_the_node_is_set_to() -> void:
	var instance: TreeInstance3D = _instance(grown_tree(2))
	instance.lod = 0
	await _settle(instance)
	# Not typed: as the inspector and loaded scenes set it.
	instance.set("visibility_range_end", 50.0)
	instance.set("layers", 4)
	instance.set("cast_shadow", GeometryInstance3D.SHADOW_CASTING_SETTING_OFF)
	await tree.process_frame
	var leaves: MultiMeshInstance3D = _leaves_of(instance)
	check_equal(leaves.visibility_range_end, 50.0, "the distance at which the leaves vanish")
	check_equal(leaves.layers, 4, "the leaves' layers")
	check_equal(leaves.cast_shadow, instance.cast_shadow, "the leaves' shadow")
	instance.free()


# The engine's lists of meshes have no lock where nothing is drawn: an allocation on a worker gets
# lost, or is given away twice, beside one of the game's.
func test_workers_make_no_meshes_without_a_window() -> void:
	var job: BuildJob = BuildJob.new()
	job.source = grown_tree(4)
	job.leaves = true
	WorkerThreadPool.wait_for_task_completion(WorkerThreadPool.add_task(job.run))
	check(job.bark == null, "A worker has made a mesh.")
	check(not job.foliage[0].has("multimesh"), "A worker has made a multimesh.")
	job.draw()
	check_equal(job.bark.get_surface_count(), 1, "surfaces of bark")
	check(job.foliage[0].multimesh.instance_count > 0, "It made no leaves.")


# A tree that comes into a game holds no frame up: a worker makes its meshes, and its materials are
# read a piece per frame.
func test_a_tree_comes_in_pieces() -> void:
	var made: TreeReconstruction = grown_tree(4)
	made.leaf_preset = "willow"
	var job: BuildJob = BuildJob.new()
	job.source = made
	job.leaves = true
	job.run()
	job.draw()
	check_equal(job.bark.get_surface_count(), 1, "surfaces of bark")
	check(job.foliage[0].multimesh.instance_count > 0, "It made no leaves.")
	var pieces: Dictionary[String, bool] = {}
	for part: String in ["bark", "leaf"]:
		var path: String = "res://addons/tree_reconstruction/presets/willow_%s.tres" % part
		pieces[path] = true
		for listed: String in ResourceLoader.get_dependencies(path):
			pieces[listed.get_slice("::", listed.get_slice_count("::") - 1)] = true
	var before: int = _count_read(pieces)
	check(pieces.size() - before >= 4, "%d of %d are there already." % [before, pieces.size()])
	var watch: PerFrame = PerFrame.new()
	watch.count = _count_read.bind(pieces)
	tree.root.add_child(watch)
	var instance: TreeInstance3D = TreeInstance3D.new()
	instance.reconstruction = made
	tree.root.add_child(instance)
	while instance.is_rebuilding():
		await tree.process_frame
	for now: int in watch.counts:
		check(now - before <= 1, "%d pieces were read at once." % (now - before))
		before = now
	check_equal(_count_read(pieces), pieces.size(), "pieces that were read")
	watch.free()
	instance.free()


static func _count_read(pieces: Dictionary[String, bool]) -> int:
	var count: int = 0
	for path: String in pieces:
		count += 1 if ResourceLoader.has_cached(path) else 0
	return count
