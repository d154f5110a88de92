extends SceneTree
## Bakes a job's trees, one after the other, for scripts/bake.py:
##
##     godot --headless --path project --script bake.gd -- JOB.json
##
## JOB: {out, shared, levels, trees: [{id, skeleton, leaves, seed}]}, with folders as absolute
## paths. A line is said of each: "BEGIN id", then "DONE {row}". One that fails is a row with its
## sentence.

const BuildJob := preload("res://addons/tree_reconstruction/nodes/tree_build_job.gd")
const TRUNK_SHAPES: int = 4


func _initialize() -> void:
	var arguments: PackedStringArray = OS.get_cmdline_user_args()
	var text: String = "" if arguments.is_empty() else FileAccess.get_file_as_string(arguments[0])
	var job: Variant = JSON.parse_string(text)
	if job is not Dictionary:
		printerr("There is no job to read.")
		quit(2)
		return
	var baker: TreeBaker = TreeBaker.new()
	baker.form = TreeBaker.Form.MULTIMESH
	baker.levels = int(job["levels"])
	baker.collision_kind = TreeInstance3D.CollisionKind.TRUNK_ONLY
	baker.collision_shapes = TRUNK_SHAPES
	baker.shared_folder = job["shared"]
	for tree: Dictionary in job["trees"]:
		print("BEGIN ", tree["id"])
		var row: Dictionary = _bake(baker, tree, job["out"])
		row["id"] = tree["id"]
		print("DONE ", JSON.stringify(row))
	quit()


func _bake(baker: TreeBaker, wanted: Dictionary, out: String) -> Dictionary:
	var reader: TreeReconstructor = TreeReconstructor.new()
	var tree: TreeReconstruction = reader.import_skeleton(wanted["skeleton"])
	if tree == null:
		return {"code": 1, "error": reader.get_error_message()}
	tree.resource_name = wanted["id"]
	tree.leaf_preset = wanted["leaves"]
	tree.seed = int(wanted["seed"])
	baker.load_materials(tree)
	var parts: TreeBaker.Parts = baker.build(tree)
	var path: String = out.path_join("%s.tscn" % wanted["id"])
	var root: Node3D = baker.make_nodes(tree, parts)
	if not baker.get_error_message().is_empty():
		root.free()
		return {"code": 1, "error": baker.get_error_message()}
	var failure: Error = _save(root, path)
	if failure != OK:
		return {"code": 1, "error": "'%s' cannot be written: %s." % [path, error_string(failure)]}
	var triangles: Array[int] = []
	for level: int in baker.levels:
		triangles.append(_count(parts, level))
	var shared: PackedStringArray = []
	_add_dependencies(path, shared)
	shared.sort()
	return {"code": 0, "error": "", "triangles": triangles, "shared": shared}


## Into two files, as binary ones cannot name others by relative paths: the tree's own data in one
## that names no other, and a short text that brings it together with what it shares.
func _save(root: Node3D, path: String) -> Error:
	var script: Script = root.get_script()
	var values: Dictionary = root.get("values")
	var own_values: Dictionary = root.get("own_values")
	var bark: Material = null
	var cards: Dictionary = {}
	var kept: Array[Resource] = []
	for node: Node in root.find_children("*", "GeometryInstance3D", true, false):
		var leaves: MultiMeshInstance3D = node as MultiMeshInstance3D
		if leaves != null:
			cards[String(root.get_path_to(leaves))] = leaves.multimesh.mesh
			leaves.multimesh.mesh = null
			kept.append(leaves.multimesh)
			continue
		var mesh: ArrayMesh = (node as MeshInstance3D).mesh as ArrayMesh
		if mesh.get_surface_count() > 0:
			bark = mesh.surface_get_material(0)
			mesh.surface_set_material(0, null)
		kept.append(mesh)
	for node: Node in root.find_children("*", "CollisionShape3D", true, false):
		kept.append((node as CollisionShape3D).shape)
	root.set_script(null)
	var root_name: String = root.name
	var data: PackedScene = PackedScene.new()
	data.pack(root)
	root.free()
	_settle(data, kept)
	var data_path: String = path.get_basename() + ".scn"
	var failure: Error = _write(data, data_path)
	if failure != OK:
		return failure
	var text: String = _text(root_name, data_path, script, values, own_values, bark, cards)
	var part: String = "%s.part" % path
	var file: FileAccess = FileAccess.open(part, FileAccess.WRITE)
	if file == null:
		return FileAccess.get_open_error()
	file.store_string(text)
	file.close()
	return DirAccess.rename_absolute(part, path)


## The engine draws ids of nodes and of resources by chance, and no two files would be equal.
func _settle(scene: PackedScene, kept: Array[Resource]) -> void:
	for i: int in kept.size():
		kept[i].resource_scene_unique_id = str(i + 1)
	scene.resource_scene_unique_id = "scene"
	var bundled: Dictionary = scene.get("_bundled")
	var ids: PackedInt32Array = bundled["node_ids"]
	for i: int in ids.size():
		ids[i] = i + 1
	bundled["node_ids"] = ids
	scene.set("_bundled", bundled)


func _text(
	name: String,
	data: String,
	script: Script,
	values: Dictionary,
	own_values: Dictionary,
	bark: Material,
	cards: Dictionary
) -> String:
	var files: PackedStringArray = []
	files.append('type="PackedScene" path="%s"' % data.get_file())
	files.append(_named("Script", script))
	var told: String = 'script = ExtResource("2")\n'
	told += "values = %s\nown_values = %s\n" % [var_to_str(values), var_to_str(own_values)]
	if bark != null:
		files.append(_named("Material", bark))
		told += 'bark = ExtResource("%d")\n' % files.size()
	var words: PackedStringArray = []
	for path: String in cards:
		if not _named("ArrayMesh", cards[path]) in files:
			files.append(_named("ArrayMesh", cards[path]))
		var number: int = files.find(_named("ArrayMesh", cards[path])) + 1
		words.append('%s: ExtResource("%d")' % [var_to_str(path), number])
	told += "cards = {\n%s\n}\n" % ",\n".join(words)
	var text: String = "[gd_scene load_steps=%d format=3]\n\n" % (files.size() + 1)
	for i: int in files.size():
		text += '[ext_resource %s id="%d"]\n' % [files[i], i + 1]
	return text + '\n[node name="%s" instance=ExtResource("1")]\n%s' % [name, told]


func _named(type: String, shared: Resource) -> String:
	return 'type="%s" path="../shared/%s"' % [type, shared.resource_path.get_file()]


func _write(scene: PackedScene, path: String) -> Error:
	var part: String = "%s.part.%s" % [path.get_basename(), path.get_extension()]
	var failure: Error = ResourceSaver.save(
		scene, part, ResourceSaver.FLAG_COMPRESS | ResourceSaver.FLAG_RELATIVE_PATHS
	)
	if failure == OK:
		failure = DirAccess.rename_absolute(part, path)
	return failure


func _count(parts: TreeBaker.Parts, level: int) -> int:
	var count: int = BuildJob.leaf_triangles(parts.foliage[level])
	if not parts.bark[level].is_empty():
		@warning_ignore("integer_division")
		count += (parts.bark[level][Mesh.ARRAY_INDEX] as PackedInt32Array).size() / 3
	return count


## The names of the shared files that a file needs, and that these need.
func _add_dependencies(path: String, found: PackedStringArray) -> void:
	for named: String in ResourceLoader.get_dependencies(path):
		# Told as "uid::type::path" where it has an id.
		var file: String = named.get_slice("::", named.get_slice_count("::") - 1)
		if not file.is_absolute_path():
			file = path.get_base_dir().path_join(file).simplify_path()
		if not file.ends_with(".scn") and not file.get_file() in found:
			found.append(file.get_file())
			_add_dependencies(file, found)
