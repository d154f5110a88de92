extends Node
## A game with a forest on several machines, as docs/variants.md has it: one is the host, and who
## joins gets the state of its forest. test_forest_network.gd runs one as the host, and
## forest_guest.gd another one in an engine of its own.

## Emitted at the host when a guest has told what its forest is.
signal told(what: Dictionary)

var forest: TreeVariantSpawner3D


## Makes the forest of both, of the tree in a file.
func plant(path: String) -> void:
	name = "Game"
	forest = TreeVariantSpawner3D.new()
	forest.name = "Forest"
	forest.source = load(path) as TreeReconstruction
	forest.variants = 2
	forest.levels = 1
	forest.region_size = Vector2(60.0, 40.0)
	forest.density = 1.0
	add_child(forest)


## Opens the game to others; returns the port, or -1.
func host() -> int:
	var peer: ENetMultiplayerPeer = ENetMultiplayerPeer.new()
	for port: int in range(24_600 + OS.get_process_id() % 1000, 26_000, 7):
		if peer.create_server(port, 1) == OK:
			multiplayer.multiplayer_peer = peer
			multiplayer.peer_connected.connect(_on_peer_connected)
			return port
	return -1


func join(port: int) -> Error:
	var peer: ENetMultiplayerPeer = ENetMultiplayerPeer.new()
	var error: Error = peer.create_client("127.0.0.1", port)
	multiplayer.multiplayer_peer = peer
	return error


## All that tells one forest from another.
func describe() -> Dictionary:
	var trees: Dictionary[int, Vector3] = {}
	for id: int in forest.find_trees(Vector3.ZERO, 1e5):
		trees[id] = forest.get_tree_transform(id).origin
	return {"digest": forest.get_digest(), "trees": trees}


@rpc("authority", "call_remote", "reliable")
func take_state(state: Dictionary) -> void:
	forest.set_state(state)
	answer()


@rpc("authority", "call_local", "reliable")
func remove(id: int) -> void:
	forest.remove(id)


@rpc("authority", "call_local", "reliable")
func spawn(frame: Transform3D) -> void:
	forest.spawn_at(frame)


@rpc("authority", "call_local", "reliable")
func rebuild() -> void:
	forest.rebuild()


## Has the guest tell what its forest is, once it stands.
@rpc("authority", "call_remote", "reliable")
func answer() -> void:
	await get_tree().process_frame
	while forest.is_building():
		await get_tree().process_frame
	tell.rpc_id(1, describe())


@rpc("any_peer", "call_remote", "reliable")
func tell(what: Dictionary) -> void:
	told.emit(what)


@rpc("authority", "call_remote", "reliable")
func leave() -> void:
	get_tree().quit()


func _on_peer_connected(peer: int) -> void:
	take_state.rpc_id(peer, forest.get_state())
