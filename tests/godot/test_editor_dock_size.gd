extends "./dock_suite.gd"
## The dock "Tree": what is made again of photos keeps the size that these told.

const PhotoFiles := preload("./photo_files.gd")
const Stages := preload("res://addons/tree_reconstruction/editor/dock/stages.gd")

const UNIT: float = 4.0


func _stages() -> Stages:
	return _dock.sections[&"stages"] as Stages


# A tree whose size the photos' GPS told, as its file has it.
func _sized_by_gps() -> TreeReconstruction:
	var files: PhotoFiles = PhotoFiles.new(folder.path_join("gps"))
	files.tell_places(UNIT)
	var worker: TreeReconstructor = TreeReconstructor.new()
	var made: TreeReconstruction = worker.reconstruct_photos(
		files.photos, folder.path_join("work"), {"colmap": files.colmap, "dense": false}
	)
	check(made != null, worker.get_error_message())
	if made == null:
		return null
	check(made.provenance["report"]["scale_from_gps"], "The GPS was not used.")
	var path: String = folder.path_join("sized.tres")
	ResourceSaver.save(made, path)
	return ResourceLoader.load(path, "", ResourceLoader.CACHE_MODE_IGNORE) as TreeReconstruction


func _height() -> float:
	return _session.tree.measure()["height"]


func test_a_tree_that_gps_has_sized_keeps_its_size() -> void:
	var made: TreeReconstruction = _sized_by_gps()
	if made == null:
		return
	_begin(made)
	var scale: float = made.provenance["options"]["scale"]
	check_near(scale, UNIT, 0.02, "metres per unit")
	var height: float = _height()
	check(height > 2.0 * UNIT, "The tree is %.2f m high." % height)
	for stage: StringName in [Stages.SCAN, Stages.CLEAN, Stages.SKELETON]:
		_stages().rows[stage].run.pressed.emit()
		await _finish()
		check(not _stages()._sentence.visible, _stages()._sentence.text)
		check_equal(
			_session.tree.provenance["options"]["scale"], scale, "the scale after %s" % stage
		)
		check_near(_height(), height, 1e-4, "the height after %s" % stage)
	# With another option, and once that is undone.
	var clean: Stages.Row = _stages().rows[Stages.CLEAN]
	clean.get_field(&"remove_outliers").set_value(false)
	clean.run.pressed.emit()
	await _finish()
	check_equal(_session.tree.provenance["options"]["remove_outliers"], false, "the other option")
	check_near(_height(), height, 0.02 * height, "the height with another option")
	_undo.undo()
	_frame()
	check_near(_height(), height, 1e-4, "the height after undo")
	_end()


# What the user knows goes before what the photos tell, also where both are there.
func test_a_known_height_goes_before_gps() -> void:
	var made: TreeReconstruction = _sized_by_gps()
	if made == null:
		return
	_begin(made)
	var scan: Stages.Row = _stages().rows[Stages.SCAN]
	scan.get_field(&"known_height").set_value(7.0)
	scan.run.pressed.emit()
	await _finish()
	check(not _stages()._sentence.visible, _stages()._sentence.text)
	check_near(_height(), 7.0, 0.1, "the height")
	var options: Dictionary = _session.tree.provenance["options"]
	check(not options.has("scale"), "It has a scale, too.")
	# And the other way round.
	scan.get_field(&"scale").set_value(2.0)
	scan.run.pressed.emit()
	await _finish()
	check(not _stages()._sentence.visible, _stages()._sentence.text)
	options = _session.tree.provenance["options"]
	check_equal(options.get("scale"), 2.0, "the scale")
	check(not options.has("known_height"), "It has a known height, too.")
	_end()
