@tool
extends "../../test_plugin/garden.gd"
## The project is opened a second time: what was saved is there.


func run() -> void:
	await step("the edited tree is as it was saved")
	if not ResourceLoader.exists("res://edit.tscn"):
		await user.say("        Skipped: there is nothing saved to look at.")
		return
	if not await reopened():
		return
	EditorInterface.open_scene_from_path("res://edit.tscn")
	if not await until(func() -> bool: return scene_path() == "res://edit.tscn", "it is open"):
		return
	var node: TreeInstance3D = (
		EditorInterface.get_edited_scene_root().get_node(^"Tree") as TreeInstance3D
	)
	check(node.reconstruction.edit_log.contains("remove"), "Its log does not tell of the edit.")
	await take_up(node)
	check(node.get_triangle_count() > 1000, "It has no bark.")
	check(not is_unsaved(), "It has changes.")
	await picture("opened-again")
