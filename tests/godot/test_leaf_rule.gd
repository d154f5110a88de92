extends "./suite.gd"
## LeafRule: what it makes of a tree's leaves, how it is saved, and that trees hear of its changes.

const FLOATS_PER_LEAF: int = 20
const RULES: String = "res://addons/tree_reconstruction/presets/%s_rule.tres"


func test_every_preset_is_a_rule() -> void:
	for name: String in TreeReconstruction.get_leaf_preset_names():
		var rule: LeafRule = LeafRule.from_preset(name)
		check(rule != null, "%s is no rule." % name)
		check_equal(rule.enabled, name != "none", name + " bears leaves")
		var made: TreeReconstruction = grown_tree(3)
		made.leaf_preset = name
		var plain: PackedFloat32Array = made.build_leaf_buffer()
		made.leaf_rule = rule
		check_equal(made.build_leaf_buffer(), plain, "%s's leaves by preset and by rule" % name)
		if name == "none":
			continue
		check_equal(made.get_leaf_look(), name, "the look")
		var saved: LeafRule = load(RULES % name) as LeafRule
		check(saved != null, "The addon has no rule of %s." % name)
		for property: Dictionary in rule.get_property_list():
			if (
				property.usage & PROPERTY_USAGE_STORAGE
				and not property.name.begins_with("resource")
			):
				check_equal(
					saved.get(property.name), rule.get(property.name), name + "." + property.name
				)
	expect_error("is no leaf preset")
	check(LeafRule.from_preset("plastic") == null, "Plastic leaves.")


func test_the_tree_hears_of_changes() -> void:
	var made: TreeReconstruction = grown_tree(2)
	var rule: LeafRule = LeafRule.new()
	made.leaf_rule = rule
	var other: TreeReconstruction = grown_tree(3)
	other.leaf_rule = rule
	var count: Array[int] = [0, 0]
	made.changed.connect(func() -> void: count[0] += 1)
	other.changed.connect(func() -> void: count[1] += 1)
	rule.leaf_size = 0.4
	rule.arrangement = LeafRule.ARRANGEMENT_WHORLED
	rule.whorl_size = 5
	rule.density_by_height = Curve.new()
	check_equal(count, [4, 4] as Array[int], "what both trees heard of four changes")
	rule.density_by_height.add_point(Vector2(0.5, 1.0))
	check(count[0] > 4, "It did not hear of its curve's change.")
	made.leaf_rule = null
	var before: Array[int] = count.duplicate()
	rule.droop = 3.0
	check_equal(count[0], before[0], "what the tree heard without the rule")
	check(count[1] > before[1], "The other tree hears no more.")


func test_saves_and_loads() -> void:
	var made: TreeReconstruction = grown_tree(6)
	var rule: LeafRule = LeafRule.from_preset("maple")
	rule.form = LeafRule.FORM_PALMATE
	rule.leaflets = 5
	rule.fold = -33.0
	rule.season = 0.7
	rule.density_by_order = PackedFloat32Array([0.0, 0.5, 1.0])
	rule.density_by_radius = Curve.new()
	rule.density_by_radius.add_point(Vector2(0.0, 1.0))
	rule.density_by_radius.add_point(Vector2(1.0, 0.25))
	rule.season_colors = Gradient.new()
	made.leaf_rule = rule
	for extension: String in ["tres", "res"]:
		var path: String = folder.path_join("ruled." + extension)
		check_equal(ResourceSaver.save(made, path), OK, "saving " + extension)
		var read: TreeReconstruction = (
			ResourceLoader.load(path, "", ResourceLoader.CACHE_MODE_IGNORE) as TreeReconstruction
		)
		check_equal(
			read.build_leaf_buffer(), made.build_leaf_buffer(), "the leaves in ." + extension
		)
		check_equal(read.leaf_rule.leaflets, 5, "the leaflets")
		check_equal(read.leaf_rule.fold, -33.0, "the fold")
		check_equal(read.leaf_rule.get_season_tints(), rule.get_season_tints(), "the tints")
		check_equal(
			read.build_leaf_form_arrays()[Mesh.ARRAY_VERTEX].size(),
			made.build_leaf_form_arrays()[Mesh.ARRAY_VERTEX].size(),
			"the card's vertices"
		)


func test_trees_saved_before_there_were_rules() -> void:
	var made: TreeReconstruction = grown_tree(6)
	made.leaf_preset = "maple"
	check_equal(made.leaf_arrangement, TreeReconstruction.LEAF_ARRANGEMENT_OPPOSITE, "the maple's")
	made.leaf_size = 0.2
	made.leaf_droop = 35.0
	made.foliage_followed = false
	var path: String = folder.path_join("old.tres")
	check_equal(ResourceSaver.save(made, path), OK, "saving")
	var text: String = FileAccess.get_file_as_string(path)
	check(not "leaf_rule" in text, "A rule is saved where there is none.")
	var read: TreeReconstruction = (
		ResourceLoader.load(path, "", ResourceLoader.CACHE_MODE_IGNORE) as TreeReconstruction
	)
	check_equal(read.build_leaf_buffer(), made.build_leaf_buffer(), "the leaves")
	check(not read.foliage_followed, "It follows the foliage again.")
	check_equal(
		read.leaf_arrangement, TreeReconstruction.LEAF_ARRANGEMENT_OPPOSITE, "after loading"
	)


func test_rules_saved_before_there_was_a_fold() -> void:
	var path: String = folder.path_join("unfolded.tres")
	var file: FileAccess = FileAccess.open(path, FileAccess.WRITE)
	file.store_string(
		(
			'[gd_resource type="LeafRule" format=3]\n\n[resource]\n'
			+ 'look = "palm"\nleaf_size = 2.8\ncurl = 75.0\nevergreen = true\n'
		)
	)
	file.close()
	var read: LeafRule = ResourceLoader.load(path, "", ResourceLoader.CACHE_MODE_IGNORE) as LeafRule
	check_equal(read.fold, LeafRule.new().fold, "the fold")
	check_equal(read.curl, 75.0, "the curl")
	check_equal(LeafRule.from_preset("palm").fold, 30.0, "a palm's fold")


func test_forms_are_cards_of_their_own() -> void:
	var made: TreeReconstruction = grown_tree(4)
	var rule: LeafRule = LeafRule.new()
	made.leaf_rule = rule
	check(not made.are_leaves_single(), "A spray is a single leaf.")
	var sizes: Dictionary[int, int] = {}
	rule.leaflets = 9
	rule.sprig = grown_tree(5, 12)
	for form: int in 6:
		rule.form = form as LeafRule.Form
		var card: Array = made.build_leaf_form_arrays()
		sizes[card[Mesh.ARRAY_VERTEX].size()] = form
		check_equal(made.are_leaves_single(), form != LeafRule.FORM_SPRAY, "form %d" % form)
		check(
			(
				made.build_leaf_form_arrays(2)[Mesh.ARRAY_INDEX].size()
				<= card[Mesh.ARRAY_INDEX].size()
			),
			"Form %d gets heavier." % form
		)
		check_equal(
			made.build_leaves().mesh.surface_get_arrays(0)[Mesh.ARRAY_VERTEX].size(),
			card[Mesh.ARRAY_VERTEX].size(),
			"the card of the multimesh"
		)
	check(sizes.size() >= 4, "Forms look alike: %s." % sizes)
	expect_error("A sprig is a TreeReconstruction")
	rule.sprig = null
	rule.set("sprig", Gradient.new())
	check(rule.sprig == null, "A gradient is a sprig.")


func test_sprigs_from_strings() -> void:
	var made: TreeReconstruction = grown_tree(4)
	var rule: LeafRule = LeafRule.new()
	made.leaf_rule = rule
	rule.form = LeafRule.FORM_SPRIG
	var single: int = made.build_leaf_form_arrays(1)[Mesh.ARRAY_VERTEX].size()
	rule.sprig_string = "$F[+F][-F]F[+F][-F]F"
	# Seven pieces of wood and five leaves at the tips, a quad each.
	check_equal(made.build_leaf_form_arrays(1)[Mesh.ARRAY_VERTEX].size() % 4, 0, "quads")
	var opposite: int = made.build_leaf_form_arrays(0)[Mesh.ARRAY_VERTEX].size()
	check(opposite > 5 * single, "%d vertices for a sprig, %d for a leaf." % [opposite, single])
	rule.sprig_string = "$F[+L][-L]F[+L][-L]FL"
	check(
		made.build_leaf_form_arrays(0)[Mesh.ARRAY_VERTEX].size() < opposite,
		"Leaves of their own have wood."
	)
	expect_error("line 1")
	rule.sprig_string = "F[+F"
	check_equal(rule.sprig_string, "F[+F", "what the user wrote")
	check_equal(made.build_leaf_form_arrays(1)[Mesh.ARRAY_VERTEX].size(), single, "one leaf")
	expect_error("draws no twig")
	rule.sprig_string = "+-"


func test_seasons() -> void:
	var made: TreeReconstruction = grown_tree(4)
	var rule: LeafRule = LeafRule.from_preset("maple")
	made.leaf_rule = rule
	var counts: PackedInt32Array = []
	for season: float in [0.0, 0.4, 0.7, 0.85, 0.95, 1.0]:
		rule.season = season
		counts.append(made.build_leaf_buffer().size() / FLOATS_PER_LEAF)
	check_equal(counts[0], counts[1], "leaves in spring and summer")
	check_equal(counts[1], counts[2], "leaves in summer and early autumn")
	check(counts[2] > counts[3] and counts[3] > counts[4] and counts[4] > 0, "falling: %s" % counts)
	check_equal(counts[5], 0, "leaves in winter")
	rule.season = 0.4
	check_near(rule.get_season_tints()[0].a, 0.0, 0.01, "the tint in summer")
	var summer: PackedFloat32Array = made.build_leaf_buffer()
	rule.season = 0.0
	var spring: PackedFloat32Array = made.build_leaf_buffer()
	check(_size_of_first(spring) < 0.5 * _size_of_first(summer), "Buds are as large as leaves.")
	rule.season = 0.7
	var autumn: Color = rule.get_season_tints()[1]
	check(autumn.a > 0.7 and autumn.r > 2.0 * autumn.g, "A maple in autumn is %s." % autumn)
	rule.evergreen = true
	rule.season = 1.0
	check_equal(made.build_leaf_buffer().size(), summer.size(), "leaves of an evergreen in winter")
	rule.season_colors = Gradient.new()
	rule.season_colors.set_color(0, Color.RED)
	rule.season_colors.set_color(1, Color.BLUE)
	check_near(rule.get_season_tints()[1].b, 1.0, 0.01, "the ramp's end")


func test_an_instance_shows_changes_live_and_keeps_its_bark() -> void:
	var made: TreeReconstruction = grown_tree(2)
	made.leaf_rule = LeafRule.new()
	var instance: TreeInstance3D = TreeInstance3D.new()
	instance.reconstruction = made
	tree.root.add_child(instance)
	while instance.is_rebuilding():
		await tree.process_frame
	var bark: Mesh = instance.mesh
	var before: int = instance.get_leaf_count()
	check(before > 0, "There are no leaves.")
	made.leaf_rule.internode = 0.2
	while instance.is_rebuilding():
		await tree.process_frame
	check(instance.get_leaf_count() < before, "The leaves stayed as they were.")
	check(instance.mesh == bark, "The bark was built again.")
	made.leaf_rule.look = "birch"
	while instance.is_rebuilding():
		await tree.process_frame
	var material: Material = instance.mesh.surface_get_material(0)
	check(material.resource_path.ends_with("birch_bark.tres"), material.resource_path)
	made.leaf_rule.form = LeafRule.FORM_SIMPLE
	while instance.is_rebuilding():
		await tree.process_frame
	var leaves: MultiMeshInstance3D = instance.find_child("Leaves", true, false)
	if leaves == null:
		leaves = instance.get_child(0, true) as MultiMeshInstance3D
	check(
		leaves.material_override.resource_path.ends_with("birch_blade.tres"),
		leaves.material_override.resource_path
	)
	made.leaf_rule.form = LeafRule.FORM_SPRAY
	made.leaf_rule.fold = 0.0
	while instance.is_rebuilding():
		await tree.process_frame
	var flat: float = leaves.multimesh.mesh.get_aabb().size.x
	made.leaf_rule.fold = 60.0
	while instance.is_rebuilding():
		await tree.process_frame
	check_near(leaves.multimesh.mesh.get_aabb().size.x, 0.5 * flat, 1e-3, "a folded leaf's width")
	made.skeleton = grown_tree(8).skeleton
	while instance.is_rebuilding():
		await tree.process_frame
	check(instance.mesh != bark, "The bark of another tree stayed.")
	instance.free()


func test_numbers_are_kept_in_their_range() -> void:
	var rule: LeafRule = LeafRule.new()
	rule.leaflets = 100000
	check_equal(rule.leaflets, 128, "leaflets")
	rule.clustering = -3.0
	check_equal(rule.clustering, 0.0, "clustering")
	rule.fold = -500.0
	check_equal(rule.fold, -80.0, "the fold")
	expect_error("finite number")
	rule.angle = NAN
	check_equal(rule.angle, 55.0, "the angle")
	rule.season = INF
	check_equal(rule.season, 0.4, "the season")
	expect_error("from 0 to 1")
	rule.density_by_order = PackedFloat32Array([0.5, 2.0])
	check(rule.density_by_order.is_empty(), "A share of 2 was taken.")
	expect_error("no look")
	rule.look = "none"
	check_equal(rule.look, "generic", "the look")


# The length of the first leaf's Y axis.
func _size_of_first(buffer: PackedFloat32Array) -> float:
	return Vector3(buffer[1], buffer[5], buffer[9]).length()
