extends RefCounted
## Puts words on a picture: a step's number, a title and a line below it.

const NIGHT: Color = Color("10222e")
const GREEN: Color = Color("25503f")
const LEAF: Color = Color("c4e260")
const _BAND: float = 236.0
const _HEAD: float = 132.0
const _MARGIN: float = 56.0


## The picture with a darkened foot that the words stand on.
static func at_foot(
	tree: SceneTree, picture: Image, number: String, title: String, text: String
) -> Image:
	var size: Vector2 = picture.get_size()
	var page: Control = _page(size)
	page.add_child(_placed(picture, Rect2(Vector2.ZERO, size)))
	var dark: GradientTexture2D = _shade(
		Color(0.02, 0.05, 0.06, 0.0), Color(0.02, 0.05, 0.06, 0.86)
	)
	page.add_child(_texture(dark, Rect2(0.0, size.y - _BAND, size.x, _BAND)))
	_write(page, Vector2(_MARGIN, size.y - 122.0), number, title, text)
	return await _draw(tree, page)


## The picture below words: nothing of it is hidden.
static func at_head(
	tree: SceneTree, picture: Image, number: String, title: String, text: String
) -> Image:
	var size: Vector2 = Vector2(1600.0, 900.0)
	var page: Control = _page(size)
	page.add_child(_texture(_shade(NIGHT, GREEN), Rect2(Vector2.ZERO, size)))
	var room: Vector2 = size - Vector2(0.0, _HEAD)
	var shown: Vector2 = picture.get_size()
	shown *= minf(room.x / shown.x, room.y / shown.y)
	var corner: Vector2 = Vector2(0.0, _HEAD) + (room - shown) * 0.5
	page.add_child(_placed(picture, Rect2(corner, shown)))
	_write(page, Vector2(_MARGIN, 18.0), number, title, text)
	return await _draw(tree, page)


## Pictures of equal height beside each other, each with a word.
static func beside(tree: SceneTree, pictures: Array[Image], words: PackedStringArray) -> Image:
	const GAP: float = 6.0
	var high: float = pictures[0].get_height()
	var wide: float = -GAP
	for picture: Image in pictures:
		wide += picture.get_width() * high / picture.get_height() + GAP
	var page: Control = _page(Vector2(ceilf(wide), high))
	var x: float = 0.0
	for i: int in pictures.size():
		var part: float = pictures[i].get_width() * high / pictures[i].get_height()
		page.add_child(_placed(pictures[i], Rect2(x, 0.0, part, high)))
		var dark: GradientTexture2D = _shade(
			Color(0.02, 0.05, 0.06, 0.0), Color(0.02, 0.05, 0.06, 0.8)
		)
		page.add_child(_texture(dark, Rect2(x, high - 90.0, part, 90.0)))
		page.add_child(_label(words[i], 30, Color.WHITE, Rect2(x + 18.0, high - 56.0, part, 50.0)))
		x += part + GAP
	return await _draw(tree, page)


## Small pictures in white frames, one below the other, on the right of a large one.
static func with_insets(tree: SceneTree, picture: Image, insets: Array[Image]) -> Image:
	var size: Vector2 = picture.get_size()
	var page: Control = _page(size)
	page.add_child(_placed(picture, Rect2(Vector2.ZERO, size)))
	var y: float = 40.0
	for inset: Image in insets:
		var small: Vector2 = inset.get_size()
		var where: Rect2 = Rect2(Vector2(size.x - small.x - 44.0, y), small)
		var frame: ColorRect = ColorRect.new()
		frame.color = Color.WHITE
		frame.position = where.grow(4.0).position
		frame.size = where.grow(4.0).size
		page.add_child(frame)
		page.add_child(_placed(inset, where))
		y += small.y + 28.0
	return await _draw(tree, page)


## The icon, and words at its right.
static func card(tree: SceneTree, size: Vector2, icon: Image, title: String, text: String) -> Image:
	var page: Control = _page(size)
	page.add_child(_texture(_shade(NIGHT, GREEN), Rect2(Vector2.ZERO, size)))
	var high: float = 0.4 * size.y
	var at: Vector2 = Vector2(0.12 * size.x, 0.5 * (size.y - high))
	page.add_child(_placed(icon, Rect2(at, Vector2.ONE * high)))
	var x: float = at.x + high + 56.0
	page.add_child(_label(title, 62, Color.WHITE, Rect2(x, 0.5 * size.y - 78.0, size.x, 80.0)))
	page.add_child(_label(text, 34, LEAF, Rect2(x, 0.5 * size.y + 14.0, size.x, 50.0)))
	return await _draw(tree, page)


static func _write(page: Control, at: Vector2, number: String, title: String, text: String) -> void:
	var x: float = at.x
	if not number.is_empty():
		var disc: Panel = Panel.new()
		var style: StyleBoxFlat = StyleBoxFlat.new()
		style.bg_color = LEAF
		style.set_corner_radius_all(46)
		style.corner_detail = 20
		style.anti_aliasing_size = 1.5
		disc.add_theme_stylebox_override(&"panel", style)
		disc.position = at + Vector2(0.0, 4.0)
		disc.size = Vector2(92.0, 92.0)
		page.add_child(disc)
		var figure: Label = _label(number, 56, NIGHT, Rect2(disc.position, disc.size))
		figure.horizontal_alignment = HORIZONTAL_ALIGNMENT_CENTER
		figure.vertical_alignment = VERTICAL_ALIGNMENT_CENTER
		page.add_child(figure)
		x += 122.0
	page.add_child(_label(title, 50, Color.WHITE, Rect2(x, at.y - 10.0, 1400.0, 64.0)))
	page.add_child(_label(text, 30, Color("d6e6dc"), Rect2(x, at.y + 56.0, 1400.0, 44.0)))


static func _page(size: Vector2) -> Control:
	var page: Control = Control.new()
	page.size = size
	return page


static func _placed(picture: Image, where: Rect2) -> TextureRect:
	var smooth: Image = picture.duplicate() as Image
	if smooth.is_compressed():
		smooth.decompress()
	var small: Vector2i = where.size.round()
	if small != smooth.get_size():
		smooth.resize(small.x, small.y, Image.INTERPOLATE_LANCZOS)
	return _texture(ImageTexture.create_from_image(smooth), where)


static func _texture(texture: Texture2D, where: Rect2) -> TextureRect:
	var shown: TextureRect = TextureRect.new()
	shown.texture = texture
	shown.expand_mode = TextureRect.EXPAND_IGNORE_SIZE
	shown.position = where.position
	shown.size = where.size
	return shown


static func _shade(from: Color, to: Color) -> GradientTexture2D:
	var shade: GradientTexture2D = GradientTexture2D.new()
	shade.gradient = Gradient.new()
	shade.gradient.set_color(0, from)
	shade.gradient.set_color(1, to)
	shade.fill_to = Vector2(0.0, 1.0)
	return shade


static func _label(text: String, size: int, color: Color, where: Rect2) -> Label:
	var label: Label = Label.new()
	label.text = text
	label.add_theme_font_size_override(&"font_size", size)
	label.add_theme_color_override(&"font_color", color)
	label.position = where.position
	label.size = where.size
	return label


static func _draw(tree: SceneTree, page: Control) -> Image:
	var viewport: SubViewport = SubViewport.new()
	viewport.size = Vector2i(page.size)
	viewport.disable_3d = true
	viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	viewport.add_child(page)
	tree.root.add_child(viewport)
	for frame: int in 3:
		await RenderingServer.frame_post_draw
	var drawn: Image = viewport.get_texture().get_image()
	viewport.queue_free()
	return drawn
