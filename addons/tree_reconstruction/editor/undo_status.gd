@tool
extends RefCounted
## Says which step of the edited tree was undone or done again: what is said of a tree last is of
## what it is now.

const LocalTrees: GDScript = preload("local_trees.gd")


## To be called once a frame, with the session, and with whether its tree changed since the last
## call.
func update(session: Variant, changed: bool) -> void:
	var node: TreeInstance3D = session.node if is_instance_valid(session.node) else null
	if node == null or not node.is_inside_tree():
		return
	var contexts: Array[Object] = [node]
	if session.tree != null and LocalTrees.call(&"has_file", session.tree):
		contexts.append(session.tree)
	var step: String = session.history.look(contexts)
	if step.is_empty() or not changed:
		return
	var words: String = session.tr("Undone: %s")
	if step.begins_with("+"):
		words = session.tr("Done again: %s")
	session.said.emit(words % step.substr(1), session.Kind.INFO)
