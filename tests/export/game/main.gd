extends Node3D
## A game with a tree: prints what it makes of it, for tests/export to compare with the editor, and,
## with --picture FILE, how the wind moves it, and saves what it shows.

const Digest: GDScript = preload("res://digest.gd")


func _ready() -> void:
	var tree: TreeInstance3D = $Tree
	await tree.rebuilt
	print("digest ", Digest.of(tree.reconstruction))
	var forest: TreeVariantSpawner3D = Digest.make_forest(tree.reconstruction)
	add_child(forest)
	await forest.finished
	print("forest ", forest.get_tree_count(), " ", Digest.of_forest(forest))
	print("source ", tree.reconstruction.provenance.get("source"))
	print(
		"grown ", tree.reconstruction.has_grown_bark() and not tree.reconstruction.is_bark_stale()
	)
	var bare: TreeReconstruction = tree.reconstruction.duplicate()
	bare.grown_bark = []
	var lighter: int = tree.reconstruction.build_levels([1])[0].triangles
	print("grown at level 1 ", lighter != int(bare.build_levels([1])[0].triangles))
	print("triangles ", tree.get_triangle_count())
	print("editor ", ClassDB.class_exists(&"TreeReconstructor"))
	var arguments: PackedStringArray = OS.get_cmdline_user_args()
	if arguments.size() == 2 and arguments[0] == "--picture":
		# Not while it says that it has finished.
		await get_tree().process_frame
		forest.free()
		(await _watch_the_wind()).save_png(arguments[1])
	get_tree().quit()


# This project says that there is no wind, and of the wind's other shader globals nothing: a shader
# that misses one is an error, and its tree white.
func _watch_the_wind() -> Image:
	var calm: Image = await _picture()
	print("moved without a TreeWind ", _difference(calm, await _picture()))
	var wind: TreeWind = TreeWind.new()
	wind.strength = 1.0
	add_child(wind)
	var bent: Image = await _picture()
	print("bent ", _difference(calm, bent))
	print("moved ", _difference(bent, await _picture()))
	wind.speed = 0.0
	var held: Image = await _picture()
	print("moved in a wind that stands ", _difference(held, await _picture()))
	wind.free()
	print("moved afterwards ", _difference(calm, await _picture()))
	return held


# What is shown half a second later.
func _picture() -> Image:
	await get_tree().create_timer(0.5).timeout
	await RenderingServer.frame_post_draw
	return get_viewport().get_texture().get_image()


# How many pixels of two pictures differ.
func _difference(one: Image, other: Image) -> int:
	var a: PackedByteArray = one.get_data()
	var b: PackedByteArray = other.get_data()
	var each: int = a.size() / (one.get_width() * one.get_height())
	var different: int = 0
	for at: int in range(0, a.size(), each):
		if a.slice(at, at + each) != b.slice(at, at + each):
			different += 1
	return different
