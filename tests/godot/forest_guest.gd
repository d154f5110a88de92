extends SceneTree
## The guest of test_forest_network.gd: joins the game at a port, with the tree of a file. It leaves
## when it is told to, when the host goes, or after two minutes.

const Game := preload("forest_game.gd")
const MOST_MSEC: int = 120_000


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


# Nothing waits here: what waited would be left behind at the end.
func _process(_delta: float) -> bool:
	if Time.get_ticks_msec() > MOST_MSEC:
		quit(1)
	return false
