extends "suite.gd"
## What a new import does to trees that were edited, and where several trees stand.

const Reimport: GDScript = preload("res://addons/tree_reconstruction/editor/import/reimport.gd")
const OwnTrees: GDScript = preload("res://addons/tree_reconstruction/editor/import/own_trees.gd")
const SceneAdder: GDScript = preload(
	"res://addons/tree_reconstruction/editor/import/scene_adder.gd"
)


# An import of the same scan that came out a little otherwise: shifted by less than edits mind.
static func _imported_again(made: TreeReconstruction, shift: float) -> TreeReconstruction:
	var again: TreeReconstruction = TreeReconstruction.new()
	again.skeleton = made.skeleton
	again.run_script("move nodes=%d by=%s,0,0" % [made.get_leaves()[0], shift])
	again.edit_log = ""
	again.provenance = {"source": "res://again.ply"}
	return again


func test_edits_are_done_again() -> void:
	for i: int in 8:
		var imported: TreeReconstruction = grown_tree(i)
		var local: TreeReconstruction = imported.duplicate() as TreeReconstruction
		local.edit("cut node=%d" % local.get_leaves()[5])
		local.edit("prune_order order=3")
		var before: Dictionary = local.skeleton
		var fresh: TreeReconstruction = _imported_again(imported, 0.004)
		var untouched: Dictionary = fresh.skeleton
		var result: Dictionary = Reimport.replayed(local, fresh)
		check_equal(result["done"], 2, "edits that were done again")
		check_equal(result["left_out"].size(), 0, "edits that were left out")
		var made: TreeReconstruction = result["tree"]
		check_equal(made.get_node_count(), local.get_node_count(), "nodes")
		check_equal(made.provenance["source"], "res://again.ply", "the source")
		check(not made.edit_log.is_empty(), "The log is lost.")
		# Neither the user's tree nor the import was changed on the way.
		check_equal(local.skeleton, before, "the user's tree")
		check_equal(fresh.skeleton, untouched, "the import")


func test_what_no_longer_fits_is_told_and_kept() -> void:
	var local: TreeReconstruction = grown_tree(3)
	local.edit("cut node=%d" % local.get_leaves()[2])
	var log_before: String = local.edit_log
	var other: TreeReconstruction = grown_tree(3, 6)
	var result: Dictionary = Reimport.replayed(local, other)
	check_equal(result["done"], 0, "edits that were done again")
	check_equal(result["left_out"].size(), 1, "edits that were left out")
	check_sentence(result["left_out"][0]["reason"], "the reason")
	# It fits again where the scan is what it was.
	var back: Dictionary = Reimport.replayed(result["tree"], grown_tree(3))
	check_equal(back["done"], 1, "edits that were done when it fits again")
	check_equal((back["tree"] as TreeReconstruction).skeleton, local.skeleton, "the tree")
	check_equal(local.edit_log, log_before, "the log")


func test_an_unedited_copy_is_the_import() -> void:
	var fresh: TreeReconstruction = grown_tree(5)
	var result: Dictionary = Reimport.replayed(grown_tree(4), fresh)
	check_equal((result["tree"] as TreeReconstruction).skeleton, fresh.skeleton, "the tree")


# However a scan is moved in the FileSystem dock, the trees that were made of it are its own.
func test_a_moved_scan_has_its_trees() -> void:
	for seed: int in 20:
		var random: RandomNumberGenerator = RandomNumberGenerator.new()
		random.seed = seed
		var own: OwnTrees = OwnTrees.new()
		# Where each of some scans is now, by where its tree says it is.
		var places: Dictionary[String, String] = {}
		for i: int in 4:
			places["res://gone/%d.ply" % i] = "res://gone/%d.ply" % i
		for step: int in 12:
			var which: String = places.keys()[random.randi_range(0, 3)]
			var to: String = "res://gone/%d.ply" % random.randi_range(0, 9)
			if to not in places.values():
				own.note_move(places[which], to)
				places[which] = to
		for told: String in places:
			for at: String in places:
				check_equal(
					own.is_of({"source": told, "report": {"points_read": 1.0}}, places[at], {}),
					told == at,
					"whether the tree of %s is that of %s, now %s" % [told, at, places[at]]
				)
		# Once they have followed, a name means what lies there.
		for told: String in places:
			own.note_followed(places[told])
		for told: String in places:
			check(own.is_of({"source": places[told]}, places[told], {}), "It is forgotten.")


func test_a_scan_that_another_program_moved_is_known_by_its_points() -> void:
	var own: OwnTrees = OwnTrees.new()
	var report: Dictionary = {
		"points_read": 4711.0, "origin": [1.0, 2.0, 3.0], "height_m": 8.0, "metres_per_unit": 1.0
	}
	var was: Dictionary = {"source": "res://gone.ply", "report": report}
	check(own.is_of(was, "res://new.ply", {"report": report}), "It is not known.")
	var near: Dictionary = report.merged({"origin": [1.1, 2.0, 3.0], "height_m": 8.1}, true)
	check(own.is_of(was, "res://new.ply", {"report": near}), "Other options made another scan.")
	for other: Dictionary in [{"points_read": 4712.0}, {"origin": [9.0, 2.0, 3.0]}, {"origin": []}]:
		check(
			not own.is_of(was, "res://new.ply", {"report": report.merged(other, true)}),
			"Another scan is taken for it: %s" % other
		)
	# A scan that is there was not moved.
	var there: Dictionary = {"source": "res://project.godot", "report": report}
	check(not own.is_of(there, "res://new.ply", {"report": report}), "It was taken from its scan.")


func test_trees_stand_side_by_side() -> void:
	var trees: Array[TreeReconstruction] = [grown_tree(1), grown_tree(2, 40), grown_tree(3)]
	var offsets: PackedVector3Array = SceneAdder.side_by_side(trees)
	check_equal(offsets[0], Vector3.ZERO, "the first one's place")
	for i: int in range(1, trees.size()):
		var left: AABB = trees[i - 1].get_aabb()
		var right: AABB = trees[i].get_aabb()
		check(
			offsets[i].x + right.position.x > offsets[i - 1].x + left.end.x,
			"Crowns %d and %d meet." % [i - 1, i]
		)
