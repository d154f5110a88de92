@tool
extends "../../test_plugin/garden.gd"
## After Don't Save the files are as they were saved.

const LOCAL: String = "res://garden/elm_tree.res"
const UNSAVED: String = "res://garden/elm_tree_2.res"


func run() -> void:
	await step("the tree's file is what was saved")
	check_equal(
		FileAccess.get_sha256(LOCAL), FileAccess.get_file_as_string("res://saved.cfg"), "the file"
	)
	check(not FileAccess.file_exists(UNSAVED), "What was not saved has a file.")
