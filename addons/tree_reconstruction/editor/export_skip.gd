@tool
extends EditorExportPlugin
## Keeps the editor's part of the addon out of exported games.

const _FOLDER: String = "res://addons/tree_reconstruction/"


# Plugins take their turns by name: before "GDScript", which would put the scripts in, compiled.
func _get_name() -> String:
	return "EditorFilesOfTreeReconstruction"


func _export_file(path: String, _type: String, _features: PackedStringArray) -> void:
	if path.begins_with(_FOLDER + "editor/") or path == _FOLDER + "plugin.gd":
		skip()
