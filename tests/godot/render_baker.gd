extends "./suite.gd"
## A baked tree looks like the one it was baked of, in the renderer that this run uses.

const SIZE: Vector2i = Vector2i(320, 320)
const SKY: Color = Color(0.2, 0.3, 0.9)

var _viewport: SubViewport


func _stage(made: TreeReconstruction, at: Vector3) -> void:
	_viewport = SubViewport.new()
	_viewport.size = SIZE
	_viewport.own_world_3d = true
	_viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	tree.root.add_child(_viewport)
	var world: WorldEnvironment = WorldEnvironment.new()
	world.environment = Environment.new()
	world.environment.background_mode = Environment.BG_COLOR
	world.environment.background_color = SKY
	world.environment.ambient_light_source = Environment.AMBIENT_SOURCE_COLOR
	world.environment.ambient_light_color = Color.WHITE
	world.environment.ambient_light_energy = 0.5
	_viewport.add_child(world)
	var sun: DirectionalLight3D = DirectionalLight3D.new()
	sun.rotation_degrees = Vector3(-40, 30, 0)
	_viewport.add_child(sun)
	var camera: Camera3D = Camera3D.new()
	var box: AABB = made.get_aabb()
	camera.fov = 40.0
	_viewport.add_child(camera)
	camera.position = at + box.get_center() + Vector3(0, 0, box.size.length() * 1.4)
	camera.make_current()


func _picture() -> Image:
	await RenderingServer.frame_post_draw
	await RenderingServer.frame_post_draw
	return _viewport.get_texture().get_image()


# The mean difference of a channel, over the pixels where either shows the tree.
func _difference(a: Image, b: Image) -> float:
	var sum: float = 0.0
	var count: int = 0
	for y: int in a.get_height():
		for x: int in a.get_width():
			var one: Color = a.get_pixel(x, y)
			var other: Color = b.get_pixel(x, y)
			if one.b < one.g + 0.15 or other.b < other.g + 0.15:
				sum += absf(one.r - other.r) + absf(one.g - other.g) + absf(one.b - other.b)
				count += 1
	check(count > 500, "There is no tree in the pictures.")
	return sum / (3.0 * maxi(count, 1))


func _baked(
	made: TreeReconstruction,
	wind: bool,
	at: Vector3,
	form: TreeBaker.Form = TreeBaker.Form.JOINED,
) -> Node3D:
	var baker: TreeBaker = TreeBaker.new()
	baker.levels = 1
	baker.form = form
	baker.wind = wind
	var root: Node3D = baker.bake(made).instantiate()
	root.position = at
	_viewport.add_child(root)
	return root


func test_a_baked_tree_looks_the_same() -> void:
	var made: TreeReconstruction = grown_tree(2)
	made.leaf_rule = LeafRule.from_preset("oak")
	made.leaf_rule.season = 0.7
	await _stage(made, Vector3.ZERO)
	var instance: TreeInstance3D = TreeInstance3D.new()
	instance.lod = 0
	instance.reconstruction = made
	instance.wind = false
	_viewport.add_child(instance)
	while instance.is_rebuilding():
		await tree.process_frame
	var live: Image = await _picture()
	instance.visible = false
	var empty: Image = await _picture()
	check(_difference(live, empty) > 0.1, "The picture without a tree is the same.")
	for form: TreeBaker.Form in [TreeBaker.Form.JOINED, TreeBaker.Form.MULTIMESH]:
		var shown: Node3D = _baked(made, false, Vector3.ZERO, form)
		var difference: float = _difference(live, await _picture())
		check(difference < 0.02, "A pixel of form %d differs by %.4f." % [form, difference])
		shown.free()
	_viewport.free()


func test_the_wind_moves_a_baked_tree_wherever_it_is() -> void:
	var made: TreeReconstruction = grown_tree(2)
	var away: Vector3 = Vector3(500.0, 40.0, -300.0)
	await _stage(made, away)
	for form: TreeBaker.Form in [TreeBaker.Form.JOINED, TreeBaker.Form.MULTIMESH]:
		var still: Node3D = _baked(made, false, away, form)
		var calm: Image = await _picture()
		still.free()
		var moved: Node3D = _baked(made, true, away, form)
		var first: Image = await _picture()
		await tree.create_timer(0.4).timeout
		check(
			_difference(first, await _picture()) > 0.005, "The wind does not move form %d." % form
		)
		check(_difference(first, calm) < 0.25, "The wind tears form %d apart." % form)
		moved.free()
	_viewport.free()
