@tool
extends "tool.gd"
## Shows step by step how the voxel flood finds a skeleton in the scan (Zhang 2013, 5.2 and 8.1.7):
## the voxels that it reached, the directions that it found in each neighbourhood, and the nodes
## that grew.
##
## The edited tree stays as it is.

const Jobs := preload("../jobs.gd")
const Strip := preload("strip.gd")
const Picker := preload("../viewport/picker.gd")

const _STEPS_PER_SECOND: float = 20.0
const _GROWN: Color = Color(1.0, 0.85, 0.2)
const _KEPT: Color = Color(0.4, 1.0, 0.5)
const _DROPPED: Color = Color(1.0, 0.35, 0.3)

## In metres; 0 finds the size that suits the scan.
var voxel: float = 0.0

var _maker: TreeReconstructor
var _job: Jobs.Job
# The tree whose scan the steps are of.
var _steps_of: TreeReconstruction
var _steps: Array[Dictionary] = []
# Number of voxels that the flood had reached by each step.
var _reached: PackedInt32Array
# Places of the nodes by their numbers, as far as they are known.
var _places: Dictionary[int, Vector3] = {}
var _step: int = 0
# From the flood's own space to the edited tree's.
var _offset: Vector3
var _voxels: MultiMesh
var _instance: RID
var _slider: Range
var _label: Label
var _timer: Timer
var _play: Button


func get_id() -> StringName:
	return &"flood"


func get_title() -> String:
	return tr("Flood demonstration")


func get_tooltip() -> String:
	return tr(
		(
			"Shows step by step how the voxel flood finds a skeleton in the scan. Press Run below the"
			+ " viewport, then Play, or move the slider. The tree itself does not change."
		)
	)


func get_icon() -> String:
	return "VoxelGI"


func get_key() -> Key:
	return KEY_U


func start() -> void:
	if _steps_of != session.tree:
		_forget()
	_show()


func stop() -> void:
	if _job != null:
		session.jobs.cancel(_job)
		_job = null
	_hide()


func make_settings() -> Control:
	var strip: Strip = Strip.new()
	strip.add_button(
		tr("Run"), tr("Floods the scan of this tree anew. The tree itself does not change."), run
	)
	strip.add_number(
		tr("Voxel"),
		tr("The edge of the voxels in metres. 0 finds the size that suits the scan."),
		0.0,
		0.5,
		0.005,
		voxel,
		_set_voxel
	)
	_play = strip.add_button(tr("Play"), tr("Shows the steps one after another."), _on_play)
	_play.toggle_mode = true
	_slider = HSlider.new()
	_slider.custom_minimum_size.x = 220.0 * Picker.get_scale()
	_slider.size_flags_vertical = Control.SIZE_SHRINK_CENTER
	_slider.tooltip_text = tr("Which step is shown.")
	_slider.max_value = maxi(_steps.size() - 1, 0)
	_slider.value = _step
	_slider.value_changed.connect(_on_slider_moved)
	strip.add_child(_slider)
	_label = strip.add_text("")
	_timer = Timer.new()
	_timer.wait_time = 1.0 / _STEPS_PER_SECOND
	_timer.timeout.connect(_on_timer)
	strip.add_child(_timer)
	_tell()
	return strip


## Floods the scan, on a thread.
func run() -> void:
	var source: String = Session.ScanData.source_of(session.tree)
	if source.is_empty():
		session.say(tr("This tree wasn't made of a scan, so there is nothing to flood."))
		return
	if _job != null:
		session.jobs.cancel(_job)
	_forget()
	var options: Dictionary = session.tree.provenance.get("options", {}).duplicate()
	options.merge({"skeleton": "flood", "flood_steps": true, "voxel": voxel}, true)
	_maker = TreeReconstructor.new()
	var maker: TreeReconstructor = _maker
	var of: TreeReconstruction = session.tree
	_job = session.jobs.start(
		tr("Flooding the scan"),
		func(_of: Jobs.Job) -> TreeReconstruction: return maker.reconstruct_file(source, options),
		_on_flooded.bind(of),
		maker
	)


## How many steps there are to show.
func get_step_count() -> int:
	return _steps.size()


## Shows the steps up to this one.
func set_step(step: int) -> void:
	_step = clampi(step, 0, maxi(_steps.size() - 1, 0))
	if _voxels != null and not _steps.is_empty():
		_voxels.visible_instance_count = _reached[_step]
	if is_instance_valid(_slider):
		_slider.set_value_no_signal(_step)
	_tell()
	changed.emit()


func get_ghosts() -> Array:
	if _steps.is_empty():
		return []
	var points: PackedVector3Array = []
	var colors: PackedColorArray = []
	for i: int in _step + 1:
		var parent: int = _steps[i]["parent"]
		if _places.has(parent):
			points.append(_places[parent])
			points.append(_places[_steps[i]["node"]])
			colors.append(_GROWN)
			colors.append(_GROWN)
	var now: Dictionary = _steps[_step]
	var from: Vector3 = _places[now["node"]]
	for i: int in now["directions"].size():
		var color: Color = _KEPT if now["children"][i] >= 0 else _DROPPED
		points.append(from)
		points.append(from + now["directions"][i] * now["lengths"][i])
		colors.append(color)
		colors.append(color)
	var arrays: Array = []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = points
	arrays[Mesh.ARRAY_COLOR] = colors
	return [] if points.is_empty() else arrays


func _on_flooded(made: TreeReconstruction, job: Jobs.Job, of: TreeReconstruction) -> void:
	if job != _job:
		return
	_job = null
	if made == null:
		session.say(_maker.get_error_message(), session.Kind.ERROR)
		return
	if session.tree != of:
		return
	_steps_of = of
	_offset = of.get_position_in_tree(made.get_node_scan_position(made.get_root()))
	for i: int in _maker.get_flood_step_count():
		var step: Dictionary = _maker.get_flood_step(i)
		_places[step["node"]] = step["position"] + _offset
		_steps.append(step)
	_maker = null
	_build_voxels()
	if is_instance_valid(_slider):
		_slider.max_value = maxi(_steps.size() - 1, 0)
	_show()
	set_step(0)
	if is_instance_valid(_play):
		_play.button_pressed = true
		_on_play()


# All voxels once, in the order in which they are reached: then a step is the number of those that
# are drawn.
func _build_voxels() -> void:
	_reached.clear()
	var places: PackedVector3Array = []
	var generations: PackedInt32Array = []
	for step: Dictionary in _steps:
		places.append_array(step["voxels"])
		for i: int in step["voxels"].size():
			generations.append(step["generation"])
		_reached.append(places.size())
	if _steps.is_empty():
		return
	var box: BoxMesh = BoxMesh.new()
	box.size = Vector3.ONE * (_steps[0]["voxel_size"] as float) * 0.9
	var material: StandardMaterial3D = StandardMaterial3D.new()
	material.vertex_color_use_as_albedo = true
	material.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA
	material.shading_mode = BaseMaterial3D.SHADING_MODE_UNSHADED
	box.material = material
	_voxels = MultiMesh.new()
	_voxels.transform_format = MultiMesh.TRANSFORM_3D
	_voxels.use_colors = true
	_voxels.mesh = box
	_voxels.instance_count = places.size()
	for i: int in places.size():
		_voxels.set_instance_transform(i, Transform3D(Basis.IDENTITY, places[i] + _offset))
		var hue: float = fposmod(0.55 + 0.02 * generations[i], 1.0)
		_voxels.set_instance_color(i, Color.from_hsv(hue, 0.55, 0.95, 0.35))


func _show() -> void:
	if _voxels == null or session.node == null or not session.node.is_inside_tree():
		return
	if not _instance.is_valid():
		_instance = RenderingServer.instance_create2(
			_voxels.get_rid(), session.node.get_world_3d().scenario
		)
	RenderingServer.instance_set_transform(_instance, session.node.global_transform)
	changed.emit()


func _hide() -> void:
	if _instance.is_valid():
		RenderingServer.free_rid(_instance)
		_instance = RID()


func _forget() -> void:
	_hide()
	_voxels = null
	_steps.clear()
	_places.clear()
	_reached.clear()
	_steps_of = null
	_step = 0
	_tell()
	changed.emit()


func _tell() -> void:
	if not is_instance_valid(_label):
		return
	if _steps.is_empty():
		_label.text = ""
		return
	var kept: int = 0
	for child: int in _steps[_step]["children"]:
		kept += 1 if child >= 0 else 0
	_label.text = (
		tr("Step %d of %d: %d voxels, %d directions, %d kept")
		% [
			_step + 1,
			_steps.size(),
			_steps[_step]["voxels"].size(),
			_steps[_step]["directions"].size(),
			kept
		]
	)


func _set_voxel(value: float) -> void:
	voxel = value


func _on_play() -> void:
	if not _play.button_pressed:
		_timer.stop()
		return
	if _step >= _steps.size() - 1:
		set_step(0)
	_timer.start()


func _on_timer() -> void:
	set_step(_step + 1)
	if _step >= _steps.size() - 1:
		_play.button_pressed = false
		_timer.stop()


func _on_slider_moved(value: float) -> void:
	set_step(int(value))
