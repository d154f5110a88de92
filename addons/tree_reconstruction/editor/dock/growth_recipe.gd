@tool
extends RefCounted
## A recipe of growth (see [method TreeReconstructor.grow_bark]) as lines that can be edited one by
## one.


## A command of the recipe. What is no command, such as a remark, stays as it is.
class Line:
	extends RefCounted

	var command: String
	## What is given, by names, in its order; as it is written, with quotes where it has them.
	var values: Dictionary[String, String] = {}

	func _init(text: String) -> void:
		var words: PackedStringArray = _split(text.strip_edges())
		if text.strip_edges().begins_with("#") or words.is_empty():
			command = text
			return
		command = words[0]
		for word: String in words.slice(1):
			values[word.get_slice("=", 0)] = word.substr(word.find("=") + 1)

	func get_text() -> String:
		var text: String = command
		for key: String in values:
			text += " %s=%s" % [key, values[key]]
		return text

	## What is given, without its quotes; empty where it is not.
	func get_word(name: String) -> String:
		var word: String = values.get(name, "")
		if word.length() < 2 or not word.begins_with('"'):
			return word
		return word.substr(1, word.length() - 2).replace('""', '"')

	## Gives a word, with quotes where it needs them.
	func set_word(name: String, word: String) -> void:
		var plain: bool = not word.is_empty()
		for mark: String in [" ", '"', "#", "\t", "\n"]:
			plain = plain and mark not in word
		values[name] = word if plain else '"%s"' % word.replace('"', '""').replace("\n", " ")

	# A value between quotes may have blanks.
	static func _split(text: String) -> PackedStringArray:
		var words: PackedStringArray = []
		var inside: bool = false
		for part: String in text.split(" "):
			if inside:
				words[-1] += " " + part
			elif not part.is_empty():
				words.append(part)
			if part.count('"') % 2 == 1:
				inside = not inside
		return words


# What is about the whole surface.
const _WHOLE: PackedStringArray = ["edges", "steps", "grain", "section", "seed", "fuse", "cuts"]

var lines: Array[Line] = []


func _init(text: String = "") -> void:
	for line: String in text.split("\n", false):
		if not line.strip_edges().is_empty():
			lines.append(Line.new(line))


func get_text() -> String:
	var text: String = ""
	for line: Line in lines:
		text += line.get_text() + "\n"
	return text


## The first line of a command; it is made where there is none and it is [param wanted].
func find(command: String, wanted: bool = false) -> Line:
	for line: Line in lines:
		if line.command == command:
			return line
	if not wanted:
		return null
	var made: Line = Line.new(command)
	lines.insert(0, made)
	return made


## The lines that say what grows where, such as burls: all but those about the whole surface and the
## outlines of the wood beneath, of which there may be very many.
func get_features() -> Array[Line]:
	return lines.filter(
		func(line: Line) -> bool:
			return line.command not in _WHOLE and not line.command.strip_edges().begins_with("#")
	)


## A number as recipes have it.
static func written(value: float) -> String:
	return String.num(value, 3)
