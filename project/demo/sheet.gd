extends RefCounted
## The preview's page: a heading above rows of pictures with captions.

const FRAME: Shader = preload("./frame.gdshader")

const _MARGIN: int = 26
const _GAP: int = 12
const _HEADING: int = 92
const _PAPER: Color = Color("f4f3f0")
const _INK: Color = Color("2b2f33")
const _PALE_INK: Color = Color("6b7177")

var viewport: SubViewport = SubViewport.new()
var _page: Control = Control.new()
var _y: int = _MARGIN + _HEADING


func _init(width: int) -> void:
	viewport.size = Vector2i(width, 100)
	viewport.disable_3d = true
	viewport.render_target_update_mode = SubViewport.UPDATE_ONCE
	viewport.render_target_clear_mode = SubViewport.CLEAR_MODE_ONCE
	var paper: ColorRect = ColorRect.new()
	paper.color = _PAPER
	paper.set_anchors_preset(Control.PRESET_FULL_RECT)
	viewport.add_child(paper)
	viewport.add_child(_page)


## The widths of `count` pictures that fill a row.
func cell_width(count: int) -> int:
	@warning_ignore("integer_division")
	return (viewport.size.x - 2 * _MARGIN - (count - 1) * _GAP) / count


## A name in large letters, figures below it.
func set_heading(title: String, figures: String) -> void:
	_label(title, 36, _INK, Vector2(_MARGIN, _MARGIN - 14), 800.0)
	_label(figures, 19, _PALE_INK, Vector2(_MARGIN, _MARGIN + 36), viewport.size.x - 2.0 * _MARGIN)


## Adds a row of pictures `height` pixels high. Each cell: [SubViewport, caption, second line].
func add_row(cells: Array[Array], height: int) -> void:
	var width: int = cell_width(cells.size())
	for i: int in cells.size():
		var source: SubViewport = cells[i][0]
		var at: Vector2 = Vector2(_MARGIN + i * (width + _GAP), _y)
		viewport.add_child(source)
		var picture: TextureRect = TextureRect.new()
		picture.texture = source.get_texture()
		picture.expand_mode = TextureRect.EXPAND_IGNORE_SIZE
		picture.texture_filter = CanvasItem.TEXTURE_FILTER_LINEAR
		picture.position = at
		picture.size = Vector2(width, height)
		var frame: ShaderMaterial = ShaderMaterial.new()
		frame.shader = FRAME
		frame.set_shader_parameter(&"size", picture.size)
		picture.material = frame
		_page.add_child(picture)
		_label(cells[i][1], 21, _INK, at + Vector2(16.0, 10.0), width - 32.0)
		_label(cells[i][2], 16, _PALE_INK, at + Vector2(16.0, 38.0), width - 32.0)
	_y += height + _GAP
	viewport.size.y = _y - _GAP + _MARGIN


func _label(text: String, font_size: int, color: Color, at: Vector2, width: float) -> void:
	var label: Label = Label.new()
	label.text = text
	label.position = at
	label.size.x = width
	label.clip_text = true
	label.text_overrun_behavior = TextServer.OVERRUN_TRIM_ELLIPSIS
	label.add_theme_font_size_override(&"font_size", font_size)
	label.add_theme_color_override(&"font_color", color)
	_page.add_child(label)
