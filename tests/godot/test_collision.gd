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
	return (await _meeting(instance, from, to)).get("collider")


func _meeting(instance: TreeInstance3D, from: Vector3, to: Vector3) -> Dictionary:
	await tree.physics_frame
	await tree.physics_frame
	var query: PhysicsRayQueryParameters3D = PhysicsRayQueryParameters3D.create(from, to)
	return instance.get_world_3d().direct_space_state.intersect_ray(query)


func test_a_ray_hits_the_trunk() -> void:
	var instance: TreeInstance3D = await _instance(grown_tree(2))
	var trunk: PackedInt32Array = instance.reconstruction.get_trunk_nodes()
	var at: Vector3 = instance.reconstruction.get_node_position(trunk[1])
	var hit: Object = await _hit(instance, at + Vector3(5, 0, 0), at - Vector3(5, 0, 0))
	check(hit is StaticBody3D, "The ray hit %s." % hit)
	check(hit != null and (hit as Node).get_parent() == instance, "It isn't this tree's body.")
	var from: Vector3 = at + Vector3(5, 0, 0)
	var place: Vector3 = (await _meeting(instance, from, at)).get("position", from)
	var radius: float = instance.reconstruction.get_node_radius(trunk[1])
	check_equal(snappedf(place.distance_to(at) / radius, 0.25), 1.0, "where its bark is, in radii")
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
	# On a stump that collides it might stand.
	instance.collision = false
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


# A trunk with two branches side by side, level, at 1.5 m.
func _rails() -> TreeReconstruction:
	var nodes: Array[Array] = [[-1, 0.0, 0.0, 0.0, 0.12, NODE_TRUNK | NODE_MEASURED]]
	for i: int in range(1, 6):
		nodes.append([i - 1, 0.0, 0.5 * i, 0.0, 0.12 - 0.01 * i, NODE_TRUNK])
	for side: float in [-0.11, 0.11]:
		nodes.append([3, 0.2, 1.5, side, 0.06, 0])
		nodes.append([nodes.size() - 1, 1.5, 1.5, side, 0.05, 0])
	var made: TreeReconstruction = TreeReconstruction.new()
	made.skeleton = skeleton(nodes)
	return made


# Runs the physics for `seconds` of its own time, in its usual steps but faster than the clock.
func _simulate(seconds: float) -> void:
	var usual: int = Engine.physics_ticks_per_second
	var most: int = Engine.max_physics_steps_per_frame
	Engine.time_scale = 8.0
	Engine.physics_ticks_per_second = 8 * usual
	Engine.max_physics_steps_per_frame = 64
	for i: int in int(seconds * usual):
		await tree.physics_frame
	Engine.time_scale = 1.0
	Engine.physics_ticks_per_second = usual
	Engine.max_physics_steps_per_frame = most


func _ball(at: Vector3, radius: float) -> RigidBody3D:
	var ball: RigidBody3D = RigidBody3D.new()
	var part: CollisionShape3D = CollisionShape3D.new()
	part.shape = SphereShape3D.new()
	(part.shape as SphereShape3D).radius = radius
	ball.add_child(part)
	ball.position = at
	tree.root.add_child(ball)
	return ball


func _ground() -> StaticBody3D:
	var ground: StaticBody3D = StaticBody3D.new()
	var part: CollisionShape3D = CollisionShape3D.new()
	part.shape = BoxShape3D.new()
	(part.shape as BoxShape3D).size = Vector3(60, 2, 60)
	part.position.y = -1.0
	ground.add_child(part)
	tree.root.add_child(ground)
	return ground


func test_a_ball_rests_on_branches_of_each_kind() -> void:
	for kind: TreeInstance3D.CollisionKind in TreeInstance3D.CollisionKind.values():
		var instance: TreeInstance3D = await _instance(_rails())
		instance.collision_kind = kind
		await _settle(instance)
		var ball: RigidBody3D = _ball(Vector3(0.7, 2.0, 0.0), 0.15)
		var branch: Object = await _hit(instance, Vector3(1.2, 3, 0.11), Vector3(1.2, 0.5, 0.11))
		await _simulate(1.5)
		if kind == TreeInstance3D.CollisionKind.TRUNK_ONLY:
			check(branch == null, "A ray hit a branch that is not there.")
			check(ball.position.y < 1.0, "The ball hangs at %s." % ball.position)
		else:
			check(branch is StaticBody3D, "Kind %d: the ray hit %s." % [kind, branch])
			check(absf(ball.position.y - 1.65) < 0.1, "Kind %d: %s" % [kind, ball.position])
		ball.free()
		instance.free()


func test_convex_parts_hold_the_budget() -> void:
	var made: TreeReconstruction = grown_tree(3)
	for maximum: int in [1, 5, 40]:
		var parts: Array[Dictionary] = made.build_convex_parts(maximum, 0.005)
		check(parts.size() <= maximum and not parts.is_empty(), "%d parts" % parts.size())
		for part: Dictionary in parts:
			check_equal((part["points"] as PackedVector3Array).size(), 16, "points")
	check(
		made.build_convex_parts(40, 0.005, true).size() < made.build_convex_parts(40, 0.005).size(),
		"The trunk alone has as many parts as the tree."
	)
	expect_error("between 1 and 10000")
	check_equal(made.build_convex_parts(0).size(), 0, "parts of no budget")
	expect_error("more than 0 kg")
	check(made.weigh(-1.0).is_empty(), "Wood weighs less than nothing.")


func test_a_felled_trunk_comes_to_lie() -> void:
	for kind: TreeInstance3D.CollisionKind in [0, 1]:
		var ground: StaticBody3D = _ground()
		var instance: TreeInstance3D = await _instance(_rails())
		instance.collision_kind = kind
		await _settle(instance)
		var body: RigidBody3D = instance.fell(2, 800.0, true)
		check_equal(_bodies(instance).size(), 1, "the stump's bodies")
		var wood: Dictionary = (body.get_child(0) as TreeInstance3D).reconstruction.weigh(800.0)
		check_near(body.mass, wood["mass"], 1e-3 * body.mass, "the mass")
		check(body.inertia.is_equal_approx(wood["inertia"]), "The inertia is %s." % body.inertia)
		await _settle(instance)
		await _settle(body.get_child(0) as TreeInstance3D)
		body.linear_velocity = Vector3(0.8, 0, 0.5)
		await _simulate(5.0)
		var speed: Vector3 = body.linear_velocity
		check(speed.length() < 0.5, "Kind %d still moves: %s" % [kind, speed])
		check(body.global_position.y < 0.9, "It stands: %s" % body.global_position)
		check(
			body.global_position.y > -0.1, "It fell through the ground: %s" % body.global_position
		)
		body.free()
		instance.free()
		ground.free()


func test_a_fallen_piece_is_cut_again() -> void:
	var instance: TreeInstance3D = await _instance(_rails())
	var body: RigidBody3D = instance.fell(1)
	var fallen: TreeInstance3D = body.get_child(0)
	body.linear_velocity = Vector3(1, 2, 3)
	body.angular_velocity = Vector3(0, 0, 0.5)
	var whole: float = body.mass
	var places: PackedVector3Array = []
	for id: int in fallen.reconstruction.get_node_ids():
		places.append(fallen.global_transform * fallen.reconstruction.get_node_position(id))
	var trunk: PackedInt32Array = fallen.reconstruction.get_node_ids()
	var second: RigidBody3D = fallen.fell(trunk[2])
	check(second != null and second.get_parent() == tree.root, "It is not beside the first.")
	check_near(body.mass + second.mass, whole, 0.02 * whole, "both masses")
	# Each node is where it was.
	for half: TreeInstance3D in [fallen, second.get_child(0) as TreeInstance3D]:
		for id: int in half.reconstruction.get_node_ids():
			var at: Vector3 = half.global_transform * half.reconstruction.get_node_position(id)
			var nearest: float = INF
			for place: Vector3 in places:
				nearest = minf(nearest, place.distance_to(at))
			check(nearest < 1e-3, "A node moved by %s m." % nearest)
	# They fly on as one: the velocity of each is that of the whole at its centre.
	var apart: Vector3 = second.global_position - body.global_position
	var wanted: Vector3 = body.linear_velocity + Vector3(0, 0, 0.5).cross(apart)
	check(second.linear_velocity.is_equal_approx(wanted), "%s" % second.linear_velocity)
	for part: RigidBody3D in [body, second]:
		var shapes: int = 0
		for child: Node in part.get_children(true):
			shapes += 1 if child is CollisionShape3D else 0
		check(shapes > 0, "A half has no shape.")
	second.free()
	body.free()
	instance.free()


func test_the_thinnest_piece_has_a_shape() -> void:
	var made: TreeReconstruction = grown_tree(2)
	var instance: TreeInstance3D = await _instance(made)
	var twig: int = -1
	for id: int in made.get_leaves():
		if made.get_node_radius(id) < 0.02:
			twig = id
	for kind: TreeInstance3D.CollisionKind in TreeInstance3D.CollisionKind.values():
		instance.collision_kind = kind
		instance.reconstruction = made
		var body: RigidBody3D = instance.fell(twig)
		check(body.get_child_count(true) > 1, "Kind %d has no shape." % kind)
		body.free()
	instance.free()


func test_felling_leaves_nothing_behind() -> void:
	var made: TreeReconstruction = _rails()
	var before: int = 0
	for round_of: int in 4:
		var instance: TreeInstance3D = await _instance(made)
		var body: RigidBody3D = instance.fell(2, 800.0, true)
		await _settle(instance)
		await _settle(body.get_child(0) as TreeInstance3D)
		body.free()
		instance.free()
		await tree.process_frame
		var now: int = int(Performance.get_monitor(Performance.OBJECT_COUNT))
		if round_of == 1:
			before = now
		elif round_of > 1:
			check(now <= before, "%d objects stayed." % (now - before))


func _shape_count(body: Node) -> int:
	var count: int = 0
	for child: Node in body.get_children(true):
		count += 1 if child is CollisionShape3D and not child.is_queued_for_deletion() else 0
	return count


# Felled wood is saved as it lies, with a scene or alone.
func test_a_felled_tree_that_was_saved_lies_on_the_ground() -> void:
	var ground: StaticBody3D = _ground()
	var world: Node3D = Node3D.new()
	tree.root.add_child(world)
	var instance: TreeInstance3D = await _instance(_rails())
	instance.reparent(world)
	var body: RigidBody3D = instance.fell(2)
	var mass: float = body.mass
	var inertia: Vector3 = body.inertia
	var shapes: int = _shape_count(body)
	check(shapes > 0, "It has no shapes.")
	var alone: PackedScene = PackedScene.new()
	check_equal(alone.pack(body), OK, "packing it")
	body.owner = world
	body.get_child(0).owner = world
	var scene: PackedScene = PackedScene.new()
	check_equal(scene.pack(world), OK, "packing the world")
	var path: String = folder.path_join("felled.scn")
	check_equal(ResourceSaver.save(scene, path), OK, "saving")
	world.free()
	var read: PackedScene = ResourceLoader.load(path, "", ResourceLoader.CACHE_MODE_IGNORE)
	for from: PackedScene in [alone, read]:
		var again: Node = from.instantiate()
		tree.root.add_child(again)
		var lying: RigidBody3D = again as RigidBody3D
		if lying == null:
			for child: Node in again.get_children():
				lying = child as RigidBody3D if child is RigidBody3D else lying
		lying.linear_velocity = Vector3(0.8, 0.0, 0.5)
		await tree.process_frame
		check_equal(_shape_count(lying), shapes, "its shapes")
		check_equal(lying.mass, mass, "its mass")
		check(lying.inertia.is_equal_approx(inertia), "Its inertia is %s." % lying.inertia)
		await _settle(lying.get_child(0) as TreeInstance3D)
		await _simulate(5.0)
		check(lying.global_position.y < 0.9, "It stands: %s" % lying.global_position)
		check(lying.global_position.y > -0.1, "It fell through: %s" % lying.global_position)
		# In a copy, too; and leaving the scene costs no shape.
		var copy: RigidBody3D = lying.duplicate() as RigidBody3D
		tree.root.add_child(copy)
		await tree.process_frame
		check_equal(_shape_count(copy), shapes, "shapes of its copy")
		copy.free()
		var holder: Node = lying.get_parent()
		holder.remove_child(lying)
		holder.add_child(lying)
		await tree.process_frame
		check_equal(_shape_count(lying), shapes, "its shapes when it comes back")
		again.free()
	ground.free()


func test_wood_alone_becomes_a_body() -> void:
	var instance: TreeInstance3D = await _instance(_rails())
	instance.transform = Transform3D(Basis(Vector3.UP, 0.4), Vector3(2, 1, 3))
	var before: Transform3D = instance.global_transform
	var body: RigidBody3D = instance.make_body(500.0)
	check(body != null and instance.get_parent() == body, "It is in no body.")
	check(instance.global_transform.is_equal_approx(before), "It has moved.")
	check_near(
		body.mass, instance.reconstruction.weigh(500.0)["mass"], 1e-3 * body.mass, "the mass"
	)
	check(_shape_count(body) > 0, "It has no shapes.")
	await tree.process_frame
	check(_bodies(instance).is_empty(), "It collides with itself.")
	check(instance.make_body(1000.0) == body, "There is another body.")
	check_near(body.mass, instance.reconstruction.weigh(1000.0)["mass"], 1e-3 * body.mass, "twice")
	body.free()


func test_what_cannot_fall_is_said() -> void:
	var instance: TreeInstance3D = await _instance(_rails())
	for density: float in [0.0, -1.0, NAN, INF]:
		expect_error("more than 0 kg")
		check(instance.fell(2, density) == null, "It fell at %s." % density)
		check(instance.make_body(density) == null, "It is a body of %s." % density)
	for id: int in [-1, 999, 1 << 31, (1 << 32) + 2, 1 << 62]:
		expect_error("node")
		check(instance.fell(id) == null, "It fell at node %d." % id)
	for size: Vector3 in [Vector3.ZERO, Vector3(1.0, 0.0, 1.0)]:
		instance.scale = size
		expect_error("not finite, or flat")
		check(instance.fell(2) == null, "It fell at the scale %s." % size)
		check(instance.make_body() == null, "It is a body at the scale %s." % size)
	instance.transform = Transform3D()
	instance.reconstruction = null
	expect_error("Only a tree in a scene")
	check(instance.fell(2) == null, "Nothing fell.")
	instance.free()
	var alone: TreeInstance3D = TreeInstance3D.new()
	alone.reconstruction = _rails()
	check(alone.make_body() == null, "It is a body in no scene.")
	alone.free()


# A sapling of 5 cm stops a ball as a tree does, in a forest, too.
func test_a_sapling_collides() -> void:
	var made: TreeReconstruction = TreeReconstruction.new()
	var nodes: Array[Array] = [[-1, 0.0, 0.0, 0.0, 0.028, NODE_TRUNK | NODE_MEASURED]]
	for i: int in range(1, 9):
		nodes.append([i - 1, 0.0, 0.4 * i, 0.0, 0.028 - 0.003 * i, NODE_TRUNK])
	made.skeleton = skeleton(nodes)
	for kind: TreeInstance3D.CollisionKind in TreeInstance3D.CollisionKind.values():
		var instance: TreeInstance3D = await _instance(made)
		instance.collision_kind = kind
		await _settle(instance)
		var hit: Object = await _hit(instance, Vector3(3, 1.3, 0), Vector3(-3, 1.3, 0))
		check(hit is StaticBody3D, "Kind %d: the ray hit %s." % [kind, hit])
		instance.free()
	var forest: TreeVariantSpawner3D = TreeVariantSpawner3D.new()
	forest.source = made
	forest.variants = 1
	forest.levels = 1
	forest.amount = 0.0
	forest.ages = Vector2.ONE
	forest.collision = true
	forest.placement = TreeVariantSpawner3D.Placement.GIVEN
	forest.transforms = [Transform3D()]
	tree.root.add_child(forest)
	await forest.finished
	for frame: int in 5:
		await tree.physics_frame
	var query: PhysicsRayQueryParameters3D = PhysicsRayQueryParameters3D.create(
		Vector3(3, 1.3, 0), Vector3(-3, 1.3, 0)
	)
	var found: Object = forest.get_world_3d().direct_space_state.intersect_ray(query).get(
		"collider"
	)
	check_equal(forest.find_tree_of(found as Node), 0, "which tree of the forest was hit")
	forest.free()


# A crown of twigs that are too thin for shapes of their own lies on the ground, not in it.
func test_thin_wood_does_not_sink() -> void:
	var nodes: Array[Array] = [[-1, 0.0, 0.0, 0.0, 0.12, NODE_TRUNK | NODE_MEASURED]]
	for i: int in range(1, 7):
		nodes.append([i - 1, 0.0, 0.7 * i, 0.0, 0.12 - 0.01 * i, NODE_TRUNK])
	for i: int in range(3, 7):
		for side: int in 6:
			var way: Vector3 = Vector3(cos(TAU * side / 6.0 + i), 0.5, sin(TAU * side / 6.0 + i))
			var from: int = i
			for step: int in range(1, 5):
				var at: Vector3 = Vector3(0.0, 0.7 * i, 0.0) + 0.35 * step * way
				nodes.append([from, at.x, at.y, at.z, 0.02 - 0.003 * step, 0])
				from = nodes.size() - 1
	var made: TreeReconstruction = TreeReconstruction.new()
	made.skeleton = skeleton(nodes)
	var ground: StaticBody3D = _ground()
	for kind: TreeInstance3D.CollisionKind in [0, 1]:
		var instance: TreeInstance3D = await _instance(made)
		instance.collision_kind = kind
		await _settle(instance)
		var body: RigidBody3D = instance.fell(1)
		var fallen: TreeInstance3D = body.get_child(0)
		var start: Vector3 = body.global_position
		await _simulate(0.1)
		check(body.global_position.distance_to(start) < 0.3, "It was thrown off.")
		body.linear_velocity = Vector3(1.2, 0, 0.4)
		await _simulate(6.0)
		check(body.global_position.distance_to(start) < 6.0, "It went %s." % body.global_position)
		check(body.global_basis.y.length() > 0.0 and body.global_position.y < 2.0, "It stands.")
		var deepest: float = INF
		for id: int in fallen.reconstruction.get_node_ids():
			deepest = minf(
				deepest, (fallen.global_transform * fallen.reconstruction.get_node_position(id)).y
			)
		check(deepest > -0.1, "Kind %d: twigs are %s m in the ground." % [kind, -deepest])
		body.free()
		instance.free()
	ground.free()
