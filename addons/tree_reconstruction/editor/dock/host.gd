@tool
extends EditorDock
## Where the editor keeps the dock "Tree", and remembers which of its sections are folded.

const Dock := preload("dock.gd")
const Icons: GDScript = preload("../viewport/icons.gd")

var _dock: Dock


func _init(dock: Dock) -> void:
	_dock = dock
	name = &"TreeReconstruction"
	title = dock.tr("Tree")
	layout_key = "TreeReconstruction"
	default_slot = EditorDock.DOCK_SLOT_RIGHT_UL
	available_layouts = EditorDock.DOCK_LAYOUT_VERTICAL | EditorDock.DOCK_LAYOUT_FLOATING
	# Not loaded: in a project that was just made it is not imported yet.
	dock_icon = Icons.find(dock, "res://addons/tree_reconstruction/icons/TreeReconstruction.svg")
	tooltip_text = dock.tr(
		"How the edited tree was made, what it measures, its leaves and variants."
	)
	add_child(dock)


func _save_layout_to_config(config: ConfigFile, section: String) -> void:
	config.set_value(section, "folded", _dock.get_folded())


func _load_layout_from_config(config: ConfigFile, section: String) -> void:
	var folded: Variant = config.get_value(section, "folded", null)
	if folded is PackedStringArray:
		_dock.set_folded(folded)
