@tool
extends "../../test_plugin/garden.gd"
## The editor draws only when something has changed: trees that rest give it nothing to draw, those
## in the wind do.

const PhotoModel: GDScript = preload("../../test_plugin/photo_model.gd")
# In so many steps of the editor one after another nothing must be drawn, or something in each.
const _STILL: int = 40
const _DRAWN: int = 15

var _node: TreeInstance3D


func run() -> void:
	# What is drawn is counted.
	user.seldom.end()
	await _go_through()
	user.seldom.begin()


func _go_through() -> void:
	await step("a tree that is edited rests, and nothing is drawn")
	var made: TreeReconstruction = own_tree("res://rest_tree.res")
	if made == null:
		return
	PhotoModel.new(OS.get_environment("TREE_EDITOR_TEST").path_join("rest"), made)
	ResourceSaver.save(made, "res://rest_tree.res")
	_node = await open_garden("res://rest.tscn", made)
	if _node == null:
		return
	await _rests("a tree is edited")
	var view_state: RefCounted = session().get(&"view")
	await user.key("l")
	await until(func() -> bool: return not view_state.get(&"leaves"), "the leaves are hidden")
	await _rests("the leaves of a tree are hidden")
	var drawn: int = drawn_objects()
	_node.visible = false
	_node.visible = true
	await _rests("the tree was hidden and shown")
	check_equal(drawn_objects(), drawn, "objects drawn without the leaves")
	await user.key("l")
	await until(func() -> bool: return view_state.get(&"leaves"), "the leaves are shown")
	await _rests("the leaves are shown again")
	check(drawn_objects() > drawn, "The leaves were never hidden.")
	await picture("rests")

	await step("its wind is drawn while it is shown")
	await user.key("e")
	await until(func() -> bool: return view_state.get(&"wind"), "the wind is shown")
	await _moves("its wind is shown")
	await user.key("e")
	await until(func() -> bool: return not view_state.get(&"wind"), "the wind is hidden")
	await _rests("its wind is hidden")
	await _look_at_a_photo()

	await step("a scene without a TreeWind rests")
	EditorInterface.get_selection().clear()
	await until(func() -> bool: return session().get(&"node") == null, "it is edited no more")
	await _rests("nothing is edited")

	await step("a TreeWind blows, unless it is calm, as long as it is in the scene")
	var wind: TreeWind = TreeWind.new()
	_node.owner.add_child(wind)
	await _moves("a TreeWind blows")
	wind.strength = 0.0
	await _rests("the TreeWind is calm")
	wind.strength = 0.4
	await _moves("the TreeWind blows again")
	wind.free()
	await _rests("the TreeWind is gone")

	await step("a TreePusher3D that stands still gives nothing to draw")
	var pusher: TreePusher3D = TreePusher3D.new()
	_node.owner.add_child(pusher)
	await until(func() -> bool: return _pushed(pusher), "the pusher takes effect")
	await _rests("a pusher stands")
	pusher.free()
	await _rests("the pusher is gone")

	await step("a forest that stands gives nothing to draw")
	var forest: TreeVariantSpawner3D = TreeVariantSpawner3D.new()
	forest.source = _node.reconstruction
	forest.variants = 1
	forest.levels = 1
	forest.region_size = Vector2(12.0, 12.0)
	_node.owner.add_child(forest)
	await until(func() -> bool: return not forest.is_building(), "the forest stands")
	await _rests("a forest stands")
	await picture("forest")
	forest.free()


func _look_at_a_photo() -> void:
	await step("a photo that is looked at gives nothing to draw")
	await user.move(middle(view().get_parent() as Control))
	await user.key("F4")
	var base: Control = EditorInterface.get_base_control()
	var stage: Callable = base.find_child.bind("PhotoStage", true, false)
	if not await until(
		func() -> bool:
			return stage.call() != null and (stage.call() as Control).get(&"_picture") != null,
		"the photo is seen"
	):
		return
	await _rests("a photo is looked at")
	await user.key("Escape")
	await until(func() -> bool: return stage.call() == null, "the photo is gone")


# Whether it has come to its size.
func _pushed(pusher: TreePusher3D) -> bool:
	var spheres: Array[Vector4] = TreePusher3D.Pushing.get_spheres()
	return spheres.size() == 1 and is_equal_approx(spheres[0].w, pusher.radius)


# Waits until nothing is drawn any more.
func _rests(what: String) -> void:
	var still: Array[int] = [0, -1]
	await until(
		func() -> bool:
			var drawn: int = Engine.get_frames_drawn()
			still[0] = still[0] + 1 if drawn == still[1] else 0
			still[1] = drawn
			return still[0] >= _STILL,
		"the editor stops drawing while " + what
	)


# Waits until each step is drawn.
func _moves(what: String) -> void:
	var drawn: Array[int] = [0, -1]
	await until(
		func() -> bool:
			var now: int = Engine.get_frames_drawn()
			drawn[0] = drawn[0] + 1 if now != drawn[1] else 0
			drawn[1] = now
			return drawn[0] >= _DRAWN,
		"the editor goes on drawing while " + what
	)
