extends Node3D
## Shows the tree that ./dev demo reconstructed last, a camera going round it. Without one it says
## how to make it.

const _MADE_BY_DEMO: String = "../build/demo/tree.tscn"

@onready var _pivot: Node3D = $Pivot
@onready var _camera: Camera3D = $Pivot/Camera
@onready var _hint: Label = $Hint


func _ready() -> void:
	var path: String = ProjectSettings.globalize_path("res://").path_join(_MADE_BY_DEMO)
	_hint.visible = not FileAccess.file_exists(path)
	if _hint.visible:
		return
	var tree: TreeInstance3D = (load(path) as PackedScene).instantiate() as TreeInstance3D
	add_child(tree)
	tree.rebuilt.connect(_frame_tree.bind(tree))


func _process(delta: float) -> void:
	_pivot.rotate_y(delta * 0.15)


func _frame_tree(tree: TreeInstance3D) -> void:
	var height: float = maxf(tree.get_aabb().end.y, 0.5)
	_pivot.position.y = height * 0.48
	_camera.position = Vector3(0.0, height * 0.12, height * 1.7)
	_camera.far = height * 40.0
