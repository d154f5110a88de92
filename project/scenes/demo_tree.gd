extends RefCounted
## The tree that the demo scenes show: the one that ./dev demo reconstructed last, or an oak grown
## from a grammar where there is none.

const _SCENE: String = "res://demo/result/tree.tscn"
const _POINTS: String = "res://demo/result/points.res"

static var _tree: TreeReconstruction


static func load_tree() -> TreeReconstruction:
	if _tree != null:
		return _tree
	if is_scanned():
		var scene: PackedScene = load(_SCENE) as PackedScene
		var node: TreeInstance3D = scene.instantiate() as TreeInstance3D
		_tree = node.reconstruction
		node.free()
	if _tree == null:
		_tree = grow()
	return _tree


## Makes the scenes that are opened from now on show [param tree].
static func show_tree(tree: TreeReconstruction) -> void:
	_tree = tree


## The oak.
static func grow() -> TreeReconstruction:
	var grammar: LSystem = LSystem.new()
	grammar.grammar = LSystem.get_preset("oak")
	var tree: TreeReconstruction = grammar.grow(1)
	tree.leaf_preset = "oak"
	return tree


static func is_scanned() -> bool:
	return ResourceLoader.exists(_SCENE)


## The scan's points in the tree's space, or null: a grown tree has none.
static func load_points() -> ArrayMesh:
	return load(_POINTS) as ArrayMesh if ResourceLoader.exists(_POINTS) else null
