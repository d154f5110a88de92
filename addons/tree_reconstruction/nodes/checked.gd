@tool
extends RefCounted
## Keeps values that a node can't work with out of its properties.


## [param value] between [param least] and [param most]; [param before] where it is no number.
static func number(value: float, least: float, most: float, before: float) -> float:
	return before if is_nan(value) else clampf(value, least, most)


## [param value] where it is finite, else [param before].
static func point(value: Vector2, before: Vector2) -> Vector2:
	return value if value.is_finite() else before
