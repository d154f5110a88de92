#!/usr/bin/env bash
# Cuts the pictures of docs/first_tree.md out of those that the editor's test has left in build/editor/ (run
# './dev test editor' before, on a machine that does nothing else) and writes them to docs/editor/.
set -euo pipefail
cd "$(dirname "$0")/../.."
mkdir -p docs/editor

# cut NAME GEOMETRY WIDTH: build/editor/NN-tour-NAME.png as docs/editor/NAME.jpg.
cut() {
    local from
    from=$(find build/editor -name "*-tour-$1.png" | sort | tail -n 1)
    [ -n "$from" ] || {
        echo "There is no picture '$1' in build/editor/." >&2
        exit 1
    }
    convert "$from" -crop "$2" +repage -resize "$3x" -sampling-factor 4:2:0 -strip -interlace Plane -quality 84 \
        "docs/editor/$1.jpg"
    echo "docs/editor/$1.jpg: $(($(stat -c %s "docs/editor/$1.jpg") / 1024)) kB"
}

cut menu 1240x900+0+0 900
cut tree 1600x900+0+0 900
cut scan 855x700+358+145 900
cut branch 855x700+358+145 900
cut graft 855x700+358+145 900
cut leaves 1600x900+0+0 900
cut sketch 1600x900+0+0 900
cut sketch_view 1600x900+0+0 900
