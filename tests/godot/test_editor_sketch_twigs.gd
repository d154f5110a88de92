extends "./session_suite.gd"
## The window 'Sketch Tree': whose twigs a sketch has, and what is folded away.

const SketchPanel := preload("res://addons/tree_reconstruction/editor/sketch/sketch_panel.gd")
const TestSketch := preload("./test_sketch.gd")

var _session: Session
var _panel: SketchPanel
var _scene: Node3D
var _drawn: TreeInstance3D


# A sketched tree, and another one beside it, whose twigs it may have.
func _open() -> void:
	_session = _session_with(TestSketch.source_tree())
	_scene = _session.node
	_scene.name = "OldOak"
	_drawn = TreeInstance3D.new()
	_drawn.name = "Drawn"
	_drawn.reconstruction = TreeReconstructor.new().sketch_tree(TestSketch.small_sketch())
	_scene.add_child(_drawn)
	_session.edit_node(_drawn)
	_panel = SketchPanel.new(_session)
	_panel.options.twigs.find_scene = func() -> Node: return _scene
	tree.root.add_child(_panel)
	_panel.set_node(_drawn)
	await _wait()


func _shut() -> void:
	_panel.close()
	_panel.free()
	_session.edit_node(null)
	_session.shut_down()
	_undo.clear_history()
	_undo.free()
	_scene.free()
	_session = null


func _wait() -> void:
	for frame: int in 3:
		_session.update()
		_panel.update()
		await tree.process_frame
	while not _session.jobs.get_running().is_empty() or _panel._due > 0:
		_session.update()
		_panel.update()
		await tree.process_frame
	for frame: int in 3:
		_session.update()
		_panel.update()
		await tree.process_frame


func _choose(part: String) -> void:
	var species: OptionButton = _panel.options.species
	species.get_popup().about_to_popup.emit()
	for i: int in species.item_count:
		if part in species.get_item_text(i):
			species.select(i)
			species.item_selected.emit(i)
			break
	await _wait()


func _words() -> PackedStringArray:
	var words: PackedStringArray = []
	for i: int in _panel.options.species.item_count:
		words.append(_panel.options.species.get_item_text(i))
	return words


func test_a_trees_twigs_are_chosen_and_undone() -> void:
	await _open()
	var plain: Dictionary = _drawn.reconstruction.skeleton
	await _choose("OldOak")
	check("Twigs of OldOak" in _words(), "It offers %s." % ", ".join(_words()))
	check(not "Twigs of Drawn" in _words(), "It offers the tree's own twigs.")
	var sketch: TreeSketch = _drawn.reconstruction.provenance["sketch"]
	check(sketch.twigs != "", "The sketch has no twigs of its own.")
	check_equal(sketch.species, "oak", "the kind of leaves")
	check_equal(_drawn.reconstruction.leaf_preset, "oak", "leaves of the tree")
	check(_drawn.reconstruction.skeleton != plain, "It's the same tree.")
	var shown: String = _panel.options.species.text
	check_equal(shown, "Twigs of OldOak", "what the choice shows")
	var made: Dictionary = _drawn.reconstruction.skeleton
	# Another seed keeps them.
	_panel.options.seed_field.value = 5
	await _wait()
	sketch = _drawn.reconstruction.provenance["sketch"]
	check(sketch.twigs != "" and sketch.seed == 5, "The seed takes the twigs away.")
	check(_drawn.reconstruction.skeleton != made, "Another seed gives the same tree.")
	_undo.undo()
	await _wait()
	check_equal(_drawn.reconstruction.skeleton, made, "the tree after an undo")
	_undo.undo()
	await _wait()
	check_equal(_drawn.reconstruction.skeleton, plain, "the tree after two")
	check_equal(_drawn.reconstruction.leaf_preset, "maple", "leaves after two")
	check_equal(_panel.options.species.get_selected_metadata(), "maple", "what is shown then")
	_undo.redo()
	await _wait()
	check_equal(_panel.options.species.text, "Twigs of OldOak", "what is shown after a redo")
	await _choose("Poplar")
	sketch = _drawn.reconstruction.provenance["sketch"]
	check_equal(sketch.twigs, "", "own twigs of a poplar")
	check_equal(_drawn.reconstruction.leaf_preset, "poplar", "leaves of a poplar")
	_shut()


func test_a_tree_without_twigs_gets_a_sentence() -> void:
	await _open()
	var pole: TreeReconstruction = TreeReconstruction.new()
	pole.skeleton = {}
	_scene.reconstruction = pole
	_panel.options.species.get_popup().about_to_popup.emit()
	check(not "Twigs of OldOak" in _words(), "It offers the twigs of nothing.")
	var said: Array[String] = []
	_session.said.connect(func(sentence: String, _kind: int) -> void: said.append(sentence))
	_panel.options.twigs.take(_panel.get_sketch(), "nothing", "res://none.tres")
	_panel.options.twigs.take(_panel.get_sketch(), "pole", pole)
	await _wait()
	check_equal(said.size(), 2, "sentences")
	check("no library" in "".join(said), "It says %s." % str(said))
	check("no tree to take" in "".join(said), "It says %s." % str(said))
	_shut()


func test_what_is_folded_away() -> void:
	await _open()
	check(_panel.options.more.folded, "All is open.")
	var plain: Dictionary = _drawn.reconstruction.skeleton
	_panel.options.more.trunk_radius.value = 0.3
	await _wait()
	var tree_made: TreeReconstruction = _drawn.reconstruction
	check_near(
		tree_made.get_node_radius(tree_made.get_root()), 0.3, 0.001, "the radius at the base"
	)
	_panel.options.more.depth.select(1)
	_panel.options.more.depth.item_selected.emit(1)
	await _wait()
	var sketch: TreeSketch = tree_made.provenance["sketch"]
	check_equal(sketch.depth, TreeSketch.DEPTH_PAPER, "the depth")
	_panel.options.more.crown.select(1)
	_panel.options.more.crown.item_selected.emit(1)
	await _wait()
	sketch = _drawn.reconstruction.provenance["sketch"]
	check_equal(sketch.crown, TreeSketch.CROWN_ALPHA, "the crown")
	check_near(sketch.trunk_radius, 0.3, 0.001, "the trunk's radius")
	for step: int in 3:
		_undo.undo()
		await _wait()
	check_equal(_drawn.reconstruction.skeleton, plain, "the tree after three undos")
	check_equal(_panel.options.more.trunk_radius.value, 0.0, "the radius shown")
	check_equal(_panel.options.more.depth.get_selected_metadata(), 0, "the depth shown")
	_shut()


func test_everything_has_a_tooltip() -> void:
	await _open()
	for node: Node in _panel.find_children("*", "Control", true, false):
		var control: Control = node as Control
		if control is BaseButton or control is SpinBox:
			check(control.tooltip_text != "", "%s has no tooltip." % _panel.get_path_to(control))
	_shut()
