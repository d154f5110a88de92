@tool
@icon("../icons/TwigLibrary.svg")
class_name TwigLibrary
extends Resource
## A collection of branches to graft.
##
## [method presets] holds those that ship with the addon. Save one of your own as a
## [code].tres[/code] file and fill it in the inspector or with [method Twig.from_branch].

const _THUMBNAIL: String = "res://addons/tree_reconstruction/presets/twigs/%s.png"

## The branches, in the order of a list.
@export var twigs: Array[Twig] = []:
	set(value):
		twigs = value
		emit_changed()


## A new collection of the twigs that ship with the addon. Their [member Resource.resource_name]s
## are those that [method TreeReconstruction.graft] knows: [code]tree.graft(node, {"twig":
## "oak"})[/code].
static func presets() -> TwigLibrary:
	var library: TwigLibrary = TwigLibrary.new()
	for entry: Dictionary in TreeReconstruction.get_twig_library():
		var twig: Twig = Twig.new()
		twig.resource_name = entry["name"]
		twig.title = (entry["name"] as String).capitalize()
		twig.description = entry["description"]
		twig.lstring = entry["lstring"]
		var path: String = _THUMBNAIL % entry["name"]
		# A game need not carry the pictures.
		if ResourceLoader.exists(path):
			twig.thumbnail = load(path) as Texture2D
		else:
			twig.draw_thumbnail()
		library.twigs.append(twig)
	return library


## The first branch with this [member Twig.title] or [member Resource.resource_name], or
## [code]null[/code].
func find(called: String) -> Twig:
	for twig: Twig in twigs:
		if twig != null and (twig.title == called or twig.resource_name == called):
			return twig
	return null


## Fills [param list] with names and pictures; each item's metadata is its [Twig].
func fill(list: ItemList) -> void:
	if list == null:
		push_error("There is no list to fill.")
		return
	list.clear()
	for twig: Twig in twigs:
		if twig == null:
			continue
		var item: int = list.add_item(twig.title, twig.thumbnail)
		list.set_item_metadata(item, twig)
		list.set_item_tooltip(
			item,
			(
				"%s\n%.2f m long, %.1f mm thick at its base"
				% [twig.description, twig.length, twig.base_radius * 2000.0]
			)
		)
