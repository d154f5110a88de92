extends SceneTree
## Films docs/wind/gust.webp: four seconds of a tree and of a row of ten while a gust comes over
## them, and tells how far the tree's top moves. Frames for make_captures.sh, at 12 a second:
##
##     godot --path project --script tests/captures/wind_film.gd -- SCAN LEAVES FOLDER

const Daylight: PackedScene = preload("res://addons/tree_reconstruction/presets/daylight.tscn")
const _TREE_SIZE: Vector2i = Vector2i(300, 340)
const _ROW_SIZE: Vector2i = Vector2i(600, 340)
const _RATE: float = 12.0
const _FRAMES: int = 48
const _TREES: int = 10
const _FILMED: float = 0.8
const _STRENGTHS: PackedFloat32Array = [0.4, 0.8, 1.2]
# Seconds: more than from one gust to the next.
const _MEASURED: float = 16.0
const _MEASURED_RATE: float = 2.5
# Of the tree's height: what is its top. Of a channel: less is no change.
const _TOP: float = 0.06
const _CHANGE: float = 0.12

var _viewport: SubViewport = SubViewport.new()
var _camera: Camera3D = Camera3D.new()
var _wind: TreeWind = TreeWind.new()
var _trees: Array[TreeInstance3D] = []
var _height: float


func _init() -> void:
	_film.call_deferred()


func _film() -> void:
	var given: PackedStringArray = OS.get_cmdline_user_args()
	var maker: TreeReconstructor = TreeReconstructor.new()
	var shape: TreeReconstruction = maker.reconstruct_file(given[0])
	if shape == null:
		printerr(maker.get_error_message())
		quit(1)
		return
	shape.leaf_preset = given[1]
	if DirAccess.make_dir_recursive_absolute(given[2]) != OK:
		printerr("The folder %s could not be made." % given[2])
		quit(1)
		return
	await _stage(shape)
	var start: float = _front()
	_wind.strength = _FILMED
	var near: Array[Image] = await _frames(start, false)
	var row: Array[Image] = await _frames(start, true)
	for i: int in _FRAMES:
		var all: Image = Image.create_empty(
			_TREE_SIZE.x + _ROW_SIZE.x, _ROW_SIZE.y, false, Image.FORMAT_RGB8
		)
		all.blit_rect(near[i], Rect2i(Vector2i.ZERO, _TREE_SIZE), Vector2i.ZERO)
		all.blit_rect(row[i], Rect2i(Vector2i.ZERO, _ROW_SIZE), Vector2i(_TREE_SIZE.x, 0))
		if all.save_png(given[2].path_join("%04d.png" % i)) != OK:
			printerr("The frame %d could not be written." % i)
			quit(1)
			return
	await _measure()
	_viewport.free()
	await process_frame
	quit()


# A row that the wind blows along, of one tree turned this way and that.
func _stage(shape: TreeReconstruction) -> void:
	_viewport.own_world_3d = true
	_viewport.render_target_update_mode = SubViewport.UPDATE_DISABLED
	root.add_child(_viewport)
	_viewport.add_child(Daylight.instantiate())
	_viewport.add_child(_camera)
	_wind.direction = Vector2(1.0, 0.0)
	# So that its clock stands where it is put.
	_wind.speed = 0.0
	_viewport.add_child(_wind)
	_height = shape.get_aabb().end.y
	_viewport.add_child(_ground())
	TreeInstance3D.threaded = false
	for i: int in _TREES:
		var instance: TreeInstance3D = TreeInstance3D.new()
		instance.lod = 2
		instance.reconstruction = shape
		instance.position.x = 0.6 * _height * i
		instance.rotation.y = 2.4 * i
		_viewport.add_child(instance)
		_trees.append(instance)
	await process_frame
	await process_frame


# Bare: grass takes a software renderer far longer than trees do.
func _ground() -> MeshInstance3D:
	var plane: PlaneMesh = PlaneMesh.new()
	plane.size = Vector2(1000.0, 1000.0)
	var material: StandardMaterial3D = StandardMaterial3D.new()
	material.albedo_color = Color(0.28, 0.36, 0.16)
	plane.material = material
	var ground: MeshInstance3D = MeshInstance3D.new()
	ground.mesh = plane
	return ground


func _see(row: bool) -> void:
	for i: int in _TREES:
		_trees[i].visible = row or i == 0
		_trees[i].lod = 2 if row else 1
	_viewport.size = _ROW_SIZE if row else _TREE_SIZE
	if row:
		_camera.fov = 36.0
		_camera.position = Vector3(-0.6, 0.4, 1.9) * _height
		_camera.look_at(Vector3(1.3, 0.5, 0.0) * _height)
	else:
		_camera.fov = 30.0
		_camera.position = Vector3(0.0, 0.3, 2.2) * _height
		_camera.look_at(Vector3(0.0, 0.5, 0.0) * _height)


func _picture(clock: float) -> Image:
	RenderingServer.global_shader_parameter_set(&"tree_wind_shift", clock)
	_viewport.render_target_update_mode = SubViewport.UPDATE_ONCE
	await RenderingServer.frame_post_draw
	var picture: Image = _viewport.get_texture().get_image()
	picture.convert(Image.FORMAT_RGB8)
	return picture


func _frames(start: float, row: bool) -> Array[Image]:
	_see(row)
	for i: int in 3:
		await _picture(start)
	var frames: Array[Image] = []
	for i: int in _FRAMES:
		frames.append(await _picture(start + i / _RATE))
	return frames


# When a gust's front reaches the first tree: after tree_wind.gdshaderinc.
func _front() -> float:
	var best: float = 0.0
	var steepest: float = 0.0
	for i: int in 1000:
		var clock: float = 0.1 * i
		var rise: float = _gust(clock + 2.5) - _gust(clock + 0.5)
		if rise > steepest:
			steepest = rise
			best = clock
	return best


func _gust(clock: float) -> float:
	var front: float = 0.62 * clock
	return 0.6 * sin(front + 0.6 * sin(front)) + 0.4 * sin(1.29 * clock + 1.7)


# Prints how far the top goes to and fro, over the tree's height.
func _measure() -> void:
	_see(false)
	_trees[0].visible = false
	_wind.strength = 0.0
	for i: int in 3:
		await _picture(0.0)
	var empty: Image = await _picture(0.0)
	_trees[0].visible = true
	for strength: float in _STRENGTHS:
		_wind.strength = strength
		var places: PackedFloat32Array = []
		for i: int in int(_MEASURED * _MEASURED_RATE):
			places.append(_top_of(await _picture(i / _MEASURED_RATE), empty))
		# Of any four seconds, those in which it moves most.
		var most: float = 0.0
		var span: int = int(4.0 * _MEASURED_RATE)
		for i: int in places.size() - span:
			var part: Array = Array(places.slice(i, i + span))
			most = maxf(most, part.max() - part.min())
		var all: Array = Array(places)
		print(
			(
				"> strength %.1f: the top moves %.1f %% of the height within 4 s, %.1f %% in all"
				% [strength, 100.0 * most, 100.0 * (all.max() - all.min())]
			)
		)


# Where the top is, to the right, over the tree's height.
func _top_of(picture: Image, empty: Image) -> float:
	# At the tree's distance.
	var per_height: float = picture.get_height() / (2.0 * 2.2 * tan(deg_to_rad(0.5 * _camera.fov)))
	var first: int = -1
	var sum: float = 0.0
	var count: int = 0
	for y: int in picture.get_height():
		if first >= 0 and y > first + _TOP * per_height:
			break
		for x: int in picture.get_width():
			var one: Color = picture.get_pixel(x, y)
			var other: Color = empty.get_pixel(x, y)
			if absf(one.r - other.r) + absf(one.b - other.b) < _CHANGE:
				continue
			first = y if first < 0 else first
			sum += x
			count += 1
	return sum / maxi(count, 1) / per_height
