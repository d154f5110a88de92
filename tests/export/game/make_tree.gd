extends SceneTree
## In the editor's engine: reconstructs the scan that the command line names into res://tree.res.

const Digest: GDScript = preload("res://digest.gd")


func _initialize() -> void:
	var maker: TreeReconstructor = TreeReconstructor.new()
	var made: TreeReconstruction = maker.reconstruct_file(OS.get_cmdline_user_args()[0], {})
	if made == null:
		printerr(maker.get_error_message())
		quit(1)
		return
	ResourceSaver.save(made, "res://tree.res", ResourceSaver.FLAG_COMPRESS)
	print("digest ", Digest.of(made))
	quit()
