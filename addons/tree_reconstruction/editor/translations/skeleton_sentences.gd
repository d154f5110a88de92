@tool
extends RefCounted
## What the library says of ways to a skeleton: patterns as those of sentences.gd.

const PATTERNS: PackedStringArray = [
	(
		"This build was made without CGAL and has no Delaunay triangulation; take the skeleton method"
		+ " geodesic or flood."
	),
	(
		"Too few points stand where the trunk should be. Take the skeleton method geodesic, which needs"
		+ " none."
	),
	(
		"The points around the base lie on no cylinder, so all radii are guesses by how far the tree"
		+ " reaches."
	),
]
