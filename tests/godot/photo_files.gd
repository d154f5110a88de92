extends RefCounted
## Photos, and a program that stands in for COLMAP: it says what COLMAP 3.8 says and hands out a
## model that was made beforehand. Without a shell there is none.

const COUNT: int = 9

const _PROGRAM: String = """#!/bin/sh
here=$(dirname "$0")
if [ "$1" = -h ]; then
	echo "COLMAP 3.8 -- Structure-from-Motion and Multi-View Stereo"
	echo "              (Commit Unknown on Unknown without CUDA)"
	exit 0
fi
command=$1
shift
if [ "$1" = -h ]; then
	for name in database_path image_path image_list_path output_path; do echo "  --$name arg"; done
	exit 0
fi
database= output= list=
while [ $# -gt 0 ]; do
	case $1 in
	--database_path) database=$2 ;;
	--output_path) output=$2 ;;
	--image_list_path) list=$2 ;;
	esac
	shift 2
done
while [ -e "$here/wait_in_$command" ]; do sleep 0.05; done
case $command in
feature_extractor)
	count=$(wc -l <"$list") i=0
	while IFS= read -r name; do
		i=$((i + 1))
		printf '%s\\n' "$name" >>"$database"
		echo "Processed file [$i/$count]"
		echo "  Name:            $name"
		echo "  Features:        $((2000 + i))"
	done <"$list" ;;
*matcher | matches_importer) echo "Matching block [1/1, 1/1] in 0.1s" ;;
mapper) cp -r "$here/models"/. "$output" ;;
esac
"""

## The program.
var colmap: String
## The photos.
var photos: String

var _count: int
var _size: Vector2i
# Of the camera, in pixels.
var _focal: float
# Where the photos were taken from: how far away, and how far around.
var _away: float
var _arc: float


## Writes both into [param folder], with a model of all photos but the last.
func _init(folder: String) -> void:
	_set_camera()
	photos = folder.path_join("my photos")
	DirAccess.make_dir_recursive_absolute(photos)
	for i: int in _count:
		_picture(i).save_jpg(photos.path_join(_name(i)), 0.95)
	colmap = folder.path_join("colmap")
	write(colmap, _PROGRAM.to_utf8_buffer())
	FileAccess.set_unix_permissions(colmap, 0x1C0)
	_write_model(folder.path_join("models/0"))


# How many photos there are, and what takes them.
func _set_camera() -> void:
	_count = COUNT
	_size = Vector2i(64, 48)
	_focal = 50.0
	_away = 5.0
	_arc = 1.5 * PI


# What a photo shows.
func _picture(i: int) -> Image:
	var picture: Image = Image.create_empty(_size.x, _size.y, false, Image.FORMAT_RGB8)
	picture.fill(Color.from_hsv(float(i) / _count, 0.5, 0.6))
	return picture


## Makes [param command] of the program wait until it is let go.
func hold(command: String) -> void:
	write(_gate(command), "wait".to_utf8_buffer())


func let_go(command: String) -> void:
	DirAccess.remove_absolute(_gate(command))


## Writes a file, which is closed then.
static func write(path: String, bytes: PackedByteArray) -> void:
	var file: FileAccess = FileAccess.open(path, FileAccess.WRITE)
	file.store_buffer(bytes)
	file.close()


func _gate(command: String) -> String:
	return colmap.get_base_dir().path_join("wait_in_" + command)


## Has the photos say by GPS where the model's cameras stood, if its unit were [param unit] metres.
func tell_places(unit: float) -> void:
	for i: int in _count - 1:
		var path: String = photos.path_join(_name(i))
		var jpeg: PackedByteArray = FileAccess.get_file_as_bytes(path)
		# The model's z is down, so that north is -y.
		var east: float = _centre(i).x * unit
		var north: float = -_centre(i).y * unit
		var latitude: float = 52.0 + north / 111200.0
		var longitude: float = 13.0 + east / (111200.0 * cos(deg_to_rad(52.0)))
		var record: PackedByteArray = _exif(latitude, longitude)
		var segment: StreamPeerBuffer = StreamPeerBuffer.new()
		segment.big_endian = true
		segment.put_u16(0xFFE1)
		segment.put_u16(record.size() + 2)
		segment.put_data(record)
		write(path, jpeg.slice(0, 2) + segment.data_array + jpeg.slice(2))


# A record of TIFF with nothing but a place, in degrees north and east.
static func _exif(latitude: float, longitude: float) -> PackedByteArray:
	var record: StreamPeerBuffer = StreamPeerBuffer.new()
	record.put_data("Exif".to_ascii_buffer())
	record.put_u16(0)
	record.put_data("II".to_ascii_buffer())
	record.put_u16(42)
	record.put_u32(8)
	# The first directory points at that of the place, at 26; its fields' values are at 80 and 104.
	record.put_u16(1)
	_put_field(record, [0x8825, 4, 1, 26])
	record.put_u32(0)
	record.put_u16(4)
	for value: Array in [[1, 2, 2, 0x4E], [2, 5, 3, 80], [3, 2, 2, 0x45], [4, 5, 3, 104]]:
		_put_field(record, value)
	record.put_u32(0)
	for degrees: float in [latitude, longitude]:
		record.put_u32(roundi(degrees * 1e7))
		record.put_u32(10000000)
		for _zero: int in 2:
			record.put_u32(0)
			record.put_u32(1)
	return record.data_array


# A field's number, its type, how many values it has, and the value, or where these are.
static func _put_field(record: StreamPeerBuffer, field: Array) -> void:
	record.put_u16(field[0])
	record.put_u16(field[1])
	record.put_u32(field[2])
	record.put_u32(field[3])


static func _name(i: int) -> String:
	return "photo %d.jpg" % i


# Where a photo was taken from.
func _centre(i: int) -> Vector3:
	return Vector3(_away, 0.0, 0.0).rotated(Vector3.BACK, _arc * i / (_count - 1))


# How its camera is turned: rows are what is right, down and ahead. The model's z is down.
func _turn(i: int) -> Basis:
	var ahead: Vector3 = -_centre(i).normalized()
	var down: Vector3 = Vector3.BACK
	return Basis(down.cross(ahead), down, ahead).transposed()


# A tree of 3 boughs and 3 units; the photos are taken from around it.
func _write_model(folder: String) -> void:
	DirAccess.make_dir_recursive_absolute(folder)
	var cameras: StreamPeerBuffer = StreamPeerBuffer.new()
	cameras.put_u64(1)
	cameras.put_32(1)
	cameras.put_32(2)
	cameras.put_u64(_size.x)
	cameras.put_u64(_size.y)
	for value: float in [_focal, 0.5 * _size.x, 0.5 * _size.y, 0.0]:
		cameras.put_double(value)
	_save(folder, "cameras.bin", cameras)
	var images: StreamPeerBuffer = StreamPeerBuffer.new()
	images.put_u64(_count - 1)
	for i: int in _count - 1:
		var turn: Basis = _turn(i)
		var q: Quaternion = turn.get_rotation_quaternion()
		var place: Vector3 = -(turn * _centre(i))
		images.put_32(i + 1)
		for value: float in [q.w, q.x, q.y, q.z, place.x, place.y, place.z]:
			images.put_double(value)
		images.put_32(1)
		images.put_data((_name(i)).to_utf8_buffer())
		images.put_8(0)
		images.put_u64(0)
	_save(folder, "images.bin", images)
	_save(folder, "points3D.bin", _points())


static func _points() -> StreamPeerBuffer:
	var random: RandomNumberGenerator = RandomNumberGenerator.new()
	random.seed = 5
	var count: int = 6000
	var points: StreamPeerBuffer = StreamPeerBuffer.new()
	points.put_u64(count)
	for i: int in count:
		var up: float = random.randf()
		var round: Vector2 = Vector2.from_angle(random.randf() * TAU)
		# z is down.
		var at: Vector3 = Vector3(0.0, 0.0, 1.5 - 2.0 * up)
		var radius: float = 0.15 - 0.08 * up
		if i % 3 == 0:
			radius = 0.03
			@warning_ignore("integer_division")
			var away: Vector2 = Vector2.from_angle(TAU / 3.0 * (i / 3)) * up
			at = Vector3(away.x, away.y, -0.5 - up)
		points.put_u64(i)
		points.put_double(at.x + radius * round.x)
		points.put_double(at.y + radius * round.y)
		points.put_double(at.z)
		points.put_data(PackedByteArray([96, 80, 64]))
		points.put_double(0.6)
		points.put_u64(4)
		for k: int in 4:
			points.put_u64(0)
	return points


static func _save(into: String, name: String, bytes: StreamPeerBuffer) -> void:
	write(into.path_join(name), bytes.data_array)
