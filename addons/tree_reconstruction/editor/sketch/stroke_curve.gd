@tool
extends RefCounted
## A few Bézier handles of a stroke: cubic curves fitted to its points by least squares (Schneider,
## "An Algorithm for Automatically Fitting Digitized Curves", Graphics Gems, 1990).
##
## Where a handle moves, the points go by as much as the curve does beside them, so that what was
## drawn finely stays.

# A stroke that one curve misses by more, in pixels of the canvas, gets two.
const _TOLERANCE: float = 8.0
# How often the points' places along the curve are improved.
const _ROUNDS: int = 6
# Ends that are nearer to each other than this share of the length make a closed stroke.
const _CLOSED: float = 0.08

## Four handles for each curve; the last of one is the first of the next.
var handles: PackedVector2Array = []
## Whether the stroke ends where it begins: then the last handle is the first one.
var closed: bool = false

var _points: PackedVector2Array
# Of each point: in which curve it lies, and where along it, as 0.25 or 1.25.
var _places: PackedFloat64Array = []
var _first: PackedVector2Array


## Fits one or two curves to [param points] (pixels, two at least): 4, 6 or 7 handles.
func _init(points: PackedVector2Array) -> void:
	_points = points
	var length: float = length_of(points)
	closed = points.size() > 8 and points[0].distance_to(points[-1]) < _CLOSED * length
	var forward: Vector2 = _tangent(points, 0, 1)
	var back: Vector2 = _tangent(points, points.size() - 1, -1)
	if closed:
		# They go through the seam as one.
		forward = (forward - back).normalized()
		back = -forward
	var whole: Fit = Fit.new(points, forward, back)
	if points.size() < 8 or (not closed and whole.error <= _TOLERANCE):
		_take(whole)
	else:
		var at: int = _half(points, length) if closed else whole.worst
		at = clampi(at, 3, points.size() - 4)
		var through: Vector2 = (points[at - 2] - points[at + 2]).normalized()
		if through == Vector2.ZERO:
			through = -forward.orthogonal()
		_take(Fit.new(points.slice(0, at + 1), forward, through))
		_take(Fit.new(points.slice(at), -through, back))
	if closed:
		handles[-1] = handles[0]
	_first = handles.duplicate()


## How many handles there are to be seen: those of a closed stroke meet in one.
func get_count() -> int:
	return handles.size() - (1 if closed else 0)


## Whether the curve goes through the handle.
func is_knot(index: int) -> bool:
	return index % 3 == 0


## The knot that a handle is bound to.
func get_knot_of(index: int) -> int:
	return index - 1 if index % 3 == 1 else index + (1 if index % 3 == 2 else 0)


## Moves a handle. The curve stays smooth: a knot takes its neighbours along, and of two handles at
## a knot one turns with the other.
func move(index: int, to: Vector2) -> void:
	var by: Vector2 = to - handles[index]
	if is_knot(index):
		for each: int in [index - 1, index, index + 1]:
			_shift(each, by)
	else:
		handles[index] = to
		var knot: int = get_knot_of(index)
		var other: int = _wrapped(2 * knot - index)
		if other >= 0:
			var arm: float = handles[other].distance_to(handles[knot])
			handles[other] = handles[knot] + (handles[knot] - to).normalized() * arm
	if closed:
		handles[-1] = handles[0]


## The stroke's points as the handles are now.
func get_points() -> PackedVector2Array:
	var moved: PackedVector2Array = _points.duplicate()
	for i: int in moved.size():
		moved[i] += _at(handles, _places[i]) - _at(_first, _places[i])
	return moved


## The length of a line through points.
static func length_of(points: PackedVector2Array) -> float:
	var length: float = 0.0
	for i: int in range(1, points.size()):
		length += points[i].distance_to(points[i - 1])
	return length


func _shift(index: int, by: Vector2) -> void:
	var at: int = _wrapped(index)
	if at >= 0:
		handles[at] += by


# The place of a handle, around the seam of a closed stroke; -1 where there is none.
func _wrapped(index: int) -> int:
	var last: int = handles.size() - 1
	if not closed:
		return index if index >= 0 and index <= last else -1
	return posmod(index, last)


func _take(fit: Fit) -> void:
	var curve: int = handles.size() / 3
	if handles.is_empty():
		handles.append(fit.curve[0])
	else:
		# The joint belongs to both.
		_places.resize(_places.size() - 1)
	handles.append_array(fit.curve.slice(1))
	for place: float in fit.places:
		_places.append(curve + place)


static func _half(points: PackedVector2Array, length: float) -> int:
	var gone: float = 0.0
	for i: int in range(1, points.size()):
		gone += points[i].distance_to(points[i - 1])
		if gone >= 0.5 * length:
			return i
	return points.size() / 2


# The direction into which a stroke goes from one of its ends, seen over some points.
static func _tangent(points: PackedVector2Array, at: int, step: int) -> Vector2:
	var reach: int = mini(4, points.size() - 1)
	for i: int in range(reach, points.size()):
		var way: Vector2 = points[at + step * i] - points[at]
		if way.length_squared() > 1e-6:
			return way.normalized()
	return Vector2.UP


static func _at(curves: PackedVector2Array, place: float) -> Vector2:
	var curve: int = mini(int(place), curves.size() / 3 - 1)
	var k: int = 3 * curve
	return curves[k].bezier_interpolate(
		curves[k + 1], curves[k + 2], curves[k + 3], clampf(place - curve, 0.0, 1.0)
	)


## One cubic curve through the first and the last of some points.
class Fit:
	extends RefCounted

	## Its four handles.
	var curve: PackedVector2Array
	## Of each point: where along the curve it lies, 0 to 1.
	var places: PackedFloat64Array = []
	## The largest distance between a point and its place, in pixels, and the point that has it.
	var error: float = 0.0
	var worst: int = 0

	func _init(points: PackedVector2Array, forward: Vector2, back: Vector2) -> void:
		_place_by_length(points)
		for round: int in _ROUNDS:
			_solve(points, forward, back)
			_improve(points)
		_solve(points, forward, back)
		for i: int in points.size():
			var away: float = points[i].distance_to(_value(places[i]))
			if away > error:
				error = away
				worst = i

	func _place_by_length(points: PackedVector2Array) -> void:
		var gone: float = 0.0
		places.append(0.0)
		for i: int in range(1, points.size()):
			gone += points[i].distance_to(points[i - 1])
			places.append(gone)
		for i: int in places.size():
			places[i] /= maxf(gone, 1e-9)

	# The lengths of both arms, which least squares give (the 2 x 2 system of section "Fitting the
	# curve").
	func _solve(points: PackedVector2Array, forward: Vector2, back: Vector2) -> void:
		var first: Vector2 = points[0]
		var last: Vector2 = points[-1]
		var c: Array[float] = [0.0, 0.0, 0.0]
		var x: Array[float] = [0.0, 0.0]
		for i: int in points.size():
			var u: float = places[i]
			var v: float = 1.0 - u
			var a: Vector2 = forward * (3.0 * u * v * v)
			var b: Vector2 = back * (3.0 * u * u * v)
			var ends: Vector2 = first * (v * v * (v + 3.0 * u)) + last * (u * u * (u + 3.0 * v))
			var rest: Vector2 = points[i] - ends
			c[0] += a.dot(a)
			c[1] += a.dot(b)
			c[2] += b.dot(b)
			x[0] += a.dot(rest)
			x[1] += b.dot(rest)
		var chord: float = first.distance_to(last)
		var determinant: float = c[0] * c[2] - c[1] * c[1]
		var arms: Vector2 = Vector2.ONE * (chord / 3.0)
		if absf(determinant) > 1e-9:
			var solved: Vector2 = Vector2(
				(x[0] * c[2] - x[1] * c[1]) / determinant, (c[0] * x[1] - c[1] * x[0]) / determinant
			)
			# Otherwise the arms of Wu and Barsky's heuristic stay.
			if solved.x > 1e-3 * chord and solved.y > 1e-3 * chord:
				arms = solved
		curve = [first, first + forward * arms.x, last + back * arms.y, last]

	# A step of Newton and Raphson for each place.
	func _improve(points: PackedVector2Array) -> void:
		for i: int in range(1, points.size() - 1):
			var u: float = places[i]
			var away: Vector2 = _value(u) - points[i]
			var slope: Vector2 = curve[0].bezier_derivative(curve[1], curve[2], curve[3], u)
			var bend: Vector2 = (
				6.0 * (1.0 - u) * (curve[2] - 2.0 * curve[1] + curve[0])
				+ 6.0 * u * (curve[3] - 2.0 * curve[2] + curve[1])
			)
			var below: float = slope.dot(slope) + away.dot(bend)
			if absf(below) > 1e-9:
				u -= away.dot(slope) / below
			# They stay in their order.
			places[i] = clampf(u, places[i - 1], 1.0)

	func _value(u: float) -> Vector2:
		return curve[0].bezier_interpolate(curve[1], curve[2], curve[3], u)
