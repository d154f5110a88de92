@tool
extends RefCounted
## What the viewport's keys, buttons and menu items do. All three come here, by the names of
## shortcuts.gd.

const Session: GDScript = preload("../session.gd")
const Shortcuts: GDScript = preload("shortcuts.gd")
const CameraViews: GDScript = preload("camera_views.gd")
const Turntable: GDScript = preload("turntable.gd")
const Screenshot: GDScript = preload("screenshot.gd")
const PhotoCompare: GDScript = preload("../compare/photo_compare.gd")

## What may be shown: the property of the view state, by the action that turns it on and off.
const SHOWN: Dictionary[StringName, StringName] = {
	&"show_points": &"points",
	&"show_voxels": &"voxels",
	&"show_skeleton": &"skeleton",
	&"show_mesh": &"mesh",
	&"show_leaves": &"leaves",
	&"show_wind": &"wind",
	&"show_axes": &"axes",
	&"show_grid": &"grid",
}
## Where the camera looks from, by the action.
const VIEWS: Array[StringName] = [
	&"view_front",
	&"view_rear",
	&"view_right",
	&"view_left",
	&"view_top",
	&"view_bottom",
	&"view_home",
]

var views: CameraViews
var turntable: Turntable
var screenshot: Screenshot
var photos: PhotoCompare

var _session: Session


func _init(session: Session) -> void:
	set_translation_domain(session.get_translation_domain())
	_session = session
	views = CameraViews.new(session)
	turntable = Turntable.new(session)
	screenshot = Screenshot.new(session)
	photos = PhotoCompare.new(session)


## Does it. [param camera] is that of the viewport in question.
func run(action: StringName, camera: Camera3D) -> void:
	if _session.tree == null:
		return
	if SHOWN.has(action):
		var property: StringName = SHOWN[action]
		_session.view.set(property, not _session.view.get(property))
	elif action in VIEWS:
		turntable.stop()
		photos.leave()
		views.look(action, camera)
	elif action.begins_with("tool_"):
		_session.choose(StringName(action.trim_prefix("tool_")))
	else:
		_run_other(action, camera)


func _run_other(action: StringName, camera: Camera3D) -> void:
	match action:
		&"edit_skeleton":
			_session.view.editing = not _session.view.editing
		&"turntable":
			photos.leave()
			turntable.toggle(camera)
		&"compare_photos":
			turntable.stop()
			photos.toggle(camera)
		&"edit_sketch":
			_session.sketch_wanted.emit()
		&"screenshot":
			if photos.is_open():
				screenshot.save(photos.get_picture())
			else:
				screenshot.take(camera)
		&"view_selection":
			turntable.stop()
			photos.leave()
			if _session.selection.is_empty() or not _session.view.editing:
				views.frame(camera)
			else:
				views.bring(_session.get_box_of(_session.selection), camera)
		&"select_all":
			_session.select_by("all")
		&"grow_selection":
			_session.grow_selection()
		&"shrink_selection":
			_session.shrink_selection()
		&"delete_selected":
			_delete()


func _delete() -> void:
	if _session.selection.is_empty():
		# The editor would delete the whole node.
		(
			_session
			. say(
				tr(
					(
						"Nothing of the tree is selected. To delete the whole tree, switch 'Edit skeleton'"
						+ " off first, or delete it in the Scene dock."
					)
				)
			)
		)
		return
	_session.run(tr("Delete wood"), "remove nodes=" + _session.get_selection_words())
