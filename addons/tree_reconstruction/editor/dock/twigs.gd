@tool
extends "section.gd"
## Branches to graft: those of the addon and of the user's own libraries. They can be dragged onto
## the tree in the viewport.

const Files := preload("files.gd")
const TwigList := preload("twig_list.gd")

const _KEY: String = "twig_libraries"

var list: TwigList = TwigList.new()
var libraries: OptionButton
var add: Button
var remove: Button

var _open: Button
# The libraries in files, by their paths; "" is the addon's own.
var _known: Dictionary[String, TwigLibrary] = {}
var _shown: TwigLibrary
var _filled: bool = false
var _files: Files = Files.new()


func get_id() -> StringName:
	return &"twigs"


func close() -> void:
	_files.close()
	for path: String in _known:
		_forget(path)


## Adds the library in a file to the choice, and shows it. Returns whether it is one.
func open(path: String) -> bool:
	var library: TwigLibrary = null
	if ResourceLoader.exists(path):
		library = load(path) as TwigLibrary
	if library == null:
		session.say(tr("%s is no library of twigs.") % path, session.Kind.ERROR)
		return false
	_know(path, library)
	_show(path)
	_keep_paths()
	return true


## Makes a library in a file, and shows it.
func make(path: String) -> void:
	var library: TwigLibrary = TwigLibrary.new()
	var error: Error = ResourceSaver.save(library, path)
	if error != OK:
		session.say(
			tr("%s can't be written: %s.") % [path, error_string(error)], session.Kind.ERROR
		)
		return
	library.take_over_path(path)
	Files.tell_editor(path)
	open(path)


## Adds the branch that begins at the selected node to the shown library.
func add_selected() -> void:
	var id: int = session.get_active()
	if session.tree == null or id == session.NO_NODE or _shown == null:
		return
	var title: String = tr("Branch %d") % (_shown.twigs.size() + 1)
	var twig: Twig = Twig.from_branch(session.tree, id, title)
	if twig.lstring.is_empty():
		return
	twig.description = tr("From %s, node %d.") % [_name_of(session.tree), id]
	_set_twigs(tr("Add Twig"), _shown.twigs + ([twig] as Array[Twig]))


## What is grafted from now on: the twig that is selected in the list.
func use_selected() -> void:
	var chosen: PackedInt32Array = list.get_selected_items()
	if chosen.is_empty():
		return
	var twig: Twig = list.get_item_metadata(chosen[0])
	session.scion = TwigList.scion_of(twig)
	if session.tools.has(&"graft"):
		session.choose(&"graft")
	session.say(tr("Click where %s shall grow.") % twig.title)


func _build() -> void:
	title = "Twigs"
	tooltip_text = "Branches to graft onto the tree."
	folded = true
	libraries = Widgets.choice(PackedStringArray(["Presets"]), [""])
	libraries.tooltip_text = "The collection that is shown. The presets come with the addon."
	libraries.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	libraries.item_selected.connect(_on_library_selected)
	_open = Widgets.button("", "Opens a library of your own, or makes one.", &"Folder")
	_open.pressed.connect(_on_open_pressed)
	var line: HBoxContainer = HBoxContainer.new()
	line.add_child(libraries)
	line.add_child(_open)
	body.add_child(line)
	list.tooltip_text = "Drag a twig onto a branch, or double-click it and click where it shall grow."
	list.custom_minimum_size.y = Widgets.px(150)
	list.item_activated.connect(_on_item_activated)
	list.item_selected.connect(_on_item_selected)
	body.add_child(list)
	add = Widgets.button(
		"Add picked branch", "Keeps the branch at the selected node in the shown library.", &"Add"
	)
	add.pressed.connect(_on_add_pressed)
	remove = Widgets.button("Remove", "Takes the selected twig out of the library.", &"Remove")
	remove.pressed.connect(_on_remove_pressed)
	body.add_child(buttons([add, remove]))


func _refresh() -> void:
	if not _filled:
		_filled = true
		_restore_paths()
		_show("")
	_update_buttons()


func _update_buttons() -> void:
	var id: int = session.get_active()
	var is_branch: bool = (
		session.tree != null and id != session.NO_NODE and id != session.tree.get_root()
	)
	add.disabled = not is_branch
	remove.disabled = _path() == "" or list.get_selected_items().is_empty()


func _path() -> String:
	return "" if libraries.selected < 0 else libraries.get_selected_metadata()


func _show(path: String) -> void:
	Widgets.choose(libraries, path)
	if path.is_empty() and not _known.has(""):
		_known[""] = TwigLibrary.presets()
	_shown = _known[path]
	_fill()


func _fill() -> void:
	_shown.fill(list)
	var domain: StringName = session.get_translation_domain()
	for item: int in list.item_count:
		var twig: Twig = list.get_item_metadata(item)
		list.set_item_text(item, Session.Sentences.translate(twig.title, domain))
		list.set_item_tooltip(
			item,
			(
				tr("%s\n%.2f m long, %.1f mm thick at its base")
				% [
					Session.Sentences.translate(twig.description, domain),
					twig.length,
					twig.base_radius * 2000.0
				]
			)
		)
	_update_buttons()


func _know(path: String, library: TwigLibrary) -> void:
	if _known.has(path):
		_forget(path)
	else:
		libraries.add_item(path.get_file().get_basename().capitalize())
		libraries.set_item_metadata(libraries.item_count - 1, path)
		libraries.set_item_tooltip(libraries.item_count - 1, path)
	_known[path] = library
	library.changed.connect(_on_library_changed.bind(path))


func _forget(path: String) -> void:
	if not path.is_empty() and _known[path].changed.is_connected(_on_library_changed):
		_known[path].changed.disconnect(_on_library_changed)


# One step of the history; the file follows it by itself.
func _set_twigs(step: String, twigs: Array[Twig]) -> void:
	var old: Array[Twig] = _shown.twigs
	session.history.begin(step, session.node)
	session.history.add_property(_shown, &"twigs", twigs, old)
	session.history.commit()


func _on_library_changed(path: String) -> void:
	var error: Error = ResourceSaver.save(_known[path], path)
	if error != OK:
		session.say(
			tr("%s can't be written: %s.") % [path, error_string(error)], session.Kind.ERROR
		)
	if _shown == _known[path]:
		_fill()


func _on_library_selected(_index: int) -> void:
	_show(_path())


func _on_item_activated(_index: int) -> void:
	use_selected()


func _on_item_selected(_index: int) -> void:
	_update_buttons()


func _on_add_pressed() -> void:
	if not _path().is_empty():
		add_selected()
		return
	# The presets are the addon's: the user's own go into a file.
	_files.ask(
		tr("Keep the Branch in a Library"),
		"res://twigs.tres",
		PackedStringArray(["*.tres;" + tr("Library of twigs")]),
		_on_library_chosen.bind(true)
	)


func _on_open_pressed() -> void:
	_files.ask(
		tr("Open or Make a Library"),
		"res://twigs.tres",
		PackedStringArray(["*.tres;" + tr("Library of twigs")]),
		_on_library_chosen.bind(false)
	)


func _on_library_chosen(path: String, then_add: bool) -> void:
	# The dialog asks before it returns a file that exists.
	if ResourceLoader.exists(path):
		if not open(path):
			return
	else:
		make(path)
	if then_add:
		add_selected()


func _on_remove_pressed() -> void:
	var chosen: PackedInt32Array = list.get_selected_items()
	if chosen.is_empty() or _path().is_empty():
		return
	var twigs: Array[Twig] = _shown.twigs.duplicate()
	twigs.erase(list.get_item_metadata(chosen[0]))
	_set_twigs(tr("Remove Twig"), twigs)


## Where the user's libraries are that were opened in this project.
static func get_kept_paths() -> PackedStringArray:
	if not Engine.is_editor_hint():
		return PackedStringArray()
	return EditorInterface.get_editor_settings().get_project_metadata(
		"tree_reconstruction", _KEY, PackedStringArray()
	)


func _restore_paths() -> void:
	for path: String in get_kept_paths():
		if ResourceLoader.exists(path) and load(path) is TwigLibrary:
			_know(path, load(path) as TwigLibrary)


func _keep_paths() -> void:
	if not Engine.is_editor_hint():
		return
	var paths: PackedStringArray = []
	for path: String in _known:
		if not path.is_empty():
			paths.append(path)
	EditorInterface.get_editor_settings().set_project_metadata("tree_reconstruction", _KEY, paths)


static func _name_of(tree: TreeReconstruction) -> String:
	if not tree.resource_name.is_empty():
		return tree.resource_name
	return tree.resource_path.get_file().get_basename()
