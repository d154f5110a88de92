@tool
extends "../../test_plugin/garden.gd"
## Several scenes with trees: nothing of one is left in another, and copies are trees of their own.


func run() -> void:
	await step("the view of another scene has nothing of the tree in it")
	var empty: Node3D = Node3D.new()
	empty.name = "Empty"
	var packed: PackedScene = PackedScene.new()
	packed.pack(empty)
	empty.free()
	ResourceSaver.save(packed, "res://empty.tscn")
	EditorInterface.open_scene_from_path("res://empty.tscn")
	await until(func() -> bool: return scene_path() == "res://empty.tscn", "the scene is open")
	await user.frames(10)
	var drawn: int = drawn_objects()
	var node: TreeInstance3D = await open_garden(
		"res://first_of_two.tscn", own_tree("res://two.res")
	)
	if node == null:
		return
	await user.click(
		node_on_screen(node, clear_nodes(node, large_branches(node.reconstruction))[0])
	)
	await until(func() -> bool: return drawn_objects() > drawn + 1, "the tree is drawn")
	await go_to_scene("res://empty.tscn")
	check(session().get(&"node") == null, "A tree of another scene is still edited.")
	await until(func() -> bool: return drawn_objects() <= drawn, "nothing of the tree is drawn")
	await picture("another-scene")

	await step("back in its scene the tree is there again")
	await go_to_scene("res://first_of_two.tscn")
	node = EditorInterface.get_edited_scene_root().get_node(^"Tree") as TreeInstance3D
	if not check(node != null, "The tree is gone."):
		return
	await take_up(node)
	check_equal(session().get(&"node"), node, "the edited node")

	await step("Ctrl+D makes a second node of the same tree, and nothing else")
	# The key is the Scene dock's, which the click on the node has given the focus.
	await click_node(node)
	await user.key("ctrl+d")
	var root: Node = EditorInterface.get_edited_scene_root()
	if not await until(func() -> bool: return root.get_child_count() == 2, "there are two nodes"):
		return
	var copy: TreeInstance3D = root.get_child(1) as TreeInstance3D
	check_equal(copy.get_child_count(), 0, "children of the copy")
	check_equal(copy.reconstruction, node.reconstruction, "the copy's tree")
	await until(func() -> bool: return not copy.is_rebuilding(), "the copy is built")
	await picture("duplicated")
	await user.key("ctrl+z")
	await until(func() -> bool: return root.get_child_count() == 1, "the copy is gone")

	await step("it is copied into another scene")
	await click_node(node)
	await user.key("ctrl+c")
	await go_to_scene("res://empty.tscn")
	root = EditorInterface.get_edited_scene_root()
	await click_node(root)
	await user.key("ctrl+v")
	if not await until(func() -> bool: return root.get_child_count() == 1, "it is pasted"):
		return
	var pasted: TreeInstance3D = root.get_child(0) as TreeInstance3D
	check(pasted != null and pasted.reconstruction != null, "It is no tree.")
	await take_up(pasted)
	check(pasted.get_triangle_count() > 1000, "It has no bark.")
	await picture("pasted")
	await save_scene()
	await go_to_scene("res://first_of_two.tscn")
	await save_scene()

	await step("a scene that is closed leaves nothing behind")
	await click_node(EditorInterface.get_edited_scene_root().get_node(^"Tree"))
	EditorInterface.close_scene()
	await until(func() -> bool: return scene_path() != "res://first_of_two.tscn", "it is closed")
	await user.frames(5)
	var edited: Variant = session().get(&"node")
	check(edited == null or is_instance_valid(edited), "A node that is gone is still edited.")
