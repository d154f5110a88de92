#!/usr/bin/env bash
# Tries addons/sign_macos.sh with stand-ins for Apple's tools, which write down how they are called. The last line is
# 'N passed, N failed'.
set -uo pipefail
cd "$(dirname "$0")/../.."
. tests/tools/checks.sh

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/tools" "$work/bin" "$work/empty"
touch "$work/bin/one.dylib" "$work/bin/two.dylib"
cat >"$work/tools/stand_in" <<'TOOL'
#!/bin/sh
echo "$(basename "$0") $*" >>"$CALLS"
case "$(basename "$0") $1" in
'security find-identity') printf '%s\n' "$IDENTITY" ;;
'xcrun notarytool') printf '%s\n' "$ANSWER" ;;
'uuidgen ') echo secret ;;
esac
TOOL
chmod +x "$work/tools/stand_in"
for name in security codesign ditto xcrun uuidgen; do
    ln -s stand_in "$work/tools/$name"
done
# sign FOLDER [NAME=VALUE…]: with all that it needs, but for what is set otherwise.
sign() {
    local folder=$1
    shift
    rm -f "$work/calls"
    env PATH="$work/tools:$PATH" CALLS="$work/calls" IDENTITY='  1) 0A "Developer ID Application: Somebody (TEAM)"' \
        ANSWER='{"id":"1","status":"Accepted"}' CERTIFICATE="$(printf 'p12' | base64)" CERTIFICATE_PASSWORD=word \
        APPLE_ID=somebody TEAM=TEAM PASSWORD=other "$@" addons/sign_macos.sh "$folder" >"$work/out" 2>&1
}

check 'both libraries are signed and accepted' sign "$work/bin"
check 'with the certificate, a time stamp and the hardened runtime' [ "$(grep -c \
    '^codesign --force --timestamp --options runtime .* --sign Developer ID Application: Somebody (TEAM) .*dylib$' "$work/calls")" = 2 ]
check 'the keychain goes at the end' sh -c "tail -n 1 '$work/calls' | grep -q '^security delete-keychain'"
! sign "$work/bin" ANSWER='{"id":"1","status":"Invalid"}'
check 'what Apple refuses is a failure, though its tool ends well' [ $? = 0 ]
! sign "$work/bin" IDENTITY='     0 valid identities found'
check 'so is a certificate of another kind' [ $? = 0 ]
! sign "$work/bin" TEAM= && grep -q 'TEAM is not set' "$work/out"
check 'a secret that is missing is named' [ $? = 0 ]
! sign "$work/empty"
check 'a folder without libraries is a failure' [ $? = 0 ]
finish
