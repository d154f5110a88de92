@tool
extends RefCounted
## Tells which files are scans, and reads and writes the small files ([code].treescan[/code]) that
## stand for scans whose extension belongs to other files too.

## What holds nothing but scans. E57 for the sentence that says how to convert it.
const SCANS: PackedStringArray = ["ply", "las", "laz", "pcd", "xyz", "pts", "asc", "e57"]
## What holds nothing but skeletons. A PLY file may hold one too.
const SKELETONS: PackedStringArray = ["swc", "mtg", "lstring", "treefile"]
## The extension of the file that stands for a scan.
const STAND_IN: String = "treescan"

const _SAMPLE: int = 16384
const _ROWS: int = 50
const _LEAST_POINTS: float = 300.0
const _COORDINATES: Array[Array] = [
	["x", "easting", "east", "coordx", "xcoord", "points0"],
	["y", "northing", "north", "coordy", "ycoord", "points1"],
	["z", "elevation", "altitude", "height", "coordz", "zcoord", "points2"],
]
# Columns of skeletons and cylinder models, which are no clouds.
const _NOT_OF_CLOUDS: PackedStringArray = ["radius", "parent", "parentid", "length", "startx"]


## Whether the file holds a skeleton: by its extension, or a PLY file by its edges.
static func is_skeleton(path: String) -> bool:
	var extension: String = path.get_extension().to_lower()
	if extension in SKELETONS:
		return true
	if extension != "ply":
		return false
	var file: FileAccess = FileAccess.open(path, FileAccess.READ)
	if file == null or file.get_line().strip_edges() != "ply":
		return false
	# A header is short; a line of a damaged file may be long.
	while file.get_position() < _SAMPLE and not file.eof_reached():
		var line: String = file.get_line().strip_edges()
		if line.begins_with("element edge"):
			return not line.ends_with(" 0")
		if line == "end_header":
			return false
	return false


## The scan that a [code].treescan[/code] file stands for, as "scan", or "error": why there is
## none.
static func read_stand_in(path: String) -> Dictionary:
	var config: ConfigFile = ConfigFile.new()
	var error: Error = config.load(path)
	if error != OK:
		return {
			"error": "'%s' cannot be read as a list of settings: %s." % [path, error_string(error)]
		}
	var named: Variant = config.get_value("scan", "path", "")
	if not named is String or (named as String).is_empty():
		return {"error": "'%s' names no scan. Write: [scan] path=\"FILE\"." % path}
	var scan: String = named
	if scan.is_relative_path():
		scan = path.get_base_dir().path_join(scan).simplify_path()
	if not FileAccess.file_exists(scan):
		return {"error": "'%s' stands for '%s', which is not there (any more)." % [path, scan]}
	return {"scan": scan}


## Writes a file that stands for the scan. The path in it is relative, so that both can be moved.
static func write_stand_in(path: String, scan: String) -> Error:
	var folder: String = path.get_base_dir().trim_suffix("/") + "/"
	var config: ConfigFile = ConfigFile.new()
	config.set_value("scan", "path", scan.trim_prefix(folder))
	return config.save(path)


## Whether a text file is a point cloud, by its first lines. Any thread.
static func is_text_cloud(path: String) -> bool:
	var file: FileAccess = FileAccess.open(path, FileAccess.READ)
	if file == null:
		return false
	var bytes: PackedByteArray = file.get_buffer(_SAMPLE)
	if bytes.has(0):
		return false
	for i: int in bytes.size():
		if bytes[i] > 126:
			bytes[i] = 63  # letters of headers and comments
	var lines: PackedStringArray = bytes.get_string_from_ascii().split("\n", false)
	if lines.size() > 1 and file.get_length() > bytes.size():
		lines.remove_at(lines.size() - 1)  # cut off
	var points: float = float(lines.size()) * file.get_length() / maxf(bytes.size(), 1.0)
	return points >= _LEAST_POINTS and _are_points(lines)


static func _are_points(lines: PackedStringArray) -> bool:
	var rows: Array[PackedFloat64Array] = []
	var others: int = 0
	var fractions: int = 0
	for line: String in lines:
		var words: PackedStringArray = _words(line)
		if words.is_empty() or line.begins_with("#") or line.begins_with("//"):
			continue
		var row: PackedFloat64Array = _row(words)
		if row.is_empty() and rows.is_empty():
			if not _is_header_of_points(words):
				return false
			continue
		# A few damaged lines make no other file of it.
		if row.size() < 3 or (not rows.is_empty() and row.size() != rows[0].size()):
			others += 1
			# The number of points, as PTS files begin.
			if rows.is_empty() and row.size() != 1:
				return false
			continue
		fractions += int("." in words[0] and "." in words[1])
		rows.append(row)
		if rows.size() == _ROWS:
			break
	# Tables of whole numbers are data of another kind.
	if rows.size() < _ROWS or others * 10 > _ROWS or fractions * 10 < _ROWS * 6:
		return false
	return not _is_series(rows) and _varies(rows)


static func _words(line: String) -> PackedStringArray:
	for separator: String in [",", ";", "\t", '"', "\r"]:
		line = line.replace(separator, " ")
	return line.split(" ", false)


# The numbers of a line; none if its first three words are not all numbers.
static func _row(words: PackedStringArray) -> PackedFloat64Array:
	var row: PackedFloat64Array = []
	for i: int in words.size():
		if words[i].is_valid_float():
			row.append(words[i].to_float())
		elif i < 3:
			return []
		else:
			row.append(NAN)
	return row


# A line of words above the points either names coordinates or is a title.
static func _is_header_of_points(words: PackedStringArray) -> bool:
	var names: PackedStringArray = []
	for word: String in words:
		var plain: String = ""
		for letter: String in word.to_lower():
			if (letter >= "a" and letter <= "z") or (letter >= "0" and letter <= "9"):
				plain += letter
		if plain in _NOT_OF_CLOUDS:
			return false
		names.append(plain)
	for known: Array in _COORDINATES:
		var found: bool = false
		for name: String in names:
			found = found or name in known
		if not found:
			return false
	return true


# A first column that counts on in even steps is time, not a place.
static func _is_series(rows: Array[PackedFloat64Array]) -> bool:
	var step: float = rows[1][0] - rows[0][0]
	var even: int = 0
	for i: int in range(1, rows.size()):
		even += int(absf(rows[i][0] - rows[i - 1][0] - step) <= 0.02 * absf(step))
	return step != 0.0 and even * 10 >= rows.size() * 8


static func _varies(rows: Array[PackedFloat64Array]) -> bool:
	var varied: int = 0
	for axis: int in 3:
		var values: Dictionary[float, bool] = {}
		for row: PackedFloat64Array in rows:
			values[row[axis]] = true
		varied += int(values.size() > 10)
	return varied >= 2
