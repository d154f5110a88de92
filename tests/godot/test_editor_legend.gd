extends "./view_suite.gd"
## The legend of the colors in the viewport: its words, values and colors.

const Legend := preload("res://addons/tree_reconstruction/editor/viewport/legend.gd")

var _points: PointView
var _legend: Legend


func _open_legend(made: TreeReconstruction) -> void:
	_open(made)
	_points = PointView.new(_session)
	_legend = Legend.new(_session, _points)


func _close_legend() -> void:
	_points = null
	_legend = null
	_close()


func _keys() -> Array[Legend.Meaning]:
	_points.update()
	_legend.update()
	return _legend.keys


func test_points_have_a_legend_while_they_are_colored_by_a_measure() -> void:
	_open_legend(grown_tree(3))
	check(_keys().is_empty(), "There is a legend of nothing.")
	_session.scan.points = [Vector3(0, 0.25, 0), Vector3(0, 2, 0), Vector3(0, 1, 1)]
	check(_keys().is_empty(), "There is a legend of points that are not shown.")
	_session.view.points = true
	var keys: Array[Legend.Meaning] = _keys()
	check_equal(keys.size(), 1, "legends")
	check_equal(keys[0].title, "Height", "the measure")
	check_equal(keys[0].values, PackedStringArray(["0.25 m", "2.00 m"]), "the values")
	check_equal(keys[0].ramp, PointView.HEIGHTS, "the colors")
	_session.scan.points = [Vector3(0, -0.001, 0), Vector3(0, 12.34, 0)]
	_points.rebuild()
	check_equal(
		_keys()[0].values, PackedStringArray(["0.00 m", "12.34 m"]), "values of another scan"
	)
	_session.scan.colors = [Color.RED, Color.GREEN]
	_points.rebuild()
	check(_keys().is_empty(), "The scan's own colors have a legend.")
	_session.view.point_colors = ViewState.PointColors.HEIGHT
	check_equal(_keys().size(), 1, "legends of the height")
	_session.view.points = false
	check(_keys().is_empty(), "There is a legend of points that were hidden.")
	_session.view.points = true
	check_equal(_keys().size(), 1, "legends of points that are shown again")
	_session.edit_node(null)
	check(_keys().is_empty(), "There is a legend without a tree.")
	_close_legend()


# The bar's colors are those of the points at the distances below it.
func test_the_heat_map_s_legend_says_what_its_colors_are() -> void:
	_open_legend(grown_tree(3))
	var random: RandomNumberGenerator = RandomNumberGenerator.new()
	random.seed = 5
	var made: TreeReconstruction = _session.tree
	var cloud: PackedVector3Array = []
	for id: int in made.get_node_ids():
		var off: Vector3 = Vector3(random.randfn(), random.randfn(), random.randfn()) * 0.03
		cloud.append(made.get_node_position(id) + off)
	_session.scan.points = cloud
	_session.scan.wood = cloud
	_session.view.points = true
	_session.view.point_colors = ViewState.PointColors.FIDELITY
	var fidelity: TreeFidelity = TreeFidelity.new()
	check(fidelity.set_cloud(made, cloud, _session.scan.TOLERANCE), "The cloud was refused.")
	fidelity.update(made)
	_session.scan.fidelity = fidelity
	var key: Legend.Meaning = _keys()[0]
	check_equal(key.title, "Distance to the bark", "the measure")
	check_equal(key.values, PackedStringArray(["0 m", "2 cm", "6 cm or more"]), "the values")
	check(key.words.is_empty(), "There are words for leaves that are not there.")
	var errors: PackedFloat32Array = fidelity.get_point_errors()
	var colors: PackedColorArray = fidelity.get_point_colors()
	var seen: Dictionary[int, bool] = {}
	for i: int in errors.size():
		var off: float = absf(errors[i]) / _session.scan.TOLERANCE
		# 0, one tolerance and three of it stand in even steps.
		var at: float = 2.0 * off if off < 1.0 else minf(2.0 + off - 1.0, 4.0)
		var first: int = mini(int(at), 3)
		var wanted: Color = key.ramp[first].lerp(key.ramp[first + 1], at - first)
		seen[first] = true
		for channel: int in 3:
			check_near(colors[i][channel], wanted[channel], 0.006, "a color at %f m" % errors[i])
	check_equal(seen.size(), 4, "parts of the bar that are tried")
	_session.scan.wood = cloud.slice(0, 4)
	check_equal(_keys()[0].words, PackedStringArray(["Leaves, not compared"]), "words for leaves")
	check_equal(_keys()[0].swatches[0], _session.scan.LEAF_COLOR, "their color")
	_session.scan.wood = cloud
	_close_legend()


func test_channels_have_a_legend_that_follows_the_tree() -> void:
	var made: TreeReconstruction = grown_tree(3)
	_open_legend(made)
	for channel: int in range(1, TreeWind.Channel.MOTION + 1):
		_session.view.channel = channel
		check_equal(_keys().size(), 1, "legends of channel %d" % channel)
		var key: Legend.Meaning = _keys()[0]
		check(not key.title.is_empty(), "Channel %d has no name." % channel)
		check(
			not key.ramp.is_empty() or not key.words.is_empty(), "Channel %d: no colors." % channel
		)
		check_equal(key.ramp.is_empty(), key.values.is_empty(), "a bar without values")
		check_equal(key.swatches.size(), key.words.size(), "swatches without words")
	_session.view.channel = TreeWind.Channel.LEVEL
	var orders: int = made.measure().orders.size()
	check(orders > 1, "The tree has no branches.")
	check_equal(_keys()[0].words[0], "trunk", "the first word")
	check_equal(_keys()[0].words.size(), orders + 1, "words with that for leaves")
	check(_session.tree.edit("prune_order order=1") != null, "It can't be pruned.")
	check_equal(_keys()[0].words.size(), made.measure().orders.size() + 1, "words of the rest")
	_session.view.channel = TreeWind.Channel.SWAY
	var height: String = _keys()[0].values[1]
	check(
		_session.tree.edit("scale node=%d factor=0.5" % made.get_root()) != null,
		"It can't be scaled."
	)
	check(_keys()[0].values[1] != height, "The height of a lower tree is %s, too." % height)
	_session.view.channel = 0
	check(_keys().is_empty(), "There is a legend of a channel that is off.")
	_close_legend()


# It is drawn where it fits, and does not fail without the editor's theme.
func test_it_is_drawn_in_the_corner() -> void:
	_open_legend(grown_tree(3))
	_session.view.channel = TreeWind.Channel.LEVEL
	_session.scan.points = [Vector3.ZERO, Vector3(0, 2, 0)]
	_session.view.points = true
	check_equal(_keys().size(), 2, "legends")
	var overlay: Control = Control.new()
	overlay.size = _SIZE
	_viewport.add_child(overlay)
	var drawn: Array[bool] = [false]
	overlay.draw.connect(
		func() -> void:
			_legend.draw(overlay)
			drawn[0] = true
	)
	overlay.queue_redraw()
	await tree.process_frame
	await tree.process_frame
	check(drawn[0], "Nothing was drawn.")
	_close_legend()
