@tool
extends "../../test_plugin/garden.gd"
## One tree in several nodes and scenes: its user is asked what an edit should change, and the tree
## is undone wherever it is seen.

const FIRST: String = "res://shared_first.tscn"
const SECOND: String = "res://shared_second.tscn"
const TREE: String = "res://shared_tree.res"


func run() -> void:
	var node: TreeInstance3D = await _duplicate()
	if node != null:
		await _two_scenes(node.reconstruction)


# Returns the node that was there first.
func _duplicate() -> TreeInstance3D:
	await step("editing a duplicate asks first, and makes it a tree of its own with Enter")
	var node: TreeInstance3D = await open_garden(FIRST, own_tree(TREE))
	if node == null:
		return null
	await save_scene()
	await click_node(node)
	await user.key("ctrl+d")
	var root: Node = EditorInterface.get_edited_scene_root()
	if not await until(func() -> bool: return root.get_child_count() == 2, "there are two nodes"):
		return null
	var copy: TreeInstance3D = root.get_child(1) as TreeInstance3D
	var shared: TreeReconstruction = node.reconstruction
	check_equal(copy.reconstruction, shared, "the copy's tree")
	var before: PackedByteArray = bytes(shared)
	await take_up(copy)
	await _press_delete(copy)
	if not await until(func() -> bool: return dialog("Shared") != null, "it asks"):
		return null
	check_equal(bytes(shared), before, "the tree while it asks")
	check(String(node.name) in dialog("Shared").dialog_text, "It does not say who shows it.")
	await picture("asks-about-duplicate")
	await user.key("Return")
	if not await until(
		func() -> bool:
			return copy.reconstruction != shared and bytes(copy.reconstruction) != before,
		"the copy has a tree of its own, which is edited"
	):
		return null
	check_equal(bytes(shared), before, "the tree of the original")
	var own: String = copy.reconstruction.resource_path
	check(not FileAccess.file_exists(own), "Its file is there before it was saved.")
	var edited: PackedByteArray = bytes(copy.reconstruction)
	await save_scene()
	check_equal(bytes(_on_disk(own)), edited, "the copy in its file")
	check_equal(bytes(_on_disk(TREE)), before, "the original in its file")
	check_uid(FIRST, own)
	check_uid(FIRST, TREE)
	await user.move(middle(view().get_parent() as Control))
	await user.key("ctrl+z")
	await until(func() -> bool: return bytes(copy.reconstruction) == before, "the edit is undone")
	await user.key("ctrl+z")
	await until(func() -> bool: return copy.reconstruction == shared, "both show one tree again")
	await user.key("ctrl+z")
	await until(func() -> bool: return root.get_child_count() == 1, "the copy is gone")
	await save_scene()
	return node


func _two_scenes(shared: TreeReconstruction) -> void:
	await step("a tree in two open scenes: it asks, both are marked, and Ctrl+Z works in both")
	var before: PackedByteArray = bytes(shared)
	var second: TreeInstance3D = await open_garden(SECOND, shared)
	if second == null:
		return
	check_equal(second.reconstruction, shared, "the tree in the second scene")
	await _press_delete(second)
	if not await until(func() -> bool: return dialog("Shared") != null, "it asks"):
		return
	await picture("asks-about-scenes")
	await user.key("Return")
	if not await until(func() -> bool: return bytes(shared) != before, "it is edited"):
		return
	var edited: PackedByteArray = bytes(shared)
	await until(func() -> bool: return is_marked(SECOND), "the second scene is marked")
	await until(func() -> bool: return is_marked(FIRST), "the first scene is marked")
	await picture("both-marked")
	await go_to_scene(FIRST)
	await user.move(middle(view().get_parent() as Control))
	await user.key("ctrl+z")
	await until(func() -> bool: return bytes(shared) == before, "it is undone in the first scene")
	await user.key("ctrl+shift+z")
	await until(func() -> bool: return bytes(shared) == edited, "it is done again")
	await go_to_scene(SECOND)
	await user.move(middle(view().get_parent() as Control))
	await user.key("ctrl+z")
	await until(func() -> bool: return bytes(shared) == before, "it is undone in the second scene")
	await user.key("ctrl+shift+z")
	await until(func() -> bool: return bytes(shared) == edited, "it is done again there")

	await step("it is asked once, and a scene that is saved saves the tree with the UID it had")
	var uid: int = ResourceLoader.get_resource_uid(TREE)
	await take_up(second)
	await _press_delete(second)
	await until(func() -> bool: return bytes(shared) != edited, "it is edited")
	check(dialog("Shared") == null, "It asks again.")
	edited = bytes(shared)
	await save_scene()
	check_equal(bytes(_on_disk(TREE)), edited, "the tree in its file")
	check_equal(ResourceLoader.get_resource_uid(TREE), uid, "the UID")
	check_uid(SECOND, TREE)
	check_uid(FIRST, TREE)
	await go_to_scene(FIRST)
	await save_scene()

	await step("what is not saved with the last scene that shows it is gone with it")
	await take_up(EditorInterface.get_edited_scene_root().get_node(^"Tree") as TreeInstance3D)
	await _press_delete(EditorInterface.get_edited_scene_root().get_node(^"Tree") as TreeInstance3D)
	await until(func() -> bool: return dialog("Shared") != null or bytes(shared) != edited, "a cut")
	check(bytes(shared) != edited, "It asks again.")
	second = null
	shared = null
	EditorInterface.close_scene()
	await until(func() -> bool: return scene_path() != FIRST, "the first is closed")
	await go_to_scene(SECOND)
	EditorInterface.close_scene()
	await until(func() -> bool: return scene_path() != SECOND, "the second is closed")
	await user.frames(10)
	check_equal(bytes(_on_disk(TREE)), edited, "the tree in its file")
	EditorInterface.open_scene_from_path(FIRST)
	if await until(func() -> bool: return scene_path() == FIRST, "it is open again"):
		var node: Node = EditorInterface.get_edited_scene_root().get_node(^"Tree")
		check_equal(
			bytes((node as TreeInstance3D).reconstruction), edited, "the tree that is shown"
		)


# A branch is selected with the mouse, and Delete is pressed.
func _press_delete(node: TreeInstance3D) -> void:
	session().call(&"select", PackedInt32Array())
	var branch: int = clear_nodes(node, large_branches(node.reconstruction))[0]
	await user.click(node_on_screen(node, branch))
	await until(func() -> bool: return session().get(&"selection").size() == 1, "it is selected")
	await user.key("Delete")


func _on_disk(path: String) -> TreeReconstruction:
	return (
		ResourceLoader.load(path, "", ResourceLoader.CACHE_MODE_IGNORE_DEEP) as TreeReconstruction
	)
