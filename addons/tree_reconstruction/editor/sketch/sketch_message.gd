@tool
extends Label
## What there is to say of a sketch, below its paper.

const Widgets := preload("../dock/widgets.gd")
const Known := preload("sketch_known.gd")


func _init() -> void:
	auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
	autowrap_mode = TextServer.AUTOWRAP_WORD_SMART
	size_flags_horizontal = Control.SIZE_EXPAND_FILL
	custom_minimum_size.x = Widgets.px(60)


## What holds it: sentences of any length leave the window as large as it is.
func framed() -> ScrollContainer:
	var scroll: ScrollContainer = ScrollContainer.new()
	scroll.horizontal_scroll_mode = ScrollContainer.SCROLL_MODE_DISABLED
	scroll.custom_minimum_size.y = Widgets.px(44)
	scroll.add_child(self)
	return scroll


## Says what is known of a sketch.
func tell(known: Known, sketch: TreeSketch) -> void:
	var faults: PackedStringArray = known.get_faults(sketch)
	var sentence: String = known.get_sentence(sketch)
	if not faults.is_empty():
		say("\n".join(faults), &"error_color")
	elif not sentence.is_empty():
		say(sentence, &"font_color")
	elif sketch.strokes.is_empty():
		say("", &"font_color")
	else:
		var words: String = tr(
			"Green is the crown's outline, brown the trunk, light brown a branch; red isn't understood."
		)
		say("\n".join(known.get_remarks(sketch) + PackedStringArray([words])), &"font_color")


## Says a sentence, in a color of the theme.
func say(sentence: String, color: StringName) -> void:
	text = sentence
	if color == &"font_color":
		remove_theme_color_override(&"font_color")
	else:
		add_theme_color_override(
			&"font_color", get_theme_color(color, &"Editor") if is_inside_tree() else Color.RED
		)
