@tool
extends RefCounted
## Strokes that make no tree yet: as long as there is none, or while those of a tree are drawn anew,
## they are kept here, stroke by stroke, and undone here.
##
## They go on from [member base], the sketch of the tree as it stands, or none. A tree that comes of
## them is a step of the editor's history; where that is undone, [member base] is what the tree has
## again, and the strokes go on from where they were.

## The sketch that the strokes go on from; [code]null[/code] where no tree stands.
var base: TreeSketch

# The first is as the base.
var _states: Array[TreeSketch] = []
var _at: int = 0


## Whether these strokes go on from [param sketch].
func goes_on_from(sketch: TreeSketch) -> bool:
	return not _states.is_empty() and is_same(base, sketch)


## Begins anew, from the sketch of a tree or from nothing.
func begin(from: TreeSketch) -> void:
	base = from
	_states = [from if from != null else TreeSketch.new()]
	_at = 0


## The strokes as they are.
func get_sketch() -> TreeSketch:
	return _states[_at]


## Adds what was changed.
func push(sketch: TreeSketch) -> void:
	_states.resize(_at + 1)
	_states.append(sketch)
	_at += 1


## A tree came of what was changed: what was undone before is gone.
func end() -> void:
	if not _states.is_empty():
		_states.resize(_at + 1)


func has_undo() -> bool:
	return _at > 0


func has_redo() -> bool:
	return _at + 1 < _states.size()


func undo() -> void:
	_at -= 1


func redo() -> void:
	_at += 1
