@tool
extends RefCounted
## Lets all trees rest while the editor shows no wind, by shaders that do not read the engine's
## TIME: the editor draws only what has changed, but all the time as long as it sees one that does.

const _INCLUDE: String = "res://addons/tree_reconstruction/shaders/tree_wind_rest.gdshaderinc"

# As long as this is held, so are all shaders that are loaded later.
var _include: ShaderInclude = load(_INCLUDE) as ShaderInclude
var _saved: String = _include.code


## To be called once a frame. [param shown]: whether the wind is to be seen without a [TreeWind].
func update(shown: bool) -> void:
	_set_code(_saved if shown or TreeWind.is_blowing() else "#define TREE_WIND_RESTS\n")


## Trees move again as they do in a game.
func leave() -> void:
	_set_code(_saved)


# All shaders that include it are compiled anew.
func _set_code(code: String) -> void:
	if _include.code != code:
		_include.code = code
