extends "./suite.gd"
## The handles by which strokes of a sketch are bent.

const StrokeCurve := preload("res://addons/tree_reconstruction/editor/sketch/stroke_curve.gd")
const TestSketch := preload("./test_sketch.gd")


func test_handles_fit_strokes() -> void:
	var random: RandomNumberGenerator = RandomNumberGenerator.new()
	random.seed = 4
	for trial: int in 200:
		var ends: PackedVector2Array = []
		for i: int in 4:
			ends.append(Vector2(random.randf_range(0, 1000), random.randf_range(0, 1000)))
		var points: PackedVector2Array = []
		for i: int in random.randi_range(2, 80):
			points.append(ends[0].bezier_interpolate(ends[1], ends[2], ends[3], i / 80.0))
		var curve: StrokeCurve = StrokeCurve.new(points)
		check(curve.get_count() in [4, 6, 7], "It has %d handles." % curve.get_count())
		check_equal(curve.get_points(), points, "points that nobody moved")
		for handle: Vector2 in curve.handles:
			check(handle.is_finite(), "A handle lies at %s." % handle)
		curve.move(0, curve.handles[0] + Vector2(50.0, -20.0))
		check(
			curve.get_points()[0].distance_to(points[0] + Vector2(50.0, -20.0)) < 0.01,
			"The end does not go along."
		)
	var closed: StrokeCurve = StrokeCurve.new(TestSketch.small_sketch().strokes[0]["points"])
	check(closed.closed, "An outline isn't closed.")
	check_equal(closed.get_count(), 6, "handles of an outline")
	closed.move(0, closed.handles[0] + Vector2(0.0, -40.0))
	var moved: PackedVector2Array = closed.get_points()
	check(moved[0].distance_to(moved[-1]) < 40.0, "The outline opens.")
	for same: Array in [[Vector2.ONE, Vector2.ONE], [Vector2.ONE, Vector2.ONE, Vector2.ZERO]]:
		for handle: Vector2 in StrokeCurve.new(PackedVector2Array(same)).handles:
			check(handle.is_finite(), "A handle lies at %s." % handle)


func test_the_curve_that_was_drawn_is_found() -> void:
	var random: RandomNumberGenerator = RandomNumberGenerator.new()
	random.seed = 9
	for trial: int in 200:
		var from: Vector2 = Vector2(random.randf_range(0, 300), random.randf_range(0, 1000))
		var to: Vector2 = Vector2(random.randf_range(600, 1000), random.randf_range(0, 1000))
		var aside: Vector2 = (to - from).orthogonal() * random.randf_range(-0.2, 0.2)
		var arms: PackedVector2Array = [from.lerp(to, 0.3) + aside, from.lerp(to, 0.7) + aside]
		var points: PackedVector2Array = []
		for i: int in 81:
			points.append(from.bezier_interpolate(arms[0], arms[1], to, i / 80.0))
		var curve: StrokeCurve = StrokeCurve.new(points)
		check_equal(curve.get_count(), 4, "handles")
		for i: int in 2:
			var away: float = curve.handles[i + 1].distance_to(arms[i])
			check(away < 0.1 * from.distance_to(to), "A handle is %.1f px off." % away)
