@tool
extends "../../test_plugin/garden.gd"
## A tree is cut, the cut undone and done again, and saved.


func run() -> void:
	await step("Delete cuts the selected branch off")
	var node: TreeInstance3D = await open_garden("res://edit.tscn", own_tree("res://edit_tree.res"))
	if node == null:
		return
	var of: TreeReconstruction = node.reconstruction
	var before: PackedByteArray = bytes(of)
	var count: int = of.get_node_count()
	var branch: int = clear_nodes(node, large_branches(of))[0]
	await user.click(node_on_screen(node, branch))
	await until(func() -> bool: return session().get(&"selection").size() == 1, "it is selected")
	await picture("before-delete")
	await user.key("Delete")
	if not await until(func() -> bool: return of.get_node_count() < count, "the branch is cut"):
		return
	var after: PackedByteArray = bytes(of)
	check_equal(node.reconstruction, of, "the tree, which was the user's own")
	check(is_unsaved(), "The scene does not say that it has changes.")
	await until(func() -> bool: return not node.is_rebuilding(), "the tree is built")
	await picture("after-delete")

	await step("Ctrl+Z brings it back, Ctrl+Shift+Z takes it again")
	for i: int in 3:
		await user.key("ctrl+z")
		await until(func() -> bool: return bytes(of) == before, "the tree is as before")
		await user.key("ctrl+shift+z")
		await until(func() -> bool: return bytes(of) == after, "the tree is cut again")

	await step("Ctrl+S saves the tree's file with the scene")
	await save_scene()
	var saved: TreeReconstruction = (
		ResourceLoader.load("res://edit_tree.res", "", ResourceLoader.CACHE_MODE_IGNORE_DEEP)
		as TreeReconstruction
	)
	check_equal(bytes(saved), after, "the saved tree")
	check(
		FileAccess.get_file_as_string("res://edit.tscn").length() < 2000,
		"The scene's file holds more than the node."
	)

	await step("coming back to the editor loads nothing over what is not saved")
	branch = clear_nodes(node, large_branches(of))[0]
	await user.click(node_on_screen(node, branch))
	await until(func() -> bool: return session().get(&"selection").size() == 1, "it is selected")
	await user.key("Delete")
	await until(func() -> bool: return bytes(of) != after, "another branch is cut")
	var unsaved: PackedByteArray = bytes(of)
	await user.go()
	await user.come()
	await user.frames(90)
	check_equal(bytes(of), unsaved, "the tree after coming back")
	check_equal(session().get(&"local_trees").get_unsaved().size(), 1, "trees to save")
	await user.key("ctrl+z")
	await until(func() -> bool: return bytes(of) == after, "the tree is as saved")
	await save_scene()

	await step("a tree whose file another program changes is as its file, and not to be saved")
	# A second of the file's time must pass for the engine to see the difference.
	OS.delay_msec(1100)
	saved.seed += 1
	var other: String = OS.get_environment("TREE_EDITOR_TEST").path_join("other.res")
	ResourceSaver.save(saved, other)
	await user.go()
	await user.ask(["copy", other, ProjectSettings.globalize_path("res://edit_tree.res")])
	await user.come()
	await until(func() -> bool: return of.seed == saved.seed, "the file is loaded again")
	check_equal(session().get(&"local_trees").get_unsaved().size(), 0, "trees to save")
