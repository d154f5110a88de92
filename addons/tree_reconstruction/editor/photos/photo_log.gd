@tool
extends RefCounted
## Follows what COLMAP says, in the file that it is all kept in.

# What is kept to be shown.
const _MOST_LINES: int = 400

## The lines, the last ones.
var lines: PackedStringArray = []
## How many features each photo has, as far as they are told.
var features: Dictionary[String, int] = {}

var _path: String
var _read: int = 0
var _rest: PackedByteArray = []
var _photo: String = ""


func _init(path: String) -> void:
	_path = path


## Reads what has come. Returns whether there was anything.
func update() -> bool:
	var file: FileAccess = FileAccess.open(_path, FileAccess.READ)
	if file == null or file.get_length() == _read:
		return false
	if file.get_length() < _read:
		# Somebody has begun it anew.
		_read = 0
		_rest.clear()
	file.seek(_read)
	var bytes: PackedByteArray = _rest + file.get_buffer(file.get_length() - _read)
	_read = file.get_length()
	# A line may be half written, and a letter of it.
	var end: int = bytes.rfind(10) + 1
	_rest = bytes.slice(end)
	for line: String in bytes.slice(0, end).get_string_from_utf8().split("\n", false):
		_take(line.strip_edges(false))
	if lines.size() > _MOST_LINES:
		lines = lines.slice(lines.size() - _MOST_LINES)
	return true


func _take(line: String) -> void:
	lines.append(line)
	var name: String = _after(line, "Name:")
	if not name.is_empty():
		_photo = name
	var count: String = _after(line, "Features:")
	if not _photo.is_empty() and not count.is_empty():
		features[_photo] = count.to_int()
		_photo = ""


static func _after(line: String, word: String) -> String:
	var at: int = line.find(word)
	return "" if at < 0 else line.substr(at + word.length()).strip_edges()
