extends "./picture_suite.gd"
## A baked tree looks like the one it was baked of, in the renderer that this run uses.

const SIZE: Vector2i = Vector2i(320, 320)


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
	_open_stage(SIZE)
	_look_at_all(made)
	var instance: TreeInstance3D = await _show_tree(made, false)
	var live: Image = await _picture()
	instance.visible = false
	var empty: Image = await _picture()
	check(_summary(live)[0] > 0.005, "There is no tree in the picture.")
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
	_open_stage(SIZE)
	_look_at_all(made, away)
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
		var wanted: Vector2 = _brightness(await _picture())
		baked.visible = false
		model.visible = true
		var given: Vector2 = _brightness(await _picture())
		check(wanted.x > 0.05 and wanted.y > 0.05, "There is no tree in the picture.")
		for half: int in 2:
			check(
				given[half] > 0.6 * wanted[half] and given[half] < 1.7 * wanted[half],
				(
					"From height %.1f half %d has %.3f of light, the tree %.3f."
					% [height, half, given[half], wanted[half]]
				)
			)
	_viewport.free()


# How bright the upper and the lower half of what is shown of the tree are.
static func _brightness(picture: Image) -> Vector2:
	var rows: PackedInt32Array = []
	var light: PackedFloat32Array = []
	for y: int in picture.get_height():
		for x: int in picture.get_width():
			var pixel: Color = picture.get_pixel(x, y)
			if _shows_tree(pixel):
				rows.append(y)
				light.append(pixel.get_luminance())
	var sums: Vector2 = Vector2.ZERO
	@warning_ignore("integer_division")
	var half: int = rows.size() / 2
	for i: int in rows.size():
		# They come from top to bottom.
		sums[0 if i < half else 1] += light[i]
	return sums / maxf(half, 1.0)
