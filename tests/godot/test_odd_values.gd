extends "./suite.gd"
## What no node can work with: it is refused with a sentence or changes nothing, and nothing stalls.

const ODD: Array[float] = [NAN, INF, -INF, -1.0, 1e30]


func test_numbers_of_a_tree() -> void:
	var instance: TreeInstance3D = TreeInstance3D.new()
	instance.reconstruction = grown_tree(2)
	instance.collision = true
	tree.root.add_child(instance)
	for number: int in [-100_000, 100_000, 1 << 40, -(1 << 40)]:
		for property: String in ["lod", "levels", "shadow_level", "collision_shapes"]:
			instance.set(property, number)
		check(instance.lod >= -1 and instance.lod <= 4, "lod is %d." % instance.lod)
		check(instance.levels >= 1 and instance.levels <= 5, "levels is %d." % instance.levels)
		check_equal(instance.get_level_budget(number), 0, "the budget of level %d" % number)
		check_equal(instance.get_level_triangle_count(number), 0, "triangles of %d" % number)
	instance.lod = -1
	instance.levels = 3
	for number: float in ODD:
		instance.collision_minimum_radius = number
		check(is_finite(instance.collision_minimum_radius), "The radius is not finite.")
	instance.collision_minimum_radius = 0.03
	instance.level_distances = PackedFloat32Array([NAN, INF])
	instance.level_budgets = PackedInt32Array([-5, -5, -5])
	expect_error("can't stand at a place that is no number")
	for frame: Transform3D in [
		Transform3D(Basis.from_scale(Vector3.ZERO), Vector3.ZERO),
		Transform3D(Basis(), Vector3(NAN, 0.0, 0.0)),
		Transform3D(),
	]:
		instance.transform = frame
		instance.rebuild()
		await _built(instance)
	check(instance.get_triangle_count() > 0, "It is not drawn at last.")
	instance.free()


func _built(instance: TreeInstance3D) -> void:
	var deadline: int = Time.get_ticks_msec() + 10_000
	while instance.is_building_levels() and Time.get_ticks_msec() < deadline:
		await tree.process_frame
	check(not instance.is_building_levels(), "It is never built.")


func test_numbers_of_the_wind() -> void:
	var wind: TreeWind = TreeWind.new()
	tree.root.add_child(wind)
	for number: float in ODD:
		for property: String in ["strength", "speed", "gustiness", "area_storm"]:
			wind.set(property, number)
		wind.direction = Vector2(number, 1.0)
		var values: Dictionary[StringName, Variant] = wind.get_values()
		for name: StringName in values:
			var value: Variant = values[name]
			var finite: bool = (
				(value as Vector2).is_finite() if value is Vector2 else is_finite(value)
			)
			check(finite, "%s is %s after %s." % [name, value, number])
	wind.area = Area3D.new()
	wind.area_storm = 0.0
	wind.area.wind_force_magnitude = 5.0
	check(is_finite(wind.get_values()[&"tree_wind_strength"]), "The area blows without end.")
	wind.area.free()
	wind.free()
	expect_error("Give show_channel() a TreeInstance3D")
	TreeWind.show_channel(null, TreeWind.Channel.SWAY)


func test_numbers_of_a_pusher() -> void:
	const Pushing := preload("res://addons/tree_reconstruction/nodes/pushing.gd")
	var pusher: TreePusher3D = TreePusher3D.new()
	pusher.position = Vector3(1.0, 2.0, 3.0)
	tree.root.add_child(pusher)
	for i: int in 3:
		await tree.process_frame
	for number: float in ODD:
		pusher.radius = number
		pusher.strength = number
		pusher.position = Vector3(
			number if absf(number) > 1e20 or is_nan(number) else 0.0, 0.0, 0.0
		)
		for i: int in 3:
			await tree.process_frame
		for sphere: Vector4 in Pushing.get_spheres():
			check(sphere.is_finite(), "The shaders have %s." % sphere)
	pusher.free()
	await tree.process_frame


# With a body, and built before and after it gets there. A place that is no number is refused with
# a sentence; one of no size only collides with nothing.
func test_places_of_a_tree() -> void:
	var here: Transform3D = Transform3D(Basis.IDENTITY, Vector3(1.0, 2.0, 3.0))
	var odd: Array[Transform3D] = [
		here.scaled_local(Vector3.ZERO),
		here.scaled_local(Vector3(1.0, 0.0, 1.0)),
		here.scaled_local(Vector3(-1.0, 1.0, 1.0)),
		Transform3D(Basis.IDENTITY, Vector3(NAN, 0.0, 0.0)),
		Transform3D(Basis.IDENTITY, Vector3(0.0, INF, 0.0)),
		Transform3D(Basis(Vector3.ONE * NAN, Vector3.UP, Vector3.BACK), Vector3.ZERO),
	]
	expect_error("can't stand at a place that is no number")
	for kind: TreeInstance3D.CollisionKind in TreeInstance3D.CollisionKind.values():
		for frame: Transform3D in odd:
			for late: bool in [false, true]:
				await _place_tree(kind, here, frame, late)


func _place_tree(
	kind: TreeInstance3D.CollisionKind, here: Transform3D, frame: Transform3D, late: bool
) -> void:
	var instance: TreeInstance3D = TreeInstance3D.new()
	instance.collision = true
	instance.collision_kind = kind
	instance.reconstruction = grown_tree(2)
	instance.transform = here
	if not late:
		instance.transform = frame
	tree.root.add_child(instance)
	while instance.is_building_levels():
		await tree.process_frame
	instance.transform = frame
	await tree.physics_frame
	await tree.process_frame
	var collides: bool = instance.transform.basis.determinant() != 0.0
	check_equal(instance.transform, frame if frame.is_finite() else here, "its place")
	check_equal(_has_body(instance), collides, "whether it collides at %s" % frame)
	check(instance.get_tree_height() >= 0.0, "Its height is %s." % instance.get_tree_height())
	instance.transform = here
	await tree.physics_frame
	check(_has_body(instance), "It does not collide any more after %s." % frame)
	instance.free()


func _has_body(instance: TreeInstance3D) -> bool:
	for child: Node in instance.get_children(true):
		if child is StaticBody3D:
			return true
	return false
