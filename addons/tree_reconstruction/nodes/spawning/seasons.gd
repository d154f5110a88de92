@tool
extends RefCounted
## What the season makes of a forest's leaves. The shaders have it, so that a change of it needs no
## tree to be built again: trees bear all their leaves, and the shader folds up those that have
## fallen.

const Materials := preload("materials.gd")
# Between the unfolding of the leaves and their fall.
const _SUMMER: float = 0.45

## How far the earliest and the latest tree are apart.
var spread: float = 0.0

# By the id of the tree: what the shaders take, and what the rule was when it was looked at last.
var _values: Dictionary[int, Dictionary] = {}
var _seen: Dictionary[int, Array] = {}


## Looks at [param trees] as they are now.
func start(trees: Array[TreeReconstruction], between: float) -> void:
	spread = between
	_values = {}
	_seen = {}
	for tree: TreeReconstruction in trees:
		_values[tree.get_instance_id()] = _values_of(tree)
		_seen[tree.get_instance_id()] = _look_at(tree)


## What the shaders take of a tree's season, by their names. It follows the season.
func get_values(tree: TreeReconstruction) -> Dictionary[StringName, Variant]:
	var values: Dictionary[StringName, Variant] = _values[tree.get_instance_id()]
	return values


## Whether a change of [param tree] that was just heard of is one of its season alone; then its
## values are new.
func follow(tree: TreeReconstruction) -> bool:
	var before: Array = _seen.get(tree.get_instance_id(), [])
	if before.is_empty() or tree.leaf_rule == null:
		return false
	var now: Array = _look_at(tree)
	_seen[tree.get_instance_id()] = now
	if before[1] == now[1] or before[0] != now[0]:
		return false
	get_values(tree).merge(_values_of(tree), true)
	return true


## The rule by which a tree bears all leaves that it may have in a year; [code]null[/code] where it
## has no rule.
static func summer_rule(tree: TreeReconstruction) -> LeafRule:
	if tree.leaf_rule == null:
		return null
	var rule: LeafRule = tree.leaf_rule.duplicate() as LeafRule
	rule.season = _SUMMER
	return rule


# All but the season, then the season.
static func _look_at(tree: TreeReconstruction) -> Array:
	var rule: LeafRule = tree.leaf_rule
	if rule == null:
		return [[], []]
	var others: Array = [rule.get_instance_id()]
	for property: Dictionary in rule.get_property_list():
		var stored: bool = property.usage & PROPERTY_USAGE_STORAGE
		if stored and not "season" in property.name and not "resource" in property.name:
			var value: Variant = rule.get(property.name)
			others.append((value as Object).get_instance_id() if value is Object else value)
	return [others, [rule.season, rule.get_season_tints()]]


# From the earliest tree to the latest.
func _values_of(tree: TreeReconstruction) -> Dictionary[StringName, Variant]:
	var values: Dictionary[StringName, Variant] = {}
	var rule: LeafRule = tree.leaf_rule
	if rule == null:
		return values
	var other: LeafRule = rule.duplicate() as LeafRule
	var standing: Vector2
	var unfolded: Vector2
	for end: int in 2:
		other.season = clampf(rule.season + (end - 0.5) * spread, 0.0, 1.0)
		standing[end] = other.get_standing_share()
		unfolded[end] = other.get_unfolded_share()
		var tints: PackedColorArray = other.get_season_tints()
		for i: int in 2:
			# Colors would be converted by some renderers and not by others.
			var tint: Color = tints[i].srgb_to_linear()
			values[StringName(["season_early", "season_late"][i] + ["", "_after"][end])] = Vector4(
				tint.r, tint.g, tint.b, tint.a
			)
	values[&"season_standing"] = standing
	values[&"season_unfolded"] = unfolded
	return values
