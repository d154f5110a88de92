extends "./suite.gd"
## The label of the node under the mouse, beside what a tool says there.

const Overlay := preload("res://addons/tree_reconstruction/editor/viewport/overlay.gd")

const _ROOM: Vector2 = Vector2(800, 460)
const _TOP: float = 50.0


func test_a_label_never_covers_a_tools_sentence() -> void:
	var random: RandomNumberGenerator = RandomNumberGenerator.new()
	random.seed = 5
	var moved: int = 0
	for i: int in 5000:
		var at: Vector2 = Vector2(random.randf(), random.randf()) * _ROOM
		var off: float = random.randf_range(9.0, 50.0)
		var size: Vector2 = Vector2(random.randf_range(80.0, 420.0), 26.0)
		var taken: Rect2 = Rect2(0.0, 0.0, random.randf_range(80.0, 420.0), 50.0)
		taken.position = (at + Vector2(18, 24)).min(_ROOM - taken.size)
		var alone: Rect2 = Overlay.place_label(at, off, size, _ROOM, _TOP, Rect2())
		var box: Rect2 = Overlay.place_label(at, off, size, _ROOM, _TOP, taken)
		moved += int(alone != box)
		check(not box.intersects(taken), "%s is covered by %s." % [taken, box])
		check(box.position.y >= _TOP, "%s lies under the buttons." % box)
		check(box.position.x > 0.0 and box.end.x < _ROOM.x, "%s goes out at a side." % box)
		if not alone.intersects(taken):
			check_equal(box, alone, "the place of a label that covers nothing")
	check(moved > 100, "Only %d labels had to give way." % moved)
