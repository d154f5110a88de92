extends "./suite.gd"
## Two engines with one forest: what the host has done to it before a guest comes, and after.

const Game := preload("forest_game.gd")

var _told: Array[Dictionary] = []


# What the guest tells next.
func _answer() -> Dictionary:
	var deadline: int = Time.get_ticks_msec() + 60_000
	while _told.is_empty() and Time.get_ticks_msec() < deadline:
		await tree.process_frame
	return {} if _told.is_empty() else _told.pop_front()


func test_a_guest_has_the_hosts_forest() -> void:
	var path: String = folder.path_join("tree.res")
	check_equal(ResourceSaver.save(grown_tree(3, 60), path), OK, "saving the tree")
	var game: Game = Game.new()
	game.plant(path)
	tree.root.add_child(game)
	game.told.connect(func(what: Dictionary) -> void: _told.append(what))
	var forest: TreeVariantSpawner3D = game.forest
	await forest.finished
	var untouched: String = forest.get_digest()
	forest.remove(0)
	forest.take(4).free()
	var gone: int = forest.spawn_at(Transform3D(Basis(), Vector3(90.0, 1.0, 0.0)))
	forest.spawn_at(Transform3D(Basis(Vector3.UP, 1.0), Vector3(95.0, 2.0, 3.0)))
	forest.remove(gone)
	check(forest.get_digest() != untouched, "Nothing was done.")

	var port: int = game.host()
	check(port > 0, "No port is free.")
	var guest: String = (get_script() as Script).resource_path.get_base_dir()
	var process: int = OS.create_process(
		OS.get_executable_path(),
		[
			"--headless",
			"--path",
			ProjectSettings.globalize_path("res://"),
			"--script",
			guest.path_join("forest_guest.gd"),
			"--",
			str(port),
			path
		]
	)
	check(process > 0, "No second engine has started.")
	check_equal(await _answer(), game.describe(), "the forest of who comes")

	# On all machines in the same order, also while the forest is made again.
	game.rebuild.rpc()
	game.remove.rpc(2)
	game.spawn.rpc(Transform3D(Basis(), Vector3(100.0, 0.0, 0.0)))
	game.remove.rpc(7)
	game.answer.rpc()
	await tree.process_frame
	while forest.is_building():
		await tree.process_frame
	check_equal(await _answer(), game.describe(), "the forest of who stays")
	check_equal(forest.find_trees(Vector3(100.0, 0.0, 0.0), 0.1).size(), 1, "trees that came")

	game.leave.rpc()
	var deadline: int = Time.get_ticks_msec() + 20_000
	while OS.is_process_running(process) and Time.get_ticks_msec() < deadline:
		await tree.process_frame
	if OS.is_process_running(process):
		OS.kill(process)
		check(false, "The guest does not leave.")
	game.multiplayer.multiplayer_peer = null
	game.free()
