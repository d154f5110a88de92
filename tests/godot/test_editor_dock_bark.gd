extends "./dock_suite.gd"
## The dock "Tree": bark that grows.

const Bark := preload("res://addons/tree_reconstruction/editor/dock/bark.gd")
const Recipe := preload("res://addons/tree_reconstruction/editor/dock/growth_recipe.gd")
const AllTools := preload("res://addons/tree_reconstruction/editor/tools/all_tools.gd")
const Picker := preload("res://addons/tree_reconstruction/editor/viewport/picker.gd")
const GrownBark := preload("./test_grown_bark.gd")


func _bark() -> Bark:
	return _dock.sections[&"bark"] as Bark


# Coarse, so that it is quick.
func _grow() -> void:
	_bark().surface.edge.value = 0.08
	_bark().grow.pressed.emit()
	await _finish()
	_frame()


func test_a_burl_is_added_and_grown_as_one_step() -> void:
	var of: TreeReconstruction = GrownBark.stout()
	_begin(of)
	var shown: Bark = _bark()
	check(shown.remove.disabled and shown.back.disabled, "There is something to take away.")
	check("tubes" in shown._notice.text, shown._notice.text)
	shown.add.pressed.emit()
	check_equal(shown.list.item_count, 1, "burls")
	check_near(shown.fields["radius"].value, 0.32, 1e-6, "the radius: twice the trunk's")
	shown.fields["along"].value = 0.8
	shown.fields["around"].value = 45.0
	check("0.80" in shown.list.get_item_text(0), shown.list.get_item_text(0))
	check_equal(_undo.get_history_count(), 0, "steps before it grows")
	await _grow()
	check(of.has_grown_bark() and not of.is_bark_stale(), "No bark has grown: %s" % _said)
	check("burl along=0.8 around=45 radius=0.32" in of.growth_recipe, of.growth_recipe)
	check_equal(_undo.get_history_count(), 1, "steps")
	check_equal(_undo.get_action_name(0), "Grow Bark", "the step")
	check("as this recipe" in shown._notice.text, shown._notice.text)
	check_equal(shown.list.item_count, 1, "burls of the tree's own recipe")
	_undo.undo()
	_frame()
	check(not of.has_grown_bark() and of.growth_recipe.is_empty(), "Undo leaves something.")
	check_equal(shown.list.item_count, 0, "burls after undo")
	_undo.redo()
	_frame()
	check(of.has_grown_bark(), "Redo has no bark.")
	check_equal(shown.list.item_count, 1, "burls after redo")
	shown.back.pressed.emit()
	_frame()
	check(not of.has_grown_bark() and of.growth_recipe.is_empty(), "It is no tube again.")
	_undo.undo()
	check(of.has_grown_bark(), "It does not come back.")
	_end()


func test_a_stale_surface_says_so_and_grows_again() -> void:
	var of: TreeReconstruction = GrownBark.stout()
	_begin(of)
	await _grow()
	var shown: Bark = _bark()
	check_equal(shown.grow.text, "Grow", "the button")
	_said.clear()
	_session.run("Cut", "cut node=13")
	_frame()
	check(of.is_bark_stale(), "It is not stale.")
	check("wood beneath" in str(_said), str(_said))
	check("wood beneath" in shown._notice.text, shown._notice.text)
	check_equal(shown.grow.text, "Grow Again", "the button")
	_undo.undo()
	_frame()
	check(not of.is_bark_stale(), "It is stale after undo.")
	check_equal(shown.grow.text, "Grow", "the button after undo")
	_undo.redo()
	_frame()
	shown.grow.pressed.emit()
	await _finish()
	_frame()
	check(not of.is_bark_stale(), "It has not grown again: %s" % _said)
	_end()


func test_a_burl_goes_to_the_selected_branch_and_away() -> void:
	var of: TreeReconstruction = GrownBark.stout()
	_begin(of)
	var shown: Bark = _bark()
	_session.select([12])
	shown.add.pressed.emit()
	_session.select([])
	shown.add.pressed.emit()
	check("node 12" in shown.list.get_item_text(0), shown.list.get_item_text(0))
	check("trunk" in shown.list.get_item_text(1), shown.list.get_item_text(1))
	await _grow()
	# With its place, so that it is found on a tree that was made anew.
	check("node=12@" in of.growth_recipe, of.growth_recipe)
	check("node 12" in shown.list.get_item_text(0), shown.list.get_item_text(0))
	shown.list.select(0)
	shown.list.item_selected.emit(0)
	shown.remove.pressed.emit()
	check_equal(shown.list.item_count, 1, "burls")
	check("another recipe" in shown._notice.text, shown._notice.text)
	await _grow()
	check(not "node=12" in of.growth_recipe, of.growth_recipe)
	_end()


func test_what_is_edited_meanwhile_is_told() -> void:
	var of: TreeReconstruction = GrownBark.stout()
	_begin(of)
	_bark().surface.edge.value = 0.08
	_bark().grow.pressed.emit()
	check(_bark().grow.disabled, "It can be grown twice at once.")
	_session.run("Cut", "cut node=13")
	await _finish()
	_frame()
	check(of.is_bark_stale(), "The bark fits wood that it did not grow on.")
	check("edited while" in str(_said), str(_said))
	_end()


func test_it_is_cancelled_and_a_bad_recipe_is_told() -> void:
	var of: TreeReconstruction = GrownBark.stout()
	_begin(of)
	var shown: Bark = _bark()
	shown.surface.edge.value = 0.012
	shown.grow.pressed.emit()
	await tree.process_frame
	_session.jobs.cancel(_session.jobs.get_running()[0])
	await _finish()
	_frame()
	check(not of.has_grown_bark(), "It has grown all the same.")
	check(not shown.grow.disabled, "It can't be grown any more.")
	check_equal(_undo.get_history_count(), 0, "steps")
	_said.clear()
	shown.surface.edge.value = 1.0
	shown.grow.pressed.emit()
	await _finish()
	check("thick enough" in str(_said), str(_said))
	check_equal(_undo.get_history_count(), 0, "steps of what failed")
	_end()


func test_a_recipe_keeps_what_the_dock_does_not_know() -> void:
	var text: String = (
		"# by hand\nedges longest=0.05 shortest=0.02\nburl along=1 growth=2 from=0.3\n"
		+ 'wire file="a b.obj"\n'
	)
	var recipe: Recipe = Recipe.new(text)
	check_equal(recipe.get_text(), text, "the text")
	check_equal(recipe.get_features().size(), 2, "features")
	recipe.get_features()[0].values["along"] = "1.5"
	check_equal(recipe.get_text(), text.replace("along=1", "along=1.5"), "the text that was edited")


# Of the trunk up to its first branch, with a bump 0.6 m up towards -Z.
func _lumpy_points() -> PackedVector3Array:
	var points: PackedVector3Array = []
	for row: int in 64:
		var up: float = 0.015 * row
		var wood: float = 0.16 - 0.04 * up
		for column: int in 90:
			var angle: float = TAU * column / 90.0
			var across: float = wood * angle_difference(0.5 * PI, angle)
			var square: float = (up - 0.6) * (up - 0.6) + across * across
			var out: float = wood + 0.045 * exp(-0.5 * square / (0.06 * 0.06))
			points.append(Vector3(0.05 * up + out * cos(angle), up, -out * sin(angle)))
	return points


func test_the_scan_proposes_burls() -> void:
	var of: TreeReconstruction = GrownBark.stout()
	_begin(of)
	var shown: Bark = _bark()
	check(shown.from_scan.button.disabled, "A tree of no scan has lumps of its scan.")
	_end()
	of = GrownBark.stout()
	of.provenance = {"source": "lumpy.ply"}
	_begin(of)
	shown = _bark()
	check(not shown.from_scan.button.disabled, "The scan can't be asked.")
	shown.add.pressed.emit()
	_session.scan.wood = _lumpy_points()
	shown.from_scan.button.pressed.emit()
	check(shown.from_scan.button.disabled, "It can be asked twice at once.")
	await _finish()
	_frame()
	check("1 burls and 0 hollows" in str(_said), str(_said))
	check_equal(shown.list.item_count, 2, "burls: the one that was there, and the scan's")
	check_equal(_undo.get_history_count(), 0, "steps before it grows")
	shown.list.select(1)
	shown.list.item_selected.emit(1)
	check_near(shown.fields["along"].value, 0.6, 0.03, "how far up")
	check_near(shown.fields["around"].value, 90.0, 8.0, "which way")
	_said.clear()
	_session.scan.wood = PackedVector3Array([Vector3(50.0, 0.0, 0.0)])
	shown.from_scan.button.pressed.emit()
	await _finish()
	check("too few points" in str(_said), str(_said))
	check_equal(shown.list.item_count, 2, "burls")
	await _grow()
	check("from=0.7" in of.growth_recipe, of.growth_recipe)
	check_equal(_undo.get_history_count(), 1, "steps")
	_end()


func test_other_features_are_added_and_changed_by_their_fields() -> void:
	var of: TreeReconstruction = GrownBark.stout()
	_begin(of)
	var shown: Bark = _bark()
	var menu: PopupMenu = shown.more.get_popup()
	for i: int in range(1, Bark.BarkFeatures.KINDS.size()):
		menu.id_pressed.emit(i)
		check_equal(shown.list.item_count, i, "features")
		check(shown.list.is_selected(i - 1), "What was added is not selected.")
		check(shown.fields.has("along") and shown.fields.has("growth"), str(shown.fields.keys()))
		var title: String = shown.list.get_item_text(i - 1)
		check("trunk" in title and "=" not in title, title)
		check(menu.get_item_text(menu.get_item_index(i)) in title, title)
	# A post becomes a wire, which has other fields.
	shown.list.select(2)
	shown.list.item_selected.emit(2)
	check(shown.fields.has("radius") and not shown.fields.has("thickness"), "of a post")
	var shape: OptionButton = shown.choices["shape"] as OptionButton
	shape.select(1)
	shape.item_selected.emit(1)
	await tree.process_frame
	check(shown.fields.has("thickness") and not shown.fields.has("radius"), "of a wire")
	shown.fields["thickness"].value = 0.02
	shown.surface.twist.value = 1.5
	check_equal(_undo.get_history_count(), 0, "steps before it grows")
	await _grow()
	check(
		"shape=wire" in of.growth_recipe and "thickness=0.02" in of.growth_recipe, of.growth_recipe
	)
	check("grain twist=1.5" in of.growth_recipe, of.growth_recipe)
	check("hollow" in of.growth_recipe and "grain=yes" in of.growth_recipe, of.growth_recipe)
	_end()


func test_fusing_and_healing_are_switches_of_the_recipe() -> void:
	var of: TreeReconstruction = GrownBark.stout()
	_begin(of)
	var shown: Bark = _bark()
	shown.surface.edge.value = 0.08
	shown.surface.fuse.button_pressed = true
	shown.surface.cuts.button_pressed = true
	check_equal(shown.list.item_count, 0, "They are no features.")
	await _grow()
	check("fuse\n" in of.growth_recipe and "cuts" in of.growth_recipe, of.growth_recipe)
	_undo.undo()
	_frame()
	check(not shown.surface.fuse.button_pressed, "after undo")
	_undo.redo()
	_frame()
	check(shown.surface.fuse.button_pressed and shown.surface.cuts.button_pressed, "after redo")
	shown.surface.cuts.button_pressed = false
	await _grow()
	check("fuse" in of.growth_recipe and "cuts" not in of.growth_recipe, of.growth_recipe)
	_end()


func test_a_preset_comes_instead_and_keeps_the_edges() -> void:
	var of: TreeReconstruction = GrownBark.stout()
	_begin(of)
	var shown: Bark = _bark()
	var menu: PopupMenu = shown.more.get_popup()
	shown.surface.edge.value = 0.08
	shown.add.pressed.emit()
	for i: int in menu.item_count:
		if menu.get_item_text(i) == "Old Oak":
			menu.id_pressed.emit(menu.get_item_id(i))
	check_equal(shown.list.item_count, 5, "features")
	check_near(shown.surface.edge.value, 0.08, 1e-6, "the edges")
	check_near(shown.surface.twist.value, 0.8 * 0.22 / 0.108, 0.02, "the grain's twist")
	await _grow()
	check(of.has_grown_bark(), "It has not grown: %s" % _said)
	_end()


func test_a_preset_brings_edges_where_there_are_none() -> void:
	var of: TreeReconstruction = GrownBark.stout()
	_begin(of)
	var shown: Bark = _bark()
	var own: Recipe.Line = Recipe.new(TreeReconstructor.scale_growth_preset("old_oak", of)).find(
		"edges"
	)
	shown.take_preset("old_oak")
	check_near(shown.surface.edge.value, own.values["longest"].to_float(), 1e-6, "the edges")
	shown.take_preset("spiral_grain")
	var lines: Array[Recipe.Line] = shown._recipe.lines
	check_equal(
		lines.filter(func(line: Recipe.Line) -> bool: return line.command == "edges").size(),
		1,
		"lines of edges"
	)
	_end()


func test_while_bark_is_painted_each_change_is_a_step() -> void:
	var of: TreeReconstruction = GrownBark.stout()
	of.growth_recipe = "edges longest=0.08\n"
	_begin(of)
	AllTools.add_to(_session)
	_session.picker = Picker.new(_session)
	_session.choose(&"paint_bark")
	var shown: Bark = _bark()
	shown.add.pressed.emit()
	check_equal(_undo.get_history_count(), 1, "steps")
	await _finish()
	_frame()
	check(of.has_grown_bark() and not of.growth_pending, "It has not grown: %s" % _said)
	check("as this recipe" in shown._notice.text, shown._notice.text)
	shown.fields["growth"].value = 1.5
	check_equal(_undo.get_history_count(), 2, "steps after a field")
	await _finish()
	_undo.undo()
	_frame()
	check_near(shown.fields["growth"].value, 0.5, 1e-6, "the growth after undo")
	check(of.has_grown_bark() and not of.growth_pending, "The bark before is not there.")
	_undo.undo()
	_frame()
	check(not of.has_grown_bark(), "Bark is left.")
	_session.choose(&"")
	_session.tools.clear()
	_session.picker = null
	_end()
