extends "./picture_suite.gd"
## Where wood is cut through, its face shows rings, heartwood and bark, in the renderer that this
## run uses.

const SIZE: Vector2i = Vector2i(400, 400)
const RADIUS: float = 0.06
const HEIGHT: float = 0.8
# Of the picture's half: how far the face reaches.
const REACH: float = 0.8
const DIRECTIONS: int = 12
# Of the light: less is no edge of a ring.
const STEP: float = 0.03


# A log without a foot, cut at both ends.
func _log() -> TreeReconstruction:
	var nodes: Array[Array] = []
	for i: int in 9:
		nodes.append([i - 1, 0.0, HEIGHT * i / 8.0, 0.0, RADIUS, NODE_MEASURED])
	var made: TreeReconstruction = TreeReconstruction.new()
	made.skeleton = skeleton(nodes)
	return made


# Lightness from the middle to the rim, one line for each direction.
func _lines(picture: Image) -> Array[PackedFloat32Array]:
	var lines: Array[PackedFloat32Array] = []
	var middle: Vector2 = 0.5 * Vector2(SIZE)
	for k: int in DIRECTIONS:
		var line: PackedFloat32Array = []
		for pixel: int in int(REACH * middle.x):
			var at: Vector2 = middle + Vector2.from_angle(TAU * (k + 0.3) / DIRECTIONS) * pixel
			line.append(picture.get_pixelv(Vector2i(at)).get_luminance())
		lines.append(line)
	return lines


# How often a line goes from light to dark and back.
static func _alternations(line: PackedFloat32Array) -> int:
	var count: int = 0
	var last: float = line[0]
	var rising: bool = true
	for value: float in line:
		if (value > last) == rising:
			last = value
		elif absf(value - last) > STEP:
			rising = not rising
			last = value
			count += 1
	@warning_ignore("integer_division")
	return count / 2


static func _mean(lines: Array[PackedFloat32Array], from: float, to: float) -> float:
	var sum: float = 0.0
	var count: int = 0
	for line: PackedFloat32Array in lines:
		for i: int in range(int(from * line.size()), int(to * line.size())):
			sum += line[i]
			count += 1
	return sum / count


func _check_cuts() -> void:
	_camera.fov = 20.0
	var away: float = RADIUS / REACH / tan(deg_to_rad(0.5 * _camera.fov))
	for side: float in [1.0, -1.0]:
		var face: Vector3 = Vector3(0.0, HEIGHT if side > 0.0 else 0.0, 0.0)
		_camera.look_at_from_position(face + side * away * Vector3.UP, face, Vector3.BACK)
		var lines: Array[PackedFloat32Array] = _lines(await _settled())
		for line: PackedFloat32Array in lines:
			var seen: int = _alternations(line)
			# At 2 to 4 mm a year.
			check(seen >= 13 and seen <= 30, "%d rings are seen from %s." % [seen, side])
		var heart: float = _mean(lines, 0.1, 0.4)
		var sap: float = _mean(lines, 0.65, 0.85)
		check(heart < 0.9 * sap, "The heartwood is %.3f, what is around it %.3f." % [heart, sap])
		var rind: float = _mean(lines, 0.96, 0.99)
		check(rind < 0.8 * sap, "The bark is %.3f, the wood within it %.3f." % [rind, sap])


func test_a_cut_shows_rings_heartwood_and_bark() -> void:
	_open_stage(SIZE)
	var instance: TreeInstance3D = await _show_tree(_log(), false)
	instance.leaves = false
	while instance.is_rebuilding():
		await tree.process_frame
	await _check_cuts()
	_viewport.free()


func test_so_does_that_of_a_baked_tree() -> void:
	_open_stage(SIZE)
	var made: TreeReconstruction = _log()
	made.leaf_preset = "none"
	var baker: TreeBaker = TreeBaker.new()
	baker.levels = 1
	baker.wind = false
	_viewport.add_child(baker.bake(made).instantiate())
	await _check_cuts()
	_viewport.free()
