extends "./tools_suite.gd"
## What the tool Paint Bark shows of a lump that is dragged, drawn by the renderer.

const GrownBark := preload("./test_grown_bark.gd")
const PaintBark := preload("res://addons/tree_reconstruction/editor/tools/paint_bark.gd")


# The mean difference of two pictures, 0 to 1, within a rectangle.
static func _difference(a: Image, b: Image, within: Rect2i) -> float:
	var sum: float = 0.0
	for y: int in range(within.position.y, within.end.y):
		for x: int in range(within.position.x, within.end.x):
			sum += absf(a.get_pixel(x, y).get_luminance() - b.get_pixel(x, y).get_luminance())
	return sum / within.get_area()


func _picture() -> Image:
	for i: int in 4:
		await _frame()
	await RenderingServer.frame_post_draw
	return _viewport.get_texture().get_image()


func test_a_lump_that_is_dragged_is_drawn() -> void:
	_begin(GrownBark.stout(), &"paint_bark")
	_session.node.wind = false
	_viewport.own_world_3d = true
	_viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	var light: DirectionalLight3D = DirectionalLight3D.new()
	light.rotation = Vector3(-0.7, 0.9, 0.0)
	_viewport.add_child(light)
	while _session.node.is_building_levels():
		await _frame()
	var tool: PaintBark = _session.tool as PaintBark
	tool._on_grow_toggled(false)
	var before: Image = await _picture()
	var at: Vector2 = _session.picker.project_place(_camera, Vector3(0.04, 0.8, 0.0))
	_button(at, true)
	var held: Image = await _picture()
	var around: Rect2i = Rect2i(Vector2i(at) - Vector2i(15, 15), Vector2i(30, 30))
	check(_difference(before, held, around) > 0.05, "The lump is not seen.")
	var folder: String = OS.get_environment("PAINT_PICTURES")
	if not folder.is_empty():
		before.save_png(folder.path_join("before.png"))
		held.save_png(folder.path_join("held.png"))
	_key(KEY_ESCAPE)
	var after: Image = await _picture()
	check(_difference(before, after, around) < 0.002, "Something of it stays.")
	_end()


func test_the_mouth_of_a_hollow_that_is_dragged_is_drawn() -> void:
	_begin(GrownBark.stout(), &"paint_bark")
	_session.node.wind = false
	_viewport.own_world_3d = true
	_viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	var light: DirectionalLight3D = DirectionalLight3D.new()
	light.rotation = Vector3(-0.7, 0.9, 0.0)
	_viewport.add_child(light)
	while _session.node.is_building_levels():
		await _frame()
	var tool: PaintBark = _session.tool as PaintBark
	tool._on_grow_toggled(false)
	tool.set_setting(2, &"kind")
	var before: Image = await _picture()
	var at: Vector2 = _session.picker.project_place(_camera, Vector3(0.04, 0.8, 0.0))
	_button(at, true)
	var held: Image = await _picture()
	# The mouth is half as wide as the trunk: its middle is dark, the bark beside it stays.
	var middle: Rect2i = Rect2i(Vector2i(at) - Vector2i(4, 8), Vector2i(8, 16))
	check(_difference(before, held, middle) > 0.05, "The mouth is not seen.")
	var folder: String = OS.get_environment("PAINT_PICTURES")
	if not folder.is_empty():
		held.save_png(folder.path_join("mouth.png"))
	var started: int = Time.get_ticks_usec()
	for i: int in 20:
		_hover(at + Vector2(0.0, 8.0 + i), true)
		tool._update_preview()
	var each: float = (Time.get_ticks_usec() - started) / 20e3
	print("        %.2f ms per move" % each)
	_key(KEY_ESCAPE)
	var after: Image = await _picture()
	check(_difference(before, after, middle) < 0.002, "Something of it stays.")
	_end()
