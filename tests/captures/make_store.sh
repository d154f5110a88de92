#!/usr/bin/env bash
# Draws the icon, the pictures and the film of docs/store/, by the names below, or all of them. Build before (./dev build,
# ./dev demo), on a machine that does nothing else; ffmpeg, python3-pil and what './dev test editor' needs must be there, and
#
#   GODOT=…     the engine ('./dev godot --version' finds one)
#   SCANS=…     a folder with the scans that are named below
#   GARDEN=…    photos of a garden and what 'treerec photos' made of them: GARDEN/photos and GARDEN/out/cloud.ply.
#               CONTRIBUTING.md tells how; a folder of photos of your own, so arranged, will do as well.
#
#   tests/captures/make_store.sh [icon] [photos] [same] [skeleton] [tree] [graft] [forest] [film]
#
# The forest is drawn by Forward+, the others by Compatibility, which a processor alone draws in minutes, or as RENDERER=forward_plus
# says.
set -euo pipefail
cd "$(dirname "$0")/../.."
: "${GODOT:?GODOT must name the engine; './dev godot --version' finds one}"
. tests/tools/own_cache.sh
out=$PWD/docs/store
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$out"
renderer=${RENDERER:-gl_compatibility}

scan() {
    local path=${SCANS:?SCANS must name the folder of scans}/$1
    [ -e "$path" ] || {
        echo "There is no scan $path." >&2
        exit 1
    }
    echo "$path"
}

# draw METHOD ARGS…: store.gd in a window that nobody sees.
draw() {
    local method=$1 driver=vulkan
    shift
    [ "$method" != gl_compatibility ] || driver=opengl3
    own_cache xvfb-run -a "$GODOT" --path project --rendering-driver $driver --rendering-method "$method" --audio-driver Dummy \
        --resolution 160x120 --script "$PWD/tests/captures/store/store.gd" -- "$@" >"$work/log" 2>&1 || {
        tail -n 20 "$work/log" >&2
        exit 1
    }
}

# words WHERE NAME NUMBER TITLE TEXT: docs/store/NUMBER_NAME.jpg of the picture NAME.
words() {
    draw gl_compatibility "$1" "$out/$3_$2.jpg" "$work/$2.png" "$3" "$4" "$5"
    echo "docs/store/$3_$2.jpg: $(($(stat -c %s "$out/$3_$2.jpg") / 1024)) kB"
}

# shot NAME FILE: the editor's picture NAME of the scenario 'tour', with a scan of the user's own.
shot() {
    local from
    from=$(find build/editor -name "*-tour-$1.png" 2>/dev/null | sort | tail -n 1)
    if [ -z "$from" ] || [ ! -e build/editor/of_store ]; then
        # The tour calls it a PLY file.
        bin/treerec reconstruct "$(scan rtls_leafy_urban.txt)" --cloud "$work/street.ply" -o "$work/street.txt" --quiet
        TREE_EDITOR_SAMPLE=$work/street.ply tests/editor/run.sh tour >"$work/log" 2>&1 || {
            grep FAILED "$work/log" >&2
            exit 1
        }
        touch build/editor/of_store
        from=$(find build/editor -name "*-tour-$1.png" | sort | tail -n 1)
    fi
    cp "$from" "$2"
}

woods() {
    printf '%s\n' "$(scan wytham_Tf8_ash.txt)" oak "$(scan wytham_Tf18_birch.txt)" birch "$(scan wytham_Tf15_sycamore.txt)" maple
}

for name in "${@:-icon photos same skeleton tree graft forest film}"; do
    for picture in $name; do
        case $picture in
        icon) draw gl_compatibility icon "$out/icon.svg" "$out" ;;
        photos)
            draw "$renderer" photos "$work/photos.png" "${GARDEN:?GARDEN must name the folder of the photos}/out/cloud.ply" "$GARDEN/photos"
            words foot photos 1 'From photos, or a laser scan' 'Where each photo of a walk was taken, and the points that they agree on'
            ;;
        same) draw "$renderer" same "$out/photo_and_tree.jpg" "${GARDEN:?GARDEN must name the folder of the photos}/out/cloud.ply" "$GARDEN/photos" oak ;;
        skeleton)
            shot scan "$work/skeleton.png"
            words head skeleton 2 'To a skeleton, in the editor' 'Drop a scan into the project. P lays its points over the tree that was made of them'
            ;;
        tree)
            draw "$renderer" tree "$work/tree.png" "$(scan rtls_leafy_urban.txt)" ''
            words foot tree 3 'To a tree' 'Bark, leaves and wind; levels of detail, collision, and a fall when it is cut'
            ;;
        graft)
            # Those of docs/first_tree.md (tests/editor/make_pictures.sh), without what the editor says below them.
            convert docs/editor/branch.jpg docs/editor/graft.jpg +append -crop 1800x695+0+0 +repage "$work/graft.png"
            words head graft 4 'That you shape' 'Cut, prune, bend, grow, graft: each tool shows what a click would do, and each click is one undo'
            ;;
        forest)
            mapfile -t trees < <(woods)
            draw forward_plus forest "$work/forest.png" "${trees[@]}"
            words foot forest 5 'To a forest' 'Thousands of individuals of your scans, of all ages, and none is a copy'
            ;;
        film) . tests/captures/store/film.sh ;;
        *)
            echo "There is no picture '$picture'; the names are in this file." >&2
            exit 1
            ;;
        esac
    done
done
