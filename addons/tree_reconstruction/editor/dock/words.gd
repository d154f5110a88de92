@tool
extends RefCounted
## What the dock calls options and figures.


## Titles of the options of a reconstruction, in the language of [param of].
static func option_titles(of: Object) -> Dictionary[String, String]:
	return {
		"up": of.tr("Up axis"),
		"scale": of.tr("Metres per unit"),
		"known_height": of.tr("Known height"),
		"known_length": of.tr("Known length"),
		"columns": of.tr("Columns"),
		"classes": of.tr("Classes of points"),
		"remove_extreme_colors": of.tr("Remove white and black"),
		"white_above": of.tr("White above"),
		"black_below": of.tr("Black below"),
		"remove_outliers": of.tr("Remove stray points"),
		"neighbours": of.tr("Neighbours"),
		"outlier_deviations": of.tr("Stray beyond"),
		"remove_fragments": of.tr("Remove fragments"),
		"remove_ground": of.tr("Remove ground and walls"),
		"separate_trees": of.tr("One of several trees"),
		"tree_number": of.tr("Tree number"),
		"tree_position": of.tr("Tree at"),
		"tell_leaves": of.tr("Tell leaves from wood"),
		"skeleton": of.tr("Method"),
		"spanning_tree": of.tr("Spanning tree"),
		"flood": of.tr("Flood"),
		"voxel": of.tr("Voxel size"),
		"radii": of.tr("Thickness by"),
		"complete": of.tr("Look for missing branches"),
		"prune": of.tr("Cut long twigs"),
		"spacing": of.tr("Point spacing"),
		"minimum_branch": of.tr("Shortest branch"),
		"simplify_distance": of.tr("Simplify by"),
		"fit_radii": of.tr("Measure thickness"),
		"seed": of.tr("Seed"),
	}
