#!/usr/bin/env bash
# A folder of scans becomes a forest, the same one however often it was stopped and on however many cores. ./dev test
# forest calls it with GODOT set and the forest's Python environment. The last line is 'N passed, N failed'.
set -uo pipefail
cd "$(dirname "$0")/../.."
python=$1/bin/python
. tests/tools/checks.sh

work=$PWD/build/forest
rm -rf "$work"
mkdir -p "$work"
"$python" tests/forest/make_scans.py "$work/scans" bin/treerec

# forest OUT CORES [ARGS…]: a run, with its log beside OUT.
forest() {
    ./dev forest "$work/scans" --out "$1" --cores "$2" "${@:3}" >"$1.log" 2>&1 9>&-
}
# What a forest is for, without the bookkeeping of its runs.
digests() {
    (cd "$1" && find . -path ./work -prune -o -path ./.snakemake -prune -o -path ./.godot -prune -o -type f \
        ! -name .lock ! -name '*.import' -print0 | sort -z | xargs -0 sha256sum)
}
dates() {
    find "$1" -path "$1/.snakemake" -prune -o -type f ! -name .lock -printf '%p %T@\n' | sort
}

check 'other tools that were installed meanwhile have left these alone' "$python" -c 'import snakemake'
check 'a folder with a broken scan is done' forest "$work/two" 2
check 'its rows, tables and catalogue' "$python" tests/forest/check_forest.py "$work/two"
# It comes from one folder and goes to another: nothing in it is to name either.
check 'no file of it names the folder' [ -z "$(grep -rlF "$work" "$work/two" --include='*.tscn' --include='*.csv' \
    --include='*.html' --include='*.glb' --include='*.txt' --exclude-dir=.snakemake --exclude-dir=work)" ]

before=$(dates "$work/two")
forest "$work/two" 2
check 'a second run has nothing to do' [ "$before" = "$(dates "$work/two")" ]

# On one core, killed when some trees are done and some are not.
set -m
forest "$work/one" 1 &
run=$!
set +m
for ((i = 0; i < 1200; i++)); do
    [ "$(find "$work/one/work/rows" -name '*.json' 2>/dev/null | wc -l)" -lt 2 ] || break
    sleep .1
done
kill -9 -- "-$run"
wait "$run" 2>/dev/null
done_before=$(find "$work/one/work/rows" -name '*.json' | sort | head -n 2)
dates_before=$(stat -c %Y $done_before)
check 'a run that is killed in its midst is not done' [ ! -e "$work/one/catalogue.html" ]
check 'another run goes on from there' forest "$work/one" 1
check 'what was done is not done again' [ "$dates_before" = "$(stat -c %Y $done_before)" ]
check 'and the bytes are those of two cores and no kill' [ "$(digests "$work/one")" = "$(digests "$work/two")" ]

exec 8>"$work/one/.lock"
flock 8
forest "$work/one" 1
check 'two runs in one folder keep apart' grep -q 'Another run is at work' "$work/one.log"
exec 8>&-

mkdir -p "$work/empty"
./dev forest "$work/empty" >"$work/empty.log" 2>&1
check 'an empty folder is told so' grep -q 'There is no scan in' "$work/empty.log"

# An engine that ends in the midst of one tree.
cat >"$work/dying" <<END
#!/usr/bin/env bash
"$GODOT" "\$@" | while IFS= read -r line; do
    echo "\$line"
    if [ "\$line" = "BEGIN conifer" ]; then
        kill -9 \$\$
        exit
    fi
done
END
chmod +x "$work/dying"
cp -r "$work/two" "$work/ended"
rm -rf "$work/ended/work/baked" "$work/ended/work/bakes" "$work/ended/forest.tscn"
check 'an engine that ends over a tree stops nothing' forest "$work/ended" 1 --config godot="$work/dying"
check 'the tree is told of' grep -q '^conifer,.*It is not in the scene: The engine ended' "$work/ended/trees.csv"
check 'the others are in the scene' [ "$(grep -c 'type="PackedScene" path="trees/' "$work/ended/forest.tscn")" = 7 ]

forest "$work/ended" 1 --config godot=
check 'without an engine it ends, and says so' grep -q 'The scene was left out' "$work/ended.log"
check 'and there is none' [ ! -e "$work/ended/forest.tscn" ]
check 'all else is there' [ "$(cut -d, -f1-18 "$work/ended/trees.csv")" = "$(cut -d, -f1-18 "$work/two/trees.csv")" ]

"$GODOT" --headless --path "$work/two" --import >"$work/import.log" 2>&1
check 'the engine imports it without an error' [ -z "$(grep -E '^(ERROR|SCRIPT ERROR)' "$work/import.log")" ]
"$GODOT" --headless --path "$work/two" --script "$PWD/tests/forest/open_forest.gd" >"$work/open.log" 2>&1
grep '^WRONG' "$work/open.log"
check 'the scene opens, and the trees stand on their ground' grep -q '^OPENED' "$work/open.log"
finish
