@tool
extends RefCounted
## Moves the editor's camera to look at the whole tree from one side.

const Session: GDScript = preload("../session.gd")

var _session: Session


func _init(session: Session) -> void:
	_session = session


func look(_action: StringName, _camera: Camera3D) -> void:
	pass
