extends RefCounted
## A photo studio: a lit world with a backdrop and a floor, and cameras that frame what stands in
## it.

const SKY: Shader = preload("./studio_sky.gdshader")
const GROUND: Shader = preload("./studio_ground.gdshader")
## Pictures are taken this much larger than they are shown, and shrunk: that smooths every edge.
const SUPERSAMPLING: int = 2

const _FIELD_OF_VIEW: float = 22.0
const _PITCH: float = deg_to_rad(-7.0)
const _MARGIN: float = 0.9
const _CAPTION: float = 66.0  # pixels at the top that stay free
const _SAMPLES: int = 1500


## What a camera looks at: where from, and how far.
class Framing:
	extends RefCounted
	var centre: Vector3
	var distance: float
	var reach: float


## A world of its own, holding backdrop, sun, floor and `contents`. The energies suit the
## Compatibility renderer, which adds the light of suns with shadows after the conversion to sRGB.
static func make_world(contents: Array, framing: Framing) -> SubViewport:
	var viewport: SubViewport = SubViewport.new()
	viewport.own_world_3d = true
	viewport.render_target_update_mode = SubViewport.UPDATE_ONCE
	viewport.msaa_3d = Viewport.MSAA_DISABLED
	viewport.mesh_lod_threshold = 0.0
	var environment: WorldEnvironment = WorldEnvironment.new()
	environment.environment = _environment()
	viewport.add_child(environment)
	var sun: DirectionalLight3D = DirectionalLight3D.new()
	sun.rotation_degrees = Vector3(-62.0, 40.0, 0.0)
	sun.light_color = Color(1.0, 0.955, 0.87)
	sun.light_energy = 0.93
	sun.shadow_enabled = true
	sun.directional_shadow_mode = DirectionalLight3D.SHADOW_ORTHOGONAL
	sun.directional_shadow_max_distance = framing.distance + 2.0 * framing.reach
	sun.shadow_blur = 2.0
	sun.shadow_opacity = 0.75
	viewport.add_child(sun)
	var fill: DirectionalLight3D = DirectionalLight3D.new()
	fill.rotation_degrees = Vector3(-15.0, -110.0, 0.0)
	fill.light_color = Color(0.82, 0.89, 1.0)
	fill.light_energy = 0.28
	viewport.add_child(fill)
	var floor_mesh: PlaneMesh = PlaneMesh.new()
	floor_mesh.size = Vector2.ONE * framing.reach * 5.0
	var floor_material: ShaderMaterial = ShaderMaterial.new()
	floor_material.shader = GROUND
	floor_mesh.material = floor_material
	var ground: MeshInstance3D = MeshInstance3D.new()
	ground.mesh = floor_mesh
	ground.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
	viewport.add_child(ground)
	for content: Node3D in contents:
		viewport.add_child(content)
	return viewport


## A second picture of the same world.
static func share_world(of: SubViewport) -> SubViewport:
	var viewport: SubViewport = SubViewport.new()
	viewport.world_3d = of.find_world_3d()
	viewport.render_target_update_mode = SubViewport.UPDATE_ONCE
	viewport.mesh_lod_threshold = 0.0
	return viewport


## Puts a camera into a viewport of `size` pixels: it looks from `yaw` (radians; 0 is from +Z).
static func place_camera(
	viewport: SubViewport, size: Vector2i, framing: Framing, yaw: float
) -> void:
	viewport.size = size * SUPERSAMPLING
	var camera: Camera3D = Camera3D.new()
	camera.fov = _FIELD_OF_VIEW
	camera.near = framing.distance * 0.05
	camera.far = framing.distance * 4.0 + 10.0 * framing.reach
	var basis: Basis = Basis.from_euler(Vector3(_PITCH, yaw, 0.0))
	camera.transform = Transform3D(basis, framing.centre + basis.z * framing.distance)
	viewport.add_child(camera)
	camera.make_current()


## The nearest place from which all `points` fit into a picture of `size`, from every one of `yaws`.
static func frame(points: PackedVector3Array, size: Vector2i, yaws: Array[float]) -> Framing:
	var framing: Framing = Framing.new()
	var half: float = tan(deg_to_rad(_FIELD_OF_VIEW) * 0.5)
	var tan_down: float = half * _MARGIN
	var tan_up: float = half * (1.0 - 2.0 * _CAPTION / size.y)
	var tan_x: float = half * _MARGIN * size.x / size.y
	@warning_ignore("integer_division")
	var step: int = maxi(1, points.size() / _SAMPLES)
	var box: AABB = AABB(Vector3.ZERO, Vector3.ZERO)
	for i: int in range(0, points.size(), step):
		box = box.expand(points[i])
	framing.reach = maxf(box.size.length() * 0.5, 0.05)
	framing.centre = box.get_center()
	for pass_number: int in 5:
		framing.distance = 0.0
		var too_low: float = 0.0
		var too_high: float = 0.0
		for yaw: float in yaws:
			var inverse: Basis = Basis.from_euler(Vector3(_PITCH, yaw, 0.0)).inverse()
			for i: int in range(0, points.size(), step):
				var seen: Vector3 = inverse * (points[i] - framing.centre)
				framing.distance = maxf(framing.distance, absf(seen.x) / tan_x + seen.z)
				too_high = maxf(too_high, seen.y / tan_up + seen.z)
				too_low = maxf(too_low, -seen.y / tan_down + seen.z)
		framing.distance = maxf(framing.distance, maxf(too_high, too_low))
		framing.centre.y += (too_high - too_low) * 0.5 * tan_down
	return framing


static func _environment() -> Environment:
	var environment: Environment = Environment.new()
	var sky: Sky = Sky.new()
	var material: ShaderMaterial = ShaderMaterial.new()
	material.shader = SKY
	sky.sky_material = material
	sky.radiance_size = Sky.RADIANCE_SIZE_32
	environment.background_mode = Environment.BG_SKY
	environment.sky = sky
	environment.ambient_light_source = Environment.AMBIENT_SOURCE_COLOR
	environment.ambient_light_color = Color(0.80, 0.86, 0.95)
	environment.ambient_light_energy = 0.33
	environment.reflected_light_source = Environment.REFLECTION_SOURCE_DISABLED
	environment.tonemap_mode = Environment.TONE_MAPPER_LINEAR
	# Suns that are added after the conversion to sRGB make greens stronger than they are.
	environment.adjustment_enabled = true
	environment.adjustment_saturation = 0.78
	environment.adjustment_contrast = 1.04
	return environment
