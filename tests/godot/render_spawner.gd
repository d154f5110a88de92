extends "./picture_suite.gd"
## A forest in the renderer that this run uses: it is made anew without an error of the renderer's.


func test_a_forest_is_made_again_and_again() -> void:
	_open_stage(Vector2i(64, 64))
	_camera.position = Vector3(0.0, 2.0, 12.0)
	var forest: TreeVariantSpawner3D = TreeVariantSpawner3D.new()
	forest.source = grown_tree(3, 60)
	forest.variants = 2
	forest.levels = 2
	forest.region_size = Vector2(30.0, 30.0)
	_viewport.add_child(forest)
	await forest.finished
	check(_summary(await _picture())[0] > 0.002, "No tree is to be seen.")
	for i: int in 2:
		forest.seed += 1
		await forest.finished
		check(_summary(await _picture())[0] > 0.002, "No tree is to be seen any longer.")
	_viewport.free()
