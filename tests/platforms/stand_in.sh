# For scripts of tests: shows of a library that the stand-in for the engine (stand_in_host.cpp) can start and end it.
# Wants checks.sh, and $work for its logs.

# What a template registers; the editor's library has more.
runtime='LSystem LeafRule TreeEdit TreeReconstruction TreeSketch'

# stand_in_table: what the host is compiled with, in $work.
stand_in_table() {
    python3 tests/platforms/stand_in_table.py build/gdextension/gdextension_interface.h >"$work/stand_in_table.inc"
}

# check_library TARGET LIBRARY HOST…: HOST is the command that runs the stand-in on the library.
check_library() {
    local target=$1 library=$2 classes carries=0
    shift 2
    "$@" "$library" 2>&1 | tr -d '\r' >"$work/$target.log"
    check "$target: starts, finds all functions of the engine and ends" grep -q '^ended$' "$work/$target.log"
    check "$target: no error in between" [ "$(grep -cE '^(error|missing)' "$work/$target.log")" = 0 ]
    classes=$(sed -n 's/^class \([^ ]*\) .*/\1/p' "$work/$target.log" | LC_ALL=C sort | tr '\n' ' ')
    tests/platforms/carries_editor.sh "$library" || carries=$?
    if [ "$target" = editor ]; then
        check "$target: registers the editor's classes" [ "$classes" != "$runtime " ]
        check "$target: has the class reference" grep -qE 'methods, [1-9][0-9]* pages' "$work/$target.log"
        check "$target: carries the reconstruction" [ "$carries" = 0 ]
    else
        check "$target: registers the classes of a game alone" [ "$classes" = "$runtime " ]
        check "$target: carries nothing of the reconstruction" [ "$carries" = 1 ]
    fi
    echo "        $(stat -c %s "$library") bytes"
}
