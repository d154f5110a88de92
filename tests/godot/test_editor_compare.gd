extends "./session_suite.gd"
## 'Compare with Photos', without an editor around it.

const PhotoModel := preload("./photo_model.gd")
const PhotoCompare := preload("res://addons/tree_reconstruction/editor/compare/photo_compare.gd")
const Source := preload("res://addons/tree_reconstruction/editor/compare/photo_source.gd")

var _photos: PhotoModel
var _made: TreeReconstruction
var _session: Session
var _compare: PhotoCompare
# As the editor has them: what shows a viewport, and what is around that.
var _editor: Control
var _camera: Camera3D


func _open() -> void:
	_made = grown_tree(4)
	_set_frame(1.0)
	_photos = PhotoModel.new(folder, _made)
	_session = _session_with(_made)
	_editor = Control.new()
	_editor.size = Vector2(800, 600)
	var container: SubViewportContainer = SubViewportContainer.new()
	var viewport: SubViewport = SubViewport.new()
	_camera = Camera3D.new()
	viewport.add_child(_camera)
	container.add_child(viewport)
	_editor.add_child(container)
	tree.root.add_child(_editor)
	_compare = PhotoCompare.new(_session)


func _shut() -> void:
	_compare.leave()
	_end(_session)
	_editor.free()
	# What it says to this suite holds the suite.
	_session = null
	_compare = null


func _set_frame(unit: float) -> void:
	var kept: Dictionary = _made.skeleton
	kept["frame"] = bits(PackedFloat64Array([0.5, -0.25, 1.0, unit]))
	_made.skeleton = kept


func _wait() -> void:
	for i: int in 3:
		_session.update()
		_compare.note_edit()
		_compare.update()
		await tree.process_frame
	while not _session.jobs.get_running().is_empty():
		_session.update()
		_compare.update()
		await tree.process_frame


func _key(code: Key) -> bool:
	var event: InputEventKey = InputEventKey.new()
	event.keycode = code
	event.pressed = true
	return _compare.take_key(event)


# Those of the other trees in the picture, too, as long as they stand.
func test_no_foot_is_in_the_ground() -> void:
	_open()
	var other: TreeInstance3D = TreeInstance3D.new()
	other.reconstruction = grown_tree(5)
	_session.node.add_child(other)
	_compare.toggle(_camera)
	await _wait()
	check_equal(_hidden_feet(), 2, "feet in the ground")
	other.visible = false
	await _wait()
	check_equal(_hidden_feet(), 1, "feet of trees that are shown")
	other.visible = true
	await _wait()
	check_equal(_hidden_feet(), 2, "feet of both again")
	other.free()
	await _wait()
	check_equal(_hidden_feet(), 1, "feet of trees that there are")
	_shut()


func _hidden_feet() -> int:
	var count: int = 0
	for foot: Node3D in _compare.stage.get(&"_feet"):
		count += int(foot.visible)
	return count


func test_it_begins_at_the_nearest_photo_and_goes_round() -> void:
	_open()
	var views: Array[Dictionary] = TreeReconstructor.new().load_photo_views(_made)
	var pose: Transform3D = views[4]["transform"]
	_camera.position = pose.origin * 1.3
	_compare.toggle(_camera)
	check(_compare.is_open(), "Nothing is shown.")
	await _wait()
	var source: Source = _compare.source
	check_equal(source.sentence, "", "what is wrong")
	check_equal(source.index, 4, "the first photo")
	check(source.picture != null, "The photo isn't seen.")
	check(_key(KEY_RIGHT) and _key(KEY_PAGEDOWN), "The keys were not taken.")
	await _wait()
	check_equal(source.index, 0, "two photos after the last but one")
	check(_key(KEY_LEFT), "The key was not taken.")
	await _wait()
	check_equal(source.index, PhotoModel.COUNT - 1, "the photo before the first")
	check(not _key(KEY_Z), "A key that is nothing to it was taken.")
	check_equal(_said.size(), 1, "sentences")
	check(_key(KEY_ESCAPE) and not _compare.is_open(), "Escape doesn't end it.")
	check_equal(_undo.get_history_count(), 0, "steps of the history")
	_shut()


func test_it_follows_the_tree() -> void:
	_open()
	_compare.toggle(_camera)
	await _wait()
	_compare.source.choose(3)
	await _wait()
	var before: Transform3D = _compare.source.views[3]["transform"]
	_made.edit("thicken factor=1.1")
	await _wait()
	var after: Transform3D = _compare.source.views[3]["transform"]
	check_equal(after, before, "the pose after an edit")
	# A known length: all of the scan is twice as large.
	_set_frame(2.0)
	await _wait()
	after = _compare.source.views[3]["transform"]
	check_equal(_compare.source.index, 3, "the photo that is looked at")
	check(_compare.source.picture != null, "The photo isn't seen.")
	check(
		after.origin.is_equal_approx(before.origin * 2.0),
		"The photo stands at %s instead of %s." % [after.origin, before.origin * 2.0]
	)
	_session.node.position = Vector3(1, 2, 3)
	_compare.update()
	check(
		_compare.stage.camera.global_position.is_equal_approx(after.origin + Vector3(1, 2, 3)),
		"The camera doesn't follow the node."
	)
	var message: Label = _compare.bar.find_child("Message", true, false) as Label
	check(not message.is_visible_in_tree(), "It says: " + message.text)
	_session.node.scale = Vector3(1, 2, 1)
	_compare.source.changed.emit()
	check("unevenly" in message.text, "It doesn't say that the scale is uneven.")
	_session.edit_node(null)
	_compare.note_node()
	check(not _compare.is_open(), "It goes on without a tree.")
	_session.edit_node(tree.root.find_children("*", "TreeInstance3D", true, false)[0])
	_shut()


func test_what_is_missing_is_asked_for() -> void:
	_open()
	DirAccess.rename_absolute(_photos.photos, folder.path_join("b"))
	DirAccess.rename_absolute(_photos.model, folder.path_join("c"))
	_compare.toggle(_camera)
	await _wait()
	var source: Source = _compare.source
	check_equal(source.lack, Source.Lack.MODEL, "what is lacking")
	check_sentence(source.sentence, "what it says of no model")
	source.take_folder(folder.path_join("c"))
	await _wait()
	check_equal(source.views.size(), PhotoModel.COUNT, "photos of the model that was chosen")
	check_equal(source.lack, Source.Lack.PHOTOS, "what is lacking then")
	check_sentence(source.sentence, "what it says of no photos")
	source.take_folder(folder)
	await _wait()
	check_equal(source.lack, Source.Lack.PHOTOS, "what is lacking in a wrong folder")
	check_sentence(source.sentence, "what it says of a wrong folder")
	source.take_folder(folder.path_join("b"))
	await _wait()
	check_equal(source.lack, Source.Lack.NOTHING, "what is lacking at the end")
	check(source.picture != null, "The photo isn't seen.")
	# The next time it is known.
	_compare.toggle(_camera)
	_compare.toggle(_camera)
	await _wait()
	check(source.picture != null, "The folders were forgotten: " + source.sentence)
	PhotoModel.write(folder.path_join("b").path_join(PhotoModel.name_of(source.index)), "none")
	source.choose(source.index)
	await _wait()
	check(source.picture == null, "It shows what is no photo.")
	check_sentence(source.sentence, "what it says of a damaged photo")
	_shut()


func test_work_that_is_ended_in_the_dock_is_told() -> void:
	_open()
	_compare.toggle(_camera)
	_session.jobs.cancel(_session.jobs.get_running()[0])
	await _wait()
	_compare.update()
	check_sentence(_compare.source.sentence, "what it says of work that was ended")
	check(not _compare.source.is_reading(), "It waits for it.")
	_shut()


func test_every_control_says_what_it_is() -> void:
	_open()
	_compare.toggle(_camera)
	await _wait()
	for control: Node in _compare.bar.find_children("*", "Control", true, false):
		if (control is BaseButton and (control as Control).visible) or control is Slider:
			var tip: String = (control as Control).tooltip_text
			check(tip.ends_with("."), "%s has no tooltip." % control.name)
	_shut()
