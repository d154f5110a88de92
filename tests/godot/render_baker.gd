extends "./picture_suite.gd"
## A baked tree looks like the one it was baked of, in the renderer that this run uses.

const SIZE: Vector2i = Vector2i(320, 320)
# Forms of baked trees, and whether they share files with others.
const WAYS: Array[Array] = [
	[TreeBaker.Form.JOINED, false],
	[TreeBaker.Form.MULTIMESH, false],
	[TreeBaker.Form.MULTIMESH, true],
]


func _baked(
	made: TreeReconstruction,
	wind: bool,
	at: Vector3,
	form: TreeBaker.Form = TreeBaker.Form.JOINED,
	shares: bool = false,
) -> Node3D:
	var baker: TreeBaker = TreeBaker.new()
	baker.levels = 1
	baker.form = form
	baker.wind = wind
	if shares:
		baker.shared_folder = folder.path_join("shared")
	var root: Node3D = baker.bake(made).instantiate()
	root.position = at
	_viewport.add_child(root)
	return root


func test_a_baked_tree_looks_the_same() -> void:
	var made: TreeReconstruction = grown_tree(2)
	made.leaf_rule = LeafRule.from_preset("oak")
	made.leaf_rule.season = 0.7
	_open_stage(SIZE)
	_look_at_all(made)
	var instance: TreeInstance3D = await _show_tree(made, false)
	var live: Image = await _picture()
	instance.visible = false
	var empty: Image = await _picture()
	check(_summary(live)[0] > 0.005, "There is no tree in the picture.")
	check(_difference(live, empty) > 0.1, "The picture without a tree is the same.")
	for way: Array in WAYS:
		var shown: Node3D = _baked(made, false, Vector3.ZERO, way[0], way[1])
		var difference: float = _difference(live, await _picture())
		check(difference < 0.02, "A pixel of form %s differs by %.4f." % [way, difference])
		shown.free()
	_viewport.free()


func test_the_wind_moves_a_baked_tree_wherever_it_is() -> void:
	var made: TreeReconstruction = grown_tree(2)
	var away: Vector3 = Vector3(500.0, 40.0, -300.0)
	_open_stage(SIZE)
	_look_at_all(made, away)
	for way: Array in WAYS:
		var still: Node3D = _baked(made, false, away, way[0], way[1])
		var calm: Image = await _picture()
		still.free()
		var moved: Node3D = _baked(made, true, away, way[0], way[1])
		var first: Image = await _picture()
		await tree.create_timer(0.4).timeout
		check(
			_difference(first, await _picture()) > 0.005, "The wind does not move form %s." % [way]
		)
		check(_difference(first, calm) < 0.25, "The wind tears form %s apart." % [way])
		moved.free()
	_viewport.free()


# A model has none of the addon's shaders. Where one looked up at its crown it was black.
func test_an_exported_model_is_as_bright_as_the_tree() -> void:
	var made: TreeReconstruction = grown_tree(2)
	made.leaf_rule = LeafRule.from_preset("oak")
	var path: String = folder.path_join("oak.glb")
	check_equal(TreeReconstructor.new().export_file(made, path, 2, true), OK, "exporting")
	check(FileAccess.file_exists(folder.path_join("oak_textures/leaf_albedo.png")), "No pictures.")
	var document: GLTFDocument = GLTFDocument.new()
	var state: GLTFState = GLTFState.new()
	check_equal(document.append_from_file(path, state), OK, "reading it")
	_open_stage(SIZE)
	# A high sun and little else: what is turned away from it is black.
	for node: Node in _viewport.get_children():
		if node is WorldEnvironment:
			(node as WorldEnvironment).environment.ambient_light_energy = 0.05
		elif node is DirectionalLight3D:
			(node as DirectionalLight3D).rotation_degrees = Vector3(-60, 30, 0)
	_look_at_all(made)
	var middle: Vector3 = made.get_aabb().get_center()
	var baked: Node3D = _baked(made, false, Vector3.ZERO)
	var model: Node3D = document.generate_scene(state)
	_viewport.add_child(model)
	for height: float in [-0.45, 0.0, 0.8]:
		_camera.position.y = middle.y + height * made.get_aabb().size.y
		_camera.look_at(middle)
		model.visible = false
		baked.visible = true
		var wanted: PackedFloat32Array = _lights(await _picture())
		baked.visible = false
		model.visible = true
		var given: PackedFloat32Array = _lights(await _picture())
		check(wanted.size() > 2000 and given.size() > 2000, "There is no tree in the picture.")
		# The top of the crown, and all of it.
		for share: float in [0.25, 1.0]:
			var part: PackedFloat32Array = wanted.slice(0, roundi(share * wanted.size()))
			var other: PackedFloat32Array = given.slice(0, roundi(share * given.size()))
			var mean: float = _mean(part)
			check(
				absf(_mean(other) / mean - 1.0) < 0.35,
				"From height %.1f it has %.3f of light, not %.3f." % [height, _mean(other), mean]
			)
			if share < 1.0:
				var dark: float = _below(other, 0.4 * mean)
				check(dark < 0.33, "From height %.1f %.2f of the top is dark." % [height, dark])
	_viewport.free()


# How bright the pixels are that show the tree, from top to bottom.
static func _lights(picture: Image) -> PackedFloat32Array:
	var lights: PackedFloat32Array = []
	for y: int in picture.get_height():
		for x: int in picture.get_width():
			var pixel: Color = picture.get_pixel(x, y)
			if _shows_tree(pixel):
				lights.append(pixel.get_luminance())
	return lights


static func _mean(values: PackedFloat32Array) -> float:
	var sum: float = 0.0
	for value: float in values:
		sum += value
	return sum / maxf(values.size(), 1.0)


# The share of values that are less.
static func _below(values: PackedFloat32Array, least: float) -> float:
	var count: int = 0
	for value: float in values:
		count += int(value < least)
	return count / maxf(values.size(), 1.0)
