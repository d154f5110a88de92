extends SceneTree
## Photographs a tree whose every branch is known, in a garden, as a walker with a phone would: into
## a folder of JPEGs, with the truth beside it. Needs a renderer:
##
##     godot --path project --script tests/photos/garden.gd -- TRUTH.txt FOLDER [--photos=40]
##         [--leafy] [--width=1600] [--seed=1] [--masks] [--leaf-tint=1.5,0.72,0.6]
##         [--marker=0.3] [--film[=180]]
##
## TRUTH.txt is a tree file (treerec synth writes one). FOLDER/photos gets the photos and
## FOLDER/cameras.json the cameras (metres, Z up, as the tree file has it; of each its axes to the
## right, down and ahead) and the focal length in pixels; with --masks, FOLDER/masks what is tree in
## each, white on black, whatever stands before it. --leaf-tint is what the oak's leaves are
## multiplied by, as colors are stored.
## With --marker, a printed marker whose black square is so many metres wide leans on a board near
## the tree's base.
## With --film, FOLDER/film/walk.mp4 is a phone's film of so many frames of one walk, by ffmpeg, and
## cameras.json has the camera in the middle of each frame's exposure, by its time in the film. The
## frames are those of a walk of a minute, played faster: their blur, shake and exposure are its.

# The long side of a picture by its short one: of photos and of films.
const SHAPE: float = 1.5
const FILM_SHAPE: float = 16.0 / 9.0
# Of the short side, in degrees: a phone held upright.
const FOV: float = 50.0
# Radial distortion of a phone's lens: r (1 + K r²) of the picture's half width.
const DISTORTION: float = -0.03
# How unlike each other the exposures are, in stops.
const STOPS: float = 0.25
# Of the sky behind a tree alone: no wood and no leaf has a hue near it.
const KEY: Color = Color(1.0, 0.0, 1.0)
# Pixels of a printed marker to a metre: 300 dpi.
const MARKER_PIXELS: float = 300.0 / 0.0254
# How much of a photo's height the tree takes.
const FILLING: float = 0.8
# Of a film: frames of a second, bits of a second, and of the walk seconds, what is walked (a
# little more than around), of one frame the seconds of exposure and in how many pieces it is drawn.
const RATE: int = 30
const BITS: String = "17M"
const SECONDS: float = 60.0
const WALKED: float = TAU * 1.04
const EXPOSED: float = 1.0 / 60.0
const PIECES: int = 4
# Where each of them is within a pixel: their mean has smooth edges, at a fifth of what MSAA costs.
const WITHIN: Array[Vector2] = [
	Vector2(-0.125, -0.375), Vector2(0.375, -0.125), Vector2(-0.375, 0.125), Vector2(0.125, 0.375)
]

const OAK_LEAF: String = "res://addons/tree_reconstruction/presets/oak_leaf.tres"

var _random: RandomNumberGenerator = RandomNumberGenerator.new()
var _scene: SubViewport = SubViewport.new()
var _lens: SubViewport = SubViewport.new()
var _material: ShaderMaterial = ShaderMaterial.new()
var _camera: Camera3D = Camera3D.new()
var _options: Dictionary[String, String] = {}
var _words: PackedStringArray = []
var _shape: float = SHAPE
# Of each way that a hand shakes, the three sines: amplitude, turns of a second, phase.
var _sines: Array[PackedVector3Array] = []


func _initialize() -> void:
	for word: String in OS.get_cmdline_user_args():
		if word.begins_with("--"):
			_options[word.trim_prefix("--").get_slice("=", 0)] = word.get_slice("=", 1)
		else:
			_words.append(word)
	if _words.size() != 2:
		printerr("A tree file and a folder are needed.")
		quit(2)
		return
	_photograph.call_deferred()


func _option(name: String, standard: int) -> int:
	return _options.get(name, str(standard)).to_int()


func _photograph() -> void:
	_random.seed = _option("seed", 1)
	var worker: TreeReconstructor = TreeReconstructor.new()
	var tree: TreeReconstruction = worker.import_skeleton(_words[0])
	if tree == null:
		printerr(worker.get_error_message())
		quit(1)
		return
	var filmed: bool = _options.has("film")
	_shape = FILM_SHAPE if filmed else SHAPE
	var width: int = _option("width", 1080 if filmed else 1600)
	_build(tree, Vector2i(width, roundi(width * _shape)))
	for frame: int in 30:
		await process_frame
	while (_scene.get_node(^"Tree") as TreeInstance3D).is_rebuilding():
		await process_frame
	var box: AABB = tree.get_aabb()
	var cameras: Array[Dictionary] = []
	if filmed:
		cameras = await _film(box)
	else:
		cameras = await _take_photos(box)
	if cameras.is_empty():
		quit(1)
		return
	var focal: float = width * 0.5 / tan(deg_to_rad(FOV) * 0.5)
	var scene: Dictionary = {
		"focal_pixels": focal, "width": width, "height": roundi(width * _shape), "cameras": cameras
	}
	if filmed:
		scene["frames_per_second"] = RATE
	var file: FileAccess = FileAccess.open(_words[1].path_join("cameras.json"), FileAccess.WRITE)
	file.store_string(JSON.stringify(scene, "\t"))
	file.close()
	quit(0)


func _take_photos(box: AABB) -> Array[Dictionary]:
	var folder: String = _words[1]
	DirAccess.make_dir_recursive_absolute(folder.path_join("photos"))
	var cameras: Array[Dictionary] = []
	var count: int = _option("photos", 40)
	for i: int in count:
		var at: Vector3 = _place(i, count, box)
		# A hand is not quite steady.
		var aim: Vector3 = box.get_center() + Vector3(0.0, -0.02 * box.size.y, 0.0)
		aim += _shake(0.02 * box.size.y)
		_camera.look_at_from_position(at, aim)
		_camera.rotate_object_local(Vector3.BACK, _random.randfn(0.0, deg_to_rad(1.5)))
		_material.set_shader_parameter(&"exposure", pow(2.0, _random.randf_range(-STOPS, STOPS)))
		# Leafy scenes take minutes to draw: once a photo.
		_scene.render_target_update_mode = SubViewport.UPDATE_ONCE
		# The second picture shows what the first viewport drew for this place.
		for frame: int in 3:
			await RenderingServer.frame_post_draw
		var name: String = "IMG_%04d.jpg" % (i + 101)
		_lens.get_texture().get_image().save_jpg(folder.path_join("photos").path_join(name), 0.92)
		if _options.has("masks"):
			await _save_mask(folder.path_join("masks"), name)
		cameras.append({"name": name, "centre": _z_up(at), "axes": _axes()})
		print("%d of %d" % [i + 1, count])
	return cameras


func _film(box: AABB) -> Array[Dictionary]:
	var folder: String = _words[1].path_join("film")
	var drawn: String = _words[1].path_join("drawn")
	DirAccess.make_dir_recursive_absolute(folder)
	DirAccess.make_dir_recursive_absolute(drawn)
	_add_sines()
	var cameras: Array[Dictionary] = []
	var count: int = maxi(_option("film", 0), 0)
	count = count if count > 0 else 180
	# The angle of one in the middle of the picture.
	var pixel: float = 2.0 * tan(deg_to_rad(FOV) * 0.5) / _scene.size.x
	var pieces: Array[ImageTexture] = []
	for i: int in count:
		var middle: float = SECONDS * i / count
		for k: int in PIECES:
			_hold(middle + EXPOSED * ((k + 0.5) / PIECES - 0.5), box)
			_camera.rotate_object_local(Vector3.UP, WITHIN[k].x * pixel)
			_camera.rotate_object_local(Vector3.RIGHT, WITHIN[k].y * pixel)
			_scene.render_target_update_mode = SubViewport.UPDATE_ONCE
			await RenderingServer.frame_post_draw
			var picture: Image = _scene.get_texture().get_image()
			if pieces.size() < PIECES:
				pieces.append(ImageTexture.create_from_image(picture))
			else:
				pieces[k].update(picture)
		_material.set_shader_parameter(&"pieces", pieces)
		var stops: float = STOPS * sin(TAU * 2.0 * i / count + _sines[0][0].z)
		_material.set_shader_parameter(&"exposure", pow(2.0, stops))
		_lens.render_target_update_mode = SubViewport.UPDATE_ONCE
		await RenderingServer.frame_post_draw
		_lens.get_texture().get_image().save_jpg(drawn.path_join("%04d.jpg" % i), 0.97)
		_hold(middle, box)
		var centre: Vector3 = _camera.global_position
		cameras.append({"time": float(i) / RATE, "centre": _z_up(centre), "axes": _axes()})
		print("%d of %d" % [i + 1, count])
	var said: Array = []
	var words: PackedStringArray = ["-y", "-hide_banner", "-framerate", str(RATE)]
	words.append_array(["-i", drawn.path_join("%04d.jpg"), "-c:v", "libx264"])
	words.append_array(["-b:v", BITS, "-pix_fmt", "yuv420p", folder.path_join("walk.mp4")])
	if OS.execute("ffmpeg", words, said, true) != 0:
		printerr("ffmpeg made no film:\n", "".join(said))
		return []
	return cameras


func _add_sines() -> void:
	# Metres aside, up and ahead; degrees to the side, up and rolled.
	for most: float in [0.05, 0.04, 0.25, 1.2, 1.0, 1.0]:
		var sines: PackedVector3Array = []
		for high: float in [0.15, 0.5, 1.6]:
			# The quicker, the smaller.
			var quick: float = high * _random.randf_range(0.6, 1.0)
			var size: float = most * 0.6 * sqrt(0.15 / high)
			sines.append(Vector3(size, quick, _random.randf_range(0.0, TAU)))
		_sines.append(sines)


# As at this second of the walk.
func _hold(second: float, box: AABB) -> void:
	var shaken: PackedFloat64Array = []
	for sines: PackedVector3Array in _sines:
		var sum: float = 0.0
		for sine: Vector3 in sines:
			sum += sine.x * sin(TAU * sine.y * second + sine.z)
		shaken.append(sum)
	var out: Vector3 = Vector3.RIGHT.rotated(Vector3.UP, WALKED * second / SECONDS)
	var at: Vector3 = out * (_away(box) + shaken[2]) + out.cross(Vector3.UP) * shaken[0]
	at.y = 1.6 + shaken[1]
	var aim: Vector3 = box.get_center() + Vector3(0.0, -0.02 * box.size.y, 0.0)
	_camera.look_at_from_position(at, aim)
	_camera.rotate_object_local(Vector3.UP, deg_to_rad(shaken[3]))
	_camera.rotate_object_local(Vector3.RIGHT, deg_to_rad(shaken[4]))
	_camera.rotate_object_local(Vector3.BACK, deg_to_rad(shaken[5]))


# The tree alone, before what no tree is like.
func _save_mask(folder: String, name: String) -> void:
	DirAccess.make_dir_recursive_absolute(folder)
	var air: Environment = (_scene.get_node(^"Air") as WorldEnvironment).environment
	var sky: Color = air.background_color
	_show_things(false)
	air.background_color = KEY
	_material.set_shader_parameter(&"exposure", 1.0)
	_scene.render_target_update_mode = SubViewport.UPDATE_ONCE
	for frame: int in 3:
		await RenderingServer.frame_post_draw
	var drawn: Image = _lens.get_texture().get_image()
	drawn.convert(Image.FORMAT_RGB8)
	var bytes: PackedByteArray = drawn.get_data()
	var mask: PackedByteArray = []
	mask.resize(drawn.get_width() * drawn.get_height())
	for i: int in mask.size():
		var purple: int = mini(bytes[3 * i], bytes[3 * i + 2]) - bytes[3 * i + 1]
		mask[i] = 0 if purple > 127 else 255
	var size: Vector2i = drawn.get_size()
	var picture: Image = Image.create_from_data(size.x, size.y, false, Image.FORMAT_L8, mask)
	picture.save_png(folder.path_join(name + ".png"))
	air.background_color = sky
	_show_things(true)


func _show_things(shown: bool) -> void:
	for node: Node in _scene.get_children():
		if node is MeshInstance3D and node is not TreeInstance3D:
			(node as MeshInstance3D).visible = shown


# Y up in the engine, Z up in the file.
func _z_up(v: Vector3) -> Array[float]:
	return [v.x, -v.z, v.y]


func _axes() -> Array[Array]:
	var turn: Basis = _camera.global_basis
	return [_z_up(turn.x), _z_up(-turn.y), _z_up(-turn.z)]


# On a walk round the tree: never quite as far away, never quite as high.
func _place(i: int, count: int, box: AABB) -> Vector3:
	var angle: float = TAU * (i + _random.randf_range(-0.2, 0.2)) / count
	var out: Vector3 = Vector3.RIGHT.rotated(Vector3.UP, angle)
	var at: Vector3 = out * _away(box) * _random.randf_range(0.95, 1.05)
	return at + Vector3.UP * (1.6 + _random.randf_range(-0.15, 0.15))


# From where all of the tree is in the picture.
func _away(box: AABB) -> float:
	var vertical: float = 2.0 * atan(tan(deg_to_rad(FOV) * 0.5) * _shape)
	return maxf(
		box.size.y / FILLING / (2.0 * tan(vertical * 0.5)),
		0.5 * maxf(box.size.x, box.size.z) / FILLING / tan(deg_to_rad(FOV) * 0.5)
	)


func _shake(most: float) -> Vector3:
	return Vector3(
		_random.randf_range(-most, most),
		_random.randf_range(-most, most),
		_random.randf_range(-most, most)
	)


func _build(tree: TreeReconstruction, size: Vector2i) -> void:
	_scene.size = size
	_scene.own_world_3d = true
	_scene.msaa_3d = Viewport.MSAA_DISABLED if _options.has("film") else Viewport.MSAA_4X
	_scene.render_target_update_mode = SubViewport.UPDATE_DISABLED
	root.add_child(_scene)
	_camera.fov = FOV
	_camera.keep_aspect = Camera3D.KEEP_WIDTH
	_camera.far = 300.0
	_scene.add_child(_camera)
	var leafy: bool = _options.has("leafy")
	var node: TreeInstance3D = TreeInstance3D.new()
	node.name = "Tree"
	node.lod = 0
	node.wind = leafy
	node.leaves = leafy
	tree.leaf_preset = "oak"
	node.reconstruction = tree
	if _options.has("leaf-tint"):
		var material: ShaderMaterial = load(OAK_LEAF).duplicate()
		var parts: PackedFloat64Array = _options["leaf-tint"].split_floats(",")
		material.set_shader_parameter(&"tint", Color(parts[0], parts[1], parts[2]))
		node.leaf_material = material
	_scene.add_child(node)
	_add_light()
	_add_ground()
	_add_things(tree.get_aabb())
	if _options.has("marker"):
		_add_marker(_options["marker"].to_float())
	_add_lens(size)


func _add_light() -> void:
	var world: WorldEnvironment = WorldEnvironment.new()
	world.name = "Air"
	world.environment = Environment.new()
	world.environment.background_mode = Environment.BG_COLOR
	# A grey day.
	world.environment.background_color = Color(0.78, 0.8, 0.83)
	world.environment.ambient_light_source = Environment.AMBIENT_SOURCE_COLOR
	world.environment.ambient_light_color = Color.WHITE
	world.environment.ambient_light_energy = 0.6
	_scene.add_child(world)
	var sun: DirectionalLight3D = DirectionalLight3D.new()
	sun.rotation_degrees = Vector3(-55, 30, 0)
	sun.light_energy = 0.7
	_scene.add_child(sun)


# What looks different everywhere, from near and from afar: two pictures whose tiles never fall
# together.
func _noise(low: Color, high: Color, scale: float) -> StandardMaterial3D:
	var material: StandardMaterial3D = StandardMaterial3D.new()
	material.albedo_texture = _noise_picture(low, high)
	material.detail_enabled = true
	material.detail_albedo = _noise_picture(Color(0.55, 0.55, 0.55), Color.WHITE)
	material.detail_blend_mode = BaseMaterial3D.BLEND_MODE_MUL
	material.detail_uv_layer = BaseMaterial3D.DETAIL_UV_2
	material.texture_filter = BaseMaterial3D.TEXTURE_FILTER_LINEAR_WITH_MIPMAPS_ANISOTROPIC
	if _options.has("film"):
		# Half the time of drawing.
		material.texture_filter = BaseMaterial3D.TEXTURE_FILTER_LINEAR_WITH_MIPMAPS
	material.roughness = 1.0
	material.uv1_triplanar = true
	material.uv1_world_triplanar = true
	material.uv1_scale = Vector3.ONE * scale
	material.uv2_triplanar = true
	material.uv2_world_triplanar = true
	material.uv2_scale = Vector3.ONE * scale * 0.2236
	return material


func _noise_picture(low: Color, high: Color) -> ImageTexture:
	var noise: FastNoiseLite = FastNoiseLite.new()
	noise.seed = _random.randi()
	noise.frequency = 0.02
	noise.fractal_octaves = 6
	noise.fractal_gain = 0.7
	var ramp: Gradient = Gradient.new()
	ramp.set_color(0, low)
	ramp.set_color(1, high)
	var picture: Image = noise.get_seamless_image(1024, 1024)
	var colored: Image = Image.create_empty(1024, 1024, false, Image.FORMAT_RGB8)
	for y: int in 1024:
		for x: int in 1024:
			colored.set_pixel(x, y, ramp.sample(picture.get_pixel(x, y).r))
	colored.generate_mipmaps()
	return ImageTexture.create_from_image(colored)


# The same stuff, lighter or darker and from another place.
func _other(material: StandardMaterial3D) -> StandardMaterial3D:
	var other: StandardMaterial3D = material.duplicate()
	other.uv1_offset = Vector3(_random.randf(), _random.randf(), _random.randf())
	other.uv2_offset = Vector3(_random.randf(), _random.randf(), _random.randf())
	other.albedo_color = Color.from_hsv(
		_random.randf(), _random.randf_range(0.0, 0.25), _random.randf_range(0.6, 1.0)
	)
	return other


func _add_box(at: Vector3, size: Vector3, material: Material, turn: float = 0.0) -> void:
	var box: MeshInstance3D = MeshInstance3D.new()
	var mesh: BoxMesh = BoxMesh.new()
	mesh.size = size
	box.mesh = mesh
	box.material_override = material
	box.position = at
	box.rotation.y = turn
	_scene.add_child(box)


func _add_ground() -> void:
	_add_box(
		Vector3(0, -0.5, 0),
		Vector3(200, 1, 200),
		_noise(Color(0.12, 0.16, 0.05), Color(0.5, 0.52, 0.3), 0.35)
	)


func _add_things(box: AABB) -> void:
	var wood: StandardMaterial3D = _noise(Color(0.25, 0.17, 0.1), Color(0.62, 0.5, 0.36), 1.2)
	var stone: StandardMaterial3D = _noise(Color(0.3, 0.3, 0.3), Color(0.75, 0.73, 0.7), 0.6)
	var hedge: StandardMaterial3D = _noise(Color(0.05, 0.1, 0.03), Color(0.4, 0.5, 0.2), 0.5)
	# A bench beside the trunk.
	var aside: Vector3 = Vector3(1.4, 0, 0.9)
	for k: int in 4:
		_add_box(aside + Vector3(0, 0.45, 0.13 * k), Vector3(1.5, 0.04, 0.1), wood)
	for leg: float in [-0.65, 0.65]:
		_add_box(aside + Vector3(leg, 0.22, 0.2), Vector3(0.08, 0.44, 0.4), wood)
	# A fence, hedges and houses, farther away than anybody walks; no two alike, as none are.
	var around: float = 2.2 * maxf(box.size.y, box.size.x) + 6.0
	var angle: float = 0.0
	while angle < TAU - 0.05:
		var wide: float = _random.randf_range(0.05, 0.14)
		_add_box(
			_on_circle(angle + 0.5 * wide, around) + Vector3.UP * 0.6,
			Vector3(0.12, _random.randf_range(0.9, 1.5), around * wide * 0.9),
			_other(wood),
			-angle - 0.5 * wide
		)
		angle += wide
	for k: int in 26:
		var height: float = _random.randf_range(2.0, 7.0)
		_add_box(
			(
				_on_circle(_random.randf_range(0.0, TAU), around * _random.randf_range(1.15, 1.9))
				+ Vector3.UP * height * 0.5
			),
			Vector3(_random.randf_range(1, 6), height, _random.randf_range(1, 6)),
			_other(hedge if k % 2 == 0 else stone),
			_random.randf_range(0.0, TAU)
		)


# A page that leans back a little, as large as it is printed, on a board.
func _add_marker(side: float) -> void:
	var path: String = "user://garden_marker.png"
	var worker: TreeReconstructor = TreeReconstructor.new()
	if worker.save_marker(path, 7, side) != OK:
		printerr(worker.get_error_message())
		quit(1)
		return
	var picture: Image = Image.load_from_file(path)
	var metres: Vector2 = Vector2(picture.get_size()) / MARKER_PIXELS
	# Each mipmap of another size would leave out a row, and show the marker that much larger.
	picture.resize(4096, 4096, Image.INTERPOLATE_LANCZOS)
	picture.generate_mipmaps()
	var paper: StandardMaterial3D = StandardMaterial3D.new()
	paper.albedo_texture = ImageTexture.create_from_image(picture)
	paper.albedo_color = Color(0.9, 0.9, 0.88)
	paper.texture_filter = BaseMaterial3D.TEXTURE_FILTER_LINEAR_WITH_MIPMAPS_ANISOTROPIC
	paper.roughness = 1.0
	var page: QuadMesh = QuadMesh.new()
	page.size = metres
	page.material = paper
	var wood: BoxMesh = BoxMesh.new()
	wood.size = Vector3(page.size.x + 0.02, page.size.y + 0.02, 0.02)
	wood.material = _noise(Color(0.25, 0.17, 0.1), Color(0.62, 0.5, 0.36), 1.2)
	var board: MeshInstance3D = MeshInstance3D.new()
	board.mesh = wood
	var sheet: MeshInstance3D = MeshInstance3D.new()
	sheet.mesh = page
	sheet.position = Vector3(0, 0, 0.0105)
	board.add_child(sheet)
	var away: float = deg_to_rad(100.0)
	board.basis = Basis(Vector3.UP, away + PI * 0.5) * Basis(Vector3.RIGHT, deg_to_rad(-20.0))
	var out: Vector3 = Vector3.RIGHT.rotated(Vector3.UP, away)
	board.position = out * 0.9 + Vector3.UP * (0.5 * page.size.y + 0.02)
	_scene.add_child(board)


func _on_circle(angle: float, radius: float) -> Vector3:
	return Vector3(cos(angle), 0, sin(angle)) * radius


func _add_lens(size: Vector2i) -> void:
	_lens.size = size
	var filmed: bool = _options.has("film")
	_lens.render_target_update_mode = (
		SubViewport.UPDATE_DISABLED if filmed else SubViewport.UPDATE_ALWAYS
	)
	root.add_child(_lens)
	var beside: String = (get_script() as Script).resource_path.get_base_dir()
	_material.shader = load(beside.path_join("film_lens.gdshader" if filmed else "lens.gdshader"))
	if not filmed:
		_material.set_shader_parameter(&"scene", _scene.get_texture())
	_material.set_shader_parameter(&"distortion", DISTORTION)
	_material.set_shader_parameter(&"shape", Vector2(size))
	var glass: ColorRect = ColorRect.new()
	glass.size = size
	glass.material = _material
	_lens.add_child(glass)
