extends "./suite.gd"
## TreeReconstruction: what it stores, refuses, answers.

const STORED: PackedStringArray = [
	"skeleton", "provenance", "seed", "leaf_preset", "leaf_size", "leaf_angle", "leaves_enabled"
]


func test_saves_and_loads_as_text_and_binary() -> void:
	var made: TreeReconstruction = grown_tree(3)
	made.seed = 1234567890123
	made.leaf_preset = "oak"
	made.leaf_size = 0.21
	made.provenance = {"source": "scan.ply", "report": {"points": 12}}
	for extension: String in ["tres", "res"]:
		var path: String = folder.path_join("tree." + extension)
		check_equal(ResourceSaver.save(made, path), OK, "saving " + extension)
		var read: TreeReconstruction = (
			ResourceLoader.load(path, "", ResourceLoader.CACHE_MODE_IGNORE) as TreeReconstruction
		)
		check(read != null, "No tree came back from ." + extension)
		for property: String in STORED:
			check_equal(read.get(property), made.get(property), "%s in .%s" % [property, extension])
		check_equal(read.get_positions(), made.get_positions(), "positions")
		check_equal(read.build_leaf_buffer(), made.build_leaf_buffer(), "the leaves")


# Where photos told the way up, it is along none of the scan's axes.
func test_a_tilted_tree_keeps_its_place_in_the_scan() -> void:
	var tilt: Quaternion = Quaternion(Vector3(1.0, 0.0, 2.0).normalized(), 0.3)
	var tilted: Dictionary = skeleton([[-1, 0, 0, 0, 0.1, 1], [0, 0, 1, 0, 0.1, 1]])
	tilted["up_axis"] = "y"
	tilted["frame"] = bits(PackedFloat64Array([5.0, 6.0, 7.0, 0.5, tilt.x, tilt.y, tilt.z]))
	var made: TreeReconstruction = TreeReconstruction.new()
	made.skeleton = tilted
	check_equal(made.skeleton, tilted, "what saving writes")
	var place: PackedFloat64Array = made.get_node_scan_position(1)
	var wanted: Vector3 = Vector3(5.0, 6.0, 7.0) + tilt.inverse() * Vector3.UP / 0.5
	check(Vector3(place[0], place[1], place[2]).distance_to(wanted) < 1e-5, "It is at %s." % place)
	check(made.get_position_in_tree(place).distance_to(Vector3.UP) < 1e-6, "It does not come back.")


func test_duplicate_is_independent() -> void:
	var made: TreeReconstruction = grown_tree(4)
	var copy: TreeReconstruction = made.duplicate() as TreeReconstruction
	check_equal(copy.skeleton, made.skeleton, "the copy's skeleton")
	copy.skeleton = {}
	check(copy.is_empty() and not made.is_empty(), "Emptying the copy touched the original.")


func test_refuses_a_newer_version_and_keeps_it() -> void:
	expect_error("newer version")
	var newer: Dictionary = skeleton([[-1, 0, 0, 0, 0.1, 1], [0, 0, 1, 0, 0.1, 1]])
	newer["format_version"] = TreeReconstruction.FORMAT_VERSION + 1
	var made: TreeReconstruction = TreeReconstruction.new()
	made.skeleton = newer
	check(made.is_empty(), "A newer tree was read.")
	check_equal(made.skeleton, newer, "what saving would write")


func test_refuses_damaged_skeletons() -> void:
	var good: Dictionary = skeleton(
		[[-1, 0, 0, 0, 0.1, 1], [0, 0, 1, 0, 0.1, 1], [1, 0, 2, 0, 0.1, 0]]
	)
	var spoilt: Array[Dictionary] = []
	for key: String in good:
		for value: Variant in [null, "text", -1, PackedInt32Array([7]), PackedFloat64Array([NAN])]:
			var bad: Dictionary = good.duplicate(true)
			bad[key] = value
			# These two are as good as any.
			if key == "format_version" and value is int and value == 1:
				continue
			spoilt.append(bad)
		var less: Dictionary = good.duplicate(true)
		less.erase(key)
		spoilt.append(less)
	for parents: PackedInt32Array in [
		PackedInt32Array([-1, 2, 1]),
		PackedInt32Array([0, 0, 1]),
		PackedInt32Array([-1, -1, 1]),
		PackedInt32Array([-1, 0, 99]),
		PackedInt32Array([-1, 0, -2147483648]),
		PackedInt32Array([2, 0, 1]),
	]:
		var bad: Dictionary = good.duplicate(true)
		bad["parents"] = parents
		spoilt.append(bad)
	for ids: PackedInt32Array in [
		PackedInt32Array([0, 1, 1]),
		PackedInt32Array([0, 1, -1]),
		PackedInt32Array([0, 1, 2147483647]),
	]:
		var bad: Dictionary = good.duplicate(true)
		bad["ids"] = ids
		spoilt.append(bad)
	for number: float in [NAN, INF, -1.0, 0.0]:
		var bad: Dictionary = good.duplicate(true)
		bad["radii"] = bits(PackedFloat64Array([0.1, number, 0.1]))
		spoilt.append(bad)
	for place: int in 4:
		for number: float in [NAN, INF, -INF]:
			var bad: Dictionary = good.duplicate(true)
			var frame: PackedFloat64Array = [0.0, 0.0, 0.0, 1.0]
			frame[place] = number
			bad["frame"] = bits(frame)
			spoilt.append(bad)
	for frame: PackedFloat64Array in [
		[0.0, 0.0, 0.0, 1.0, 0.1], [0.0, 0.0, 0.0, 1.0, 0.9, 0.9, 0.0]
	]:
		var bad: Dictionary = good.duplicate(true)
		bad["frame"] = bits(frame)
		spoilt.append(bad)
	expect_error(".")
	for bad: Dictionary in spoilt:
		var made: TreeReconstruction = TreeReconstruction.new()
		made.skeleton = bad
		check(made.is_empty(), "This was taken for a tree: %s" % bad)
		check_equal(made.get_node_count(), 0, "the number of nodes")
		check(made.build_mesh().get_surface_count() == 0, "An empty tree got a mesh.")


# Outlines that were measured: the second to the fifth harmonic, their cosines and then their sines.
func test_keeps_measured_sections_and_refuses_damaged_ones() -> void:
	var measured: Dictionary = skeleton([[-1, 0, 0, 0, 0.2, 1], [0, 0, 1, 0, 0.2, 1]])
	measured["section_nodes"] = PackedInt32Array([1])
	measured["sections"] = PackedFloat32Array([0.1, 0.0, 0.05, 0.0, 0.0, -0.1, 0.0, 0.02])
	measured["format_version"] = 3
	var made: TreeReconstruction = TreeReconstruction.new()
	made.skeleton = measured
	check_equal(made.skeleton, measured, "what saving writes")
	var round_one: TreeReconstruction = TreeReconstruction.new()
	round_one.skeleton = skeleton([[-1, 0, 0, 0, 0.2, 1], [0, 0, 1, 0, 0.2, 1]])
	check(
		made.build_mesh_arrays(0) != round_one.build_mesh_arrays(0),
		"Its bark is as round as without."
	)
	for numbers: PackedFloat32Array in [
		PackedFloat32Array([0.1]),
		PackedFloat32Array([NAN, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
		PackedFloat32Array([1e9, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
	]:
		expect_error("measured sections")
		var bad: Dictionary = measured.duplicate()
		bad["sections"] = numbers
		TreeReconstruction.new().skeleton = bad
	expect_error("measured sections")
	var nowhere: Dictionary = measured.duplicate()
	nowhere["section_nodes"] = PackedInt32Array([7])
	TreeReconstruction.new().skeleton = nowhere


func test_knows_kinds_depths_and_the_trunk() -> void:
	var made: TreeReconstruction = TreeReconstruction.new()
	made.skeleton = skeleton(
		[
			[-1, 0, 0, 0, 0.2, 3],
			[0, 0, 1, 0, 0.2, 3],
			[1, 0, 2, 0, 0.1, 1],
			[1, 1, 2, 0, 0.05, 0],
			[3, 2, 2, 0, 0.05, 0],
		]
	)
	check_equal(made.get_root(), 0, "the root")
	check_equal(made.get_node_kind(0), TreeReconstruction.NODE_KIND_TRUNK, "the root's kind")
	check_equal(made.get_node_kind(1), TreeReconstruction.NODE_KIND_BRANCH, "the fork's kind")
	check_equal(made.get_node_kind(2), TreeReconstruction.NODE_KIND_LEAF, "the top's kind")
	check_equal(made.get_node_kind(3), TreeReconstruction.NODE_KIND_COMMON, "the twig's kind")
	check_equal(made.get_node_depth(4), 4, "the tip's depth")
	check_equal(made.get_leaves(), PackedInt32Array([2, 4]), "the leaves")
	check_equal(made.get_branch_nodes(), PackedInt32Array([1]), "the forks")
	check_equal(made.get_trunk_nodes(), PackedInt32Array([0, 1, 2]), "the trunk")
	check_equal(made.get_node_children(1), PackedInt32Array([2, 3]), "the fork's children")
	check_equal(made.get_node_parent(0), TreeReconstruction.NO_NODE, "the root's parent")
	check(
		made.is_radius_measured(0) and not made.is_radius_measured(4), "Measured radii are wrong."
	)
	check_near(made.get_node_radius(3), 0.05, 1e-9, "the twig's radius")
	check_equal(made.get_node_position(4), Vector3(2, 2, 0), "the tip's position")
	var scan: PackedFloat64Array = made.get_node_scan_position(0)
	check_equal(scan, PackedFloat64Array([443210.25, 5431234.5, 312.125]), "the root in the scan")


func test_unknown_nodes_are_errors_with_defaults() -> void:
	var made: TreeReconstruction = grown_tree(1)
	expect_error("no node")
	for id: int in [-1, -2147483648, 300, 2147483647]:
		check(not made.has_node(id), "There is a node %d." % id)
		check_equal(made.get_node_position(id), Vector3.ZERO, "its position")
		check_equal(made.get_node_radius(id), 0.0, "its radius")
		check_equal(made.get_node_parent(id), TreeReconstruction.NO_NODE, "its parent")
		check(made.get_node_children(id).is_empty(), "It has children.")


func test_says_when_it_changes() -> void:
	var made: TreeReconstruction = TreeReconstruction.new()
	var count: Array[int] = [0]
	made.changed.connect(func() -> void: count[0] += 1)
	made.skeleton = skeleton([[-1, 0, 0, 0, 0.1, 1], [0, 0, 1, 0, 0.1, 1]])
	made.seed = 5
	made.leaf_preset = "birch"
	made.leaf_size = 0.3
	check(count[0] >= 4, "It said so %d times." % count[0])


func test_leaf_presets() -> void:
	var names: PackedStringArray = TreeReconstruction.get_leaf_preset_names()
	check("birch" in names and "none" in names, "Presets are missing: %s" % names)
	var made: TreeReconstruction = TreeReconstruction.new()
	for name: String in names:
		made.leaf_preset = name
		check_equal(made.leaf_preset, name, "the preset")
	expect_error("birch")
	made.leaf_preset = "no such leaf"
	check(made.leaf_preset in names, "An unknown preset was taken.")


# As the inspector does: it keeps the linked properties, sets the preset, and undoes all.
func test_undoing_a_preset_brings_the_tuned_values_back() -> void:
	var made: TreeReconstruction = grown_tree(2)
	made.leaf_preset = "oak"
	made.leaf_size = 0.4
	made.leaves_enabled = false
	made.maximum_leaves = 77
	made.leaf_arrangement = TreeReconstruction.LEAF_ARRANGEMENT_OPPOSITE
	var before: Dictionary[String, Variant] = _leaf_properties(made)
	check(before.size() > 8, "The leaves have %d properties." % before.size())
	var linked: PackedStringArray = made.call("_get_linked_undo_properties", &"leaf_preset", "pine")
	made.leaf_preset = "pine"
	made.leaf_preset = "oak"
	for property: String in linked:
		made.set(property, before[property])
	check_equal(_leaf_properties(made), before, "the leaf properties after the undo")
	linked = made.call("_get_linked_undo_properties", &"seed", 3)
	check_equal(linked.size(), 0, "what is linked to the seed")


# All that stands in the inspector's group "Leaves".
func _leaf_properties(of: TreeReconstruction) -> Dictionary[String, Variant]:
	var values: Dictionary[String, Variant] = {}
	var group: Dictionary = {}
	for property: Dictionary in of.get_property_list():
		if property.usage & (PROPERTY_USAGE_GROUP | PROPERTY_USAGE_CATEGORY):
			group = property
		elif group.get("name") == "Leaves" and property.name.begins_with(group.hint_string):
			values[property.name] = of.get(property.name)
	return values


func test_the_leaves_stand_in_one_group() -> void:
	var grouped: Dictionary[String, Variant] = _leaf_properties(grown_tree(2))
	for property: Dictionary in ClassDB.class_get_property_list("TreeReconstruction", true):
		var name: String = property.name
		if "lea" in name and not property.usage & PROPERTY_USAGE_GROUP:
			check(grouped.has(name), name + " stands outside the group.")


func test_leaf_values_stay_in_range() -> void:
	expect_error("finite")
	var made: TreeReconstruction = TreeReconstruction.new()
	for property: Dictionary in made.get_property_list():
		if not property.name.begins_with("leaf_") or property.type != TYPE_FLOAT:
			continue
		for value: float in [NAN, INF, -INF, -1e300, 1e300, 0.0]:
			made.set(property.name, value)
			check(is_finite(made.get(property.name)), "%s became %s." % [property.name, value])
	made.maximum_leaves = -5
	check(made.maximum_leaves >= 0, "A negative number of leaves is allowed.")


func test_measures() -> void:
	var made: TreeReconstruction = grown_tree(8)
	var measures: Dictionary = made.measure()
	for key: String in ["height", "dbh", "crown_radius", "volume", "total_length"]:
		check(measures[key] is float and is_finite(measures[key]), "%s is missing." % key)
		check(measures[key] >= 0.0, "%s is negative." % key)
	check_near(measures["height"], made.get_aabb().end.y, 0.2, "the height")
	check_equal(int(measures["nodes"]), made.get_node_count(), "the nodes")
	check_equal(int(measures["tips"]), made.get_leaves().size(), "the tips")
	check(TreeReconstruction.new().measure() is Dictionary, "An empty tree can't be measured.")
