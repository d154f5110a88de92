@tool
extends RefCounted
## What the library says of bark that grows: patterns as those of sentences.gd.

const PATTERNS: PackedStringArray = [
	"The tree has no wood that bark could grow on.",
	(
		"Nothing of this tree is thick enough for bark with edges of %s mm: make them shorter, or check"
		+ " the tree's units."
	),
	(
		"%s was left out: its branch is thinner than %s mm and stays a tube. Give it a thicker branch,"
		+ " or shorter edges."
	),
	"%s lies %s m along its branch, which is grown from %s to %s m: it was left out.",
	"%s found no bark %s m along its branch and was left out.",
	"A burl",
	"A hollow",
	"A cut",
	"A section",
	(
		"radii has %s, where shares of the branch's radius from %s to %s belong, with commas between"
		+ " them: radii=1.2,0.9,1.1."
	),
	"A section has %s radii, where it needs from %s to %s: one in each of so many equal directions.",
	"An obstacle",
	(
		"An obstacle stands where the trunk begins, below the ground: nothing can grow there. Move it"
		+ " aside."
	),
	"An obstacle has corners that are no numbers: give it a mesh that has its place.",
	"%s=%s is larger than %s=%s: make it smaller.",
	"A hollow that begins at from=%s must end later: give until= more than that.",
	"An obstacle with shape=mesh needs file=, a .glb, .gltf or .obj file.",
	"An obstacle with file= needs shape=mesh.",
	"An obstacle is of a file= or of a mesh=, not of both.",
	(
		"The obstacle %s is a mesh of a scene, which is not at hand here. Grow this recipe in the editor,"
		+ " or give the obstacle a file=, a .glb, .gltf or .obj file."
	),
	"There is no recipe %s; there are %s.",
	"'%s' has no faces: give a mesh as a .glb, .gltf or .obj file.",
	"'%s' names what is not in it: the file is damaged.",
	"'%s' has sparse or compressed geometry: export it without compression.",
	"'%s' has more than %s triangles: simplify it.",
	"'%s' is larger than 4 GB: simplify it.",
	"'%s' can't be read as a glTF model.",
	"'%s' can't be read as a glTF model: %s",
	"'%s' shows no triangles in its scene.",
	"This build was made without CGAL and can't grow bark; get one that has it.",
	"The tree has no wood that lumps could be on.",
	"The scan has no points that bark could be compared with.",
	(
		"The scan has too few points on the bark to tell lumps: nothing is proposed. Is it the scan that"
		+ " this tree was made of?"
	),
	"The scan's bark winds about the trunk by %s radians a metre, and so does the grain.",
	"The saved bark is damaged. Grow it again.",
	"The seed has corners that are no numbers: give a mesh that has its place.",
	"The seed has %s triangles, and can have %s: simplify it.",
	(
		"The seed is not one surface: at each edge two triangles must meet, and they must face the same"
		+ " way. Weld its vertices, and recalculate its normals outside."
	),
	"The seed has holes: bark grows from a closed mesh. Fill them.",
	"The seed has %s parts that don't hang together: join them, or leave all but one out.",
	"The seed goes through itself in %s places: mend it, for example by remeshing.",
	"The trunk does not begin in the seed: move it so that it holds %s.",
	"The trunk does not come out of the seed: nothing is left to grow.",
	"An obstacle stands in the seed that bark starts from. Move one of them aside.",
	# Of a recipe.
	"Line %s of the recipe: %s",
	(
		"The shortest edge must be at most half of the longest: with longest=%s give shortest=%s or"
		+ " less."
	),
	"There is no %s; a recipe has %s.",
	"'%s' takes no '%s'; it takes %s.",
	"'%s' must be %s, not %s.",
	"a number from %s to %s",
	"a whole number from %s to %s",
]
