@tool
extends RefCounted
## The body that a TreeInstance3D collides with, while it stands anywhere.

const Collision := preload("tree_collision.gd")

var _tree: TreeInstance3D
var _body: StaticBody3D


func _init(tree: TreeInstance3D) -> void:
	_tree = tree


## Gives it a shape for each of [param parts], as Collision.gather() returns them; there is no body
## without any.
func fill(parts: Array[Dictionary]) -> void:
	if parts.is_empty():
		free_body()
		return
	if _body == null:
		_body = StaticBody3D.new()
		_body.name = &"Body"
		update()
	Collision.fill(_body, parts)
	follow()


## The layers have changed.
func update() -> void:
	if _body != null:
		_body.collision_layer = _tree.collision_layer
		_body.collision_mask = _tree.collision_mask


## The tree has moved. One of no size collides with nothing: physics can't turn its frame around.
func follow() -> void:
	if _body == null:
		return
	var frame: Transform3D = _tree.global_transform if _tree.is_inside_tree() else _tree.transform
	var stands: bool = frame.is_finite() and frame.basis.determinant() != 0.0
	if stands and _body.get_parent() == null:
		_tree.add_child(_body, false, Node.INTERNAL_MODE_BACK)
	elif not stands and _body.get_parent() != null:
		_tree.remove_child(_body)


func free_body() -> void:
	if _body == null:
		return
	# While it is in the scene the engine may be in the midst of it.
	if _body.is_inside_tree():
		_body.queue_free()
	else:
		_body.free()
	_body = null
