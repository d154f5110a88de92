extends "./forest_suite.gd"
## The bodies of the trees of a forest.


func test_bodies_near_the_camera() -> void:
	var forest: TreeVariantSpawner3D = _forest()
	forest.collision = true
	forest.collision_trees = 5
	forest.collision_distance = 15.0
	await _plant(forest)
	for frame: int in 20:
		await tree.process_frame
	check_equal(forest.get_statistics()["bodies"], 5, "bodies")
	var near: PackedInt32Array = forest.find_trees(Vector3.ZERO, 15.0).slice(0, 5)
	var seen: int = 0
	for child: Node in forest.get_children(true):
		var body: StaticBody3D = child as StaticBody3D
		if body != null:
			seen += 1
			check(near.has(forest.find_tree_of(body)), "A body is of a far tree.")
			check(body.get_child_count(true) > 0, "It has no shapes.")
	check_equal(seen, 5, "bodies that are there")
	forest.remove(near[0])
	for frame: int in 20:
		await tree.process_frame
	check(not near[0] in forest.find_trees(Vector3.ZERO, 15.0), "It is still found.")
	for child: Node in forest.get_children(true):
		if child is StaticBody3D and not child.is_queued_for_deletion():
			check(forest.find_tree_of(child) != near[0], "Its body is still there.")
	_clear()


# A server has no camera, and a split screen several.
func test_bodies_follow_a_group() -> void:
	var forest: TreeVariantSpawner3D = _forest()
	forest.collision = true
	forest.collision_trees = 6
	forest.collision_distance = 12.0
	forest.collision_group = &"players"
	await _plant(forest)
	for frame: int in 10:
		await tree.process_frame
	check_equal(forest.get_statistics()["bodies"], 0, "bodies of no player")
	var players: Array[Node3D] = []
	for at: Vector3 in [Vector3(-22.0, 0.0, 0.0), Vector3(22.0, 0.0, 5.0)]:
		players.append(Node3D.new())
		players[-1].position = at
		players[-1].add_to_group(&"players")
		_world.add_child(players[-1])
	for round_of: int in 3:
		for frame: int in 20:
			await tree.process_frame
		var seen: PackedInt32Array = []
		for child: Node in forest.get_children(true):
			if child is StaticBody3D and not child.is_queued_for_deletion():
				seen.append(forest.find_tree_of(child))
		check(seen.size() > 2 and seen.size() <= 6, "There are %d bodies." % seen.size())
		for player: Node3D in players:
			var nearest: PackedInt32Array = forest.find_trees(player.position, 12.0)
			check(nearest.is_empty() or seen.has(nearest[0]), "%s has none." % player.position)
		if round_of == 0:
			players[0].position.z = 12.0
		elif round_of == 1:
			players.pop_back().free()
	_clear()
