extends "./dock_suite.gd"
## The dock "Tree": variants, baking and exporting.

const Variants := preload("res://addons/tree_reconstruction/editor/dock/variants.gd")
const Export := preload("res://addons/tree_reconstruction/editor/dock/export.gd")


func _exports() -> Export:
	return _dock.sections[&"export"] as Export


func test_variants_are_drawn_and_put_beside_the_tree() -> void:
	_begin(grown_tree(6))
	var shown: Variants = _dock.sections[&"variants"] as Variants
	shown.draw_pictures()
	await _finish()
	var first: Image = (shown.pictures[0].icon as ImageTexture).get_image()
	var second: Image = (shown.pictures[1].icon as ImageTexture).get_image()
	check(first.get_data() != second.get_data(), "Two variants look the same.")
	shown.more.pressed.emit()
	await _finish()
	var third: Image = (shown.pictures[0].icon as ImageTexture).get_image()
	check(first.get_data() != third.get_data(), "More shows the same ones.")
	var parent: Node = _session.node
	shown.pictures[0].pressed.emit()
	shown.pictures[1].pressed.emit()
	check_equal(parent.get_child_count(), 2, "variants in the scene")
	check_equal(_undo.get_history_count(), 2, "steps")
	var one: TreeInstance3D = parent.get_child(0)
	var other: TreeInstance3D = parent.get_child(1)
	check_equal(one.owner, parent, "the owner, without which it is not saved")
	check(one.position.distance_to(other.position) > 0.5, "They stand in one place.")
	check(one.reconstruction.skeleton != other.reconstruction.skeleton, "They are the same tree.")
	_undo.undo()
	check_equal(parent.get_child_count(), 1, "variants after undo")
	_undo.redo()
	check_equal(parent.get_child_count(), 2, "variants after redo")
	check_equal(other.owner, parent, "the owner after redo")
	_end()


func test_a_variant_that_was_undone_leaves_no_file() -> void:
	var made: TreeReconstruction = grown_tree(6)
	var beside: String = "res://.godot/tree_reconstruction_test"
	DirAccess.make_dir_recursive_absolute(beside)
	for file: String in DirAccess.get_files_at(beside):
		DirAccess.remove_absolute(beside.path_join(file))
	made.take_over_path(beside.path_join("oak.res"))
	_begin(made)
	var shown: Variants = _dock.sections[&"variants"] as Variants
	var path: String = beside.path_join("oak_variant_3.res")
	var placed: TreeInstance3D = shown.add_variant(3)
	var variant: TreeReconstruction = placed.reconstruction
	check_equal(variant.resource_path, path, "the variant's file")
	check(path in _session.local_trees.get_unsaved(), "Nobody knows that it is unsaved.")
	_undo.undo()
	check(path not in _session.local_trees.get_unsaved(), "What was undone is to be saved.")
	check_equal(_session.local_trees.save(), PackedStringArray(), "failures")
	check(not FileAccess.file_exists(path), "What was undone was saved.")
	# Another one of the same seed does not take its file, since it may come back.
	var again: TreeInstance3D = shown.add_variant(3)
	var second: String = beside.path_join("oak_variant_3_2.res")
	check_equal(again.reconstruction.resource_path, second, "the second one's file")
	_undo.undo()
	# In an array of a resource of a node it is used, too.
	var keeper: Node = Node.new()
	var inside: Resource = Resource.new()
	inside.set_meta(&"trees", {"one": [variant]})
	keeper.set_meta(&"kept", inside)
	tree.root.add_child(keeper)
	check_equal(_session.local_trees.save(), PackedStringArray(), "failures")
	check_equal(
		(
			(ResourceLoader.load(path, "", ResourceLoader.CACHE_MODE_IGNORE) as TreeReconstruction)
			. skeleton
		),
		variant.skeleton,
		"the saved variant"
	)
	check(not FileAccess.file_exists(second), "What was undone was saved.")
	keeper.free()
	_undo.redo()
	check_equal(_session.local_trees.save(), PackedStringArray(), "failures")
	check(FileAccess.file_exists(second), "What was done again was not saved.")
	_end()
	for file: String in DirAccess.get_files_at(beside):
		DirAccess.remove_absolute(beside.path_join(file))


func test_pictures_follow_edits_once_the_tree_is_calm() -> void:
	_begin(grown_tree(6))
	var shown: Variants = _dock.sections[&"variants"] as Variants
	shown.draw_pictures()
	await _finish()
	var before: Texture2D = shown.pictures[0].icon
	_session.run("Prune", "prune_order order=1")
	_frame()
	check(_session.jobs.get_running().is_empty(), "They are drawn at once.")
	shown._calm.timeout.emit()
	await _finish()
	check(shown.pictures[0].icon != before, "They are not drawn again.")
	shown._calm.timeout.emit()
	check(_session.jobs.get_running().is_empty(), "They are drawn without need.")
	_end()


func test_baking_writes_a_scene() -> void:
	_begin(grown_tree(6))
	_exports().levels.value = 2
	_exports().collision.button_pressed = false
	var path: String = folder.path_join("baked.scn")
	_exports().bake_to(path)
	await _finish()
	check(path in _said[-1], _said[-1])
	var root: Node = (load(path) as PackedScene).instantiate()
	check_equal(root.get_child_count(), 2, "levels")
	root.free()
	_exports().form.select(_exports().form.get_item_index(TreeBaker.Form.MULTIMESH))
	_exports().lightmap.button_pressed = true
	_exports().levels.value = 1
	path = folder.path_join("apart.scn")
	_exports().bake_to(path)
	await _finish()
	root = (load(path) as PackedScene).instantiate()
	var bark: MeshInstance3D = root.get_node("%s_LOD0" % root.name)
	check(bark.get_node("Leaves") is MultiMeshInstance3D, "The leaves are no multimesh.")
	var format: int = (bark.mesh as ArrayMesh).surface_get_format(0)
	check((format & Mesh.ARRAY_FORMAT_TEX_UV2) != 0, "There is no place for a lightmap.")
	root.free()
	_exports().form.select(_exports().form.get_item_index(TreeBaker.Form.JOINED))
	_exports().lightmap.button_pressed = false
	_exports().levels.value = 2
	_exports().bake_meshes_to(folder.path_join("oak.res"))
	await _finish()
	for level: int in 2:
		var mesh: Mesh = load(folder.path_join("oak_LOD%d.res" % level)) as Mesh
		check_equal(mesh.get_surface_count(), 2, "surfaces of level %d" % level)
	_end()


# Both threads would wait for each other if each loaded one of them at that moment.
func test_baking_loads_materials_before_it_leaves_the_main_thread() -> void:
	_begin(grown_tree(6))
	var presets: PackedStringArray = []
	for part: String in ["bark", "leaf"]:
		presets.append("res://addons/tree_reconstruction/presets/generic_%s.tres" % part)
	for path: String in presets:
		check(not ResourceLoader.has_cached(path), "%s was loaded before." % path)
	_exports().bake_to(folder.path_join("baked.scn"))
	for path: String in presets:
		check(ResourceLoader.has_cached(path), "%s is loaded by a worker." % path)
	await _finish()
	_end()


# A bake asks the renderer for what the main thread alone can answer.
func test_the_editor_can_be_closed_while_a_tree_is_baked() -> void:
	_begin(grown_tree(6))
	_exports().bake_to(folder.path_join("baked.scn"))
	# So that it is at what can't be cancelled.
	OS.delay_msec(500)
	_end()
	check(_session.jobs.get_running().is_empty(), "It goes on.")


func test_an_impostor_needs_a_window() -> void:
	_begin(grown_tree(6))
	var path: String = folder.path_join("oak.impostor.res")
	await _exports().impostor.bake_to(path)
	check("--headless" in _said[-1], _said[-1])
	check(not FileAccess.file_exists(path), "Something was written.")
	check(_session.jobs.get_running().is_empty(), "It goes on.")
	check(not _undo.has_undo(), "There is a step for it.")
	_end()


func test_every_format_is_written_or_says_why_not() -> void:
	_begin(_scanned())
	for extension: String in Export._FORMATS:
		var path: String = folder.path_join("tree." + extension)
		_exports().export_to(path)
		await _finish()
		check(FileAccess.file_exists(path), "%s: %s" % [extension, _said[-1]])
	var nowhere: String = folder.path_join("no/such/folder/tree.glb")
	_exports().export_to(nowhere)
	await _finish()
	check_sentence(_said[-1], "the failure")
	_end()


func test_the_cleaned_cloud_is_saved() -> void:
	_begin(grown_tree(6))
	check(_exports().cloud_button.disabled, "A tree of no scan has a cloud to save.")
	_end()
	_begin(_scanned())
	check(not _exports().cloud_button.disabled, "The cloud can't be saved.")
	var path: String = folder.path_join("clean.ply")
	_exports().save_cloud_to(path)
	var job: Session.Jobs.Job = _session.jobs.get_running()[0]
	check(job.measured and "clean.ply" in job.title, job.title)
	await _finish()
	check(FileAccess.file_exists(path), _said[-1])
	check(path in _said[-1], _said[-1])
	var scan: String = _session.tree.provenance["source"]
	_exports().save_cloud_to(scan)
	await _finish()
	check("the scan itself" in _said[-1], _said[-1])
	var cancelled: String = folder.path_join("cancelled.ply")
	_exports().save_cloud_to(cancelled)
	_session.jobs.cancel(_session.jobs.get_running()[0])
	await _finish()
	check(not FileAccess.file_exists(cancelled), "A cancelled one is there.")
	check(not _undo.has_undo(), "There is a step for it.")
	_end()


func test_edits_are_saved_as_text() -> void:
	_begin(grown_tree(6))
	check(_exports().log_button.disabled, "No edits can be saved.")
	_session.run("Prune", "prune_order order=1")
	_frame()
	check(not _exports().log_button.disabled, "Edits can't be saved.")
	var path: String = folder.path_join("edits.txt")
	_exports().save_log_to(path)
	check_equal(FileAccess.get_file_as_string(path), _session.tree.edit_log, "the file")
	_exports().save_log_to(folder.path_join("no/such/folder/edits.txt"))
	check_sentence(_said[-1], "the failure")
	_end()
