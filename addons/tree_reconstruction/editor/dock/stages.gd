@tool
extends "section.gd"
## The way from the scan to the tree, stage by stage, each with its options; any stage can be done
## again from there.

const Row := preload("stage_row.gd")
const OptionField := preload("option_field.gd")
const Rerun := preload("rerun.gd")
const Words := preload("words.gd")

const SCAN: StringName = &"scan"
const CLEAN: StringName = &"clean"
const SKELETON: StringName = &"skeleton"
const PRUNE: StringName = &"prune"
const LEAVES: StringName = &"leaves"
const MESH: StringName = &"mesh"
const _FROM_SCAN: Array[StringName] = [SCAN, CLEAN, SKELETON]
const _SCAN_OPTIONS: PackedStringArray = [
	"up", "scale", "known_height", "known_length", "columns", "classes"
]
# Each tells the size. The reconstruction takes one of them.
const _SIZES: PackedStringArray = ["scale", "known_height", "known_length"]
const _CLEAN_OPTIONS: PackedStringArray = [
	"remove_extreme_colors",
	"white_above",
	"black_below",
	"remove_outliers",
	"neighbours",
	"outlier_deviations",
	"remove_fragments",
	"remove_ground",
	"separate_trees",
	"tree_number",
	"tree_position",
	"tell_leaves",
]
# Those that have a place elsewhere, or that nobody can see here.
const _HIDDEN: PackedStringArray = ["leaves", "flood_steps"]
# The stages of a report that belong to a row; all others are part of finding the skeleton.
const _REPORTED: Dictionary[String, StringName] = {
	"Read": SCAN, "Orient": SCAN, "Clean": CLEAN, "Leaves": CLEAN, "Score": &""
}

var rows: Dictionary[StringName, Row] = {}
var rerun: Rerun

var _no_scan: Label
var _sketch: Button
var _sentence: Label
var _node: TreeInstance3D
var _tree: TreeReconstruction
# What it was made by: a new reconstruction of the same tree has another one.
var _provenance: Dictionary


func get_id() -> StringName:
	return &"stages"


## Does the reconstruction again, with what the user changed of this stage and of later ones.
func run_from(stage: StringName) -> void:
	if rerun.is_running() or session.tree == null:
		return
	var options: Dictionary = session.tree.provenance.get("options", {}).duplicate()
	for each: StringName in _FROM_SCAN.slice(_FROM_SCAN.find(stage)):
		var changed: Dictionary = rows[each].get_changed()
		_give_way(options, changed)
		options.merge(changed, true)
		rows[each].set_running(true)
	_sentence.visible = false
	rerun.start(options)


# What the tree had its size from, as from the photos' GPS, goes where the user tells it now.
static func _give_way(options: Dictionary, changed: Dictionary) -> void:
	for name: String in _SIZES:
		if changed.get(name):
			for other: String in _SIZES:
				options.erase(other)


# A tool asks for it; an option that is [code]null[/code] goes back to its default.
func _on_wanted(changed: Dictionary) -> void:
	if rerun.is_running() or session.tree == null:
		return
	var options: Dictionary = session.tree.provenance.get("options", {}).duplicate()
	options.merge(changed, true)
	for name: String in changed:
		if changed[name] == null:
			options.erase(name)
	for stage: StringName in _FROM_SCAN:
		rows[stage].set_running(true)
	_sentence.visible = false
	rerun.start(options)


func close() -> void:
	session.reconstruction_wanted.disconnect(_on_wanted)
	rerun.ended.disconnect(_on_ended)
	rerun.close()
	_watch(null)


func _build() -> void:
	title = "Stages"
	tooltip_text = "How the scan became this tree. Unfold a stage to change its options."
	rerun = Rerun.new(session)
	rerun.ended.connect(_on_ended)
	session.reconstruction_wanted.connect(_on_wanted)
	_no_scan = Widgets.sentence(
		"This tree wasn't made of a scan, so its first stages can't be done again."
	)
	body.add_child(_no_scan)
	_sketch = Widgets.button(
		"Edit Sketch",
		"Opens the strokes that this tree was made of: draw on, and the tree follows.",
		&"Edit"
	)
	_sketch.pressed.connect(session.sketch_wanted.emit)
	body.add_child(_sketch)
	_add_row(
		SCAN,
		"Scan",
		"Reads the point cloud, finds which way is up, and how long its unit is.",
		"Reads the scan again and does everything from there, your edits too."
	)
	_add_row(
		CLEAN,
		"Clean",
		"Takes off what is no tree: the ground, stray points, other trees; and tells leaves from wood.",
		"Cleans the points again and does everything from there, your edits too."
	)
	_add_row(
		SKELETON,
		"Skeleton",
		"Finds the branches among the points, and how thick they are.",
		"Finds the branches again, and does your edits on them again."
	)
	_add_row(
		PRUNE,
		"Prune",
		"Cuts twigs that are longer than most. Your other edits are counted here too.",
		"Prunes the tree as it is now. You can undo it."
	)
	_add_row(
		LEAVES,
		"Leaves",
		"Which leaves the tree bears, and where.",
		"Lets the leaves grow again with these options."
	)
	_add_row(
		MESH,
		"Mesh",
		"The bark and the leaves as triangles.",
		"Builds the mesh again with these options."
	)
	_add_scan_fields()
	_add_edit_fields()
	_sentence = Widgets.sentence()
	_sentence.visible = false
	body.add_child(_sentence)


func _refresh() -> void:
	if session.node != _node:
		_watch(session.node)
		for row: Row in rows.values():
			row.set_failed(false)
			row.reset()
		_sentence.visible = false
	var provenance: Dictionary = {} if session.tree == null else session.tree.provenance
	if session.tree != _tree or not is_same(provenance, _provenance):
		_tree = session.tree
		_provenance = provenance
		_show_options()
	_show_scan_stages()
	_show_built()


func _add_row(stage: StringName, title: String, tip: String, run_tip: String) -> void:
	var row: Row = Row.new(title, tip, run_tip)
	rows[stage] = row
	body.add_child(row)
	row.run_requested.connect(_on_run_requested.bind(stage))


func _add_scan_fields() -> void:
	var titles: Dictionary[String, String] = Words.option_titles(self)
	for option: Dictionary in TreeReconstructor.get_option_list():
		var name: String = option.name
		if name in _HIDDEN:
			continue
		var stage: StringName = SKELETON
		if name in _SCAN_OPTIONS:
			stage = SCAN
		elif name in _CLEAN_OPTIONS:
			stage = CLEAN
		rows[stage].add_field(OptionField.new(option, titles.get(name, name.capitalize())))


func _add_edit_fields() -> void:
	_add_field(
		PRUNE,
		"factor",
		TYPE_FLOAT,
		"0,5,0.05,or_greater",
		"Longest twig",
		"How long a twig may be, as a multiple of the mean twig's length."
	)
	_add_field(
		PRUNE,
		"minimum_length",
		TYPE_FLOAT,
		"0,2,0.01,or_greater,suffix:m",
		"Left of a twig",
		"How much of every twig stays in any case, in metres."
	)
	_add_field(
		PRUNE,
		"spare_leader",
		TYPE_BOOL,
		"",
		"Spare the top",
		"Whether the trunk's own tip is left alone."
	)
	rows[PRUNE].set_values({"factor": 1.0, "minimum_length": 0.0, "spare_leader": true})
	_add_field(
		LEAVES,
		"maximum_leaves",
		TYPE_INT,
		"0,200000,100,or_greater",
		"At most",
		"The most leaves or sprays. Beyond it, fewer and larger ones cover the same area."
	)
	_add_field(
		LEAVES,
		"foliage_followed",
		TYPE_BOOL,
		"",
		"As scanned",
		"Whether leaves stand where the scan saw them. Without it, they stand on all twigs."
	)
	_add_field(
		LEAVES,
		"seed",
		TYPE_INT,
		"0,1000000,1,or_greater",
		"Seed",
		"Decides everything random about the leaves: the same seed gives the same leaves."
	)
	_add_field(
		MESH,
		"lod",
		TYPE_INT,
		"-1,4,1",
		"Level of detail",
		"-1 shows the level that suits the distance; 0 is always the finest one."
	)
	_add_field(MESH, "leaves", TYPE_BOOL, "", "With leaves", "Whether the tree bears its leaves.")


func _add_field(
	stage: StringName, name: String, type: int, range: String, title: String, tip: String
) -> void:
	var option: Dictionary = {
		"name": name,
		"type": type,
		"hint": PROPERTY_HINT_NONE if range.is_empty() else PROPERTY_HINT_RANGE,
		"hint_string": range,
		"description": tip,
	}
	rows[stage].add_field(OptionField.new(option, title))


func _show_options() -> void:
	var options: Dictionary = Rerun.options_of(_tree)
	for stage: StringName in _FROM_SCAN:
		rows[stage].set_values(options)


func _show_scan_stages() -> void:
	var provenance: Dictionary = {} if _tree == null else _tree.provenance
	var report: Dictionary = provenance.get("report", {})
	var sketched: bool = provenance.get("sketch") is TreeSketch
	var scanned: bool = not Session.ScanData.source_of(_tree).is_empty()
	_no_scan.visible = _tree != null and not scanned and not sketched
	_sketch.visible = sketched
	for stage: StringName in _FROM_SCAN:
		rows[stage].visible = not sketched
	var times: Dictionary[StringName, float] = {}
	for entry: Dictionary in report.get("stages", []):
		var stage: StringName = _REPORTED.get(entry.name, SKELETON)
		times[stage] = times.get(stage, 0.0) + float(entry.ms)
	_show_count(SCAN, report.get("points_read", 0), tr("Points in the scan."), times.get(SCAN, 0.0))
	_show_count(CLEAN, report.get("points", 0), tr("Points that were kept."), times.get(CLEAN, 0.0))
	_show_count(
		SKELETON,
		report.get("nodes", 0),
		tr("Nodes of the skeleton as it was found."),
		times.get(SKELETON, 0.0)
	)
	for stage: StringName in _FROM_SCAN:
		rows[stage].run.disabled = not scanned or rerun.is_running()


func _show_count(stage: StringName, count: int, tip: String, milliseconds: float) -> void:
	rows[stage].show_result(Widgets.grouped(count) if count > 0 else "", tip, milliseconds)


func _show_built() -> void:
	for stage: StringName in [PRUNE, LEAVES, MESH]:
		rows[stage].run.disabled = _tree == null
	if _tree == null:
		return
	var edits: int = 0
	for line: String in _tree.edit_log.split("\n", false):
		edits += 0 if line.begins_with("#") or line.begins_with("frame ") else 1
	rows[PRUNE].show_result(
		Widgets.grouped(_tree.get_node_count()), tr("Nodes after your %d edits.") % edits, 0.0
	)
	(
		rows[LEAVES]
		. set_values(
			{
				"maximum_leaves": _rules().maximum_leaves,
				"foliage_followed": _tree.foliage_followed,
				"seed": _tree.seed,
			}
		)
	)
	rows[MESH].set_values({"lod": _node.lod, "leaves": _node.leaves})
	rows[LEAVES].get_field(&"foliage_followed").visible = _tree.has_foliage()
	_show_count(
		LEAVES,
		_node.get_leaf_count(),
		tr("Leaves or sprays of leaves."),
		_node.get_leaf_build_time()
	)
	_show_count(
		MESH,
		_node.get_triangle_count(),
		tr("Triangles of bark and leaves."),
		_node.get_bark_build_time()
	)


func _rules() -> Resource:
	return _tree.leaf_rule if _tree.leaf_rule != null else _tree


func _watch(node: TreeInstance3D) -> void:
	if is_instance_valid(_node) and _node.rebuilt.is_connected(_on_rebuilt):
		_node.rebuilt.disconnect(_on_rebuilt)
	_node = node
	if _node != null:
		_node.rebuilt.connect(_on_rebuilt)


func _on_rebuilt() -> void:
	if session.node == _node and session.tree == _tree and is_visible_in_tree():
		_show_built()


func _on_run_requested(stage: StringName) -> void:
	if session.tree == null:
		return
	match stage:
		PRUNE:
			var values: Dictionary = rows[PRUNE].get_values()
			var command: String = (
				"prune factor=%s minimum_length=%s spare_leader=%s"
				% [values.factor, values.minimum_length, "yes" if values.spare_leader else "no"]
			)
			session.run(tr("Prune"), command)
			rows[PRUNE].set_values(values)
		LEAVES:
			_set_changed(LEAVES, tr("Change Leaves"))
		MESH:
			for option: String in rows[MESH].get_changed():
				session.set_value(
					tr("Change Mesh"), session.node, option, rows[MESH].get_values()[option]
				)
			session.node.rebuild()
		_:
			run_from(stage)
			_show_scan_stages()


func _set_changed(stage: StringName, step: String) -> void:
	var changed: Dictionary = rows[stage].get_changed()
	for option: String in changed:
		var of: Object = _rules() if option == "maximum_leaves" else _tree as Object
		session.set_value(step, of, option, changed[option])
	if changed.is_empty():
		session.node.rebuild()


func _on_ended(sentence: String) -> void:
	for stage: StringName in _FROM_SCAN:
		var was: bool = rows[stage].state == Row.State.RUNNING
		rows[stage].set_running(false)
		if was and not sentence.is_empty():
			rows[stage].set_failed(true)
	_sentence.text = sentence
	_sentence.visible = not sentence.is_empty()
	invalidate()
	update()
