@tool
extends "../../test_plugin/garden.gd"
## Files that are no scans: the user reads why, and the editor goes on.


func run() -> void:
	await step("a broken file says what is wrong, once")
	var path: String = OS.get_environment("TREE_EDITOR_TEST").path_join("broken.ply")
	var file: FileAccess = FileAccess.open(path, FileAccess.WRITE)
	file.store_string("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nend_header\n1\n")
	file.close()
	expect_error("broken.ply")
	expect_error("Error importing 'res://broken.ply'")
	await drop_file(path, "res://broken.ply")
	if not await until(func() -> bool: return has_seen("broken.ply"), "the error is said"):
		return
	await until(
		func() -> bool: return not EditorInterface.get_resource_filesystem().is_scanning(),
		"the editor has looked through the project"
	)
	var settings: ConfigFile = ConfigFile.new()
	settings.load("res://broken.ply.import")
	check_equal(settings.get_value("remap", "valid", true), false, "whether it was imported")
	await picture("broken-file")

	await step("the editor goes on, and doesn't try again")
	await user.go()
	await user.come()
	await user.frames(30)
	check(addon() != null, "The addon is gone.")

	await step("a file without points says so, too")
	path = OS.get_environment("TREE_EDITOR_TEST").path_join("empty.xyz")
	FileAccess.open(path, FileAccess.WRITE).close()
	expect_error("empty.xyz")
	await drop_file(path, "res://empty.xyz")
	await until(func() -> bool: return has_seen("empty.xyz"), "the error is said")
	await files_rest()
	DirAccess.remove_absolute("res://broken.ply")
	DirAccess.remove_absolute("res://empty.xyz")
	await user.go()
	await user.come()
	await until(func() -> bool: return file_item("res://empty.xyz") == null, "the file is gone")
