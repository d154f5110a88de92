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
	# The engine's own sentence, for whatever is drawn there; it has others for bodies.
	instance.collision = false
	expect_error("v.is_finite()")
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
