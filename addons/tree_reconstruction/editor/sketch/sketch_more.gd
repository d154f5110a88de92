@tool
extends FoldableContainer
## What few need to change of a sketched tree: how its strokes get their depth, what bounds its
## crown, and how thick its trunk is.

## A value was chosen, as of the other options.
signal value_chosen(title: String, property: StringName, value: Variant, merged: bool)

const Widgets := preload("../dock/widgets.gd")

var depth: OptionButton
var crown: OptionButton
var trunk_radius: SpinBox


func _init() -> void:
	title = "More"
	tooltip_text = "Depth, crown and trunk: what is usual suits nearly every sketch."
	folded = true
	depth = Widgets.choice(
		["True", "Paper"], [int(TreeSketch.DEPTH_TRUE), int(TreeSketch.DEPTH_PAPER)]
	)
	crown = Widgets.choice(
		["Sections", "Alpha shapes"], [int(TreeSketch.CROWN_SECTIONS), int(TreeSketch.CROWN_ALPHA)]
	)
	trunk_radius = Widgets.number(0.0, 2.0, 0.005, "m")
	trunk_radius.allow_greater = true
	var body: VBoxContainer = VBoxContainer.new()
	body.add_child(
		Widgets.line(
			"Depth",
			(
				"True keeps the front as it was drawn, and adds branches in front and behind. Paper"
				+ " turns the drawn branches about the trunk and adds none, as in the paper that"
				+ " the method is from."
			),
			depth
		)
	)
	body.add_child(
		Widgets.line(
			"Crown",
			(
				"What bounds the twigs: round sections of the outline, or alpha shapes of random"
				+ " points, which take several times longer."
			),
			crown
		)
	)
	body.add_child(
		Widgets.line(
			"Trunk",
			(
				"How thick the trunk is at its base. 0 is as drawn with two lines, or else as the"
				+ " twigs' tree has it, or a fortieth of the height."
			),
			trunk_radius
		)
	)
	add_child(body)
	depth.item_selected.connect(_on_depth)
	crown.item_selected.connect(_on_crown)
	trunk_radius.value_changed.connect(_on_trunk_radius)


## Shows the values of a sketch.
func show_sketch(sketch: TreeSketch) -> void:
	Widgets.choose(depth, int(sketch.depth))
	Widgets.choose(crown, int(sketch.crown))
	trunk_radius.set_value_no_signal(sketch.trunk_radius)


func _on_depth(_index: int) -> void:
	value_chosen.emit(tr("Change Sketch Depth"), &"depth", depth.get_selected_metadata(), false)


func _on_crown(_index: int) -> void:
	value_chosen.emit(tr("Change Sketch Crown"), &"crown", crown.get_selected_metadata(), false)


func _on_trunk_radius(value: float) -> void:
	value_chosen.emit(tr("Change Sketch Trunk Radius"), &"trunk_radius", value, true)
