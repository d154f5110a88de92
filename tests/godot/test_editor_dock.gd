extends "./dock_suite.gd"
## The dock "Tree": its stages, from the scan to the mesh, and its measurements.

const Stages := preload("res://addons/tree_reconstruction/editor/dock/stages.gd")
const Measurements := preload("res://addons/tree_reconstruction/editor/dock/measurements.gd")
const Row := preload("res://addons/tree_reconstruction/editor/dock/stage_row.gd")


func _stages() -> Stages:
	return _dock.sections[&"stages"] as Stages


func test_every_control_says_what_it_is() -> void:
	_begin(grown_tree(2))
	for control: Node in _dock.find_children("*", "Control", true, false):
		var asks: bool = (
			control is BaseButton
			or control is Range and not control is ScrollBar
			or control is ItemList
			or control is TextEdit
			or (control is LineEdit and not control.get_parent() is SpinBox)
		)
		var inner: bool = control.owner == null and control.get_parent() is ScrollContainer
		if asks and not inner:
			var tip: String = (control as Control).tooltip_text
			check(tip.ends_with("."), "%s has no tooltip." % _dock.get_path_to(control))
	_end()


func test_it_is_narrow() -> void:
	_begin(grown_tree(2))
	await tree.process_frame
	var width: float = _dock.get_combined_minimum_size().x
	check(width <= 300.0, "It needs %s pixels." % width)
	_end()


func test_without_a_tree_it_says_what_to_do() -> void:
	_begin(grown_tree(2))
	var node: TreeInstance3D = _session.node
	_session.edit_node(null)
	_frame()
	for section: Control in _dock.sections.values():
		check(not section.is_visible_in_tree(), "A section is shown.")
	_session.edit_node(node)
	_frame()
	for section: Control in _dock.sections.values():
		check(section.is_visible_in_tree(), "A section is hidden.")
	check(not _dock._no_tree.is_visible_in_tree(), "It says that there is no tree.")
	node.reconstruction = null
	_frame()
	check(_dock._no_tree.is_visible_in_tree(), "It doesn't say that there is no tree.")
	check(not _dock.sections[&"stages"].is_visible_in_tree(), "A section is shown without a tree.")
	_end()


func test_which_sections_are_folded_is_remembered() -> void:
	_begin(grown_tree(2))
	_dock.set_folded(["stages"])
	check_equal(_dock.get_folded(), PackedStringArray(["stages"]), "the folded ones")
	_end()


func test_a_tree_without_a_scan_can_not_be_scanned_again() -> void:
	_begin(grown_tree(2))
	for stage: StringName in [&"scan", &"clean", &"skeleton"]:
		check(_stages().rows[stage].run.disabled, "%s can be run." % stage)
		check_equal(_stages().rows[stage].state, Row.State.NONE, "the state")
	check(not _stages().rows[&"prune"].run.disabled, "It can't be pruned.")
	_end()


func test_a_changed_option_waits_until_its_stage_is_run() -> void:
	_begin(_scanned())
	var old: TreeReconstruction = _session.tree
	_session.run("Move", "move nodes=%d by=0.05,0,0" % old.get_leaves()[0])
	_frame()
	var row: Row = _stages().rows[&"skeleton"]
	check_equal(row.state, Row.State.DONE, "the state")
	var count: int = old.get_node_count()
	var shown: Variant = row.get_field(&"simplify_distance").get_value()
	row.get_field(&"simplify_distance").set_value(0.05)
	row.get_field(&"simplify_distance").edited.emit()
	check_equal(row.state, Row.State.CHANGED, "the state after a change")
	_frame()
	check_equal(row.state, Row.State.CHANGED, "the state a frame later")
	check(_session.tree == old, "It ran by itself.")
	row.run.pressed.emit()
	check_equal(row.state, Row.State.RUNNING, "the state while it runs")
	check(_dock.progress.get_child_count() > 0, "No progress is shown.")
	await _finish()
	var made: TreeReconstruction = _session.tree
	check_equal(made, old, "the resource")
	check_equal(made.provenance.options.simplify_distance, 0.05, "the option of the new tree")
	check(made.get_node_count() < count, "The option changed nothing: " + ", ".join(_said))
	check("move" in made.edit_log, "The edit was lost.")
	check_equal(row.state, Row.State.DONE, "the state at the end")
	_undo.undo()
	_frame()
	check_equal(made.get_node_count(), count, "the nodes after undo")
	check_equal(row.get_field(&"simplify_distance").get_value(), shown, "the option after undo")
	_undo.undo()
	check_equal(made.edit_log, "", "the log after the edit before was undone, too")
	_end()


func test_leaves_stay_as_they_were_set() -> void:
	_begin(_scanned())
	_session.tree.leaf_preset = "oak"
	_session.tree.leaf_droop = 33.0
	_session.tree.leaf_rule = LeafRule.from_preset("pine")
	_session.tree.seed = 77
	_stages().run_from(&"clean")
	await _finish()
	check_equal(_session.tree.leaf_preset, "oak", "the preset")
	check_equal(_session.tree.leaf_droop, 33.0, "the droop")
	check_equal(_session.tree.leaf_rule.look, "pine", "the rule")
	check_equal(_session.tree.seed, 77, "the seed")
	_end()


func test_a_failed_stage_says_why() -> void:
	var made: TreeReconstruction = _scanned()
	made.provenance["source"] = folder.path_join("gone.xyz")
	made.provenance = made.provenance
	_begin(made)
	_stages().rows[&"scan"].run.pressed.emit()
	await _finish()
	check_equal(_stages().rows[&"scan"].state, Row.State.FAILED, "the state")
	check_equal(_said.size(), 1, "sentences")
	check_sentence(_said[0], "the failure")
	check(_session.tree == made, "The tree is another one.")
	_end()


func test_work_can_be_cancelled() -> void:
	_begin(_scanned())
	var old: TreeReconstruction = _session.tree
	_stages().rows[&"scan"].run.pressed.emit()
	_session.jobs.cancel(_session.jobs.get_running()[0])
	await _finish()
	_frame()
	check(_session.tree == old, "The tree is another one.")
	check(_stages().rows[&"scan"].state != Row.State.RUNNING, "It still runs.")
	check(not _stages().rows[&"scan"].run.disabled, "It can't be run again.")
	_end()


func test_pruning_is_one_step() -> void:
	_begin(grown_tree(5))
	var before: int = _session.tree.get_node_count()
	_stages().rows[&"prune"].get_field(&"factor").set_value(0.5)
	_stages().rows[&"prune"].run.pressed.emit()
	check(_session.tree.get_node_count() < before, "Nothing was pruned.")
	check_equal(_undo.get_history_count(), 1, "steps")
	_undo.undo()
	check_equal(_session.tree.get_node_count(), before, "nodes after undo")
	_end()


func test_leaves_and_mesh_take_their_options() -> void:
	_begin(grown_tree(5))
	_stages().rows[&"leaves"].get_field(&"seed").set_value(9)
	_stages().rows[&"leaves"].run.pressed.emit()
	check_equal(_session.tree.seed, 9, "the seed")
	_stages().rows[&"mesh"].get_field(&"lod").set_value(2)
	_stages().rows[&"mesh"].run.pressed.emit()
	check_equal(_session.node.lod, 2, "the level")
	check_equal(_undo.get_history_count(), 2, "steps")
	_undo.undo()
	_undo.undo()
	check_equal(_session.tree.seed, 1, "the seed after undo")
	check_equal(_session.node.lod, -1, "the level after undo")
	await _session.node.rebuilt
	await tree.process_frame
	_end()


func test_measurements_follow_edits() -> void:
	_begin(grown_tree(5))
	var shown: Measurements = _dock.sections[&"measurements"] as Measurements
	check_equal(
		shown.values[&"nodes"].text, str(_session.tree.get_node_count()), "the number of nodes"
	)
	_session.run("Prune", "prune_order order=1")
	_frame()
	check_equal(
		shown.values[&"nodes"].text, str(_session.tree.get_node_count()), "nodes after an edit"
	)
	_end()


func test_the_radius_of_what_is_selected_can_be_set() -> void:
	_begin(grown_tree(5))
	var ids: PackedInt32Array = [_session.tree.get_root(), _session.tree.get_leaves()[0]]
	_session.select(ids)
	_frame()
	var shown: Measurements = _dock.sections[&"measurements"] as Measurements
	check_near(shown.radius.value, 100.0 * _session.tree.get_node_radius(ids[1]), 0.006, "radius")
	check_equal(_undo.get_history_count(), 0, "steps by looking")
	shown.radius.value = 12.5
	for id: int in ids:
		check_near(_session.tree.get_node_radius(id), 0.125, 1e-6, "the new radius")
	check_equal(_undo.get_history_count(), 1, "steps")
	_end()
