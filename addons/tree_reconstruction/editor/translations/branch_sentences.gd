@tool
extends RefCounted
## What the library says of branches drawn over a scan: patterns as those of sentences.gd.

const PATTERNS: PackedStringArray = [
	"There is no tree to hang a branch on.",
	"The camera of a drawn branch is no camera: its numbers must be finite, and its axes square.",
	"The stroke has no points: draw along the missing branch.",
	"The stroke has more than %s points.",
	"The stroke has a point that is no place in the picture.",
	"The stroke lies outside of the picture.",
	"The stroke is too short to be a branch: draw it along the whole branch.",
	"The tree lies behind the camera: turn the camera towards it.",
	(
		"The stroke begins near no wood of the tree: draw it from the wood that the branch grows"
		+ " from."
	),
	# Remarks.
	"The stroke runs through the wood: its shorter part was left out.",
	"The stroke ends before the wood and was joined to the nearest.",
	(
		"No points of the scan lie along the stroke that the tree lacks: how far the branch reaches"
		+ " towards the camera or away from it is guessed from the tree's other branches."
	),
	(
		"There is no scan: how far the branch reaches towards the camera or away from it is guessed from"
		+ " the tree's other branches."
	),
]
