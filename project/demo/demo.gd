extends Node3D
## Shows the tree that ./dev demo reconstructed, with its camera turning around it. Without one it
## says how to make it.

const _TREE: String = "res://demo/tree.res"

@onready var _tree: TreeInstance3D = $Tree
@onready var _pivot: Node3D = $Pivot
@onready var _camera: Camera3D = $Pivot/Camera
@onready var _hint: Label = $Hint


func _ready() -> void:
	_hint.visible = not ResourceLoader.exists(_TREE)
	if _hint.visible:
		return
	_tree.reconstruction = load(_TREE) as TreeReconstruction
	_tree.rebuilt.connect(_frame_tree)


func _process(delta: float) -> void:
	_pivot.rotate_y(delta * 0.15)


func _frame_tree() -> void:
	var height: float = maxf(_tree.get_aabb().end.y, 0.5)
	_pivot.position.y = height * 0.48
	_camera.position = Vector3(0.0, height * 0.12, height * 1.7)
	_camera.far = height * 40.0
