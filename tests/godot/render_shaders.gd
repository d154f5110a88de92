extends "./picture_suite.gd"
## What needs a window: the shaders compile and look right in the renderer that this run uses.

const SIZE: Vector2i = Vector2i(320, 320)

var _instance: TreeInstance3D


func _stage(made: TreeReconstruction) -> void:
	_open_stage(SIZE, true)
	_look_at_all(made)
	_instance = await _show_tree(made)


func test_every_shader_compiles() -> void:
	await _stage(grown_tree(2))
	var checked: int = 0
	var folders: PackedStringArray = ["res://addons/tree_reconstruction/shaders"]
	# The preview is drawn in Compatibility alone.
	if RenderingServer.get_current_rendering_method() == "gl_compatibility":
		folders.append("res://demo")
	for folder_path: String in folders:
		for file: String in ResourceLoader.list_directory(folder_path):
			if file.get_extension() != "gdshader":
				continue
			var shader: Shader = load(folder_path.path_join(file))
			var material: ShaderMaterial = ShaderMaterial.new()
			material.shader = shader
			if shader.get_mode() == Shader.MODE_SPATIAL:
				_instance.bark_material = material
				_instance.leaf_material = material
				await _picture()
			checked += 1
	check(checked >= 2 * folders.size(), "Only %d shaders were found." % checked)
	_viewport.free()


func test_a_tree_is_bark_then_leaves() -> void:
	for preset: String in TreeReconstruction.get_leaf_preset_names():
		if preset == "none":
			continue
		var made: TreeReconstruction = grown_tree(2)
		made.leaf_preset = preset
		await _stage(made)
		_instance.wind = false
		var leafy: float = _summary(await _picture())[0]
		_instance.leaves = false
		while _instance.is_rebuilding():
			await tree.process_frame
		var bare: float = _summary(await _picture())[0]
		check(bare > 0.003, "%s: bark covers %.4f of the picture." % [preset, bare])
		check(leafy > bare * 1.5, "%s: leaves cover %.4f, bark %.4f." % [preset, leafy, bare])
		check(leafy < 0.8, "%s: the tree covers %.2f of the picture." % [preset, leafy])
		_viewport.free()


# How much redder than green the tree is.
func _redness(picture: Image) -> float:
	var sum: float = 0.0
	for y: int in range(0, picture.get_height(), 2):
		for x: int in range(0, picture.get_width(), 2):
			var color: Color = picture.get_pixel(x, y)
			sum += maxf(color.r - maxf(color.g, color.b), 0.0)
	return sum


func test_thin_wood_is_young_whatever_its_level() -> void:
	var made: TreeReconstruction = grown_tree(2)
	await _stage(made)
	_instance.wind = false
	_instance.leaves = false
	while _instance.is_rebuilding():
		await tree.process_frame
	var material: ShaderMaterial = ShaderMaterial.new()
	material.shader = load("res://addons/tree_reconstruction/shaders/bark.gdshader")
	material.set_shader_parameter(&"twig_color", Color(1.0, 0.0, 0.0, 1.0))
	_instance.bark_material = material
	var seen: Dictionary[float, float] = {}
	for radius: float in [0.003, 0.02, 0.1]:
		for level: float in [0.0, 6.0]:
			var arrays: Array = made.build_mesh_arrays()
			var radii: PackedFloat32Array = arrays[Mesh.ARRAY_CUSTOM1]
			radii.fill(radius)
			arrays[Mesh.ARRAY_CUSTOM1] = radii
			var pivots: PackedFloat32Array = arrays[Mesh.ARRAY_CUSTOM0]
			for i: int in range(3, pivots.size(), 4):
				pivots[i] = level
			arrays[Mesh.ARRAY_CUSTOM0] = pivots
			var bark: ArrayMesh = ArrayMesh.new()
			bark.add_surface_from_arrays(
				Mesh.PRIMITIVE_TRIANGLES, arrays, [], {}, TreeReconstruction.MESH_FLAGS
			)
			bark.surface_set_material(0, material)
			_instance.mesh = bark
			var red: float = _redness(await _picture())
			if level == 0.0:
				seen[radius] = red
			else:
				check_near(red, seen[radius], 0.01 + 0.05 * seen[radius], "the red of a high level")
	check(seen[0.003] > 5.0, "Twigs are not of their colour: %.2f." % seen[0.003])
	check(seen[0.02] < 0.9 * seen[0.003], "Wood of 2 cm is as young as a twig.")
	check(seen[0.1] < 0.2 * seen[0.02], "Thick wood looks like twigs: %s." % seen)
	_viewport.free()


func test_wind_moves_the_tree_and_can_be_stopped() -> void:
	await _stage(grown_tree(2))
	_instance.wind = false
	var still: Image = await _picture()
	for i: int in 5:
		await tree.process_frame
	check(_change(still, await _picture()) < 1.0, "It moves without wind.")
	_instance.wind = true
	var first: Image = await _picture()
	await tree.create_timer(0.4).timeout
	check(_change(first, await _picture()) > 80.0, "The wind does not move it.")
	_viewport.free()


func test_wind_follows_a_moved_tree() -> void:
	# The same tree, far from the origin: the wind must bend it by as little.
	await _stage(grown_tree(2))
	_instance.wind = false
	var still: float = _summary(await _picture())[0]
	var away: Vector3 = Vector3(500.0, 40.0, -300.0)
	_instance.position += away
	_camera.position += away
	_instance.wind = true
	var moved: float = _summary(await _picture())[0]
	check_near(moved, still, still * 0.25, "the tree's share of the picture")
	_viewport.free()
