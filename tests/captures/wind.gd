extends SceneTree
## Draws the pictures of docs/wind.md: a tree in calm air, a breeze and a gale, and what its shaders
## read. Also to look at bark and leaves in wind in each renderer:
##
##     godot --path project --rendering-method mobile --script tests/captures/wind.gd -- SCAN FOLDER

const _SIZE: Vector2i = Vector2i(320, 380)
const _SUPERSAMPLING: int = 2
const _STRENGTHS: PackedFloat32Array = [0.0, 0.45, 1.2]
const _CHANNELS: Array[TreeWind.Channel] = [
	TreeWind.Channel.SWAY,
	TreeWind.Channel.ALONG,
	TreeWind.Channel.PHASE,
	TreeWind.Channel.OCCLUSION,
	TreeWind.Channel.LEVEL,
	TreeWind.Channel.PRIMARY_BRANCH,
	TreeWind.Channel.SECONDARY_BRANCH,
	TreeWind.Channel.MOTION,
]

var _viewport: SubViewport = SubViewport.new()
var _tree: TreeInstance3D = TreeInstance3D.new()
var _wind: TreeWind = TreeWind.new()


func _initialize() -> void:
	_draw.call_deferred()


func _draw() -> void:
	var folder: String = OS.get_cmdline_user_args()[1]
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	var shape: TreeReconstruction = reconstructor.reconstruct_file(OS.get_cmdline_user_args()[0])
	if shape == null:
		push_error(reconstructor.get_error_message())
		quit(1)
		return
	shape.leaf_preset = "birch"
	await _open_stage(shape)
	var pictures: Array[Image] = []
	for strength: float in _STRENGTHS:
		_wind.strength = strength
		pictures.append(await _picture())
	_save(pictures, 3, folder.path_join("strengths.jpg"))
	pictures.clear()
	_wind.strength = 0.7
	for channel: TreeWind.Channel in _CHANNELS:
		TreeWind.show_channel(_tree, channel)
		pictures.append(await _picture())
	_save(pictures, 4, folder.path_join("channels.jpg"))
	TreeWind.show_channel(_tree, TreeWind.Channel.NONE)
	_wind.strength = 1.0
	var camera: Camera3D = _viewport.get_camera_3d()
	var box: AABB = shape.get_aabb()
	camera.position = box.get_center() + Vector3(0.1, -0.05, 0.35) * box.size.y
	camera.look_at(box.get_center() + Vector3(0.0, 0.1, 0.0) * box.size.y)
	pictures = [await _picture()]
	camera.position = Vector3(0.2, 0.12, 0.22) * box.size.y
	camera.look_at(Vector3(0.0, 0.08, 0.0) * box.size.y)
	pictures.append(await _picture())
	_save(pictures, 2, folder.path_join("close.jpg"))
	# The world before the servers that it lives in.
	_viewport.free()
	await process_frame
	quit()


func _open_stage(shape: TreeReconstruction) -> void:
	_viewport.size = _SIZE * _SUPERSAMPLING
	_viewport.own_world_3d = true
	_viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	root.add_child(_viewport)
	_viewport.add_child((load("res://scenes/world.tscn") as PackedScene).instantiate())
	# So that two runs draw the same: a wind that stands.
	_wind.speed = 0.0
	_wind.direction = Vector2(1.0, 0.0)
	_viewport.add_child(_wind)
	RenderingServer.global_shader_parameter_set(
		&"tree_wind_shift", _find_gust(shape.get_aabb().size.y)
	)
	_tree.lod = 0
	_tree.reconstruction = shape
	_viewport.add_child(_tree)
	var camera: Camera3D = Camera3D.new()
	camera.fov = 30.0
	_viewport.add_child(camera)
	var box: AABB = shape.get_aabb()
	camera.position = Vector3(0.12, 0.3, 2.35) * box.size.y
	camera.look_at(Vector3(0.05, 0.5, 0.0) * box.size.y)
	camera.make_current()
	while _tree.is_rebuilding():
		await process_frame


# When a gust has bent a tree of this height most: after tree_wind.gdshaderinc.
func _find_gust(height: float) -> float:
	var best: float = 0.0
	var hardest: float = 0.0
	for i: int in 4000:
		var clock: float = 0.05 * i
		var front: float = 0.62 * clock
		var gust: float = 0.6 * sin(front + 0.6 * sin(front)) + 0.4 * sin(1.29 * clock + 1.7)
		var bend: float = (0.58 + 0.36 * gust) * (0.58 + 0.42 * sin(6.0 / sqrt(height) * clock))
		if bend > hardest:
			hardest = bend
			best = clock
	return best


func _picture() -> Image:
	for i: int in 4:
		await RenderingServer.frame_post_draw
	var picture: Image = _viewport.get_texture().get_image()
	picture.convert(Image.FORMAT_RGB8)
	picture.resize(_SIZE.x, _SIZE.y, Image.INTERPOLATE_LANCZOS)
	return picture


func _save(pictures: Array[Image], columns: int, path: String) -> void:
	@warning_ignore("integer_division")
	var rows: int = (pictures.size() + columns - 1) / columns
	var all: Image = Image.create_empty(columns * _SIZE.x, rows * _SIZE.y, false, Image.FORMAT_RGB8)
	for i: int in pictures.size():
		@warning_ignore("integer_division")
		var at: Vector2i = Vector2i(i % columns, i / columns) * _SIZE
		all.blit_rect(pictures[i], Rect2i(Vector2i.ZERO, _SIZE), at)
	all.save_jpg(path, 0.86)
