extends SceneTree
## How much an impostor differs from its tree, where it takes over from the last level:
##
##     ./dev bench --impostor
##
## It needs a window. The tree is that of the demo, or of a scene (--tree); --out FILE draws both
## side by side, larger than they are seen.

const Levels := preload("res://addons/tree_reconstruction/nodes/tree_levels.gd")
const _SCENE: String = "res://demo/result/tree.tscn"
# A picture of these many lines that are so high in degrees is what a player sees.
const _LINES: float = 1080.0
const _FIELD_OF_VIEW: float = 75.0
const _SKY: Color = Color(0.55, 0.68, 0.85)
const _PITCHES: PackedFloat32Array = [2.0, 25.0, 55.0]
const _YAWS: int = 8
const _DRAWN_YAWS: int = 4
const _DRAWN: int = 160

var _viewport: SubViewport
var _camera: Camera3D
var _live: TreeInstance3D
var _card: MeshInstance3D
var _impostor: TreeImpostor


func _initialize() -> void:
	_run.call_deferred()


func _run() -> void:
	var given: PackedStringArray = OS.get_cmdline_user_args()
	var path: String = _value(given, "--tree", _SCENE)
	var scene: PackedScene = load(path) as PackedScene
	if scene == null:
		printerr("There is no scene %s. './dev demo' makes it." % path)
		quit(1)
		return
	_live = scene.instantiate() as TreeInstance3D
	_live.wind = false
	_live.lod = 0
	var baker: TreeImpostorBaker = TreeImpostorBaker.new()
	baker.resolution = _value(given, "--resolution", str(baker.resolution)).to_int()
	baker.views = _value(given, "--views", str(baker.views)).to_int()
	var started: int = Time.get_ticks_msec()
	_impostor = await baker.bake(_live.reconstruction)
	if _impostor == null:
		printerr(baker.get_error_message())
		quit(1)
		return
	var took: float = (Time.get_ticks_msec() - started) / 1000.0
	await _make_stage()
	print(
		(
			"renderer %s, %d views of %d pixels, baked in %.1f s, %.1f MB of textures"
			% [
				RenderingServer.get_current_rendering_method(),
				baker.views * baker.views,
				baker.resolution / baker.views,
				took,
				_texture_bytes() / 1e6
			]
		)
	)
	var height: float = _impostor.height
	for distance: float in Levels.distances(height, Levels.COUNT + 1).slice(2):
		await _measure(distance)
	var out: String = _value(given, "--out", "")
	if not out.is_empty():
		await _draw(out, 8.0 * height)
	_viewport.free()
	quit()


static func _value(given: PackedStringArray, name: String, otherwise: String) -> String:
	var at: int = given.find(name)
	return given[at + 1] if at >= 0 and at + 1 < given.size() else otherwise


func _make_stage() -> void:
	_viewport = SubViewport.new()
	_viewport.own_world_3d = true
	_viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	_viewport.mesh_lod_threshold = 0.0
	root.add_child(_viewport)
	var world: WorldEnvironment = WorldEnvironment.new()
	world.environment = Environment.new()
	world.environment.background_mode = Environment.BG_COLOR
	world.environment.background_color = _SKY
	world.environment.ambient_light_source = Environment.AMBIENT_SOURCE_COLOR
	world.environment.ambient_light_color = Color(0.8, 0.86, 0.95)
	world.environment.ambient_light_energy = 0.4
	_viewport.add_child(world)
	var sun: DirectionalLight3D = DirectionalLight3D.new()
	sun.rotation_degrees = Vector3(-45.0, 40.0, 0.0)
	_viewport.add_child(sun)
	_viewport.add_child(_live)
	while _live.is_rebuilding():
		await process_frame
	_card = MeshInstance3D.new()
	_card.mesh = _impostor.get_mesh()
	_viewport.add_child(_card)
	var server: Object = RenderingServer
	server.instance_geometry_set_shader_parameter(_card.get_instance(), &"tree_wind", 0.0)
	_camera = Camera3D.new()
	_viewport.add_child(_camera)
	_camera.make_current()


func _look(distance: float, pitch: float, yaw: float, degrees: float, size: int) -> void:
	_viewport.size = Vector2i(size, size)
	var axes: Basis = Basis.from_euler(Vector3(deg_to_rad(-pitch), deg_to_rad(yaw), 0.0))
	_camera.transform = Transform3D(axes, _impostor.box.get_center() + axes.z * distance)
	_camera.fov = degrees
	_camera.near = 0.1 * distance
	_camera.far = 2.0 * distance


# The tree, its impostor, and neither.
func _pictures() -> Array[Image]:
	var taken: Array[Image] = []
	for shown: int in 3:
		_live.visible = shown == 0
		_card.visible = shown == 1
		await RenderingServer.frame_post_draw
		await RenderingServer.frame_post_draw
		var picture: Image = _viewport.get_texture().get_image()
		picture.convert(Image.FORMAT_RGBA8)
		taken.append(picture)
	return taken


# As many pixels as a player sees of it, no more.
func _measure(distance: float) -> void:
	var reach: float = 0.55 * _impostor.box.size.length()
	var line: float = 2.0 * tan(deg_to_rad(0.5 * _FIELD_OF_VIEW)) / _LINES
	var size: int = ceili(2.0 * reach / distance / line)
	var degrees: float = rad_to_deg(2.0 * atan(0.5 * size * line))
	for pitch: float in _PITCHES:
		var sums: PackedFloat64Array = [0.0, 0.0, 0.0, 0.0, 0.0]
		for i: int in _YAWS:
			_look(distance, pitch, 360.0 * (i + 0.37) / _YAWS, degrees, size)
			var taken: Array[Image] = await _pictures()
			var found: PackedFloat64Array = _compared(taken)
			for k: int in sums.size():
				sums[k] += found[k] / _YAWS
		print(
			(
				(
					"%5.0f m, %2.0f degrees up: %5.0f pixels, area %+5.1f %%, outline %4.1f %%, "
					% [distance, pitch, sums[0], 100.0 * sums[1], 100.0 * sums[2]]
				)
				+ ("a pixel differs by %.3f, the mean color by %.3f (of 1)" % [sums[3], sums[4]])
			)
		)


# The tree's pixels; how much more the impostor has, and what only one of them has, as shares of
# them; the mean difference of a channel; and that of the mean colors.
static func _compared(taken: Array[Image]) -> PackedFloat64Array:
	var area: PackedFloat64Array = [0.0, 0.0]
	var colors: PackedColorArray = [Color(0.0, 0.0, 0.0), Color(0.0, 0.0, 0.0)]
	var different: float = 0.0
	var either: float = 0.0
	var sum: float = 0.0
	for y: int in taken[0].get_height():
		for x: int in taken[0].get_width():
			var empty: Color = taken[2].get_pixel(x, y)
			var pixels: PackedColorArray = [taken[0].get_pixel(x, y), taken[1].get_pixel(x, y)]
			var there: PackedByteArray = [0, 0]
			for k: int in 2:
				if _apart(pixels[k], empty) > 0.03:
					there[k] = 1
					area[k] += 1.0
					colors[k] += pixels[k]
			different += 1.0 if there[0] != there[1] else 0.0
			if there[0] + there[1] > 0:
				either += 1.0
				sum += _apart(pixels[0], pixels[1])
	area[0] = maxf(area[0], 1.0)
	return PackedFloat64Array(
		[
			area[0],
			area[1] / area[0] - 1.0,
			different / area[0],
			sum / maxf(either, 1.0),
			_apart(colors[0] / area[0], colors[1] / maxf(area[1], 1.0))
		]
	)


static func _apart(one: Color, other: Color) -> float:
	return (absf(one.r - other.r) + absf(one.g - other.g) + absf(one.b - other.b)) / 3.0


func _texture_bytes() -> int:
	var bytes: int = 0
	for name: StringName in [&"albedo_texture", &"normal_texture", &"depth_texture"]:
		var texture: Texture2D = _impostor.material.get_shader_parameter(name)
		bytes += texture.get_image().get_data_size()
	return bytes


func _draw(path: String, distance: float) -> void:
	var sheet: Image = Image.create_empty(
		2 * _DRAWN_YAWS * _DRAWN, _PITCHES.size() * _DRAWN, false, Image.FORMAT_RGBA8
	)
	var reach: float = 0.42 * _impostor.box.size.length()
	var degrees: float = rad_to_deg(2.0 * atan(reach / distance))
	for row: int in _PITCHES.size():
		for column: int in _DRAWN_YAWS:
			_look(
				distance, _PITCHES[row], 360.0 * (column + 0.37) / _DRAWN_YAWS, degrees, 2 * _DRAWN
			)
			var taken: Array[Image] = await _pictures()
			for k: int in 2:
				taken[k].shrink_x2()
				sheet.blit_rect(
					taken[k],
					Rect2i(0, 0, _DRAWN, _DRAWN),
					Vector2i((2 * column + k) * _DRAWN, row * _DRAWN)
				)
	if path.get_extension() == "jpg":
		sheet.save_jpg(path, 0.88)
	else:
		sheet.save_png(path)
