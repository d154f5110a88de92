#!/usr/bin/env bash
# Films scenes of the demo project for README: docs/captures/NAME.webp, some seconds each; sketch: docs/sketch.webp; bark_post: docs/bark_post.webp; bark_presets: docs/bark_presets.webp, a picture; gust: docs/wind/gust.webp. (The forest is too much for
# a software rasterizer; docs/game/forest.jpg is one picture of it.) Run './dev demo' before,
# on a machine that does nothing else; then, with GODOT naming the engine and img2webp (Debian's package webp) at hand,
#
#   tests/captures/make_captures.sh [NAME…]
set -euo pipefail
cd "$(dirname "$0")/../.."
: "${GODOT:?GODOT must name the engine; './dev godot --version' finds one}"
. tests/tools/own_cache.sh
mkdir -p docs/captures
frames=$(mktemp -d)
trap 'rm -rf "$frames"' EXIT

for name in "${@:-one_tree scan_and_tree felling}"; do
    for scene in $name; do
        rm -f "$frames"/*
        if [ "$scene" = sketch ]; then
            own_cache xvfb-run -a "$GODOT" --path project --rendering-driver opengl3 --audio-driver Dummy \
                --resolution 160x120 --script "$PWD/tests/captures/sketch_film.gd" -- "$PWD/tests/sketch/cases/maple.json" "$frames"
            ffmpeg -loglevel error -y -framerate 7 -i "$frames/%04d.png" -loop 0 -quality 70 docs/sketch.webp
            continue
        fi
        if [ "$scene" = bark_post ]; then
            : "${PINE:?PINE must name the skeleton of a scanned pine, as 'treerec reconstruct' makes it}"
            own_cache xvfb-run -a "$GODOT" --path project --rendering-driver opengl3 --audio-driver Dummy \
                --resolution 160x120 --script "$PWD/tests/captures/bark_film.gd" -- "$PINE" "$frames" oak
            ffmpeg -loglevel error -y -framerate 14 -i "$frames/%04d.png" -loop 0 -quality 70 docs/bark_post.webp
            continue
        fi
        if [ "$scene" = gust ]; then
            : "${SCAN:?SCAN must name a scan of a tree}"
            own_cache xvfb-run -a "$GODOT" --path project --rendering-driver opengl3 --audio-driver Dummy \
                --resolution 160x120 --script "$PWD/tests/captures/wind_film.gd" -- "$SCAN" oak "$frames"
            ffmpeg -loglevel error -y -framerate 12 -i "$frames/%04d.png" -loop 0 -quality 60 docs/wind/gust.webp
            continue
        fi
        if [ "$scene" = bark_presets ]; then
            : "${SKELETONS:?SKELETONS must name those of three scans, as 'treerec reconstruct' makes them}"
            rows=()
            for tree in $SKELETONS; do
                row="$frames/${#rows[@]}.png"
                own_cache xvfb-run -a "$GODOT" --path project --rendering-driver opengl3 --audio-driver Dummy \
                    --resolution 160x120 --script "$PWD/tests/captures/barks.gd" -- "$tree" "$row" oak
                rows+=(-i "$row")
            done
            ffmpeg -loglevel error -y "${rows[@]}" -filter_complex "vstack=inputs=$((${#rows[@]} / 2)),scale=1280:-2:flags=lanczos" \
                -quality 80 docs/bark_presets.webp
            continue
        fi
        # A fixed rate: what moves moves by a frame's time in each picture, however long it takes to draw.
        own_cache xvfb-run -a -s '-screen 0 640x360x24' "$GODOT" --path project --rendering-driver opengl3 --audio-driver Dummy \
            --resolution 640x360 --fixed-fps 12 --script "$PWD/tests/captures/film.gd" -- "$scene" "$frames"
        # A whole picture now and then: what is left out of the others as too faint would add up.
        img2webp -loop 0 -kmin 3 -kmax 6 -lossy -q 62 -m 5 -d 83 "$frames"/*.png -o "docs/captures/$scene.webp"
        echo "docs/captures/$scene.webp: $(($(stat -c %s "docs/captures/$scene.webp") / 1024)) kB"
    done
done
