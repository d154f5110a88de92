@tool
extends EditorContextMenuPlugin
## 'New Tree from Photos…' in the FileSystem dock's menu of folders with photos, and of photos.

## The user wants a tree of the photos in a folder.
signal chosen(folder: String)

const PhotoFolder := preload("photo_folder.gd")

const _ICON: String = "res://addons/tree_reconstruction/icons/TreeInstance3D.svg"


func _popup_menu(paths: PackedStringArray) -> void:
	var folder: String = _folder_of(paths)
	if PhotoFolder.list(folder).size() < PhotoFolder.LEAST:
		return
	# Not preloaded: in a project that was just made it is imported after this script is loaded.
	var icon: Texture2D = load(_ICON) as Texture2D if ResourceLoader.exists(_ICON) else null
	add_context_menu_item(tr("New Tree from Photos…"), _choose, icon)


func _choose(paths: PackedStringArray) -> void:
	chosen.emit(_folder_of(paths))


# That of all the paths, or none: single photos mean the folder that they are in.
static func _folder_of(paths: PackedStringArray) -> String:
	var folder: String = ""
	for path: String in paths:
		var own: String = (
			path.trim_suffix("/") if path.ends_with("/") and path != "res://" else path
		)
		if not DirAccess.dir_exists_absolute(own):
			if not PhotoFolder.is_photo(path):
				return ""
			own = path.get_base_dir()
		if not folder.is_empty() and own != folder:
			return ""
		folder = own
	return folder
