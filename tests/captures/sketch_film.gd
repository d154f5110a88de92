extends SceneTree
## A tree that follows the pen: replays a sketch point by point, strokes and tree side by side:
##
##     godot --path project --script tests/captures/sketch_film.gd -- SKETCH.json FOLDER
##
## FOLDER gets one picture for each step, 0000.png and so on; make_captures.sh makes a film of them.

const Stage := preload("sketch_stage.gd")
const _PART: Vector2i = Vector2i(320, 320)
const _SUPERSAMPLING: int = 1
const _STEPS: int = 40
const _LAST: int = 16
const _MOST_DEGREES: float = 360.0
const _INK: Dictionary[String, Color] = {
	"outline": Color(0.25, 0.5, 0.2),
	"trunk": Color(0.4, 0.26, 0.15),
	"branch": Color(0.6, 0.42, 0.25)
}

var _folder: String
var _count: int = 0
var _sketch: TreeSketch
var _scale: float = 1.0
var _base: Vector2
var _stage: Stage = Stage.new(_PART * _SUPERSAMPLING, 200.0)
var _paper: SubViewport = SubViewport.new()


func _initialize() -> void:
	_film.call_deferred()


func _film() -> void:
	var arguments: PackedStringArray = OS.get_cmdline_user_args()
	_folder = arguments[1]
	var maker: TreeReconstructor = TreeReconstructor.new()
	_sketch = maker.load_sketch(arguments[0])
	var whole: TreeReconstruction = null if _sketch == null else maker.sketch_tree(_sketch)
	if whole == null:
		push_error(maker.get_error_message())
		quit(1)
		return
	_read_place(maker)
	await _open_stage()
	var total: int = 0
	for stroke: Dictionary in _sketch.strokes:
		total += (stroke["points"] as PackedVector2Array).size()
	for step: int in _STEPS:
		await _keep(ceili(total * (step + 1.0) / _STEPS), 0.0)
	for step: int in _LAST:
		await _keep(-1, deg_to_rad(_MOST_DEGREES) * (step + 1.0) / _LAST)
	quit()


# Draws the first so many points and what they make; -1: the tree stays as it is.
func _keep(points: int, turn: float) -> void:
	if points >= 0:
		await _draw(points)
	_look(turn)
	_stage.render_target_update_mode = SubViewport.UPDATE_ONCE
	await process_frame
	await RenderingServer.frame_post_draw
	var picture: Image = Image.create_empty(_PART.x * 2, _PART.y, false, Image.FORMAT_RGB8)
	var column: int = 0
	for view: SubViewport in [_paper, _stage]:
		var part: Image = view.get_texture().get_image()
		part.resize(_PART.x, _PART.y, Image.INTERPOLATE_LANCZOS)
		part.convert(Image.FORMAT_RGB8)
		picture.blit_rect(part, Rect2i(Vector2i.ZERO, _PART), Vector2i(column * _PART.x, 0))
		column += 1
	picture.save_png(_folder.path_join("%04d.png" % _count))
	_count += 1


func _draw(points: int) -> void:
	var strokes: Array[Dictionary] = []
	for stroke: Dictionary in _sketch.strokes:
		var line: PackedVector2Array = stroke["points"]
		if points < 2:
			break
		var part: Dictionary = stroke.duplicate()
		part["points"] = line.slice(0, points)
		part["pressure"] = (
			(stroke.get("pressure", PackedFloat32Array()) as PackedFloat32Array).slice(0, points)
		)
		strokes.append(part)
		points -= line.size()
	var sketch: TreeSketch = _sketch.duplicate() as TreeSketch
	sketch.strokes = strokes
	var maker: TreeReconstructor = TreeReconstructor.new()
	var tree: TreeReconstruction = maker.sketch_tree(sketch)
	var readings: Array = [] if tree == null else maker.get_report()["strokes"]
	for old: Node in _paper.get_children():
		if old is Line2D:
			old.queue_free()
	var scale: float = _paper.size.y / sketch.canvas_size.y
	for i: int in strokes.size():
		var line: Line2D = Line2D.new()
		line.width = 4.0
		line.joint_mode = Line2D.LINE_JOINT_ROUND
		line.begin_cap_mode = Line2D.LINE_CAP_ROUND
		line.end_cap_mode = Line2D.LINE_CAP_ROUND
		line.antialiased = true
		var role: String = "" if readings.is_empty() else str(readings[i]["role"])
		line.default_color = _INK.get(role, Color(0.35, 0.35, 0.4))
		var drawn: PackedVector2Array = strokes[i]["points"]
		for k: int in drawn.size():
			drawn[k] *= scale
		line.points = drawn
		_paper.add_child(line)
	# What makes no tree yet leaves the last one, as the editor does.
	if tree != null:
		_read_place(maker)
		_stage.shown.reconstruction = tree
		await _stage.shown.rebuilt


func _read_place(maker: TreeReconstructor) -> void:
	var report: Dictionary = maker.get_report()
	_scale = report["metres_per_pixel"]
	_base = Vector2(report["base"][0], report["base"][1])


# As large as it was drawn, and where it was drawn: the tree stands under the pen.
func _look(turn: float) -> void:
	var size: float = _scale * _sketch.canvas_size.y
	_stage.camera.size = size
	var off: Vector2 = (0.5 * _sketch.canvas_size - _base) * _scale
	var middle: Vector3 = Vector3(off.x, -off.y, 0.0)
	_stage.camera.look_at_from_position(
		middle + 100.0 * Vector3(0.0, 0.1, 1.0).normalized(), middle
	)
	_stage.shown.rotation.y = turn


func _open_stage() -> void:
	for view: SubViewport in [_paper, _stage]:
		view.size = _PART * _SUPERSAMPLING
		root.add_child(view)
	_paper.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	var sheet: ColorRect = ColorRect.new()
	sheet.color = Color(0.98, 0.97, 0.93)
	sheet.size = _paper.size
	_paper.add_child(sheet)
	await process_frame
