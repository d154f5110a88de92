@tool
extends RefCounted
## The wind's shader globals in the project's settings, where users find and set them.
##
## The shaders work without: the library adds those that are missing. But a game that has baked
## trees alone, and no library, needs them here.

const _SETTINGS: String = "shader_globals/"
const _TYPES: Dictionary[int, String] = {
	TYPE_FLOAT: "float", TYPE_VECTOR2: "vec2", TYPE_VECTOR4: "vec4"
}


## Adds those that are missing. Returns how many these were.
static func add() -> int:
	var added: int = 0
	var globals: Dictionary = TreeReconstruction.get_wind_globals()
	for name: String in globals:
		if not ProjectSettings.has_setting(_SETTINGS + name):
			ProjectSettings.set_setting(_SETTINGS + name, _setting_of(globals[name]))
			added += 1
	return added


## Takes those away that nobody has changed. Returns how many these were.
static func remove() -> int:
	var removed: int = 0
	var globals: Dictionary = TreeReconstruction.get_wind_globals()
	for name: String in globals:
		var setting: Variant = ProjectSettings.get_setting(_SETTINGS + name, null)
		if setting is Dictionary and setting == _setting_of(globals[name]):
			ProjectSettings.set_setting(_SETTINGS + name, null)
			removed += 1
	return removed


static func _setting_of(value: Variant) -> Dictionary:
	return {"type": _TYPES[typeof(value)], "value": value}
