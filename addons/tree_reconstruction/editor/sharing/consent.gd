@tool
extends RefCounted
## Whether the user knows which other nodes and scenes an edit of a tree changes, too.

const LocalTrees: GDScript = preload("../local_trees.gd")

## Asks what to change where other nodes show a tree, too: gets these nodes, and what to call once
## the edited node has a tree of its own, or the user agrees. Without it all of them change.
var ask: Callable

var _local_trees: LocalTrees
# Told what the user should know, without being asked.
var _warn: Callable
# By instance id of a tree: those of the nodes for all of which the user edits it.
var _agreed: Dictionary[int, Array] = {}


func _init(local_trees: LocalTrees, warn: Callable) -> void:
	_local_trees = local_trees
	_warn = warn


## Edits of the tree are meant for [param node] and all others that show it now.
func agree(tree: TreeReconstruction, node: Node) -> void:
	var ids: Array = [node.get_instance_id()]
	for holder: Node in LocalTrees.get_holders(tree):
		ids.append(holder.get_instance_id())
	_agreed[tree.get_instance_id()] = ids


## Whether the tree may be edited for [param node] now. Where it may not, the user is asked, and
## [param again] is called after the answer.
func is_settled(tree: TreeReconstruction, node: Node, again: Callable) -> bool:
	if not ask.is_valid():
		return true
	var others: Array[Node] = LocalTrees.get_holders(tree)
	others.erase(node)
	var agreed: Array = _agreed.get(tree.get_instance_id(), [])
	if others.any(func(other: Node) -> bool: return other.get_instance_id() not in agreed):
		ask.call(others, again)
		return false
	if others.is_empty() and agreed.is_empty():
		var scenes: PackedStringArray = _local_trees.get_other_scenes(tree, node)
		if not scenes.is_empty():
			agree(tree, node)
			var names: String = ", ".join(scenes)
			_warn.call(
				tr("The edited tree is also in other scenes and changes there, too: %s.") % names
			)
	return true
