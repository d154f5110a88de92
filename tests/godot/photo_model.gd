extends RefCounted
## A COLMAP model of photos from around a tree, and the photos: its wood before a bright sky, bent
## by a lens. Their camera's axis is not in the middle.

const COUNT: int = 6
const SIZE: Vector2i = Vector2i(320, 400)
const FOCAL: float = 380.0
const AXIS: Vector2 = Vector2(148.0, 226.0)
const BEND: float = -0.06
const SKY: Color = Color(0.8, 0.87, 0.93)
const WOOD: Color = Color(0.3, 0.22, 0.16)

## Where the tree says that its cloud is; there is none.
var source: String
## The folders of the model and of the photos.
var model: String
var photos: String

var _tree: TreeReconstruction
# Where the tree's space is in its scan, which has Y or Z up and is not tilted.
var _up: String
var _origin: Vector3
var _unit: float
# The cameras in the tree's space: columns are right, down, ahead.
var _poses: Array[Transform3D] = []


## Writes both into [param folder], and has [param of] say that it comes from there.
func _init(folder: String, of: TreeReconstruction, camera: String = "") -> void:
	_tree = of
	source = folder.path_join("cloud.ply")
	model = folder.path_join("sparse/0")
	photos = folder.path_join("photos")
	DirAccess.make_dir_recursive_absolute(model)
	DirAccess.make_dir_recursive_absolute(photos)
	var bits: PackedInt64Array = of.skeleton["frame"]
	var place: PackedFloat64Array = bits.to_byte_array().to_float64_array()
	assert(place.size() == 4)
	_up = of.skeleton["up_axis"]
	_origin = Vector3(place[0], place[1], place[2])
	_unit = place[3]
	var lens: String = "1 SIMPLE_RADIAL %d %d %f %f %f %f\n"
	write(
		model.path_join("cameras.txt"),
		camera if not camera.is_empty() else lens % [SIZE.x, SIZE.y, FOCAL, AXIS.x, AXIS.y, BEND]
	)
	var lines: String = ""
	for i: int in COUNT:
		_poses.append(_stand(i))
		lines += _line(i) + "\n\n"
		_draw(i).save_png(photos.path_join(name_of(i)))
	write(model.path_join("images.txt"), lines)
	of.provenance = {"source": source, "photos": photos}


static func name_of(i: int) -> String:
	return "photo_%d.png" % i


static func write(path: String, text: String) -> void:
	var file: FileAccess = FileAccess.open(path, FileAccess.WRITE)
	file.store_string(text)
	file.close()


## Where a place of the tree is in a photo, in pixels, by COLMAP's formula of the camera, or of one
## without distortion.
func project(i: int, place: Vector3, bend: float = BEND) -> Vector2:
	var seen: Vector3 = _poses[i].affine_inverse() * place
	var flat: Vector2 = Vector2(seen.x, seen.y) / seen.z
	return AXIS + flat * (1.0 + bend * flat.length_squared()) * FOCAL


# A level circle around the tree, from a little below its middle.
func _stand(i: int) -> Transform3D:
	var box: AABB = _tree.get_aabb()
	var away: Vector3 = Vector3(0, -0.1, 1).rotated(Vector3.UP, TAU * i / COUNT + 0.3)
	var centre: Vector3 = box.get_center() + away * box.size.length() * 1.25
	var ahead: Vector3 = (box.get_center() - centre).normalized()
	var right: Vector3 = ahead.cross(Vector3.UP).normalized()
	return Transform3D(Basis(right, ahead.cross(right), ahead), centre)


# As images.txt has it: the quaternion that turns the scan's axes into the camera's, its shift, the
# camera and the name.
func _line(i: int) -> String:
	var pose: Transform3D = _poses[i]
	var axes: Basis = Basis(_to_scan(pose.basis.x), _to_scan(pose.basis.y), _to_scan(pose.basis.z))
	var turn: Basis = axes.transposed()
	var q: Quaternion = turn.get_rotation_quaternion()
	var shift: Vector3 = -(turn * (_origin + _to_scan(pose.origin) / _unit))
	return (
		"%d %.9f %.9f %.9f %.9f %.7f %.7f %.7f 1 %s"
		% [i + 1, q.w, q.x, q.y, q.z, shift.x, shift.y, shift.z, name_of(i)]
	)


func _to_scan(v: Vector3) -> Vector3:
	return v if _up == "y" else Vector3(v.x, -v.z, v.y)


func _draw(i: int) -> Image:
	var picture: Image = Image.create_empty(SIZE.x, SIZE.y, false, Image.FORMAT_RGB8)
	picture.fill(SKY)
	for id: int in _tree.get_node_ids():
		var parent: int = _tree.get_node_parent(id)
		if parent == TreeReconstruction.NO_NODE:
			continue
		var from: Vector3 = _tree.get_node_position(parent)
		var to: Vector3 = _tree.get_node_position(id)
		var steps: int = ceili(project(i, from).distance_to(project(i, to))) + 1
		for step: int in steps + 1:
			var at: Vector3 = from.lerp(to, float(step) / steps)
			var away: float = (_poses[i].affine_inverse() * at).z
			var half: float = maxf(_tree.get_node_radius(id) * FOCAL / away, 0.5)
			var corner: Vector2 = project(i, at) - Vector2.ONE * half
			picture.fill_rect(
				Rect2i(Vector2i(corner.round()), Vector2i.ONE * maxi(roundi(2.0 * half), 1)), WOOD
			)
	return picture
