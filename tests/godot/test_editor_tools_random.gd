extends "./tools_suite.gd"
## The viewport's tools in the hands of chance.


# Whatever hands do: nothing breaks, and undo leads back to the same bytes.
func test_random_hands_can_be_undone() -> void:
	var most: int = 0
	for random_seed: int in range(1, 9):
		var random: RandomNumberGenerator = RandomNumberGenerator.new()
		random.seed = random_seed
		_begin(grown_tree(random_seed, 400), &"slice")
		_session.tool.get(&"values")[&"shape"] = random_seed % 3
		for i: int in 70:
			await _act_at_random(random)
		_session.choose(&"")
		await _frame()
		check(not _session.is_dragging(), "A drag goes on.")
		var after: Dictionary = _made.skeleton
		var steps: int = 0
		while _undo.undo():
			steps += 1
		check_equal(_made.skeleton, _before, "the tree after undoing %d steps" % steps)
		check_equal(_made.edit_log, "", "the log after undoing all")
		# What was undone on the way is not done again.
		for i: int in steps:
			_undo.redo()
		check_equal(_made.skeleton, after, "the tree after redoing them")
		most = maxi(most, steps)
		_end()
	check(most > 8, "At most %d steps were done." % most)


func _act_at_random(random: RandomNumberGenerator) -> void:
	var ids: PackedInt32Array = _made.get_node_ids()
	var at: Vector2 = _at(ids[random.randi() % ids.size()])
	var to: Vector2 = at + Vector2(random.randfn(), random.randfn()) * 80.0
	match random.randi() % 10:
		0, 1:
			var names: Array = _session.tools.keys()
			_session.choose(names[random.randi() % names.size()])
		2:
			_hover(at)
			_wheel(at, MOUSE_BUTTON_WHEEL_UP, random.randi() % 2 == 0)
		3:
			_key(
				[KEY_ENTER, KEY_ESCAPE, KEY_BACKSPACE, KEY_X, KEY_N, KEY_BRACKETLEFT][
					random.randi() % 6
				]
			)
		4, 5:
			_hover(at)
			_click(at)
		6, 7:
			_button(at, true)
			_hover(at.lerp(to, 0.5), true, random.randi() % 3 == 0)
			if random.randi() % 2 == 0:
				await _frame()
			_hover(to, true)
			match random.randi() % 8:
				0:
					_key(KEY_ESCAPE)
				1:
					_session.choose(&"prune")
				2:
					_undo.undo()
				3:
					_hover(to)
			_button(to, false)
		8:
			_undo.undo()
		9:
			_session.select(ids.slice(random.randi() % ids.size()).slice(0, random.randi() % 6))
	if random.randi() % 3 > 0:
		await _frame()
