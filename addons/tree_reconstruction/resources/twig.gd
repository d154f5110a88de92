@tool
@icon("../icons/Twig.svg")
class_name Twig
extends Resource
## A branch to graft onto trees: its wood as an L-string, with a name and a picture for a list.
##
## [TwigLibrary] holds the ones that ship with the addon. Make others of any branch of a tree with
## [method from_branch], or write an L-string. [codeblock]
## tree.graft(node, {"string": twig.get_string(), "seed": 5})
## [/codeblock]

const _HEADING: String = "# L-string;"

## The name in a list.
@export var title: String = "":
	set(value):
		title = value
		emit_changed()

## What is special about it, in a line.
@export var description: String = "":
	set(value):
		description = value
		emit_changed()

## Its wood: metres and degrees, relative to the branch that it is grafted onto.
@export_multiline var lstring: String = "":
	set(value):
		lstring = value
		_measures = {}
		emit_changed()

## How [member lstring] is read: as its first line says, or else as a turtle's, or in a dialect
## whatever it says. [method get_string] has it in its first line.
@export var dialect: LSystem.Dialect = LSystem.DIALECT_TOLD:
	set(value):
		dialect = value
		_measures = {}
		emit_changed()

## A picture for a list. [method draw_thumbnail] makes one.
@export var thumbnail: Texture2D:
	set(value):
		thumbnail = value
		emit_changed()

## The longest way from its base to a tip, in metres; 0 while [member lstring] is no branch.
var length: float:
	get:
		return _measure().get("length", 0.0)

## Its radius at the base, in metres; 0 while [member lstring] is no branch.
var base_radius: float:
	get:
		return _measure().get("base_radius", 0.0)

var _measures: Dictionary = {}


## A copy of the branch that begins at node [param id] of [param tree], with a picture.
static func from_branch(tree: TreeReconstruction, id: int, called: String = "") -> Twig:
	var twig: Twig = Twig.new()
	twig.title = called
	if tree == null:
		push_error("There is no tree to take a branch of.")
		return twig
	twig.lstring = tree.take_branch(id)
	if not twig.lstring.is_empty():
		twig.draw_thumbnail()
	return twig


## [member lstring] with a first line that says its [member dialect], where that is told.
func get_string() -> String:
	if dialect == LSystem.DIALECT_TOLD or lstring.is_empty():
		return lstring
	var word: String = " dialect " + ("paper" if dialect == LSystem.DIALECT_PAPER else "turtle")
	if not lstring.begins_with(_HEADING):
		return "%s%s\n%s" % [_HEADING, word, lstring]
	# Of two words in a line the later one is heard.
	var end: int = lstring.find("\n")
	return lstring.insert(lstring.length() if end < 0 else end, word)


## Makes [member thumbnail] anew from [member lstring], [param size] pixels wide and high.
func draw_thumbnail(size: int = 128) -> void:
	var pixels: PackedByteArray = TreeReconstruction.draw_branch(lstring, size, dialect)
	if pixels.is_empty():
		thumbnail = null
		return
	var image: Image = Image.create_from_data(size, size, false, Image.FORMAT_RGBA8, pixels)
	thumbnail = ImageTexture.create_from_image(image)


func _measure() -> Dictionary:
	if _measures.is_empty() and not lstring.is_empty():
		_measures = TreeReconstruction.measure_branch(lstring, dialect)
	return _measures
