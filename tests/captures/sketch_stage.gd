extends SubViewport
## Where sketched trees are photographed: sky, sun, ground, and a camera without perspective.

var camera: Camera3D = Camera3D.new()
var shown: TreeInstance3D = TreeInstance3D.new()


## [param pixels]: how large its pictures are; [param ground_width]: the ground, in metres.
func _init(pixels: Vector2i, ground_width: float) -> void:
	size = pixels
	own_world_3d = true
	msaa_3d = Viewport.MSAA_4X
	# Each picture takes seconds without a graphics card: only those that are kept are drawn.
	render_target_update_mode = SubViewport.UPDATE_DISABLED
	var environment: Environment = Environment.new()
	environment.background_mode = Environment.BG_COLOR
	environment.background_color = Color(0.87, 0.9, 0.93)
	environment.sky = Sky.new()
	environment.sky.sky_material = ProceduralSkyMaterial.new()
	environment.ambient_light_source = Environment.AMBIENT_SOURCE_SKY
	environment.ambient_light_energy = 0.7
	environment.tonemap_mode = Environment.TONE_MAPPER_FILMIC
	var world: WorldEnvironment = WorldEnvironment.new()
	world.environment = environment
	add_child(world)
	var sun: DirectionalLight3D = DirectionalLight3D.new()
	sun.rotation_degrees = Vector3(-48.0, -35.0, 0.0)
	sun.shadow_enabled = true
	sun.directional_shadow_max_distance = 80.0
	add_child(sun)
	var ground: MeshInstance3D = MeshInstance3D.new()
	var plane: PlaneMesh = PlaneMesh.new()
	plane.size = Vector2(ground_width, 60.0)
	var earth: StandardMaterial3D = StandardMaterial3D.new()
	earth.albedo_color = Color(0.16, 0.2, 0.09)
	earth.roughness = 1.0
	plane.material = earth
	ground.mesh = plane
	add_child(ground)
	camera.projection = Camera3D.PROJECTION_ORTHOGONAL
	camera.far = 400.0
	add_child(camera)
	add_child(shown)
