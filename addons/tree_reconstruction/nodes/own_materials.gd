@tool
extends RefCounted
## What shaders take per tree. Most renderers keep that with the drawn instance. Compatibility has
## room for 256 instances only, some 25 trees: there, each part of a tree is drawn with a copy of
## its material whose shader has these values as plain uniforms. The copies are the rendering
## server's alone, and follow their material (see followed_material.gd).

const Followed := preload("followed_material.gd")
const _COPY: StringName = &"_own_material"


## Draws [param part] with [param material], where the renderer needs that to be a copy; elsewhere
## the part's own properties hold. To be called again whenever one of them was set.
static func give(part: GeometryInstance3D, material: Material) -> void:
	if is_needed():
		var copy: Copy = _copy_of(part)
		copy.follow(material as ShaderMaterial)
		if material is ShaderMaterial and not copy.is_following():
			copy.tell_instance(part.get_instance())
		restore(part)


## Draws [param part] with [param material] and nothing else until [method restore] is called.
static func lend(part: GeometryInstance3D, material: Material) -> void:
	if is_needed():
		_copy_of(part).tell_instance(part.get_instance())
	RenderingServer.instance_geometry_set_material_override(part.get_instance(), material.get_rid())


## Draws [param part] as it was before the server was told otherwise.
static func restore(part: GeometryInstance3D) -> void:
	var shown: RID = RID()
	if part.material_override != null:
		shown = part.material_override.get_rid()
	if is_needed() and _copy_of(part).is_following():
		shown = _copy_of(part).rid
	RenderingServer.instance_geometry_set_material_override(part.get_instance(), shown)


## Sets what the shaders of [param part] take per tree.
static func tell(part: GeometryInstance3D, name: StringName, value: Variant) -> void:
	if is_needed():
		_copy_of(part).tell(name, value)
		return
	var instance: RID = part.get_instance()
	# Telling the server again would make the editor draw; asking it would make a game wait.
	if Engine.is_editor_hint():
		if RenderingServer.instance_geometry_get_shader_parameter(instance, name) == value:
			return
	RenderingServer.instance_geometry_set_shader_parameter(instance, name, value)


## Whether this renderer needs copies.
static func is_needed() -> bool:
	return (
		RenderingServer.get_current_rendering_method() == "gl_compatibility"
		and DisplayServer.get_name() != "headless"
	)


static func _copy_of(part: GeometryInstance3D) -> Copy:
	# The other parts are never saved, so what they bear isn't, either.
	if part is TreeInstance3D:
		if part.get(_COPY) == null:
			part.set(_COPY, Copy.new())
		return part.get(_COPY) as Copy
	if not part.has_meta(_COPY):
		part.set_meta(_COPY, Copy.new())
	return part.get_meta(_COPY) as Copy


# A part's material in the server.
class Copy:
	extends RefCounted

	var rid: RID = RenderingServer.material_create()
	var _told: Dictionary[StringName, Variant] = {}
	var _followed: Followed
	# What has to be told as in other renderers: then it takes up room.
	var _instance: RID

	func _notification(what: int) -> void:
		if what == NOTIFICATION_PREDELETE:
			if _followed != null:
				_followed.leave(rid)
			RenderingServer.free_rid(rid)

	func follow(material: ShaderMaterial) -> void:
		var followed: Followed = Followed.of(material)
		if followed == _followed:
			return
		if _followed != null:
			_followed.leave(rid)
		_followed = followed
		if _followed != null:
			_followed.join(rid)
			for name: StringName in _told:
				RenderingServer.material_set_param(rid, name, _told[name])

	func is_following() -> bool:
		return _followed != null

	func tell(name: StringName, value: Variant) -> void:
		if _told.has(name) and is_same(_told[name], value):
			return
		_told[name] = value
		if _followed != null:
			RenderingServer.material_set_param(rid, name, value)
		if _instance.is_valid():
			RenderingServer.instance_geometry_set_shader_parameter(_instance, name, value)

	func tell_instance(instance: RID) -> void:
		if _instance.is_valid():
			return
		_instance = instance
		for name: StringName in _told:
			RenderingServer.instance_geometry_set_shader_parameter(_instance, name, _told[name])
