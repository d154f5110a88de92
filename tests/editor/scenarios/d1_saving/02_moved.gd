@tool
extends "../../test_plugin/garden.gd"
## A scan that is renamed or moved keeps the edits of its tree.

const FIRST: String = "res://moved/ash.ply"
const SECOND: String = "res://moved/rowan.ply"
const THIRD: String = "res://elsewhere/service.ply"
const LOCAL: String = "res://moved/ash_tree.res"
const SCENE: String = "res://moved/moved.tscn"


func run() -> void:
	await step("a scan that is renamed in the FileSystem dock takes its edited tree along")
	var node: TreeInstance3D = await open_edited(FIRST, SCENE)
	if node == null:
		return
	var local: TreeReconstruction = node.reconstruction
	var edited: PackedByteArray = bytes(local)
	var uid: int = ResourceLoader.get_resource_uid(LOCAL)
	await click_file(FIRST)
	await user.key("F2")
	await user.frames(10)
	await user.key("ctrl+a")
	await user.type(SECOND.get_file())
	await user.key("Return")
	if await imported(SECOND) == null:
		return
	await until(func() -> bool: return local.provenance["source"] == SECOND, "it follows its scan")
	check_equal(bytes(local), edited, "the tree")
	check(not is_unsaved(), "The scene has changes.")
	check_equal(_source_on_disk(), SECOND, "the scan in the tree's file")
	check_equal(ResourceLoader.get_resource_uid(LOCAL), uid, "the UID")
	check_uid(SCENE, LOCAL)

	await step("so does one that another program moves")
	await user.go()
	DirAccess.make_dir_recursive_absolute(THIRD.get_base_dir())
	DirAccess.rename_absolute(SECOND, THIRD)
	DirAccess.remove_absolute(SECOND + ".import")
	await user.come()
	if await imported(THIRD) == null:
		return
	await until(func() -> bool: return local.provenance["source"] == THIRD, "it follows its scan")
	check_equal(bytes(local), edited, "the tree")

	await step("its edits are done again on the next import")
	var settings: ConfigFile = ConfigFile.new()
	settings.load(THIRD + ".import")
	settings.set_value("params", "skeleton/spacing", 0.03)
	settings.save(THIRD + ".import")
	EditorInterface.get_resource_filesystem().reimport_files([THIRD])
	await until(func() -> bool: return bytes(local) != edited, "the new import is taken in")
	check("remove" in local.edit_log, "The edit is lost.")
	check_equal(_source_on_disk(), THIRD, "the scan in the tree's file")
	await save_scene()
	check_equal(ResourceLoader.get_resource_uid(LOCAL), uid, "the UID")


func _source_on_disk() -> String:
	var saved: TreeReconstruction = (
		ResourceLoader.load(LOCAL, "", ResourceLoader.CACHE_MODE_IGNORE) as TreeReconstruction
	)
	return saved.provenance["source"]
