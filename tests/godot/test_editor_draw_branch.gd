extends "./tools_suite.gd"
## The tool that draws a missing branch, and the cameras that it looks through.

const BranchScan := preload("./branch_scan.gd")
const Branch := preload("res://addons/tree_reconstruction/editor/tools/draw_branch.gd")
const Pinhole := preload("res://addons/tree_reconstruction/editor/tools/pinhole.gd")

var _given: BranchScan


func _draw(places: PackedVector2Array, let_go: bool = true) -> void:
	check(_button(places[0], true), "The press was left.")
	for place: Vector2 in places:
		check(_hover(place, true), "The drag was left.")
	if let_go:
		check(_button(places[-1], false), "The release was left.")


func _seen() -> PackedVector2Array:
	var line: PackedVector2Array = []
	for i: int in _given.axis.size() - 1:
		for part: int in 4:
			var place: Vector3 = _given.axis[i].lerp(_given.axis[i + 1], part / 4.0)
			line.append(_session.picker.project_place(_camera, place))
	return line


func _wait_for_jobs() -> void:
	for i: int in 3000:
		await tree.create_timer(0.01).timeout
		_session.update()
		if _session.jobs.get_running().is_empty() and not _tool().is_busy():
			return
	check(false, "The work did not end.")


func _tool() -> Branch:
	return _session.tool as Branch


func _begin_branch() -> void:
	_given = BranchScan.new(write_scan("scan.xyz"))
	_begin(_given.tree, &"draw_branch")


func test_a_stroke_becomes_a_branch() -> void:
	_begin_branch()
	var log: String = _made.edit_log
	var points: PackedVector3Array = _given.points
	var without: float = _made.measure_fidelity(points)["explained"]
	# The scan is not read yet: the stroke waits for it.
	check(_session.scan.is_loading(), "The scan is not asked for.")
	_draw(_seen())
	check(_tool().is_busy(), "Nothing is done with the stroke.")
	check_equal(_made.skeleton, _before, "the tree before the branch is made")
	await _wait_for_jobs()
	check(_made.edit_log.begins_with(log), "The log forgot what was before.")
	check_equal(_made.edit_log.count("graft"), log.count("graft") + 1, "grafts in the log")
	check(not _session.selection.is_empty(), "The new wood isn't selected.")
	var again: float = _made.measure_fidelity(points)["explained"]
	check(
		again > without + 0.6 * (_given.explained - without),
		"%f was explained, %f without it, %f again" % [_given.explained, without, again]
	)
	# What is said: fidelity before and after, how much was measured, twigs.
	check_sentence(_said[-1], "what is said")
	for part: String in ["Fidelity R_s 0.", " → ", "explained", "twigs", "the scan shows"]:
		check(part in _said[-1], "'%s' is not in '%s'." % [part, _said[-1]])
	var figures: PackedStringArray = _said[-1].get_slice("explained ", 1).split(" % → ")
	check(absf(figures[0].to_float() - 100.0 * without) < 1.5, "%s, %f" % [figures, without])
	check(figures[1].to_float() > figures[0].to_float(), "It did not become better: %s" % figures)
	_check_one_step("a branch")
	_end()


func test_the_stroke_is_drawn_and_given_up() -> void:
	_begin_branch()
	await _wait_for_jobs()
	var line: PackedVector2Array = _seen()
	_draw(line, false)
	check(_tool().is_held(), "No stroke is drawn.")
	check(_wheel(line[-1], MOUSE_BUTTON_WHEEL_UP), "The wheel zooms below the stroke.")
	check(_key(KEY_DELETE), "A key comes through while the stroke is drawn.")
	check(_key(KEY_ESCAPE), "Escape was left.")
	check(not _tool().is_busy(), "It is drawn on.")
	check(not _button(line[-1], false), "A release without a stroke was taken.")
	# By the right button.
	_draw(line, false)
	check(_button(line[-1], true, MOUSE_BUTTON_RIGHT), "The right button was left.")
	check(not _tool().is_busy(), "It is drawn on.")
	# The button was let go beside the viewport.
	_draw(line, false)
	_hover(line[-1])
	check(not _tool().is_busy(), "It is drawn on.")
	# Another tool.
	_draw(line, false)
	_session.choose(&"select")
	_session.choose(&"draw_branch")
	check(not _tool().is_busy(), "It is drawn on.")
	# The camera was moved.
	_draw(line, false)
	_camera.global_position += Vector3(0.5, 0, 0)
	check(_button(line[-1], false), "The release was left.")
	check("view was moved" in _said[-1], _said[-1])
	check(not _tool().is_busy(), "A branch is made of it.")
	# While the branch is made.
	_draw(_seen())
	check(_tool().is_busy(), "No branch is made.")
	check(_key(KEY_ESCAPE), "Escape was left.")
	check(not _tool().is_busy(), "The branch is made all the same.")
	await _wait_for_jobs()
	# The dock's button ends it, too.
	_draw(_seen())
	await tree.process_frame
	for job: Session.Jobs.Job in _session.jobs.get_running():
		_session.jobs.cancel(job)
	await _wait_for_jobs()
	_check_untouched("strokes that were given up")
	# A click is none.
	var id: int = _find(_is_middle)
	check(_click(_at(id)), "The click was left.")
	check_equal(_session.get_active(), id, "the selected node")
	check_equal(_undo.get_history_count(), 0, "steps of a click")
	_end()


func test_strokes_wait_for_each_other() -> void:
	_begin_branch()
	var line: PackedVector2Array = _seen()
	_draw(line)
	# Another one, on a later part of the trunk, and an edit by somebody else meanwhile.
	var shift: Transform2D = Transform2D(0.0, Vector2(0, 25))
	_draw(shift * line)
	await tree.process_frame
	_session.run("Smooth", "smooth_radii")
	var count: int = _undo.get_history_count()
	await _wait_for_jobs()
	check_equal(_undo.get_history_count(), count + 2, "steps of two strokes: %s" % _said)
	while _undo.has_undo():
		_undo.undo()
	check_equal(_made.skeleton, _before, "the tree after all is undone")
	_end()


func test_a_stroke_that_is_no_branch_gets_a_sentence() -> void:
	_begin_branch()
	await _wait_for_jobs()
	_draw(PackedVector2Array([Vector2(5, 5), Vector2(40, 20), Vector2(60, 60)]))
	await _wait_for_jobs()
	check("near no wood" in _said[-1], _said[-1])
	# Uneven scales: no camera sees the tree so.
	var frame: Transform3D = _session.node.transform
	_session.node.transform = frame.scaled_local(Vector3(1, 2, 1))
	var line: PackedVector2Array = _seen()
	check(_button(line[0], true), "The press was left.")
	check(_hover(line[-1], true), "The drag was left.")
	_session.node.transform = frame
	check(not _tool().is_held(), "A stroke is drawn all the same.")
	check("scaled unevenly" in _said[-1], _said[-1])
	_check_untouched("strokes that are no branches")
	_end()


func test_without_a_scan_it_is_a_guess_and_says_so() -> void:
	_given = BranchScan.new(write_scan("scan.xyz"))
	_given.tree.provenance = {}
	_begin(_given.tree, &"draw_branch")
	check(_said.is_empty(), "Nobody has asked for points: %s" % _said)
	_draw(_seen())
	await _wait_for_jobs()
	check("There is no scan" in _said[-1] and "guessed" in _said[-1], _said[-1])
	_check_one_step("a guessed branch")
	_end()


func test_a_scan_that_is_gone_is_told_of() -> void:
	_given = BranchScan.new(write_scan("scan.xyz"))
	_given.tree.provenance = {"source": folder.path_join("gone.xyz")}
	_begin(_given.tree, &"draw_branch")
	_draw(_seen())
	await _wait_for_jobs()
	check("gone.xyz" in "\n".join(_said), "It is not said which scan is gone: %s" % _said)
	check("There is no scan" in _said[-1], _said[-1])
	_check_one_step("a guessed branch")
	_end()


func test_it_is_drawn_in_an_orthogonal_view_and_a_mirrored_one() -> void:
	for mirrored: bool in [false, true]:
		_begin_branch()
		_camera.set_orthogonal(_made.get_aabb().size.y * 2.0, 0.05, 100.0)
		if mirrored:
			_session.node.scale = Vector3(-1.5, 1.5, 1.5)
			var middle: Vector3 = _session.node.global_transform * _made.get_aabb().get_center()
			_camera.look_at_from_position(middle + Vector3(1, 0.5, 4), middle)
		var without: float = _made.measure_fidelity(_given.points)["explained"]
		_draw(_seen())
		await _wait_for_jobs()
		var again: float = _made.measure_fidelity(_given.points)["explained"]
		check(
			again > without + 0.6 * (_given.explained - without),
			"%f was explained, %f without it, %f again" % [_given.explained, without, again]
		)
		_check_one_step("a branch in an orthogonal view")
		_end()


func test_cameras_are_seen_through() -> void:
	_begin_branch()
	await _wait_for_jobs()
	var box: AABB = _made.get_aabb()
	var frame: Transform3D = _session.node.global_transform
	var size: Vector2 = _session.picker.get_size(_camera)
	for mirrored: bool in [false, true]:
		_session.node.scale = Vector3(-1.5, 1.5, 1.5) if mirrored else Vector3(1.5, 1.5, 1.5)
		frame = _session.node.global_transform
		for kind: int in 3:
			var near: float = 0.05
			match kind:
				0:
					_camera.set_perspective(50.0, near, 100.0)
				1:
					# As a lens whose axis is beside the middle of a part of a photo.
					_camera.set_frustum(near * 0.9, Vector2(0.3, -0.2) * near, near, 100.0)
				2:
					_camera.set_orthogonal(8.0, near, 100.0)
			var pinhole: Pinhole = Pinhole.new(_camera, size, frame, box)
			check_equal(pinhole.sentence, "", "what is wrong with it")
			var worst: float = 0.0
			for id: int in _made.get_node_ids():
				var place: Vector3 = _made.get_node_position(id)
				var shown: Vector2 = _session.picker.project_place(_camera, place)
				var wanted: Vector2 = pinhole.to_picture(PackedVector2Array([shown]))[0]
				var off: float = wanted.distance_to(_project(pinhole.camera, place))
				worst = maxf(worst, off)
			check(worst < 0.5, "Kind %d, mirrored %s: %.2f px off" % [kind, mirrored, worst])
	# So near that perspective would differ.
	_camera.set_orthogonal(0.01, 0.05, 100.0)
	check_sentence(Pinhole.new(_camera, size, frame, box).sentence, "a view of a hair")
	var leaning: Transform3D = frame
	leaning.basis.x += leaning.basis.y
	check_sentence(Pinhole.new(_camera, size, leaning, box).sentence, "a leaning node")
	_end()


static func _project(camera: Dictionary, place: Vector3) -> Vector2:
	var seen: Vector3 = (camera["transform"] as Transform3D).affine_inverse() * place
	return (camera["principal"] as Vector2) + Vector2(seen.x, -seen.y) * (camera["focal"] / -seen.z)
