@tool
extends RefCounted
## What can grow on bark or stand in its way: how it begins on wood of some thickness, how large it
## is, and its outline in the tree's space.

const Recipe := preload("../dock/growth_recipe.gd")

## In the order of menus.
const KINDS: Array[StringName] = [
	&"burl", &"ridge", &"hollow", &"post", &"wire", &"box", &"sheet", &"ring"
]
## What grows larger with a feature, by its kind.
const _SIZES: Dictionary[StringName, Array] = {
	&"burl": ["radius"],
	&"ridge": ["radius"],
	&"hollow": ["width", "height"],
	&"post": ["radius"],
	&"wire": ["thickness"],
	&"box": ["width", "length"],
	&"sheet": ["width", "length"],
	&"ring": ["radius"],
}
# Numbers of a new one in radii of the wood beneath it, and others as they are.
const _BEGINS: Dictionary[StringName, Dictionary] = {
	&"burl": {"radius": 1.0},
	&"ridge": {"radius": 0.5, "length": 6.0},
	&"hollow": {"width": 0.7, "height": 1.6, "depth": 0.6},
	&"post": {"gap": -0.1, "radius": 0.2, "length": 7.0},
	&"wire": {"gap": -0.2, "length": 8.0, "thickness": 0.03},
	&"box": {"width": 0.6, "length": 0.6, "thickness": 0.5},
	&"sheet": {"width": 0.8, "length": 0.8, "gap": -0.15},
	&"ring": {"gap": -1.0, "radius": 0.85, "thickness": 0.1},
}
const _WORDS: Dictionary[StringName, Dictionary] = {
	&"burl": {"growth": "0.8"},
	&"ridge": {"growth": "0.6", "grain": "yes"},
	&"post": {"direction": "0,1,0"},
}
# Metres: nothing of a new feature is smaller.
const _LEAST: float = 0.004
const _SIDES: int = 32


## A line of a recipe that has one of [member KINDS] on wood of some radius, in metres, and so many
## times as large as usual.
static func make(kind: StringName, radius: float, size: float = 1.0) -> Recipe.Line:
	var command: String = "obstacle"
	if kind in [&"burl", &"ridge"]:
		command = "burl"
	elif kind == &"hollow":
		command = "hollow"
	var line: Recipe.Line = Recipe.Line.new(command)
	if command == "obstacle":
		line.values["shape"] = String(kind)
	line.values["along"] = "0"
	line.values["around"] = "0"
	var begins: Dictionary = _BEGINS[kind]
	for name: String in begins:
		var value: float = begins[name] * radius
		if name in _SIZES[kind]:
			value = value * size
		line.values[name] = Recipe.written(value if name == "gap" else maxf(value, _LEAST))
	for name: String in _WORDS.get(kind, {}):
		line.values[name] = _WORDS[kind][name]
	return line


## Which of [member KINDS] a line is, or [code]scene[/code] for a node of it; empty for others, as a
## mesh.
static func kind_of(line: Recipe.Line) -> StringName:
	match line.command:
		"burl":
			return &"ridge" if line.values.get("grain", "no") in ["yes", "true", "1"] else &"burl"
		"hollow":
			return &"hollow"
		"obstacle":
			if line.values.has("scene"):
				return &"scene"
			var shape: StringName = line.values.get("shape", "post")
			return shape if shape in KINDS else &""
	return &""


## Makes a feature so many times as large.
static func scale(line: Recipe.Line, factor: float, defaults: Callable) -> void:
	for name: String in _SIZES.get(kind_of(line), []):
		var standard: String = defaults.call(line.command, name)
		var value: float = line.values.get(name, standard).to_float() * factor
		line.values[name] = Recipe.written(maxf(value, _LEAST))
		# It goes with the radius unless it is told.
		line.values.erase("inner")


## How far a feature reaches over the bark, in metres.
static func reach_of(line: Recipe.Line, defaults: Callable) -> float:
	var names: Array = _SIZES.get(kind_of(line), [])
	if names.is_empty():
		return 0.1
	var standard: String = defaults.call(line.command, names[0])
	return line.values.get(names[0], standard).to_float()


## The outline of a feature as pairs of places in the tree's space. [param place] is what [method
## TreeReconstructor.find_bark] tells of it, [param defaults] gives a parameter's default.
static func outline_of(
	line: Recipe.Line, place: Dictionary, defaults: Callable
) -> PackedVector3Array:
	var lines: PackedVector3Array = []
	if place.is_empty():
		return lines
	var number: Callable = func(name: String) -> float:
		var standard: String = defaults.call(line.command, name)
		return line.values.get(name, standard).to_float()
	match kind_of(line):
		&"burl", &"ridge":
			_add_circle(lines, place, number.call("radius"), number.call("radius"))
		&"hollow":
			_add_circle(lines, place, 0.5 * number.call("width"), 0.5 * number.call("height"))
		&"scene", &"":
			# It is seen in the scene, if at all.
			pass
		_:
			_add_obstacle(lines, line, place, number)
	return lines


# An ellipse that lies on the bark about a place.
static func _add_circle(
	lines: PackedVector3Array, place: Dictionary, across: float, along: float
) -> void:
	var up: Vector3 = place.direction
	var out: Vector3 = place.out
	var axis: Vector3 = place.axis
	var radius: float = place.radius
	var side: Vector3 = up.cross(out)
	var before: Vector3 = Vector3.INF
	for i: int in _SIDES + 1:
		var turn: float = TAU * i / _SIDES
		# On the bark: what goes across it goes round.
		var angle: float = clampf(across * cos(turn) / maxf(radius, 1e-3), -PI, PI)
		var at: Vector3 = (
			axis
			+ up * (along * sin(turn))
			+ (out * cos(angle) + side * sin(angle)) * (radius * 1.02)
		)
		if before.is_finite():
			lines.append_array([before, at])
		before = at


static func _add_obstacle(
	lines: PackedVector3Array, line: Recipe.Line, place: Dictionary, number: Callable
) -> void:
	var axis: Vector3 = place.direction
	var out: Vector3 = place.out
	var shape: StringName = kind_of(line)
	var middle: Vector3 = (
		place.axis as Vector3 + out * (place.radius as float + number.call("gap") as float)
	)
	if line.values.has("middle"):
		middle = _vector_of(line.values["middle"])
	# As src/growth has them.
	var z: Vector3 = out
	if shape in [&"post", &"ring"]:
		z = axis
	elif shape == &"wire":
		z = axis.cross(out)
	if line.values.has("direction"):
		z = _vector_of(line.values["direction"]).normalized()
	var y: Vector3 = axis - z * axis.dot(z)
	y = z.cross(Vector3.RIGHT if absf(z.x) < 0.9 else Vector3.BACK) if y.length() < 1e-4 else y
	y = y.normalized()
	var x: Vector3 = y.cross(z)
	var half: float = 0.5 * number.call("length")
	var thin: float = 0.5 * number.call("thickness")
	match shape:
		&"post":
			_add_prism(
				lines, middle, z * half, x * number.call("radius"), y * number.call("radius")
			)
		&"wire":
			_add_prism(lines, middle, z * half, x * thin, y * thin)
		&"box":
			_add_box(lines, middle, x * (0.5 * number.call("width")), y * half, z * thin)
		&"sheet":
			_add_box(lines, middle, x * (0.5 * number.call("width")), y * half, Vector3.ZERO)
		&"ring":
			for radius: float in [number.call("radius") - thin, number.call("radius") + thin]:
				_add_ring(lines, middle, x * radius, y * radius)
		_:
			_add_ring(lines, middle, x * 0.1, y * 0.1)


static func _add_ring(
	lines: PackedVector3Array, middle: Vector3, x: Vector3, y: Vector3, sides: int = _SIDES
) -> void:
	for i: int in sides:
		var turn: float = TAU * i / sides
		var next: float = TAU * (i + 1) / sides
		lines.append(middle + x * cos(turn) + y * sin(turn))
		lines.append(middle + x * cos(next) + y * sin(next))


static func _add_prism(
	lines: PackedVector3Array, middle: Vector3, z: Vector3, x: Vector3, y: Vector3
) -> void:
	_add_ring(lines, middle - z, x, y, 16)
	_add_ring(lines, middle + z, x, y, 16)
	for i: int in 4:
		var side: Vector3 = x * cos(TAU * i / 4.0) + y * sin(TAU * i / 4.0)
		lines.append_array([middle - z + side, middle + z + side])


static func _add_box(
	lines: PackedVector3Array, middle: Vector3, x: Vector3, y: Vector3, z: Vector3
) -> void:
	for i: int in 8:
		var signs: Vector3 = Vector3(
			1.0 if i & 1 else -1.0, 1.0 if i & 2 else -1.0, 1.0 if i & 4 else -1.0
		)
		var corner: Vector3 = middle + x * signs.x + y * signs.y + z * signs.z
		var ends: Array[Vector3] = [x, y, z]
		for side: int in 3:
			if not i & (1 << side):
				lines.append_array([corner, corner + 2.0 * ends[side]])


static func _vector_of(words: String) -> Vector3:
	var numbers: PackedFloat64Array = words.split_floats(",")
	return Vector3(numbers[0], numbers[1], numbers[2]) if numbers.size() == 3 else Vector3.ZERO
