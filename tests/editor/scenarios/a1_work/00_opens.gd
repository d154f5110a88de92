@tool
extends "../../test_plugin/scenario.gd"
## A project with the addon in it is opened for the first time.


func run() -> void:
	await step("the addon is there after the first start")
	check(ClassDB.class_exists(&"TreeReconstruction"), "The native library did not load.")
	check(addon() != null, "The addon's plugin is not running.")
	await picture("first-start")

	await step("the editor is as large as its window")
	check_fits()
