extends "./suite.gd"
## Imported trees are never edited themselves: their first edit makes a copy in a file of its own.

const Session := preload("res://addons/tree_reconstruction/editor/session.gd")
const FOLDER: String = "res://.godot/tree_reconstruction_test"

var _undo: UndoRedo
var _session: Session
var _said: PackedStringArray = []


# A tree as the engine holds one that was imported: at its scan's path, with an .import beside.
func _edit_imported(made: TreeReconstruction) -> void:
	DirAccess.make_dir_recursive_absolute(FOLDER)
	_empty()
	for file: String in ["oak.ply", "oak.ply.import"]:
		FileAccess.open(FOLDER.path_join(file), FileAccess.WRITE).store_string("for a test")
	made.take_over_path(FOLDER.path_join("oak.ply"))
	made.provenance = {"source": FOLDER.path_join("oak.ply")}
	_undo = UndoRedo.new()
	var node: TreeInstance3D = TreeInstance3D.new()
	node.reconstruction = made
	tree.root.add_child(node)
	_session = Session.new(_undo)
	_session.said.connect(func(sentence: String, _kind: int) -> void: _said.append(sentence))
	_session.edit_node(node)


func _end() -> void:
	var node: TreeInstance3D = _session.node
	_session.shut_down()
	_undo.clear_history()
	_undo.free()
	_session = null
	node.free()
	_empty()


func _empty() -> void:
	for file: String in DirAccess.get_files_at(FOLDER):
		DirAccess.remove_absolute(FOLDER.path_join(file))


func _saved(path: String) -> TreeReconstruction:
	return (
		ResourceLoader.load(path, "", ResourceLoader.CACHE_MODE_IGNORE_DEEP) as TreeReconstruction
	)


func test_the_first_edit_makes_a_copy_beside_the_scan() -> void:
	var made: TreeReconstruction = grown_tree(3)
	var before: Dictionary = made.skeleton
	_edit_imported(made)
	_session.run("Prune", "prune_order order=1")
	var local: TreeReconstruction = _session.tree
	check(local != made, "The imported tree itself was edited.")
	check_equal(made.skeleton, before, "the imported skeleton")
	check_equal(local.resource_path, FOLDER.path_join("oak_tree.res"), "the file")
	check(not FileAccess.file_exists(local.resource_path), "It was written before it was saved.")
	check(_said.size() == 2 and "oak_tree.res" in _said[0], "Nobody said so: %s" % _said)
	check_equal(_undo.get_history_count(), 1, "steps")
	_undo.undo()
	check_equal(_session.tree, made, "the tree after undo")
	check_equal(local.skeleton, before, "the copy after undo")
	_undo.redo()
	check_equal(_session.tree, local, "the tree after redo")
	check(local.get_node_count() < made.get_node_count(), "It was not pruned again.")
	_session.update()
	_session.run("Prune", "prune_radius radius=0.005")
	check_equal(_session.tree, local, "the tree after a second edit")
	_end()


func test_what_changed_is_saved_with_the_scene() -> void:
	_edit_imported(grown_tree(3))
	_session.run("Prune", "prune_order order=1")
	var local: TreeReconstruction = _session.tree
	var path: String = local.resource_path
	check(not FileAccess.file_exists(path), "It was saved before anybody asked.")
	check_equal(_session.local_trees.get_unsaved(), PackedStringArray([path]), "unsaved files")
	check_equal(_session.local_trees.save(), PackedStringArray(), "failures")
	check_equal(_saved(path).skeleton, local.skeleton, "the saved skeleton")
	check_equal(_saved(path).edit_log, local.edit_log, "the saved log")
	check_equal(_session.local_trees.get_unsaved(), PackedStringArray(), "unsaved files then")
	var saved: Dictionary = local.skeleton
	_undo.undo()
	check_equal(_session.tree.resource_path, FOLDER.path_join("oak.ply"), "the tree after undo")
	check_equal(_saved(path).skeleton, saved, "the file after undo")
	_end()


func test_what_is_undone_before_it_is_saved_leaves_no_file() -> void:
	_edit_imported(grown_tree(3))
	_session.run("Prune", "prune_order order=1")
	_undo.undo()
	check_equal(_session.local_trees.get_unsaved(), PackedStringArray(), "unsaved files")
	check_equal(_session.local_trees.save(), PackedStringArray(), "failures")
	check_equal(DirAccess.get_files_at(FOLDER).size(), 2, "files")
	_undo.redo()
	check_equal(_session.local_trees.save(), PackedStringArray(), "failures")
	check_equal(_saved(_session.tree.resource_path).skeleton, _session.tree.skeleton, "the file")
	_end()


# Whatever is done, undone, done again and saved, in whatever order: the file has what was there
# when it was last saved, and nothing that was not.
func test_the_file_is_what_was_saved_last() -> void:
	for seed: int in 12:
		var random: RandomNumberGenerator = RandomNumberGenerator.new()
		random.seed = seed
		_edit_imported(grown_tree(seed))
		_session.run("Smooth", "smooth_radii rounds=1")
		var path: String = _session.tree.resource_path
		var wanted: Dictionary = {}
		for step: int in 25:
			match random.randi_range(0, 5):
				0:
					_session.run("Smooth", "smooth_radii rounds=%d" % random.randi_range(1, 3))
				1:
					var tips: PackedInt32Array = _session.tree.get_leaves()
					_session.run("Cut", "remove nodes=%d" % tips[random.randi() % tips.size()])
				2:
					_session.set_value(
						"Leaves", _session.tree, &"leaf_size", random.randf_range(0.02, 0.2)
					)
				3:
					_undo.undo()
				4:
					_undo.redo()
				5:
					# What was undone to the import before it was saved has no file.
					var has_file: bool = (
						_session.tree.resource_path == path or not wanted.is_empty()
					)
					check_equal(_session.local_trees.save(), PackedStringArray(), "failures")
					if has_file and ResourceLoader.has_cached(path):
						wanted = _state(load(path) as TreeReconstruction)
			_session.update()
			check_equal(FileAccess.file_exists(path), not wanted.is_empty(), "whether it is there")
			if not wanted.is_empty():
				check_equal(_state(_saved(path)), wanted, "the file after step %d" % step)
		_end()


func _state(of: TreeReconstruction) -> Dictionary:
	return {"wood": of.skeleton, "log": of.edit_log, "size": of.leaf_size}


func test_nothing_is_left_of_a_refused_or_cancelled_edit() -> void:
	var made: TreeReconstruction = grown_tree(3)
	_edit_imported(made)
	_session.run("Cut", "cut node=999999")
	check_equal(_session.tree, made, "the tree after a refusal")
	_session.run("Prune", "prune_radius radius=0")
	check_equal(_session.tree, made, "the tree after an edit that changed nothing")
	_session.begin_drag("Move")
	_session.drag("move nodes=%d by=1,0,0" % made.get_leaves()[0])
	_session.cancel_drag()
	check_equal(_session.tree, made, "the tree after a cancelled drag")
	check_equal(DirAccess.get_files_at(FOLDER).size(), 2, "files")
	check_equal(_undo.get_history_count(), 0, "steps")
	_end()


func test_no_file_is_overwritten() -> void:
	var made: TreeReconstruction = grown_tree(3)
	_edit_imported(made)
	var other: String = FOLDER.path_join("oak_tree.res")
	FileAccess.open(other, FileAccess.WRITE).store_string("the user's")
	_session.run("Prune", "prune_order order=1")
	check_equal(_session.tree.resource_path, FOLDER.path_join("oak_tree_2.res"), "the file")
	check_equal(FileAccess.get_file_as_string(other), "the user's", "the user's file")
	_end()


func test_a_value_makes_a_copy_too() -> void:
	var made: TreeReconstruction = grown_tree(3)
	_edit_imported(made)
	_session.set_value("Leaves", made, &"leaf_preset", "pine")
	check(_session.tree != made, "The imported tree itself was changed.")
	check_equal(_session.tree.leaf_preset, "pine", "the preset")
	check_equal(made.leaf_preset, "generic", "the imported preset")
	_undo.undo()
	check_equal(_session.tree, made, "the tree after undo")
	_end()


func test_a_rule_in_a_file_stays_as_it_is() -> void:
	var made: TreeReconstruction = grown_tree(3)
	_edit_imported(made)
	var preset: String = "res://addons/tree_reconstruction/presets/maple_rule.tres"
	var shared: LeafRule = load(preset) as LeafRule
	var size: float = shared.leaf_size
	_session.set_value("Leaf rule", made, &"leaf_rule", shared)
	_session.update()
	_session.set_value("Leaf size", _session.tree.leaf_rule, &"leaf_size", size * 2.0)
	check_equal(shared.leaf_size, size, "the preset's size")
	check_near(_session.tree.leaf_rule.leaf_size, size * 2.0, 1e-6, "the tree's size")
	_undo.undo()
	check_equal(_session.tree.leaf_rule, shared, "the rule after undo")
	_end()


func test_a_new_reconstruction_goes_into_the_file() -> void:
	_edit_imported(grown_tree(3))
	_session.run("Prune", "prune_order order=1")
	var tree_of_file: TreeReconstruction = _session.tree
	var path: String = tree_of_file.resource_path
	var before: Dictionary = tree_of_file.skeleton
	var other: TreeReconstruction = grown_tree(8)
	_session.replace_tree("Reconstruct again", other)
	_session.update()
	check_equal(_session.tree, tree_of_file, "the resource")
	_session.local_trees.save()
	check_equal(_saved(path).skeleton, other.skeleton, "the saved skeleton")
	_undo.undo()
	_session.update()
	_session.local_trees.save()
	check_equal(_saved(path).skeleton, before, "the saved skeleton after undo")
	_undo.redo()
	_session.update()
	_session.local_trees.save()
	check_equal(_saved(path).skeleton, other.skeleton, "the saved skeleton after redo")
	_end()


func test_a_new_reconstruction_of_an_imported_tree_is_a_copy() -> void:
	var made: TreeReconstruction = grown_tree(3)
	var before: Dictionary = made.skeleton
	_edit_imported(made)
	_session.replace_tree("Reconstruct again", grown_tree(8))
	check_equal(made.skeleton, before, "the imported skeleton")
	check_equal(_session.tree.resource_path, FOLDER.path_join("oak_tree.res"), "the file")
	_undo.undo()
	check_equal(_session.tree, made, "the tree after undo")
	_end()
