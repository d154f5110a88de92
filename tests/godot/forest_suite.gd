extends "./suite.gd"
## What suites of forests extend: a small forest in a world of its own.

var _world: Node3D


func _forest() -> TreeVariantSpawner3D:
	var made: TreeVariantSpawner3D = TreeVariantSpawner3D.new()
	made.source = grown_tree(3, 60)
	made.variants = 3
	made.levels = 2
	made.region_size = Vector2(60.0, 40.0)
	made.density = 1.0
	return made


func _plant(forest: TreeVariantSpawner3D) -> void:
	if _world == null:
		_world = Node3D.new()
		tree.root.add_child(_world)
	_world.add_child(forest)
	await _grown(forest)


func _grown(forest: TreeVariantSpawner3D) -> void:
	var deadline: int = Time.get_ticks_msec() + 20_000
	# One frame for what was changed to be heard.
	await tree.process_frame
	while forest.is_building() and Time.get_ticks_msec() < deadline:
		await tree.process_frame
	check(not forest.is_building(), "The forest never ends.")


func _clear() -> void:
	if _world != null:
		_world.free()
		_world = null


func _parts(forest: TreeVariantSpawner3D) -> Array[MultiMeshInstance3D]:
	var parts: Array[MultiMeshInstance3D] = []
	for child: Node in forest.get_children(true):
		var part: MultiMeshInstance3D = child as MultiMeshInstance3D
		if part != null and part.visible and not part.is_queued_for_deletion():
			parts.append(part)
	return parts
