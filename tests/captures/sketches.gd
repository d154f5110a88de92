extends SceneTree
## Draws sketches beside the trees that they become, from the front and from the side:
##
##     godot --path project --script tests/captures/sketches.gd -- FOLDER PICTURE [NAME…]
##
## FOLDER: of sketches; PICTURE: the file to write, of NAME.json in this order, or of all.

const Stage := preload("sketch_stage.gd")
const _SIZE: Vector2i = Vector2i(330, 330)
const _SUPERSAMPLING: int = 2
const _COLUMNS: int = 2
const _INK: Dictionary[String, Color] = {
	"outline": Color(0.25, 0.5, 0.2),
	"trunk": Color(0.4, 0.26, 0.15),
	"branch": Color(0.6, 0.42, 0.25)
}

var _stage: Stage = Stage.new(_SIZE * _SUPERSAMPLING, 60.0)


func _initialize() -> void:
	_draw.call_deferred()


func _draw() -> void:
	var arguments: PackedStringArray = OS.get_cmdline_user_args()
	var names: PackedStringArray = arguments.slice(2)
	if names.is_empty():
		for file: String in DirAccess.get_files_at(arguments[0]):
			names.append(file.get_basename())
	root.add_child(_stage)
	await process_frame
	var rows: Array[Image] = []
	for name: String in names:
		var maker: TreeReconstructor = TreeReconstructor.new()
		var sketch: TreeSketch = maker.load_sketch(arguments[0].path_join(name + ".json"))
		var tree: TreeReconstruction = null if sketch == null else maker.sketch_tree(sketch)
		if tree == null:
			push_error("%s: %s" % [name, maker.get_error_message()])
			quit(1)
			return
		var row: Image = Image.create_empty(_SIZE.x * 3, _SIZE.y, false, Image.FORMAT_RGB8)
		_put(row, await _paper(sketch, maker.get_report()["strokes"]), 0)
		_stage.shown.reconstruction = tree
		await _stage.shown.rebuilt
		_put(row, await _look(tree, 0.0), 1)
		_put(row, await _look(tree, 0.5 * PI), 2)
		rows.append(row)
		print(name, ": ", tree.get_node_count(), " nodes")
	var columns: int = mini(_COLUMNS, rows.size())
	var lines: int = ceili(float(rows.size()) / columns)
	var sheet: Image = Image.create_empty(
		_SIZE.x * 3 * columns, _SIZE.y * lines, false, Image.FORMAT_RGB8
	)
	sheet.fill(Color.WHITE)
	for i: int in rows.size():
		var place: Vector2i = Vector2i(
			i % columns * _SIZE.x * 3, floori(float(i) / columns) * _SIZE.y
		)
		sheet.blit_rect(rows[i], Rect2i(Vector2i.ZERO, rows[i].get_size()), place)
	if arguments[1].get_extension() == "jpg":
		sheet.save_jpg(arguments[1], 0.9)
	else:
		sheet.save_png(arguments[1])
	quit()


func _put(row: Image, picture: Image, column: int) -> void:
	row.blit_rect(picture, Rect2i(Vector2i.ZERO, _SIZE), Vector2i(column * _SIZE.x, 0))


func _look(tree: TreeReconstruction, turn: float) -> Image:
	var box: AABB = tree.get_aabb()
	var size: float = maxf(box.size.y * 1.12, maxf(box.size.x, box.size.z) * 1.08)
	_stage.camera.size = size
	var middle: Vector3 = Vector3(box.get_center().x, 0.47 * size, box.get_center().z)
	# A little from above, so that the ground is seen.
	var way: Vector3 = Vector3(sin(turn), 0.12, cos(turn)).normalized()
	_stage.camera.position = middle + 100.0 * way
	_stage.camera.look_at_from_position(_stage.camera.position, middle)
	for frame: int in 4:
		await process_frame
	_stage.render_target_update_mode = SubViewport.UPDATE_ONCE
	await process_frame
	await RenderingServer.frame_post_draw
	var picture: Image = _stage.get_texture().get_image()
	picture.resize(_SIZE.x, _SIZE.y, Image.INTERPOLATE_LANCZOS)
	picture.convert(Image.FORMAT_RGB8)
	return picture


# The strokes in the colors of what they were taken for.
func _paper(sketch: TreeSketch, readings: Array) -> Image:
	var paper: SubViewport = SubViewport.new()
	paper.size = _SIZE * _SUPERSAMPLING
	paper.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	var sheet: ColorRect = ColorRect.new()
	sheet.color = Color(0.98, 0.97, 0.93)
	sheet.size = paper.size
	paper.add_child(sheet)
	var scale: float = paper.size.y / sketch.canvas_size.y
	for i: int in sketch.strokes.size():
		var line: Line2D = Line2D.new()
		line.width = 3.5
		line.joint_mode = Line2D.LINE_JOINT_ROUND
		line.antialiased = true
		line.default_color = _INK.get(readings[i]["role"], Color.RED)
		var points: PackedVector2Array = sketch.strokes[i]["points"]
		for k: int in points.size():
			points[k] *= scale
		line.points = points
		paper.add_child(line)
	root.add_child(paper)
	await process_frame
	await RenderingServer.frame_post_draw
	var picture: Image = paper.get_texture().get_image()
	paper.queue_free()
	picture.resize(_SIZE.x, _SIZE.y, Image.INTERPOLATE_LANCZOS)
	picture.convert(Image.FORMAT_RGB8)
	return picture
