#!/usr/bin/env bash
# Exports a game with a tree, for real, and runs it: without a screen and in a window. ./dev test export calls
# it, with GODOT set, the libraries of the editor and of both templates built, and the sample scan made. The
# last line is 'N passed, N failed'.
set -uo pipefail
cd "$(dirname "$0")/../.."
. tests/tools/checks.sh
. tests/tools/own_cache.sh

work=$PWD/build/export
rm -rf "$work"
mkdir -p "$work/out"
cp -r tests/export/game "$work/game"
mkdir "$work/game/addons"
cp -r project/addons/tree_reconstruction "$work/game/addons/"

# The templates lie beside the engine in Debian's package; elsewhere where the editor keeps them.
template() {
    local found
    for found in "$(dirname "$(readlink -f "$GODOT")")/usr/bin/godot-template-$1" "/usr/bin/godot-template-$1" \
        "$HOME/.local/share/godot/export_templates"/*/linux_"$1".x86_64; do
        [ ! -x "$found" ] || { echo "$found"; return; }
    done
}
release=$(template release)
debug=$(template debug)
if [ -z "$release" ] || [ -z "$debug" ]; then
    echo "Skipped: this engine has no export templates. Install them in its editor."
    check 'the templates are told to be missing' true
    finish
fi
sed -i "s|TEMPLATE_DEBUG|$debug|; s|TEMPLATE_RELEASE|$release|" "$work/game/export_presets.cfg"

log=$work/log
engine() { timeout 300 "$GODOT" --headless --path "$work/game" "$@" >"$log" 2>&1; }
# The first import only finds the extension; the tree is made before the second one, which needs it.
engine --import
engine --script res://make_tree.gd -- "$PWD/build/sample/scan.ply" || { tail -n 20 "$log"; }
wanted=$(sed -n 's/^digest //p' "$log")
check 'the editor makes the tree' [ -n "$wanted" ]
forest=$(sed -n 's/^forest //p' "$log")
check 'the editor makes a forest' [ "${forest%% *}" -gt 10 ]
engine --import
for kind in release debug; do
    engine --export-$kind Linux "$work/out/$kind.x86_64"
    check "the $kind export ends" [ -x "$work/out/$kind.x86_64" ]
    grep -E '^(SCRIPT )?ERROR' "$log" && check "the $kind export without errors" false
done

# The unpacked engine's templates find its libraries as ./dev has the engine itself find them.
root=$(dirname "$(readlink -f "$GODOT")")
if [ -e "$root/run-godot" ]; then
    libraries=$(echo "$root"/usr/lib/*-linux-gnu)
    LIBGL_DRIVERS_PATH=$libraries/dri
    export LIBGL_DRIVERS_PATH
    for kind in release debug; do
        patchelf --set-interpreter "$(patchelf --print-interpreter "$root/usr/bin/godot")" "$work/out/$kind.x86_64"
        patchelf --force-rpath --set-rpath "$libraries:$libraries/pulseaudio" "$work/out/$kind.x86_64"
    done
fi

for kind in release debug; do
    (cd "$work/out" && timeout 120 "./$kind.x86_64" --headless) >"$work/$kind.log" 2>&1
    check "the $kind game runs" grep -q '^digest ' "$work/$kind.log"
    check "the $kind game makes the same bytes as the editor" grep -q "^digest $wanted\$" "$work/$kind.log"
    check "the $kind game shows the bark that grew" grep -q '^grown true$' "$work/$kind.log"
    check "and at lighter levels" grep -q '^grown at level 1 true$' "$work/$kind.log"
    check "the $kind game grows the same forest as the editor" grep -q "^forest $forest\$" "$work/$kind.log"
    check "the $kind game knows its scan's name, not on whose disk it lay" grep -q '^source scan.ply$' "$work/$kind.log"
    check "the $kind game has no class of the editor's" grep -q '^editor false$' "$work/$kind.log"
    ! grep -E 'ERROR|WARNING' "$work/$kind.log"
    check "the $kind game says nothing else" [ $? = 0 ]
done
# seen WHAT: how many pixels of the game's pictures did that.
seen() { sed -n "s/^$1 \([0-9]*\)\$/\1/p" "$work/window.log"; }
if command -v xvfb-run >/dev/null; then
    (cd "$work/out" && own_cache timeout 120 xvfb-run -a -s '-screen 0 640x640x24' \
        ./release.x86_64 --rendering-driver opengl3 --audio-driver Dummy -- --picture "$work/picture.png") >"$work/window.log" 2>&1
    check 'the game shows itself in a window' [ -s "$work/picture.png" ]
    # A screen that nobody sees has no V-Sync, which is a warning.
    ! grep ERROR "$work/window.log"
    check 'its shaders find the wind that its project knows nothing of' [ $? = 0 ]
    check "the project's own value ships: no wind" [ "$(seen 'moved without a TreeWind')" = 0 ]
    check "a TreeWind bends the tree: $(seen bent) pixels" [ "0$(seen bent)" -gt 2000 ]
    check "and moves it: $(seen moved) pixels" [ "0$(seen moved)" -gt 1000 ]
    check 'a wind that stands does not' [ "$(seen 'moved in a wind that stands')" = 0 ]
    check 'without the TreeWind all is as it was' [ "$(seen 'moved afterwards')" = 0 ]
fi

# A library that is missing is told when the game is exported, not when it runs.
lacking=$work/lacking
cp -r "$work/game" "$lacking"
rm "$lacking"/addons/tree_reconstruction/bin/*template_release*
timeout 300 "$GODOT" --headless --path "$lacking" --export-release Linux "$work/out/lacking.x86_64" >"$work/lacking.log" 2>&1
[ $? != 124 ]
check 'an export without its library ends' [ $? = 0 ]
check 'and says in one sentence which one is missing' \
    [ "$(grep -c 'has no library for this export (.*linux.*template_release' "$work/lacking.log")" = 1 ]
# Nor does the editor do anything but say so without its own.
rm -rf "$lacking/.godot" "$lacking"/addons/tree_reconstruction/bin/*
timeout 300 "$GODOT" --headless --path "$lacking" --import --quit-after 200 >"$work/lacking.log" 2>&1
check 'an editor without its library ends' [ $? = 0 ]
check 'it says once that it did not load' [ "$(grep -c '^ERROR: .*native library did not load' "$work/lacking.log")" = 1 ]
! grep -E 'SCRIPT ERROR: Invalid' "$work/lacking.log"
check 'and does nothing else' [ $? = 0 ]
rm -rf "$lacking" "$work"/out/lacking*

# Nothing of the editor ships.
strings -n 8 "$work/out/release.pck" >"$work/names"
# By the pack's own list, and by what its remaps lead to: the engine's cache of uids has the paths of scripts that stay
# out, too, each before a number whose first byte may look like the c of gdc.
! grep -E '(^|path="res://)addons/tree_reconstruction/(editor/.*|plugin)\.(gdc|gd.remap|tscn|po)' "$work/names"
check 'no script of the editor is in the pack' [ $? = 0 ]
grep -q '^addons/tree_reconstruction/nodes/tree_instance_3d.*\.gdc' "$work/names"
check 'the node is in the pack' [ $? = 0 ]
# shipped NAME: how many of the pack's files are pictures or materials of that kind of tree.
shipped() { grep -oE "tree_reconstruction/(textures|presets)/($1)[a-z_/]*\.(tres|png\.import)" "$work/names" | sort -u | wc -l; }
check "the pictures of the game's oak are in the pack" [ "$(shipped oak_)" -ge 8 ]
check 'and those that stand in for missing ones' [ "$(shipped generic_)" -ge 8 ]
check 'those of the kind that a script names' [ "$(shipped birch_)" -ge 8 ]
check 'no other pictures are' [ "$(shipped 'apple|cherry|ginkgo|magnolia|maple|palm|pine|poplar|spruce|willow|twigs')" = 0 ]
libraries=$(cd "$work/out" && ls ./*.so)
check 'only the libraries of the two templates are beside it' \
    [ "$(echo "$libraries" | wc -l)" = 2 ]
! echo "$libraries" | grep editor
check 'not that of the editor' [ $? = 0 ]
for library in "$work"/out/*.so; do
    tests/platforms/carries_editor.sh "$library"
    carries=$?
    check "$(basename "$library") carries nothing of the reconstruction" [ "$carries" = 1 ]
    strangers=$(objdump -p "$library" | sed -n 's/^ *NEEDED *//p' |
        grep -vE '^(libstdc\+\+\.so\.6|libm\.so\.6|libgcc_s\.so\.1|libc\.so\.6|libpthread\.so\.0|ld-linux-.*)$')
    check "and needs no library but the system's ($strangers)" [ -z "$strangers" ]
done
echo "Shipped with a game: $(du -bc "$work"/out/*template_release*.so | tail -n 1 | cut -f 1) bytes of library," \
    "$(stat -c %s "$work/out/release.pck") bytes of pack."
finish
