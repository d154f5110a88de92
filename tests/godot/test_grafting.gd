extends "./suite.gd"
## Twigs, grafts, and the library of branches.

const NAMES: PackedStringArray = [
	"apple",
	"birch",
	"cherry",
	"dead",
	"generic",
	"ginkgo_long",
	"ginkgo_medium",
	"ginkgo_short",
	"magnolia_long",
	"magnolia_medium",
	"magnolia_short",
	"maple",
	"maple_long",
	"maple_medium",
	"maple_short",
	"oak",
	"pine",
	"poplar_long",
	"poplar_medium",
	"poplar_short",
	"spruce",
	"willow",
]


func test_a_twig_and_a_graft_on_it() -> void:
	var made: TreeReconstruction = grown_tree(3)
	var start: Dictionary = made.skeleton
	var node: int = made.get_trunk_nodes()[6]
	var twig: TreeEdit = made.make_twig(
		node, {"side": "right", "view": Vector3(0, 0, -1), "length": 0.3}
	)
	check(twig != null, "No twig was made.")
	if twig == null:
		return
	var tip: int = twig.get_result_nodes()[0]
	check_equal(made.get_node_parent(tip), node, "the twig's parent")
	var way: Vector3 = made.get_node_position(tip) - made.get_node_position(node)
	check_near(way.length(), 0.3, 1e-5, "the twig's length")
	check(way.x > 0.1, "It does not go right: %s." % way)
	var edit: TreeEdit = made.graft(tip, {"twig": "maple", "seed": 7, "angle": 10.0, "tries": 8})
	check(edit != null and not edit.get_result_nodes().is_empty(), "Nothing was grafted.")
	if edit == null:
		return
	check_equal(made.get_node_parent(edit.get_result_nodes()[0]), tip, "the joint")
	for id: int in edit.get_result_nodes():
		check(
			made.get_node_radius(id) <= made.get_node_radius(made.get_node_parent(id)) + 1e-12,
			"Node %d is thicker than its parent." % id
		)
	# The same again gives the same.
	var grafted: Dictionary = made.skeleton
	check_equal(made.revert_edit(edit), OK, "undoing")
	check(made.graft(tip, {"twig": "maple", "seed": 7, "angle": 10.0, "tries": 8}) != null, "redo")
	check_equal(made.skeleton["positions"], grafted["positions"], "the same graft")
	var again: TreeReconstruction = TreeReconstruction.new()
	again.skeleton = start
	check_equal(again.replay(made.edit_log)["done"], 2, "replayed")
	check_equal(again.skeleton["positions"], grafted["positions"], "the replayed graft")


func test_many_at_once() -> void:
	var made: TreeReconstruction = grown_tree(4, 60)
	var leaves: PackedInt32Array = made.get_leaves()
	var before: int = made.get_node_count()
	var edit: TreeEdit = made.graft_many(
		leaves, {"twigs": PackedStringArray(["oak", "dead"]), "seed": 2}
	)
	check(edit != null, "Nothing was grafted.")
	check(made.get_node_count() > before + 90 * leaves.size(), "Too few nodes came.")
	check_equal(made.revert_edit(edit), OK, "undoing")
	check_equal(made.get_node_count(), before, "the nodes afterwards")


func test_a_branch_is_taken_and_grafted() -> void:
	var made: TreeReconstruction = grown_tree(5)
	var from: int = made.get_branch_nodes()[3]
	var text: String = made.take_branch(from)
	check(text.contains("F("), "It is no L-string: '%s'." % text.left(60))
	var measured: Dictionary = TreeReconstruction.measure_branch(text)
	check(measured["length"] > 0.05 and measured["base_radius"] > 0.001, str(measured))
	var tip: int = made.get_leaves()[2]
	var options: Dictionary = {"string": text, "angle": 0, "stretch": 0.0}
	var edit: TreeEdit = made.graft(tip, options)
	check(edit != null, "It was not grafted.")
	if edit != null:
		check_equal(edit.get_result_nodes().size(), measured["node_count"] - 1, "its nodes")


func test_collisions_are_found() -> void:
	var made: TreeReconstruction = TreeReconstruction.new()
	made.skeleton = skeleton(
		[
			[-1, 0, 0, 0, 0.05, NODE_TRUNK],
			[0, 0, 1, 0, 0.05, NODE_TRUNK],
			[1, 0, 2, 0, 0.05, NODE_TRUNK],
			[0, 1, 0.5, 0, 0.03, 0],
			[3, 1, 1.5, 0, 0.03, 0],
			[4, -0.5, 1.52, 0, 0.03, 0],
		]
	)
	var found: Array[Dictionary] = made.find_collisions(5)
	check_equal(found.size(), 1, "the collisions of the bar")
	if found.size() == 1:
		check_equal(found[0]["node"], 5, "the bar")
		check_equal(found[0]["other"], 2, "the stem")
		check(found[0]["depth"] > 0.05, "They overlap by %s only." % found[0]["depth"])
		check_near(found[0]["position"].x, 0.0, 0.05, "the place")
	check(made.find_collisions(2).size() == 1, "The stem does not feel the bar.")
	expect_error("clearance")
	check(made.find_collisions(5, -1.0).is_empty(), "A negative clearance was taken.")


func test_the_library() -> void:
	var library: TwigLibrary = TwigLibrary.presets()
	check_equal(library.twigs.size(), NAMES.size(), "the library's size")
	var list: ItemList = ItemList.new()
	library.fill(list)
	check_equal(list.item_count, NAMES.size(), "the list's size")
	for i: int in NAMES.size():
		var twig: Twig = library.find(NAMES[i])
		check(twig != null, "There is no %s." % NAMES[i])
		if twig == null:
			continue
		check(twig.length > 0.5 and twig.length < 3.7, "%s is %s long." % [NAMES[i], twig.length])
		check(twig.base_radius > 0.004, "%s has a radius of %s." % [NAMES[i], twig.base_radius])
		check(twig.thumbnail != null, "%s has no picture." % NAMES[i])
		check_equal(list.get_item_icon(i), library.twigs[i].thumbnail, "an icon")
		check_equal(list.get_item_metadata(i), library.twigs[i], "an item's twig")
	list.free()
	check(library.find("palm") == null, "There is a palm.")


func test_a_library_of_ones_own() -> void:
	var made: TreeReconstruction = grown_tree(6)
	var library: TwigLibrary = TwigLibrary.new()
	var twig: Twig = Twig.from_branch(made, made.get_branch_nodes()[2], "Mine")
	check(twig.thumbnail != null, "It has no picture.")
	if twig.thumbnail != null:
		var image: Image = twig.thumbnail.get_image()
		check_equal(image.get_size(), Vector2i(128, 128), "the picture's size")
		check(not image.is_invisible(), "The picture is empty.")
	library.twigs = [twig]
	var path: String = folder.path_join("library.tres")
	check_equal(ResourceSaver.save(library, path), OK, "saving")
	var read: TwigLibrary = (
		ResourceLoader.load(path, "", ResourceLoader.CACHE_MODE_IGNORE) as TwigLibrary
	)
	check(read != null and read.find("Mine") != null, "It was not read back.")
	if read != null:
		check_equal(read.twigs[0].lstring, twig.lstring, "the wood")
		check_equal(read.twigs[0].length, twig.length, "the length")


func test_refuses_what_makes_no_sense() -> void:
	var made: TreeReconstruction = grown_tree(2)
	var before: PackedInt64Array = made.skeleton["positions"]
	expect_error("palm")
	check(made.graft(made.get_leaves()[0], {"twig": "palm"}) == null, "A palm was grafted.")
	expect_error("'nonsense'")
	check(made.graft(made.get_leaves()[0], {"nonsense": 1}) == null, "Nonsense was taken.")
	expect_error("9999")
	check(made.make_twig(9999) == null, "A twig was made on nothing.")
	expect_error("There is no node to graft onto")
	check(made.graft_many([]) == null, "Grafted onto nothing.")
	expect_error("single node")
	check(TreeReconstruction.measure_branch("+(3)").is_empty(), "An empty branch was measured.")
	expect_error("pixels wide")
	check(TreeReconstruction.draw_branch("F(1)", 5).is_empty(), "A tiny picture was drawn.")
	check_equal(made.skeleton["positions"], before, "the tree")


func test_the_papers_algorithms_by_name() -> void:
	var made: TreeReconstruction = grown_tree(5)
	var tip: int = made.get_leaves()[1]
	var options: Dictionary = {"twig": "oak", "thinning": 0.8, "vary": "segments", "seed": 3}
	var edit: TreeEdit = made.graft(tip, options)
	check(edit != null, "Nothing was grafted.")
	if edit == null:
		return
	for id: int in edit.get_result_nodes():
		var depth: int = made.get_node_depth(id) - made.get_node_depth(tip)
		var printed: float = maxf(made.get_node_radius(tip) * pow(0.8, depth), 1e-9)
		check_near(made.get_node_radius(id), printed, 1e-9, "a radius")
	var node: int = made.get_trunk_nodes()[4]
	var next: int = made.get_node_children(node)[0]
	var twig: TreeEdit = made.make_twig(node, {"size": "paper"})
	check(twig != null, "There is no twig.")
	if twig == null:
		return
	var end: int = twig.get_result_nodes()[0]
	check_near(made.get_node_radius(end), 0.8 * made.get_node_radius(node), 1e-9, "its radius")
	var base: Vector3 = made.get_node_position(node)
	check_near(
		made.get_node_position(end).distance_to(base),
		0.6 * made.get_node_position(next).distance_to(base),
		1e-5,
		"its length"
	)


func test_ids_are_heard_whole() -> void:
	var made: TreeReconstruction = grown_tree(2)
	for id: int in [5 + (1 << 32), -(1 << 40), 1 << 62, -2]:
		check(not made.has_node(id), "%d is a node." % id)
		expect_error("The tree has no node %d" % id)
		check_equal(made.get_node_position(id), Vector3(), "its position")
		expect_error("The tree has no node %d" % id)
		check(made.get_node_children(id).is_empty(), "It has children.")
		expect_error("There is no node %d in this tree." % id)
		check_equal(made.take_branch(id), "", "its branch")
		expect_error("There is no node %d in this tree." % id)
		check(made.find_collisions(id).is_empty(), "It collides.")
		expect_error(str(id))
		check(made.graft(id) == null, "Something was grafted.")
		expect_error("There is no node %d in this tree." % id)
		check_equal(LSystem.write_string(made, id), "", "its string")


func test_what_is_no_number_is_told() -> void:
	var made: TreeReconstruction = grown_tree(2)
	var before: PackedInt64Array = made.skeleton["positions"]
	var tip: int = made.get_leaves()[0]
	var none: Dictionary = {
		"angle": NAN,
		"stretch": INF,
		"roll": NAN,
		"seed": NAN,
		"clearance": -INF,
		"direction": Vector3(NAN, 0, 1),
		"thinning": NAN,
		"tries": 1 << 40,
		"most": 1 << 40
	}
	for key: String in none:
		expect_error("'%s' must be" % key)
		check(made.graft(tip, {key: none[key]}) == null, "%s was taken." % key)
	for line: String in ["thicken factor=nan", "move nodes=1 by=nan,0,0", "sag load=inf"]:
		expect_error("must be")
		check(made.edit(line) == null, "%s was done." % line)
	for amount: float in [NAN, INF, -0.5, 1.5]:
		expect_error("amount of variation")
		check(made.make_variant(1, amount) == null, "A variant of %s was made." % amount)
	for age: float in [NAN, INF, 0.0, 1.5]:
		expect_error("age of a variant")
		check(made.make_variant(1, 0.5, age) == null, "A variant of age %s was made." % age)
	expect_error("clearance")
	check(made.find_collisions(tip, NAN).is_empty(), "It collides.")
	check_equal(made.skeleton["positions"], before, "the tree")


func test_roundings_and_nulls_pass() -> void:
	var made: TreeReconstruction = grown_tree(2)
	var oldest: TreeReconstruction = made.make_variant(1, 1.0000000000000002, 1.2000000000000002)
	check(oldest != null, "1.2000000000000002 is not 1.2.")
	if oldest != null:
		var plain: TreeReconstruction = made.make_variant(1, 1.0, 1.2)
		check_equal(oldest.skeleton["positions"], plain.skeleton["positions"], "the oldest one")
	var tip: int = made.get_leaves()[0]
	var options: Dictionary = {"stretch": 0.9000000000000001, "twig": null, "direction": null}
	check(made.graft(tip, options) != null, "Nothing was grafted.")
	expect_error("There is no tree to take a branch of")
	check_equal(Twig.from_branch(null, 3).lstring, "", "a branch of nothing")
	expect_error("There is no list to fill")
	TwigLibrary.presets().fill(null)
	expect_error("There is no edit to apply")
	check_equal(made.apply_edit(null), ERR_INVALID_PARAMETER, "no edit")
