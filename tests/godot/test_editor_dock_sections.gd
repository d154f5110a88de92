extends "./dock_suite.gd"
## The dock "Tree": fidelity, L-strings, twigs, leaves.

const Fidelity := preload("res://addons/tree_reconstruction/editor/dock/fidelity.gd")
const LString := preload("res://addons/tree_reconstruction/editor/dock/lstring.gd")
const Twigs := preload("res://addons/tree_reconstruction/editor/dock/twigs.gd")
const TwigDrop := preload("res://addons/tree_reconstruction/editor/dock/twig_drop.gd")
const Leaves := preload("res://addons/tree_reconstruction/editor/dock/leaf_rule.gd")


func test_fidelity_is_shown_before_and_after_an_edit() -> void:
	_begin(_scanned())
	var shown: Fidelity = _dock.sections[&"fidelity"] as Fidelity
	check(shown.next.disabled, "There are doubtful places without measuring.")
	shown.follow.button_pressed = true
	await _finish()
	_frame()
	var first: String = shown._figures[&"explained"].text
	check(first.ends_with("%"), "The share is '%s'." % first)
	check_equal(shown._before[&"explained"].text, "", "the share before")
	_session.run("Prune", "prune_order order=1")
	_frame()
	await _finish()
	_frame()
	check_equal(shown._before[&"explained"].text, first, "the share before the edit")
	check(shown._figures[&"explained"].text.begins_with("▼"), "Less is not shown as less.")
	shown.heat.button_pressed = true
	check(_session.view.points, "The points are hidden.")
	check_equal(
		_session.view.point_colors, _session.view.PointColors.FIDELITY, "the points' colours"
	)
	shown.next.pressed.emit()
	check(shown.doubtful.visible, "Nothing is said of doubtful places.")
	_end()


func test_another_tree_is_compared_with_its_own_scan() -> void:
	_begin(_scanned())
	var shown: Fidelity = _dock.sections[&"fidelity"] as Fidelity
	shown.follow.button_pressed = true
	await _finish()
	var first: TreeInstance3D = _session.node
	var second: TreeInstance3D = TreeInstance3D.new()
	second.reconstruction = TreeReconstructor.new().reconstruct_file(write_scan("other.xyz", 1500))
	tree.root.add_child(second)
	_session.edit_node(second)
	_frame()
	await _finish()
	_frame()
	check(shown.follow.button_pressed, "It no longer follows.")
	check(shown._figures[&"explained"].text.ends_with("%"), "The other tree is not measured.")
	first.free()
	_end()


func test_a_report_is_written() -> void:
	_begin(_scanned())
	var path: String = folder.path_join("report.html")
	(_dock.sections[&"fidelity"] as Fidelity).save_report(path)
	await _finish()
	check("<html" in FileAccess.get_file_as_string(path), "There is no page.")
	_end()


func test_the_string_follows_the_selection_until_it_is_edited() -> void:
	_begin(grown_tree(6))
	var shown: LString = _dock.sections[&"lstring"] as LString
	var whole: String = shown.text.text
	check(shown.apply.disabled, "What is not edited can be applied.")
	var fork: int = _session.tree.get_branch_nodes()[3]
	_session.select([fork])
	_frame()
	var branch: String = shown.text.text
	check(branch != whole, "The text is still that of the whole tree.")
	check_equal(
		LString.on_one_line(branch).replace(" ", ""),
		LSystem.write_string(_session.tree, fork),
		"the branch"
	)
	shown.text.text = "F(0.5)[+(40)F(0.3)]F(0.4)"
	shown.text.text_changed.emit()
	_session.select([_session.tree.get_leaves()[0]])
	_frame()
	check_equal(shown.text.text, "F(0.5)[+(40)F(0.3)]F(0.4)", "what was typed")
	var before: Dictionary = _session.tree.skeleton
	shown.apply.pressed.emit()
	check_equal(_undo.get_history_count(), 1, "steps: " + ", ".join(_said))
	check(_session.tree.skeleton != before, "Nothing was changed.")
	check(shown.apply.disabled, "What was applied can be applied again.")
	var lines: String = LSystem.write_string(_session.tree, shown._node)
	check_equal(lines.count("F"), 3, "segments of the new branch")
	_undo.undo()
	check_equal(_session.tree.skeleton, before, "the tree after undo")
	_end()


func test_a_mistake_in_a_string_is_told_by_its_place() -> void:
	_begin(grown_tree(6))
	var shown: LString = _dock.sections[&"lstring"] as LString
	_session.select([_session.tree.get_branch_nodes()[3]])
	_frame()
	shown.text.text = "F(0.5) # wood\n  [+(40)F(x)]\nF(0.4)"
	shown.text.text_changed.emit()
	shown.apply.pressed.emit()
	check(shown._error.visible, "Nothing is said.")
	check("line 2, column 11" in shown._error.text, shown._error.text)
	check_equal(shown.text.get_caret_line(), 1, "the caret's line")
	check_equal(_undo.get_history_count(), 0, "steps")
	shown.revert.pressed.emit()
	check(not shown._error.visible, "The mistake is still told.")
	_end()


func test_lines_of_a_string_mean_the_same() -> void:
	for text: String in ["F", "F[+F]F", "F[+F[F]][F]", "[F[F[F]]]F", "!(1)F(2)[-F][+F[&F]F]F"]:
		var lines: String = LString.broken_into_lines(text)
		check_equal(LString.on_one_line(lines).replace(" ", ""), text, "the string")
		check_equal(LString.on_one_line(lines).length(), lines.length(), "its length")


func test_a_long_string_waits() -> void:
	_begin(grown_tree(6, 9000))
	var shown: LString = _dock.sections[&"lstring"] as LString
	check_equal(shown.text.text, "", "the long text")
	check(shown.anyway.visible, "It can't be shown.")
	shown.anyway.pressed.emit()
	check(shown.text.text.length() > LString.MOST, "It is not shown.")
	_end()


func test_twigs_are_kept_in_a_library() -> void:
	_begin(grown_tree(6))
	var shown: Twigs = _dock.sections[&"twigs"] as Twigs
	check_equal(shown.list.item_count, 22, "presets")
	var path: String = folder.path_join("mine.tres")
	shown.make(path)
	check_equal(shown.list.item_count, 0, "twigs of a new library")
	_session.select([_session.tree.get_branch_nodes()[3]])
	_frame()
	check(not shown.add.disabled, "A branch can't be added.")
	shown.add.pressed.emit()
	check_equal(shown.list.item_count, 1, "twigs")
	var saved: TwigLibrary = ResourceLoader.load(path, "", ResourceLoader.CACHE_MODE_IGNORE)
	check_equal(saved.twigs.size(), 1, "twigs in the file")
	_undo.undo()
	check_equal(shown.list.item_count, 0, "twigs after undo")
	_undo.redo()
	shown.list.select(0)
	shown.list.item_selected.emit(0)
	shown.list.item_activated.emit(0)
	check(_session.scion.begins_with("!") or "F(" in _session.scion, "The scion is no string.")
	shown.remove.pressed.emit()
	check_equal(shown.list.item_count, 0, "twigs after removing")
	_end()


func test_a_dropped_twig_is_grafted() -> void:
	_begin(grown_tree(6))
	var shown: Twigs = _dock.sections[&"twigs"] as Twigs
	shown.list.select(3)
	shown.use_selected()
	check(_session.scion.begins_with("twig="), "The scion is " + _session.scion)
	var before: int = _session.tree.get_node_count()
	var at: int = _session.tree.get_leaves()[2]
	check(TwigDrop.graft(_session, _session.scion, at) != null, ", ".join(_said))
	check(_session.tree.get_node_count() > before, "Nothing grew.")
	var own: String = _session.tree.take_branch(_session.tree.get_branch_nodes()[2])
	check(TwigDrop.graft(_session, own, at) != null, ", ".join(_said))
	check_equal(_undo.get_history_count(), 2, "steps")
	_end()


func test_a_rule_made_for_a_tree_bears_the_same_leaves() -> void:
	for name: String in TreeReconstruction.get_leaf_preset_names():
		var made: TreeReconstruction = grown_tree(6)
		made.leaf_preset = name
		made.leaf_droop = 41.0
		made.leaf_internode = 0.08
		for arrangement: int in 2:
			made.leaf_rule = null
			# Setting a preset's own takes some presets' special one away.
			if made.leaf_arrangement != arrangement:
				made.leaf_arrangement = arrangement
			var before: PackedFloat32Array = made.build_leaf_buffer()
			made.leaf_rule = Leaves.shown_rule(made)
			check(made.build_leaf_buffer() == before, "The leaves of %s differ." % name)


func test_leaf_sliders_are_one_step() -> void:
	_begin(grown_tree(6))
	var shown: Leaves = _dock.sections[&"leaf_rule"] as Leaves
	for i: int in 5:
		shown.sliders[&"season"].value = 0.5 + i * 0.05
	check_near(_session.tree.leaf_rule.season, 0.7, 1e-6, "the season")
	check_equal(_undo.get_history_count(), 2, "steps")
	_undo.undo()
	check_near(_session.tree.leaf_rule.season, 0.4, 1e-6, "the season after undo")
	_undo.undo()
	check(_session.tree.leaf_rule == null, "The tree still has a rule.")
	_undo.redo()
	_undo.redo()
	check_near(_session.tree.leaf_rule.season, 0.7, 1e-6, "the season after redo")
	for i: int in 5:
		shown.sliders[&"fold"].value = 20.0 + i
	check_equal(_session.tree.leaf_rule.fold, 24.0, "the fold")
	_undo.undo()
	check_equal(_session.tree.leaf_rule.fold, 8.0, "the fold after undo")
	shown.preset.select(2)
	shown.preset.item_selected.emit(2)
	check_equal(_session.tree.leaf_rule.look, shown.preset.get_selected_metadata(), "the look")
	shown.form.select(1)
	shown.form.item_selected.emit(1)
	check_equal(_session.tree.leaf_rule.form, LeafRule.FORM_SIMPLE, "the form")
	shown._enabled.button_pressed = false
	check(not _session.tree.leaf_rule.enabled, "It bears leaves.")
	_end()


func test_leaf_rules_of_wood_are_told() -> void:
	_begin(grown_tree(2))
	var shown: Leaves = _dock.sections[&"leaf_rule"] as Leaves
	shown.folded = false
	var side_branch: int = _session.tree.get_leaves()[0]
	_session.run("Leaves", "leaves where=below:%d rule=maple" % side_branch)
	_session.select(PackedInt32Array([side_branch]))
	_frame()
	check(shown._rules.visible and shown._rules.text.contains("maple: "), shown._rules.text)
	check(
		shown._selected.visible and shown._selected.text.contains("maple: "), shown._selected.text
	)
	_session.select(PackedInt32Array())
	_frame()
	check(not shown._selected.visible, "Nothing is selected, and the dock tells of it.")
	_end()
