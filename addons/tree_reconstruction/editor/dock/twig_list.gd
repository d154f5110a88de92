@tool
extends ItemList
## Pictures of twigs that can be dragged into the viewport.

const Widgets := preload("widgets.gd")
## What a drag of one says that it is.
const DRAG: String = "treerec_twig"


func _init() -> void:
	icon_mode = ItemList.ICON_MODE_TOP
	max_columns = 0
	same_column_width = true
	fixed_column_width = Widgets.px(62)
	fixed_icon_size = Vector2i.ONE * Widgets.px(56)
	auto_height = true
	auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED


## What grafts [param twig]: the words for one of the addon's, or the L-string of another.
static func scion_of(twig: Twig) -> String:
	return twig.get_string() if twig.resource_name.is_empty() else "twig=" + twig.resource_name


func _get_drag_data(at: Vector2) -> Variant:
	var item: int = get_item_at_position(at, true)
	if item < 0:
		return null
	var twig: Twig = get_item_metadata(item)
	var picture: TextureRect = TextureRect.new()
	picture.texture = twig.thumbnail
	picture.expand_mode = TextureRect.EXPAND_IGNORE_SIZE
	picture.size = Vector2.ONE * Widgets.px(64)
	set_drag_preview(picture)
	return {"type": DRAG, "twig": twig, "scion": scion_of(twig)}
