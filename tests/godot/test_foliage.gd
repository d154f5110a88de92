extends "./suite.gd"
## What a scan saw of the leaves: found, saved, followed, and refused where it is damaged.

const FLOATS_PER_LEAF: int = 20


func test_a_leafy_scan_gets_foliage() -> void:
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	var path: String = _write_leafy_scan()
	var made: TreeReconstruction = reconstructor.reconstruct_file(path, {"up": "z", "scale": 1.0})
	check(made != null, "No tree: " + reconstructor.get_error_message())
	if made == null:
		return
	check(made.has_foliage(), "The leaves were not seen.")
	check(reconstructor.get_report()["leaf_points"] > 5000, "Few leaves were seen.")
	check_equal(made.get_foliage_colors().size(), made.get_foliage_positions().size(), "the colors")
	for place: Vector3 in made.get_foliage_positions():
		check(place.y > 1.5, "There are leaves at %s." % place)
	var plain: TreeReconstruction = reconstructor.reconstruct_file(
		path, {"up": "z", "scale": 1.0, "tell_leaves": false}
	)
	check(plain != null and not plain.has_foliage(), "Leaves were told apart though not asked for.")


func test_leaves_stand_in_the_foliage() -> void:
	var made: TreeReconstruction = grown_tree(5)
	var tip: Vector3 = made.get_node_position(made.get_leaves()[0])
	made.foliage = foliage_at(tip)
	check(made.has_foliage() and made.foliage_followed, "The foliage is not followed.")
	var places: PackedVector3Array = _leaf_places(made)
	check(places.size() > 10, "Only %d leaves stand in it." % places.size())
	for place: Vector3 in places:
		check(place.distance_to(tip) < 1.0, "A leaf stands at %s, far from %s." % [place, tip])
	made.foliage_followed = false
	var plain: TreeReconstruction = grown_tree(5)
	check_equal(made.build_leaf_buffer(), plain.build_leaf_buffer(), "leaves by the rules alone")


func test_saves_and_loads() -> void:
	var made: TreeReconstruction = grown_tree(6)
	made.leaf_preset = "oak"
	made.foliage = foliage_at(Vector3(0.1, 3.0, -0.2))
	made.foliage_followed = false
	for extension: String in ["tres", "res"]:
		var path: String = folder.path_join("foliage." + extension)
		check_equal(ResourceSaver.save(made, path), OK, "saving " + extension)
		var read: TreeReconstruction = (
			ResourceLoader.load(path, "", ResourceLoader.CACHE_MODE_IGNORE) as TreeReconstruction
		)
		check_equal(read.foliage, made.foliage, "the foliage in ." + extension)
		check(not read.foliage_followed, "It is followed again after loading .%s." % extension)
		check_equal(read.get_foliage_positions(), made.get_foliage_positions(), "the places")
		check_equal(read.get_foliage_colors(), made.get_foliage_colors(), "the colors")


func test_says_when_it_changes() -> void:
	var made: TreeReconstruction = grown_tree(2)
	var count: Array[int] = [0]
	made.changed.connect(func() -> void: count[0] += 1)
	made.foliage = foliage_at(Vector3(0, 3, 0))
	made.foliage_followed = false
	made.foliage = {}
	check(count[0] >= 3, "It said so %d times." % count[0])
	check(not made.has_foliage(), "Foliage stayed.")


func test_a_preset_leaves_the_foliage_alone() -> void:
	var made: TreeReconstruction = grown_tree(2)
	made.foliage_followed = false
	made.leaf_preset = "birch"
	check(not made.foliage_followed, "The preset made it follow the foliage.")


func test_refuses_a_newer_version_and_keeps_it() -> void:
	expect_error("newer version")
	var newer: Dictionary = foliage_at(Vector3.UP)
	newer["format_version"] = TreeReconstruction.FOLIAGE_VERSION + 1
	var made: TreeReconstruction = grown_tree(1)
	made.foliage = newer
	check(not made.has_foliage(), "Newer foliage was read.")
	check_equal(made.foliage, newer, "what saving would write")


func test_refuses_damaged_foliage() -> void:
	var good: Dictionary = foliage_at(Vector3(0, 2, 0))
	var spoilt: Array[Dictionary] = []
	for key: String in good:
		for value: Variant in [null, "text", -1, PackedInt64Array([7]), PackedByteArray([1, 2])]:
			var bad: Dictionary = good.duplicate(true)
			bad[key] = value
			spoilt.append(bad)
		var less: Dictionary = good.duplicate(true)
		less.erase(key)
		spoilt.append(less)
	for place: int in 5:
		for number: float in [NAN, INF, -INF]:
			var bad: Dictionary = good.duplicate(true)
			var numbers: PackedFloat64Array = [0.0, 0.0, 0.0, 0.1, 0.0]
			numbers[place] = number
			bad["place"] = bits(numbers)
			spoilt.append(bad)
	var twice: Dictionary = good.duplicate(true)
	twice["cells"] = (good["cells"] as PackedByteArray) + (good["cells"] as PackedByteArray)
	spoilt.append(twice)
	expect_error(".")
	for bad: Dictionary in spoilt:
		var made: TreeReconstruction = grown_tree(1)
		made.foliage = bad
		check(not made.has_foliage(), "This was taken for foliage: %s" % bad)
		check_equal(
			made.build_leaf_buffer(), grown_tree(1).build_leaf_buffer(), "leaves by the rules alone"
		)


## Foliage as TreeReconstruction stores it: a block of 5 x 5 x 5 cells around `center`.
static func foliage_at(center: Vector3) -> Dictionary:
	var edge: float = 0.1
	var corner: Vector3 = center - Vector3.ONE * 2.5 * edge
	var cells: PackedByteArray = []
	for x: int in 5:
		for y: int in 5:
			for z: int in 5:
				cells.append_array(PackedByteArray([x, 0, y, 0, z, 0, 3 + x, 0, 90, 120, 40 + z]))
	return {
		"format_version": TreeReconstruction.FOLIAGE_VERSION,
		"place": bits(PackedFloat64Array([corner.x, corner.y, corner.z, edge, 0.0])),
		"colored": true,
		"cells": cells,
	}


static func _leaf_places(made: TreeReconstruction) -> PackedVector3Array:
	var buffer: PackedFloat32Array = made.build_leaf_buffer()
	var places: PackedVector3Array = []
	for i: int in range(0, buffer.size(), FLOATS_PER_LEAF):
		places.append(Vector3(buffer[i + 3], buffer[i + 7], buffer[i + 11]))
	return places


# Brown wood as in write_scan(), green leaves around its upper branches, as x y z r g b.
func _write_leafy_scan() -> String:
	var wood: String = FileAccess.get_file_as_string(write_scan("wood.xyz"))
	var lines: PackedStringArray = []
	for line: String in wood.split("\n", false):
		lines.append(line + " 120 100 80")
	var random: RandomNumberGenerator = RandomNumberGenerator.new()
	random.seed = 12
	var clumps: Array[Vector3] = [
		Vector3(0.7, 0.1, 3.4),
		Vector3(-0.6, 0.3, 3.5),
		Vector3(-0.3, -0.5, 3.5),
		Vector3(0.4, 0.7, 3.4)
	]
	for i: int in 12000:
		var away: Vector3 = Vector3(random.randfn(), random.randfn(), random.randfn()) * 0.14
		var place: Vector3 = clumps[i % 4] + away
		lines.append("%.4f %.4f %.4f 70 130 50" % [place.x, place.y, place.z])
	return write_text("leafy.xyz", "\n".join(lines))
