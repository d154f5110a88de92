@tool
extends "../../test_plugin/garden.gd"
## The editor is closed while it reads, reconstructs and measures: run.sh presses Ctrl+Q right after
## this, and looks for a crash and for what leaked.


func run() -> void:
	await step("a scan begins to be imported and another to be measured")
	for i: int in 4:
		var path: String = ProjectSettings.globalize_path("res://late_%d.ply" % i)
		await user.ask(["copy", sample, path])
	if ResourceLoader.exists("res://edit.tscn") and await reopened():
		EditorInterface.open_scene_from_path("res://edit.tscn")
		await until(func() -> bool: return scene_path() == "res://edit.tscn", "it is open")
		await click_node(EditorInterface.get_edited_scene_root().get_node(^"Tree"))
		@warning_ignore("unsafe_method_access")
		session().scan.measure()
	EditorInterface.get_resource_filesystem().scan()
