@tool
extends RefCounted
## Icons for controls: those of the theme, and our own pictures, which are drawn here at the
## editor's scale and in colours for its theme. They need not be imported before, which they are
## not when a project is opened for the first time.

# The palette of the editor's icons on dark grounds, and what stands for it on bright ones.
const _ON_BRIGHT: Dictionary[String, String] = {
	"#e0e0e0": "#4f4f4f",
	"#8eef97": "#2f9e44",
	"#ff7070": "#cc2f2f",
	"#fc7f7f": "#cc3b3b",
	"#ffca5f": "#a87000",
	"#5fb2ff": "#1a6fc4",
}


## The icon of a name in the editor's theme, or of an SVG file. Where there is none, it is
## [code]null[/code].
static func find(control: Control, icon_name: String) -> Texture2D:
	if not icon_name.begins_with("res://"):
		return control.get_theme_icon(icon_name, &"EditorIcons")
	var drawing: String = FileAccess.get_file_as_string(icon_name)
	if control.get_theme_color(&"font_color", &"Label").get_luminance() < 0.5:
		for color: String in _ON_BRIGHT:
			drawing = drawing.replace(color, _ON_BRIGHT[color])
	var picture: Image = Image.new()
	var scale: float = EditorInterface.get_editor_scale() if Engine.is_editor_hint() else 1.0
	if drawing.is_empty() or picture.load_svg_from_string(drawing, scale) != OK:
		return null
	return ImageTexture.create_from_image(picture)
