@tool
extends RefCounted
## What is known of the sketches that were made lately: what their strokes were taken for, what is
## wrong with them, in the editor's language.

const Session := preload("../session.gd")
# So many steps can be undone without a sketch being read again.
const _MOST: int = 64


class Entry:
	extends RefCounted

	var sketch: TreeSketch
	## By a stroke's id.
	var strokes: Dictionary[int, Dictionary] = {}
	var remarks: PackedStringArray = []
	## The pixel of the canvas at the trunk's base, and how long a pixel is, in metres; 0 where no tree
	## came of it.
	var stem_base: Vector2
	var pixel: float = 0.0
	## Why it is no tree.
	var sentence: String = ""


var _entries: Array[Entry] = []


func has(sketch: TreeSketch) -> bool:
	return _find(sketch) != null


## Remembers a report of [method TreeReconstructor.sketch_tree].
func add(sketch: TreeSketch, report: Dictionary, session: Session, sentence: String = "") -> void:
	var entry: Entry = Entry.new()
	entry.sketch = sketch
	var domain: StringName = session.get_translation_domain()
	var ids: Array = sketch.strokes.map(func(stroke: Dictionary) -> int: return stroke["id"])
	var known: Array = report.get("strokes", [])
	for i: int in mini(known.size(), ids.size()):
		var stroke: Dictionary = (known[i] as Dictionary).duplicate()
		stroke["fault"] = Session.Sentences.translate(stroke.get("fault", ""), domain)
		entry.strokes[ids[i]] = stroke
	entry.sentence = Session.Sentences.translate(sentence, domain)
	entry.stem_base = stem_base_of(report)
	entry.pixel = report.get("metres_per_pixel", 0.0)
	for remark: String in report.get("remarks", []):
		entry.remarks.append(Session.Sentences.translate(remark, domain))
	_entries.append(entry)
	if _entries.size() > _MOST:
		_entries.pop_front()


## What each stroke was taken for, by its id.
func get_strokes(sketch: TreeSketch) -> Dictionary[int, Dictionary]:
	var entry: Entry = _find(sketch)
	var none: Dictionary[int, Dictionary] = {}
	return entry.strokes if entry != null else none


func get_faults(sketch: TreeSketch) -> PackedStringArray:
	var faults: PackedStringArray = []
	for stroke: Dictionary in get_strokes(sketch).values():
		if stroke["fault"] != "" and not stroke["fault"] in faults:
			faults.append(stroke["fault"])
	return faults


## The pixel of the canvas at the trunk's base.
func get_stem_base(sketch: TreeSketch) -> Vector2:
	var entry: Entry = _find(sketch)
	return entry.stem_base if entry != null else Vector2.ZERO


## How long a pixel of the canvas is, in metres; 0 where that isn't known.
func get_pixel(sketch: TreeSketch) -> float:
	var entry: Entry = _find(sketch)
	return entry.pixel if entry != null else 0.0


## The pixel at the trunk's base in a report.
static func stem_base_of(report: Dictionary) -> Vector2:
	var at: Array = report.get("base", [0.0, 0.0])
	return Vector2(at[0], at[1])


func get_remarks(sketch: TreeSketch) -> PackedStringArray:
	var entry: Entry = _find(sketch)
	return entry.remarks if entry != null else PackedStringArray()


func get_sentence(sketch: TreeSketch) -> String:
	var entry: Entry = _find(sketch)
	return entry.sentence if entry != null else ""


# The latest one.
func _find(sketch: TreeSketch) -> Entry:
	for i: int in range(_entries.size() - 1, -1, -1):
		if is_same(_entries[i].sketch, sketch):
			return _entries[i]
	return null
