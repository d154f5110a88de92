extends SceneTree
## In the editor's engine: reconstructs the scan that the command line names into res://tree.res.

const Digest: GDScript = preload("res://digest.gd")


func _initialize() -> void:
	_run.call_deferred()


func _run() -> void:
	var maker: TreeReconstructor = TreeReconstructor.new()
	var made: TreeReconstruction = maker.reconstruct_file(
		OS.get_cmdline_user_args()[0], {"leaves": "oak"}
	)
	if made == null:
		printerr(maker.get_error_message())
		quit(1)
		return
	# The bark that grew is part of what the game makes of the tree.
	made = maker.grow_bark(made, "edges longest=0.08\nburl along=1.2 radius=0.3 growth=0.8")
	if made == null:
		printerr(maker.get_error_message())
		quit(1)
		return
	ResourceSaver.save(made, "res://tree.res", ResourceSaver.FLAG_COMPRESS)
	print("digest ", Digest.of(made))
	var forest: TreeVariantSpawner3D = Digest.make_forest(made)
	root.add_child(forest)
	await forest.finished
	print("forest ", forest.get_tree_count(), " ", Digest.of_forest(forest))
	# Not while it says that it has finished.
	await process_frame
	forest.free()
	quit()
