@tool
extends RefCounted
## Strokes from and to files.

## Strokes were read. [param told] are the properties of [TreeSketch] that the file tells: all
## others stay as they are.
signal loaded(sketch: TreeSketch, told: PackedStringArray)
## A sentence for the user, and the color of the theme that it has.
signal said(sentence: String, color: StringName)

const Session := preload("../session.gd")
const Jobs := preload("../jobs.gd")

var _session: Session


func _init(session: Session) -> void:
	set_translation_domain(session.get_translation_domain())
	_session = session


## Reads strokes, on a thread: a drawing is thinned first.
func read(path: String) -> void:
	var worker: TreeReconstructor = TreeReconstructor.new()
	_session.jobs.start(
		tr("Reading %s") % path.get_file(), _read.bind(worker, path), _on_read.bind(worker, path)
	)


## Writes strokes.
func write(sketch: TreeSketch, path: String) -> void:
	var worker: TreeReconstructor = TreeReconstructor.new()
	if worker.save_sketch(sketch, path) != OK:
		_fail(worker)
		return
	said.emit(tr("The strokes were saved as %s.") % path, &"font_color")


static func _read(_running: Jobs.Job, worker: TreeReconstructor, path: String) -> TreeSketch:
	return worker.load_sketch(path)


func _on_read(
	sketch: TreeSketch, _ended: Jobs.Job, worker: TreeReconstructor, path: String
) -> void:
	if sketch == null:
		_fail(worker)
		return
	var told: PackedStringArray = ["canvas_size", "strokes"]
	# A drawing tells no more than its lines.
	if _is_json(path):
		told.append_array(["species", "height", "seed", "twigs", "leaf_rule"])
		told.append_array(["depth", "crown", "trunk_radius", "density"])
	loaded.emit(sketch, told)


# As the library tells it, by what the file begins with: its name may be any.
static func _is_json(path: String) -> bool:
	var file: FileAccess = FileAccess.open(path, FileAccess.READ)
	if file == null:
		return false
	# After the mark of UTF-8, and blanks.
	var first: int = file.get_8()
	if first == 0xEF:
		file.seek(3)
		first = file.get_8()
	while first in [0x20, 0x09, 0x0A, 0x0D] and not file.eof_reached():
		first = file.get_8()
	return first == 0x7B


func _fail(worker: TreeReconstructor) -> void:
	var sentence: String = worker.get_error_message()
	_session.say(sentence, Session.Kind.ERROR)
	said.emit(Session.Sentences.translate(sentence, get_translation_domain()), &"error_color")
