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


# Each property of a rule by itself, then all at once at either end of their ranges.
func test_numbers_of_a_leaf_rule() -> void:
	var made: TreeReconstruction = grown_tree(4)
	var usual: LeafRule = LeafRule.from_preset("maple")
	var numbers: PackedStringArray = []
	for entry: Dictionary in usual.get_property_list():
		if entry["type"] in [TYPE_FLOAT, TYPE_INT] and entry["usage"] & PROPERTY_USAGE_STORAGE:
			numbers.append(entry["name"])
	check(numbers.size() > 20, "A rule has %d numbers." % numbers.size())
	expect_error("must be a finite number")
	expect_error("There is no ")
	for name: String in numbers:
		var rule: LeafRule = usual.duplicate()
		made.leaf_rule = rule
		for number: float in ODD + ([0.0, -1e30, 1e300, -1e300] as Array[float]):
			if rule.get(name) is float:
				rule.set(name, number)
			elif is_finite(number):
				rule.set(name, int(clampf(number, -1e15, 1e15)))
			check(is_finite(rule.get(name)), "%s is %s after %s." % [name, rule.get(name), number])
		# Two million are the most that there may be, and no stall.
		rule.maximum_leaves = mini(rule.maximum_leaves, 20_000)
		_check_leaves(made, name)
	for number: float in [-1e30, 1e30]:
		var rule: LeafRule = usual.duplicate()
		for name: String in numbers:
			if rule.get(name) is float:
				rule.set(name, number)
		rule.maximum_leaves = 20_000
		made.leaf_rule = rule
		_check_leaves(made, "all at %s" % number)


func test_resources_of_a_leaf_rule() -> void:
	var made: TreeReconstruction = grown_tree(4)
	var rule: LeafRule = LeafRule.new()
	made.leaf_rule = rule
	var curve: Curve = Curve.new()
	curve.max_value = 1e30
	for number: float in ODD:
		curve.add_point(Vector2(0.5, number))
		rule.density_by_height = curve
		rule.density_by_radius = curve
		_check_leaves(made, "a curve with %s" % number)
		var colors: Gradient = Gradient.new()
		colors.set_color(0, Color(number, number, number, number))
		rule.season_colors = colors
		for color: Color in rule.get_season_tints():
			check(
				is_finite(color.r) and is_finite(color.g) and is_finite(color.b),
				"A tint is %s after %s." % [color, number]
			)
	rule.season_colors = null
	for shares: PackedFloat32Array in [[NAN], [INF], [-1.0], [0.5, NAN]]:
		expect_error("density_by_order")
		rule.density_by_order = shares
		check(rule.density_by_order.is_empty(), "%s were taken." % shares)


func _check_leaves(made: TreeReconstruction, what: String) -> void:
	var begun: int = Time.get_ticks_msec()
	for lod: int in [0, 2]:
		for number: float in made.build_leaf_buffer(lod):
			if not is_finite(number):
				check(false, "A leaf is not finite: %s." % what)
				break
		for vertex: Vector3 in made.build_leaf_form_arrays(lod)[Mesh.ARRAY_VERTEX]:
			if not vertex.is_finite():
				check(false, "A card is not finite: %s." % what)
				break
	check(Time.get_ticks_msec() - begun < 20_000, "It stalls: %s." % what)


func test_numbers_of_a_pick() -> void:
	var made: TreeReconstruction = grown_tree(3)
	var size: Vector2 = Vector2(1280.0, 720.0)
	var view: Projection = (
		Projection.create_perspective(60.0, size.aspect(), 0.05, 500.0)
		* Projection(Transform3D(Basis(), Vector3(0.0, 3.0, 12.0)).affine_inverse())
	)
	var all: Rect2 = Rect2(Vector2.ZERO, size)
	check(not made.pick_nodes(view, size, all).is_empty(), "Nothing is in the view.")
	for number: float in [NAN, INF, -INF]:
		for column: int in 4:
			var odd: Projection = view
			odd[column][1] = number
			check_equal(made.pick_node(odd, size, size / 2.0), -1, "a view with %s" % number)
			check(made.pick_nodes(odd, size, all).is_empty(), "A view with %s." % number)
		for viewport: Vector2 in [Vector2(number, 720.0), Vector2(1280.0, number)]:
			check_equal(made.pick_node(view, viewport, size / 2.0), -1, "through %s" % viewport)
			check(made.pick_nodes(view, viewport, all).is_empty(), "Through %s." % viewport)
		check_equal(made.pick_node(view, size, Vector2(number, 360.0)), -1, "at %s" % number)
	check(made.pick_nodes(view, size, Rect2(NAN, 0.0, 10.0, 10.0)).is_empty(), "In no rectangle.")
	for distance: float in [NAN, -1.0, -INF]:
		check_equal(made.pick_node(view, size, size / 2.0, distance), -1, "within %s" % distance)
	for distance: float in [INF, 1e30]:
		check(
			made.has_node(made.pick_node(view, size, size / 2.0, distance)), "Nothing is nearest."
		)
	for viewport: Vector2 in [Vector2.ZERO, -size, size * 1e30]:
		made.pick_node(view, viewport, size / 2.0)
		made.pick_nodes(view, viewport, all)


# What a script may ask for in bulk is bounded, or refused.
func test_huge_counts() -> void:
	var made: TreeReconstruction = grown_tree(3)
	for sentence: String in [
		"between 1 and 10000 capsules",
		"between 1 and 10000 convex parts",
		"16 to 1024 pixels",
		"no level of detail -1",
		"Capsules need a minimum radius",
		"Convex parts need a minimum radius",
		"The amount of variation must be 0 to 1",
	]:
		expect_error(sentence)
	var begun: int = Time.get_ticks_msec()
	for seed: int in [-1, 1 << 62, -(1 << 63), 9223372036854775807]:
		var variant: TreeReconstruction = made.make_variant(seed, 1.0, 1.2)
		check(variant != null and variant.get_aabb().size.is_finite(), "Seed %d makes none." % seed)
	for number: int in [-(1 << 40), -1, 0, 100_000, 1 << 40]:
		var capsules: Array[Dictionary] = made.build_capsules(number)
		check(capsules.size() <= 100_000, "%d capsules." % capsules.size())
		made.build_convex_parts(number)
		made.build_leaf_buffer(number)
		made.build_mesh_arrays(number)
		made.draw(number)
	for number: float in ODD:
		var capsules: Array[Dictionary] = made.build_capsules(24, number)
		for capsule: Dictionary in capsules:
			check(is_finite(capsule["radius"]), "A capsule of %s." % number)
		made.build_convex_parts(24, number)
		check(made.make_variant(3, number) == null or number == 1.0, "An amount of %s." % number)
	check(Time.get_ticks_msec() - begun < 30_000, "It stalls.")


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
