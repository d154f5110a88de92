#!/usr/bin/env bash
# Films the scenes of the demo project for README: docs/captures/NAME.webp, some seconds each. Run './dev demo' before,
# on a machine that does nothing else; then, with GODOT naming the engine,
#
#   tests/captures/make_captures.sh [NAME…]
set -euo pipefail
cd "$(dirname "$0")/../.."
: "${GODOT:?GODOT must name the engine; './dev godot --version' finds one}"
mkdir -p docs/captures
frames=$(mktemp -d)
trap 'rm -rf "$frames"' EXIT

for name in "${@:-one_tree scan_and_tree forest felling}"; do
    for scene in $name; do
        rm -f "$frames"/*
        # A fixed rate: what moves moves by a frame's time in each picture, however long it takes to draw.
        xvfb-run -a -s '-screen 0 640x360x24' "$GODOT" --path project --rendering-driver opengl3 --audio-driver Dummy \
            --resolution 640x360 --fixed-fps 12 --script "$PWD/tests/captures/film.gd" -- "$scene" "$frames"
        convert -delay 8 "$frames"/*.png -define webp:method=5 -quality 62 -loop 0 "docs/captures/$scene.webp"
        echo "docs/captures/$scene.webp: $(($(stat -c %s "docs/captures/$scene.webp") / 1024)) kB"
    done
done
