# For scripts of tests: a screen that nobody sees.
#
# start_screen SIZE LOG: an X server of that size ("1600x900") on a number that nobody else has, to which DISPLAY points
# from now on. Its process is $screen, which the caller ends; what it says is in LOG. Fails where none starts.
start_screen() {
    local number tries
    number=$(mktemp)
    Xvfb -displayfd 3 -screen 0 "$1x24" -nolisten tcp 3>"$number" 2>"$2" &
    screen=$!
    for tries in $(seq 200); do
        [ ! -s "$number" ] || break
        sleep 0.05
    done
    DISPLAY=:$(cat "$number")
    rm -f "$number"
    export DISPLAY
    [ "$DISPLAY" != : ]
}
