@tool
extends Node3D
## Shows the tree that ./dev demo reconstructed last, in the editor too; in the game a camera goes
## round it. Without a tree it says how to make one.

const _MADE_BY_DEMO: String = "res://demo/result/tree.tscn"

@onready var _pivot: Node3D = $Pivot
@onready var _camera: Camera3D = $Pivot/Camera
@onready var _hint: Label = $Hint


func _ready() -> void:
	var in_editor: bool = Engine.is_editor_hint()
	set_process(not in_editor)
	if not ResourceLoader.exists(_MADE_BY_DEMO):
		# In the editor this would change the scene.
		_hint.visible = not in_editor
		return
	var scene: PackedScene = ResourceLoader.load(
		_MADE_BY_DEMO, "", ResourceLoader.CACHE_MODE_IGNORE
	)
	var tree: TreeInstance3D = scene.instantiate() as TreeInstance3D
	# Without an owner: it is never saved with this scene.
	add_child(tree)
	if not in_editor:
		tree.rebuilt.connect(_frame_tree.bind(tree))


func _process(delta: float) -> void:
	_pivot.rotate_y(delta * 0.15)


func _frame_tree(tree: TreeInstance3D) -> void:
	var height: float = maxf(tree.get_aabb().end.y, 0.5)
	_pivot.position.y = height * 0.48
	_camera.position = Vector3(0.0, height * 0.12, height * 1.7)
	_camera.far = height * 40.0
