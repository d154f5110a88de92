extends "./tools_suite.gd"
## Trees that bear several kinds of leaves: by the command `leaves`, through all that shows, saves,
## varies, bakes and fells them.

const ErrorCollector := preload("./error_collector.gd")
const Kinds := preload("res://addons/tree_reconstruction/nodes/leaf_kinds.gd")
const LIMIT_FRAMES: int = 2000
const FLOATS_PER_LEAF: int = 20


# A maple with a branch of pine and a bare one.
func _mixed(random_seed: int = 3, count: int = 600) -> TreeReconstruction:
	var made: TreeReconstruction = grown_tree(random_seed, count)
	made.leaf_rule = LeafRule.from_preset("maple")
	var branches: PackedInt32Array = _branches(made)
	check(made.edit("leaves where=below:%d rule=pine" % branches[0]) != null, "No pine.")
	check(made.edit("leaves where=below:%d rule=none" % branches[1]) != null, "No bare branch.")
	return made


# Nodes of branches that grow from the trunk, those that bear most first.
func _branches(made: TreeReconstruction) -> PackedInt32Array:
	var found: Array = []
	for id: int in made.select_nodes("order:1"):
		if made.get_node_order(made.get_node_parent(id)) == 0:
			found.append([-made.select_nodes("below:%d" % id).size(), id])
	found.sort()
	var branches: PackedInt32Array = []
	for entry: Array in found:
		branches.append(entry[1])
	check(branches.size() >= 2, "It has %d branches." % branches.size())
	return branches


func _rules(made: TreeReconstruction) -> PackedStringArray:
	var rules: PackedStringArray = []
	for kind: Dictionary in made.get_leaf_kinds():
		if kind.nodes > 0:
			rules.append(kind.rule)
	return rules


func _settle(instance: TreeInstance3D) -> void:
	for i: int in LIMIT_FRAMES:
		if not instance.is_building_levels():
			await tree.process_frame
			return
		await tree.process_frame
	check(false, "The levels did not end.")


func test_wood_has_leaves_of_its_own() -> void:
	var made: TreeReconstruction = _mixed()
	var kinds: Array[Dictionary] = made.get_leaf_kinds()
	check_equal(kinds.size(), 3, "kinds")
	check_equal(kinds[0].rule, "", "the tree's own rule")
	check_equal(kinds[0].look, "maple", "the tree's own look")
	check_equal(kinds[1].rule, "pine", "the first rule")
	check_equal(kinds[1].look, "pine", "its look")
	var nodes: int = 0
	for kind: Dictionary in kinds:
		nodes += kind.nodes
	check_equal(nodes, made.get_node_count(), "nodes of all kinds")
	check_equal(
		made.count_leaf_rules(made.get_node_ids()),
		{"": kinds[0].nodes, "pine": kinds[1].nodes, "none": kinds[2].nodes},
		"the counts"
	)
	for level: int in 3:
		var parts: Array[Dictionary] = made.build_foliage(level)
		check(not parts[0].leaves.is_empty(), "No maple leaves at level %d." % level)
		check(not parts[1].leaves.is_empty(), "No pine leaves at level %d." % level)
		check(parts[2].leaves.is_empty(), "The bare branch has leaves.")
		if level < 2:
			check_equal(parts[0].leaves, made.build_leaf_buffer(level), "the tree's own leaves")
		var joined: Array[Dictionary] = made.build_joined_foliage(level)
		var built: Dictionary = made.build_levels([level])[0]
		for i: int in 3:
			check_equal(built.foliage[i].leaves, parts[i].leaves, "kind %d of a level" % i)
			check_equal(joined[i].arrays.is_empty(), parts[i].leaves.is_empty(), "kind %d" % i)
	check_equal(TreeReconstruction.check_leaf_rule("maple droop=40"), "", "a good rule")
	check_sentence(TreeReconstruction.check_leaf_rule("mapel"), "what is wrong")
	var resolved: LeafRule = made.resolve_leaf_rule("leaf_size=0.5")
	check_equal([resolved.leaf_size, resolved.look], [0.5, "maple"], "a change of the tree's own")


func test_they_are_saved_undone_and_replayed() -> void:
	var bare: TreeReconstruction = grown_tree(3, 600)
	var before: Dictionary = bare.skeleton
	check_equal(before.format_version, 1, "the format of a tree without rules")
	var branch: int = _branches(bare)[0]
	var edit: TreeEdit = bare.edit('leaves where=below:%d rule="pine  leaf_size=0.30"' % branch)
	var after: Dictionary = bare.skeleton
	check_equal(after.format_version, 2, "the format with rules")
	check_equal(bare.revert_edit(edit), OK, "undoing")
	check_equal(bare.skeleton, before, "the skeleton after undo")
	check_equal(bare.apply_edit(edit), OK, "doing it again")
	check_equal(bare.skeleton, after, "the skeleton after redo")
	check_equal(_rules(bare), PackedStringArray(["", "pine leaf_size=0.3"]), "the rules")
	for extension: String in ["tres", "res"]:
		var path: String = folder.path_join("mixed." + extension)
		check_equal(ResourceSaver.save(bare, path), OK, "saving")
		var read: TreeReconstruction = ResourceLoader.load(
			path, "", ResourceLoader.CACHE_MODE_IGNORE
		)
		check_equal(read.skeleton, after, "the skeleton in ." + extension)
		check_equal(read.build_foliage(), bare.build_foliage(), "the leaves in ." + extension)
	var again: TreeReconstruction = grown_tree(3, 600)
	check_equal(again.replay(bare.edit_log)["done"], 1, "commands replayed")
	check_equal(again.skeleton, after, "the skeleton after a replay")
	for damage: Array in [
		["node_leaf_rules", PackedByteArray([1]), "differ in length"],
		["node_leaf_rules", "text", "of the wrong type"],
		["leaf_rules", PackedStringArray(), "leaf rule is missing"],
		["leaf_rules", PackedStringArray(["mapel"]), "is no leaf rule"],
	]:
		var bad: Dictionary = after.duplicate(true)
		bad[damage[0]] = damage[1]
		expect_error(damage[2])
		again.skeleton = bad
		check(again.is_empty(), "It took %s = %s." % damage.slice(0, 2))


func test_seasons_are_each_kinds_own() -> void:
	var made: TreeReconstruction = _mixed()
	var count: Callable = func(kind: int) -> int:
		return made.build_foliage()[kind].leaves.size() / FLOATS_PER_LEAF
	var maple: int = count.call(0)
	var pine: int = count.call(1)
	made.leaf_rule.season = 1.0
	check_equal(count.call(0), 0, "maple leaves in winter")
	check_equal(count.call(1), pine, "needles in winter")
	made.leaf_rule.season = 0.7
	check(count.call(0) <= maple, "There are more leaves in autumn.")
	var kinds: Array[Dictionary] = made.get_leaf_kinds()
	check_equal(kinds[0].tints, made.leaf_rule.get_season_tints(), "the maple's tints")
	check(kinds[0].tints[1].a > 0.3, "The maple does not turn.")
	check(kinds[1].tints[1].a < 0.1, "The pine turns.")
	check_equal(made.get_leaf_kinds(0.1)[0].tints[0].a > kinds[0].tints[0].a, true, "later")
	made.leaf_rule = null
	check(made.get_leaf_kinds()[1].tints.is_empty(), "There is a season without a rule.")


func test_each_kind_is_drawn_with_its_material_at_all_levels() -> void:
	for threads: bool in [false, true]:
		TreeInstance3D.threaded = threads
		var made: TreeReconstruction = _mixed(4, 1500)
		var instance: TreeInstance3D = TreeInstance3D.new()
		instance.reconstruction = made
		tree.root.add_child(instance)
		await _settle(instance)
		var parts: Array[Dictionary] = made.build_foliage()
		var leaves: int = 0
		for part: Dictionary in parts:
			@warning_ignore("integer_division")
			leaves += part.leaves.size() / FLOATS_PER_LEAF
		check_equal(instance.get_leaf_count(), leaves, "leaves")
		for name: String in ["Leaves", "Level1Leaves", "Level2Leaves", "ShadowLeaves"]:
			var looks: PackedStringArray = []
			for suffix: String in ["", "2", "3"]:
				var node: MultiMeshInstance3D = instance.find_child(name + suffix, true, false)
				for child: Node in instance.get_children(true):
					if child.name == name + suffix:
						node = child as MultiMeshInstance3D
				if node != null and node.multimesh != null:
					looks.append(node.material_override.resource_path.get_file())
			check_equal(
				looks,
				PackedStringArray(["maple_leaf.tres", "pine_leaf.tres"]),
				"the looks of " + name
			)
		var mine: StandardMaterial3D = StandardMaterial3D.new()
		instance.leaf_material = mine
		var own: int = 0
		for child: Node in instance.get_children(true):
			if child is MultiMeshInstance3D and (child as MultiMeshInstance3D).multimesh != null:
				own += 1 if (child as MultiMeshInstance3D).material_override == mine else 0
		check_equal(own, 5, "parts with a material of the user's")
		# All of it bears the tree's own again: nothing of the others is left.
		made.edit("leaves where=all rule=default")
		await _settle(instance)
		await tree.process_frame
		var drawn: int = 0
		for child: Node in instance.get_children(true):
			if child is MultiMeshInstance3D and not child.is_queued_for_deletion():
				drawn += 1
		check_equal(drawn, 5, "nodes of leaves")
		instance.free()
	TreeInstance3D.threaded = true


func test_variants_and_forests_keep_them() -> void:
	var made: TreeReconstruction = _mixed(5, 800)
	for number: int in range(1, 5):
		var variant: TreeReconstruction = made.make_variant(number)
		var rules: PackedStringArray = _rules(variant)
		check("pine" in rules and "none" in rules and "" in rules, "It has %s." % rules)
	var forest: TreeVariantSpawner3D = TreeVariantSpawner3D.new()
	forest.source = made
	forest.variants = 2
	forest.levels = 2
	forest.region_size = Vector2(40.0, 40.0)
	forest.density = 1.0
	tree.root.add_child(forest)
	var deadline: int = Time.get_ticks_msec() + 20_000
	await tree.process_frame
	while forest.is_building() and Time.get_ticks_msec() < deadline:
		await tree.process_frame
	for index: int in 2:
		for level: int in 2:
			var mesh: ArrayMesh = forest.get_variant_mesh(index, level)
			var names: PackedStringArray = []
			var pictures: Array[Texture2D] = []
			for surface: int in mesh.get_surface_count():
				names.append(mesh.surface_get_name(surface))
				var material: ShaderMaterial = mesh.surface_get_material(surface) as ShaderMaterial
				pictures.append(material.get_shader_parameter(&"albedo_texture"))
			check_equal(names, PackedStringArray(["bark", "leaves", "leaves_2"]), "surfaces")
			check(pictures[1] != pictures[2], "Needles show the maple's picture.")
	forest.free()


func test_baked_trees_have_a_surface_for_each() -> void:
	var made: TreeReconstruction = _mixed()
	made.leaf_rule.season = 0.7
	var baker: TreeBaker = TreeBaker.new()
	baker.levels = 2
	baker.collision = false
	for form: TreeBaker.Form in TreeBaker.Form.values():
		baker.form = form
		var root: Node3D = baker.bake(made).instantiate()
		tree.root.add_child(root)
		await tree.process_frame
		for level: int in 2:
			var node: MeshInstance3D = root.get_node("%s_LOD%d" % [root.name, level])
			var materials: Array[ShaderMaterial] = []
			if form == TreeBaker.Form.JOINED:
				check_equal((node.mesh as ArrayMesh).get_surface_count(), 3, "surfaces")
				for surface: int in [1, 2]:
					materials.append((node.mesh as ArrayMesh).surface_get_material(surface))
			else:
				for i: int in 2:
					var leaves: MultiMeshInstance3D = node.get_node(["Leaves", "Leaves2"][i])
					check_equal(
						leaves.multimesh.buffer, made.build_foliage(level)[i].leaves, "places"
					)
					materials.append(leaves.multimesh.mesh.surface_get_material(0))
					var early: Vector4 = leaves.get_instance_shader_parameter(&"season_early")
					check(early.w > 0.3 if i == 0 else early.w < 0.1, "Their season: %s." % early)
			check(
				(
					materials[0].get_shader_parameter(&"albedo_texture")
					!= materials[1].get_shader_parameter(&"albedo_texture")
				),
				"Needles show the maple's picture."
			)
		root.free()


func test_removed_and_felled_wood_keeps_its_kind() -> void:
	var made: TreeReconstruction = _mixed()
	made.seed = 77
	var whole: TreeReconstruction = made.duplicate() as TreeReconstruction
	var branch: int = _branches(made)[0]
	var edit: TreeEdit = made.edit("cut node=%d" % branch)
	var piece: TreeReconstruction = edit.get_removed_wood()[0]
	check_equal(_rules(piece), PackedStringArray(["pine"]), "the rules of the branch")
	check_equal(piece.leaf_rule, made.leaf_rule, "the tree's rule")
	check_equal(piece.seed, 77, "the seed")
	# So does wood of a tree without a rule: it was an oak's.
	var oak: TreeReconstruction = grown_tree(3, 600)
	oak.leaf_preset = "oak"
	oak.leaf_size = 0.5
	oak.foliage_followed = false
	piece = oak.edit("cut node=%d" % branch).get_removed_wood()[0]
	check_equal(piece.leaf_preset, "oak", "the preset")
	check_equal(piece.leaf_size, 0.5, "the size")
	check(not piece.foliage_followed, "It follows the scan's leaves.")
	check_equal(piece.get_leaf_look(), "oak", "the look")
	var instance: TreeInstance3D = TreeInstance3D.new()
	instance.reconstruction = whole
	tree.root.add_child(instance)
	await _settle(instance)
	var body: RigidBody3D = instance.fell(branch)
	var fallen: TreeInstance3D = body.get_child(0) as TreeInstance3D
	check_equal(_rules(fallen.reconstruction), PackedStringArray(["pine"]), "the fallen branch's")
	check(not "pine" in _rules(instance.reconstruction), "Needles stay on the stump.")
	check_equal(fallen.reconstruction.get_leaf_kinds()[1].look, "pine", "its look")
	body.free()
	instance.free()


func test_an_impostor_knows_of_them() -> void:
	var made: TreeReconstruction = _mixed()
	var fingerprint: int = TreeImpostor.fingerprint_of(made)
	made.leaf_rule.season = 0.5
	check_equal(TreeImpostor.fingerprint_of(made), fingerprint, "late in summer")
	made.edit("leaves where=below:%d rule=birch" % _branches(made)[0])
	check(TreeImpostor.fingerprint_of(made) != fingerprint, "It is of a tree with other leaves.")


func test_the_tool_gives_them_to_the_selected_wood() -> void:
	_begin(grown_tree(17, 400), &"select")
	var branch: int = _branches(_made)[0]
	var above: PackedInt32Array = _made.select_nodes("below:%d" % branch)
	_session.select([branch])
	_session.choose(&"leaf_rule")
	var tool: RefCounted = _session.tool
	var strip: Control = tool.call(&"make_settings")
	tree.root.add_child(strip)
	check(tool.call(&"is_of_wood"), "It is not for the selected wood.")
	tool.call(&"choose_preset", "birch")
	await _frame()
	check_equal(_made.count_leaf_rules(above), {"birch": above.size()}, "the branch's leaves")
	check(_made.leaf_rule == null, "The tree's own rule changed.")
	check_equal(_undo.get_history_count(), 1, "steps")
	# A slider makes one step, when it has come to rest.
	for i: int in 6:
		tool.call(&"set_rule", &"leaf_size", 0.1 + 0.05 * i)
		await _frame()
	check_equal(_undo.get_history_count(), 1, "steps while it moves")
	await tree.create_timer(0.6).timeout
	await _frame()
	check_equal(_undo.get_history_count(), 2, "steps after it")
	check_equal(_made.count_leaf_rules(above).keys(), ["birch leaf_size=0.35"], "the rule")
	_undo.undo()
	_undo.undo()
	await _frame()
	check_equal(_made.skeleton, _before, "the tree after undo")
	_undo.redo()
	await _frame()
	check_equal(_made.count_leaf_rules(above).keys(), ["birch"], "the rule after redo")
	# Two end nodes, their twigs.
	var tips: PackedInt32Array = _made.get_leaves().slice(0, 2)
	_session.select(tips)
	tool.call(&"choose_preset", "none")
	await _frame()
	check_equal(_made.count_leaf_rules(tips), {"none": 2}, "the end nodes")
	_session.select([_made.get_root()])
	tool.call(&"choose_preset", "default")
	await _frame()
	check_equal(_rules(_made), PackedStringArray([""]), "the rules of the whole tree")
	strip.free()
	_end()


func test_a_click_gives_them_to_a_branch() -> void:
	_begin(grown_tree(17, 400), &"leaf_rule")
	var tool: RefCounted = _session.tool
	var id: int = _find(_has_two_above)
	check(not tool.call(&"is_of_wood"), "It is for wood though none is selected.")
	_click(_at(id))
	check_equal(_made.skeleton, _before, "the tree after a click")
	tool.call(&"set_of_wood", true)
	tool.call(&"choose_preset", "willow")
	check_equal(_made.skeleton, _before, "the tree with nothing selected")
	_click(_at(id))
	await _frame()
	var above: PackedInt32Array = _made.select_nodes("below:%d" % id)
	check_equal(_made.count_leaf_rules(above), {"willow": above.size()}, "its leaves")
	_check_one_step("a click")
	_end()


# As in a game that was exported without the pictures of all kinds.
func test_kinds_that_the_game_lacks_are_warned_of_once() -> void:
	var warnings: ErrorCollector = ErrorCollector.new()
	warnings.of_warnings = true
	OS.add_logger(warnings)
	var exported: Callable = func(path: String) -> bool: return not "/palm_" in path
	for part: String in ["leaf", "blade", "bark", "leaf"]:
		var found: String = Kinds.find_preset("palm", part, exported)
		check(found.ends_with("/generic_%s.tres" % part), "It is drawn as %s." % found)
		check(ResourceLoader.exists(found), "There is no %s." % found)
		check(Kinds.find_preset("oak", part, exported).ends_with("/oak_%s.tres" % part), "An oak.")
		Kinds.find_preset("no kind", part, exported)
	OS.remove_logger(warnings)
	var said: PackedStringArray = warnings.take()
	check_equal(said.size(), 1, "the warnings: %s" % said)
	for word: String in ["'palm'", "tree_reconstruction/export/more_kinds"]:
		check(word in " ".join(said), "%s is not in %s." % [word, said])
	check_sentence(" ".join(said), "the warning")
