@tool
extends VBoxContainer
## What else decides a sketched tree: its species, height, density and seed, and what the selected
## stroke is.

## A value of the sketch was chosen: a property of [TreeSketch]. With [param merged], more of it may
## follow soon, as while a number is turned.
signal value_chosen(title: String, property: StringName, value: Variant, merged: bool)
## The selected stroke was said to be something: a [enum TreeSketch.Role].
signal role_chosen(role: int)

const Widgets := preload("../dock/widgets.gd")
const Session := preload("../session.gd")
const Twigs := preload("sketch_twigs.gd")
const More := preload("sketch_more.gd")

# What says that the twigs stay those that the sketch has.
const _OWN: StringName = &"own"

var species: OptionButton
var height: SpinBox
var density: SpinBox
var seed_field: SpinBox
var dice: Button
var role: OptionButton
var more: More = More.new()
## Whose twigs there are beside the species'.
var twigs: Twigs

var _shown: TreeSketch = TreeSketch.new()
# Of each species, its usual height in metres.
var _heights: Dictionary[String, float] = {}
var _usual: Label


func _init(session: Session) -> void:
	twigs = Twigs.new(session)
	_add_species()
	height = Widgets.number(0.0, 40.0, 0.1, "m")
	height.allow_greater = true
	density = Widgets.number(0.0, 4.0, 0.05)
	seed_field = Widgets.number(0.0, 1_000_000.0, 1.0)
	seed_field.allow_greater = true
	add_child(Widgets.line("Height", "How tall the tree is. 0 is usual for the species.", height))
	_usual = Widgets.figure("The height that the tree gets by its species.")
	add_child(_usual)
	add_child(
		Widgets.line(
			"Density", "How many twigs the crown has: 1 is usual, 2 twice as many.", density
		)
	)
	var line: HBoxContainer = Widgets.line(
		"Seed",
		"Decides everything random: the same strokes and seed give the same tree.",
		seed_field
	)
	dice = (
		Widgets
		. button(
			"",
			"Tries another seed: other twigs and other branches in front and behind. The strokes stay true.",
			&"RandomNumberGenerator"
		)
	)
	line.add_child(dice)
	add_child(line)
	add_child(more)
	more.value_chosen.connect(value_chosen.emit)
	add_child(HSeparator.new())
	role = (Widgets.choice(
		["Auto", "Outline", "Trunk", "Branch"],
		[
			TreeSketch.ROLE_AUTO,
			TreeSketch.ROLE_OUTLINE,
			TreeSketch.ROLE_TRUNK,
			TreeSketch.ROLE_BRANCH
		]
	))
	add_child(
		(
			Widgets
			. line(
				"Stroke role",
				(
					"What the selected stroke is, where it was taken for something else. Click on a stroke"
					+ " to select it."
				),
				role
			)
		)
	)
	species.item_selected.connect(_on_species)
	height.value_changed.connect(_on_number.bind(tr("Change Sketch Height"), &"height"))
	density.value_changed.connect(_on_number.bind(tr("Change Sketch Density"), &"density"))
	seed_field.value_changed.connect(_on_number.bind(tr("Change Sketch Seed"), &"seed"))
	dice.pressed.connect(_on_dice)
	role.item_selected.connect(_on_role)


## Shows the values of a sketch and the role of its selected stroke, by its id, or 0.
func show_sketch(sketch: TreeSketch, selected: int) -> void:
	_shown = sketch
	_choose_species()
	more.show_sketch(sketch)
	height.set_value_no_signal(sketch.height)
	density.set_value_no_signal(sketch.density)
	seed_field.set_value_no_signal(sketch.seed)
	var named: String = "maple" if sketch.species.is_empty() else sketch.species
	var usual: float = twigs.get_height_of(sketch)
	if usual <= 0.0:
		usual = _heights.get(named, 0.0)
	_usual.visible = sketch.height <= 0.0 and usual > 0.0
	_usual.text = tr("usually %s m") % String.num(usual, 1)
	var index: int = sketch.find_stroke(selected)
	role.disabled = index < 0
	Widgets.choose(role, TreeSketch.ROLE_AUTO if index < 0 else int(sketch.strokes[index]["role"]))


## What the species of a sketch is called.
func get_title_of(sketch: TreeSketch) -> String:
	if sketch.twigs != "":
		return twigs.get_title_of(sketch)
	for i: int in species.item_count:
		if species.get_item_metadata(i) == (sketch.species if sketch.species != "" else "maple"):
			return species.get_item_text(i)
	return sketch.species.capitalize()


func _add_species() -> void:
	var titles: PackedStringArray = []
	var names: Array = []
	for known: Dictionary in TreeReconstructor.get_sketch_species():
		titles.append(known["title"] if known["title"] != "" else known["name"].capitalize())
		names.append(known["name"])
		_heights[known["name"]] = known["height"]
	species = Widgets.choice(titles, names)
	species.get_popup().about_to_popup.connect(list_twigs)
	add_child(
		Widgets.line(
			"Species",
			(
				"Whose twigs, leaves and bark the tree gets: a species', those of another tree in"
				+ " the scene, or twigs that you keep in a library. The strokes stay."
			),
			species
		)
	)


## Shows whose twigs there are now.
func list_twigs() -> void:
	_drop_twigs()
	if _shown.twigs != "":
		_add_twigs(twigs.get_title_of(_shown), _OWN)
	var sources: Dictionary[String, Variant] = twigs.get_sources(_shown)
	for name: String in sources:
		_add_twigs(tr("Twigs of %s") % name, [name, sources[name]])
	_choose_species()


# Below the species, which stay.
func _add_twigs(words: String, of: Variant) -> void:
	if species.item_count == _heights.size():
		species.add_separator()
	species.add_item(words)
	species.set_item_metadata(species.item_count - 1, of)


func _drop_twigs() -> void:
	while species.item_count > _heights.size():
		species.remove_item(species.item_count - 1)


func _choose_species() -> void:
	if _shown.twigs == "":
		# One that isn't known here stays unchosen.
		Widgets.choose(species, "maple" if _shown.species.is_empty() else _shown.species)
		return
	Widgets.choose(species, _OWN)
	if species.selected < 0:
		_drop_twigs()
		_add_twigs(twigs.get_title_of(_shown), _OWN)
		Widgets.choose(species, _OWN)
	species.set_item_text(species.selected, twigs.get_title_of(_shown))


func _on_species(_index: int) -> void:
	var chosen: Variant = species.get_selected_metadata()
	if chosen is Array:
		# It is chosen once they are there.
		_choose_species()
		twigs.take(_shown, chosen[0], chosen[1])
	elif chosen is String:
		twigs.take_species(chosen)


func _on_number(value: float, title: String, property: StringName) -> void:
	var given: Variant = int(value) if property == &"seed" else value
	value_chosen.emit(title, property, given, true)


func _on_dice() -> void:
	value_chosen.emit(tr("Change Sketch Seed"), &"seed", randi_range(1, 999_999), false)


func _on_role(_index: int) -> void:
	role_chosen.emit(int(role.get_selected_metadata()))
