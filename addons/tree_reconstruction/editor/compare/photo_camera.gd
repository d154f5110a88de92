@tool
extends RefCounted
## Sees a scene from where a photo was taken, as a lens without distortion would have.


## Stands [param camera] in the pose of a photo, so that its picture shows what the rectangle [param
## shown] of the photo does, in the photo's pixels from the upper left corner; it may reach beyond.
## The camera's viewport must have the rectangle's proportions. [param view] is one of [method
## TreeReconstructor.load_photo_views], and [param frame] where the tree stands in the scene: evenly
## scaled, or only the camera's place is right.
static func place(camera: Camera3D, view: Dictionary, frame: Transform3D, shown: Rect2) -> void:
	var pose: Transform3D = view["transform"]
	var focal: float = view["focal"]
	var principal: Vector2 = view["principal"]
	# What a pixel is on the near plane, where the engine measures a frustum. Rows go down there.
	var pixel: float = camera.near / focal
	var off: Vector2 = (shown.get_center() - principal) * pixel
	camera.keep_aspect = Camera3D.KEEP_HEIGHT
	camera.set_frustum(shown.size.y * pixel, Vector2(off.x, -off.y), camera.near, camera.far)
	camera.global_transform = (frame * pose).orthonormalized()


## The index of the photo that was taken nearest to a place of the scene; -1 without any.
static func nearest(views: Array[Dictionary], frame: Transform3D, place: Vector3) -> int:
	var found: int = -1
	var least: float = INF
	for i: int in views.size():
		var pose: Transform3D = views[i]["transform"]
		var away: float = (frame * pose.origin).distance_to(place)
		if away < least:
			least = away
			found = i
	return found


## Whether [param frame] scales all directions alike, as photos need it.
static func is_even(frame: Transform3D) -> bool:
	var scale: Vector3 = frame.basis.get_scale().abs()
	var most: float = maxf(scale.x, maxf(scale.y, scale.z))
	return most - minf(scale.x, minf(scale.y, scale.z)) < 1e-3 * most
