@tool
extends VBoxContainer
## The fields of what a recipe of bark says of the whole surface.

## A line of the recipe was changed; [param about] tells changes that can be one step with the last.
signal changed(about: Array)

const Recipe := preload("growth_recipe.gd")
const Widgets := preload("widgets.gd")

## The longest edge, and how the grain winds.
var edge: SpinBox
var twist: SpinBox
## Whether surfaces that meet become one, and whether callus grows over cuts.
var fuse: CheckBox = CheckBox.new()
var cuts: CheckBox = CheckBox.new()
## Both, to be put where there is room.
var switches: HFlowContainer = HFlowContainer.new()

var _recipe: Recipe
var _default_of: Callable


## make_number makes the field of a command's parameter: func(command, parameter) -> SpinBox.
## default_of tells its default: func(command, parameter) -> String.
func _init(make_number: Callable, default_of: Callable) -> void:
	_default_of = default_of
	edge = make_number.call("edges", "longest")
	edge.value_changed.connect(_on_edge_changed)
	add_child(
		(
			Widgets
			. line(
				"Edge Length",
				(
					"How fine the surface is: its edges are split above this length. Half of it takes about"
					+ " eight times as long."
				),
				edge
			)
		)
	)
	twist = make_number.call("grain", "twist")
	twist.value_changed.connect(_on_twist_changed)
	add_child(
		Widgets.line(
			"Grain Twist",
			(
				"How the grain winds about trunk and branches, and the ridges on it, in radians a"
				+ " metre."
			),
			twist
		)
	)
	fuse.text = "Fuse"
	fuse.tooltip_text = (
		"Bark that meets other bark becomes one with it, instead of only looking" + " as one."
	)
	fuse.toggled.connect(_on_toggled.bind("fuse"))
	cuts.text = "Heal Cuts"
	cuts.tooltip_text = (
		"Callus grows over stubs and other ends of branches that are as thick" + " as cut ones."
	)
	cuts.toggled.connect(_on_toggled.bind("cuts"))
	switches.add_child(fuse)
	switches.add_child(cuts)


## Shows what the recipe has.
func show_recipe(recipe: Recipe) -> void:
	_recipe = recipe
	for field: Array in [[edge, "edges", "longest"], [twist, "grain", "twist"]]:
		var given: Recipe.Line = recipe.find(field[1])
		var standard: String = _default_of.call(field[1], field[2])
		var value: String = standard if given != null or field[0] == edge else "0"
		if given != null:
			value = given.values.get(field[2], standard)
		(field[0] as SpinBox).set_value_no_signal(value.to_float())
	fuse.set_pressed_no_signal(recipe.find("fuse") != null)
	cuts.set_pressed_no_signal(recipe.find("cuts") != null)


func _on_edge_changed(value: float) -> void:
	var line: Recipe.Line = _recipe.find("edges", true)
	line.values["longest"] = Recipe.written(value)
	# The shortest goes with it.
	line.values.erase("shortest")
	changed.emit(["edges"])


func _on_twist_changed(value: float) -> void:
	_recipe.find("grain", true).values["twist"] = Recipe.written(value)
	changed.emit(["grain"])


func _on_toggled(on: bool, command: String) -> void:
	if on:
		_recipe.find(command, true)
	else:
		_recipe.lines = _recipe.lines.filter(
			func(line: Recipe.Line) -> bool: return line.command != command
		)
	changed.emit([])
