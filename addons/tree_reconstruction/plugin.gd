@tool
extends EditorPlugin
## The editor's side of the addon. The classes register themselves: TreeReconstruction and
## TreeReconstructor by the native library, TreeInstance3D by its class_name.


func _enter_tree() -> void:
	if not ClassDB.class_exists(&"TreeReconstruction"):
		push_error(
			(
				"Tree Reconstruction: the native library did not load. Look for its error message above,"
				+ " and check that addons/tree_reconstruction/bin/ holds a library for this system."
			)
		)


func _exit_tree() -> void:
	pass
