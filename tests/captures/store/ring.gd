extends RefCounted
## Photos around the tree that was made of them: where each was taken, what its camera saw there,
## and the points that they agree on.

const Stage := preload("./stage.gd")
const Plots := preload("res://demo/plots.gd")
# How wide the photos hang, by the circle's radius.
const _PHOTO: float = 0.24
# Points of bark are dark; before a dark ground they are shown lighter than they are.
const _LIGHT: float = 0.5
const _LINE: Color = Color("c4e260")

var tree: TreeReconstruction
var views: Array[Dictionary]
var points: PackedVector3Array
var colors: PackedColorArray
## Why it could not be read.
var message: String = ""

var _maker: TreeReconstructor = TreeReconstructor.new()
var _folder: String


## Reads the cloud that 'treerec photos' left beside COLMAP's model, and its tree. Points are at
## least [param spacing] metres apart; 0: as they are.
func read(cloud: String, photos: String, spacing: float) -> bool:
	_folder = photos
	tree = _maker.reconstruct_file(cloud, {} if spacing == 0.0 else {"spacing": spacing})
	if tree != null:
		points = _maker.get_cloud_points()
		colors = _maker.get_cloud_colors()
		views = _maker.load_photo_views(tree)
	message = _maker.get_error_message()
	return tree != null and not views.is_empty()


## A photo without its lens's distortion, or null.
func load_photo(view: int, longest: int) -> Image:
	var photo: Dictionary = _maker.load_photo(views[view], _folder, longest)
	if photo.is_empty():
		printerr(_maker.get_error_message())
		return null
	var size: Vector2i = photo["size"]
	return Image.create_from_data(size.x, size.y, false, Image.FORMAT_RGBA8, photo["pixels"])


func show_points(stage: Stage) -> void:
	var light: PackedColorArray = []
	for color: Color in colors:
		light.append(color.lightened(_LIGHT))
	stage.show_mesh(Plots.cloud(points, light), Plots.bead_material(2.6, 0.0))


## Hangs every second photo where it was taken, around the points.
func set_up(stage: Stage) -> void:
	show_points(stage)
	var wide: float = _PHOTO * _reach()
	var lines: PackedVector3Array = []
	for i: int in range(0, views.size(), 2):
		var photo: Image = load_photo(i, 400)
		if photo == null:
			continue
		var half: Vector2 = Vector2.ONE * 0.5 * wide
		half.y *= float(photo.get_height()) / photo.get_width()
		var size: Vector2 = views[i]["size"]
		var focal: float = views[i]["focal"]
		var ahead: float = wide * focal / size.x
		var place: Transform3D = views[i]["transform"]
		var picture: QuadMesh = QuadMesh.new()
		picture.size = 2.0 * half
		var paper: StandardMaterial3D = StandardMaterial3D.new()
		paper.shading_mode = BaseMaterial3D.SHADING_MODE_UNSHADED
		paper.cull_mode = BaseMaterial3D.CULL_DISABLED
		paper.texture_filter = BaseMaterial3D.TEXTURE_FILTER_LINEAR_WITH_MIPMAPS_ANISOTROPIC
		paper.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA_SCISSOR
		photo.generate_mipmaps()
		paper.albedo_texture = ImageTexture.create_from_image(photo)
		var hung: MeshInstance3D = stage.show_mesh(picture, paper)
		hung.transform = place * Transform3D(Basis.IDENTITY, Vector3.FORWARD * ahead)
		var corners: Array[Vector3] = []
		for corner: Vector2 in [Vector2(-1, -1), Vector2(1, -1), Vector2(1, 1), Vector2(-1, 1)]:
			corners.append(place * Vector3(corner.x * half.x, corner.y * half.y, -ahead))
		for c: int in 4:
			lines.append_array([place.origin, corners[c], corners[c], corners[(c + 1) % 4]])
	var drawn: ArrayMesh = ArrayMesh.new()
	var arrays: Array = []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = lines
	drawn.add_surface_from_arrays(Mesh.PRIMITIVE_LINES, arrays)
	var thin: StandardMaterial3D = StandardMaterial3D.new()
	thin.shading_mode = BaseMaterial3D.SHADING_MODE_UNSHADED
	thin.albedo_color = _LINE
	stage.show_mesh(drawn, thin)


## All of them in view, from above.
func see_from(stage: Stage, turn: float) -> void:
	var reach: float = _reach()
	var from: Vector3 = Vector3(2.55 * sin(turn), 1.15, 2.55 * cos(turn)) * reach
	var high: float = tree.get_aabb().size.y
	stage.look(from, Vector3(0.0, 0.3 * high, 0.0), 36.0)


## Where a photo was taken, with its lens.
func stand_at(stage: Stage, view: int) -> void:
	var size: Vector2 = views[view]["size"]
	var focal: float = views[view]["focal"]
	var principal: Vector2 = views[view]["principal"]
	var near: float = 0.1
	var off: Vector2 = (
		Vector2(size.x * 0.5 - principal.x, principal.y - size.y * 0.5) * near / focal
	)
	stage.camera.transform = views[view]["transform"]
	stage.camera.set_frustum(near * size.y / focal, off, near, 1000.0)


# How far from the tree the photos were taken.
func _reach() -> float:
	var reach: float = 0.0
	for view: Dictionary in views:
		var place: Transform3D = view["transform"]
		reach = maxf(reach, Vector2(place.origin.x, place.origin.z).length())
	return reach
