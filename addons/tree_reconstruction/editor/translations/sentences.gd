@tool
extends RefCounted
## What the library says, in the editor's language. The library speaks English: its sentences are
## found here by their patterns, in which each %s is a number, a name or another one of them. What
## no pattern fits stays as it is.

## tests/tools/editor_strings.py gathers these, and checks that the library's sources say so.
const PATTERNS: PackedStringArray = [
	# Of edits.
	"Nothing was cut away.",
	"Cut away %s node.",
	"Cut away %s nodes.",
	"Added %s node.",
	"Added %s nodes.",
	"Bent %s nodes.",
	"Changed %s node.",
	"Changed %s nodes.",
	"Grew %s node.",
	"Grew %s nodes.",
	"Mirrored %s nodes.",
	"Moved %s node.",
	"Moved %s nodes.",
	"Scaled %s nodes.",
	"Smoothed %s node.",
	"Smoothed %s nodes.",
	"Turned %s nodes.",
	"Grafted %s of %s in all, clear of other branches.",
	"Grafted %s of %s in all, with %s with other branches.",
	"Nothing was grafted: no node was chosen.",
	"The twig runs into %s segment of another branch.",
	"The twig runs into %s segments of other branches.",
	"%s of %s nodes are left; bark moved by up to %s, tips by up to %s.",
	"The string's %s nodes take the place of %s.",
	"No leaves changed: there is no such wood, or it bears these already.",
	"%s node bears leaves by the rule %s.",
	"%s nodes bear leaves by the rule %s.",
	"%s node bears the tree's own leaves again.",
	"%s nodes bear the tree's own leaves again.",
	"The tree is empty.",
	"There is no node %s in this tree.",
	"There is no wood within %s of the place of node %s.",
	"There is no wood of %s diameter that runs that way within %s of the place of node %s.",
	"There is no node %s in this tree to graft onto.",
	"The root cannot be cut away: no tree would be left.",
	"The root lies inside, so no tree would be left.",
	"The root can be deleted only while exactly one branch grows from it.",
	"The root hangs on nothing, so it cannot be attached elsewhere.",
	"A branch cannot be attached to wood that grows from it.",
	"A tree is left with 2 nodes at least.",
	"The tree is a single node: there is no branch on it to take.",
	"The branch to graft is a single node: it has no wood to graft.",
	"The branch to graft is empty.",
	(
		"These grafts would add %s nodes, more than the %s that are allowed: graft onto fewer nodes,"
		+ " graft smaller branches, or allow more."
	),
	"The tree is not as it was before this edit, so the edit cannot be done again.",
	"The tree is not as this edit left it, so the edit cannot be undone.",
	# Of files that are written.
	"'%s' is no name for a point cloud: use the extension .ply, .las, .xyz, .txt or .asc.",
	"'%s' is the scan itself, which would be overwritten; choose another name.",
	"'%s' cannot be written: there is no folder '%s'.",
	"'%s' cannot be written; check its name and that its folder is yours to write.",
	"'%s' could not be written; check the disk's free space and the rights.",
	"This tree does not say which scan it was made from.",
	# In them.
	"%s branch",
	"%s branches",
	"%s node",
	"%s nodes",
	"%s collision",
	"%s collisions",
	# Why a branch is doubtful.
	"few points",
	"a long bridge",
	"an improbable angle",
	"thicker than its parent",
	# Of scans.
	(
		"Only %s % of the wood's points lie within 2 cm of the wood that was found. Is it a single"
		+ " tree, and are its units right?"
	),
	(
		"Next to no part of the cloud is round like a stem or a branch, so the radii are guesses. Is"
		+ " it a tree?"
	),
	(
		"The scan is noisy: even the stem's points lie on no surface, but about %s cm or more to either"
		+ " side of it. Twigs and the radii of thin wood are guesses."
	),
	(
		"%s % of the points lie on flat surfaces, as on walls or on the ground; what is made of them is"
		+ " hardly a tree."
	),
	"The points lie on the surface of a ball; what is made of them is hardly a tree.",
	"The points are spread evenly, as noise is; what is made of them is hardly a tree.",
	(
		"%s % of the points stand well apart from the rest and were left out. If they are part of the"
		+ " tree, leave out the cleaning of fragments; if they are a tree of their own, give each tree a"
		+ " file of its own."
	),
	(
		"The photos show a stem, and its crown is above their upper edges; what stands around the stem"
		+ " was left out. If it is part of the tree, leave out the cleaning of the ground."
	),
	(
		"%s points lie on a wall, %s m long and %s m high, and were left out. If they are part of the"
		+ " tree, leave out the cleaning of the ground."
	),
	(
		"%s points lie on walls, the widest, %s m long and %s m high, and were left out. If they are part"
		+ " of the tree, leave out the cleaning of the ground."
	),
	(
		"The cloud is a slice across a trunk, %s units thick and %s wide, and no tree can be made of it."
		+ " Take the whole scan that it was cut from."
	),
	(
		"The cloud is a slice across %s trunks, %s units thick and %s wide, and no tree can be made of"
		+ " it. Take the whole scan that it was cut from."
	),
	(
		"The cloud holds %s trees; number %s, the largest, was taken. It is %s high and stands at %s in"
		+ " the scan. Another one can be chosen by its number or by a place near it. If they are one"
		+ " tree's stems or roots, take all of the scan for one tree (in the Import dock: switch"
		+ " Separate Trees off)."
	),
	(
		"The cloud holds %s trees; number %s was taken. It is %s high and stands at %s in the scan."
		+ " Another one can be chosen by its number or by a place near it. If they are one tree's stems"
		+ " or roots, take all of the scan for one tree (in the Import dock: switch Separate Trees"
		+ " off)."
	),
	(
		"The cloud is %s units high; they were taken for %s. Set the scale or one known length by hand"
		+ " if that is wrong."
	),
	(
		"A cloud with %s up comes from photos as a rule, and those have no scale of their own; its units"
		+ " were taken for metres, which makes it %s m high. If that is wrong, give the tree's height or"
		+ " one known length."
	),
	(
		"The cloud was made of photos, which have no scale of their own; its units were taken for"
		+ " metres, which makes it %s m high. If that is wrong, give the tree's height or one known"
		+ " length."
	),
	"The photos' cameras were not asked for the way up: %s",
	"The cloud is %s m high, which is odd for a tree; check the scale and the up axis.",
	(
		"The shape does not tell which way is up; %s was taken. If the tree lies or hangs, set the up"
		+ " axis by hand."
	),
	(
		"Leaves hide much of the wood: %s % of the branches in the crown were guessed from the paths"
		+ " through the leaves."
	),
	"The leaves are fronds: the tree was taken for a palm, which has one stem and no branches.",
	"The scan has a gap of up to %s m in the wood; what lies between is a guess.",
	"The scan has %s gaps of up to %s m in the wood; what lies between is a guess.",
	"%s of %s points are of the classes 7 or 18, noise, and were left out.",
	"The column %s tells leaves from wood: %s of %s points are leaves, %s are wood.",
	"The file has its heights in %s, but all else in %s; the heights were converted.",
	(
		"%s holds %s trees; the largest, tree %s with %s nodes, was taken. Ask for another one by its"
		+ " number (--tree)."
	),
	# Of files that can't be read.
	"%s holds a single node; a tree has two or more.",
	(
		"%s shows no tree: its coordinates come in steps of %s m along %s, since they were rounded to"
		+ " 32-bit numbers far from zero. Shift the cloud towards zero before saving it (or save it in"
		+ " double precision), and read that."
	),
	"%s is empty.",
	"%s holds no points.",
	"%s is cut off: it promises %s points, but holds %s; copy it again.",
	"%s is not a point cloud that can be read: no line in it begins with three numbers (x y z).",
	"%s is no PLY file: it does not begin with the line 'ply'.",
	"%s is no LAS file: it does not begin with the letters LASF.",
	"%s is a PLY file without vertices.",
	"%s is damaged or cut off within its LAZ header; copy it again.",
	(
		"The cloud has points in only %s places, and a tree needs at least 10. Check that the file is"
		+ " complete."
	),
	(
		"All points lie on one plane, so there is no tree in the cloud. Check that the file is the right"
		+ " one and its columns are read as meant."
	),
	(
		"All points lie on a plane or on a line, and a tree needs depth: this looks like a photo or a"
		+ " section of a scan."
	),
	"No tree was found in %s: nothing in it looks like wood.",
	(
		"%s holds %s trees; the largest, tree %s with %s, was taken. Ask for another one by its number"
		+ " (in the Import dock: Tree in File)."
	),
	"%s holds no points of the classes that were asked for; clear Classes in the Import dock.",
	(
		"%s holds no points but noise (classes 7 and 18); 'all' for Classes in the Import dock reads"
		+ " these too."
	),
	(
		"The file names its coordinate system by its number alone, EPSG:%s; its units were taken for"
		+ " metres. If they are feet, set the unit (in the Import dock: Unit)."
	),
	(
		"The file names its coordinate system without its unit; its units were taken for metres. If they"
		+ " are feet, set the unit (in the Import dock: Unit)."
	),
	# Of photos.
	"COLMAP, which finds out where photos were taken from, is not on this machine. %s",
	"There is no program COLMAP at '%s'. %s",
	"Install it ('sudo apt install colmap' on Debian and Ubuntu), or name the program.",
	"Install it with 'brew install colmap', or name the program.",
	(
		"Unpack COLMAP for Windows from its releases page (github.com/colmap/colmap) into a folder"
		+ " C:\\COLMAP, or name its folder."
	),
	(
		"COLMAP could not find out where any of the %s photos was taken from: they overlap too"
		+ " little, or do not show the same thing. %s"
	),
	(
		"COLMAP could not find out where any of the %s photos was taken from: there is little in"
		+ " them to recognise (%s features in a usual one, where sharp photos of bark and leaves have"
		+ " thousands). They are blurred, dark or small, or show something smooth, such as a wall or"
		+ " the sky."
	),
	(
		"Walk around the tree and take a photo every 10 to 15 degrees (24 to 36 for the circle), each"
		+ " showing most of what the one before it shows."
	),
	(
		"The photos show two scenes that nothing joins, of %s and %s photos; the first one was taken."
		+ " Add photos that lead from one to the other, or take those of the other tree out of the"
		+ " folder."
	),
	(
		"COLMAP found out where %s of %s photos were taken from; the others (%s) overlap too little"
		+ " with these, or are blurred."
	),
	(
		"The circle of photos around the tree is open for %s degrees, between %s and %s: what is seen"
		+ " from there alone is missing. Add photos there, one every 10 to 15 degrees."
	),
	(
		"The places of the photos contradict what they show: of %s points that %s and %s share, %s"
		+ " fit where these were placed, and %s fit another place. So the circle of photos is bent,"
		+ " and the tree is wrong. Take more photos around these two."
	),
	"Only %s points hold the circle together between %s and %s: take a photo between these two.",
	"To compare the photos by both (in New Tree from Photos: Compare by) finds more such points.",
	"COLMAP's features alone placed %s of %s photos; corners were tracked as well, and placed %s.",
	"Some photos' names have blanks in them: rename them for corners to be tracked.",
	"COLMAP's features alone placed some photos doubtfully, so corners were tracked as well.",
	"Photos are missing, or doubtfully placed, and corners could not be tracked as well." + " %s",
	(
		"The photos look at one side: they go %s of the 360 degrees around what they show, and from"
		+ " there a tree looks no different from a wall. Walk around the tree, or a third of the way"
		+ " at least. If there is a tree in their cloud, tell where it stands."
	),
	"%s of the photos could not be read; open them, and save them again.",
	"The tree has drawn bark. %s",
	(
		"The photos were not matched pixel by pixel, so that it is not known what stands before the"
		+ " trunk."
	),
	"The tree has no piece of trunk below its first branch that bark could be taken from.",
	"No photo shows the trunk below its first branch from the front.",
	"None of the photos that show the trunk can be read.",
	(
		"The photos show the bark with pixels of %s mm, and a picture of it needs %s mm or less: take"
		+ " some from nearer by, or larger ones."
	),
	(
		"The photos show the bark out of focus or shaken: no detail finer than %s mm, and a picture of"
		+ " it needs %s mm."
	),
	(
		"Too little of the trunk is seen: %s square metres of its clear part, in no piece of %s x %s cm"
		+ " and some more around it. Take more photos of it, all around."
	),
	"The leaves have drawn colors. %s",
	"The photos were not matched pixel by pixel, so that it is not known where they show leaves.",
	"No leaves were found in the photos.",
	"The photos show too few leaves: %s points of them, and colors need %s.",
	"The photos show too few leaves: %s points of them in %s photos, and colors need %s in %s.",
	(
		"This tree does not say what it was made of, so it is not known from where it was photographed."
		+ " Choose the folder of its COLMAP model."
	),
	(
		"Beside '%s' there is no COLMAP model that would tell from where the tree was photographed."
		+ " Choose the folder of the model."
	),
	(
		"There is no COLMAP model with cameras in '%s': it needs cameras.bin and images.bin, or both as"
		+ " .txt."
	),
	"The COLMAP model in '%s' has no photos.",
	"The COLMAP model '%s' has a line that is no camera: %s.",
	"The COLMAP model '%s' has a line that is no photo: %s.",
	"The COLMAP model '%s' is cut off; copy it again.",
	"The COLMAP model '%s' is damaged: it has a camera without a size or a focal length.",
	"The COLMAP model '%s' is damaged: %s has a camera that is not there.",
	"'%s' does not exist or cannot be reached.",
	"'%s' is no photo that can be read here; save it as JPEG or PNG.",
	(
		"'%s' has %s x %s pixels, and its camera in the COLMAP model has %s x %s: it is another photo, or"
		+ " was turned or cropped since."
	),
	(
		"The film '%s' shows no walk around a tree: too little moves in it. Walk all the way around,"
		+ " and film a minute or so."
	),
	(
		"Taking photos out of a film needs the program ffmpeg, which is not on this machine. %s Or"
		+ " take the photos out of it by another program."
	),
	"'%s' is no film that ffmpeg can read (it says: %s).",
	(
		"ffmpeg was not done with '%s' after an hour and was ended; cut the film down to one walk"
		+ " around the tree."
	),
	"The film %s was left out, since there are photos beside it; name the film to take it.",
	"The photo '%s' could not be converted by %s and was left out (it says: %s).",
	"The photo '%s' could not be converted by %s and was left out (it says nothing).",
	(
		"The photo '%s' could not be converted by %s and was left out (it was not done after five"
		+ " minutes)."
	),
	"The photo '%s' could not be converted by %s and was left out (it cannot be read: %s).",
	"So were %s more photos; photos.log names them.",
	(
		"The size comes from the photos' GPS: %s m high, give or take %s m. The tree's height or one"
		+ " known length is better."
	),
	"The photos' GPS does not tell the size, since the photos do not tell which way is up.",
	(
		"The photos' GPS does not tell the size: of different places that they say they were taken at,"
		+ " %s are needed, and there are %s."
	),
	(
		"The photos' GPS does not tell the size: it is too vague for a circle as small as theirs, or its"
		+ " places do not agree with the photos."
	),
	"No photo shows a marker whose size was told, and %s of them could not be looked at for one.",
	(
		"No photo shows a marker whose size was told. It is one of ArUco's DICT_4X4_50, and two photos or"
		+ " more must show all of it, at least 24 pixels wide, with white around it."
	),
	"The marker %s tells no size: it is in one photo alone, and two are needed at least.",
	(
		"The marker %s tells no size: the photos that show it do not agree on where it is, or were taken"
		+ " from one side. It must not move, and no other one may be like it."
	),
	(
		"The marker %s tells no size: the photos that show it were taken from too near to each other."
		+ " Take more of them, from both sides."
	),
	(
		"The marker %s tells no size: in the photos it is no square. It has to lie flat, and to stay"
		+ " where it is."
	),
	(
		"A printed marker (id %s) is in %s photos: with the side of its black square (in New Tree from"
		+ " Photos: Marker's side) the tree gets its size by it."
	),
	"A marker is written to a file that ends in .svg or .png, not '%s'.",
	"A marker's side is from %s to %s mm.",
	"By %s, the tree is %s % higher than by %s; the former was taken.",
	"By %s, the tree is %s % lower than by %s; the former was taken.",
	"the printed marker",
	"the photos' GPS",
	"the size that was told",
	"None of the %s HEIC photos in '%s' could be converted, and a tree needs %s photos or more. %s",
	(
		"Only %s of the %s HEIC photos in '%s' could be converted, and a tree needs %s photos or more."
		+ " %s"
	),
	(
		"%s picture in '%s' is HEIC, as phones save them, which COLMAP does not read. They are converted"
		+ " to JPEG where one of the programs heif-dec, heif-convert, sips (a part of macOS) or magick is"
		+ " there: %s. Or set the camera to 'most compatible'."
	),
	(
		"%s pictures in '%s' are HEIC, as phones save them, which COLMAP does not read. They are"
		+ " converted to JPEG where one of the programs heif-dec, heif-convert, sips (a part of macOS) or"
		+ " magick is there: %s. Or set the camera to 'most compatible'."
	),
	(
		"'%s' is there already, and was not made of HEIC photos here; it was left as it is. Name another"
		+ " folder to write to."
	),
	# Of photos that judge.
	(
		"The photos themselves are not where they were, and there are no masks of them: nothing can judge"
		+ " the tree."
	),
	"The photos don't agree on where up is, so that their sky can't be told.",
	"No sky is sure in any of the photos, so that only masks of them can judge the tree.",
	"None of the photos in '%s' can be read.",
	"The mask of %s has %s pixels, but the photo has %s: they must be the same.",
	"The mask '%s' is no picture that can be read (PNG, JPEG, BMP or TGA).",
	"There is no folder '%s' with the photos' masks.",
	(
		"%s of %s photos have no mask in '%s': %s. A mask is called like its photo, with .png after it,"
		+ " and is white where the tree is."
	),
	"All of the photos' masks are black: none shows a tree.",
]
const TwigSentences := preload("twig_sentences.gd")
const SketchSentences := preload("sketch_sentences.gd")
const BranchSentences := preload("branch_sentences.gd")
const GrowthSentences := preload("growth_sentences.gd")
const SkeletonSentences := preload("skeleton_sentences.gd")
const _ALL: PackedStringArray = (
	PATTERNS
	+ TwigSentences.PATTERNS
	+ SketchSentences.PATTERNS
	+ BranchSentences.PATTERNS
	+ GrowthSentences.PATTERNS
	+ SkeletonSentences.PATTERNS
)
const _GAP: String = "%s"
## How the library names options of its program, and where they are in the editor.
## tests/tools/editor_strings.py checks that there are no others.
const IN_EDITOR: Dictionary[String, String] = {
	"(--one-tree)": "(in the Import dock: switch Separate Trees off)",
	"(--marker)": "(in New Tree from Photos: Marker's side)",
	"(--matcher both)": "(in New Tree from Photos: Compare by)",
	"(--tree)": "(in the Import dock: Tree in File)",
	"leave out --classes.": "clear Classes in the Import dock.",
	"--classes all reads these too.": "'all' for Classes in the Import dock reads these too.",
	"(--unit us-ft or --unit ft; in the Import dock: Unit)": "(in the Import dock: Unit)",
}


## A sentence of the library in the language of [param domain]; several that follow each other, too.
static func translate(sentence: String, domain: StringName) -> String:
	var words: TranslationDomain = TranslationServer.get_or_add_domain(domain)
	var told: String = sentence
	for option: String in IN_EDITOR:
		told = told.replace(option, IN_EDITOR[option])
	if words.get_translations().is_empty():
		return told
	return _translate(told, words)


## A list of words with commas between.
static func translate_list(list: String, domain: StringName) -> String:
	var parts: PackedStringArray = []
	for part: String in list.split(", "):
		parts.append(translate(part, domain))
	return ", ".join(parts)


static func _translate(sentence: String, words: TranslationDomain) -> String:
	for pattern: String in _ALL:
		var gaps: Variant = find_gaps(sentence, pattern)
		if gaps == null:
			continue
		var made: String = words.translate(pattern, &"")
		if made == pattern:
			return sentence
		var pieces: PackedStringArray = made.split(_GAP)
		var filled: String = pieces[0]
		for i: int in range(1, pieces.size()):
			filled += _translate((gaps as PackedStringArray)[i - 1], words) + pieces[i]
		return filled
	return sentence


## What stands in the gaps of a pattern that the sentence fits, or [code]null[/code].
static func find_gaps(sentence: String, pattern: String) -> Variant:
	var pieces: PackedStringArray = pattern.split(_GAP)
	var gaps: PackedStringArray = []
	if not sentence.begins_with(pieces[0]):
		return null
	var at: int = pieces[0].length()
	for i: int in range(1, pieces.size()):
		var last: bool = i == pieces.size() - 1
		var piece: String = pieces[i]
		var next: int = sentence.length() - piece.length() if last else sentence.find(piece, at)
		if next <= at or (last and not sentence.ends_with(piece)):
			return null
		gaps.append(sentence.substr(at, next - at))
		at = next + piece.length()
	return gaps if at == sentence.length() else null
