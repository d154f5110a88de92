@tool
extends "section.gd"
## Other trees of the same kind, made of this one's branches: a strip of pictures to choose from.

const _MANY: int = 6
const _SIDE: int = 72
# While the tree is dragged no pictures are drawn.
const _CALM_SECONDS: float = 0.5
# How far apart trees stand, over the width of the crown.
const _APART: float = 1.1

var amount: HSlider = HSlider.new()
var more: Button
var pictures: Array[Button] = []

var _strip: HFlowContainer = HFlowContainer.new()
var _calm: Timer = Timer.new()
var _job: Session.Jobs.Job
var _first_seed: int = 1
# What the pictures are of.
var _tree: TreeReconstruction
var _shown: Array = []


func get_id() -> StringName:
	return &"variants"


func close() -> void:
	if _job != null:
		session.jobs.cancel(_job)


## Puts the variant of a seed beside the tree, as one step.
func add_variant(number: int) -> TreeInstance3D:
	var of: TreeInstance3D = session.node
	if session.tree == null:
		return null
	var made: TreeReconstruction = session.tree.make_variant(number, amount.value)
	if made == null:
		return null
	_take_path(made, number)
	var placed: TreeInstance3D = TreeInstance3D.new()
	placed.name = "%sVariant%d" % [of.name, number]
	placed.reconstruction = made
	for property: StringName in [&"lod", &"leaves", &"wind", &"bark_material", &"leaf_material"]:
		placed.set(property, of.get(property))
	# A tree that is its own scene bears its variants.
	var parent: Node = of if of.owner == null else of.get_parent()
	var apart: float = _APART * maxf(2.0 * session.tree.measure().crown_radius, 1.0)
	placed.transform = Transform3D.IDENTITY if parent == of else of.transform
	placed.position = _free_place(parent, placed.position, apart)
	session.history.begin(tr("Add Variant"), of)
	session.history.add_method(parent, &"add_child", [placed, true], &"remove_child", [placed])
	session.history.add_method(
		placed, &"set_owner", [of if of.owner == null else of.owner], &"set_owner", [null]
	)
	session.history.keep_added(placed)
	session.history.commit()
	session.say(tr("%s stands beside the tree.") % placed.name)
	return placed


func _build() -> void:
	title = "Variants"
	tooltip_text = "Other trees of the same kind, made of this tree's own branches."
	folded = true
	amount.max_value = 1.0
	amount.step = 0.05
	amount.value = 0.5
	amount.size_flags_vertical = Control.SIZE_SHRINK_CENTER
	amount.value_changed.connect(_on_amount_changed)
	body.add_child(
		Widgets.line(
			"How different", "0 is the same tree, 1 as different as its kind allows.", amount
		)
	)
	for i: int in _MANY:
		var picture: Button = Widgets.button("", "A variant of this tree.")
		picture.custom_minimum_size = Vector2.ONE * Widgets.px(_SIDE)
		picture.icon_alignment = HORIZONTAL_ALIGNMENT_CENTER
		picture.expand_icon = true
		picture.disabled = true
		picture.pressed.connect(_on_picture_pressed.bind(i))
		pictures.append(picture)
		_strip.add_child(picture)
	body.add_child(_strip)
	more = Widgets.button("More", "Shows other variants, with further seeds.", &"Reload")
	more.pressed.connect(_on_more_pressed)
	body.add_child(buttons([more]))
	_calm.one_shot = true
	_calm.wait_time = _CALM_SECONDS
	_calm.timeout.connect(draw_pictures)
	add_child(_calm, false, Node.INTERNAL_MODE_BACK)


func _refresh() -> void:
	if session.tree != _tree:
		_tree = session.tree
		_shown = []
		for picture: Button in pictures:
			picture.disabled = true
	if _wanted() != _shown and _tree != null and not _tree.is_empty():
		_calm.start()


## Draws the variants, on a thread.
func draw_pictures() -> void:
	if session.tree == null or session.tree.is_empty() or _wanted() == _shown:
		return
	if _job != null:
		session.jobs.cancel(_job)
	_shown = _wanted()
	_job = session.jobs.start(
		tr("Drawing variants"),
		_draw_variants.bind(session.tree, _first_seed, amount.value, Widgets.px(_SIDE)),
		_on_drawn.bind(_first_seed)
	)


static func _draw_variants(
	job: Session.Jobs.Job, tree: TreeReconstruction, first: int, how_far: float, size: int
) -> Array[Image]:
	var drawn: Array[Image] = []
	for i: int in _MANY:
		if job.cancelled:
			break
		var variant: TreeReconstruction = tree.make_variant(first + i, how_far)
		var pixels: PackedByteArray = variant.draw(size)
		drawn.append(Image.create_from_data(size, size, false, Image.FORMAT_RGBA8, pixels))
	return drawn


func _on_drawn(drawn: Array[Image], job: Session.Jobs.Job, first: int) -> void:
	if job != _job:
		return
	_job = null
	for i: int in drawn.size():
		pictures[i].icon = ImageTexture.create_from_image(drawn[i])
		pictures[i].tooltip_text = (
			tr("The variant with the seed %d. Click to put it beside the tree.") % (first + i)
		)
		pictures[i].disabled = false


# What the pictures should be of.
func _wanted() -> Array:
	if session.tree == null:
		return []
	return [
		session.tree.get_bark_revision(),
		_first_seed,
		amount.value,
		session.tree.get_leaf_look(),
		session.tree.leaves_enabled
	]


func _on_amount_changed(_value: float) -> void:
	_calm.start()


func _on_more_pressed() -> void:
	_first_seed += _MANY
	draw_pictures()


func _on_picture_pressed(index: int) -> void:
	add_variant(_first_seed + index)


# A file beside the tree's, so that the scene stays small. Without one it goes into the scene.
func _take_path(made: TreeReconstruction, number: int) -> void:
	var beside: String = session.tree.resource_path
	if (
		not beside.begins_with("res://")
		or beside.contains("::")
		or beside.begins_with("res://addons/")
	):
		return
	var stem: String = beside.get_basename() + "_variant_%d" % number
	var path: String = stem + ".res"
	var next: int = 2
	while FileAccess.file_exists(path) or ResourceLoader.has_cached(path):
		path = "%s_%d.res" % [stem, next]
		next += 1
	session.local_trees.add_new(made, path)


# The nearest place to the right where no other tree stands.
static func _free_place(parent: Node, from: Vector3, apart: float) -> Vector3:
	var place: Vector3 = from
	var taken: bool = true
	while taken:
		place.x += apart
		taken = false
		for other: Node in parent.get_children():
			if other is TreeInstance3D:
				var away: Vector3 = (other as TreeInstance3D).position - place
				taken = taken or Vector2(away.x, away.z).length() < 0.5 * apart
	return place
