@tool
extends "section.gd"
## What a forester would measure on the tree, and the thickness of the wood at the selected node.

# What may be longer than there is room.
const _LONG: Array[StringName] = [&"orders", &"place", &"kind"]

var radius: SpinBox
var values: Dictionary[StringName, Label] = {}

var _selected: VBoxContainer = VBoxContainer.new()
# The tree and the state of its wood that the figures are of.
var _shown: Array = []


func get_id() -> StringName:
	return &"measurements"


func close() -> void:
	pass


func _build() -> void:
	title = "Measurements"
	tooltip_text = "What a forester would measure on this tree."
	_add(body, &"height", "Height", "From the tree's base to its highest tip.")
	_add(
		body,
		&"dbh",
		"Trunk (DBH)",
		"Diameter at breast height: how thick the trunk is 1.3 metres above the ground."
	)
	_add(body, &"stems", "Stems", "How many trunks stand on the same base.")
	_add(body, &"crown", "Crown width", "How wide the crown is, on average over all directions.")
	_add(body, &"crown_base", "Crown begins at", "How high above the ground the crown begins.")
	_add(body, &"length", "Length of wood", "All branches laid end to end.")
	_add(
		body,
		&"volume",
		"Volume of wood",
		"How much wood there is, trunk and branches, without leaves."
	)
	_add(body, &"nodes", "Nodes", "Points of the skeleton: what you select and move.")
	_add(body, &"tips", "Tips", "Ends of branches.")
	_add(
		body,
		&"orders",
		"Branches",
		"How many branches grow on the trunk (first), on those (second), and so on."
	)
	_add(
		body,
		&"measured",
		"Measured",
		"The share of the wood whose thickness was measured on the scan; the rest is inferred."
	)
	body.add_child(_selected)
	_selected.add_child(HSeparator.new())
	_add(
		_selected,
		&"selected",
		"Selected",
		"How many nodes are selected. The figures below are of the last one."
	)
	_add(
		_selected,
		&"place",
		"Place",
		"Where the node is, in metres from the tree's base: right, up, to the front."
	)
	_add(
		_selected,
		&"kind",
		"Kind",
		"What the node is: on the trunk, a fork, a tip, or along a branch."
	)
	radius = Widgets.number(0.01, 500.0, 0.01, "cm")
	radius.update_on_text_changed = false
	radius.value_changed.connect(_on_radius_changed)
	_selected.add_child(
		Widgets.line(
			"Radius",
			"How thick the wood is here. Type a new radius for all selected nodes.",
			radius
		)
	)


func _refresh() -> void:
	var tree: TreeReconstruction = session.tree
	if tree == null or tree.is_empty():
		_shown = []
		for label: Label in values.values():
			label.text = "-"
		_selected.visible = false
		return
	_show_selected(tree)
	if _shown == [tree, tree.get_bark_revision()]:
		return
	_shown = [tree, tree.get_bark_revision()]
	var measured: Dictionary = tree.measure()
	values[&"height"].text = _metres(measured.height)
	values[&"dbh"].text = _metres(measured.dbh) if measured.dbh > 0.0 else "-"
	values[&"stems"].text = str(measured.stems)
	values[&"crown"].text = _metres(2.0 * measured.crown_radius)
	values[&"crown_base"].text = _metres(measured.crown_base)
	values[&"length"].text = _metres(measured.total_length)
	values[&"volume"].text = _volume(measured.volume)
	values[&"nodes"].text = Widgets.grouped(measured.nodes)
	values[&"tips"].text = Widgets.grouped(measured.tips)
	values[&"measured"].text = "%d %%" % roundi(100.0 * measured.measured_share)
	var orders: PackedStringArray = []
	for order: Dictionary in (measured.orders as Array).slice(1):
		orders.append(str(int(order.branches)))
	values[&"orders"].text = "-" if orders.is_empty() else " · ".join(orders)


func _show_selected(tree: TreeReconstruction) -> void:
	var id: int = session.get_active()
	_selected.visible = id != session.NO_NODE and tree.has_node(id)
	if not _selected.visible:
		return
	values[&"selected"].text = Widgets.grouped(session.selection.size())
	var place: Vector3 = tree.get_node_position(id)
	values[&"place"].text = "%.2f %.2f %.2f m" % [place.x, place.y, place.z]
	values[&"kind"].text = _kind(tree, id)
	if not radius.get_line_edit().has_focus():
		radius.set_value_no_signal(100.0 * tree.get_node_radius(id))


func _add(to: Container, id: StringName, title: String, tip: String) -> void:
	var value: Label = Widgets.figure(tip)
	value.text = "-"
	values[id] = value
	var line: HBoxContainer = HBoxContainer.new()
	line.add_child(Widgets.words(title, tip))
	line.add_child(value)
	if id in _LONG:
		value.clip_text = true
		value.text_overrun_behavior = TextServer.OVERRUN_TRIM_ELLIPSIS
		value.size_flags_horizontal = Control.SIZE_EXPAND_FILL
		value.size_flags_stretch_ratio = 2.0
	to.add_child(line)


func _kind(tree: TreeReconstruction, id: int) -> String:
	var kind: String = tr("Along a branch")
	match tree.get_node_kind(id):
		TreeReconstruction.NODE_KIND_LEAF:
			kind = tr("Tip")
		TreeReconstruction.NODE_KIND_BRANCH:
			kind = tr("Fork")
	if tree.is_trunk(id):
		kind = (
			tr("Trunk")
			if tree.get_node_kind(id) == TreeReconstruction.NODE_KIND_TRUNK
			else (tr("Trunk, %s") % kind.to_lower())
		)
	return kind if tree.is_radius_measured(id) else tr("%s (inferred)") % kind


func _on_radius_changed(value: float) -> void:
	if session.tree == null or session.selection.is_empty():
		return
	session.run(
		tr("Set Radius"),
		"set_radius nodes=%s radius=%s" % [session.get_selection_words(), value / 100.0]
	)


# Centimetres below a metre.
static func _metres(length: float) -> String:
	return "%.1f cm" % (100.0 * length) if absf(length) < 1.0 else "%.2f m" % length


static func _volume(cubic_metres: float) -> String:
	if cubic_metres < 0.1:
		return "%.1f l" % (1000.0 * cubic_metres)
	return "%.3f m³" % cubic_metres
