@tool
extends MenuButton
## The menu above the viewport: what is shown of the tree, and from where.

## The user chose an action of actions.gd.
signal asked(action: StringName)

const Session: GDScript = preload("../session.gd")
const ViewState: GDScript = preload("../view_state.gd")
const Shortcuts: GDScript = preload("shortcuts.gd")
const Icons: GDScript = preload("icons.gd")
const Actions: GDScript = preload("actions.gd")

var _session: Session
var _shortcuts: Shortcuts
var _actions: Array[StringName] = []
var _colors: PopupMenu
var _channels: PopupMenu


func _init(session: Session, shortcuts: Shortcuts) -> void:
	set_translation_domain(session.get_translation_domain())
	_session = session
	_shortcuts = shortcuts
	name = &"TreeViewMenu"
	text = tr("Tree")
	tooltip_text = tr("What is shown of the tree that is edited, and from where.")
	flat = false
	theme_type_variation = &"FlatMenuButton"
	switch_on_hover = true
	about_to_popup.connect(update)
	_fill()
	get_popup().id_pressed.connect(_on_pressed)
	_colors.id_pressed.connect(
		func(id: int) -> void: _session.view.point_colors = id as ViewState.PointColors
	)
	_channels.id_pressed.connect(func(id: int) -> void: _session.view.channel = id)


## Sets the marks, and the keys as the user has set them.
func update() -> void:
	var popup: PopupMenu = get_popup()
	for id: int in _actions.size():
		var index: int = popup.get_item_index(id)
		var action: StringName = _actions[id]
		popup.set_item_shortcut(index, _shortcuts.get_shortcut(action), false)
		popup.set_item_shortcut_disabled(index, true)
		if action == &"edit_sketch":
			var drawn: bool = _session.tree != null and _session.tree.provenance.has("sketch")
			popup.set_item_disabled(index, not drawn)
		elif action == &"edit_skeleton":
			popup.set_item_checked(index, _session.view.editing)
		elif Actions.SHOWN.has(action):
			popup.set_item_checked(index, _session.view.get(Actions.SHOWN[action]))
	for id: int in _colors.item_count:
		_colors.set_item_checked(id, _session.view.point_colors == id)
	for id: int in _channels.item_count:
		_channels.set_item_checked(id, _session.view.channel == id)


func _fill() -> void:
	_add(&"edit_skeleton", tr("Edit Skeleton"), true, tr("Mouse and keys are for the wood."))
	get_popup().add_separator(tr("Show"))
	_add(&"show_points", tr("Scan Points"), true, tr("The points that the tree was made of."))
	_colors = PopupMenu.new()
	_colors.name = &"PointColors"
	_colors.hide_on_checkable_item_selection = false
	_colors.add_radio_check_item(tr("Colors of the Scan"), ViewState.PointColors.SCAN)
	_colors.add_radio_check_item(tr("By Height"), ViewState.PointColors.HEIGHT)
	_colors.add_radio_check_item(tr("By Distance to the Bark"), ViewState.PointColors.FIDELITY)
	_colors.set_item_tooltip(
		2, tr("Blue points lie on the bark, red ones lie off it: there the tree misses something.")
	)
	# With an id that is no action's.
	get_popup().add_submenu_node_item(tr("Point Colors"), _colors, 1000)
	_add(
		&"show_voxels",
		tr("Voxels of the Scan"),
		true,
		tr("The boxes that hold the scan's points, as the voxel flood goes through them.")
	)
	_add(&"show_skeleton", tr("Skeleton"), true, tr("The lines and joints that are edited."))
	_add(&"show_mesh", tr("Bark"), true, tr("The mesh of trunk and branches."))
	_add(&"show_leaves", tr("Leaves"), true, tr("The leaves of the tree, if it bears any."))
	_add(
		&"show_wind",
		tr("Wind"),
		true,
		tr("Wood that sways is hard to edit, so the wind rests unless this is on.")
	)
	_add_channels()
	_add(&"show_axes", tr("Axes and Height"), true, tr("The tree's axes, with a mark each metre."))
	_add(&"show_grid", tr("Ground Grid"), true, tr("Squares of one metre, and a person of 1.75 m."))
	get_popup().add_separator(tr("Look From"))
	var titles: Dictionary[StringName, String] = {
		&"view_front": tr("Front"),
		&"view_rear": tr("Rear"),
		&"view_right": tr("Right"),
		&"view_left": tr("Left"),
		&"view_top": tr("Top"),
		&"view_bottom": tr("Bottom"),
		&"view_home": tr("Home"),
	}
	for action: StringName in titles:
		_add(action, titles[action], false, tr("Shows the whole tree from there."))
	_add(
		&"view_selection",
		tr("Selection"),
		false,
		tr("Brings the selected wood into view, from where you look now.")
	)
	_add(
		&"turntable", tr("Turntable"), false, tr("Turns around the tree until you press anything.")
	)
	_add(
		&"compare_photos",
		tr("Compare with Photos"),
		false,
		tr("Stands where the photos were taken that the tree was made of. Nothing is changed.")
	)
	get_popup().add_separator()
	_add(
		&"edit_sketch",
		tr("Edit Sketch"),
		false,
		tr("Opens the strokes that this tree was made of, if it was: draw on, and it follows.")
	)
	_add(
		&"screenshot",
		tr("Save Picture"),
		false,
		tr("Saves what the viewport shows. The folder is set in the editor's settings.")
	)


# In the order of TreeWind.Channel.
func _add_channels() -> void:
	_channels = PopupMenu.new()
	_channels.name = &"WindChannels"
	_channels.hide_on_checkable_item_selection = false
	var titles: PackedStringArray = [
		tr("Off"),
		tr("Height"),
		tr("Along the Branch"),
		tr("Phase"),
		tr("Ambient Occlusion"),
		tr("Pivot"),
		tr("Branch Level"),
		tr("Primary Branches"),
		tr("Secondary Branches"),
		tr("Motion"),
	]
	for title: String in titles:
		_channels.add_radio_check_item(title)
	get_popup().add_submenu_node_item(tr("Wind Channels"), _channels, 1001)
	get_popup().set_item_tooltip(
		get_popup().item_count - 1,
		tr("Colors the tree by what its shaders read: to see why it moves as it does.")
	)


func _add(action: StringName, title: String, checkable: bool, tooltip: String) -> void:
	var popup: PopupMenu = get_popup()
	popup.hide_on_checkable_item_selection = false
	var id: int = _actions.size()
	_actions.append(action)
	if checkable:
		popup.add_check_item(title, id)
	else:
		popup.add_item(title, id)
	popup.set_item_tooltip(popup.get_item_index(id), tooltip)


func _on_pressed(id: int) -> void:
	if id < _actions.size():
		asked.emit(_actions[id])
		update()


func _notification(what: int) -> void:
	if what == NOTIFICATION_THEME_CHANGED:
		icon = Icons.find(self, "res://addons/tree_reconstruction/icons/TreeInstance3D.svg")
