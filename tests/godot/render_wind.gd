extends "./picture_suite.gd"
## The wind in the renderer that this run uses: what moves, what stays, and by what.

const WindRest: GDScript = preload("res://addons/tree_reconstruction/editor/viewport/wind_rest.gd")
const SIZE: Vector2i = Vector2i(240, 240)
# The wind's clock is looked at each so many seconds, so often: some swing of these reaches out.
const SWING_STEP: float = 0.4
const MOST_SWINGS: int = 24

var _instance: TreeInstance3D
var _wind: TreeWind


# A tree before the sky on ground, with a wind that stands still at first.
func _stage(made: TreeReconstruction, with_wind: bool = true) -> void:
	_open_stage(SIZE, true)
	_look_at_all(made)
	if with_wind:
		_wind = TreeWind.new()
		_wind.strength = 0.0
		_viewport.add_child(_wind)
	_instance = await _show_tree(made)


func _wait(seconds: float) -> void:
	await tree.create_timer(seconds).timeout


func test_still_air_is_still_and_wind_is_not() -> void:
	await _stage(grown_tree(2))
	var still: Image = await _settled()
	await _wait(0.3)
	check_equal(_change(still, await _picture()), 0.0, "what moved in still air")
	_wind.strength = 1.0
	var first: Image = await _picture()
	check(_change(still, first) > 50.0, "The wind does not bend it.")
	await _wait(0.4)
	check(_change(first, await _picture()) > 50.0, "The wind does not move it.")
	_viewport.free()


func test_a_wind_without_speed_bends_and_holds() -> void:
	await _stage(grown_tree(2))
	_wind.speed = 0.0
	_wind.strength = 1.0
	var east: Image = await _settled()
	await _wait(0.3)
	check_equal(_change(east, await _picture()), 0.0, "what moved in a wind that stands")
	_wind.direction = Vector2(-1.0, 0.0)
	check(_change(east, await _picture()) > 50.0, "The direction does not matter.")
	_viewport.free()


# Neither a tree nor what is baked of it is left out where the wind bends it into the picture.
func test_what_is_bent_over_the_border_is_drawn() -> void:
	# So slim that it bends far out of its box.
	var made: TreeReconstruction = LSystem.read_string("!(0.03) F(1) F(1) F(1) F(1) F(1)")
	await _stage(made)
	_wind.speed = 0.0
	_wind.gustiness = 0.0
	_wind.direction = Vector2(1.0, 0.0)
	_camera.projection = Camera3D.PROJECTION_ORTHOGONAL
	_camera.size = made.get_aabb().size.y * 1.2
	_wind.strength = 1.25
	var baked: Node3D = _baked(made, true)
	_viewport.add_child(baked)
	for shown: Node3D in [_instance, baked]:
		_instance.visible = shown == _instance
		baked.visible = shown == baked
		var drawn: MeshInstance3D = shown as MeshInstance3D
		if drawn == null:
			drawn = shown.get_child(0)
		var rest: AABB = (
			drawn.custom_aabb if shown == baked else (drawn.mesh as ArrayMesh).custom_aabb
		)
		# The picture begins where the tree at rest ends.
		_camera.position.x = rest.end.x + 0.5 * _camera.size + 0.005
		var change: float = 0.0
		# Where the clock of all tests stands, a gust may just have let go of it, and how far it goes
		# in a time depends on how busy the machine is: so the clock is set.
		for swing: int in MOST_SWINGS:
			RenderingServer.global_shader_parameter_set(&"tree_wind_shift", SWING_STEP * swing)
			var bent: Image = await _settled()
			shown.visible = false
			change = _change(bent, await _settled())
			shown.visible = true
			if change > 1.0:
				break
		check(change > 1.0, "%s is left out: %.2f." % [shown.name, change])
	baked.free()
	_viewport.free()


func test_without_a_node_the_project_says_how_it_blows() -> void:
	await _stage(grown_tree(2), false)
	var first: Image = await _picture()
	await _wait(0.4)
	check(_change(first, await _picture()) > 20.0, "There is no wind in a project without.")
	# A node takes over, and gives back what was.
	var wind: TreeWind = TreeWind.new()
	wind.strength = 0.0
	_viewport.add_child(wind)
	first = await _settled()
	await _wait(0.3)
	check_equal(_change(first, await _picture()), 0.0, "what moved against the node's will")
	wind.free()
	first = await _picture()
	await _wait(0.4)
	check(_change(first, await _picture()) > 20.0, "The wind did not come back.")
	_viewport.free()


# Whether something is drawn of itself, by an engine that draws only what has changed.
# What still changes may come to its end.
func _draws() -> bool:
	OS.low_processor_usage_mode = true
	var still: int = 0
	var frames: int = 0
	while still < 8 and frames < 30:
		var drawn: int = Engine.get_frames_drawn()
		await tree.process_frame
		still = still + 1 if Engine.get_frames_drawn() == drawn else 0
		frames += 1
	OS.low_processor_usage_mode = false
	return still < 8


func test_trees_at_rest_give_nothing_to_draw() -> void:
	await _stage(grown_tree(2), false)
	check(await _draws(), "The wind is not drawn.")
	var rest: WindRest = WindRest.new()
	rest.update(false)
	check(not await _draws(), "Trees at rest are drawn again and again.")
	var upright: Image = await _settled()
	rest.update(true)
	check(await _draws(), "The wind that is to be seen is not drawn.")
	check(_change(upright, await _picture()) > 20.0, "Trees at rest are bent.")
	# A node that does not blow lets them rest, and they are as they were.
	_wind = TreeWind.new()
	_wind.strength = 0.0
	_viewport.add_child(_wind)
	check_equal(_change(upright, await _settled()), 0.0, "what differs from still air")
	rest.update(false)
	check(not await _draws(), "Trees in still air are drawn again and again.")
	_wind.strength = 0.4
	rest.update(false)
	check(await _draws(), "The node's wind is not drawn.")
	_viewport.free()
	rest.update(false)
	rest.leave()


func test_the_shadow_moves_with_the_tree() -> void:
	await _stage(grown_tree(2))
	var ground: MeshInstance3D = MeshInstance3D.new()
	var plane: PlaneMesh = PlaneMesh.new()
	plane.size = Vector2(40.0, 40.0)
	ground.mesh = plane
	_viewport.add_child(ground)
	_instance.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_SHADOWS_ONLY
	_camera.position = Vector3(0.0, 9.0, 9.0)
	_camera.look_at(Vector3.ZERO)
	await _wait(0.1)
	var still: Image = await _picture()
	ground.visible = false
	check(_change(still, await _picture()) > 100.0, "There is no ground to see.")
	ground.visible = true
	_instance.visible = false
	check(_change(still, await _picture()) > 20.0, "There is no shadow to see.")
	_instance.visible = true
	_wind.speed = 0.0
	_wind.strength = 1.2
	check(_change(still, await _picture()) > 20.0, "The shadow does not sway.")
	_viewport.free()


func test_a_sphere_pushes_what_is_near() -> void:
	var made: TreeReconstruction = grown_tree(2)
	await _stage(made)
	var still: Image = await _settled()
	var box: AABB = made.get_aabb()
	var pusher: TreePusher3D = TreePusher3D.new()
	# At the crown's left in the picture.
	pusher.position = box.get_center() - Vector3(0.35 * box.size.x, 0.0, 0.0)
	pusher.radius = 0.25 * box.size.x
	_viewport.add_child(pusher)
	var frames: int = 0
	while frames < 300:
		await tree.process_frame
		frames += 1
		var spheres: Array[Vector4] = TreePusher3D.Pushing.get_spheres()
		if spheres.size() == 1 and is_equal_approx(spheres[0].w, pusher.radius):
			break
	var pushed: Image = await _picture()
	@warning_ignore("integer_division")
	var half: Vector2i = Vector2i(SIZE.x / 2, SIZE.y)
	var left: float = _change(still, pushed, Rect2i(Vector2i.ZERO, half))
	check(left > 5.0, "Nothing is pushed: %.1f." % left)
	var right: float = _change(still, pushed, Rect2i(half.x + 10, 0, half.x - 10, SIZE.y))
	check(right < 0.1 * left, "What is far is pushed, too: %.1f and %.1f." % [left, right])
	pusher.free()
	frames = 0
	while not TreePusher3D.Pushing.get_spheres().is_empty() and frames < 900:
		await tree.process_frame
		frames += 1
	check_equal(_change(still, await _picture()), 0.0, "what did not spring back")
	_viewport.free()


func test_less_quality_moves_less() -> void:
	await _stage(grown_tree(2))
	_wind.speed = 0.0
	_wind.strength = 1.0
	var pictures: Array[Image] = []
	for quality: int in 4:
		TreeWind.quality = quality as TreeWind.Quality
		pictures.append(await _settled())
	_wind.strength = 0.0
	var still: Image = await _settled()
	check_equal(_change(pictures[0], still), 0.0, "what moves at the lowest quality")
	for quality: int in range(1, 4):
		var changed: float = _change(pictures[quality], pictures[quality - 1])
		check(changed > 5.0, "Quality %d is like the one before: %.1f." % [quality, changed])
	check_equal(TreeWind.quality, TreeWind.Quality.FLUTTER, "the quality in the end")
	_viewport.free()


func _plain(shader: String) -> ShaderMaterial:
	var material: ShaderMaterial = ShaderMaterial.new()
	material.shader = load("res://addons/tree_reconstruction/shaders/%s.gdshader" % shader)
	return material


func _baked(made: TreeReconstruction, global_wind: bool) -> Node3D:
	var baker: TreeBaker = TreeBaker.new()
	baker.levels = 1
	baker.global_wind = global_wind
	baker.collision = false
	# Without their pictures, which take long to pack.
	baker.bark_material = _plain("bark")
	baker.leaf_material = _plain("leaf")
	return baker.bake(made).instantiate()


func test_a_baked_tree_follows_the_project_if_told_to() -> void:
	var made: TreeReconstruction = grown_tree(2)
	await _stage(made)
	_instance.visible = false
	# That trees rest in the editor is nothing that is baked.
	var rest: WindRest = WindRest.new()
	rest.update(false)
	for global: bool in [false, true]:
		var baked: Node3D = _baked(made, global)
		_viewport.add_child(baked)
		var first: Image = await _picture()
		if global:
			first = await _settled()
		await _wait(0.4)
		var moved: float = _change(first, await _picture())
		check((moved == 0.0) == global, "With global_wind = %s, it moved %.1f." % [global, moved])
		baked.free()
	rest.leave()
	_viewport.free()


func test_every_channel_can_be_looked_at() -> void:
	await _stage(grown_tree(2))
	var seen: Array[Image] = [await _settled()]
	for channel: int in range(1, TreeWind.Channel.MOTION + 1):
		TreeWind.show_channel(_instance, channel as TreeWind.Channel)
		seen.append(await _picture())
		for other: int in channel:
			var changed: float = _change(seen[channel], seen[other])
			check(changed > 20.0, "Channels %d and %d look the same." % [other, channel])
	# The number itself is seen, whatever the renderer works in: leaves have no level, and show 0.2.
	var levels: Image = seen[TreeWind.Channel.LEVEL]
	var exact: int = 0
	for y: int in levels.get_height():
		for x: int in levels.get_width():
			exact += int(_apart(levels.get_pixel(x, y), Color(0.2, 0.2, 0.2)) < 0.03)
	check(exact > 200, "Only %d pixels show the number." % exact)
	TreeWind.show_channel(_instance, TreeWind.Channel.NONE)
	check_equal(_change(seen[0], await _settled()), 0.0, "what stays of the channels")
	_viewport.free()
