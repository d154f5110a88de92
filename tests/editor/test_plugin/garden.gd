@tool
extends "./scenario.gd"
## Scenarios with a tree in them: a scan in the project, a scene with a tree, the view on it.

## The grown and scanned sample.
var sample: String = OS.get_environment("TREE_EDITOR_SAMPLE")


## A path of real scans, or empty where there are none here.
func real_scan(file: String) -> String:
	var folder: String = OS.get_environment("TREEREC_SCANS")
	var path: String = folder.path_join("clouds").path_join(file)
	return path if not folder.is_empty() and FileAccess.file_exists(path) else ""


## Puts a file into the project's folder from another program, and comes back to the editor.
func drop_file(from: String, to: String) -> void:
	await files_rest()
	await user.go()
	DirAccess.make_dir_recursive_absolute(to.get_base_dir())
	await user.ask(["copy", from, ProjectSettings.globalize_path(to)])
	await user.come()


## Waits until files may change. The engine forgets new files that it comes upon while it imports
## others, and overlooks what becomes of a folder within a second after it has looked into it: it
## compares whole seconds.
func files_rest() -> void:
	var files: EditorFileSystem = EditorInterface.get_resource_filesystem()
	var quiet: int = 0
	var since: int = Time.get_ticks_msec()
	while quiet < 12 or Time.get_ticks_msec() < since + 2000:
		await user.frames(1)
		quiet += 1
		if files.is_scanning():
			quiet = 0
			since = Time.get_ticks_msec()


## Clicks on a file in the FileSystem dock.
func click_file(path: String, button: int = User.LEFT) -> bool:
	return await click_entry(file_list(), func() -> TreeItem: return file_item(path), button)


## Waits until a scan in the project is imported, and returns its tree or null.
func imported(path: String) -> TreeReconstruction:
	if not await until(
		func() -> bool:
			return (
				ResourceLoader.exists(path, "TreeReconstruction")
				and FileAccess.file_exists(path + ".import")
				and not EditorInterface.get_resource_filesystem().is_scanning()
			),
		path + " is imported"
	):
		return null
	return load(path) as TreeReconstruction


## The sample's tree as a file of its own: made once, and nothing that is imported.
func own_tree(path: String) -> TreeReconstruction:
	if ResourceLoader.exists(path):
		return load(path) as TreeReconstruction
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	var made: TreeReconstruction = reconstructor.reconstruct_file(sample, {})
	if not check(made != null, "The sample can't be reconstructed."):
		return null
	made.leaf_preset = "birch"
	ResourceSaver.save(made, path)
	made.take_over_path(path)
	EditorInterface.get_resource_filesystem().update_file(path)
	return made


## Makes a scene with the tree in it, opens it, and clicks on its node in the Scene dock. The view
## is on it. Returns the node, or null.
func open_garden(path: String, of: TreeReconstruction) -> TreeInstance3D:
	var root: Node3D = Node3D.new()
	root.name = path.get_file().get_basename().to_pascal_case()
	var made: TreeInstance3D = TreeInstance3D.new()
	made.name = "Tree"
	made.reconstruction = of
	root.add_child(made)
	made.owner = root
	if not await open_scene(root, path):
		return null
	return await take_up(EditorInterface.get_edited_scene_root().get_node(^"Tree"))


## Puts the sample into the project, makes a scene with its tree as [method open_garden] does, cuts
## a large branch off, which makes the tree the user's own, and saves. Returns the node, or null.
func open_edited(scan: String, scene: String) -> TreeInstance3D:
	await drop_file(sample, scan)
	var made: TreeReconstruction = await imported(scan)
	if made == null:
		return null
	var node: TreeInstance3D = await open_garden(scene, made)
	if node == null:
		return null
	await user.click(node_on_screen(node, clear_nodes(node, large_branches(made))[0]))
	await until(func() -> bool: return session().get(&"selection").size() == 1, "it is selected")
	await user.key("Delete")
	if not await until(func() -> bool: return node.reconstruction != made, "it is the user's own"):
		return null
	await save_scene()
	return node


## Waits until the editor has opened the scenes of its last run, and shows the one that was shown:
## until then it turns from whatever it is asked to open to the next of them.
func reopened() -> bool:
	var layout: ConfigFile = ConfigFile.new()
	layout.load("res://.godot/editor/editor_layout.cfg")
	var wanted: PackedStringArray = layout.get_value("EditorNode", "open_scenes", [])
	var shown: String = layout.get_value("EditorNode", "current_scene", "")
	return await until(
		func() -> bool:
			for path: String in wanted:
				if not path in EditorInterface.get_open_scenes():
					return false
			return scene_path() == shown,
		"the scenes of the last run are open"
	)


## Clicks on a tree's node in the Scene dock, and brings it into view.
func take_up(node: TreeInstance3D) -> TreeInstance3D:
	EditorInterface.set_main_screen_editor("3D")
	if not await until(func() -> bool: return not node.is_rebuilding(), "the tree is built"):
		return null
	if not await click_node(node):
		return null
	await frame_view()
	return node


## Clicks on a node in the Scene dock.
func click_node(node: Node) -> bool:
	if not await until(func() -> bool: return node_item(node) != null, "the node is in the dock"):
		return false
	if EditorInterface.get_selection().get_selected_nodes() == [node]:
		# A second click would begin to rename it.
		return true
	await click_entry(node_list(), func() -> TreeItem: return node_item(node))
	return await until(
		func() -> bool: return EditorInterface.get_selection().get_selected_nodes() == [node],
		"the node is selected"
	)


## Chooses a tool of the viewport by its key.
func take_tool(id: StringName, key: String) -> bool:
	await user.move(middle(view().get_parent() as Control))
	await user.key(key)
	return await until(
		func() -> bool: return session().get(&"tool") == session().get(&"tools")[id],
		"the tool '%s' is chosen" % id
	)


## The addon's key for the view on the whole tree.
func frame_view() -> void:
	await user.move(middle(view().get_parent() as Control))
	await user.key("KP_0")
	await view_rests()


## Where a tree's node is on the screen.
func node_on_screen(of: TreeInstance3D, id: int) -> Vector2:
	return on_screen(of.global_transform * of.reconstruction.get_node_position(id))


## Those of the nodes that the mouse finds at their own place, nothing else being nearer: as many as
## `most`, or at least `least` of them. The nodes must have been framed.
func clear_nodes(
	of: TreeInstance3D, candidates: PackedInt32Array, most: int = 1, least: int = most
) -> PackedInt32Array:
	var picker: RefCounted = session().get(&"picker")
	var camera: Camera3D = view().get_camera_3d()
	var found: PackedInt32Array = []
	for id: int in candidates:
		var place: Vector3 = of.global_transform * of.reconstruction.get_node_position(id)
		var clear: bool = true
		# The mouse stands on whole pixels.
		for off: Vector2 in [
			Vector2.ZERO, Vector2.ONE, -Vector2.ONE, Vector2(1, -1), Vector2(-1, 1)
		]:
			@warning_ignore("unsafe_method_access")
			clear = clear and picker.pick(camera, camera.unproject_position(place) + off) == id
		if clear:
			found.append(id)
			if found.size() == most:
				break
	check(found.size() >= least, "Too few nodes can be clicked.")
	return found


## The nodes with most wood above them, outside of the trunk: each begins a branch.
func large_branches(of: TreeReconstruction) -> PackedInt32Array:
	var counts: Dictionary[int, int] = {}
	for id: int in of.select_nodes("order:1..2"):
		if of.get_node_order(id) > of.get_node_order(of.get_node_parent(id)):
			counts[id] = of.select_nodes("below:%d" % id).size()
	var ids: Array = counts.keys()
	ids.sort_custom(func(a: int, b: int) -> bool: return counts[a] > counts[b])
	return PackedInt32Array(ids)


## A picture for people, in which the 3D view is as fine as in anybody's project: project.cfg has it
## drawn coarsely. [param seen] is what is looked at instead of the 3D view.
func fine_picture(name: String, seen: SubViewport = view()) -> void:
	var scale: float = seen.scaling_3d_scale
	var shadows: String = "rendering/lights_and_shadows/directional_shadow/size"
	seen.scaling_3d_scale = 1.0
	RenderingServer.directional_shadow_atlas_set_size(4096, true)
	cast_shadows(true)
	await picture(name)
	cast_shadows(false)
	seen.scaling_3d_scale = scale
	var size: int = ProjectSettings.get_setting(shadows)
	RenderingServer.directional_shadow_atlas_set_size(size, true)


## Clicks on the tab of an open scene.
func go_to_scene(path: String) -> bool:
	var tab: int = scene_tab(path)
	if not check(tab >= 0, path + " is not open."):
		return false
	var tabs: TabBar = scene_tabs()
	# There may be more tabs than there is room.
	tabs.ensure_tab_visible(tab)
	await user.frames(5)
	await user.click(tabs.get_screen_transform() * tabs.get_tab_rect(tab).get_center())
	return await until(func() -> bool: return scene_path() == path, path + " is shown")


## Fails the step unless a scene's file names another file, and by no other UID than it has. The
## engine names a file that did not exist yet by its path alone.
func check_uid(scene: String, path: String) -> void:
	var uid: String = ResourceUID.id_to_text(ResourceLoader.get_resource_uid(path))
	for line: String in FileAccess.get_file_as_string(scene).split("\n"):
		if line.begins_with("[ext_resource") and 'path="%s"' % path in line:
			var is_right: bool = not "uid=" in line or 'uid="%s"' % uid in line
			check(is_right, "%s has %s, whose UID is %s" % [scene, line, uid])
			return
	check(false, "%s names no %s." % [scene, path])


## How many objects the 3D view draws, with those that no node owns.
func drawn_objects() -> int:
	return RenderingServer.viewport_get_render_info(
		view().get_viewport_rid(),
		RenderingServer.VIEWPORT_RENDER_INFO_TYPE_VISIBLE,
		RenderingServer.VIEWPORT_RENDER_INFO_OBJECTS_IN_FRAME
	)
