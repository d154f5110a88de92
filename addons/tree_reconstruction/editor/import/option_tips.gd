@tool
extends EditorInspectorPlugin
## Gives the parameters in the Import dock their tooltips.
##
## The engine looks the texts up in the class reference of the importer's class, which for one that
## is a script is [EditorImportPlugin]. So they are put into the fields of the dock once these are
## there, in the form in which the engine's own tooltips take a text of their own.

const ImportOptions: GDScript = preload("./import_options.gd")
const Sentences: GDScript = preload("../translations/sentences.gd")

# What the engine calls the object whose properties the dock shows.
const _DOCK_OBJECT: String = "ImportDockParameters"
const _KIND: String = "local_variable"
const _TOOLTIP: String = "EditorHelpBitTooltip"

var _due: bool = false


func _can_handle(object: Object) -> bool:
	return object != null and object.get_class() == _DOCK_OBJECT and _is_ours(object)


func _parse_begin(_object: Object) -> void:
	if not _due:
		_due = true
		# When the fields are there.
		_fill.call_deferred()


## The text of a parameter, in the editor's language; empty for one that nobody knows.
func describe(parameter: String) -> String:
	match parameter:
		"scan/unit":
			return tr(
				(
					"In what the scan's coordinates are given. It is taken from the file, or guessed from"
					+ " its size; say it where that is wrong, or tell the tree's height or one length that"
					+ " you know."
				)
			)
		"scan/tree_in_file":
			return tr("Which tree of a skeleton file with several, in its order; 0 is the largest.")
		"scan/dialect":
			return tr(
				"How an L-string is read: as its first line says, or in a dialect whatever it says."
			)
		"scan/known_length":
			return tr(
				(
					"Two places of the scan and the distance between them in metres, as x, y, z, x, y, z,"
					+ " metres."
				)
			)
	return tr(ImportOptions.get_description(parameter))


# All parameters are there that only our importer has.
static func _is_ours(object: Object) -> bool:
	for property: Dictionary in object.get_property_list():
		if property["name"] == "skeleton/algorithm":
			return true
	return false


func _fill() -> void:
	_due = false
	for dock: Node in EditorInterface.get_base_control().find_children(
		"*", "ImportDock", true, false
	):
		for node: Node in dock.find_children("*", "EditorProperty", true, false):
			var field: EditorProperty = node as EditorProperty
			var text: String = describe(field.get_edited_property())
			if text.is_empty():
				continue
			field.tooltip_text = to_tooltip(field.label, text)
			if not field.child_entered_tree.is_connected(_on_child_entered):
				field.child_entered_tree.connect(_on_child_entered)


# The engine's tooltip would be titled as that of a variable.
func _on_child_entered(child: Node) -> void:
	if child.get_class() == _TOOLTIP:
		_retitle.call_deferred(child)


func _retitle(tooltip: Node) -> void:
	if not is_instance_valid(tooltip) or not tooltip.get_parent() is EditorProperty:
		return
	for node: Node in tooltip.find_children("*", "RichTextLabel", true, false):
		var title: RichTextLabel = node as RichTextLabel
		title.clear()
		title.add_text((tooltip.get_parent() as EditorProperty).label)
		return


## What the engine's tooltips of properties take: the kind of thing, its class, its name, and more
## in JSON.
static func to_tooltip(label: String, text: String) -> String:
	# The engine reads tags in it, and bars between its parts.
	var escaped: String = text.replace("[", "[lb]")
	return "%s||%s|%s" % [_KIND, label.replace("|", "/"), JSON.stringify({"description": escaped})]
