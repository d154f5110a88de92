@tool
extends "../../test_plugin/garden.gd"
## A tree of one's own is edited, undone, redone and saved.


func run() -> void:
	await step("a tree in a scene is edited when its node is selected")
	var node: TreeInstance3D = await open_garden("res://edit.tscn", own_tree("res://edit_tree.res"))
	if node == null:
		return
	check(session().get(&"node") == node, "The addon does not edit it.")
	await picture("tree-in-scene")
