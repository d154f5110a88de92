@tool
extends RefCounted
## Which kinds of trees (the names of bark and leaf pictures: oak, maple and so on) a project uses:
## those of its trees and leaf rules, those whose materials or pictures its resources refer to, and
## those that its scripts name.

const _ADDON: String = "res://addons/tree_reconstruction/"
const _PRESETS: String = _ADDON + "presets/"
const _TEXTURES: String = _ADDON + "textures/"
# What stands in where a kind has no material.
const _FALLBACK: String = "generic"
const _SCRIPTS: PackedStringArray = ["gd", "cs"]
const _SAVED: PackedStringArray = ["tscn", "scn", "tres", "res"]

var _used: Dictionary[String, bool] = {_FALLBACK: true}
# What in the addon's folders is referred to, by path.
var _files: Dictionary[String, bool] = {}
var _word: RegEx


func _init() -> void:
	# A word of its own, or the beginning of a preset's file; no part of a path of the project's.
	var kinds: String = "|".join(all_kinds())
	_word = RegEx.create_from_string(
		(
			"(?<![\\w/.-])(%s)(?![\\w/.-])|tree_reconstruction/(?:presets|textures)/(%s)_"
			% [kinds, kinds]
		)
	)


## All kinds that the addon has pictures of.
static func all_kinds() -> PackedStringArray:
	var kinds: PackedStringArray = []
	for file: String in ResourceLoader.list_directory(_PRESETS):
		if file.ends_with("_bark.tres"):
			kinds.append(file.trim_suffix("_bark.tres"))
	kinds.sort()
	return kinds


## Looks through all files of the project but the addon's own.
func add_project() -> void:
	_add_folder(EditorInterface.get_resource_filesystem().get_filesystem())


## One more, whatever the project says.
func add_kind(kind: String) -> void:
	_used[kind] = true


## Those that nothing of the project needs.
func get_unused() -> PackedStringArray:
	var unused: PackedStringArray = []
	for kind: String in all_kinds():
		if not _used.has(kind):
			unused.append(kind)
	return unused


## Whether [param path] is a picture or a material of the addon's that no tree needs and no resource
## refers to.
func is_unused_file(path: String) -> bool:
	if _files.has(path):
		return false
	if path.begins_with(_PRESETS + "twigs/"):
		return true
	if not (path.begins_with(_PRESETS) or path.begins_with(_TEXTURES)):
		return false
	var kind: String = path.get_file().get_slice("_", 0)
	return not _used.has(kind)


## The kinds that [param text], a script or the like, names.
func add_text(text: String) -> void:
	for found: RegExMatch in _word.search_all(text):
		add_kind(found.get_string(1) + found.get_string(2))


## The kinds of all trees and leaf rules in [param value], a resource or what is in one.
func add_value(value: Variant, seen: Dictionary[Variant, bool] = {}) -> void:
	if value is Dictionary:
		add_value((value as Dictionary).keys(), seen)
		add_value((value as Dictionary).values(), seen)
	elif value is Array:
		for item: Variant in value as Array:
			add_value(item, seen)
	elif value is String or value is StringName:
		add_text(str(value))
	elif value is Resource and not seen.has(value):
		seen[value] = true
		_add_resource(value as Resource, seen)


func _add_resource(resource: Resource, seen: Dictionary[Variant, bool]) -> void:
	if resource is TreeReconstruction:
		for kind: Dictionary in (resource as TreeReconstruction).get_leaf_kinds():
			add_kind(kind.look)
	elif resource is LeafRule:
		add_kind((resource as LeafRule).look)
	elif resource is PackedScene:
		# What nodes have, as their scene keeps it: nothing is made for it.
		add_value((resource as PackedScene).get(&"_bundled"), seen)
		return
	for property: Dictionary in resource.get_property_list():
		var kept: bool = (property.usage as int) & PROPERTY_USAGE_STORAGE != 0
		if kept and property.type in [TYPE_OBJECT, TYPE_ARRAY, TYPE_DICTIONARY, TYPE_STRING]:
			if property.name not in ["resource_path", "resource_name", "skeleton", "provenance"]:
				add_value(resource.get(property.name as StringName), seen)


func _add_folder(folder: EditorFileSystemDirectory) -> void:
	if folder.get_path() == _ADDON:
		return
	for index: int in folder.get_subdir_count():
		_add_folder(folder.get_subdir(index))
	for index: int in folder.get_file_count():
		var path: String = folder.get_file_path(index)
		var type: StringName = folder.get_file_type(index)
		var extension: String = path.get_extension().to_lower()
		if extension in _SCRIPTS:
			add_text(FileAccess.get_file_as_string(path))
			continue
		var saved: bool = extension in _SAVED
		if saved:
			_add_dependencies(path)
		if type in [&"TreeReconstruction", &"LeafRule"] or (saved and _has_trees(path, type)):
			add_value(load(path))


# Materials and pictures of the addon's that it names.
func _add_dependencies(path: String) -> void:
	for dependency: String in ResourceLoader.get_dependencies(path):
		var file: String = dependency.get_slice("::", dependency.get_slice_count("::") - 1)
		if file.begins_with(_PRESETS) or file.begins_with(_TEXTURES):
			_files[file] = true
			add_kind(file.get_file().get_slice("_", 0))


# Whether there may be trees or rules in a saved file. Most files are not loaded for it.
static func _has_trees(path: String, type: StringName) -> bool:
	if type != &"PackedScene" and not ClassDB.is_parent_class(type, &"Resource"):
		return false
	var bytes: PackedByteArray = FileAccess.get_file_as_bytes(path)
	if bytes.slice(0, 4).get_string_from_ascii() == "RSCC":
		# Compressed: nobody knows from outside.
		return type == &"PackedScene" or type == &"Resource"
	return (
		_contains(bytes, "TreeReconstruction")
		or _contains(bytes, "LeafRule")
		or _contains(bytes, "tree_reconstruction")
	)


static func _contains(bytes: PackedByteArray, word: String) -> bool:
	var text: PackedByteArray = word.to_ascii_buffer()
	var at: int = bytes.find(text[0])
	while at >= 0:
		if bytes.slice(at, at + text.size()) == text:
			return true
		at = bytes.find(text[0], at + 1)
	return false
