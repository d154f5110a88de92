@tool
extends RefCounted
## What the inspector shows of a [TreeVariantSpawner3D], and warns of.

const Region := preload("region.gd")
# Properties that matter to scattered trees alone.
const _OF_SCATTERED: PackedStringArray = [
	"region_size",
	"region",
	"density",
	"minimum_distance",
	"clumping",
	"size_variation",
	"lean",
	"ground_rays",
	"ground_mask",
	"ground_depth",
	"ground_alignment",
	"ground_slope_limit",
	"ground_heights",
]


## Whether the property has a meaning with the others as they are.
static func is_shown(property: String, of: TreeVariantSpawner3D) -> bool:
	var given: bool = of.placement == TreeVariantSpawner3D.Placement.GIVEN
	return not (
		(given and property in _OF_SCATTERED)
		or (not given and property == "transforms")
		or (not of.ground_rays and property in ["ground_mask", "ground_depth"])
		or (not of.region.is_empty() and property == "region_size")
	)


## See [method Node._get_configuration_warnings]; [param budget]: what was said of the triangles.
static func warnings(of: TreeVariantSpawner3D, budget: String) -> PackedStringArray:
	var found: PackedStringArray = []
	if of.get_all_sources().is_empty():
		found.append("Give this node a TreeReconstruction to make a forest of.")
	if not of.region.is_empty() and not Region.is_region(of.get_node_or_null(of.region)):
		found.append("The region is neither a Path3D with a curve nor a MeshInstance3D.")
	if of.is_inside_tree() and not of.global_basis.get_scale().is_equal_approx(Vector3.ONE):
		found.append("This node is scaled: its levels of detail change too early or too late.")
	if not budget.is_empty():
		found.append(budget)
	return found
