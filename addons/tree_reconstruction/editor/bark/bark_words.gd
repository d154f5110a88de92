@tool
extends RefCounted
## What is shown of the features of bark, and in which words.

const BarkFeatures := preload("bark_features.gd")
const Recipe := preload("../dock/growth_recipe.gd")
const SceneObstacles := preload("scene_obstacles.gd")

# The parameters that have a field, in this order, by the kind of feature.
const _SHOWN: Dictionary[StringName, Array] = {
	&"burl": ["along", "around", "radius", "growth", "from", "grain"],
	&"ridge": ["along", "around", "radius", "growth", "from", "grain", "length"],
	&"hollow": ["along", "around", "width", "height", "depth", "from", "until", "growth"],
	&"post": ["shape", "along", "around", "gap", "radius", "length", "growth"],
	&"wire": ["shape", "along", "around", "gap", "thickness", "length", "growth"],
	&"box": ["shape", "along", "around", "gap", "width", "length", "thickness", "growth"],
	&"sheet": ["shape", "along", "around", "gap", "width", "length", "growth"],
	&"ring": ["shape", "along", "around", "gap", "radius", "thickness", "growth"],
	&"scene": ["growth"],
}


func _init(domain: StringName) -> void:
	set_translation_domain(domain)


## The parameters of a line that have a field.
static func get_shown(line: Recipe.Line) -> PackedStringArray:
	return PackedStringArray(_SHOWN.get(BarkFeatures.kind_of(line), []) as Array)


## What the kinds of features are called, in the order of [constant BarkFeatures.KINDS].
func get_titles() -> PackedStringArray:
	return [
		tr("Burl"),
		tr("Ridge along the Grain"),
		tr("Hollow"),
		tr("Obstacle: Post"),
		tr("Obstacle: Wire"),
		tr("Obstacle: Box"),
		tr("Obstacle: Sheet"),
		tr("Obstacle: Ring"),
	]


## The shapes of obstacles: their titles, and their words in recipes.
func get_shapes() -> Array:
	return [
		PackedStringArray([tr("Post"), tr("Wire"), tr("Box"), tr("Sheet"), tr("Ring")]),
		["post", "wire", "box", "sheet", "ring"],
	]


## What a parameter is called, and its tooltip.
func words_of(command: String, parameter: Dictionary) -> PackedStringArray:
	var name: String = parameter.name
	if name == "radius" and command == "obstacle":
		return [tr("Radius"), tr("Of the post or ring.")]
	var words: Dictionary[String, PackedStringArray] = {
		"along": [tr("Along"), tr("Along its branch: of the trunk from the ground.")],
		"around":
		[
			tr("Around"),
			tr("About its branch, counter-clockwise as seen from above; 0° is towards +X.")
		],
		"growth":
		[tr("Growth"), tr("How much faster than usual the bark grows there; 1 is twice as fast.")],
		"grain": [tr("Along the Grain"), tr("A ridge that follows the grain instead of a lump.")],
		"shape": [tr("Shape"), tr("What stands in the way of the bark.")],
		"from":
		[
			tr("From"),
			tr("The share of the wood's age after which it begins: 0 at once, 0.5 half way.")
		],
		"until":
		[tr("Until"), tr("The share of the wood's age after which no more bark dies there.")],
		"radius": [tr("Radius"), tr("How far from its middle the burl reaches.")],
		"width": [tr("Width"), tr("Across the branch.")],
		"height": [tr("Height"), tr("Of its mouth, along the branch.")],
		"depth":
		[tr("Depth"), tr("Of its ground below the bark; with 0 it is a wound that heals over.")],
		"gap":
		[
			tr("Gap"),
			tr("From the grown bark to its middle; below 0 the middle ends up inside the wood.")
		],
		"length": [tr("Length"), tr("From end to end.")],
		"thickness": [tr("Thickness"), tr("How thick the obstacle is.")],
	}
	return words.get(name, PackedStringArray([name.capitalize(), parameter.description]))


## A line of the list.
func title_of(line: Recipe.Line, defaults: Callable) -> String:
	var kind: int = BarkFeatures.KINDS.find(BarkFeatures.kind_of(line))
	if SceneObstacles.is_one(line):
		return tr("Obstacle from the scene: %s") % SceneObstacles.name_of(line)
	if kind < 0:
		return line.get_text()
	var standard: String = defaults.call(line.command, "along")
	var along: float = line.values.get("along", standard).to_float()
	var around: int = roundi(line.values.get("around", "0").to_float())
	# As it was found, it has its place with it.
	var node: String = line.values.get("node", "root").get_slice("@", 0)
	var on_trunk: bool = node == "root"
	if kind == 0:
		if on_trunk:
			return tr("Burl on the trunk, %.2f m up, %d°") % [along, around]
		return tr("Burl by node %s, %.2f m along, %d°") % [node, along, around]
	var title: String = get_titles()[kind]
	if on_trunk:
		return tr("%s on the trunk, %.2f m up, %d°") % [title, along, around]
	return tr("%s by node %s, %.2f m along, %d°") % [title, node, along, around]


## What one of the presets is called.
func name_of_preset(preset: String) -> String:
	match preset:
		"old_oak":
			return tr("Old Oak")
		"fence_post_swallowed":
			return tr("Swallowed Fence Post")
		"spiral_grain":
			return tr("Spiral Grain")
		"hollow_refuge":
			return tr("Hollow Refuge")
	return preset.capitalize()


## What one of the presets makes.
func tip_of_preset(preset: String) -> String:
	match preset:
		"old_oak":
			return tr("Burls, a healed wound, and a ridge that goes up with the grain.")
		"fence_post_swallowed":
			return tr("A fence post that the trunk has grown around, and its wire.")
		"spiral_grain":
			return tr("Grain that winds about the trunk, with ridges that show it.")
		"hollow_refuge":
			return tr("A hollow deep enough to live in, with thick lips.")
	return ""
