@tool
extends Node3D
## Ground to stand a tree on: soil, moss and grass that meet without a seam, blades of grass, and
## dead leaves below the crown. It grows when the node enters the scene.

const FLOOR: Shader = preload("forest_floor.gdshader")
const BLADES: Shader = preload("meadow.gdshader")
const _SIDE: float = 3000.0
const _BLADES: int = 9  # of a tuft
const _LITTER: Color = Color(0.36, 0.25, 0.14)

## Metres around the middle within which grass grows.
@export_range(1.0, 60.0) var reach: float = 14.0
## Tufts on a square metre in the middle; there are fewer further out.
@export_range(0.0, 100.0) var density: float = 60.0
## Metres: how high the highest blades are.
@export_range(0.02, 1.0) var height: float = 0.26
## Metres around the middle that the crown shades: grass is thin there, and dead leaves lie.
@export_range(0.0, 30.0) var shade: float = 3.0
## Another number, other ground.
@export var number: int = 1


func _ready() -> void:
	var noise: FastNoiseLite = FastNoiseLite.new()
	noise.seed = number
	noise.frequency = 0.02
	noise.fractal_octaves = 4
	_add_floor(noise)
	var random: RandomNumberGenerator = RandomNumberGenerator.new()
	random.seed = number
	_add_grass(noise, random)
	_add_litter(random)


func _add_floor(noise: FastNoiseLite) -> void:
	var picture: NoiseTexture2D = NoiseTexture2D.new()
	picture.seamless = true
	picture.generate_mipmaps = true
	picture.noise = noise
	var material: ShaderMaterial = ShaderMaterial.new()
	material.shader = FLOOR
	material.set_shader_parameter(&"noise", picture)
	material.set_shader_parameter(&"litter", Color(0.37, 0.35, 0.21))
	material.set_shader_parameter(&"moss", Color(0.29, 0.33, 0.15))
	material.set_shader_parameter(&"grass", Color(0.36, 0.41, 0.19))
	var plane: PlaneMesh = PlaneMesh.new()
	plane.size = Vector2.ONE * _SIDE
	plane.material = material
	var ground: MeshInstance3D = MeshInstance3D.new()
	ground.mesh = plane
	ground.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
	add_child(ground, false, Node.INTERNAL_MODE_BACK)


func _add_grass(noise: FastNoiseLite, random: RandomNumberGenerator) -> void:
	var places: Array[Transform3D] = []
	var colors: PackedColorArray = []
	for i: int in int(density * PI * reach * reach / 3.0):
		# As many at each distance thin the grass out evenly to its end.
		var away: float = reach * sqrt(random.randf()) * sqrt(random.randf())
		var place: Vector2 = Vector2.from_angle(TAU * random.randf()) * away
		var patch: float = 0.5 + noise.get_noise_2dv(place * 12.0)
		var lit: float = smoothstep(0.5, 1.3, away / maxf(shade, 0.01))
		if random.randf() > clampf(patch + 0.2, 0.1, 1.0) * lerpf(0.25, 1.0, lit):
			continue
		var grown: float = height * random.randf_range(0.4, 1.0) * lerpf(0.55, 1.0, lit)
		var turned: Basis = Basis(Vector3.UP, TAU * random.randf())
		places.append(
			Transform3D(
				turned.scaled(Vector3(1.0, grown / 0.2, 1.0)), Vector3(place.x, 0.0, place.y)
			)
		)
		var dry: float = clampf(random.randfn(0.25, 0.25) + 0.3 * (1.0 - patch), 0.0, 1.0)
		colors.append(Color(dry, random.randf(), random.randf()))
	var material: ShaderMaterial = ShaderMaterial.new()
	material.shader = BLADES
	_add_many(_make_tuft(random), material, places, colors, &"Grass")


func _add_litter(random: RandomNumberGenerator) -> void:
	var places: Array[Transform3D] = []
	var colors: PackedColorArray = []
	for i: int in int(30.0 * PI * shade * shade):
		var place: Vector2 = (
			Vector2.from_angle(TAU * random.randf()) * shade * 1.3 * sqrt(random.randf())
		)
		var lies: Basis = Basis.from_euler(
			Vector3(random.randfn(0.0, 0.3), TAU * random.randf(), random.randfn(0.0, 0.3))
		)
		lies = lies.scaled_local(Vector3.ONE * random.randf_range(0.03, 0.075))
		places.append(Transform3D(lies, Vector3(place.x, 0.006 + 0.012 * random.randf(), place.y)))
		var color: Color = _LITTER.lerp(Color(0.5, 0.4, 0.22), random.randf())
		colors.append(color * random.randf_range(0.5, 1.15))
	var material: StandardMaterial3D = StandardMaterial3D.new()
	material.vertex_color_use_as_albedo = true
	material.vertex_color_is_srgb = true
	material.roughness = 0.9
	material.metallic_specular = 0.2
	material.cull_mode = BaseMaterial3D.CULL_DISABLED
	_add_many(_make_dead_leaf(), material, places, colors, &"Litter")


func _add_many(
	mesh: ArrayMesh,
	material: Material,
	places: Array[Transform3D],
	colors: PackedColorArray,
	called: StringName
) -> void:
	mesh.surface_set_material(0, material)
	var many: MultiMesh = MultiMesh.new()
	many.transform_format = MultiMesh.TRANSFORM_3D
	many.use_colors = true
	many.mesh = mesh
	many.instance_count = places.size()
	for i: int in places.size():
		many.set_instance_transform(i, places[i])
		many.set_instance_color(i, colors[i])
	var node: MultiMeshInstance3D = MultiMeshInstance3D.new()
	node.name = called
	node.multimesh = many
	node.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
	add_child(node, false, Node.INTERNAL_MODE_BACK)


# Some blades from one root, as high as 0.2 m.
func _make_tuft(random: RandomNumberGenerator) -> ArrayMesh:
	var builder: SurfaceTool = SurfaceTool.new()
	builder.begin(Mesh.PRIMITIVE_TRIANGLES)
	for blade: int in _BLADES:
		var yaw: float = TAU * (blade + random.randf()) / _BLADES
		var out: Vector3 = Basis(Vector3.UP, yaw) * Vector3.RIGHT
		var across: Vector3 = out.cross(Vector3.UP) * random.randf_range(0.004, 0.008)
		var root: Vector3 = out * random.randf_range(0.0, 0.12)
		var tall: float = 0.2 * random.randf_range(0.5, 1.0)
		var lean: float = random.randf_range(0.1, 0.5) * tall
		var before: int = blade * 5
		for level: int in 3:
			var up: float = 0.5 * level
			var middle: Vector3 = root + Vector3.UP * tall * up + out * lean * up * up
			for side: float in [-1.0, 1.0] if level < 2 else [0.0]:
				builder.set_normal(across.cross(Vector3.UP).normalized())
				builder.set_uv(Vector2(0.5 + 0.5 * side, up))
				builder.add_vertex(middle + across * side * (1.0 - 0.4 * up))
		for corner: int in [0, 1, 2, 2, 1, 3, 2, 3, 4]:
			builder.add_index(before + corner)
	return builder.commit()


# A leaf of length 1 that has curled up a little.
func _make_dead_leaf() -> ArrayMesh:
	var builder: SurfaceTool = SurfaceTool.new()
	builder.begin(Mesh.PRIMITIVE_TRIANGLES)
	var widths: PackedFloat32Array = [0.0, 0.24, 0.3, 0.2, 0.0]
	for i: int in widths.size():
		var along: float = float(i) / (widths.size() - 1)
		var high: float = 0.5 * (along - 0.5) * (along - 0.5)
		for side: float in [-1.0, 0.0, 1.0]:
			builder.set_normal(Vector3(-0.35 * side, 1.0, 0.5 - along).normalized())
			builder.add_vertex(Vector3(side * widths[i], high + 0.1 * absf(side), along - 0.5))
	for i: int in widths.size() - 1:
		for half: int in 2:
			var at: int = 3 * i + half
			for corner: int in [at, at + 1, at + 3, at + 3, at + 1, at + 4]:
				builder.add_index(corner)
	return builder.commit()
