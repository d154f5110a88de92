extends SceneTree
## What a switch of levels of detail costs the eye, as ./dev bench --levels prints it: for each tree
## the triangles of its levels, and how much a picture changes where the next one takes over, drawn
## as a screen of 1080 lines and Godot's field of view would show it. Arguments after '--': where
## to write a picture of all, then pairs of a skeleton file or a scan, and a leaf preset ("" for the
## tree's own).

const Levels := preload("res://addons/tree_reconstruction/nodes/tree_levels.gd")
const LINES: float = 1080.0
const SCREEN: float = 1920.0 * 1080.0
const FIELD: float = 75.0
const NEAR: float = 1.45
const SIDE: int = 288
const SKY: Color = Color(0.62, 0.72, 0.86)
# A pixel that differs by less than this in all of its channels is not seen to change.
const SEEN: float = 0.1
# Pixels that the same level is moved by, to see how much of a change is that of thin things alone.
const ASIDE: float = 0.5

# Sides that a tree is looked at from.
const FROM: int = 8
const SUMS: Array[StringName] = [
	&"covered", &"after", &"outline", &"own_outline", &"light_before", &"light", &"changed"
]

var _viewport: SubViewport
var _camera: Camera3D
var _instance: TreeInstance3D
var _sheet: Image


func _init() -> void:
	_measure.call_deferred()


func _measure() -> void:
	var arguments: PackedStringArray = OS.get_cmdline_user_args()
	_stage()
	var rows: int = (arguments.size() - 1) / 2
	_sheet = Image.create_empty(4 * SIDE + 480, maxi(rows, 1) * SIDE, false, Image.FORMAT_RGB8)
	_sheet.fill(SKY)
	print(
		(
			"| tree | leaves | level | triangles | from, m | pixels of its height | changed pixels"
			+ " of the screen | of the tree | silhouette | of itself | cover | lightness |"
		)
	)
	print("|---|---|---|---|---|---|---|---|---|---|---|---|")
	for row: int in rows:
		await _measure_tree(arguments[1 + 2 * row], arguments[2 + 2 * row], row)
	if not arguments.is_empty() and not arguments[0].is_empty():
		_sheet.save_jpg(arguments[0], 0.9)
	quit()


func _stage() -> void:
	_viewport = SubViewport.new()
	_viewport.size = Vector2i(SIDE, SIDE)
	_viewport.own_world_3d = true
	_viewport.transparent_bg = true
	_viewport.msaa_3d = Viewport.MSAA_4X
	_viewport.render_target_update_mode = SubViewport.UPDATE_DISABLED
	root.add_child(_viewport)
	var world: WorldEnvironment = WorldEnvironment.new()
	world.environment = Environment.new()
	world.environment.ambient_light_source = Environment.AMBIENT_SOURCE_COLOR
	world.environment.ambient_light_color = Color(0.75, 0.85, 1.0)
	world.environment.ambient_light_energy = 0.5
	_viewport.add_child(world)
	var sun: DirectionalLight3D = DirectionalLight3D.new()
	sun.rotation_degrees = Vector3(-45, 40, 0)
	sun.shadow_enabled = true
	sun.directional_shadow_max_distance = 400.0
	_viewport.add_child(sun)
	_camera = Camera3D.new()
	_camera.far = 4000.0
	_viewport.add_child(_camera)
	_instance = TreeInstance3D.new()
	_instance.wind = false
	_viewport.add_child(_instance)
	TreeInstance3D.threaded = false


func _measure_tree(path: String, look: String, row: int) -> void:
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	var made: TreeReconstruction = reconstructor.import_skeleton(path)
	if made == null:
		made = reconstructor.reconstruct_file(path, {})
	if made == null:
		push_error("%s: %s" % [path, reconstructor.get_error_message()])
		return
	if not look.is_empty():
		made.leaf_preset = look
	_instance.lod = 0
	_instance.reconstruction = made
	await process_frame
	await process_frame
	var name: String = path.get_base_dir().get_file()
	var height: float = _instance.get_tree_height()
	var switches: PackedFloat32Array = Levels.distances(height, Levels.COUNT)
	var box: AABB = made.get_aabb()
	for level: int in Levels.COUNT:
		await _show_level(level)
		_blit(await _picture(box, NEAR * height, SIDE), Vector2i(level * SIDE, row * SIDE))
		var line: String = (
			"| %s | %s | %d | %d |" % [name, look, level, _instance.get_triangle_count()]
		)
		if level == 0:
			print(line + " | | | | | | | |")
			continue
		var away: float = switches[level - 1]
		# As large as the tree is there, with room for the wind.
		var side: int = ceili(1.2 * maxf(box.size.y, maxf(box.size.x, box.size.z)) / _pixel(away))
		await _show_level(level - 1)
		var before: Image = await _picture(box, away, side)
		await _show_level(level)
		var now: Array[Image] = await _pictures(box, away, side)
		await _show_level(0)
		var finest: Array[Image] = await _pictures(box, away, side)
		var moved: Array[Image] = await _pictures(box, away, side, ASIDE * _pixel(away))
		await _show_level(level)
		_blit_pair(before, now[0], level, row)
		print(
			(
				line
				+ (
					" %.0f | %.0f | %s |"
					% [away, height / _pixel(away), " | ".join(_compare(finest, now, moved))]
				)
			)
		)


func _show_level(level: int) -> void:
	_instance.lod = level
	await process_frame
	await process_frame


# Metres in one pixel of the screen so far away.
func _pixel(away: float) -> float:
	return 2.0 * away * tan(deg_to_rad(0.5 * FIELD)) / LINES


# From all sides.
func _pictures(box: AABB, away: float, side: int, aside: float = 0.0) -> Array[Image]:
	var pictures: Array[Image] = []
	for from: int in FROM:
		pictures.append(await _picture(box, away, side, aside, from))
	return pictures


func _picture(box: AABB, away: float, side: int, aside: float = 0.0, from: int = 0) -> Image:
	_viewport.size = Vector2i(side, side)
	_camera.fov = rad_to_deg(2.0 * atan(0.5 * side * _pixel(away) / away))
	if away < 2.0 * box.size.y:
		_camera.fov = 55.0
	var way: Vector3 = Vector3(0.5, 0.12, 1.0).normalized().rotated(Vector3.UP, TAU * from / FROM)
	_camera.position = box.get_center() + way * away
	_camera.look_at(box.get_center())
	_camera.h_offset = aside
	_camera.v_offset = aside
	_viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	await RenderingServer.frame_post_draw
	await RenderingServer.frame_post_draw
	_viewport.render_target_update_mode = SubViewport.UPDATE_DISABLED
	return _viewport.get_texture().get_image()


# Means over all sides, and of cover and lightness the side that differs most.
func _compare(before: Array[Image], after: Array[Image], moved: Array[Image]) -> PackedStringArray:
	var sums: Dictionary[StringName, float] = {}
	var covers: PackedFloat32Array = []
	var lights: PackedFloat32Array = []
	for from: int in FROM:
		var found: Dictionary[StringName, float] = _compare_side(
			before[from], after[from], moved[from]
		)
		for name: StringName in found:
			sums[name] = sums.get(name, 0.0) + found[name]
		covers.append(_more(found.after, found.covered))
		lights.append(_more(found.light, found.light_before))
	var covered: float = maxf(sums.covered, 1.0)
	return PackedStringArray(
		[
			"%.3f %%" % (100.0 * sums.changed / FROM / SCREEN),
			"%.0f %%" % (100.0 * sums.changed / covered),
			"%.0f %%" % (100.0 * sums.outline / covered),
			"%.0f %%" % (100.0 * sums.own_outline / covered),
			"%+.1f %% (%+.1f)" % [_more(sums.after, sums.covered), _farthest(covers)],
			"%+.1f %% (%+.1f)" % [_more(sums.light, sums.light_before), _farthest(lights)],
		]
	)


func _compare_side(before: Image, after: Image, moved: Image) -> Dictionary[StringName, float]:
	var sum: Dictionary[StringName, float] = {}
	for name: StringName in SUMS:
		sum[name] = 0.0
	for y: int in before.get_height():
		for x: int in before.get_width():
			var a: Color = before.get_pixel(x, y)
			var b: Color = after.get_pixel(x, y)
			var c: Color = moved.get_pixel(x, y)
			if a.a + b.a + c.a == 0.0:
				continue
			sum.covered += a.a
			sum.after += b.a
			sum.outline += absf(a.a - b.a)
			sum.own_outline += absf(a.a - c.a)
			var over: Color = _over_sky(a)
			var now: Color = _over_sky(b)
			sum.light_before += over.get_luminance() - SKY.get_luminance()
			sum.light += now.get_luminance() - SKY.get_luminance()
			var most: float = maxf(
				absf(over.r - now.r), maxf(absf(over.g - now.g), absf(over.b - now.b))
			)
			sum.changed += 1.0 if most > SEEN else 0.0
	return sum


# Percent.
func _more(now: float, before: float) -> float:
	return 100.0 * (now / before - 1.0) if absf(before) > 1e-6 else 0.0


func _farthest(values: PackedFloat32Array) -> float:
	var found: float = 0.0
	for value: float in values:
		found = value if absf(value) > absf(found) else found
	return found


# The renderer has multiplied the color by its alpha.
func _over_sky(color: Color) -> Color:
	return Color(
		color.r * color.a + SKY.r * (1.0 - color.a),
		color.g * color.a + SKY.g * (1.0 - color.a),
		color.b * color.a + SKY.b * (1.0 - color.a)
	)


func _blit(picture: Image, at: Vector2i) -> void:
	for y: int in mini(picture.get_height(), _sheet.get_height() - at.y):
		for x: int in mini(picture.get_width(), _sheet.get_width() - at.x):
			_sheet.set_pixel(at.x + x, at.y + y, _over_sky(picture.get_pixel(x, y)))


# The finer level and the next, as large as they are on the screen where they take turns.
func _blit_pair(before: Image, after: Image, level: int, row: int) -> void:
	var at: Vector2i = Vector2i(4 * SIDE, row * SIDE)
	if level == 2:
		at += Vector2i(0, SIDE / 2)
	elif level == 3:
		at += Vector2i(320, SIDE / 2)
	var width: int = mini(before.get_width(), 240 if level == 1 else 150 if level == 2 else 75)
	var cut: Rect2i = Rect2i(
		(before.get_width() - width) / 2, 0, width, mini(before.get_height(), SIDE / 2)
	)
	if level == 1:
		cut.position.y = (before.get_height() - cut.size.y) / 4
	_blit(before.get_region(cut), at)
	_blit(after.get_region(cut), at + Vector2i(width, 0))
