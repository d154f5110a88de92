extends RefCounted
## One number for all that a game makes of a tree: bark and leaves of each level, edits, grafts, and
## what grammars grow.


## All that a forest is: where its trees stand, and the meshes of its individuals.
static func of_forest(forest: TreeVariantSpawner3D) -> String:
	var all: HashingContext = HashingContext.new()
	all.start(HashingContext.HASH_SHA256)
	all.update(forest.get_digest().to_ascii_buffer())
	for index: int in forest.variants:
		var tree: TreeReconstruction = forest.get_variant(index)
		for lod: int in forest.levels:
			all.update(var_to_bytes(tree.build_mesh_arrays(lod)))
			all.update(var_to_bytes(tree.build_joined_leaf_arrays(lod)))
	return all.finish().hex_encode()


## The forest of the game.
static func make_forest(tree: TreeReconstruction) -> TreeVariantSpawner3D:
	var forest: TreeVariantSpawner3D = TreeVariantSpawner3D.new()
	forest.source = tree
	forest.variants = 3
	forest.levels = 3
	forest.seed = 12
	forest.region_size = Vector2(60.0, 60.0)
	forest.clumping = 0.5
	return forest


static func of(tree: TreeReconstruction) -> String:
	var all: HashingContext = HashingContext.new()
	all.start(HashingContext.HASH_SHA256)
	for lod: int in 4:
		all.update(var_to_bytes(tree.build_mesh_arrays(lod)))
		all.update(tree.build_leaf_buffer(lod).to_byte_array())
	var other: TreeReconstruction = tree.duplicate() as TreeReconstruction
	other.edit("prune factor=1.5")
	other.graft(other.get_leaves()[0], {"twig": "oak", "seed": 7})
	all.update(var_to_bytes(other.build_mesh_arrays(0)))
	var system: LSystem = LSystem.new()
	system.grammar = LSystem.get_preset("birch")
	all.update(var_to_bytes(system.grow(4).build_mesh_arrays(0)))
	return all.finish().hex_encode()
