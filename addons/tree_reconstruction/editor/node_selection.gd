@tool
extends RefCounted
## Which nodes of a tree are selected, and which one is under the mouse. That is no part of the
## undo history.

signal selection_changed
signal hover_changed

enum How { REPLACE, ADD, TOGGLE, REMOVE }

const NO_NODE: int = TreeReconstruction.NO_NODE

## What is selected of, or [code]null[/code].
var tree: TreeReconstruction:
	get = _get_tree
## Ids of nodes in the order in which they were selected: the last one is the active one.
var selection: PackedInt32Array
## The id of the node under the mouse.
var hovered: int = NO_NODE:
	set(value):
		if hovered != value:
			hovered = value
			hover_changed.emit()


## The node selected last, or NO_NODE.
func get_active() -> int:
	return NO_NODE if selection.is_empty() else selection[-1]


## Selects nodes. That is no step of the history.
func select(ids: PackedInt32Array, how: How = How.REPLACE) -> void:
	var kept: Dictionary[int, bool] = {}
	if how != How.REPLACE:
		for id: int in selection:
			kept[id] = true
	var of: TreeReconstruction = tree
	for id: int in ids:
		if of == null or not of.has_node(id):
			continue
		var take_off: bool = how == How.REMOVE or (how == How.TOGGLE and kept.has(id))
		# Taken out first, so that what is selected again is the last.
		kept.erase(id)
		if not take_off:
			kept[id] = true
	var now: PackedInt32Array = PackedInt32Array(kept.keys())
	if now != selection:
		selection = now
		selection_changed.emit()


## Selects by words, as in [code]order:2..&radius:..0.01[/code] (docs/editing.md). Returns whether
## they were understood.
func select_by(words: String, how: How = How.REPLACE) -> bool:
	if tree == null:
		return false
	var sentence: String = tree.check_selection(words)
	if not sentence.is_empty():
		_refuse(sentence)
		return false
	select(tree.select_nodes(words), how)
	return true


func clear_selection() -> void:
	select([])


## Selects all that grows from the selected nodes, too.
func select_subtree() -> void:
	if not selection.is_empty():
		var active: int = get_active()
		select(tree.select_nodes(_in_words("below:")), How.ADD)
		select([active], How.ADD)


## Adds the neighbours of the selected nodes along the wood.
func grow_selection() -> void:
	var more: PackedInt32Array = []
	for id: int in selection:
		more.append_array(tree.get_node_children(id))
		if id != tree.get_root():
			more.append(tree.get_node_parent(id))
	var active: int = get_active()
	select(more, How.ADD)
	select([active], How.ADD)


## Takes the nodes off that have an unselected neighbour along the wood, and the tips.
func shrink_selection() -> void:
	var selected: Dictionary[int, bool] = {}
	for id: int in selection:
		selected[id] = true
	var less: PackedInt32Array = []
	for id: int in selection:
		var children: PackedInt32Array = tree.get_node_children(id)
		var inside: bool = not children.is_empty()
		for child: int in children:
			inside = inside and selected.has(child)
		if id != tree.get_root():
			inside = inside and selected.has(tree.get_node_parent(id))
		if not inside:
			less.append(id)
	select(less, How.REMOVE)


func _in_words(prefix: String) -> String:
	var words: PackedStringArray = []
	for id: int in selection:
		words.append(prefix + str(id))
	return ",".join(words)


## The selected nodes in the words of an edit command, as in [code]1,7[/code].
func get_selection_words() -> String:
	var words: PackedStringArray = []
	for id: int in selection:
		words.append(str(id))
	return ",".join(words)


## The box around nodes, and what they grow from, in the tree's space; around the whole tree without
## any.
func get_box_of(ids: PackedInt32Array) -> AABB:
	var box: AABB = AABB()
	var begun: bool = false
	var root: int = tree.get_root()
	for id: int in ids:
		if not tree.has_node(id):
			continue
		var at: Vector3 = tree.get_node_position(id)
		box = box.expand(at) if begun else AABB(at, Vector3.ZERO)
		begun = true
		if id != root:
			box = box.expand(tree.get_node_position(tree.get_node_parent(id)))
	return box if begun else tree.get_aabb()


# Takes the nodes off that are no more.
func _drop_missing() -> void:
	var left: PackedInt32Array = []
	for id: int in selection:
		if tree != null and tree.has_node(id):
			left.append(id)
	if tree == null or not tree.has_node(hovered):
		hovered = NO_NODE
	if left != selection:
		selection = left
		selection_changed.emit()


func _get_tree() -> TreeReconstruction:
	return null


func _refuse(_sentence: String) -> void:
	pass
