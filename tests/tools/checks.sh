# For scripts of tests: counts what they check. The last line is 'N passed, N failed'.
passed=0
failed=0
# check WHAT COMMAND…
check() {
    local what=$1
    shift
    if "$@"; then
        echo "ok      $what"
        passed=$((passed + 1))
    else
        echo "FAILED  $what"
        failed=$((failed + 1))
    fi
}
finish() {
    echo "$passed passed, $failed failed"
    [ "$failed" = 0 ]
    exit
}
