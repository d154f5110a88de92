@tool
extends RefCounted
## The plugin's part that brings scans into the project and trees into scenes: the importer, the
## finder of scans, thumbnails, the FileSystem dock's menu, drops onto the 3D view, and what a new
## import does to trees that were edited.

const Importer: GDScript = preload("./importer.gd")
const OptionTips: GDScript = preload("./option_tips.gd")
const ScanFinder: GDScript = preload("./scan_finder.gd")
const Thumbnails: GDScript = preload("./thumbnails.gd")
const SceneAdder: GDScript = preload("./scene_adder.gd")
const ContextMenu: GDScript = preload("./context_menu.gd")
const DropArea: GDScript = preload("./drop_area.gd")
const Reimport: GDScript = preload("./reimport.gd")

const _VIEWPORTS: int = 4

var adder: SceneAdder
var finder: ScanFinder
var importer: Importer
var reimport: Reimport

var _plugin: EditorPlugin
var _thumbnails: Array[Thumbnails] = []
var _tips: OptionTips
var _menu: ContextMenu
var _areas: Array[Control] = []


func enter(plugin: EditorPlugin, session: RefCounted) -> void:
	_plugin = plugin
	importer = Importer.new()
	importer.set_translation_domain(get_translation_domain())
	importer.failed.connect(_on_failed)
	plugin.add_import_plugin(importer)
	_tips = OptionTips.new()
	_tips.set_translation_domain(get_translation_domain())
	plugin.add_inspector_plugin(_tips)
	for of_scripts: bool in [false, true]:
		var thumbnails: Thumbnails = Thumbnails.new()
		thumbnails.of_scripts = of_scripts
		EditorInterface.get_resource_previewer().add_preview_generator(thumbnails)
		_thumbnails.append(thumbnails)
	var domain: StringName = get_translation_domain()
	adder = SceneAdder.new(plugin.get_undo_redo())
	adder.set_translation_domain(domain)
	adder.added.connect(session.view.show_whole.unbind(1))
	_menu = ContextMenu.new()
	_menu.set_translation_domain(domain)
	_menu.adder = adder
	_menu.placed.connect(session.view.want)
	plugin.add_context_menu_plugin(EditorContextMenuPlugin.CONTEXT_SLOT_FILESYSTEM, _menu)
	for i: int in _VIEWPORTS:
		_add_area(EditorInterface.get_editor_viewport_3d(i))
	reimport = Reimport.new(session)
	reimport.set_translation_domain(domain)
	reimport.enter()
	finder = ScanFinder.new()
	adder.finder = finder
	finder.found.connect(_on_found)
	finder.enter()


func exit() -> void:
	finder.exit()
	adder.finder = null
	finder = null
	reimport.exit()
	reimport = null
	for area: Control in _areas:
		area.queue_free()
	_areas.clear()
	_plugin.remove_context_menu_plugin(_menu)
	_menu = null
	adder = null
	for thumbnails: Thumbnails in _thumbnails:
		EditorInterface.get_resource_previewer().remove_preview_generator(thumbnails)
	_thumbnails.clear()
	_plugin.remove_inspector_plugin(_tips)
	_tips = null
	_plugin.remove_import_plugin(importer)
	importer = null
	_plugin = null


func _add_area(viewport: SubViewport) -> void:
	if viewport == null or not viewport.get_parent() is Control:
		return
	var area: Control = DropArea.create(viewport, adder)
	# Beside the viewport's container, so above what the editor draws over it.
	viewport.get_parent().get_parent().add_child(area)
	_areas.append(area)


func _on_failed(_path: String, sentence: String) -> void:
	EditorInterface.get_editor_toaster().push_toast(sentence, EditorToaster.SEVERITY_ERROR)


func _on_found(stand_ins: PackedStringArray) -> void:
	var names: PackedStringArray = []
	for path: String in stand_ins:
		names.append(path.get_file())
	EditorInterface.get_editor_toaster().push_toast(
		tr("Point clouds were found. These files import them as trees: %s") % ", ".join(names),
		EditorToaster.SEVERITY_INFO
	)
