extends "./forest_suite.gd"
## What trees are for the baking of navigation meshes.


func _parse(
	of: Node, type: NavigationMesh.ParsedGeometryType
) -> NavigationMeshSourceGeometryData3D:
	var navigation: NavigationMesh = NavigationMesh.new()
	navigation.geometry_parsed_geometry_type = type
	var data: NavigationMeshSourceGeometryData3D = NavigationMeshSourceGeometryData3D.new()
	NavigationServer3D.parse_source_geometry_data(navigation, data, of)
	return data


func _count(data: NavigationMeshSourceGeometryData3D) -> int:
	@warning_ignore("integer_division")
	return data.get_vertices().size() / 3


# Whether something stands at a place.
func _is_there(data: NavigationMeshSourceGeometryData3D, place: Vector3) -> bool:
	var numbers: PackedFloat32Array = data.get_vertices()
	for i: int in range(0, numbers.size(), 3):
		var off: Vector3 = Vector3(numbers[i], numbers[i + 1], numbers[i + 2]) - place
		if Vector2(off.x, off.z).length() < 0.8 and absf(off.y) < 1.0:
			return true
	return false


func test_every_tree_of_a_forest_is_in_the_way() -> void:
	var forest: TreeVariantSpawner3D = _forest()
	forest.collision = true
	forest.collision_trees = 4
	forest.source.leaf_preset = "oak"
	await _plant(forest)
	for frame: int in 20:
		await tree.process_frame
	var box: MeshInstance3D = MeshInstance3D.new()
	box.mesh = BoxMesh.new()
	forest.add_child(box)
	var far: MeshInstance3D = MeshInstance3D.new()
	far.mesh = BoxMesh.new()
	_world.add_child(far)
	for type: NavigationMesh.ParsedGeometryType in [
		NavigationMesh.PARSED_GEOMETRY_MESH_INSTANCES,
		NavigationMesh.PARSED_GEOMETRY_STATIC_COLLIDERS,
		NavigationMesh.PARSED_GEOMETRY_BOTH,
	]:
		var data: NavigationMeshSourceGeometryData3D = _parse(_world, type)
		var boxes: int = 0 if type == NavigationMesh.PARSED_GEOMETRY_STATIC_COLLIDERS else 2 * 24
		var each: float = float(_count(data) - boxes) / forest.get_tree_count()
		check(each <= 144.0 and each >= 12.0, "%s vertices for each tree." % each)
		for id: int in forest.get_tree_count():
			check(_is_there(data, forest.get_tree_transform(id).origin), "Tree %d is missing." % id)
		for index: int in data.get_indices():
			check(index >= 0 and index < _count(data), "Index %d points nowhere." % index)
	# One that does not collide is none, and the layers decide.
	var colliders: NavigationMesh.ParsedGeometryType = (
		NavigationMesh.PARSED_GEOMETRY_STATIC_COLLIDERS
	)
	forest.collision = false
	await _grown(forest)
	check_equal(_count(_parse(_world, colliders)), 0, "vertices of what does not collide")
	_clear()


func test_a_tree_is_in_the_way_with_its_stem() -> void:
	_world = Node3D.new()
	tree.root.add_child(_world)
	var both: NavigationMesh.ParsedGeometryType = NavigationMesh.PARSED_GEOMETRY_BOTH
	for i: int in 2:
		var instance: TreeInstance3D = TreeInstance3D.new()
		instance.reconstruction = grown_tree(2)
		instance.reconstruction.leaf_preset = "oak"
		instance.collision = true
		instance.position = Vector3(10.0 * i, 0.0, 0.0)
		_world.add_child(instance)
		while instance.is_building_levels():
			await tree.process_frame
		# What somebody hung into it stays.
		var box: MeshInstance3D = MeshInstance3D.new()
		box.mesh = BoxMesh.new()
		instance.add_child(box)
	var data: NavigationMeshSourceGeometryData3D = _parse(_world, both)
	check(_count(data) >= 48 + 24 and _count(data) <= 48 + 2 * 144, "%d vertices" % _count(data))
	for i: int in 2:
		check(_is_there(data, Vector3(10.0 * i, 0.0, 0.0)), "Tree %d is missing." % i)
	# The tree alone, and twice in a frame.
	for child: Node in _world.get_children() + _world.get_children():
		var one: NavigationMeshSourceGeometryData3D = _parse(child, both)
		check(_count(one) >= 24 + 12 and _count(one) <= 24 + 144, "%d vertices" % _count(one))
	_clear()


# An agent goes around the trunk.
func test_a_path_goes_around() -> void:
	_world = Node3D.new()
	tree.root.add_child(_world)
	var ground: MeshInstance3D = MeshInstance3D.new()
	ground.mesh = PlaneMesh.new()
	(ground.mesh as PlaneMesh).size = Vector2(12.0, 12.0)
	_world.add_child(ground)
	var instance: TreeInstance3D = TreeInstance3D.new()
	instance.reconstruction = grown_tree(2)
	_world.add_child(instance)
	while instance.is_rebuilding():
		await tree.process_frame
	var navigation: NavigationMesh = NavigationMesh.new()
	navigation.cell_size = 0.1
	navigation.cell_height = 0.1
	navigation.agent_radius = 0.3
	navigation.agent_height = 1.8
	navigation.agent_max_climb = 0.2
	var data: NavigationMeshSourceGeometryData3D = NavigationMeshSourceGeometryData3D.new()
	NavigationServer3D.parse_source_geometry_data(navigation, data, _world)
	NavigationServer3D.bake_from_source_geometry_data(navigation, data)
	var free: int = 0
	var corners: PackedVector3Array = navigation.get_vertices()
	for polygon: int in navigation.get_polygon_count():
		var outline: PackedVector2Array = []
		for corner: int in navigation.get_polygon(polygon):
			outline.append(Vector2(corners[corner].x, corners[corner].z))
		check(not Geometry2D.is_point_in_polygon(Vector2.ZERO, outline), "One walks in the trunk.")
		free += 1 if Geometry2D.is_point_in_polygon(Vector2(3.0, 3.0), outline) else 0
	check(free > 0, "Nobody can walk at all.")
	_clear()
