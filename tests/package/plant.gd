extends SceneTree
## In an empty project with the addon: grows a tree, shows it, varies it, bakes it.


func _initialize() -> void:
	var system: LSystem = LSystem.new()
	system.grammar = LSystem.get_preset("birch")
	var tree: TreeReconstruction = system.grow(4)
	var shown: TreeInstance3D = TreeInstance3D.new()
	root.add_child(shown)
	shown.reconstruction = tree
	await shown.rebuilt
	var other: TreeReconstruction = tree.make_variant(1, 0.5)
	var scene: PackedScene = TreeBaker.new().bake(other)
	var saved: Error = ResourceSaver.save(scene, "res://baked.scn")
	if shown.get_triangle_count() > 0 and saved == OK:
		print("planted")
	quit()
