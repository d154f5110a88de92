extends "./dock_suite.gd"
## What photos say of a tree: TreeReconstructor.load_outlines() and measure_outline(), and the dock.

const Fidelity := preload("res://addons/tree_reconstruction/editor/dock/fidelity.gd")
const PhotoModel := preload("photo_model.gd")

var _photos: PhotoModel


# A tree of a scan that lies beside COLMAP's model of the photos of it.
func _photographed(with_masks: bool) -> TreeReconstruction:
	DirAccess.make_dir_recursive_absolute(folder.path_join("judged"))
	var scan: String = write_scan("judged/cloud.xyz")
	var made: TreeReconstruction = TreeReconstructor.new().reconstruct_file(scan)
	var provenance: Dictionary = made.provenance
	_photos = PhotoModel.new(scan.get_base_dir(), made)
	provenance["photos"] = _photos.photos
	made.provenance = provenance
	made.leaf_preset = "none"
	if with_masks:
		_write_masks(scan.get_base_dir().path_join("masks"))
	return made


# The photos' wood is dark, their sky bright.
func _write_masks(masks: String) -> void:
	DirAccess.make_dir_recursive_absolute(masks)
	for i: int in PhotoModel.COUNT:
		var name: String = PhotoModel.name_of(i)
		var photo: Image = Image.load_from_file(_photos.photos.path_join(name))
		for y: int in photo.get_height():
			for x: int in photo.get_width():
				var white: bool = photo.get_pixel(x, y).get_luminance() < 0.6
				photo.set_pixel(x, y, Color.WHITE if white else Color.BLACK)
		photo.save_png(masks.path_join(name + ".png"))


func _points_of(made: TreeReconstruction) -> PackedVector3Array:
	var reader: TreeReconstructor = TreeReconstructor.new()
	reader.load_cloud(made)
	return reader.get_cloud_points()


func test_masks_judge_points_and_outline() -> void:
	var made: TreeReconstruction = _photographed(true)
	var points: PackedVector3Array = _points_of(made)
	var worker: TreeReconstructor = TreeReconstructor.new()
	var folders: Dictionary = {"masks": _photos.photos.path_join("../masks")}
	var found: Dictionary = worker.load_outlines(made, points, folders)
	check_equal(worker.get_error_message(), "", "the error")
	check_equal(found["judged_by"], "masks", "what judges")
	check_near(found["information"], 1.0 - 0.8 ** PhotoModel.COUNT, 1e-9, "I")
	check(found["reconstruction"] > 0.6, "R_3d is %s." % found["reconstruction"])
	check(
		found["reconstruction_seen"] >= found["reconstruction"],
		"Fewer points fall in than are seen."
	)
	check_equal((found["photos"] as Array).size(), PhotoModel.COUNT, "photos")
	for photo: Dictionary in found["photos"]:
		check_equal(photo["inside"] + photo["outside"], points.size(), photo["name"])
	var outline: Dictionary = worker.measure_outline(made, false)
	check_equal((outline["photos"] as Array).size(), PhotoModel.COUNT, "photos with an outline")
	for part: String in ["precision", "recall", "iou"]:
		check(outline[part] > 0.4 and outline[part] <= 1.0, "%s is %s." % [part, outline[part]])
	# Half of the tree covers less of the masks; what is left is as right as it was.
	var bare: TreeReconstruction = made.duplicate() as TreeReconstruction
	bare.edit("prune_order order=1")
	var less: Dictionary = worker.measure_outline(bare, false)
	check(
		less["recall"] < outline["recall"] - 0.1, "Without branches recall is %s." % less["recall"]
	)
	check(less["precision"] > outline["precision"] - 0.05, "Precision is %s." % less["precision"])
	check_equal(worker.measure_outline(made, false), outline, "the outline, measured again")


func test_the_sky_judges_where_there_are_no_masks() -> void:
	var made: TreeReconstruction = _photographed(false)
	var points: PackedVector3Array = _points_of(made)
	var worker: TreeReconstructor = TreeReconstructor.new()
	var found: Dictionary = worker.load_outlines(made, points, {"photos": _photos.photos})
	check_equal(worker.get_error_message(), "", "the error")
	check_equal(found["judged_by"], "sky", "what judges")
	var outline: Dictionary = worker.measure_outline(made)
	check(outline["precision"] > 0.4, "Precision is %s." % outline["precision"])
	check(not outline.has("recall") and not outline.has("iou"), "It tells what it can't know.")
	# A tree that is four times as thick lies in the sky.
	var thick: TreeReconstruction = made.duplicate() as TreeReconstruction
	thick.edit("thicken nodes=all factor=4")
	var worse: Dictionary = worker.measure_outline(thick)
	check(worse["precision"] < outline["precision"] - 0.1, "Too thick is %s." % worse)


func test_mistakes_get_a_sentence() -> void:
	var made: TreeReconstruction = _photographed(false)
	var points: PackedVector3Array = _points_of(made)
	var worker: TreeReconstructor = TreeReconstructor.new()
	check_equal(worker.measure_outline(made), {}, "before load_outlines()")
	check("call load_outlines() first" in worker.get_error_message(), worker.get_error_message())
	for mistake: Array in [
		[points, {}, "photos themselves are not where they were"],
		[points, {"masks": "user://nowhere"}, "There is no folder"],
		[points, {"photos": "user://nowhere"}, "None of the photos"],
		[points, {"model": "user://nowhere", "photos": _photos.photos}, "no COLMAP model"],
		[PackedVector3Array(), {"photos": _photos.photos}, "point cloud is empty"],
		[PackedVector3Array([Vector3.INF]), {"photos": _photos.photos}, "no finite number"],
	]:
		check_equal(worker.load_outlines(made, mistake[0], mistake[1]), {}, mistake[2])
		var said: String = worker.get_error_message()
		check(mistake[2] in said, "It says '%s' instead of '%s'." % [said, mistake[2]])
	worker.cancel()
	check_equal(worker.load_outlines(made, points, {"photos": _photos.photos}), {}, "cancelled")


func test_a_page_tells_of_the_photos() -> void:
	var made: TreeReconstruction = _photographed(true)
	var worker: TreeReconstructor = TreeReconstructor.new()
	worker.reconstruct_file(made.provenance["source"], {"leaves": "none"})
	var path: String = folder.path_join("judged.html")
	var masks: String = _photos.photos.path_join("../masks")
	check_equal(
		worker.save_html_report(path, {"masks": masks, "photos": _photos.photos}), OK, "the page"
	)
	var page: String = FileAccess.get_file_as_string(path)
	check("Fidelity to the photos" in page, "It tells nothing of the photos.")
	check("Recall and precision" in page, "It doesn't say what is measured.")
	check("photo_3.png" in page, "It has no table of the photos.")
	check_equal(worker.save_html_report(path), OK, "the page without photos")
	check(not "Fidelity to the photos" in FileAccess.get_file_as_string(path), "It tells of them.")


func _wait() -> void:
	# One job begins the next.
	for i: int in 4:
		await _finish()
		_frame()


func _text(id: StringName) -> String:
	return (_dock.sections[&"fidelity"] as Fidelity)._figures[id].text


func test_the_dock_shows_q_before_and_after_an_edit() -> void:
	_begin(_photographed(true))
	var shown: Fidelity = _dock.sections[&"fidelity"] as Fidelity
	check(not shown._photos.visible, "It shows Q without measuring.")
	shown.follow.button_pressed = true
	await _wait()
	check(shown._photos.visible, "It doesn't show Q: %s" % _session.photos.sentence)
	var first: Dictionary = {}
	for id: StringName in shown._lines:
		first[id] = _text(id)
		check(first[id] != "-", "%s isn't told." % id)
		var figure: Label = shown._figures[id]
		check(figure.tooltip_text.length() > 40, "%s has no tooltip." % id)
	var measured: Dictionary = _session.scan.fidelity.get_current()
	var found: Dictionary = _session.photos.cloud
	var q: float = found["information"] * found["reconstruction"] * measured["skeleton"]
	check_equal(first[&"quality"], "%.3f" % q, "Q")
	var title: Label = shown._lines[&"quality"].get_child(0) as Label
	check(title.text in ["Q · good", "Q · fair", "Q · poor"], "The verdict is " + title.text)
	check("masks of 6 photos" in shown.judged.text, shown.judged.text)
	check(not shown.masks.visible, "It asks for masks that it has.")
	_session.run("Prune", "prune_order order=1")
	_frame()
	check(_session.photos.stale or _session.photos.is_measuring(), "The outline is not old.")
	check(shown._figures[&"recall"].modulate.a < 1.0, "It doesn't look old.")
	await _wait()
	check_equal(shown._figures[&"recall"].modulate.a, 1.0, "how the new one looks")
	check(_text(&"quality").begins_with("▼"), "Q is " + _text(&"quality"))
	check(_text(&"recall").begins_with("▼"), "Recall is " + _text(&"recall"))
	check_equal(shown._before[&"recall"].text, first[&"recall"], "recall before")
	check_equal(shown._before[&"quality"].text, first[&"quality"], "Q before")
	check_equal(title.text, "Q · poor", "the verdict of a tree without branches")
	check_equal(_text(&"information"), first[&"information"], "I")
	check_equal(_text(&"reconstruction"), first[&"reconstruction"], "R_3d")
	_undo.undo()
	_frame()
	await _wait()
	for id: StringName in first:
		check_equal(_text(id).trim_prefix("▲ ").trim_prefix("▼ "), first[id], "%s after undo" % id)
	_end()


func test_an_edit_while_the_photos_are_asked_is_not_missed() -> void:
	_begin(_photographed(true))
	var shown: Fidelity = _dock.sections[&"fidelity"] as Fidelity
	shown.follow.button_pressed = true
	while not _session.photos.is_measuring():
		await tree.process_frame
		_frame()
	_session.run("Prune", "prune_order order=1")
	_frame()
	await _wait()
	var worker: TreeReconstructor = TreeReconstructor.new()
	worker.load_outlines(_session.tree, _session.scan.points, _session.photos.get_folders())
	check_equal(_session.photos.outline, worker.measure_outline(_session.tree), "the outline")
	check(not _session.photos.stale, "It is still old.")
	_end()


func test_the_dock_says_where_it_is_precision_only() -> void:
	_begin(_photographed(false))
	var shown: Fidelity = _dock.sections[&"fidelity"] as Fidelity
	shown.follow.button_pressed = true
	await _wait()
	check(_text(&"quality").begins_with("≤"), "Q is " + _text(&"quality"))
	check(_text(&"precision").begins_with("≤"), "Precision is " + _text(&"precision"))
	check(not shown._lines[&"recall"].visible, "It tells of recall.")
	check("precision only" in shown.judged.text, shown.judged.text)
	check(shown.masks.visible, "There is no way to masks.")
	_write_masks(_photos.photos.path_join("../elsewhere"))
	_session.photos.take_masks(_photos.photos.path_join("../elsewhere"))
	await _wait()
	check(shown._lines[&"recall"].visible, "Recall isn't told.")
	check(not _text(&"quality").begins_with("≤"), "Q is " + _text(&"quality"))
	_session.photos.take_masks("user://nowhere")
	await _wait()
	check_equal(_text(&"quality"), "-", "Q without masks")
	check("There is no folder" in shown.judged.text, shown.judged.text)
	_end()


func test_a_scan_without_photos_has_no_q() -> void:
	_begin(_scanned())
	var shown: Fidelity = _dock.sections[&"fidelity"] as Fidelity
	shown.follow.button_pressed = true
	await _wait()
	check(not shown._photos.visible, "Q is made up.")
	check(_text(&"skeleton") != "-", "R_s isn't told.")
	_end()
