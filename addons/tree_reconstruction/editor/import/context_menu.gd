@tool
extends EditorContextMenuPlugin
## 'Add Tree to Scene' in the FileSystem dock's menu of scans and trees.

## A tree was put into the scene, where there was room for it.
signal placed(node: TreeInstance3D)

const SceneAdder: GDScript = preload("./scene_adder.gd")
const FreePlace: GDScript = preload("./free_place.gd")

const _ICON: String = "res://addons/tree_reconstruction/icons/TreeInstance3D.svg"

var adder: SceneAdder


func _popup_menu(paths: PackedStringArray) -> void:
	var count: int = SceneAdder.tree_files(adder.resolved(paths)).size()
	if count == 0:
		return
	var title: String = tr("Add Tree to Scene") if count == 1 else tr("Add Trees to Scene")
	# Not preloaded: in a project that was just made it is imported after this script is loaded.
	var icon: Texture2D = load(_ICON) as Texture2D if ResourceLoader.exists(_ICON) else null
	add_context_menu_item(title, _add, icon)


func _add(paths: PackedStringArray) -> void:
	var trees: Array[TreeReconstruction] = SceneAdder.load_trees(adder.resolved(paths))
	var nodes: Array[TreeInstance3D] = adder.add(trees, FreePlace.in_view(trees))
	if not nodes.is_empty():
		placed.emit(nodes[0])
