@tool
@icon("../icons/TreeWind.svg")
class_name TreeWind
extends Node
## The wind of all trees: put one into your scene, and set or animate it.
##
## It writes the project's shader globals [code]tree_wind_…[/code], which the bark, the leaves and
## your own shaders read (see docs/wind.md). Without one, they are what Project Settings > Globals >
## Shader Globals says. When it leaves the tree, they are so again.
## [codeblock]
## $TreeWind.strength = 0.9  # A storm comes up.
## TreeWind.quality = TreeWind.Quality.BRANCHES  # For slower machines.
## [/codeblock]

## How much of the motion the shaders have. Less is compiled, not only hidden.
enum Quality {
	NONE,  ## Nothing moves.
	SWAY,  ## Whole trees lean and swing.
	BRANCHES,  ## Primary and secondary branches swing, too, and give way to a [TreePusher3D].
	FLUTTER,  ## Twigs tremble and leaves flutter, too.
}

## What [method show_channel] shows.
enum Channel {
	NONE,  ## The tree as it is.
	SWAY,  ## From black at the root to white at the top ([code]COLOR.r[/code]).
	ALONG,  ## From black at a branch's base to white at its tip ([code]COLOR.g[/code]).
	PHASE,  ## A colour for each branch ([code]COLOR.b[/code]), for leaves their own.
	OCCLUSION,  ## White is open to the sky ([code]COLOR.a[/code]).
	PIVOT,  ## Where the branch's pivot is, repeating each metre ([code]CUSTOM0.xyz[/code]).
	LEVEL,  ## A colour for each level of branching ([code]CUSTOM0.w[/code]).
	## A colour for each primary branch, the lighter the farther out ([code]CUSTOM2.x[/code]).
	PRIMARY_BRANCH,
	SECONDARY_BRANCH,  ## The same for secondary branches ([code]CUSTOM2.y[/code]).
	MOTION,  ## How far it has moved now: red, green and blue are 10 cm in x, y and z.
	LIMB = PRIMARY_BRANCH,  ## @deprecated: Use [constant PRIMARY_BRANCH].
	BOUGH = SECONDARY_BRANCH,  ## @deprecated: Use [constant SECONDARY_BRANCH].
}

const Checked := preload("checked.gd")
const Channels: GDScript = preload("wind_channels.gd")
const _SHADERS: String = "res://addons/tree_reconstruction/shaders/"
# After which the engine's TIME begins anew.
const _ROLLOVER: String = "rendering/limits/time/time_rollover_secs"
const _SETTINGS: String = "shader_globals/"

## The quality of all trees' wind, for a menu of graphics options. Setting it compiles the shaders
## of all trees that include [code]tree_wind.gdshaderinc[/code] anew, which is felt: not while
## playing. Baked trees keep that which they were baked with.
static var quality: Quality = Quality.FLUTTER:
	set(value):
		if quality == value:
			return
		quality = value
		var shader: ShaderInclude = (
			load(_SHADERS + "tree_wind_quality.gdshaderinc") as ShaderInclude
		)
		# As long as this is held, so are all shaders that are loaded later.
		_quality_include = shader
		shader.code = "#define TREE_WIND_QUALITY %d\n" % quality
static var _quality_include: ShaderInclude
# Those in a tree; the last one blows.
static var _winds: Array[TreeWind] = []

## How hard it blows: 0 is calm, 0.4 a breeze, 1 a storm.
@export_range(0.0, 1.25, 0.01) var strength: float = 0.4:
	set(value):
		strength = Checked.number(value, 0.0, 100.0, strength)
		_write()

## Where it blows to, in world space (x, z).
@export var direction: Vector2 = Vector2(1.0, 0.35):
	set(value):
		direction = Checked.point(value, direction)
		_write()

## How fast gusts and swings pass: 1 is natural.
@export_range(0.0, 4.0, 0.01) var speed: float = 1.0:
	set(value):
		var faster: float = Checked.number(value, 0.0, 100.0, speed)
		if speed != faster:
			_keep_clock(faster)
		speed = faster
		_write()

## 0 is an even wind, 1 one of lulls and gusts.
@export_range(0.0, 1.0, 0.01) var gustiness: float = 0.8:
	set(value):
		gustiness = Checked.number(value, 0.0, 1.0, gustiness)
		_write()

## Follows the wind of this [Area3D] ([member Area3D.wind_force_magnitude] and [member
## Area3D.wind_source_path], whose -Z axis says where it blows to), so that cloth and trees share
## one. [member strength] and [member direction] are not used then.
@export var area: Area3D:
	set(value):
		area = value
		set_process(area != null)
		_write()

## Which [member Area3D.wind_force_magnitude] is a strength of 1.
@export_range(0.1, 100.0, 0.1, "or_greater") var area_storm: float = 10.0:
	set(value):
		area_storm = Checked.number(value, 0.001, 1e6, area_storm)
		_write()

# The seconds by which the shaders' clock is ahead of TIME times the speed.
var _shift: float = 0.0
var _written: Dictionary = {}


## Colours a tree by what its shaders read, for looking for mistakes; nothing of it is saved.
## [param instance]: a [TreeInstance3D], whose children are coloured too.
static func show_channel(instance: GeometryInstance3D, channel: Channel) -> void:
	if instance == null or channel < Channel.NONE or channel > Channel.MOTION:
		push_error("Give show_channel() a TreeInstance3D and one of TreeWind's channels.")
		return
	Channels.show(instance, channel)


## What the project says of a shader global of the wind: see [method
## TreeReconstruction.get_wind_globals].
static func get_project_value(global: StringName) -> Variant:
	var setting: Variant = ProjectSettings.get_setting(_SETTINGS + global, null)
	if setting is Dictionary and (setting as Dictionary).has("value"):
		return setting["value"]
	return TreeReconstruction.get_wind_globals().get(String(global))


## Whether a [TreeWind] blows now: one is in the tree, and it is not calm.
static func is_blowing() -> bool:
	return not _winds.is_empty() and _winds.back()._written.get(&"tree_wind_strength", 0.0) > 0.0


func _enter_tree() -> void:
	_winds.append(self)
	_written.clear()
	_write()
	set_process(area != null)


func _exit_tree() -> void:
	_winds.erase(self)
	if _winds.is_empty():
		for global: StringName in get_values():
			RenderingServer.global_shader_parameter_set(global, get_project_value(global))
	else:
		_winds.back()._written.clear()
		_winds.back()._write()


func _process(_delta: float) -> void:
	_write()


func _get_configuration_warnings() -> PackedStringArray:
	if _winds.size() > 1 and _winds.back() != self:
		return ["There is another TreeWind in the tree, and the last one alone blows."]
	return []


## What it writes into the shader globals, by their names.
func get_values() -> Dictionary[StringName, Variant]:
	var force: float = strength
	var way: Vector2 = direction
	if is_instance_valid(area):
		force = area.wind_force_magnitude / area_storm
		var source: Node3D = area.get_node_or_null(area.wind_source_path) as Node3D
		if source != null and source.is_inside_tree():
			var forward: Vector3 = -source.global_basis.z
			way = Vector2(forward.x, forward.z)
	return {
		&"tree_wind_strength": force,
		&"tree_wind_direction": way,
		&"tree_wind_speed": speed,
		&"tree_wind_gustiness": gustiness,
		&"tree_wind_shift": _shift,
	}


func _write() -> void:
	if not is_inside_tree() or _winds.back() != self:
		return
	var values: Dictionary[StringName, Variant] = get_values()
	for global: StringName in values:
		if _written.get(global) != values[global]:
			RenderingServer.global_shader_parameter_set(global, values[global])
	_written = values


# The wind's clock goes on from where it is, now at another speed. The engine does not tell its
# TIME; what is missing since its start changes little.
func _keep_clock(faster: float) -> void:
	var rollover: float = ProjectSettings.get_setting(_ROLLOVER, 3600.0)
	var time: float = fmod(Time.get_ticks_msec() / 1000.0, maxf(rollover, 1.0))
	_shift += time * (speed - faster)
