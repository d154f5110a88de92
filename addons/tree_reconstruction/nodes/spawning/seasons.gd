@tool
extends RefCounted
## What the season makes of a forest's leaves. The shaders have it, so that a change of it needs no
## tree to be built again: trees bear all their leaves, and the shader folds up those that have
## fallen.

const Kinds := preload("../leaf_kinds.gd")
# Between the unfolding of the leaves and their fall.
const _SUMMER: float = 0.45

## How far the earliest and the latest tree are apart.
var spread: float = 0.0

# By the id of the tree: what the shaders take for each kind of leaves, and what the rule was when
# it was looked at last.
var _values: Dictionary[int, Array] = {}
var _seen: Dictionary[int, Array] = {}


## Looks at [param trees] as they are now.
func start(trees: Array[TreeReconstruction], between: float) -> void:
	spread = between
	_values = {}
	_seen = {}
	for tree: TreeReconstruction in trees:
		_values[tree.get_instance_id()] = _values_of(tree)
		_seen[tree.get_instance_id()] = _look_at(tree)


## What the shaders take of a tree's season, by their names: for each kind of leaves (see [method
## TreeReconstruction.get_leaf_kinds]). They follow the season.
func get_values(tree: TreeReconstruction) -> Array[Dictionary]:
	var values: Array[Dictionary] = _values[tree.get_instance_id()]
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
	var values: Array[Dictionary] = _values_of(tree)
	for kind: int in values.size():
		get_values(tree)[kind].merge(values[kind], true)
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
func _values_of(tree: TreeReconstruction) -> Array[Dictionary]:
	var early: Array[Dictionary] = tree.get_leaf_kinds(-0.5 * spread)
	var late: Array[Dictionary] = tree.get_leaf_kinds(0.5 * spread)
	var all: Array[Dictionary] = []
	for kind: int in early.size():
		var values: Dictionary[StringName, Variant] = {}
		if tree.leaf_rule != null:
			values = Kinds.season_values(early[kind].tints)
			var after: Dictionary[StringName, Variant] = Kinds.season_values(late[kind].tints)
			for name: StringName in after:
				values[StringName(name + "_after")] = after[name]
			values[&"season_standing"] = Vector2(early[kind].standing, late[kind].standing)
			values[&"season_unfolded"] = Vector2(early[kind].unfolded, late[kind].unfolded)
		all.append(values)
	return all
