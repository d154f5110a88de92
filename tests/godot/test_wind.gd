extends "./suite.gd"
## The wind's globals, its nodes and what they leave behind, without a picture.

const WindGlobals: GDScript = preload("res://addons/tree_reconstruction/editor/wind_globals.gd")
const SETTINGS: String = "shader_globals/"


func test_the_shaders_globals_are_there() -> void:
	var known: Array[StringName] = RenderingServer.global_shader_parameter_get_list()
	var code: String = FileAccess.get_file_as_string(
		"res://addons/tree_reconstruction/shaders/tree_wind.gdshaderinc"
	)
	var globals: Dictionary = TreeReconstruction.get_wind_globals()
	var found: Array[RegExMatch] = (
		RegEx.create_from_string("global uniform (\\w+) (\\w+);").search_all(code)
	)
	check_equal(found.size(), globals.size(), "the number of globals in the shader")
	var types: Dictionary[String, int] = {
		"float": TYPE_FLOAT, "vec2": TYPE_VECTOR2, "vec4": TYPE_VECTOR4
	}
	for global: RegExMatch in found:
		var name: String = global.get_string(2)
		check(globals.has(name), "The library does not know %s." % name)
		check_equal(typeof(globals.get(name)), types[global.get_string(1)], "the type of " + name)
		check(StringName(name) in known, "The renderer does not know %s." % name)
		if name in ["tree_wind_shift"] or name.begins_with("tree_push"):
			continue
		# Baked trees have the same, as their own.
		var own: RegEx = RegEx.create_from_string("\\nuniform \\w+ %s[^=]*= ([^;]+);" % name)
		var value: RegExMatch = own.search(code)
		check(value != null, "A baked tree has no %s." % name)
		if value != null:
			var numbers: String = value.get_string(1).replace("vec2", "Vector2")
			check_equal(str(str_to_var(numbers)), str(globals[name]), "a baked tree's " + name)


func test_the_plugin_adds_what_is_missing_and_keeps_what_was_changed() -> void:
	var globals: Dictionary = TreeReconstruction.get_wind_globals()
	for name: String in globals:
		check(
			not ProjectSettings.has_setting(SETTINGS + name), "The project has %s already." % name
		)
	check_equal(WindGlobals.add(), globals.size(), "how many were added")
	check_equal(WindGlobals.add(), 0, "how many were added again")
	for name: String in globals:
		var setting: Dictionary = ProjectSettings.get_setting(SETTINGS + name)
		check_equal(setting.value, globals[name], name)
		check_equal(TreeWind.get_project_value(name), globals[name], name + " as the node reads it")
	var changed: Dictionary = {"type": "float", "value": 0.7}
	ProjectSettings.set_setting(SETTINGS + "tree_wind_strength", changed)
	check_equal(TreeWind.get_project_value(&"tree_wind_strength"), 0.7, "the project's strength")
	check_equal(WindGlobals.remove(), globals.size() - 1, "how many were removed")
	check_equal(
		ProjectSettings.get_setting(SETTINGS + "tree_wind_strength"), changed, "what was changed"
	)
	ProjectSettings.set_setting(SETTINGS + "tree_wind_strength", null)


func test_the_last_wind_blows() -> void:
	var first: TreeWind = TreeWind.new()
	var second: TreeWind = TreeWind.new()
	tree.root.add_child(first)
	tree.root.add_child(second)
	check_equal(first._get_configuration_warnings().size(), 1, "what the first warns of")
	check_equal(second._get_configuration_warnings().size(), 0, "what the second warns of")
	second.free()
	check_equal(first._get_configuration_warnings().size(), 0, "what the first warns of then")
	first.free()


func test_a_wind_follows_an_area() -> void:
	var wind: TreeWind = TreeWind.new()
	var area: Area3D = Area3D.new()
	var source: Node3D = Node3D.new()
	area.add_child(source)
	tree.root.add_child(area)
	tree.root.add_child(wind)
	source.rotation_degrees = Vector3(0.0, -90.0, 0.0)
	area.wind_source_path = area.get_path_to(source)
	area.wind_force_magnitude = 5.0
	wind.area = area
	var values: Dictionary = wind.get_values()
	check_near(values[&"tree_wind_strength"], 0.5, 1e-6, "the strength")
	var way: Vector2 = values[&"tree_wind_direction"]
	check(way.normalized().distance_to(Vector2.RIGHT) < 1e-4, "It blows to %s." % way)
	# An area that goes leaves the node's own.
	area.free()
	check_near(wind.get_values()[&"tree_wind_strength"], 0.4, 1e-6, "the strength without")
	await tree.process_frame
	wind.free()


func test_the_clock_goes_on_when_the_speed_changes() -> void:
	var wind: TreeWind = TreeWind.new()
	tree.root.add_child(wind)
	var clock: Callable = func() -> float:
		return Time.get_ticks_msec() / 1000.0 * wind.speed + wind.get_values()[&"tree_wind_shift"]
	for speed: float in [2.0, 0.5, 0.0, 4.0, 1.0]:
		var before: float = clock.call()
		wind.speed = speed
		check_near(clock.call(), before, 0.2, "the clock at speed %s" % speed)
	wind.free()


func test_pushers_come_and_go() -> void:
	var pushers: Array[TreePusher3D] = []
	for i: int in 7:
		var pusher: TreePusher3D = TreePusher3D.new()
		pusher.position = Vector3(i, 0.0, 0.0)
		pushers.append(pusher)
		tree.root.add_child(pusher)
	for i: int in 3:
		await tree.process_frame
	check_equal(TreePusher3D.Pushing.get_spheres().size(), 4, "the number of spheres")
	for pusher: TreePusher3D in pushers:
		pusher.free()
	var left: int = 600
	while not TreePusher3D.Pushing.get_spheres().is_empty() and left > 0:
		await tree.process_frame
		left -= 1
	check(left > 0, "The spheres do not go.")


func test_the_nearest_pushers_take_effect() -> void:
	var camera: Camera3D = Camera3D.new()
	tree.root.add_child(camera)
	camera.make_current()
	var pushers: Array[TreePusher3D] = []
	for i: int in 6:
		var pusher: TreePusher3D = TreePusher3D.new()
		pusher.position = Vector3(10.0 * (5 - i), 0.0, 0.0)
		pushers.append(pusher)
		tree.root.add_child(pusher)
	for i: int in 3:
		await tree.process_frame
	for sphere: Vector4 in TreePusher3D.Pushing.get_spheres():
		check(sphere.x < 35.0, "One at %s takes effect." % sphere)
	for pusher: TreePusher3D in pushers:
		pusher.free()
	camera.free()
	var left: int = 600
	while not TreePusher3D.Pushing.get_spheres().is_empty() and left > 0:
		await tree.process_frame
		left -= 1
