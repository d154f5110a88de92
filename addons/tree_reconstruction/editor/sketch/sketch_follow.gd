@tool
extends RefCounted
## Lets a tree follow the pen: it takes the wood of what is drawn so far, without a step of the
## history, and has its own again before any step is made.

const LocalTrees := preload("../local_trees.gd")

var _tree: TreeReconstruction
var _before: TreeReconstruction
# By which it is known that nobody else changed the tree meanwhile.
var _provenance: Dictionary


## Whether a tree shows what is under way.
func is_at_work() -> bool:
	return _tree != null


## Whether the tree of a node may follow. One that other nodes show, or that was imported, may not.
static func can_follow(node: TreeInstance3D) -> bool:
	return (
		node != null
		and node.reconstruction != null
		and not LocalTrees.is_foreign(node.reconstruction, node)
		and LocalTrees.get_holders(node.reconstruction).size() <= 1
	)


## Shows [param made] on the tree.
func show(tree: TreeReconstruction, made: TreeReconstruction) -> void:
	if _tree != tree:
		restore()
		_tree = tree
		_before = TreeReconstruction.new()
		_before.take_tree_of(tree)
	tree.take_tree_of(made)
	_provenance = tree.provenance


## The tree is bit for bit what it was.
func restore() -> void:
	if _tree != null and is_same(_tree.provenance, _provenance):
		_tree.take_tree_of(_before)
	_tree = null
	_before = null
