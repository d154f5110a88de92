extends RefCounted
## A place for trees to stand and to be seen: in daylight on a meadow, or in a dark studio.

const Daylight: PackedScene = preload("res://addons/tree_reconstruction/presets/daylight.tscn")
const Meadow := preload("res://scenes/meadow.gd")
const DARK: Color = Color("0e1d24")

var viewport: SubViewport = SubViewport.new()
var camera: Camera3D = Camera3D.new()
## Of daylight alone.
var sun: DirectionalLight3D
var air: Environment
var meadow: Meadow

var _tree: SceneTree


func _init(tree: SceneTree, size: Vector2i) -> void:
	_tree = tree
	viewport.size = size
	viewport.own_world_3d = true
	viewport.msaa_3d = Viewport.MSAA_4X
	viewport.render_target_update_mode = SubViewport.UPDATE_DISABLED
	tree.root.add_child(viewport)
	camera.near = 0.05
	camera.far = 3000.0
	viewport.add_child(camera)


## Sky, sun and grass; dead leaves lie within [param shade] metres of the middle.
func light_up(reach: float, shade: float) -> void:
	var light: Node3D = Daylight.instantiate() as Node3D
	viewport.add_child(light)
	sun = light.get_node(^"Sun") as DirectionalLight3D
	sun.directional_shadow_max_distance = 160.0
	var world: WorldEnvironment = light.get_node(^"Environment") as WorldEnvironment
	air = world.environment.duplicate() as Environment
	world.environment = air
	meadow = Meadow.new()
	meadow.reach = reach
	meadow.shade = shade
	viewport.add_child(meadow)


## A dark room, for points and lines; what has bark is lit a little.
func darken() -> void:
	air = Environment.new()
	air.background_mode = Environment.BG_COLOR
	air.background_color = DARK
	air.ambient_light_source = Environment.AMBIENT_SOURCE_COLOR
	air.ambient_light_color = Color.WHITE
	air.ambient_light_energy = 0.5
	var world: WorldEnvironment = WorldEnvironment.new()
	world.environment = air
	viewport.add_child(world)
	sun = DirectionalLight3D.new()
	sun.rotation_degrees = Vector3(-42.0, -38.0, 0.0)
	sun.light_energy = 1.2
	sun.shadow_enabled = true
	viewport.add_child(sun)


## A tree as it is seen from near, at rest.
func plant(tree: TreeReconstruction) -> TreeInstance3D:
	var planted: TreeInstance3D = TreeInstance3D.new()
	planted.lod = 0
	planted.wind = false
	planted.reconstruction = tree
	viewport.add_child(planted)
	return planted


## Something of a mesh, such as points and lines.
func show_mesh(mesh: Mesh, material: Material) -> MeshInstance3D:
	var shown: MeshInstance3D = MeshInstance3D.new()
	shown.mesh = mesh
	shown.material_override = material
	shown.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
	viewport.add_child(shown)
	return shown


func look(from: Vector3, at: Vector3, field: float) -> void:
	camera.fov = field
	camera.look_at_from_position(from, at)


## What the camera sees, once all that is being built is there.
func picture() -> Image:
	var rest: int = 0
	while rest < 3:
		await _tree.process_frame
		rest += 1
		for node: Node in viewport.find_children("*", "Node3D", true, false):
			var planted: TreeInstance3D = node as TreeInstance3D
			var forest: TreeVariantSpawner3D = node as TreeVariantSpawner3D
			if planted != null and planted.is_rebuilding():
				rest = 0
			if forest != null and forest.is_building():
				rest = 0
	viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	# The sky's light and shadows need a frame or two.
	for frame: int in 3:
		await RenderingServer.frame_post_draw
	viewport.render_target_update_mode = SubViewport.UPDATE_DISABLED
	return viewport.get_texture().get_image()


func free_all() -> void:
	viewport.queue_free()
