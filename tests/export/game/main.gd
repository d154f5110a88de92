extends Node3D
## A game with a tree: prints what it makes of it, for tests/export to compare with the editor, and,
## with --picture FILE, saves what it shows.

const Digest: GDScript = preload("res://digest.gd")


func _ready() -> void:
	var tree: TreeInstance3D = $Tree
	await tree.rebuilt
	print("digest ", Digest.of(tree.reconstruction))
	var forest: TreeVariantSpawner3D = Digest.make_forest(tree.reconstruction)
	add_child(forest)
	await forest.finished
	print("forest ", forest.get_tree_count(), " ", Digest.of_forest(forest))
	print("triangles ", tree.get_triangle_count())
	print("editor ", ClassDB.class_exists(&"TreeReconstructor"))
	var arguments: PackedStringArray = OS.get_cmdline_user_args()
	if arguments.size() == 2 and arguments[0] == "--picture":
		for i: int in 3:
			await get_tree().process_frame
		get_viewport().get_texture().get_image().save_png(arguments[1])
	get_tree().quit()
