extends "./suite.gd"
## What TreeReconstruction builds: bark, leaves, lines.

const BuildJob := preload("res://addons/tree_reconstruction/nodes/tree_build_job.gd")
const FLOATS_PER_LEAF: int = 20


func test_bark_is_sound() -> void:
	for random_seed: int in 20:
		var made: TreeReconstruction = grown_tree(random_seed, 20 + random_seed * 15)
		var mesh: ArrayMesh = made.build_mesh()
		check_equal(mesh.get_surface_count(), 1, "the number of surfaces")
		# A trunk runs out into roots, and goes on below the ground: so far under low trees.
		var root_place: Vector3 = made.get_positions()[0]
		check_near(mesh.get_aabb().position.y, root_place.y - 0.6, 1e-5, "the bark's lowest point")
		var reach: float = 4.0 * made.get_radii()[0]
		var corner: Vector3 = root_place - Vector3(reach, 0.6, reach)
		var foot: AABB = AABB(corner, Vector3(2.0 * reach, 1.0, 2.0 * reach))
		var box: AABB = made.get_aabb().grow(0.03).merge(foot.grow(1e-5))
		check(box.encloses(mesh.get_aabb()), "The bark %s leaves %s." % [mesh.get_aabb(), box])
		_check_surface(mesh.surface_get_arrays(0))


func _check_surface(arrays: Array) -> void:
	var vertices: PackedVector3Array = arrays[Mesh.ARRAY_VERTEX]
	var normals: PackedVector3Array = arrays[Mesh.ARRAY_NORMAL]
	var colors: PackedColorArray = arrays[Mesh.ARRAY_COLOR]
	var custom: PackedFloat32Array = arrays[Mesh.ARRAY_CUSTOM0]
	var radii: PackedFloat32Array = arrays[Mesh.ARRAY_CUSTOM1]
	var indices: PackedInt32Array = arrays[Mesh.ARRAY_INDEX]
	check_equal(radii.size(), vertices.size(), "the number of radii")
	check(radii[0] > 0.0, "The trunk's radius is %f." % radii[0])
	check_equal(normals.size(), vertices.size(), "the number of normals")
	check_equal(colors.size(), vertices.size(), "the number of colours")
	check_equal(custom.size(), vertices.size() * 4, "the number of pivots and levels")
	check_equal(arrays[Mesh.ARRAY_TEX_UV].size(), vertices.size(), "the number of UVs")
	check_equal(arrays[Mesh.ARRAY_TANGENT].size(), vertices.size() * 4, "the number of tangents")
	var crooked: int = 0
	for normal: Vector3 in normals:
		crooked += 0 if absf(normal.length() - 1.0) < 0.01 else 1
	check_equal(crooked, 0, "the number of normals that are no unit vectors")
	var inward: int = 0
	for i: int in range(0, indices.size(), 3):
		var a: Vector3 = vertices[indices[i]]
		var face: Vector3 = (vertices[indices[i + 2]] - a).cross(vertices[indices[i + 1]] - a)
		var outward: Vector3 = (
			normals[indices[i]] + normals[indices[i + 1]] + normals[indices[i + 2]]
		)
		# Godot's front faces turn clockwise.
		inward += 1 if face.dot(outward) < 0.0 else 0
	check(inward * 200 <= indices.size() / 3, "%d triangles face inwards." % inward)


func test_levels_of_detail_get_lighter() -> void:
	var made: TreeReconstruction = grown_tree(5)
	var triangles: int = 1 << 30
	var leaves: int = 1 << 30
	for lod: int in 3:
		var arrays: Array = made.build_mesh_arrays(lod)
		var count: int = arrays[Mesh.ARRAY_INDEX].size() / 3
		check(count > 0 and count < triangles, "Level %d has %d triangles." % [lod, count])
		triangles = count
		var cards: int = made.build_leaves(lod).instance_count
		check(cards > 0 and cards < leaves, "Level %d has %d leaves." % [lod, cards])
		leaves = cards


func test_a_negative_level_is_an_error() -> void:
	expect_error("level of detail")
	var made: TreeReconstruction = grown_tree(5)
	check(made.build_mesh_arrays(-1).is_empty(), "It built a mesh.")
	check(made.build_leaf_buffer(-1).is_empty(), "It built leaves.")
	check(TreeReconstruction.build_leaf_card_arrays(-1).is_empty(), "It built a card.")


# Who has placed the leaves already says how many triangles they take; the bark is the same.
func test_counted_leaves_make_the_same_bark() -> void:
	var oak: LSystem = LSystem.new()
	oak.grammar = LSystem.get_preset("oak")
	var made: TreeReconstruction = oak.grow()
	for lod: int in 3:
		var apart: int = BuildJob.leaf_triangles(made.build_foliage(lod))
		check(apart > 0, "There are no leaves.")
		check_equal(
			BuildJob.leaf_triangles(made.build_joined_foliage(lod)), apart, "joined triangles"
		)
		check_equal(
			hash(made.build_mesh_arrays(lod, false, true, apart)),
			hash(made.build_mesh_arrays(lod)),
			"the bark's hash"
		)
	var room: int = made.build_mesh_arrays(0, false, true, 0)[Mesh.ARRAY_INDEX].size()
	check(room > made.build_mesh_arrays(0)[Mesh.ARRAY_INDEX].size(), "Bark has no more room.")


func test_the_same_tree_gives_the_same_bytes() -> void:
	var first: TreeReconstruction = grown_tree(9)
	var second: TreeReconstruction = grown_tree(9)
	check_equal(
		hash(first.build_mesh_arrays()), hash(second.build_mesh_arrays()), "the bark's hash"
	)
	check_equal(first.build_leaf_buffer(), second.build_leaf_buffer(), "the leaf buffer")
	second.seed = 77
	check(first.build_leaf_buffer() != second.build_leaf_buffer(), "Another seed changed nothing.")


func test_leaves_sit_on_the_tree() -> void:
	var made: TreeReconstruction = grown_tree(6)
	made.leaf_preset = "birch"
	var buffer: PackedFloat32Array = made.build_leaf_buffer()
	var leaves: MultiMesh = made.build_leaves()
	check(buffer.size() > 0 and buffer.size() % FLOATS_PER_LEAF == 0, "The buffer is cut short.")
	check_equal(leaves.instance_count * FLOATS_PER_LEAF, buffer.size(), "the number of leaves")
	check(leaves.mesh != null and leaves.mesh.get_surface_count() == 1, "There is no leaf card.")
	var box: AABB = made.get_aabb().grow(0.05)
	for i: int in range(0, buffer.size(), FLOATS_PER_LEAF):
		var place: Vector3 = Vector3(buffer[i + 3], buffer[i + 7], buffer[i + 11])
		check(box.has_point(place), "A leaf hangs in the air at %s." % place)
		for channel: int in range(12, FLOATS_PER_LEAF):
			var value: float = buffer[i + channel]
			# Codes of the wind are as large as a half can be.
			var most: float = 65504.0 if channel in [17, 19] else 10.0
			check(value >= 0.0 and value <= most, "Channel %d is %f." % [channel, value])
		if failures.size() > 3:
			return


func test_leaves_can_be_turned_off() -> void:
	var made: TreeReconstruction = grown_tree(6)
	made.leaves_enabled = false
	check(made.build_leaf_buffer().is_empty(), "Leaves grow though they are disabled.")
	check_equal(made.build_leaves().instance_count, 0, "the number of leaves")
	made.leaf_preset = "none"
	check(made.build_leaf_buffer().is_empty(), "Leaves grow though the preset is none.")


func test_an_empty_tree_and_a_lone_root_build_nothing() -> void:
	var empty: TreeReconstruction = TreeReconstruction.new()
	var lone: TreeReconstruction = TreeReconstruction.new()
	lone.skeleton = skeleton([[-1, 0, 0, 0, 0.1, 1]])
	check_equal(lone.get_node_count(), 1, "the number of nodes")
	for made: TreeReconstruction in [empty, lone]:
		check_equal(made.build_mesh().get_surface_count(), 0, "the number of surfaces")
		check(made.build_skeleton_lines().is_empty(), "There are lines.")
	check_equal(empty.build_leaves().instance_count, 0, "the number of leaves")


func test_skeleton_lines() -> void:
	var made: TreeReconstruction = grown_tree(2)
	var arrays: Array = made.build_skeleton_lines()
	check_equal(
		arrays[Mesh.ARRAY_VERTEX].size(), 2 * (made.get_node_count() - 1), "the number of line ends"
	)
	check_equal(
		arrays[Mesh.ARRAY_COLOR].size(), arrays[Mesh.ARRAY_VERTEX].size(), "the number of colours"
	)
	var ids: PackedInt32Array = made.get_node_ids()
	var places: PackedVector3Array = arrays[Mesh.ARRAY_VERTEX]
	for i: int in places.size():
		var id: int = ids[Array(made.get_positions()).find(places[i])]
		check_near(
			arrays[Mesh.ARRAY_TEX_UV][i].x, made.get_node_radius(id), 1e-6, "the radius at an end"
		)


func test_lines_are_widened() -> void:
	var made: TreeReconstruction = grown_tree(2)
	var lines: Array = made.build_skeleton_lines()
	var ribbons: Array = TreeReconstruction.widen_lines(lines)
	var ends: PackedVector3Array = lines[Mesh.ARRAY_VERTEX]
	check_equal(ribbons[Mesh.ARRAY_VERTEX].size(), 2 * ends.size(), "the number of corners")
	check_equal(ribbons[Mesh.ARRAY_INDEX].size(), 3 * ends.size(), "the number of indices")
	var sides: float = 0.0
	for i: int in ribbons[Mesh.ARRAY_VERTEX].size():
		@warning_ignore("integer_division")
		var end: int = i / 2
		var place: Vector2 = ribbons[Mesh.ARRAY_TEX_UV][i]
		var way: Vector3 = (ends[end | 1] - ends[end & ~1]).normalized()
		check_equal(ribbons[Mesh.ARRAY_VERTEX][i], ends[end], "a corner's place")
		check_equal(place.x, lines[Mesh.ARRAY_TEX_UV][end].x, "a radius")
		check_equal(absf(place.y), 1.0, "a corner's side")
		check(ribbons[Mesh.ARRAY_NORMAL][i].is_equal_approx(way), "A ribbon goes another way.")
		check_equal(ribbons[Mesh.ARRAY_COLOR][i], lines[Mesh.ARRAY_COLOR][end], "a colour")
		sides += place.y
	check_equal(sides, 0.0, "the sum of the sides")
	for i: int in ribbons[Mesh.ARRAY_INDEX].size():
		@warning_ignore("integer_division")
		var line: int = i / 6
		@warning_ignore("integer_division")
		check_equal(ribbons[Mesh.ARRAY_INDEX][i] / 4, line, "an index's line")
	check(TreeReconstruction.widen_lines([]).is_empty(), "Nothing has ribbons.")


func test_builders_work_on_a_worker_while_the_tree_changes() -> void:
	var made: TreeReconstruction = grown_tree(3)
	var other: Dictionary = grown_tree(4, 200).skeleton
	var first: Dictionary = made.skeleton
	var wanted: Array[int] = [made.build_mesh_arrays()[Mesh.ARRAY_VERTEX].size()]
	made.skeleton = other
	wanted.append(made.build_mesh_arrays()[Mesh.ARRAY_VERTEX].size())
	var sizes: Array[int] = []
	sizes.resize(40)
	var task: int = WorkerThreadPool.add_group_task(
		func(i: int) -> void: sizes[i] = made.build_mesh_arrays()[Mesh.ARRAY_VERTEX].size(), 40
	)
	var turn: bool = false
	while not WorkerThreadPool.is_group_task_completed(task):
		made.skeleton = first if turn else other
		turn = not turn
	WorkerThreadPool.wait_for_group_task_completion(task)
	for size: int in sizes:
		check(size in wanted, "A worker saw half a tree: %d vertices." % size)
