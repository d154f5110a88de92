extends RefCounted
## What every file of tests extends: its methods named test_… run one after another, each on a fresh
## object. A test fails when a check fails, when the engine reports an error that no expect_error()
## announced, or when it stops halfway.

const NODE_TRUNK: int = 1
const NODE_MEASURED: int = 2

## The running scene tree.
var tree: SceneTree
## An empty folder of this run.
var folder: String

var failures: PackedStringArray = []
var expected_errors: PackedStringArray = []
var seen_errors: PackedStringArray = []


## Fails the test with `message` unless `condition` holds.
func check(condition: bool, message: String) -> void:
	if condition:
		return
	for frame: Dictionary in get_stack():
		if not frame.source.ends_with("/suite.gd"):
			failures.append("%s (%s:%d)" % [message, frame.source.get_file(), frame.line])
			return
	failures.append(message)


## Fails the test unless `given` equals `wanted`.
func check_equal(given: Variant, wanted: Variant, what: String) -> void:
	check(
		typeof(given) == typeof(wanted) and given == wanted,
		"%s is %s instead of %s" % [what, str(given).left(200), str(wanted).left(200)]
	)


## Fails the test unless `given` is within `tolerance` of `wanted`.
func check_near(given: float, wanted: float, tolerance: float, what: String) -> void:
	check(absf(given - wanted) <= tolerance, "%s is %s instead of %s" % [what, given, wanted])


## Announces that the engine will report an error containing `part`; the test fails if it does not.
func expect_error(part: String) -> void:
	expected_errors.append(part)


## Whether an announced error has come.
func has_seen(part: String) -> bool:
	for error: String in seen_errors:
		if part in error:
			return true
	return false


## A sentence for users: not empty, and without the marks of a raw exception.
func check_sentence(text: String, what: String) -> void:
	check(text.length() > 15 and text.ends_with("."), "%s is no sentence: '%s'" % [what, text])


## A skeleton as TreeReconstruction stores it. Each node: [parent's id, x, y, z, radius, flags]; ids
## count from 0.
static func skeleton(nodes: Array[Array]) -> Dictionary:
	var ids: PackedInt32Array = []
	var parents: PackedInt32Array = []
	var positions: PackedFloat64Array = []
	var radii: PackedFloat64Array = []
	var flags: PackedByteArray = []
	for node: Array in nodes:
		ids.append(ids.size())
		parents.append(node[0])
		positions.append_array(PackedFloat64Array([node[1], node[2], node[3]]))
		radii.append(node[4])
		flags.append(node[5])
	return {
		# Of a tree without leaf rules of its wood.
		"format_version": 1,
		"ids": ids,
		"parents": parents,
		"positions": bits(positions),
		"radii": bits(radii),
		"flags": flags,
		"frame": bits(PackedFloat64Array([443210.25, 5431234.5, 312.125, 1.0])),
		"up_axis": "z",
	}


## Doubles as a skeleton stores them.
static func bits(numbers: PackedFloat64Array) -> PackedInt64Array:
	return numbers.to_byte_array().to_int64_array()


## A random tree that forks, about 4 m tall, with some `count` nodes.
static func grown_tree(random_seed: int, count: int = 300) -> TreeReconstruction:
	var random: RandomNumberGenerator = RandomNumberGenerator.new()
	random.seed = random_seed
	var nodes: Array[Array] = [[-1, 0.0, 0.0, 0.0, 0.1, NODE_TRUNK | NODE_MEASURED]]
	var directions: PackedVector3Array = [Vector3.UP]
	for i: int in range(1, count):
		var on_trunk: bool = i <= 12
		var parent: int = i - 1 if on_trunk else random.randi_range(i * 2 / 5, i - 1)
		var away: Vector3 = Vector3(random.randfn(), random.randfn() * 0.5, random.randfn())
		var spread: float = 0.05 if on_trunk else 0.5
		var direction: Vector3 = (directions[parent] + away * spread).normalized()
		directions.append(direction)
		var length: float = 0.25 if on_trunk else random.randf_range(0.05, 0.2)
		var place: Vector3 = Vector3(nodes[parent][1], nodes[parent][2], nodes[parent][3])
		place += direction * length
		nodes.append(
			[
				parent,
				place.x,
				place.y,
				place.z,
				maxf(nodes[parent][4] * 0.9, 0.002),
				NODE_TRUNK if on_trunk else 0
			]
		)
	var made: TreeReconstruction = TreeReconstruction.new()
	made.skeleton = skeleton(nodes)
	return made


## Writes a scan (x y z text, z up) of a small forked tree and returns its path.
func write_scan(file_name: String, points_per_metre: int = 2500) -> String:
	var random: RandomNumberGenerator = RandomNumberGenerator.new()
	random.seed = 11
	var lines: PackedStringArray = []
	var branches: Array[Array] = [
		[Vector3(0, 0, 0), Vector3(0.05, 0, 2.2), 0.08, 0.06],
		[Vector3(0.05, 0, 2.2), Vector3(0.7, 0.1, 3.4), 0.045, 0.02],
		[Vector3(0.05, 0, 2.2), Vector3(-0.6, 0.3, 3.5), 0.045, 0.02],
		[Vector3(-0.28, 0.15, 2.85), Vector3(-0.3, -0.5, 3.5), 0.02, 0.012],
		[Vector3(0.4, 0.05, 2.85), Vector3(0.4, 0.7, 3.4), 0.02, 0.012],
	]
	for branch: Array in branches:
		var from: Vector3 = branch[0]
		var to: Vector3 = branch[1]
		var along: Vector3 = (to - from).normalized()
		var side: Vector3 = along.cross(Vector3(0.9, 0.2, 0.1)).normalized()
		for i: int in int(from.distance_to(to) * points_per_metre):
			var t: float = random.randf()
			var radius: float = lerpf(branch[2], branch[3], t)
			var place: Vector3 = from.lerp(to, t)
			place += side.rotated(along, random.randf() * TAU) * (radius + random.randfn() * 0.001)
			lines.append("%.5f %.5f %.5f" % [place.x, place.y, place.z])
	return write_text(file_name, "\n".join(lines))


## Writes a file into this run's folder and returns its path.
func write_text(file_name: String, text: String) -> String:
	var path: String = folder.path_join(file_name)
	var file: FileAccess = FileAccess.open(path, FileAccess.WRITE)
	file.store_string(text)
	file.close()
	return path
