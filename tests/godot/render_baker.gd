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
