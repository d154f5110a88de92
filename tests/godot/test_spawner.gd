extends "./forest_suite.gd"
## Forests of individuals of one tree's kind.

const Scatter := preload("res://addons/tree_reconstruction/nodes/spawning/scatter.gd")
const Stand := preload("res://addons/tree_reconstruction/nodes/spawning/stand.gd")
const Ground := preload("res://addons/tree_reconstruction/nodes/spawning/ground.gd")
const Cells := preload("res://addons/tree_reconstruction/nodes/spawning/cells.gd")
const Individual := preload("res://addons/tree_reconstruction/nodes/spawning/individual.gd")
const Leftovers := preload("res://addons/tree_reconstruction/nodes/spawning/leftovers.gd")
const LeafKinds := preload("res://addons/tree_reconstruction/nodes/leaf_kinds.gd")
const Materials := preload("res://addons/tree_reconstruction/nodes/spawning/materials.gd")
const Reading := preload("res://addons/tree_reconstruction/nodes/spawning/reading.gd")
const NEVER: int = 0x7fffffffffffffff


# Of all places and all meshes.
func _hash(forest: TreeVariantSpawner3D) -> String:
	var all: HashingContext = HashingContext.new()
	all.start(HashingContext.HASH_SHA256)
	for index: int in forest.variants:
		for level: int in forest.levels:
			var mesh: ArrayMesh = forest.get_variant_mesh(index, level)
			for surface: int in mesh.get_surface_count():
				all.update(var_to_bytes(mesh.surface_get_arrays(surface)))
	return forest.get_digest() + all.finish().hex_encode()


func test_the_same_forest_on_threads_and_without() -> void:
	var found: PackedStringArray = []
	for threads: bool in [true, false, true]:
		TreeVariantSpawner3D.threaded = threads
		var forest: TreeVariantSpawner3D = _forest()
		await _plant(forest)
		check(forest.get_tree_count() >= 12, "%d trees stand." % forest.get_tree_count())
		check_equal(forest.get_statistics()["variants"], 3, "individuals")
		found.append(_hash(forest))
		_clear()
		await tree.process_frame
	TreeVariantSpawner3D.threaded = true
	check_equal(found[1], found[0], "the forest without threads")
	check_equal(found[2], found[0], "the forest once more")
	var other: TreeVariantSpawner3D = _forest()
	other.seed = 2
	await _plant(other)
	check(other.get_digest() != found[0].left(64), "Another seed gives the same.")
	_clear()


# The renderer of a run without a screen keeps no instances, but their number.
func test_what_is_drawn_is_every_tree_once_per_level() -> void:
	var forest: TreeVariantSpawner3D = _forest()
	# The camera is far away from most, and all is within the view.
	forest.level_distances = PackedFloat32Array([1000.0])
	forest.view_distance = 2000.0
	await _plant(forest)
	for level: int in 2:
		var drawn: int = 0
		for part: MultiMeshInstance3D in _parts(forest):
			if (part.visibility_range_begin > 0.0) == (level > 0):
				drawn += part.multimesh.instance_count
		check_equal(
			drawn, forest.get_tree_count() if level == 0 else 0, "trees of level %d" % level
		)
	for id: int in forest.get_tree_count():
		var base: Vector3 = forest.get_tree_transform(id).origin
		var around: int = 0
		for part: MultiMeshInstance3D in _parts(forest):
			around += 1 if part.custom_aabb.has_point(base + Vector3.UP) else 0
		check(around > 0, "Tree %d is in no box." % id)
	_clear()


func test_trees_keep_their_distance_and_their_region() -> void:
	for distance: float in [0.5, 2.0, 5.0]:
		var scatter: Scatter = Scatter.new()
		scatter.number = 5
		scatter.size = Vector2(50.0, 30.0)
		scatter.distance = distance
		scatter.density = 20.0
		scatter.clumping = 0.5
		scatter.run(NEVER)
		check(scatter.places.size() > 30, "There are %d trees." % scatter.places.size())
		var nearest: float = INF
		for i: int in scatter.places.size():
			var place: Vector3 = scatter.places[i]
			check(absf(place.x) <= 25.0 and absf(place.z) <= 15.0, "One is at %s." % place)
			for j: int in i:
				nearest = minf(nearest, place.distance_to(scatter.places[j]))
		check(nearest >= distance - 1e-4, "Two are %f m apart, not %f." % [nearest, distance])


func test_scattering_in_slices_is_the_same() -> void:
	var found: Array[PackedVector3Array] = []
	for deadline: int in [NEVER, 0]:
		var scatter: Scatter = Scatter.new()
		scatter.outline = PackedVector2Array(
			[Vector2(0, 0), Vector2(30, 0), Vector2(30, 30), Vector2(15, 5)]
		)
		scatter.height = 2.0
		scatter.density = 4.0
		scatter.distance = 1.5
		while not scatter.run(deadline):
			pass
		found.append(scatter.places)
	check_equal(found[1], found[0], "the places")
	check(found[0].size() > 5, "There are %d trees." % found[0].size())
	for place: Vector3 in found[0]:
		check_equal(place.y, 2.0, "the height")
		check(place.z <= place.x + 1e-4, "%s is outside of the outline." % place)


func test_trees_stand_on_a_mesh() -> void:
	var random: RandomNumberGenerator = RandomNumberGenerator.new()
	random.seed = 3
	var corners: PackedVector3Array = []
	for x: int in 8:
		for z: int in 8:
			var at: Array[Vector3] = []
			for corner: Vector2 in [
				Vector2(x, z), Vector2(x + 1, z), Vector2(x, z + 1), Vector2(x + 1, z + 1)
			]:
				at.append(Vector3(4.0 * corner.x, sin(corner.x) + cos(corner.y), 4.0 * corner.y))
			corners.append_array(PackedVector3Array([at[0], at[1], at[2], at[1], at[3], at[2]]))
	var ground: Ground = Ground.new(corners)
	check_near(ground.area, 32.0 * 32.0, 0.01, "the area")
	for i: int in 200:
		var at: Vector2 = Vector2(random.randf_range(-2.0, 34.0), random.randf_range(-2.0, 34.0))
		var found: PackedVector3Array = ground.find(at)
		var inside: bool = Rect2(0, 0, 32, 32).has_point(at)
		check_equal(not found.is_empty(), inside, "whether there is ground at %s" % at)
		if found.is_empty():
			continue
		# A ray from above says the same.
		var highest: float = -INF
		for j: int in range(0, corners.size(), 3):
			var hit: Variant = Geometry3D.ray_intersects_triangle(
				Vector3(at.x, 100.0, at.y), Vector3.DOWN, corners[j], corners[j + 1], corners[j + 2]
			)
			if hit != null:
				highest = maxf(highest, (hit as Vector3).y)
		check_near(found[0].y, highest, 1e-3, "the height at %s" % at)
		check(found[1].y > 0.0, "The normal looks down.")
	var scatter: Scatter = Scatter.new()
	scatter.corners = corners
	scatter.steepest = deg_to_rad(8.0)
	scatter.lowest = 0.0
	scatter.density = 10.0
	scatter.distance = 0.3
	scatter.run(NEVER)
	check(scatter.places.size() > 5, "There are %d trees." % scatter.places.size())
	for i: int in scatter.places.size():
		check(scatter.places[i].y >= 0.0, "One stands too low.")
		check(scatter.normals[i].angle_to(Vector3.UP) <= deg_to_rad(8.01), "One is too steep.")


func test_rays_find_the_ground() -> void:
	var floor_body: StaticBody3D = StaticBody3D.new()
	var shape: CollisionShape3D = CollisionShape3D.new()
	shape.shape = BoxShape3D.new()
	(shape.shape as BoxShape3D).size = Vector3(20.0, 2.0, 100.0)
	floor_body.add_child(shape)
	floor_body.position = Vector3(0.0, -6.0, 0.0)
	_world = Node3D.new()
	tree.root.add_child(_world)
	_world.add_child(floor_body)
	for i: int in 2:
		await tree.physics_frame
	var forest: TreeVariantSpawner3D = _forest()
	forest.ground_rays = true
	await _plant(forest)
	check(forest.get_tree_count() > 3, "%d trees stand." % forest.get_tree_count())
	for id: int in forest.get_tree_count():
		var place: Vector3 = forest.get_tree_transform(id).origin
		check(absf(place.x) <= 10.1, "One stands beside the ground, at %s." % place)
		check_near(place.y, -5.0, 0.1, "its height")
	_clear()


func test_budgets_are_kept() -> void:
	var forest: TreeVariantSpawner3D = _forest()
	forest.variants = 8
	forest.leaves = false
	await _plant(forest)
	var all: int = forest.get_statistics()["bytes"]
	var each: int = all >> 3
	check_equal(forest.get_statistics()["variants"], 8, "individuals")
	# A budget in megabytes is too coarse for these trees.
	forest._forest._individuals.budget = 3 * each + (each >> 1)
	forest._forest._individuals.forget()
	var plans: Array = forest._forest._plans(forest.get_all_sources())
	var few := forest._forest._individuals
	few.start(plans)
	while not few.is_done():
		few.poll(Time.get_ticks_usec() + 1000)
		await tree.process_frame
	check(few.accepted >= 2 and few.accepted <= 4, "%d individuals were made." % few.accepted)
	check(few.bytes <= few.budget, "They take %d bytes of %d." % [few.bytes, few.budget])
	_clear()
	# One is made in any case, and stands for all.
	forest = _forest()
	forest.memory_budget_mb = 1
	forest.source = grown_tree(4, 900)
	forest.source.leaf_preset = "oak"
	await _plant(forest)
	check_equal(forest.get_statistics()["variants"], 1, "individuals of one megabyte")
	for id: int in forest.get_tree_count():
		check_equal(forest.get_tree_variant(id), 0, "which one tree %d is" % id)
	_clear()


func test_cells_come_and_go_with_the_camera() -> void:
	var forest: TreeVariantSpawner3D = _forest()
	forest.region_size = Vector2(400.0, 400.0)
	forest.view_distance = 40.0
	forest.camera = Node3D.new()
	_world = Node3D.new()
	tree.root.add_child(_world)
	_world.add_child(forest.camera)
	await _plant(forest)
	var first: int = forest.get_statistics()["multimeshes"]
	check(first > 3, "Only %d multimeshes are drawn." % first)
	var nodes: int = forest.get_child_count(true)
	for i: int in 12:
		forest.camera.position = Vector3(150.0 * cos(i), 2.0, 150.0 * sin(i))
		for frame: int in 40:
			await tree.process_frame
		for part: MultiMeshInstance3D in _parts(forest):
			var away: float = (part.custom_aabb.get_center() - forest.camera.position).length()
			var reach: float = 75.0 + 0.5 * part.custom_aabb.size.length()
			check(away < reach, "A cell %f m away is drawn." % away)
	check(
		forest.get_child_count(true) < 4 * nodes + 256,
		"There are %d nodes, from %d." % [forest.get_child_count(true), nodes]
	)
	forest.camera.position = Vector3(5000.0, 0.0, 0.0)
	for frame: int in 20:
		await tree.process_frame
	check_equal(forest.get_statistics()["multimeshes"], 0, "multimeshes far away")
	check_equal(_parts(forest).size(), 0, "what is drawn far away")
	_clear()


func test_trees_are_added_taken_and_removed() -> void:
	var forest: TreeVariantSpawner3D = _forest()
	await _plant(forest)
	var before: int = forest.get_tree_count()
	var digest: String = forest.get_digest()
	var frame: Transform3D = Transform3D(Basis(Vector3.UP, 1.0), Vector3(3.0, 1.0, 4.0))
	var id: int = forest.spawn_at(frame)
	check_equal(forest.get_tree_count(), before + 1, "trees")
	check(forest.get_tree_transform(id).is_equal_approx(frame), "It stands elsewhere.")
	check(forest.find_trees(Vector3(3.0, 1.0, 4.0), 0.1).has(id), "It is not found.")
	check(forest.get_digest() != digest, "The digest is the same.")
	var felled: TreeInstance3D = forest.take(id)
	check_equal(felled.transform.origin, frame.origin, "where it is taken")
	check(felled.reconstruction.get_node_count() > 10, "It has no wood.")
	check_equal(forest.get_tree_count(), before, "trees without it")
	forest.remove(0)
	check_equal(forest.get_tree_count(), before - 1, "trees without two")
	check(forest.find_trees(Vector3.ZERO, 1000.0).size() == before - 1, "One is still found.")
	expect_error("The forest has no tree 0.")
	forest.remove(0)
	while felled.is_rebuilding():
		await tree.process_frame
	_clear()


func test_given_places() -> void:
	var forest: TreeVariantSpawner3D = _forest()
	forest.placement = TreeVariantSpawner3D.Placement.GIVEN
	for i: int in 20:
		forest.transforms.append(Transform3D(Basis(), Vector3(3.0 * i, 0.5 * i, -2.0 * i)))
	await _plant(forest)
	check_equal(forest.get_tree_count(), 20, "trees")
	var kinds: Dictionary[int, bool] = {}
	for id: int in 20:
		check(
			forest.get_tree_transform(id).is_equal_approx(forest.transforms[id]),
			"Tree %d stands elsewhere." % id
		)
		kinds[forest.get_tree_variant(id)] = true
	check_equal(kinds.size(), 3, "individuals among them")
	_clear()


# Wherever it is under way, nothing is left and no error is heard.
func test_forests_go_at_any_moment() -> void:
	for frames: int in [0, 1, 2, 3, 5, 8, 13]:
		for threads: bool in [true, false]:
			TreeVariantSpawner3D.threaded = threads
			var forest: TreeVariantSpawner3D = _forest()
			forest.collision = true
			_world = Node3D.new()
			tree.root.add_child(_world)
			_world.add_child(forest)
			for i: int in frames:
				await tree.process_frame
			if frames % 2 == 0:
				forest.seed += 1
				_world.remove_child(forest)
				await tree.process_frame
				forest.free()
			_clear()
	TreeVariantSpawner3D.threaded = true
	await tree.process_frame


func test_a_changed_tree_changes_its_forest() -> void:
	var forest: TreeVariantSpawner3D = _forest()
	await _plant(forest)
	var before: String = _hash(forest)
	forest.source.edit("prune")
	await _grown(forest)
	check(_hash(forest) != before, "The forest is the old one.")
	check_equal(forest.get_statistics()["variants"], 3, "individuals")
	_clear()


func test_the_old_trees_stay_until_new_ones_come() -> void:
	var forest: TreeVariantSpawner3D = _forest()
	await _plant(forest)
	var before: Array[MultiMeshInstance3D] = _parts(forest)
	check(not before.is_empty(), "Nothing is drawn.")
	forest.seed += 1
	var frames: int = 0
	while frames == 0 or forest.get_tree_count() == 0:
		check_equal(_parts(forest).size(), before.size(), "what is drawn in frame %d" % frames)
		await tree.process_frame
		frames += 1
	await _grown(forest)
	var drawn: int = 0
	for part: MultiMeshInstance3D in _parts(forest):
		drawn += part.multimesh.instance_count
	check(drawn >= forest.get_tree_count(), "Only %d are drawn." % drawn)
	check_equal(forest.get_statistics()["multimeshes"], _parts(forest).size(), "multimeshes")
	# What nobody wants any longer has ended, or will.
	Leftovers.wait()
	forest.source = null
	await _grown(forest)
	check_equal(_parts(forest).size(), 0, "what is drawn of no tree")
	_clear()


func test_materials_are_read_a_piece_per_frame() -> void:
	var pieces: PackedStringArray = []
	var made: ShaderMaterial = ShaderMaterial.new()
	made.shader = load("res://addons/tree_reconstruction/shaders/bark.gdshader")
	for name: String in ["albedo_texture", "normal_texture"]:
		var picture: Image = Image.create_empty(64, 64, true, Image.FORMAT_RGB8)
		var texture: ImageTexture = ImageTexture.create_from_image(picture)
		pieces.append(folder.path_join(name + ".res"))
		ResourceSaver.save(texture, pieces[-1])
		texture.take_over_path(pieces[-1])
		made.set_shader_parameter(name, texture)
	pieces.append(folder.path_join("bark.tres"))
	ResourceSaver.save(made, pieces[-1])
	made = null
	var plan: Individual = Individual.new()
	plan.bark_path = pieces[-1]
	var look: Individual.Look = Individual.Look.new()
	look.path = LeafKinds.preset_path("generic", "leaf")
	plan.looks = [look]
	var reading: Reading = Reading.new()
	check_equal(_count_cached(pieces), 0, "what is there already")
	reading.start([plan], [])
	var ready: Array[Individual] = []
	var known: int = 0
	for frame: int in 100:
		if not ready.is_empty():
			break
		check(reading.is_busy(), "It is done with nothing.")
		ready = reading.poll()
		var now: int = _count_cached(pieces)
		check(now - known <= 1, "%d pieces are read at once." % (now - known))
		known = now
	check_equal(known, pieces.size(), "what was read")
	check_equal(ready, [plan] as Array[Individual], "whose materials are there")
	check(not reading.is_busy(), "It never ends.")
	check_equal(plan.bark_material.resource_path, plan.bark_path, "the bark's material")
	check_equal(look.material.resource_path, look.path, "the leaves' material")


static func _count_cached(paths: PackedStringArray) -> int:
	var count: int = 0
	for path: String in paths:
		count += 1 if ResourceLoader.has_cached(path) else 0
	return count


# Each tree of a forest knows its own level where the shaders do.
func test_the_presets_know_levels() -> void:
	for name: String in ["bark", "leaf", "blade"]:
		var path: String = LeafKinds.preset_path("generic", name)
		check(Materials.knows_levels(load(path) as Material), "%s does not." % path)


func test_a_saved_scene_holds_nothing_that_was_built() -> void:
	var forest: TreeVariantSpawner3D = _forest()
	forest.source.take_over_path("res://not_there_spawner_tree.res")
	await _plant(forest)
	var scene: PackedScene = PackedScene.new()
	check_equal(scene.pack(forest), OK, "packing")
	check_equal(scene.get_state().get_node_count(), 1, "nodes in the scene")
	var path: String = folder.path_join("forest.tscn")
	check_equal(ResourceSaver.save(scene, path), OK, "saving")
	check(FileAccess.get_file_as_bytes(path).size() < 1000, FileAccess.get_file_as_string(path))
	var digest: String = forest.get_digest()
	_clear()
	var again: TreeVariantSpawner3D = scene.instantiate() as TreeVariantSpawner3D
	again.source = grown_tree(3, 60)
	await _plant(again)
	check_equal(again.get_digest(), digest, "the forest read again")
	_clear()


# A dense scan is no heavier in a forest than its height allows, and a light one as fine as it is.
func test_triangles_keep_to_their_budgets() -> void:
	var forest: TreeVariantSpawner3D = _forest()
	forest.source = grown_tree(4, 1500)
	forest.source.leaf_preset = "oak"
	forest.variants = 1
	forest.levels = 3
	forest.level_budgets = PackedInt32Array([0, 0, 0])
	await _plant(forest)
	var own: PackedInt32Array = forest.get_statistics()["triangles"]
	var highest: float = forest.get_variant(0).get_aabb().end.y
	forest.level_budgets = PackedInt32Array()
	await _grown(forest)
	var usual: PackedInt32Array = forest.get_statistics()["triangles"]
	for level: int in 3:
		var most: int = TreeVariantSpawner3D.TreeLevels.budget(highest, level)
		check(usual[level] <= most, "Level %d has %d of %d." % [level, usual[level], most])
		check(own[level] > most, "Level %d is too light to tell: %d." % [level, own[level]])
	forest.level_budgets = PackedInt32Array([5000, 0])
	await _grown(forest)
	var chosen: PackedInt32Array = forest.get_statistics()["triangles"]
	check(chosen[0] <= 5000 and chosen[0] > 2500, "The finest has %d of 5000." % chosen[0])
	check_equal(chosen[1], own[1], "triangles without a bound")
	check_equal(chosen[2], usual[2], "triangles of the last")
	forest.leaves = false
	forest.level_budgets = PackedInt32Array([600, 600, 600])
	await _grown(forest)
	check(forest.get_statistics()["triangles"][0] <= 600, "Bare, it has more.")
	var bare: ArrayMesh = forest.get_variant_mesh(0)
	check_equal(bare.get_surface_count(), 1, "surfaces without leaves")
	# One that can't be kept is said.
	forest.level_budgets = PackedInt32Array([1, 1, 1])
	await _grown(forest)
	check_equal(forest._get_configuration_warnings().size(), 1, "warnings")
	_clear()
