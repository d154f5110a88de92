@tool
extends RefCounted
## Tells how far a forest is: from 0 on, never less than before, and then that it is there.

var _telling: bool = false
var _told: float = -1.0


## Begins anew.
func start() -> void:
	_telling = true
	_told = -1.0


func stop() -> void:
	_telling = false


func is_busy() -> bool:
	return _telling


## Lets [param of] tell the share that is done, if it has become more, and the end of it.
func tell(share: float, of: TreeVariantSpawner3D) -> void:
	if not _telling:
		return
	var now: float = 0.0 if _told < 0.0 else share
	if now > _told:
		_told = now
		of.progressed.emit(now)
	if _told >= 1.0:
		_telling = false
		of.update_configuration_warnings()
		of.finished.emit()
