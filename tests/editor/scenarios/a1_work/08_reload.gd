@tool
extends "../../test_plugin/garden.gd"
## What a tree goes through while a project is worked on: saved, loaded, its scripts changed, the
## addon switched off and on.

const PLUGIN: String = "tree_reconstruction"


func run() -> void:
	await step("a scene that is loaded again has the tree as it was saved")
	var node: TreeInstance3D = await open_garden(
		"res://reload.tscn", own_tree("res://reload_tree.res")
	)
	if node == null:
		return
	await _cut(node)
	var edited: PackedByteArray = bytes(node.reconstruction)
	await save_scene()
	var old: int = node.get_instance_id()
	node = null
	EditorInterface.reload_scene_from_path("res://reload.tscn")
	await until(func() -> bool: return not is_instance_id_valid(old), "the scene is loaded again")
	node = EditorInterface.get_edited_scene_root().get_node(^"Tree") as TreeInstance3D
	check_equal(bytes(node.reconstruction), edited, "the tree")
	await take_up(node)

	await step("a script of the addon that is changed and loaded again keeps working")
	await user.go()
	var path: String = "res://addons/tree_reconstruction/nodes/tree_instance_3d.gd"
	var text: String = FileAccess.get_file_as_string(path)
	var file: FileAccess = FileAccess.open(path, FileAccess.WRITE)
	file.store_string(text + "\n# Changed.\n")
	file.close()
	await user.come()
	var script: Script = load(path) as Script
	await until(
		func() -> bool: return script.source_code.ends_with("# Changed.\n"), "it is loaded again"
	)
	await user.frames(10)
	check(is_instance_valid(node) and node.reconstruction != null, "The node lost its tree.")
	await until(func() -> bool: return not node.is_rebuilding(), "the tree is built")
	await take_up(node)
	await _cut(node)
	await picture("after-script-reload")
	await save_scene()

	await step("the addon is switched off: nothing of it is left, and the tree still stands")
	var buttons: int = _count_controls()
	EditorInterface.set_plugin_enabled(PLUGIN, false)
	await until(func() -> bool: return addon() == null, "the addon is off")
	await user.frames(10)
	check(_count_controls() < buttons, "Its controls are still there.")
	check(node.get_triangle_count() > 1000, "The tree is gone.")
	await picture("addon-off")

	await step("switched on again it edits as before")
	EditorInterface.set_plugin_enabled(PLUGIN, true)
	await until(func() -> bool: return addon() != null, "the addon is on")
	await click_node(EditorInterface.get_edited_scene_root())
	await take_up(node)
	check_equal(session().get(&"node"), node, "the edited node")
	check_equal(_count_controls(), buttons, "the addon's controls")
	check_fits()
	await _cut(node)
	await user.key("ctrl+z")
	await user.frames(10)
	await picture("addon-on")
	await save_scene()


# Selects a branch with the mouse and deletes it.
func _cut(node: TreeInstance3D) -> void:
	var count: int = node.reconstruction.get_node_count()
	var branch: int = clear_nodes(node, large_branches(node.reconstruction))[0]
	await user.click(node_on_screen(node, branch))
	await until(func() -> bool: return session().get(&"selection").size() == 1, "it is selected")
	await user.key("Delete")
	await until(
		func() -> bool: return node.reconstruction.get_node_count() < count, "the branch is cut"
	)


# How many controls of the editor have a script of the addon, or belong to one that has.
func _count_controls() -> int:
	var count: int = 0
	for control: Node in EditorInterface.get_base_control().find_children(
		"*", "Control", true, false
	):
		var script: Script = control.get_script() as Script
		if script != null and script.resource_path.begins_with("res://addons/tree_reconstruction/"):
			count += 1
	return count
