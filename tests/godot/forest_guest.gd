extends SceneTree
## The guest of test_forest_network.gd: joins the game at a port, with the tree of a file. It leaves
## when it is told to, when the host goes, or after two minutes.

const Game := preload("forest_game.gd")


func _initialize() -> void:
	_run.call_deferred()


func _run() -> void:
	var arguments: PackedStringArray = OS.get_cmdline_user_args()
	var game: Game = Game.new()
	game.plant(arguments[1])
	root.add_child(game)
	game.multiplayer.server_disconnected.connect(quit)
	game.multiplayer.connection_failed.connect(quit.bind(1))
	if game.join(int(arguments[0])) != OK:
		quit(1)
	await create_timer(120.0).timeout
	quit(1)
