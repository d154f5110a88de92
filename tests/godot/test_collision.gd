extends "./suite.gd"
## What collides with a tree, and how one is felled.

const LIMIT_FRAMES: int = 2000


func _instance(made: TreeReconstruction) -> TreeInstance3D:
	var instance: TreeInstance3D = TreeInstance3D.new()
	instance.reconstruction = made
	instance.collision = true
	tree.root.add_child(instance)
	await _settle(instance)
	return instance


func _settle(instance: TreeInstance3D) -> void:
	for i: int in LIMIT_FRAMES:
		if not instance.is_rebuilding():
			return
		await tree.process_frame
	check(false, "The build did not end.")


func _bodies(instance: TreeInstance3D) -> Array[StaticBody3D]:
	var bodies: Array[StaticBody3D] = []
	for child: Node in instance.get_children(true):
		if child is StaticBody3D and not child.is_queued_for_deletion():
			bodies.append(child)
	return bodies


func _hit(instance: TreeInstance3D, from: Vector3, to: Vector3) -> Object:
	await tree.physics_frame
	await tree.physics_frame
	var query: PhysicsRayQueryParameters3D = PhysicsRayQueryParameters3D.create(from, to)
	return instance.get_world_3d().direct_space_state.intersect_ray(query).get("collider")


func test_a_ray_hits_the_trunk() -> void:
	var instance: TreeInstance3D = await _instance(grown_tree(2))
	var trunk: PackedInt32Array = instance.reconstruction.get_trunk_nodes()
	var at: Vector3 = instance.reconstruction.get_node_position(trunk[1])
	var hit: Object = await _hit(instance, at + Vector3(5, 0, 0), at - Vector3(5, 0, 0))
	check(hit is StaticBody3D, "The ray hit %s." % hit)
	check(hit != null and (hit as Node).get_parent() == instance, "It isn't this tree's body.")
	instance.collision_layer = 4
	check_equal(_bodies(instance)[0].collision_layer, 4, "the body's layer")
	instance.collision = false
	await _settle(instance)
	check(_bodies(instance).is_empty(), "The body stayed.")
	check(await _hit(instance, at + Vector3(5, 0, 0), at - Vector3(5, 0, 0)) == null, "It hits.")
	instance.free()


func test_the_budget_holds() -> void:
	var made: TreeReconstruction = grown_tree(3)
	for maximum: int in [1, 5, 40]:
		var capsules: Array[Dictionary] = made.build_capsules(maximum, 0.005)
		check(capsules.size() <= maximum, "%d capsules" % capsules.size())
		check(not capsules.is_empty(), "There are none.")
	expect_error("between 1 and 10000")
	check_equal(made.build_capsules(0).size(), 0, "capsules of no budget")


func test_the_body_is_neither_saved_nor_copied() -> void:
	var instance: TreeInstance3D = await _instance(grown_tree(2))
	var copy: TreeInstance3D = instance.duplicate() as TreeInstance3D
	tree.root.add_child(copy)
	await _settle(copy)
	check_equal(_bodies(copy).size(), 1, "bodies of the copy")
	var scene: PackedScene = PackedScene.new()
	scene.pack(instance)
	check_equal(scene.get_state().get_node_count(), 1, "saved nodes")
	copy.free()
	instance.free()


func test_a_felled_tree_falls() -> void:
	var made: TreeReconstruction = grown_tree(2)
	var whole: int = made.get_node_count()
	var volume: float = made.measure()["volume"]
	var before: Dictionary = made.skeleton
	var instance: TreeInstance3D = await _instance(made)
	instance.transform = Transform3D(
		Basis(Vector3.UP, 0.7).scaled(Vector3.ONE * 2.0), Vector3(3, 0, 1)
	)
	var cut: int = made.get_trunk_nodes()[2]
	var place: Vector3 = instance.global_transform * made.get_node_position(cut)
	var body: RigidBody3D = instance.fell(cut, 500.0)
	check(body != null, "Nothing fell.")
	var fallen: TreeInstance3D = body.get_child(0)
	var top: TreeReconstruction = fallen.reconstruction
	check_equal(made.skeleton, before, "the tree that others may share")
	check(instance.reconstruction.get_node_count() < whole, "Nothing was cut off.")
	check_near(
		top.measure()["volume"] + instance.reconstruction.measure()["volume"],
		volume,
		0.02 * volume,
		"the volume of both halves"
	)
	check_near(body.mass, top.measure()["volume"] * 8.0 * 500.0, 1.0, "the mass")
	var there: Array[Vector3] = []
	for id: int in top.get_node_ids():
		there.append(fallen.global_transform * top.get_node_position(id))
	var nearest: float = INF
	for other: Vector3 in there:
		nearest = minf(nearest, other.distance_to(place))
	check(nearest < 1e-3, "The piece begins %s m from where it was." % nearest)
	await _settle(instance)
	await _settle(fallen)
	check(fallen.get_leaf_count() > 0, "The fallen crown is bare.")
	var height: float = body.global_position.y
	for i: int in 20:
		await tree.physics_frame
	check(body.global_position.y < height, "It hangs in the air.")
	expect_error("no node 999999")
	check(instance.fell(999999) == null, "A node that isn't there was cut.")
	body.free()
	instance.free()
