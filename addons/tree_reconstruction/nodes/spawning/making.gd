@tool
extends RefCounted
## Makes trees of their own of those of a [TreeVariantSpawner3D].


## See [method TreeVariantSpawner3D.get_variant].
static func make_variant(
	of: TreeVariantSpawner3D, index: int, number: int, age: float
) -> TreeReconstruction:
	var from: Array[TreeReconstruction] = of.get_all_sources()
	if from.is_empty() or index < 0 or index >= of.variants:
		push_error("The forest has no individual %d." % index)
		return null
	return from[index % from.size()].make_variant(number, of.amount, age)


## The node that stands for the tree [param id].
static func make_instance(of: TreeVariantSpawner3D, id: int) -> TreeInstance3D:
	var made: TreeInstance3D = TreeInstance3D.new()
	made.reconstruction = of.get_variant(of.get_tree_variant(id))
	made.bark_material = of.bark_material
	made.leaf_material = of.leaf_material
	made.leaves = of.leaves
	made.transform = of.get_tree_transform(id)
	return made
