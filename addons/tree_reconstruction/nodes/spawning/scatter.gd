@tool
extends RefCounted
## Where the trees of a forest stand: at random places that keep their distance. The same settings
## and seed give the same places, whatever the machine.

const Ground := preload("ground.gd")
# Places that are tried for each tree that is wanted.
const _TRIES: int = 10
const _TRIES_BETWEEN_LOOKS: int = 64
const _MOST_TREES: int = 1_000_000
# How wide glades and thickets are, over the distance that trees keep, and in metres at least.
const _CLUMP: float = 6.0
const _LEAST_CLUMP: float = 12.0

var number: int = 1
## Trees per 100 square metres.
var density: float = 1.0
var distance: float = 3.0
var clumping: float = 0.0
## Around the origin, where there is no [member outline] and no [member corners].
var size: Vector2 = Vector2(40.0, 40.0)
## A polygon, seen from above, and the height that it lies at.
var outline: PackedVector2Array = []
var height: float = 0.0
## Three for each triangle of the ground.
var corners: PackedVector3Array = []
## The steepest ground that bears a tree, in radians.
var steepest: float = PI
var lowest: float = -INF
var highest: float = INF

## Set to end early.
var stale: bool = false

## The places, and the ground's normals there.
var places: PackedVector3Array = []
var normals: PackedVector3Array = []

var _taken: Dictionary[int, PackedVector2Array] = {}
var _random: RandomNumberGenerator
var _ground: Ground
var _rect: Rect2
var _wanted: int = 0
var _tries: int = 0


## Finds the places, on any thread, until [param deadline] (see [method Time.get_ticks_usec]);
## [code]true[/code] when all are found. Call it again to go on.
func run(deadline: int) -> bool:
	if _random == null:
		_begin()
	while _tries > 0 and places.size() < _wanted and not stale:
		_try()
		_tries -= 1
		if _tries % _TRIES_BETWEEN_LOOKS == 0 and Time.get_ticks_usec() >= deadline:
			return false
	return true


func _begin() -> void:
	_random = RandomNumberGenerator.new()
	_random.seed = number
	_rect = Rect2(-0.5 * size, size)
	var area: float = _rect.get_area()
	if not corners.is_empty():
		_ground = Ground.new(corners)
		_rect = _ground.rect
		area = _ground.area
	elif not outline.is_empty():
		_rect = Rect2(outline[0], Vector2.ZERO)
		area = 0.0
		for i: int in outline.size():
			_rect = _rect.expand(outline[i])
			area += 0.5 * outline[i].cross(outline[(i + 1) % outline.size()])
		area = absf(area)
	if area <= 0.0 or density <= 0.0:
		return
	_wanted = mini(ceili(area * density / 100.0), _MOST_TREES)
	# More tries where much of the rectangle is outside.
	_tries = int(_TRIES * _wanted * minf(_rect.get_area() / area, _TRIES))


func _try() -> void:
	var at: Vector2 = _rect.position + _rect.size * Vector2(_random.randf(), _random.randf())
	var luck: float = _random.randf()
	if not outline.is_empty() and not Geometry2D.is_point_in_polygon(at, outline):
		return
	if luck >= _chance(at) or not is_free(at):
		return
	var found: PackedVector3Array = [Vector3(at.x, height, at.y), Vector3.UP]
	if _ground != null:
		found = _ground.find(at)
		if found.is_empty() or not fits(found[0], found[1]):
			return
	take(at)
	places.append(found[0])
	normals.append(found[1])


## Whether a tree may stand on such ground.
func fits(place: Vector3, normal: Vector3) -> bool:
	return normal.angle_to(Vector3.UP) <= steepest and place.y >= lowest and place.y <= highest


## Whether nothing is nearer than the distance.
func is_free(at: Vector2) -> bool:
	if distance <= 0.0:
		return true
	var cell: Vector2i = Vector2i((at / distance).floor())
	for y: int in range(cell.y - 1, cell.y + 2):
		for x: int in range(cell.x - 1, cell.x + 2):
			var key: int = (x << 32) ^ (y & 0xffffffff)
			if _taken.has(key):
				for other: Vector2 in _taken[key]:
					if other.distance_squared_to(at) < distance * distance:
						return false
	return true


## Keeps others away from there.
func take(at: Vector2) -> void:
	if distance <= 0.0:
		return
	var cell: Vector2i = Vector2i((at / distance).floor())
	var key: int = (cell.x << 32) ^ (cell.y & 0xffffffff)
	if not _taken.has(key):
		_taken[key] = PackedVector2Array()
	_taken[key].append(at)


# Glades and thickets: smooth noise between 0 and 1, of two sizes.
func _chance(at: Vector2) -> float:
	if clumping <= 0.0:
		return 1.0
	var wide: Vector2 = at / maxf(_CLUMP * distance, _LEAST_CLUMP)
	var noise: float = 0.7 * _noise(wide, 0) + 0.3 * _noise(2.7 * wide, 1)
	return lerpf(1.0, smoothstep(0.35, 0.6, noise), clumping)


func _noise(at: Vector2, layer: int) -> float:
	var cell: Vector2i = Vector2i(at.floor())
	var part: Vector2 = at - at.floor()
	part = part * part * (Vector2(3.0, 3.0) - 2.0 * part)
	return lerpf(
		lerpf(_value(cell.x, cell.y, layer), _value(cell.x + 1, cell.y, layer), part.x),
		lerpf(_value(cell.x, cell.y + 1, layer), _value(cell.x + 1, cell.y + 1, layer), part.x),
		part.y
	)


func _value(x: int, y: int, layer: int) -> float:
	return share(mix(mix(mix(number, layer + 101), x), y))


## A well-mixed number of another and a key (SplitMix64).
static func mix(of: int, key: int) -> int:
	var z: int = of + (key + 1) * -0x61c8864680b583eb
	z = (z ^ ((z >> 30) & 0x3ffffffff)) * -0x40a7b892e31b1a47
	z = (z ^ ((z >> 27) & 0x1fffffffff)) * -0x6b2fb644ecceee15
	return z ^ ((z >> 31) & 0x1ffffffff)


## The share of 1 that such a number stands for.
static func share(of: int) -> float:
	return ((of >> 11) & 0x1fffffffffffff) * (1.0 / 9007199254740992.0)
