@tool
extends RefCounted
## What the kinds of leaves of a tree look like: of [method TreeReconstruction.get_leaf_kinds], the
## tree's own first.

const _PRESETS: String = "res://addons/tree_reconstruction/presets/%s_%s.tres"
# As game_export.gd, which games don't have.
const _KINDS_SETTING: String = "tree_reconstruction/export/more_kinds"
const _SEASON_PARAMETERS: Array[StringName] = [&"season_early", &"season_late"]

# Those that were warned of.
static var _missing: Dictionary[String, bool] = {}


## Whether leaves of [param kind] are drawn as the tree's own, [param own], are: with the material
## that the user gave these, if there is one.
static func looks_like(kind: Dictionary, own: Dictionary) -> bool:
	return kind.look == own.look and kind.single == own.single


## Where the addon's material for such leaves is.
static func material_path(kind: Dictionary) -> String:
	return preset_path(kind.look, "blade" if kind.single else "leaf")


## Where the addon's material for the [code]bark[/code], a [code]leaf[/code] (a spray) or a
## [code]blade[/code] of a preset is.
static func preset_path(look: String, part: String) -> String:
	return find_preset(look, part, ResourceLoader.exists)


## As [method preset_path]; [param is_there] says of a path whether it leads to anything.
static func find_preset(look: String, part: String, is_there: Callable) -> String:
	var path: String = _PRESETS % [look, part]
	if is_there.call(path):
		return path
	if look in TreeReconstruction.get_leaf_preset_names() and not _missing.has(look):
		_missing[look] = true
		push_warning(
			(
				(
					"This game was exported without the pictures of the kind '%s', so its trees look"
					+ " like those of no kind. Add it to the project setting %s and export the game"
					+ " again."
				)
				% [look, _KINDS_SETTING]
			)
		)
	return _PRESETS % ["generic", part]


## What shaders take of [param tints], the colors of leaves that are early, and late, in the season;
## those of no season where there are none.
static func season_values(tints: PackedColorArray) -> Dictionary[StringName, Variant]:
	var values: Dictionary[StringName, Variant] = {}
	for i: int in 2:
		var tint: Color = Color(1.0, 1.0, 1.0, 0.0)
		if i < tints.size():
			# Colors would be converted by some renderers and not by others.
			tint = tints[i].srgb_to_linear()
		values[_SEASON_PARAMETERS[i]] = Vector4(tint.r, tint.g, tint.b, tint.a)
	return values
