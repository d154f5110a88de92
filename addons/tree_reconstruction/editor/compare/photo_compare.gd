@tool
extends RefCounted
## Compares the edited tree with the photos that it was made of: over a viewport of the editor comes
## what is seen from where a photo was taken, with the photo behind the tree, before it, or the
## difference of both.
##
## Nothing of the scene, of the selection or of the editor's camera is touched, so there is nothing
## to undo.

## The photos are left: [param sentence], which was said of them, no longer holds.
signal left(sentence: String)

const Session: GDScript = preload("../session.gd")
const FileChooser: GDScript = preload("../file_chooser.gd")
const PhotoCamera: GDScript = preload("photo_camera.gd")
const Source: GDScript = preload("photo_source.gd")
const Stage: GDScript = preload("photo_stage.gd")
const Bar: GDScript = preload("photo_bar.gd")

var source: Source
## What lies over the viewport; [code]null[/code] while nothing is compared.
var cover: ColorRect
var stage: Stage
var bar: Bar

## Called with a key that is not for the photos; returns whether it was for something else.
var press: Callable

var _session: Session
var _node: TreeInstance3D
# What had the keyboard before.
var _focused: WeakRef = weakref(null)
# The trees of the scene when the photos were opened.
var _standing_by: Array[WeakRef] = []
# From where the user looked.
var _from: Vector3
# What a tool draws lies over the stage, whose own drawing is the photo.
var _ink: Control
var _chooser: FileChooser = FileChooser.new()
# As it was set last.
var _mode: Stage.Mode = Stage.Mode.BEHIND
var _opacity: float = 1.0
# What stands there already of the views and the picture.
var _standing: Dictionary = {}
var _shown: Texture2D


func _init(session: Session) -> void:
	set_translation_domain(session.get_translation_domain())
	_chooser.set_translation_domain(session.get_translation_domain())
	_session = session
	source = Source.new(session)
	source.changed.connect(_on_source_changed)


func is_open() -> bool:
	return cover != null


## Begins over the viewport of [param camera], or ends.
func toggle(camera: Camera3D) -> void:
	if is_open():
		leave()
	elif camera != null and _session.tree != null:
		_open(camera)


## Ends: all is as it was before.
func leave() -> void:
	if not is_open():
		return
	_chooser.close()
	source.close()
	var focused: Control = _focused.get_ref() as Control
	if stage.has_focus() and focused != null and focused.is_visible_in_tree():
		focused.grab_focus()
	cover.queue_free()
	cover = null
	stage = null
	_session.view.stage = null
	bar = null
	_ink = null
	_node = null
	_shown = null
	left.emit(_where_it_is())


## What is seen now of tree and photo.
func get_picture() -> Image:
	var window: Image = stage.get_viewport().get_texture().get_image()
	return window.get_region(Rect2i(stage.get_global_rect()))


## Another node is edited, or none. A tree that is drawn over the photos is another one.
func note_node() -> void:
	if is_open() and _session.node != _node and not _session.view.drawing:
		leave()


## The tree was edited.
func note_edit() -> void:
	if not is_open() or _session.node != _node:
		return
	if _session.tree == null:
		leave()
	else:
		source.follow(_session.tree)


## To be called once a frame.
func update() -> void:
	if not is_open():
		return
	if not is_instance_valid(_node) or not _node.is_inside_tree():
		leave()
		return
	note_node()
	if not is_open():
		return
	source.update()
	if stage.update(_node.global_transform):
		redraw()
	stage.hide_feet(_get_trees())


## What the tool at hand draws has changed.
func redraw() -> void:
	if is_open():
		_ink.queue_redraw()


## Takes a key, or returns whether it was for somebody else.
func take_key(event: InputEventKey) -> bool:
	if not event.pressed:
		return false
	if _is_drawn_over() and _session.tool.call(&"input", stage.camera, event):
		return true
	match event.get_keycode_with_modifiers():
		KEY_ESCAPE:
			leave()
		KEY_LEFT, KEY_PAGEUP:
			_step(-1)
		KEY_RIGHT, KEY_PAGEDOWN:
			_step(1)
		_:
			return press.is_valid() and not event.echo and press.call(event)
	return true


func _open(camera: Camera3D) -> void:
	_node = _session.node
	_from = camera.global_position
	_standing_by = []
	var scene: Node = _node.owner if _node.owner != null else _node
	for mesh: Node in [scene] + scene.find_children("*", "MeshInstance3D", true, false):
		if mesh is TreeInstance3D:
			_standing_by.append(weakref(mesh))
	_session.hovered = TreeReconstruction.NO_NODE
	stage = Stage.new(get_translation_domain())
	_session.view.stage = stage
	bar = Bar.new(_session)
	cover = ColorRect.new()
	cover.name = &"PhotoCompare"
	cover.set_translation_domain(get_translation_domain())
	cover.color = Stage.GROUND
	var rows: VBoxContainer = VBoxContainer.new()
	rows.add_theme_constant_override(&"separation", 0)
	rows.add_child(bar)
	stage.size_flags_vertical = Control.SIZE_EXPAND_FILL
	stage.gui_input.connect(_on_stage_input)
	rows.add_child(stage)
	_ink = Control.new()
	_ink.mouse_filter = Control.MOUSE_FILTER_IGNORE
	_ink.clip_contents = true
	_ink.draw.connect(_on_ink_draw)
	stage.add_child(_ink)
	_ink.set_anchors_and_offsets_preset(Control.PRESET_FULL_RECT)
	cover.add_child(rows)
	rows.set_anchors_and_offsets_preset(Control.PRESET_FULL_RECT)
	bar.chosen.connect(source.choose)
	bar.stepped.connect(_step)
	bar.mode_chosen.connect(_on_mode_chosen)
	bar.opacity_chosen.connect(_on_opacity_chosen)
	bar.folder_wanted.connect(_choose_folder)
	# Deferred, since it frees the button that was pressed.
	bar.left.connect(leave, CONNECT_DEFERRED)
	var editor: SubViewport = camera.get_viewport() as SubViewport
	editor.get_parent().get_parent().add_child(cover)
	cover.set_anchors_and_offsets_preset(Control.PRESET_FULL_RECT)
	stage.look_into(editor)
	stage.mode = _mode
	stage.opacity = _opacity
	bar.set_look(_mode, _opacity)
	_focused = weakref(cover.get_viewport().gui_get_focus_owner())
	stage.grab_focus()
	_standing = {}
	_shown = null
	source.open(_session.tree)


# Those of the scene, and one that is drawn over the photo since.
func _get_trees() -> Array[TreeInstance3D]:
	var trees: Array[TreeInstance3D] = []
	for reference: WeakRef in _standing_by:
		var tree: TreeInstance3D = reference.get_ref()
		if tree != null:
			trees.append(tree)
	if is_instance_valid(_session.node) and not _session.node in trees:
		trees.append(_session.node)
	return trees


func _step(by: int) -> void:
	source.choose(source.index + by)


func _on_source_changed() -> void:
	if not is_open():
		return
	if source.index < 0 and not source.views.is_empty():
		# Which says this again.
		source.choose(PhotoCamera.nearest(source.views, _node.global_transform, _from))
		return
	if source.index >= 0 and not is_same(source.views[source.index], _standing):
		if _standing.is_empty():
			_session.say(_where_it_is())
		_standing = source.views[source.index]
		stage.stand(_standing)
	if source.picture != _shown:
		_shown = source.picture
		stage.show_picture(_shown, source.picture_scale)
	stage.waiting = source.is_reading() and _shown == null
	var note: String = ""
	if not PhotoCamera.is_even(_node.global_transform):
		note = tr(
			"The node is scaled unevenly, which no photo shows: the tree can't lie on its photos."
		)
	bar.update(source, note)


func _where_it_is() -> String:
	return tr(
		(
			"This is seen from where the photo was taken. Escape leaves. Nothing in the scene is"
			+ " changed, so there is nothing to undo."
		)
	)


func _on_mode_chosen(mode: Stage.Mode) -> void:
	_mode = mode
	stage.mode = mode


func _on_opacity_chosen(opacity: float) -> void:
	_opacity = opacity
	stage.opacity = opacity


func _on_stage_input(event: InputEvent) -> void:
	if event is InputEventMouse:
		if not _is_drawn_over() or _standing.is_empty():
			return
		if _session.tool.call(&"input", stage.camera, event):
			if event is InputEventMouseButton:
				stage.grab_focus()
			stage.accept_event()
		return
	var key: InputEventKey = event as InputEventKey
	if key == null:
		return
	var over: Stage = stage
	if take_key(key) and over.is_inside_tree():
		over.accept_event()


# Whether the tool at hand draws over photos; any other one waits for its viewport.
func _is_drawn_over() -> bool:
	return (
		_session.view.editing and _session.tool != null and _session.tool.call(&"draws_over_photos")
	)


func _on_ink_draw() -> void:
	if is_open() and _is_drawn_over():
		_session.tool.call(&"draw_strokes", _ink)


func _choose_folder() -> void:
	var for_model: bool = source.lack == Source.Lack.MODEL
	_chooser.open(
		cover,
		EditorFileDialog.FILE_MODE_OPEN_DIR,
		tr("Choose Cameras") if for_model else tr("Choose Photos"),
		source.take_folder,
		[],
		source.get_folder_to_begin()
	)
