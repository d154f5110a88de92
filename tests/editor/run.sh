#!/usr/bin/env bash
# Tests the addon in the real editor, in a window under Xvfb, driven by mouse and keyboard events of the X server.
# ./dev test editor calls it, with GODOT set, project/addons/ built and a sample scan in build/sample/.
#
#   tests/editor/run.sh [NAME…]     all scenarios, or those whose file name contains a NAME
#
# It makes an empty project in a temporary folder with the built addon and test_plugin/ in it, and opens it in the
# editor with settings of its own. A scenario is a script in scenarios/FOLDER/: it runs in the editor, in test_plugin/,
# asserts what it finds there, and asks this script over a socket to press keys and buttons (xdotool), to take
# pictures and to copy files. Each FOLDER is one run of the editor, in alphabetical order, which ends with Ctrl+Q;
# those with the same first letter are on the same project, one after another, and as many projects at once as there are
# cores, each on a screen of its own, the longest first. What the engine reports as an error fails the step in which it appears, unless the
# step expects it. Nothing waits for a fixed time: scenarios wait for what should be there, at most for
# TREE_EDITOR_PATIENCE seconds.
# Pictures: build/editor/FOLDER-NN-name.png; what the editor printed: build/editor/FOLDER.log. Last line: 'N passed, N
# failed'.
set -uo pipefail
cd "$(dirname "$0")/../.."
: "${GODOT:?GODOT must name the engine: ./dev test editor sets it}"
. tests/tools/screen.sh
# Mesa's shaders on the processor: to optimize them takes longer than to draw these few pictures with them as they are.
export GALLIVM_PERF=nopt
root=$PWD
pictures=$root/build/editor
work=$(mktemp -d)
export TREE_EDITOR_SAMPLE=${TREE_EDITOR_SAMPLE:-$root/build/sample/scan.ply}
# Seconds that anything may take on a machine that does something else, too.
export TREE_EDITOR_PATIENCE=${TREE_EDITOR_PATIENCE:-180}
# The whole of one editor's run, in seconds: whatever hangs ends then.
limit=${TREE_EDITOR_LIMIT:-1500}
passed=0
failed=0
shots=0
engine=
screen=
other=
declare -A projects=() # processes by letter

# Ends what this script has started, and nothing else.
cleanup() {
    [ ${#projects[@]} = 0 ] || kill "${projects[@]}" 2>/dev/null
    [ -z "$engine" ] || kill -KILL -- "-$engine" 2>/dev/null
    [ -z "$other" ] || kill "$other" 2>/dev/null
    [ -z "$screen" ] || kill "$screen" 2>/dev/null
    wait 2>/dev/null
    rm -rf "$work"
}
trap cleanup EXIT
trap 'exit 1' INT TERM

open_screen() {
    start_screen 1600x900 "$work/xvfb.log" || {
        cat "$work/xvfb.log"
        count "FAILED  there is no screen"
        exit 1
    }
    # Another program, beyond the screen's edge: focus() says what for.
    xev -name elsewhere -geometry 20x20+1700+1000 >"$work/xev.log" 2>&1 &
    other=$!
}

# make_project LETTER: a game's project as it comes from version control: the addon is in it, nothing is imported. One
# of them shows that the editor gets along with that; for the others, pictures are imported as in project/, which takes
# half of the time until an editor is open.
make_project() {
    rm -rf "$work/project" "$work/config" "$work/data" "$work/cache" "$work/runtime"
    mkdir -p "$work/project/addons" "$work/config/godot" "$work/data" "$work/cache" "$work/runtime"
    chmod 700 "$work/runtime"
    cp -r project/addons/tree_reconstruction "$work/project/addons/"
    mkdir "$work/project/addons/editor_test"
    cp -r tests/editor/test_plugin tests/editor/scenarios "$work/project/addons/editor_test/"
    cp tests/godot/error_collector.gd tests/godot/photo_files.gd tests/godot/trunk_photos.gd tests/godot/leafy_photos.gd tests/godot/photo_model.gd \
        "$work/project/addons/editor_test/test_plugin/"
    # Nobody should see it in the pictures.
    touch "$work/project/addons/editor_test/.gdignore"
    [ "$1" = a ] || { mkdir "$work/project/.godot" && cp -r project/.godot/imported "$work/project/.godot/"; }
    cp tests/editor/project.cfg "$work/project/project.godot"
    cp tests/editor/editor_settings.cfg "$work/config/godot/editor_settings-4.6.tres"
}

count() {
    case $1 in
    ok*) passed=$((passed + 1)) ;;
    FAILED*) failed=$((failed + 1)) ;;
    esac
    printf '%s\n' "$1"
}

picture() {
    shots=$((shots + 1))
    import -window root -define png:compression-level=2 "$pictures/$folder-$(printf '%02d' "$shots")-$1.png"
}

# focus editor, focus elsewhere: where the keyboard goes. There is no window manager that would see to it. Elsewhere is
# a window of its own: with the focus on the root, X tells the window under the pointer that it has it, too.
focus() {
    case $1 in
    editor) xdotool windowfocus "$(xdotool search --onlyvisible --class godot 2>/dev/null | head -n 1)" ;;
    elsewhere) xdotool windowfocus "$(xdotool search --name '^elsewhere$' 2>/dev/null | head -n 1)" ;;
    esac
}

# Does what the scenarios ask for until they end, or the editor does, or stands still: then nothing is asked for, not
# even to say that something was waited for in vain.
serve() {
    local line words
    while IFS= read -r -t $((TREE_EDITOR_PATIENCE * 2)) line <&"$socket"; do
        IFS=$'\t' read -r -a words <<<"$line"
        case ${words[0]} in
        x) xdotool "${words[@]:1}" ;;
        focus) focus "${words[1]}" ;;
        picture) picture "${words[1]}" ;;
        copy) cp "${words[1]}" "${words[2]}.part" && mv "${words[2]}.part" "${words[2]}" ;;
        say) count "${words[1]}" ;;
        end) return 0 ;;
        *) echo "FAILED  a scenario asked for '${words[0]}'" ;;
        esac
        echo >&"$socket"
    done
    return 1
}

is_running() { kill -0 "$engine" 2>/dev/null; }

# wait_until SECONDS COMMAND…
wait_until() {
    local end=$((SECONDS + $1))
    shift
    until "$@"; do
        [ "$SECONDS" -lt "$end" ] || return 1
        sleep 0.1
    done
}

ended() { ! is_running; }
# Asks the editor to close, again and again: it hears no keys while its own progress dialog is up.
closed() {
    ended || xdotool key ctrl+q
    wait_until 5 ended
}
# What it waits for is there, or will never be.
met() { [ -s "$work/port" ] || ended; }

# run_editor FOLDER SCRIPT…: one run of the editor.
run_editor() {
    local folder=$1 log=$pictures/$1.log port status=0
    shift
    echo "-- $folder"
    rm -f "$work/port"
    # Its own (tests/tools/own_cache.sh).
    mkdir -p "$work/mesa-$folder"
    TREE_EDITOR_TEST=$work TREE_EDITOR_SCENARIOS="$*" XDG_CONFIG_HOME=$work/config XDG_DATA_HOME=$work/data XDG_CACHE_HOME=$work/cache \
        XDG_RUNTIME_DIR=$work/runtime MESA_SHADER_CACHE_DIR=$work/mesa-$folder \
        setsid timeout --signal=ABRT --kill-after=10 "$limit" "$GODOT" --rendering-driver opengl3 --audio-driver Dummy --resolution 1600x900 --position 0,0 --verbose \
        --path "$work/project" --editor >"$log" 2>&1 &
    engine=$!
    if wait_until $((TREE_EDITOR_PATIENCE * 3)) met && ! ended; then
        port=$(cat "$work/port")
        exec {socket}<>"/dev/tcp/127.0.0.1/$port"
        if ! serve; then
            if is_running; then
                count "FAILED  $folder: the editor stands still"
                kill -ABRT -- "-$engine"
                wait_until 20 ended || kill -KILL -- "-$engine"
            else
                count "FAILED  $folder: the editor ended before its scenarios did"
            fi
        fi
        exec {socket}>&-
        if is_running; then
            # What is not saved is asked about only where the scenarios left it so: then this does not end.
            wait_until "$TREE_EDITOR_PATIENCE" closed || {
                picture "$folder-does-not-close"
                count "FAILED  $folder: the editor does not close"
            }
        fi
    else
        picture "$folder-does-not-start"
        count "FAILED  $folder: the editor does not start"
    fi
    ! is_running || kill -ABRT -- "-$engine"
    wait "$engine" 2>/dev/null || status=$?
    engine=
    if [ "$status" = 0 ]; then count "ok      $folder: the editor ended well"; else
        tail -n 25 "$log"
        count "FAILED  $folder: the editor ended with status $status"
    fi
    if [ ! -s "$log" ] || grep -E 'ObjectDB instances (were )?leaked|resources still in use|were leaked at exit|Leaked instance:|handle_crash' "$log"; then
        count "FAILED  $folder: something leaked"
    else
        count "ok      $folder: nothing leaked"
    fi
}

# run_project LETTER NAME…: the runs of the editor whose folders begin with that letter.
run_project() {
    local letter=$1 folder scripts script name
    shift
    for folder in tests/editor/scenarios/"$letter"*/; do
        folder=$(basename "$folder")
        scripts=()
        for script in tests/editor/scenarios/"$folder"/*.gd; do
            [ -f "$script" ] || continue
            script=$(basename "$script")
            for name in "${@:-}"; do
                [[ $script == *"$name"* ]] || continue
                scripts+=("res://addons/editor_test/scenarios/$folder/$script")
                break
            done
        done
        [ ${#scripts[@]} -gt 0 ] || continue
        [ -n "$screen" ] || open_screen
        [ -d "$work/project" ] || make_project "$letter"
        run_editor "$folder" "${scripts[@]}"
    done
    echo "$passed passed, $failed failed"
}

# Each project is this script again, with --project LETTER. What they say is printed one after another.
main() {
    local letters letter
    if [ "${1:-}" = --project ]; then
        run_project "${@:2}"
        return
    fi
    rm -rf "$pictures"
    mkdir -p "$pictures"
    letters=$(for folder in tests/editor/scenarios/*/; do basename "$folder" | cut -c 1; done | uniq)
    # The longest first: none is left alone at the end.
    for letter in $(for letter in $letters; do
        echo "$(cat tests/editor/scenarios/"$letter"*/*.gd | wc -c) $letter"
    done | sort -rn | cut -d ' ' -f 2); do
        [ "$(jobs -rp | wc -l)" -lt "$(nproc)" ] || wait -n
        tests/editor/run.sh --project "$letter" "$@" >"$work/$letter" 2>&1 &
        projects[$letter]=$!
    done
    for letter in $letters; do
        wait "${projects[$letter]}" || count "FAILED  $letter: its run did not end"
        grep -vE '^[0-9]+ passed, [0-9]+ failed$' "$work/$letter"
        passed=$((passed + $(grep -c '^ok' "$work/$letter")))
        failed=$((failed + $(grep -c '^FAILED' "$work/$letter")))
    done
    echo "$passed passed, $failed failed"
    [ "$failed" = 0 ] && [ "$passed" -gt 0 ]
}

main "$@"
