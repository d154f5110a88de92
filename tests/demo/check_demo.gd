extends SceneTree
## Checks what ./dev demo left in a folder: the scene, the picture, the models, the report.
##
##     godot --headless --path project --script tests/demo/check_demo.gd -- FOLDER

const SCENE: String = "res://demo/result/tree.tscn"
const FILES: PackedStringArray = ["tree.glb", "tree.obj", "report.json", "preview.png"]
const LIMIT_FRAMES: int = 2000
# A cell shows something if more of its pixels than this differ from those at its edge.
const LEAST_SHARE: float = 0.002

var _folder: String
var _passed: int = 0
var _failed: int = 0


func _initialize() -> void:
	_run.call_deferred()


func _run() -> void:
	_folder = OS.get_cmdline_user_args()[0]
	for file: String in FILES:
		_check(FileAccess.file_exists(_folder.path_join(file)), file + " is there")
	_check_report()
	_check_picture()
	_check_model()
	await _check_scene()
	print("%d passed, %d failed" % [_passed, _failed])
	quit(1 if _failed > 0 else 0)


func _check(condition: bool, what: String) -> void:
	if condition:
		_passed += 1
	else:
		_failed += 1
	print(("ok      " if condition else "FAILED  ") + what)


func _check_report() -> void:
	var text: String = FileAccess.get_file_as_string(_folder.path_join("report.json"))
	var report: Variant = JSON.parse_string(text)
	_check(report is Dictionary, "report.json is JSON")
	if not report is Dictionary:
		return
	_check(report.get("points", 0) > 1000, "the report counts points")
	_check(report.get("nodes", 0) > 100, "the report counts nodes")
	_check(report.get("triangles", 0) > 1000, "the report counts triangles")
	_check(report.get("leaves", 0) > 100, "the report counts leaves")
	var height: float = report.get("height_m", 0.0)
	_check(height > 3.0 and height < 40.0, "the height is a tree's")
	var diameter: Variant = report.get("dbh_m")
	_check(diameter is float and diameter > 0.03 and diameter < 2.0, "the diameter is a tree's")
	_check(report.get("crown_radius_m", 0.0) > 0.3, "the crown has a radius")
	var stages: Variant = report.get("stages")
	_check(stages is Array and stages.size() > 3, "the report times its stages")
	_check(report.get("warnings") is Array, "the report has a list of warnings")


# Nine pictures, each with something in it. The cells are found by their even paper-coloured gaps.
func _check_picture() -> void:
	var picture: Image = Image.load_from_file(_folder.path_join("preview.png"))
	_check(picture != null and picture.get_width() >= 1500, "preview.png is a picture")
	if picture == null:
		return
	var paper: Color = picture.get_pixel(2, 2)
	var rows: Array[Vector2i] = _runs(
		picture, paper, Rect2i(Vector2i.ZERO, picture.get_size()), true
	)
	_check(rows.size() == 2, "the picture has two rows")
	var wanted: Array[int] = [5, 4]
	for i: int in mini(rows.size(), 2):
		var strip: Rect2i = Rect2i(0, rows[i].x, picture.get_width(), rows[i].y - rows[i].x)
		var cells: Array[Vector2i] = _runs(picture, paper, strip, false)
		_check(cells.size() == wanted[i], "row %d has %d pictures" % [i + 1, wanted[i]])
		for cell: Vector2i in cells:
			var area: Rect2i = Rect2i(cell.x, rows[i].x, cell.y - cell.x, strip.size.y)
			var share: float = _drawn_share(picture, area)
			_check(
				share > LEAST_SHARE and share < 0.9,
				"something is drawn at %s (%.1f %%)" % [area.position, share * 100.0]
			)


# Where lines (rows if `across`, else columns) of `area` hold more than paper: [first, end) of each
# run longer than 100 pixels.
func _runs(picture: Image, paper: Color, area: Rect2i, across: bool) -> Array[Vector2i]:
	var runs: Array[Vector2i] = []
	var length: int = area.size.y if across else area.size.x
	var width: int = area.size.x if across else area.size.y
	var first: int = -1
	for line: int in length + 1:
		var filled: int = 0
		if line < length:
			for at: int in range(0, width, 3):
				var place: Vector2i = Vector2i(at, line) if across else Vector2i(line, at)
				var color: Color = picture.get_pixelv(area.position + place)
				filled += 1 if not color.is_equal_approx(paper) else 0
		var is_picture: bool = filled * 3 > width * 0.9
		if is_picture and first < 0:
			first = line
		elif not is_picture and first >= 0:
			if line - first > 100:
				var offset: int = area.position.y if across else area.position.x
				runs.append(Vector2i(first, line) + Vector2i.ONE * offset)
			first = -1
	return runs


# How many pixels of the cell's middle differ from those of their line's end by more than a shade.
func _drawn_share(picture: Image, cell: Rect2i) -> float:
	var drawn: int = 0
	var all: int = 0
	for y: int in range(cell.position.y + 70, cell.end.y - 12, 2):
		var backdrop: Color = picture.get_pixel(cell.position.x + 4, y)
		for x: int in range(cell.position.x + 20, cell.end.x - 20, 2):
			var color: Color = picture.get_pixel(x, y)
			var away: float = absf(color.r - backdrop.r) + absf(color.g - backdrop.g)
			drawn += 1 if away + absf(color.b - backdrop.b) > 0.35 else 0
			all += 1
	return drawn / maxf(all, 1.0)


func _check_model() -> void:
	var document: GLTFDocument = GLTFDocument.new()
	var state: GLTFState = GLTFState.new()
	var error: Error = document.append_from_file(_folder.path_join("tree.glb"), state)
	_check(error == OK, "the engine reads tree.glb")
	if error != OK:
		return
	var scene: Node = document.generate_scene(state)
	var surfaces: PackedStringArray = []
	var level: MeshInstance3D = scene.find_child("Tree_LOD0", true, false) as MeshInstance3D
	if level != null:
		for i: int in level.mesh.get_surface_count():
			surfaces.append(level.mesh.surface_get_material(i).resource_name)
	var wanted: PackedStringArray = ["bark", "leaves"]
	_check(surfaces == wanted, "tree.glb has bark and leaves: %s" % [surfaces])
	scene.free()


func _check_scene() -> void:
	var text: String = FileAccess.get_file_as_string(SCENE)
	_check(not "ArrayMesh" in text, "tree.tscn holds the tree, not its mesh")
	var scene: PackedScene = load(SCENE) as PackedScene
	_check(scene != null, "the engine opens tree.tscn")
	if scene == null:
		return
	var instance: TreeInstance3D = scene.instantiate() as TreeInstance3D
	_check(instance != null, "tree.tscn is a TreeInstance3D")
	if instance == null:
		return
	root.add_child(instance)
	for frame: int in LIMIT_FRAMES:
		if not instance.is_rebuilding():
			break
		await process_frame
	_check(instance.mesh != null and instance.get_triangle_count() > 1000, "the scene shows bark")
	_check(instance.get_leaf_count() > 100, "the scene shows leaves")
	instance.free()
