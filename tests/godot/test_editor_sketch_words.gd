extends "./session_suite.gd"
## What is said of sketches, in the editor's languages.

const Translations: GDScript = preload(
	"res://addons/tree_reconstruction/editor/translations/part.gd"
)
const Sentences: GDScript = preload(
	"res://addons/tree_reconstruction/editor/translations/sentences.gd"
)
const SketchPanel := preload("res://addons/tree_reconstruction/editor/sketch/sketch_panel.gd")
const TestSketch := preload("./test_sketch.gd")

const _DOMAIN: StringName = &"tree_reconstruction_sketch_test"
const _LANGUAGES: PackedStringArray = ["ja", "zh_CN", "zh_TW"]
const _BASE: Vector2 = Vector2(500.0, 960.0)
const _TOP: Vector2 = Vector2(505.0, 260.0)
const _HEAD: String = '{"format": "treerec sketch", "version": 1, '

# English sentences that were said.
var _heard: PackedStringArray = []

# --- strokes --------------------------------------------------------------------------------------


func test_faults_and_remarks_are_translated() -> void:
	var crown: PackedVector2Array = _circle(Vector2(500.0, 350.0), 290.0)
	var trunk: PackedVector2Array = _line(_BASE, _TOP)
	var left: PackedVector2Array = _line(Vector2(502.0, 540.0), Vector2(320.0, 330.0))
	var twig: PackedVector2Array = _line(Vector2(411.0, 435.0), Vector2(310.0, 430.0))
	var twig_of_twig: PackedVector2Array = _line(Vector2(360.0, 432.0), Vector2(330.0, 500.0))
	var second: PackedVector2Array = _line(Vector2(800.0, 960.0), Vector2(800.0, 300.0))
	var dot: PackedVector2Array = [Vector2(600.0, 600.0)]
	# Most of a ring, and back across it again and again.
	var there_and_back: PackedVector2Array = _circle(Vector2(500.0, 350.0), 250.0).slice(0, 50)
	for i: int in range(there_and_back.size() - 1, -1, -1):
		var out: Vector2 = (there_and_back[i] - Vector2(500.0, 350.0)).normalized()
		there_and_back.append(there_and_back[i] + out * (12.0 if i % 4 < 2 else -12.0))
	var ground: PackedVector2Array = _line(Vector2(200.0, 968.0), Vector2(800.0, 962.0))
	var far: PackedVector2Array = _line(Vector2(650.0, 500.0), Vector2(740.0, 320.0))
	var short_one: PackedVector2Array = _line(Vector2(720.0, 420.0), Vector2(735.0, 405.0))
	var lollipop: PackedVector2Array = _line(_BASE, Vector2(500.0, 600.0))
	lollipop.append_array(_circle(Vector2(500.0, 350.0), 250.0, PI))
	var low_trunk: PackedVector2Array = _line(_BASE, Vector2(500.0, 800.0))
	var outline: int = TreeSketch.ROLE_OUTLINE
	var stem: int = TreeSketch.ROLE_TRUNK

	var wanted: Dictionary[String, Array] = {
		"only a dot": [crown, trunk, left, dot],
		"is a further one": [[trunk, stem], [left, stem], [second, stem], [crown, outline]],
		"does not stand beside": [[trunk, stem], [left, stem], [crown, outline]],
		"lies within the crown's": [crown, trunk, left, _circle(Vector2(600.0, 300.0), 75.0)],
		"a second outline": [crown, trunk, left, _circle(Vector2(900.0, 880.0), 75.0)],
		"is a small ring": [crown, trunk, left, _circle(Vector2(900.0, 930.0), 40.0)],
		"runs to and fro": [[there_and_back, outline], trunk, left],
		"outline encloses nothing": [[_line(_BASE, _TOP), outline], trunk, left],
		"looks like the ground": [crown, trunk, left, ground],
		"a branch of a branch": [crown, trunk, left, twig, twig_of_twig],
		"is short and begins": [crown, trunk, left, short_one],
		"begins far from": [crown, trunk, left, far],
		"goes right through": [crown, trunk, _line(Vector2(320.0, 420.0), Vector2(660.0, 460.0))],
		"This branch leaves": [crown, trunk, _line(Vector2(502.0, 500.0), Vector2(900.0, 700.0))],
		"The trunk leaves": [crown, _line(_BASE, Vector2(500.0, 20.0)), left],
		"ends below the crown": [crown, low_trunk],
		"in one stroke": [lollipop],
		"No trunk was drawn": [crown],
		"No outline of the crown": [trunk, left],
	}
	for part: String in wanted:
		var worker: TreeReconstructor = TreeReconstructor.new()
		worker.sketch_tree(_sketch_of(wanted[part]))
		_hear(worker)
		_check_heard(part)
	var wide: TreeSketch = _sketch_of([crown, trunk])
	for i: int in 16:
		var base: Vector2 = _BASE.lerp(_TOP, 0.5 + 0.03 * i)
		wide.add_stroke(_line(base, base + Vector2(150.0 if i % 2 == 0 else -150.0, -60.0)))
	wide.depth = TreeSketch.DEPTH_PAPER
	var paper: TreeReconstructor = TreeReconstructor.new()
	paper.sketch_tree(wide)
	_hear(paper)
	_check_heard("16 branches")
	_check_all_translated()


func test_why_there_is_no_tree_is_translated() -> void:
	var sketches: Dictionary[String, TreeSketch] = {
		"Nothing is drawn yet": TreeSketch.new(),
		"only dots": _sketch_of([PackedVector2Array([Vector2(5.0, 5.0)])]),
		"looks like a trunk": _sketch_of([_line(Vector2(10.0, 500.0), Vector2(900.0, 500.0))]),
		"'baobab'": TestSketch.small_sketch(),
		"a fifth of": TestSketch.small_sketch(),
		"strokes; at most": TestSketch.small_sketch(),
		"100 times as long": TestSketch.small_sketch(),
		"more than 100 canvases": TestSketch.small_sketch(),
		"a pressure that is not": TestSketch.small_sketch(),
	}
	sketches["'baobab'"].species = "baobab"
	sketches["a fifth of"].height = 1.0
	sketches["a fifth of"].trunk_radius = 5.0
	for i: int in 1000:
		sketches["strokes; at most"].add_stroke(PackedVector2Array([Vector2(i, 1.0)]))
	sketches["100 times as long"].canvas_size = Vector2(1.0, 1000.0)
	sketches["more than 100 canvases"].add_stroke(_line(_BASE, Vector2(1e6, 0.0)))
	sketches["a pressure that is not"].add_stroke(
		PackedVector2Array([_BASE, _TOP]), PackedFloat32Array([0.5, 2.0])
	)
	for part: String in sketches:
		var worker: TreeReconstructor = TreeReconstructor.new()
		check(worker.sketch_tree(sketches[part]) == null, "A tree in spite of '%s'." % part)
		_hear(worker)
		_check_heard(part)
	_check_all_translated()


# --- files ----------------------------------------------------------------------------------------


func test_what_is_wrong_with_a_file_is_translated() -> void:
	var stroke: String = _HEAD + '"strokes": [{"points": [[1, 2]]}, %s]}'
	var svg: String = "<svg viewBox='0 0 9 9'>%s</svg>"
	var files: Dictionary[String, String] = {
		"is empty": "",
		"is no sketch: neither": "words",
		"a kind that can't be read": "GIF89a",
		"wrong or missing in line 2": '{"format":\n "treerec',
		"does not begin with {": "{}",
		"its format is 'other'": '{"format": "other", "version": 1}',
		"does not tell the version": '{"format": "treerec sketch"}',
		"a newer version": '{"format": "treerec sketch", "version": 2, "strokes": []}',
		"no list of 'strokes'": _HEAD + '"seed": 1}',
		"a 'canvas'": _HEAD + '"canvas": 5, "strokes": []}',
		"a canvas whose sides": _HEAD + '"canvas": [0, 5], "strokes": []}',
		"is not from 0 to 200 metres": _HEAD + '"height": -1, "strokes": []}',
		"a 'height' that is no number": _HEAD + '"height": "1", "strokes": []}',
		"a 'species'": _HEAD + '"species": 1, "strokes": []}',
		"a 'seed'": _HEAD + '"seed": -1, "strokes": []}',
		"lists in lists": _HEAD + '"strokes": %s}' % ("[".repeat(50) + "]".repeat(50)),
		"a number that is too large": stroke % '{"points": [[1, 1e999]]}',
		'is no {"points": ...}': stroke % "7",
		"number 2, that has no points": stroke % '{"points": []}',
		"point 1 is not [x, y]": stroke % '{"points": [[1]]}',
		"that has 2 pressures for 1": stroke % '{"points": [[1, 2]], "pressure": [1, 1]}',
		"not from 0 to 1": stroke % '{"points": [[1, 2]], "pressure": [1.5]}',
		"'pressure' is no list": stroke % '{"points": [[1, 2]], "pressure": 1}',
		"a pressure that is no number": stroke % '{"points": [[1, 2]], "pressure": ["a"]}',
		"'role' is no text": stroke % '{"points": [[1, 2]], "role": 1}',
		"and not 'root'": stroke % '{"points": [[1, 2]], "role": "root"}',
		"whose 'id'": stroke % '{"points": [[1, 2]], "id": -4}',
		"begins with <html>": "<html><body/></html>",
		"it has no <svg>": "<!-- tree -->",
		"shows no lines": "<svg/>",
		"its <svg> does not end": "<svg><path d='M1 1L9 9'/>",
		"it ends in the middle of an element": "<svg><path d='M1 1L9 9'",
		"it ends in the middle of an attribute": "<svg><path d='M1 1L9 9/></svg>",
		"an attribute has no quotes": "<svg><path d=M1/></svg>",
		"a comment does not end": "<svg><!-- </svg>",
		"a CDATA section does not end": "<svg><![CDATA[ </svg>",
		"its document type does not end": "<!DOCTYPE svg [ <svg></svg>",
		"attributes cannot be told apart": "<svg><path 'a' d='M1 1'/></svg>",
		"a transform": svg % "<path transform='turn(3)' d='M0 0L1 1'/>",
		"a viewBox": "<svg viewBox='0 0 10'><path d='M0 0L1 1'/></svg>",
		"whose x1 is no length": svg % "<line x1='a' y1='1' x2='3'/>",
		"from its character 9 on": svg % "<path d='M1 1L9 9X3'/>",
		"pairs of numbers": svg % "<polyline points='1 2 3'/>",
		"1000 deep": "<svg>" + "<g>".repeat(1200),
		"more than 1000 lines": svg % "<path d='M1 1L9 9'/>".repeat(1001),
	}
	var bytes: Dictionary[String, PackedByteArray] = {
		"is compressed": PackedByteArray([0x1f, 0x8b, 8, 0]),
		"UTF-16": PackedByteArray([0xff, 0xfe, 60, 0]),
		"is a picture that is damaged": PackedByteArray([0x89, 0x50, 0x4e, 0x47, 13, 10]),
		"nearly one color": Image.create(200, 200, false, Image.FORMAT_RGB8).save_png_to_buffer(),
		"has filled areas": _picture(Rect2i(100, 40, 90, 220)).save_png_to_buffer(),
		"only specks": _picture(Rect2i(100, 100, 1, 1)).save_png_to_buffer(),
	}
	for part: String in files:
		bytes[part] = files[part].to_utf8_buffer()
	for part: String in bytes:
		var path: String = folder.path_join("a sketch.bin")
		FileAccess.open(path, FileAccess.WRITE).store_buffer(bytes[part])
		var worker: TreeReconstructor = TreeReconstructor.new()
		check(worker.load_sketch(path) == null, "Strokes in spite of '%s'." % part)
		_hear(worker)
		_check_heard(part)
	var reader: TreeReconstructor = TreeReconstructor.new()
	check(reader.load_sketch(folder) == null, "A folder is read.")
	_hear(reader)
	_check_heard("is a folder")
	_check_all_translated()


# --- the window -----------------------------------------------------------------------------------


func test_the_window_speaks_the_editor_s_language() -> void:
	Translations.fill(TranslationServer.get_or_add_domain(_DOMAIN), "ja")
	var session: Session = _session_with(null)
	var node: TreeInstance3D = session.node
	session.edit_node(null)
	session.set_translation_domain(_DOMAIN)
	var panel: SketchPanel = SketchPanel.new(session)
	tree.root.add_child(panel)
	await tree.process_frame
	var shown: Dictionary[String, TreeSketch] = {
		"これは点にすぎません。線を描いてください。": TestSketch.small_sketch(),
		"幹が描かれていないため、まっすぐな幹を作りました。": _sketch_of([_circle(Vector2(500.0, 350.0), 290.0)]),
		"地面から上へ幹を、そして枝を何本かと樹冠の輪郭を。": _sketch_of([PackedVector2Array([_BASE])]),
	}
	shown.values()[0].add_stroke(PackedVector2Array([Vector2(600.0, 600.0)]))
	for sentence: String in shown:
		panel.files.loaded.emit(shown[sentence], PackedStringArray(["strokes"]))
		await _rest(session, panel)
		check(sentence in panel.message.text, "The window says: %s" % panel.message.text)
		session.edit_node(null)
		panel.set_node(null)
	panel.files.read(write_text("words.svg", "words"))
	await _rest(session, panel)
	check("スケッチではありません" in panel.message.text, "Of a file it says: %s" % panel.message.text)
	check("スケッチではありません" in _said[-1], "Of a file is said: %s" % _said[-1])
	var species: OptionButton = panel.options.species
	for i: int in species.item_count:
		var title: String = species.get_item_text(i)
		check(species.atr(title) != title, "The species %s is not translated." % title)
		check(species.get_popup().atr(title) != title, "In its list %s is not translated." % title)
	panel.close()
	panel.free()
	session.shut_down()
	_undo.clear_history()
	_undo.free()
	node.free()
	TranslationServer.remove_domain(_DOMAIN)


func _rest(session: Session, panel: SketchPanel) -> void:
	for i: int in 4:
		session.update()
		panel.update()
		await tree.process_frame
		while not session.jobs.get_running().is_empty():
			session.update()
			panel.update()
			await tree.process_frame


# --- how it is checked ----------------------------------------------------------------------------


# What a worker said of strokes.
func _hear(worker: TreeReconstructor) -> void:
	var error: String = worker.get_error_message()
	if not error.is_empty():
		_heard.append(error)
	var report: Dictionary = worker.get_report()
	for stroke: Dictionary in report.get("strokes", []):
		if stroke["fault"] != "":
			_heard.append(stroke["fault"])
	_heard.append_array(PackedStringArray(report.get("remarks", [])))


func _check_heard(part: String) -> void:
	for sentence: String in _heard:
		if part in sentence:
			return
	check(false, "Nobody says '%s', but: %s" % [part, _heard.slice(-3)])


# A clause within is translated, too.
func _check_all_translated() -> void:
	for language: String in _LANGUAGES:
		Translations.fill(TranslationServer.get_or_add_domain(_DOMAIN), language)
		for sentence: String in _heard:
			check_sentence(sentence, "what is said")
			var told: String = Sentences.translate(sentence, _DOMAIN)
			check(told != sentence, "%s: %s" % [language, told])
			for word: String in [" is ", " has ", " does ", " an ", " the ", "The "]:
				check(not word in told, "%s: %s" % [language, told])
			check(not "%s" in told, "%s: %s" % [language, told])
	TranslationServer.remove_domain(_DOMAIN)


# Lines, or lines with the roles that the user gives them.
static func _sketch_of(strokes: Array) -> TreeSketch:
	var sketch: TreeSketch = TreeSketch.new()
	for stroke: Variant in strokes:
		if stroke is PackedVector2Array:
			sketch.add_stroke(stroke)
		else:
			var id: int = sketch.add_stroke(stroke[0])
			sketch.set_stroke_role(id, stroke[1])
	sketch.height = 8.0
	return sketch


static func _line(from: Vector2, to: Vector2) -> PackedVector2Array:
	var points: PackedVector2Array = []
	for i: int in 41:
		points.append(from.lerp(to, i / 40.0))
	return points


static func _circle(middle: Vector2, radius: float, start: float = 0.0) -> PackedVector2Array:
	var points: PackedVector2Array = []
	for i: int in 61:
		var angle: float = start + TAU * i / 60.0
		points.append(middle + radius * Vector2(sin(angle), -cos(angle)))
	return points


# White paper with one black area.
static func _picture(black: Rect2i) -> Image:
	var picture: Image = Image.create(300, 300, false, Image.FORMAT_RGB8)
	picture.fill(Color.WHITE)
	picture.fill_rect(black, Color.BLACK)
	return picture
