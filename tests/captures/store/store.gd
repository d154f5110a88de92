extends SceneTree
## Draws what docs/store/ shows: see make_store.sh, which calls it with what to draw, a file or
## folder to write, and what that needs. Needs a window.
##
##     godot --path project --script tests/captures/store/store.gd -- tree OUT.png SCAN LEAVES
##         … photos OUT.png CLOUD.ply PHOTOS         the ring of photos around their points
##         … same OUT.jpg CLOUD.ply PHOTOS LEAVES    a photo, and the tree from the same place
##         … forest OUT.png SCAN LEAVES [SCAN LEAVES…]
##         … stages FOLDER SCAN LEAVES               points, skeleton, bark and leaves, for the film
##         … foot OUT.jpg IN.png NUMBER TITLE TEXT   the picture with words on it
##         … head OUT.jpg IN.png NUMBER TITLE TEXT   the picture below words
##         … card OUT.png ICON.png TITLE TEXT        the icon beside words
##         … icon ICON.svg FOLDER

const Stage := preload("./stage.gd")
const Caption := preload("./caption.gd")
const Ring := preload("./ring.gd")
const Wood := preload("./wood.gd")
const Plots := preload("res://demo/plots.gd")
const SIZE: Vector2i = Vector2i(1600, 900)
# Metres between points: finer, and noise of quick matching counts.
const SPACING: float = 0.02
const INSET: Vector2i = Vector2i(400, 300)
# Which of the photos, of the way around.
const VIEW: float = 0.9
const FILM: Vector2i = Vector2i(1280, 720)
# What the film shows of the tree, one after another.
const STAGES: PackedStringArray = ["Points", "Skeleton", "Bark", "Leaves"]
const TELLING: PackedStringArray = [
	"What a scanner saw of a tree in a street",
	"Trunk, branches and twigs, each of which can be edited",
	"One surface, with wind in it",
	"Of thirteen kinds, or of your own rule, in any season",
]

var _words: PackedStringArray


func _initialize() -> void:
	_run.call_deferred()


func _run() -> void:
	_words = OS.get_cmdline_user_args()
	TreeInstance3D.threaded = false
	var drawn: bool = false
	match _words[0] if not _words.is_empty() else "":
		"tree":
			drawn = await _draw_tree()
		"photos":
			drawn = await _draw_photos()
		"same":
			drawn = await _draw_same()
		"forest":
			drawn = await _draw_forest()
		"stages":
			drawn = await _draw_stages()
		"foot", "head":
			drawn = await _caption()
		"card":
			var icon: Image = Image.load_from_file(_words[2])
			drawn = save(await Caption.card(self, FILM, icon, _words[3], _words[4]), _words[1])
		"icon":
			drawn = _draw_icon()
		_:
			printerr("store.gd does not know what to draw.")
	quit(0 if drawn else 1)


# The whole tree from eye level, and beside it its bark and its leaves from near.
func _draw_tree() -> bool:
	var tree: TreeReconstruction = read(_words[2], _words[3])
	if tree == null:
		return false
	var box: AABB = tree.get_aabb()
	var stage: Stage = Stage.new(self, SIZE)
	stage.light_up(24.0, 0.3 * box.size.x)
	stage.plant(tree)
	var away: float = 1.3 * maxf(box.size.y, 0.62 * box.size.x)
	var aside: Vector3 = Vector3(0.3, 0.0, 0.95)
	var middle: Vector3 = box.get_center() * Vector3(1, 0, 1)
	var from: Vector3 = middle + aside * away + Vector3.UP * 1.5
	stage.look(from, middle + Vector3(0.2 * box.size.x, 0.43 * box.size.y, 0.0), 50.0)
	var whole: Image = await stage.picture()
	stage.viewport.size = INSET
	var high: float = minf(1.4, 0.2 * box.size.y)
	var trunk: Vector3 = Vector3.ZERO
	for id: int in tree.get_trunk_nodes():
		trunk = tree.get_node_position(id)
		if trunk.y >= high:
			break
	stage.look(trunk + aside * 0.8 + Vector3.UP * 0.1, trunk, 50.0)
	var insets: Array[Image] = [await stage.picture()]
	var sprig: Vector3 = _outermost(tree, aside)
	stage.look(sprig + (aside + 0.2 * Vector3.UP) * 1.1, sprig, 45.0)
	insets.append(await stage.picture())
	return save(await Caption.with_insets(self, whole, insets), _words[1])


# The end of a twig that is nearest to who looks from there, half way up.
static func _outermost(tree: TreeReconstruction, way: Vector3) -> Vector3:
	var middle: Vector3 = tree.get_aabb().get_center() + 0.1 * tree.get_aabb().size.y * Vector3.UP
	var best: Vector3 = middle
	var most: float = -INF
	for id: int in tree.get_node_ids():
		var place: Vector3 = tree.get_node_position(id)
		var out: float = (place - middle).dot(way) - 1.5 * absf(place.y - middle.y)
		if out > most:
			most = out
			best = place
	return best


func _draw_photos() -> bool:
	var ring: Ring = Ring.new()
	if not ring.read(_words[2], _words[3], 0.0):
		printerr(ring.message)
		return false
	var stage: Stage = Stage.new(self, SIZE)
	stage.darken()
	ring.set_up(stage)
	ring.see_from(stage, 0.9)
	return save(await stage.picture(), _words[1])


# A photo, its points, the tree and the tree in leaf, all from where that photo was taken.
func _draw_same() -> bool:
	var ring: Ring = Ring.new()
	if not ring.read(_words[2], _words[3], SPACING):
		printerr(ring.message)
		return false
	var view: int = roundi(VIEW * ring.views.size())
	var photo: Image = ring.load_photo(view, 1200)
	if photo == null:
		return false
	var size: Vector2i = photo.get_size()
	var dark: Stage = Stage.new(self, size)
	dark.darken()
	ring.show_points(dark)
	ring.stand_at(dark, view)
	var points: Image = await dark.picture()
	dark.free_all()
	var day: Stage = Stage.new(self, size)
	day.light_up(20.0, 2.0)
	ring.tree.leaf_preset = _words[4]
	var planted: TreeInstance3D = day.plant(ring.tree)
	ring.stand_at(day, view)
	planted.leaves = false
	var bare: Image = await day.picture()
	planted.leaves = true
	var leafy: Image = await day.picture()
	# The edges of a photo without distortion are bent.
	var part: Rect2i = Rect2i(size / 14, size - size / 7)
	var pictures: Array[Image] = []
	for picture: Image in [photo, points, bare, leafy]:
		pictures.append(picture.get_region(part))
	var words: PackedStringArray = ["One of the photos", "Their points", "The tree", "In leaf"]
	var all: Image = await Caption.beside(self, pictures, words)
	all.resize(1600, roundi(1600.0 * all.get_height() / all.get_width()), Image.INTERPOLATE_LANCZOS)
	return save(all, _words[1])


func _draw_forest() -> bool:
	var wood: Wood = await _plant_wood(SIZE, 2)
	if wood == null:
		return false
	wood.stand(0.0)
	return save(await wood.stage.picture(), _words[1])


func _plant_wood(size: Vector2i, first: int) -> Wood:
	var trees: Array[TreeReconstruction] = []
	for i: int in range(first, _words.size() - 1, 2):
		var tree: TreeReconstruction = read(_words[i], _words[i + 1])
		if tree == null:
			return null
		trees.append(tree)
	var wood: Wood = Wood.new(Stage.new(self, size))
	await wood.plant(trees)
	return wood


# Points, skeleton, bark and leaves from one place, each with its words.
func _draw_stages() -> bool:
	var maker: TreeReconstructor = TreeReconstructor.new()
	var tree: TreeReconstruction = read(_words[2], _words[3], maker)
	if tree == null:
		return false
	DirAccess.make_dir_recursive_absolute(_words[1])
	var box: AABB = tree.get_aabb()
	var away: float = 1.3 * maxf(box.size.y, 0.7 * maxf(box.size.x, box.size.z))
	var from: Vector3 = Vector3(0.5 * away, 0.2 * box.size.y, 0.87 * away)
	var aim: Vector3 = Vector3(box.get_center().x, 0.45 * box.size.y, box.get_center().z)
	var dark: Stage = Stage.new(self, FILM)
	dark.darken()
	dark.look(from, aim, 50.0)
	var day: Stage = Stage.new(self, FILM)
	day.light_up(16.0, 0.3 * box.size.x)
	day.look(from, aim, 50.0)
	var cloud: Mesh = _lighter(Plots.cloud(maker.get_cloud_points(), maker.get_cloud_colors()))
	var points: MeshInstance3D = dark.show_mesh(cloud, Plots.bead_material(2.4, 0.0))
	var lines: Mesh = _lighter(Plots.segments(tree, true))
	var planted: TreeInstance3D = day.plant(tree)
	for i: int in STAGES.size():
		if i == 1:
			points.visible = false
			dark.show_mesh(lines, Plots.line_material(2.0))
		planted.leaves = i == 3
		var seen: Image = await (dark if i < 2 else day).picture()
		seen = await Caption.at_foot(self, seen, "", STAGES[i], TELLING[i])
		if not save(seen, _words[1].path_join("%d.png" % i)):
			return false
	return true


# Before a dark ground.
static func _lighter(mesh: ArrayMesh) -> ArrayMesh:
	var arrays: Array = mesh.surface_get_arrays(0)
	var colors: PackedColorArray = arrays[Mesh.ARRAY_COLOR]
	for i: int in colors.size():
		colors[i] = colors[i].lightened(0.45)
	arrays[Mesh.ARRAY_COLOR] = colors
	var light: ArrayMesh = ArrayMesh.new()
	light.add_surface_from_arrays(mesh.surface_get_primitive_type(0), arrays)
	return light


func _caption() -> bool:
	var picture: Image = Image.load_from_file(_words[2])
	if picture == null:
		return false
	var drawn: Image
	if _words[0] == "foot":
		drawn = await Caption.at_foot(self, picture, _words[3], _words[4], _words[5])
	else:
		drawn = await Caption.at_head(self, picture, _words[3], _words[4], _words[5])
	return save(drawn, _words[1])


func _draw_icon() -> bool:
	var text: String = FileAccess.get_file_as_string(_words[1])
	for size: int in [512, 256]:
		var icon: Image = Image.new()
		if icon.load_svg_from_string(text, size / 512.0) != OK:
			return false
		if not save(icon, _words[2].path_join("icon_%d.png" % size)):
			return false
	return true


## The tree of a scan, with leaves of a kind; null where it can't be made, which is printed.
static func read(
	scan: String, leaves: String, maker: TreeReconstructor = TreeReconstructor.new()
) -> TreeReconstruction:
	var tree: TreeReconstruction = maker.reconstruct_file(scan, {})
	if tree == null:
		printerr(maker.get_error_message())
	elif not leaves.is_empty():
		tree.leaf_preset = leaves
	return tree


static func save(picture: Image, path: String) -> bool:
	picture.convert(Image.FORMAT_RGBA8 if path.contains("icon") else Image.FORMAT_RGB8)
	var jpeg: bool = path.get_extension() == "jpg"
	var error: Error = picture.save_jpg(path, 0.88) if jpeg else picture.save_png(path)
	if error != OK:
		printerr("Could not write %s: %s." % [path, error_string(error)])
	return error == OK
