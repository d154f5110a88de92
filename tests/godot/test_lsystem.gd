extends "./suite.gd"
## LSystem: grammars that grow, strings that are read and written.

const CHANCE: String = """
	iterations: 2
	angle: 90
	step: 0.5
	axiom: F
	F -> F[+F]F : 0.5
	F -> FF : 0.5
"""


func test_presets_grow() -> void:
	check(LSystem.get_preset_names().size() >= 5, "There are few presets.")
	for name: String in LSystem.get_preset_names():
		var system: LSystem = LSystem.new()
		system.grammar = LSystem.get_preset(name)
		check_equal(system.get_error_message(), "", name)
		var made: TreeReconstruction = system.grow()
		check(made.get_node_count() > 500, "%s has %d nodes." % [name, made.get_node_count()])
		check(made.get_aabb().size.y > 2.0, "%s is %s tall." % [name, made.get_aabb().size.y])
		check(made.build_mesh().get_surface_count() > 0, "%s has no bark." % name)
		check(made.build_leaf_buffer().size() > 0, "%s has no leaves." % name)


func test_a_seed_is_a_tree() -> void:
	var system: LSystem = LSystem.new()
	system.grammar = CHANCE
	system.iterations = 5
	check_equal(system.generate(7), system.generate(7), "the same seed")
	check(system.generate(7) != system.generate(8), "Two seeds give one string.")
	check_equal(system.generate(), system.generate(1), "the grammar's own seed")
	var made: TreeReconstruction = system.grow(7)
	check(made.get_node_count() > 30, "It has %d nodes." % made.get_node_count())
	check_equal(made.seed, 7, "the seed of the leaves")


func test_a_grammar_names_its_leaves() -> void:
	var system: LSystem = LSystem.new()
	system.grammar = LSystem.get_preset("willow")
	check_equal(system.grow().leaf_preset, "willow", "the leaves")
	system.grammar = LSystem.get_preset("hazel")
	check_equal(system.grow().leaf_preset, "generic", "no leaves named")
	expect_error("'cactus' is no leaf preset")
	system.grammar = "leaf_preset: cactus\naxiom: FF"
	check_equal(system.grow().leaf_preset, "generic", "a preset that is none")


func test_iterations() -> void:
	var system: LSystem = LSystem.new()
	system.grammar = "iterations: 2\naxiom: F\nF -> FF"
	check_equal(system.generate(), "FFFF", "the grammar's own")
	system.iterations = 0
	check_equal(system.generate(), "F", "none")
	system.iterations = 3
	check_equal(system.generate(), "FFFFFFFF", "three")


func test_strings_come_back() -> void:
	var made: TreeReconstruction = grown_tree(3)
	var text: String = LSystem.write_string(made)
	var read: TreeReconstruction = LSystem.read_string(text)
	check_equal(read.get_node_count(), made.get_node_count(), "the nodes")
	var ids: PackedInt32Array = made.get_node_ids()
	for node: int in read.get_node_ids():
		check(
			read.get_node_position(node).distance_to(made.get_node_position(ids[node])) < 1e-4,
			"Node %d lies elsewhere." % node
		)
		check_near(read.get_node_radius(node), made.get_node_radius(ids[node]), 1e-4, "a radius")
		check_equal(read.is_trunk(node), made.is_trunk(ids[node]), "on the trunk")
	var paper: String = LSystem.write_string(made, -1, LSystem.DIALECT_PAPER)
	check_equal(
		LSystem.read_string(paper, LSystem.DIALECT_PAPER).get_node_count(),
		made.get_node_count(),
		"the paper's dialect"
	)


func test_a_branch_is_relative() -> void:
	# Of two equal branches on opposite sides, each is straight above its own wood.
	var made: TreeReconstruction = TreeReconstruction.new()
	made.skeleton = skeleton(
		[
			[-1, 0.0, 0.0, 0.0, 0.1, 0],
			[0, 1.0, 0.0, 0.0, 0.1, 0],
			[1, 2.0, 0.0, 0.0, 0.1, 0],
			[0, -1.0, 0.0, 0.0, 0.1, 0],
			[3, -2.0, 0.0, 0.0, 0.1, 0]
		]
	)
	check_equal(LSystem.write_string(made, 2), "!(0.1)F(1)", "one side")
	check_equal(LSystem.write_string(made, 4), "!(0.1)F(1)", "the other side")


func test_leaves_become_foliage() -> void:
	var made: TreeReconstruction = LSystem.read_string("F(2)[+(60)F(1)~(0.1)]F(1)")
	check(made.has_foliage(), "The leaf is lost.")
	var where: Vector3 = made.get_node_position(2)
	for node: int in made.get_leaves():
		if made.get_node_position(node).x < -0.5:
			where = made.get_node_position(node)
	check(made.get_foliage_positions()[0].distance_to(where) < 0.15, "The leaf is elsewhere.")


func test_mistakes_are_told() -> void:
	var system: LSystem = LSystem.new()
	check(system.get_error_message().contains("no axiom"), "An empty grammar: no message.")
	system.grammar = "axiom: F\nF -> F[+F"
	var sentence: String = "The grammar, line 2, column 7: this [ is never closed."
	check_equal(system.get_error_message(), sentence, "the message")
	expect_error(sentence)
	check_equal(system.generate(), "", "a string")
	check(system.grow() == null, "A tree grew.")
	expect_error("line 1, column 2")
	check(LSystem.read_string("F*") == null, "A wrong string was read.")
	expect_error("There is no grammar 'cactus'")
	check_equal(LSystem.get_preset("cactus"), "", "no preset")
	expect_error("There is no tree")
	check_equal(LSystem.write_string(null), "", "no tree")
	expect_error("The tree is empty")
	check_equal(LSystem.write_string(TreeReconstruction.new()), "", "an empty tree")
	expect_error("no node 99999")
	check_equal(LSystem.write_string(grown_tree(1), 99999), "", "no node")


func test_explosions_are_stopped() -> void:
	var system: LSystem = LSystem.new()
	system.grammar = "iterations: 100\naxiom: F\nF -> FF"
	system.maximum_symbols = 5000
	expect_error("grows past 5000 symbols")
	check_equal(system.generate(), "", "too long a string")
	system.maximum_symbols = 100000000
	system.maximum_seconds = 0.01
	expect_error("The grammar ")
	check(system.grow() == null, "A tree grew.")


func test_saves_and_loads() -> void:
	var system: LSystem = LSystem.new()
	system.grammar = LSystem.get_preset(LSystem.get_preset_names()[0])
	system.iterations = 4
	system.maximum_symbols = 7000
	system.maximum_seconds = 3.5
	for extension: String in ["tres", "res"]:
		var path: String = folder.path_join("system." + extension)
		check_equal(ResourceSaver.save(system, path), OK, "saving " + extension)
		var read: LSystem = (
			ResourceLoader.load(path, "", ResourceLoader.CACHE_MODE_IGNORE) as LSystem
		)
		check_equal(read.grammar, system.grammar, "the grammar")
		check_equal(read.iterations, 4, "the iterations")
		check_equal(read.maximum_symbols, 7000, "the most symbols")
		check_equal(read.maximum_seconds, 3.5, "the most seconds")


func test_says_when_it_changes() -> void:
	var system: LSystem = LSystem.new()
	var count: Array[int] = [0]
	system.changed.connect(func() -> void: count[0] += 1)
	system.grammar = CHANCE
	system.iterations = 3
	system.maximum_symbols = 10
	system.maximum_seconds = 1.0
	check_equal(count[0], 4, "how often it said so")


func test_grows_on_a_thread_while_it_changes() -> void:
	var system: LSystem = LSystem.new()
	system.grammar = LSystem.get_preset("monopodial")
	var wanted: String = system.generate()
	var thread: Thread = Thread.new()
	thread.start(
		func() -> bool:
			for i: int in 20:
				var text: String = system.generate()
				if text != wanted and text != "FF":
					return false
			return true
	)
	for i: int in 200:
		system.grammar = "axiom: F\nF -> FF" if i % 2 == 0 else LSystem.get_preset("monopodial")
	check(thread.wait_to_finish(), "A string of neither grammar came out.")


func test_a_heading_says_the_dialect() -> void:
	var made: TreeReconstruction = grown_tree(3)
	var paper: String = LSystem.write_string(made, -1, LSystem.DIALECT_PAPER)
	check(paper.begins_with("# L-string; dialect paper\n"), "It begins with %s." % paper.left(40))
	var told: TreeReconstruction = LSystem.read_string(paper)
	check_near(told.get_aabb().size.y, made.get_aabb().size.y, 0.2, "its height")
	check(not LSystem.write_string(made).contains("#"), "A turtle's string has a heading.")
	var turtle: TreeReconstruction = LSystem.read_string(paper, LSystem.DIALECT_TURTLE)
	check(
		absf(turtle.get_aabb().size.y - made.get_aabb().size.y) > 0.1, "The argument was not heard."
	)
	expect_error("dialect paper")
	check(LSystem.read_string("[+45&60F(0.5)]") == null, "It was misread.")
	check_equal(
		LSystem.read_string("[+45&60F(0.5)]", LSystem.DIALECT_PAPER).get_node_count(), 2, "as told"
	)
	# Wherever a string goes.
	check_equal(
		TreeReconstruction.measure_branch("# L-string; step 2\nFF")["length"],
		4.0,
		"a twig's length"
	)
	var tip: int = made.get_leaves()[0]
	var count: int = made.get_node_count()
	var edit: TreeEdit = made.graft(tip, {"string": "# L-string; dialect paper\n&90F(0.1)F(0.1)"})
	check(edit != null and made.get_node_count() == count + 2, "It was not grafted.")
	var again: TreeReconstruction = grown_tree(3)
	check_equal(again.replay(made.edit_log)["done"], 1, "replayed with its two lines")
	check_equal(again.skeleton["positions"], made.skeleton["positions"], "the same graft")


# A paper's string says 10 cm of wood that lies flat; as a turtle's, that it stands.
func test_an_argument_says_the_dialect_of_a_branch() -> void:
	const PAPER: LSystem.Dialect = LSystem.DIALECT_PAPER
	var text: String = "[+45&60F0.5[-30&80F0.2]]"
	check_equal(TreeReconstruction.measure_branch(text, PAPER)["node_count"], 3, "its nodes")
	check_near(TreeReconstruction.measure_branch(text, PAPER)["length"], 0.7, 1e-6, "its length")
	check(not TreeReconstruction.draw_branch(text, 64, PAPER).is_empty(), "It was not drawn.")
	# The argument goes before the heading.
	var headed: String = "# L-string; dialect paper\n&(90)F(1)&(90)F(1)"
	check_equal(
		TreeReconstruction.draw_branch(headed, 64),
		TreeReconstruction.draw_branch("&(90)F(1)&(90)F(1)", 64, PAPER),
		"the picture"
	)
	check(
		(
			TreeReconstruction.draw_branch(headed, 64)
			!= TreeReconstruction.draw_branch(headed, 64, LSystem.DIALECT_TURTLE)
		),
		"The argument was not heard."
	)
	for dialect: int in [-1, 3]:
		expect_error("no dialect %d" % dialect)
		check(TreeReconstruction.measure_branch("F(1)", dialect).is_empty(), "It was measured.")
		expect_error("no dialect %d" % dialect)
		check(LSystem.read_string("F(1)", dialect) == null, "It was read.")
	var file: String = folder.path_join("bare.lstring")
	FileAccess.open(file, FileAccess.WRITE).store_string(text)
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	var read: TreeReconstruction = reconstructor.import_skeleton(file, "y", 0, PAPER)
	check(read != null, reconstructor.get_error_message())
	if read != null:
		check_equal(read.get_node_count(), 3, "the file's nodes")
	check(reconstructor.import_skeleton(file) == null, "A file of the paper's was misread.")
	check("dialect paper" in reconstructor.get_error_message(), reconstructor.get_error_message())
	FileAccess.open(file, FileAccess.WRITE).store_string("F(1)[+(30)F(0.5)]F(1)")
	check_equal(reconstructor.import_skeleton(file).get_node_count(), 4, "a turtle's file")


func test_a_twig_has_a_dialect() -> void:
	var text: String = "[+45&60F0.5[-30&80F0.2]]"
	var twig: Twig = Twig.new()
	twig.dialect = LSystem.DIALECT_PAPER
	twig.lstring = text
	check_near(twig.length, 0.7, 1e-6, "its length")
	twig.draw_thumbnail()
	check(twig.thumbnail != null, "It has no picture.")
	var right: PackedInt64Array = (
		LSystem.read_string(text, LSystem.DIALECT_PAPER).skeleton["positions"]
	)
	check_equal(LSystem.read_string(twig.get_string()).skeleton["positions"], right, "its wood")
	for heading: String in ["# L-string; dialect turtle\n", "# L-string; radius 0.02\n"]:
		twig.lstring = heading + text
		check_equal(LSystem.read_string(twig.get_string()).skeleton["positions"], right, heading)
	var made: TreeReconstruction = grown_tree(3)
	var count: int = made.get_node_count()
	var edit: TreeEdit = made.graft(made.get_leaves()[0], {"string": twig.get_string()})
	check(edit != null and made.get_node_count() == count + 2, "It was not grafted.")
	twig.dialect = LSystem.DIALECT_TOLD
	twig.lstring = "F(1)"
	check_equal(twig.get_string(), "F(1)", "as it is")
	check_near(twig.length, 1.0, 1e-6, "a turtle's length")
	# It is saved.
	twig.dialect = LSystem.DIALECT_PAPER
	var path: String = folder.path_join("paper.tres")
	check_equal(ResourceSaver.save(twig, path), OK, "saving")
	var again: Twig = ResourceLoader.load(path, "", ResourceLoader.CACHE_MODE_IGNORE) as Twig
	check_equal(again.dialect, LSystem.DIALECT_PAPER, "the saved dialect")


func test_a_sprig_has_a_dialect() -> void:
	var rule: LeafRule = LeafRule.new()
	rule.form = LeafRule.FORM_SPRIG
	rule.sprig_dialect = LSystem.DIALECT_PAPER
	rule.sprig_string = "[+45&60F0.5[-30&80F0.2]]"
	var made: TreeReconstruction = grown_tree(4)
	made.leaf_rule = rule
	var sprig: int = made.build_leaf_form_arrays(0)[Mesh.ARRAY_VERTEX].size()
	var path: String = folder.path_join("paper_rule.tres")
	check_equal(ResourceSaver.save(rule, path), OK, "saving")
	var read: LeafRule = ResourceLoader.load(path, "", ResourceLoader.CACHE_MODE_IGNORE) as LeafRule
	check_equal(read.sprig_dialect, int(LSystem.DIALECT_PAPER), "the saved dialect")
	made.leaf_rule = read
	check_equal(made.build_leaf_form_arrays(0)[Mesh.ARRAY_VERTEX].size(), sprig, "the saved sprig")
	expect_error("dialect paper")
	rule.sprig_dialect = LSystem.DIALECT_TOLD
	expect_error("no dialect 3")
	rule.sprig_dialect = 3
	check_equal(rule.sprig_dialect, int(LSystem.DIALECT_TOLD), "as before")


func test_segments_vary_by_a_seed() -> void:
	var text: String = LSystem.write_string(grown_tree(4))
	var plain: TreeReconstruction = LSystem.read_string(text)
	var one: TreeReconstruction = LSystem.read_string(text, LSystem.DIALECT_TOLD, 8.0, 0.2, 4)
	var same: TreeReconstruction = LSystem.read_string(text, LSystem.DIALECT_TOLD, 8.0, 0.2, 4)
	var other: TreeReconstruction = LSystem.read_string(text, LSystem.DIALECT_TOLD, 8.0, 0.2, 5)
	check_equal(one.skeleton["positions"], same.skeleton["positions"], "the same seed")
	check(one.skeleton["positions"] != other.skeleton["positions"], "Two seeds give one branch.")
	check_equal(one.get_node_count(), plain.get_node_count(), "the nodes")
	for node: int in one.get_node_ids():
		var parent: int = one.get_node_parent(node)
		if parent == TreeReconstruction.NO_NODE:
			continue
		var length: float = plain.get_node_position(node).distance_to(
			plain.get_node_position(parent)
		)
		var varied: float = one.get_node_position(node).distance_to(one.get_node_position(parent))
		check(absf(varied - length) <= 0.2 * length + 1e-5, "Node %d: %f." % [node, varied])
	for spread: float in [NAN, -1.0, 181.0, INF]:
		expect_error("0 to 180 degrees")
		check(LSystem.read_string("F(1)", LSystem.DIALECT_TOLD, spread) == null, str(spread))


func test_what_draws_nothing_is_told() -> void:
	for text: String in ["", "+(3)", "F(0)", "# F(1)"]:
		expect_error("The L-string draws no wood")
		check(LSystem.read_string(text) == null, "'%s' is a tree." % text)
	var system: LSystem = LSystem.new()
	system.grammar = "iterations: 2\naxiom: F(1)\nF(x) -> *"
	expect_error("The string that the grammar makes in 2 steps draws no wood")
	check(system.grow() == null, "Nothing is a tree.")


func test_growing_is_cancelled() -> void:
	var system: LSystem = LSystem.new()
	system.grammar = "iterations: 10000\naxiom: FFFFFFFFFFFFFFFFFFFFFFFFFFFFFFFF\nF -> F"
	system.maximum_seconds = 3600.0
	system.grammar = system.grammar.replace("axiom: ", "axiom: " + "F".repeat(20000))
	expect_error("Cancelled.")
	var thread: Thread = Thread.new()
	thread.start(system.generate)
	while thread.is_alive():
		system.cancel()
		OS.delay_msec(20)
	check_equal(thread.wait_to_finish(), "", "the string")
