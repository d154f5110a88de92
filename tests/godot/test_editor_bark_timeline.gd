extends "./dock_suite.gd"
## The dock "Tree": how bark grew, scrubbed through.

const Bark := preload("res://addons/tree_reconstruction/editor/dock/bark.gd")
const Timeline := preload("res://addons/tree_reconstruction/editor/dock/bark_timeline.gd")
const GrownBark := preload("./test_grown_bark.gd")


func _timeline() -> Timeline:
	return (_dock.sections[&"bark"] as Bark).timeline


func _grow() -> void:
	(_dock.sections[&"bark"] as Bark).surface.edge.value = 0.08
	(_dock.sections[&"bark"] as Bark).grow.pressed.emit()
	await _finish()
	_frame()


func test_the_library_keeps_the_steps() -> void:
	var maker: TreeReconstructor = TreeReconstructor.new()
	var of: TreeReconstruction = GrownBark.stout()
	var plain: TreeReconstruction = maker.grow_bark(of, GrownBark.RECIPE)
	check(maker.get_growth_frames().is_empty(), "There are steps that nobody wanted.")
	var made: TreeReconstruction = maker.grow_bark(of, GrownBark.RECIPE, true)
	check_equal(made.grown_bark, plain.grown_bark, "the bark with its steps kept")
	var frames: Array[Dictionary] = maker.get_growth_frames()
	check(frames.size() > 20, "There are %d steps." % frames.size())
	check_equal(frames[-1].bark, made.grown_bark, "the last step")
	var before: int = 0
	for frame: Dictionary in frames:
		check(frame.step > before, "Step %d comes after step %d." % [frame.step, before])
		before = frame.step
	var first: Array = TreeReconstructor.draw_grown_bark(of, frames[0].bark)
	var last: Array = TreeReconstructor.draw_grown_bark(of, frames[-1].bark)
	var small: PackedInt32Array = first[Mesh.ARRAY_INDEX]
	var large: PackedInt32Array = last[Mesh.ARRAY_INDEX]
	check(small.size() > 0 and small.size() < large.size(), "It does not grow.")
	check_equal(large.size(), 3 * int(maker.get_report().triangles), "without tubes")
	maker.cancel()
	check(maker.grow_bark(of, GrownBark.RECIPE, true) == null, "It was not cancelled.")


func test_bad_steps_are_refused() -> void:
	expect_error("damaged")
	check_equal(
		TreeReconstructor.draw_grown_bark(GrownBark.stout(), "no bark".to_utf8_buffer()),
		[],
		"what is drawn of no bark"
	)


func test_scrubbing_shows_steps_instead_of_the_tree() -> void:
	var of: TreeReconstruction = GrownBark.stout()
	_begin(of)
	check(not _timeline().visible, "There is a slider without grown bark.")
	await _grow()
	var shown: Timeline = _timeline()
	check(shown.visible and shown._line.visible and not shown.record.visible, "There is no slider.")
	check_equal(shown.slider.value, shown.slider.max_value, "where the slider begins")
	check(not _session.view.growing, "The tree is hidden.")
	var steps: int = _undo.get_history_count()
	var revision: int = of.get_bark_revision()
	shown.slider.value = 3.0
	check(_session.view.growing, "The tree is not hidden.")
	var early: int = shown._frames.get_triangle_count()
	var started: int = Time.get_ticks_msec()
	shown.slider.value = shown.slider.max_value - 1.0
	check(Time.get_ticks_msec() - started < 2000, "A jump takes too long.")
	var late: int = shown._frames.get_triangle_count()
	check(early > 0 and late > early, "There are %d and %d triangles." % [early, late])
	shown.slider.value = shown.slider.max_value
	check(not _session.view.growing, "The tree is not shown at the end.")
	shown.slider.value = 1.0
	shown.back.pressed.emit()
	check(not _session.view.growing, "The tree is not shown again.")
	check_equal(shown.slider.value, shown.slider.max_value, "where the slider is")
	check_equal(_undo.get_history_count(), steps, "steps of the history")
	check_equal(of.get_bark_revision(), revision, "the bark's revision")
	_end()


func test_it_plays_and_ends_with_the_tree() -> void:
	_begin(GrownBark.stout())
	await _grow()
	var shown: Timeline = _timeline()
	shown.slider.value = shown.slider.max_value - 4.0
	shown.play.pressed.emit()
	while not shown._timer.is_stopped():
		await tree.process_frame
		_frame()
	check_equal(shown.slider.value, shown.slider.max_value, "where it ends")
	check(not _session.view.growing, "The tree is not shown at the end.")
	shown.play.pressed.emit()
	check_equal(shown.slider.value, 0.0, "where it begins anew")
	shown.play.pressed.emit()
	check(shown._timer.is_stopped(), "It does not pause.")
	# Folding the section ends it.
	_dock.set_folded(["bark"])
	await tree.process_frame
	await tree.process_frame
	check(not _session.view.growing, "The tree is hidden for good.")
	_end()


func test_without_steps_it_grows_once_more_and_changes_nothing() -> void:
	var made: TreeReconstruction = TreeReconstructor.new().grow_bark(
		GrownBark.stout(), GrownBark.RECIPE
	)
	_begin(made)
	var shown: Timeline = _timeline()
	check(shown.record.visible and not shown._line.visible, "There are steps of nothing.")
	var bark: PackedByteArray = made.grown_bark
	shown.record.pressed.emit()
	_frame()
	check(shown.record.disabled, "It can be asked twice at once.")
	_session.jobs.cancel(_session.jobs.get_running()[0])
	await _finish()
	_frame()
	check(shown.record.visible and not shown.record.disabled, "It can't be asked again.")
	shown.record.pressed.emit()
	await _finish()
	_frame()
	check(shown._line.visible, "There is no slider: %s" % _said)
	check_equal(made.grown_bark, bark, "the bark")
	check_equal(_undo.get_history_count(), 0, "steps of the history")
	shown.slider.value = 2.0
	# An edit of the wood ends it.
	_session.run("Cut", "cut node=13")
	_frame()
	check(not _session.view.growing and not shown.visible, "A stale surface is scrubbed.")
	_end()
