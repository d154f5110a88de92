extends RefCounted
## One number for all that a game makes of a tree: bark and leaves of each level, edits, grafts, and
## what grammars grow.


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
