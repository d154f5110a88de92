extends "./suite.gd"
## Strokes as a resource, and trees of them.

const SKETCH_FILE: String = "user://sketch_test.json"


# A round crown, a trunk, and a branch to either side, in pixels.
static func small_sketch() -> TreeSketch:
	var sketch: TreeSketch = TreeSketch.new()
	var outline: PackedVector2Array = []
	for i: int in 60:
		var angle: float = TAU * i / 60.0
		outline.append(Vector2(500.0, 350.0) + 290.0 * Vector2(sin(angle), -cos(angle)))
	sketch.add_stroke(outline)
	sketch.add_stroke(_line(Vector2(500.0, 960.0), Vector2(505.0, 260.0)))
	sketch.add_stroke(_line(Vector2(502.0, 600.0), Vector2(690.0, 400.0)))
	sketch.add_stroke(_line(Vector2(502.0, 540.0), Vector2(320.0, 330.0)))
	sketch.height = 8.0
	return sketch


static func _line(from: Vector2, to: Vector2) -> PackedVector2Array:
	var points: PackedVector2Array = []
	for i: int in 41:
		points.append(from.lerp(to, i / 40.0))
	return points


func test_strokes_keep_their_ids() -> void:
	var sketch: TreeSketch = small_sketch()
	check_equal(_ids(sketch), [1, 2, 3, 4], "ids in the order of drawing")
	check(sketch.remove_stroke(2), "Stroke 2 does not go.")
	check(not sketch.remove_stroke(2), "Stroke 2 goes twice.")
	check_equal(sketch.add_stroke(PackedVector2Array([Vector2.ZERO])), 5, "the id of a new one")
	check_equal(_ids(sketch), [1, 3, 4, 5], "ids after that")
	check_equal(sketch.find_stroke(4), 2, "where stroke 4 is")
	check(sketch.set_stroke_role(4, TreeSketch.ROLE_BRANCH), "There is no stroke 4.")
	check(sketch.reshape_stroke(4, PackedVector2Array([Vector2.ONE])), "It keeps its shape.")
	var fourth: Dictionary = sketch.strokes[2]
	check_equal(fourth["points"], PackedVector2Array([Vector2.ONE]), "its points")
	check_equal(fourth["role"], TreeSketch.ROLE_BRANCH, "its role")


func test_strokes_are_read_as_copies_and_made_whole() -> void:
	var sketch: TreeSketch = small_sketch()
	sketch.strokes[0]["points"] = PackedVector2Array()
	check_equal(
		(sketch.strokes[0]["points"] as PackedVector2Array).size(), 60, "points of the first"
	)
	var odd: Array[Dictionary] = [
		{"points": PackedVector2Array([Vector2(1.0, 2.0)]), "id": 7, "role": 99},
		{"points": PackedVector2Array()},
		{"points": PackedVector2Array([Vector2(3.0, 4.0)]), "id": 7, "pressure": [0.5, 0.5]},
		{},
	]
	sketch.strokes = odd
	check_equal(_ids(sketch), [7, 8], "the ids of those that have points")
	check_equal(sketch.strokes[0]["role"], TreeSketch.ROLE_BRANCH, "a role that there is")
	check_equal(sketch.strokes[1]["pressure"], PackedFloat32Array(), "pressures that fit no points")


func test_odd_values_are_refused() -> void:
	expected_errors = [
		"1 to 100000 pixels",
		"1 to 100000 pixels",
		"height must be a finite number",
		"A stroke has at least one point"
	]
	var sketch: TreeSketch = TreeSketch.new()
	sketch.canvas_size = Vector2(0.0, 10.0)
	sketch.canvas_size = Vector2(NAN, 10.0)
	sketch.height = NAN
	check_equal(sketch.add_stroke(PackedVector2Array()), 0, "the id of nothing")
	check_equal(sketch.canvas_size, Vector2(1000.0, 1000.0), "the canvas")
	sketch.density = 100.0
	check_equal(sketch.density, 4.0, "the density")


func test_a_tree_of_strokes() -> void:
	var sketch: TreeSketch = small_sketch()
	var worker: TreeReconstructor = TreeReconstructor.new()
	var made: TreeReconstruction = worker.sketch_tree(sketch)
	check(made != null, worker.get_error_message())
	check(made.get_node_count() > 500, "It has only %d nodes." % made.get_node_count())
	check_near(made.get_aabb().size.y, 8.0, 0.5, "its height")
	check_equal(made.provenance["source"], "sketch", "where it comes from")
	var kept: TreeSketch = made.provenance["sketch"]
	check_equal(kept.strokes, sketch.strokes, "the strokes that it keeps")
	sketch.remove_stroke(1)
	check_equal(kept.strokes.size(), 4, "strokes kept after one was taken from the sketch")
	var roles: Array = worker.get_report()["strokes"].map(
		func(s: Dictionary) -> String: return s.role
	)
	check_equal(roles, ["outline", "trunk", "branch", "branch"], "roles")
	var again: TreeReconstruction = TreeReconstructor.new().sketch_tree(kept)
	check_equal(again.skeleton, made.skeleton, "the same tree again")


func test_a_tree_is_saved_with_its_strokes() -> void:
	var made: TreeReconstruction = TreeReconstructor.new().sketch_tree(small_sketch())
	var path: String = "user://sketched_test.res"
	check_equal(ResourceSaver.save(made, path), OK, "saving")
	var read: TreeReconstruction = ResourceLoader.load(path, "", ResourceLoader.CACHE_MODE_IGNORE)
	check_equal(read.skeleton, made.skeleton, "the skeleton")
	var strokes: TreeSketch = read.provenance["sketch"]
	check_equal(strokes.strokes, (made.provenance["sketch"] as TreeSketch).strokes, "the strokes")
	check_equal(strokes.height, 8.0, "the height")
	DirAccess.remove_absolute(path)


func test_strokes_go_through_a_file() -> void:
	var sketch: TreeSketch = small_sketch()
	sketch.species = "maple"
	sketch.seed = 7
	sketch.set_stroke_role(1, TreeSketch.ROLE_OUTLINE)
	var worker: TreeReconstructor = TreeReconstructor.new()
	check_equal(worker.save_sketch(sketch, SKETCH_FILE), OK, "saving")
	var read: TreeSketch = worker.load_sketch(SKETCH_FILE)
	check(read != null, worker.get_error_message())
	check_equal(read.strokes, sketch.strokes, "strokes")
	check_equal(read.species, "maple", "species")
	check_equal(read.seed, 7, "seed")
	DirAccess.remove_absolute(SKETCH_FILE)
	check(worker.load_sketch(SKETCH_FILE) == null, "A file that is gone is read.")
	check(SKETCH_FILE.get_file() in worker.get_error_message(), worker.get_error_message())


func test_what_makes_no_tree_gets_a_sentence() -> void:
	var worker: TreeReconstructor = TreeReconstructor.new()
	check(worker.sketch_tree(TreeSketch.new()) == null, "No strokes make a tree.")
	check(worker.get_error_message().ends_with("."), worker.get_error_message())
	var sketch: TreeSketch = small_sketch()
	sketch.species = "baobab"
	check(worker.sketch_tree(sketch) == null, "An unknown species makes a tree.")
	check("baobab" in worker.get_error_message(), worker.get_error_message())


func test_species() -> void:
	var names: Array = TreeReconstructor.get_sketch_species().map(
		func(species: Dictionary) -> String: return species.name
	)
	for name: String in ["ginkgo", "magnolia", "maple", "poplar"]:
		check(name in names, "There is no %s." % name)
		check(name in TreeReconstruction.get_leaf_preset_names(), "%s has no leaves." % name)


static func _ids(sketch: TreeSketch) -> Array:
	return sketch.strokes.map(func(stroke: Dictionary) -> int: return stroke["id"])


# --- twigs of one's own ---------------------------------------------------------------------------


# A tree of the same strokes as a scanned one would be: with leaves of another kind.
static func source_tree() -> TreeReconstruction:
	var sketch: TreeSketch = small_sketch()
	sketch.seed = 9
	var made: TreeReconstruction = TreeReconstructor.new().sketch_tree(sketch)
	made.resource_name = "Old Oak"
	made.leaf_preset = "oak"
	return made


func test_twigs_of_a_tree() -> void:
	var source: TreeReconstruction = source_tree()
	var rule: LeafRule = LeafRule.from_preset("oak")
	source.leaf_rule = rule
	var worker: TreeReconstructor = TreeReconstructor.new()
	var sketch: TreeSketch = small_sketch()
	var plain: TreeReconstruction = worker.sketch_tree(sketch)
	var made: TreeReconstruction = worker.sketch_tree(sketch, source)
	check(made != null, worker.get_error_message())
	if made == null:
		return
	check(made.skeleton != plain.skeleton, "It has a maple's twigs.")
	check_equal(made.leaf_preset, "oak", "its leaves")
	check(made.leaf_rule != null and made.leaf_rule != rule, "It has no rule of its own.")
	check_equal(sketch.twigs, "", "twigs of the sketch that was given")
	var kept: TreeSketch = made.provenance["sketch"]
	var told: Dictionary = JSON.parse_string(kept.twigs)
	check_equal(told["title"], "Old Oak", "whose twigs it keeps")
	check((told["twigs"] as Array).size() >= 4, "It keeps %d twigs." % told["twigs"].size())
	# Without the source, and with another seed.
	source = null
	check_equal(worker.sketch_tree(kept).skeleton, made.skeleton, "the same tree again")
	var other: TreeSketch = kept.duplicate()
	other.seed = 77
	var again: TreeReconstruction = worker.sketch_tree(other)
	check(again.skeleton != made.skeleton, "Another seed gives the same tree.")
	check_equal((again.provenance["sketch"] as TreeSketch).twigs, kept.twigs, "its twigs")


func test_twigs_of_a_library() -> void:
	var library: TwigLibrary = TwigLibrary.new()
	var source: TreeReconstruction = source_tree()
	var wanted: Array[String] = ["oak", "maple_long", "birch"]
	for name: String in wanted:
		library.twigs.append(TwigLibrary.presets().find(name))
	# A branch of a tree, as the dock keeps it; and a place that was left empty.
	library.twigs.append(Twig.from_branch(source, source.get_node_children(source.get_root())[0]))
	library.twigs.pop_back()
	library.twigs.append(null)
	var worker: TreeReconstructor = TreeReconstructor.new()
	var sketch: TreeSketch = worker.sketch_with_twigs(small_sketch(), library, "Mine")
	check(sketch != null, worker.get_error_message())
	if sketch == null:
		return
	check_equal(sketch.species, "", "the species")
	check_equal((JSON.parse_string(sketch.twigs)["twigs"] as Array).size(), 3, "twigs")
	var made: TreeReconstruction = worker.sketch_tree(sketch)
	check(made != null and made.get_node_count() > 300, worker.get_error_message())
	library.twigs.clear()
	check(worker.sketch_tree(small_sketch(), library) == null, "No twigs make a tree.")
	check("no twigs" in worker.get_error_message(), worker.get_error_message())
	check(worker.sketch_tree(small_sketch(), Resource.new()) == null, "Nothing makes a tree.")
	check("give a TwigLibrary" in worker.get_error_message(), worker.get_error_message())
	sketch.twigs = "nonsense"
	check(worker.sketch_tree(sketch) == null, "Nonsense makes a tree.")
	check("own twigs" in worker.get_error_message(), worker.get_error_message())


func test_any_branch_is_a_twig_to_keep() -> void:
	var source: TreeReconstruction = source_tree()
	var ids: PackedInt32Array = source.get_node_ids()
	for i: int in range(1, ids.size(), 97):
		if ids[i] == source.get_root():
			continue
		var twig: Twig = Twig.from_branch(source, ids[i], "One")
		check(twig.length > 0.0 and twig.base_radius > 0.0, "Node %d gives no twig." % ids[i])
		check(twig.thumbnail != null, "The twig of node %d has no picture." % ids[i])


func test_all_goes_through_a_file() -> void:
	var worker: TreeReconstructor = TreeReconstructor.new()
	var sketch: TreeSketch = worker.sketch_with_twigs(small_sketch(), source_tree())
	sketch.depth = TreeSketch.DEPTH_PAPER
	sketch.crown = TreeSketch.CROWN_ALPHA
	sketch.trunk_radius = 0.25
	sketch.density = 1.5
	check_equal(worker.save_sketch(sketch, SKETCH_FILE), OK, "saving")
	var read: TreeSketch = worker.load_sketch(SKETCH_FILE)
	check(read != null, worker.get_error_message())
	if read == null:
		return
	for property: String in ["twigs", "species", "depth", "crown", "trunk_radius", "density"]:
		check_equal(read.get(property), sketch.get(property), property)
	DirAccess.remove_absolute(SKETCH_FILE)
	# And with the tree in its own.
	var path: String = "user://own_twigs_test.res"
	var made: TreeReconstruction = worker.sketch_tree(sketch)
	check_equal(ResourceSaver.save(made, path), OK, "saving the tree")
	var tree_read: TreeReconstruction = ResourceLoader.load(
		path, "", ResourceLoader.CACHE_MODE_IGNORE
	)
	check_equal((tree_read.provenance["sketch"] as TreeSketch).twigs, sketch.twigs, "its twigs")
	DirAccess.remove_absolute(path)
