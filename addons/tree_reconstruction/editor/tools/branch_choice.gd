@tool
extends OptionButton
## The branches that the Graft tool offers: those that were picked, some of the tree's own, the
## addon's twigs, and an L-string that the user writes.

const Session := preload("../session.gd")

const _ICON_WIDTH: int = 32
const _ICON_DRAWN: int = 64
# Of the tree's own branches these are offered: their ranks by their number of nodes.
const _RANKS: PackedFloat32Array = [0.4, 0.65, 0.85, 0.97]
const _LEAST_NODES: int = 3
# An edit's log keeps the branch as text.
const _MOST_NODES: int = 300

var _session: Session
var _magnified: float
var _library: TwigLibrary
# What was grafted when this was looked at last.
var _seen: String
# Of the tree's own: what they are of, and the branches.
var _own_of: Array = []
var _own: Array[Twig] = []
# By L-string: the pictures of what was picked.
var _drawn: Dictionary[String, Texture2D] = {}


func _init(session: Session, library: TwigLibrary, magnified: float) -> void:
	set_translation_domain(session.get_translation_domain())
	_session = session
	_library = library
	_magnified = magnified
	auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
	add_theme_constant_override(&"icon_max_width", int(_ICON_WIDTH * magnified))
	fit_to_longest_item = false
	get_popup().about_to_popup.connect(refresh)
	_seen = session.scion
	_fill()


## Offers the branches of the tree as it is now. It goes through all of the wood, so that is done
## when somebody looks.
func refresh() -> void:
	var of: Array = []
	if _session.tree != null:
		of = [_session.tree.get_instance_id(), _session.tree.get_bark_revision()]
	if of != _own_of:
		_own_of = of
		_own = _find_own()
	_fill()


## Shows what is grafted now, which others choose, too.
func update() -> void:
	if _session.scion == _seen:
		return
	_seen = _session.scion
	for item: int in item_count:
		if get_item_metadata(item) == _session.scion:
			select(item)
			return
	_fill()


## What the chosen item grafts, empty for an L-string that is still to be written.
func get_scion() -> String:
	var scion: Variant = get_selected_metadata()
	return scion if scion is String else ""


## Whether the user wants to write an L-string.
func is_written() -> bool:
	return selected == item_count - 1


func _fill() -> void:
	var written: bool = item_count > 0 and is_written()
	clear()
	_add_heading(tr("Picked branch"))
	var known: PackedStringArray = _session.picked
	if (
		not written
		and not _session.scion.is_empty()
		and not _session.scion.begins_with("twig=")
		and _session.scion not in known
		and not _own.any(func(twig: Twig) -> bool: return twig.lstring == _session.scion)
	):
		known = PackedStringArray([_session.scion]) + known
	for lstring: String in known:
		_add(_describe(lstring), _picture_of(lstring), lstring, tr("A branch that was picked."))
	if known.is_empty():
		add_item(tr("None yet"))
		set_item_disabled(item_count - 1, true)
		set_item_tooltip(
			item_count - 1, tr("Take the Pick tool and click the branch that you want.")
		)
	if not _own.is_empty():
		_add_heading(tr("Of this tree"))
		for twig: Twig in _own:
			_add(_describe(twig.lstring), twig.thumbnail, twig.lstring, twig.description)
	_add_heading(tr("Library"))
	var domain: StringName = get_translation_domain()
	for twig: Twig in _library.twigs:
		_add(
			Session.Sentences.translate(twig.title, domain),
			twig.thumbnail,
			"twig=%s" % twig.resource_name,
			Session.Sentences.translate(twig.description, domain)
		)
	add_separator()
	add_item(tr("L-string"))
	set_item_tooltip(item_count - 1, tr("A branch that you write yourself."))
	if written:
		select(item_count - 1)
		return
	for item: int in item_count:
		if get_item_metadata(item) == _session.scion and not _session.scion.is_empty():
			select(item)
			return
	select(-1)


func _add_heading(text: String) -> void:
	add_separator(text)


func _add(text: String, picture: Texture2D, scion: String, tooltip: String) -> void:
	add_icon_item(picture, text)
	var item: int = item_count - 1
	get_popup().set_item_icon_max_width(item, int(_ICON_WIDTH * _magnified))
	set_item_metadata(item, scion)
	set_item_tooltip(item, tooltip)


func _describe(lstring: String) -> String:
	var measures: Dictionary = TreeReconstruction.measure_branch(lstring)
	if measures.is_empty():
		return tr("L-string")
	return tr("%.2f m, %d nodes") % [measures["length"], measures["node_count"]]


func _picture_of(lstring: String) -> Texture2D:
	if not _drawn.has(lstring):
		var pixels: PackedByteArray = TreeReconstruction.draw_branch(lstring, _ICON_DRAWN)
		if pixels.is_empty():
			return null
		_drawn[lstring] = ImageTexture.create_from_image(
			Image.create_from_data(_ICON_DRAWN, _ICON_DRAWN, false, Image.FORMAT_RGBA8, pixels)
		)
	return _drawn[lstring]


# Branches of the tree from small to large, no two of one size.
func _find_own() -> Array[Twig]:
	var found: Array[Twig] = []
	if _session.tree == null or _session.tree.is_empty():
		return found
	var tree: TreeReconstruction = _session.tree
	# Where a branch leaves another one, by the number of nodes of it.
	var by_count: Dictionary[int, int] = {}
	var counts: Dictionary[int, int] = _count_nodes(tree)
	for id: int in tree.select_nodes("order:1..&!guesses"):
		var count: int = counts[id]
		if count < _LEAST_NODES or count > _MOST_NODES or by_count.has(count):
			continue
		if tree.get_node_order(id) > tree.get_node_order(tree.get_node_parent(id)):
			by_count[count] = id
	var sizes: Array[int] = by_count.keys()
	sizes.sort()
	var last: int = -1
	for rank: float in _RANKS:
		if sizes.is_empty():
			break
		var at: int = mini(int(rank * sizes.size()), sizes.size() - 1)
		if at == last:
			continue
		last = at
		var id: int = by_count[sizes[at]]
		var twig: Twig = Twig.new()
		twig.lstring = tree.take_branch(id)
		twig.description = tr("The tree's own branch at node %d.") % id
		twig.draw_thumbnail(_ICON_DRAWN)
		found.append(twig)
	return found


# By node: how many nodes its branch has, with its own.
static func _count_nodes(tree: TreeReconstruction) -> Dictionary[int, int]:
	var order: PackedInt32Array = [tree.get_root()]
	var at: int = 0
	while at < order.size():
		order.append_array(tree.get_node_children(order[at]))
		at += 1
	var counts: Dictionary[int, int] = {}
	for i: int in range(order.size() - 1, -1, -1):
		var id: int = order[i]
		counts[id] = counts.get(id, 0) + 1
		if i > 0:
			var parent: int = tree.get_node_parent(id)
			counts[parent] = counts.get(parent, 0) + counts[id]
	return counts
