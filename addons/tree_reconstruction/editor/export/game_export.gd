@tool
extends EditorExportPlugin
## What of the addon goes into exported games: not the editor's part, no pictures of kinds of trees
## that the game has none of, and no path of the author's disk.

const UsedKinds := preload("used_kinds.gd")
## The project setting for kinds whose names the game's code puts together.
const KINDS_SETTING: String = "tree_reconstruction/export/more_kinds"

const _FOLDER: String = "res://addons/tree_reconstruction/"
const _PLATFORMS: PackedStringArray = ["linux", "windows", "macos", "android", "ios", "web"]
const _TARGETS: PackedStringArray = ["template_debug", "template_release"]
const _PROCESSORS: PackedStringArray = ["x86_64", "x86_32", "arm64", "arm32", "universal", "wasm32"]
# Raised where what _customize_resource() does changes: resources are customized anew.
const _REVISION: int = 1

# Those that are in the addon and not in the game.
var _left_out: PackedStringArray = []
var _used: UsedKinds


## Shows the project's setting where it can be changed.
static func add_setting() -> void:
	if not ProjectSettings.has_setting(KINDS_SETTING):
		ProjectSettings.set_setting(KINDS_SETTING, PackedStringArray())
	ProjectSettings.set_initial_value(KINDS_SETTING, PackedStringArray())
	(
		ProjectSettings
		. add_property_info(
			{
				"name": KINDS_SETTING,
				"type": TYPE_PACKED_STRING_ARRAY,
				"hint": PROPERTY_HINT_TYPE_STRING,
				"hint_string":
				"%d/%d:%s" % [TYPE_STRING, PROPERTY_HINT_ENUM, ",".join(UsedKinds.all_kinds())],
			}
		)
	)


# Plugins take their turns by name: before "GDScript", which would put the scripts in, compiled.
func _get_name() -> String:
	return "EditorFilesOfTreeReconstruction"


func _export_begin(
	features: PackedStringArray, _is_debug: bool, _path: String, _flags: int
) -> void:
	var missing: String = missing_library(features)
	if not missing.is_empty():
		push_error(missing)
	_used = UsedKinds.new()
	_used.add_project()
	for kind: String in ProjectSettings.get_setting(KINDS_SETTING, PackedStringArray()):
		_used.add_kind(kind)
	_left_out = _used.get_unused()
	if not _left_out.is_empty():
		print(
			(
				(
					"Tree Reconstruction: the game has no trees of these kinds, whose pictures stay"
					+ " out of it: %s. Where code makes some, add them in Project Settings > Tree"
					+ " Reconstruction > Export."
				)
				% ", ".join(_left_out)
			)
		)


func _export_end() -> void:
	_used = null


func _export_file(path: String, _type: String, _features: PackedStringArray) -> void:
	if path.begins_with(_FOLDER + "editor/") or path == _FOLDER + "plugin.gd":
		skip()
	elif _used != null and _used.is_unused_file(path):
		skip()


func _begin_customize_resources(
	_platform: EditorExportPlatform, _features: PackedStringArray
) -> bool:
	return true


func _get_customization_configuration_hash() -> int:
	return _REVISION


# The game needs to know where a tree comes from, not on whose disk it lay.
func _customize_resource(resource: Resource, _path: String) -> Resource:
	var tree: TreeReconstruction = resource as TreeReconstruction
	if tree == null:
		return null
	var told: Dictionary = without_folders(tree.provenance)
	if told == tree.provenance:
		return null
	var made: TreeReconstruction = tree.duplicate() as TreeReconstruction
	made.provenance = told
	return made


## What is to be said where the addon has no library for a game of these features, or nothing.
static func missing_library(features: PackedStringArray) -> String:
	var manifest: ConfigFile = ConfigFile.new()
	manifest.load(_FOLDER + "tree_reconstruction.gdextension")
	for tags: String in manifest.get_section_keys("libraries"):
		var fits: bool = true
		for tag: String in tags.split("."):
			fits = fits and tag in features
		var path: String = manifest.get_value("libraries", tags)
		if fits and FileAccess.file_exists(_FOLDER.path_join(path)):
			return ""
	var wanted: PackedStringArray = []
	for tag: String in features:
		# Of all that an export tells, what tells libraries apart.
		if tag in _PLATFORMS or tag in _TARGETS or tag in _PROCESSORS:
			wanted.append(tag)
	return (
		(
			"Tree Reconstruction: addons/tree_reconstruction/bin/ has no library for this export (%s)."
			+ " The game would start without its trees: take the addon's package that has all"
			+ " libraries, or build this one."
		)
		% " ".join(wanted)
	)


## [param value] with the bare names of files in place of absolute paths.
static func without_folders(value: Variant) -> Variant:
	if value is Dictionary:
		var cleaned: Dictionary = {}
		for key: Variant in value as Dictionary:
			cleaned[key] = without_folders((value as Dictionary)[key])
		return cleaned
	if value is Array:
		var cleaned: Array = []
		for item: Variant in value as Array:
			cleaned.append(without_folders(item))
		return cleaned
	var text: String = value if value is String else ""
	if text.is_absolute_path() and not text.contains("://"):
		return text.get_file()
	return value
