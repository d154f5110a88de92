@tool
extends RefCounted
## What trees of one kind have in common, as files of one folder that their scenes name: materials,
## pictures, shaders, leaf cards and a script. A file is called by what it is made of, so it is made
## once, whichever of several programs at work in one folder comes first.

const LeavesApart := preload("leaves_apart.gd")
const PlainMaterials := preload("plain_materials.gd")

# Of a tree that is drawn with shared materials: these know neither its height nor its place.
const _SCRIPT_NAME: String = "baked_tree.gd"
const _SCRIPT: String = """@tool
extends Node3D
## Draws the parts of a baked tree with copies of the materials that all of its kind share. The
## copies know how high it is and where it stands, as the wind asks. Needs nothing else.

## What the shaders take of this tree.
@export var values: Dictionary = {}
## What those of further kinds of leaves take otherwise, by the names of their nodes.
@export var own_values: Dictionary = {}
## The bark's material, where the meshes have none.
@export var bark: Material
## The meshes of leaves by the paths of their nodes, where the multimeshes have none.
@export var cards: Dictionary = {}

var _bark: Array[ShaderMaterial] = []
var _leaves: Array[ShaderMaterial] = []


func _enter_tree() -> void:
	set_notify_transform(true)
	if _bark.is_empty() and _leaves.is_empty():
		_copy()
	_tell()


func _notification(what: int) -> void:
	if what == NOTIFICATION_TRANSFORM_CHANGED:
		_tell()


func _copy() -> void:
	var copies: Dictionary = {}
	for path: String in cards:
		(get_node(path) as MultiMeshInstance3D).multimesh.mesh = cards[path]
	for node: Node in find_children("*", "GeometryInstance3D", true, false):
		var part: GeometryInstance3D = node as GeometryInstance3D
		var mesh: Mesh = null
		if part is MultiMeshInstance3D:
			mesh = (part as MultiMeshInstance3D).multimesh.mesh
		elif part is MeshInstance3D:
			mesh = (part as MeshInstance3D).mesh
		if mesh == null or mesh.get_surface_count() == 0 or part.material_override != null:
			continue
		var shared: ShaderMaterial = mesh.surface_get_material(0) as ShaderMaterial
		if shared == null and part is not MultiMeshInstance3D:
			shared = bark as ShaderMaterial
		if shared == null:
			continue
		var own: Dictionary = own_values.get(part.name, {})
		var key: Array = [shared, own]
		if not copies.has(key):
			var copy: ShaderMaterial = shared.duplicate() as ShaderMaterial
			for name: StringName in values:
				copy.set_shader_parameter(name, values[name])
			for name: StringName in own:
				copy.set_shader_parameter(name, own[name])
			copies[key] = copy
			(_leaves if part is MultiMeshInstance3D else _bark).append(copy)
		# The server's alone: the scene is to keep the shared one.
		RenderingServer.instance_geometry_set_material_override(
			part.get_instance(), (copies[key] as ShaderMaterial).get_rid()
		)


func _tell() -> void:
	var height: float = values.get(&"tree_height", 10.0) * global_basis.get_scale().y
	for copy: ShaderMaterial in _leaves:
		copy.set_shader_parameter(&"tree_origin", global_position)
		copy.set_shader_parameter(&"tree_height", height)
"""

## Why something could not be saved; empty when all could.
var error: String = ""

var _folder: String
# By what it is made of, so that the next tree needs no work.
var _known: Dictionary[String, Resource] = {}


func _init(folder: String) -> void:
	_folder = folder.trim_suffix("/")
	if DirAccess.make_dir_recursive_absolute(ProjectSettings.globalize_path(_folder)) != OK:
		error = "'%s' cannot be written: it is no folder, and cannot become one." % _folder


## A copy of [param of] with nothing of a single tree in it. A material that has nothing of the
## addon is returned as it is. See [method PlainMaterials.plain].
func material(of: Material, joined: bool, global_wind: bool) -> Material:
	if not PlainMaterials.is_addons(of):
		return of
	var key: String = "%s %s %s" % [of.resource_path, joined, global_wind]
	if of.resource_path.is_empty() or not _known.has(key):
		_known[key] = _make_material(of as ShaderMaterial, joined, global_wind)
	return _known[key] as Material


func _make_material(of: ShaderMaterial, joined: bool, global_wind: bool) -> Material:
	var made: ShaderMaterial = ShaderMaterial.new()
	made.resource_name = of.resource_path.get_file().get_basename()
	made.shader = _shader(of.shader, joined, global_wind)
	var told: PackedStringArray = [made.shader.resource_path.get_file()]
	for uniform: Dictionary in of.shader.get_shader_uniform_list():
		var value: Variant = of.get_shader_parameter(uniform.name)
		if value is Texture2D:
			value = _picture(value as Texture2D, "normal" in String(uniform.name))
			told.append("%s %s" % [uniform.name, (value as Texture2D).resource_path.get_file()])
		elif value != null:
			told.append("%s %s" % [uniform.name, var_to_str(value)])
		if value != null:
			made.set_shader_parameter(uniform.name, value)
	told.sort()
	var name: String = made.resource_name if not made.resource_name.is_empty() else "material"
	return _keep(made, name, "\n".join(told).to_utf8_buffer(), "tres")


func _shader(of: Shader, joined: bool, global_wind: bool) -> Shader:
	var made: Shader = Shader.new()
	made.code = PlainMaterials.code_of(of, joined, global_wind, true)
	var name: String = of.resource_path.get_file().get_basename()
	return _keep(made, name, made.code.to_utf8_buffer(), "gdshader") as Shader


func _picture(of: Texture2D, is_normal: bool) -> Texture2D:
	if not PlainMaterials.is_addon_file(of):
		return of
	var name: String = of.resource_path.get_file().get_basename()
	var source: PackedByteArray = FileAccess.get_file_as_bytes(of.resource_path)
	if source.is_empty():
		source = of.get_image().get_data()
	var path: String = _path_of(name, source, "res")
	if not _known.has(path) and not FileAccess.file_exists(path):
		return _keep(PlainMaterials.plain_texture(of, is_normal), name, source, "res") as Texture2D
	return _loaded(path) as Texture2D


## The mesh of a leaf of the surface arrays [param card], in [param of].
func card(arrays: Array, of: Material) -> Mesh:
	var of_name: String = of.resource_path.get_file().get_basename()
	var bytes: PackedByteArray = var_to_bytes(arrays)
	bytes.append_array(of_name.to_utf8_buffer())
	return _keep(LeavesApart.mesh(arrays, of), "card", bytes, "tres") as Mesh


## The script that a tree's root has.
func script() -> GDScript:
	var path: String = _folder.path_join(_SCRIPT_NAME)
	if not error.is_empty():
		return null
	if not _known.has(path):
		if not FileAccess.file_exists(path) or FileAccess.get_file_as_string(path) != _SCRIPT:
			var part: String = "%s.%d.part" % [path, OS.get_process_id()]
			var file: FileAccess = FileAccess.open(part, FileAccess.WRITE)
			if file == null:
				error = "'%s' cannot be written." % path
				return null
			file.store_string(_SCRIPT)
			file.close()
			DirAccess.rename_absolute(part, path)
		_known[path] = load(path)
	return _known[path] as GDScript


# `made`, or the file that an equal one was kept as: `of` is what it was made of.
func _keep(made: Resource, name: String, of: PackedByteArray, ending: String) -> Resource:
	var path: String = _path_of(name, of, ending)
	if _known.has(path) or FileAccess.file_exists(path):
		return _loaded(path)
	if not error.is_empty():
		return made
	var part: String = "%s.%d.%s" % [path.get_basename(), OS.get_process_id(), ending]
	# The engine draws one otherwise, and no two files would be equal.
	made.resource_scene_unique_id = "made"
	var failure: Error = ResourceSaver.save(
		made, part, ResourceSaver.FLAG_COMPRESS | ResourceSaver.FLAG_RELATIVE_PATHS
	)
	if failure == OK and ending == "tres":
		failure = _write_steadily(part, FileAccess.get_file_as_string(part))
	if failure == OK:
		failure = DirAccess.rename_absolute(
			ProjectSettings.globalize_path(part), ProjectSettings.globalize_path(path)
		)
	if failure != OK:
		error = "'%s' cannot be written: %s." % [path, error_string(failure)]
	made.take_over_path(path)
	_known[path] = made
	return made


# Writes the `text` of a resource with numbers in place of the ids, which the engine draws anew
# each time, and with names in place of the paths of what lies beside it: the folder can be moved.
static func _write_steadily(path: String, text: String) -> Error:
	text = text.replace(' path="%s/' % path.get_base_dir(), ' path="')
	var numbers: Dictionary[String, String] = {}
	for found: RegExMatch in RegEx.create_from_string(' id="([^"]+)"').search_all(text):
		numbers[found.get_string(1)] = str(numbers.size() + 1)
	for id: String in numbers:
		text = text.replace(' id="%s"' % id, ' id="%s"' % numbers[id])
		text = text.replace('Resource("%s")' % id, 'Resource("%s")' % numbers[id])
	var file: FileAccess = FileAccess.open(path, FileAccess.WRITE)
	if file == null:
		return FileAccess.get_open_error()
	file.store_string(text)
	file.close()
	return OK


func _loaded(path: String) -> Resource:
	if not _known.has(path):
		_known[path] = load(path)
	return _known[path]


func _path_of(name: String, of: PackedByteArray, ending: String) -> String:
	var hashing: HashingContext = HashingContext.new()
	hashing.start(HashingContext.HASH_SHA256)
	hashing.update(of)
	var digest: String = hashing.finish().hex_encode().left(12)
	return _folder.path_join("%s_%s.%s" % [name, digest, ending])
