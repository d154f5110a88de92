#!/usr/bin/env bash
# Signs the macOS libraries in a folder with a Developer ID, and has Apple notarize them. release.yml calls it where the
# secrets are there (docs/release.md):
#
#   CERTIFICATE=… CERTIFICATE_PASSWORD=… APPLE_ID=… TEAM=… PASSWORD=… addons/sign_macos.sh FOLDER
set -euo pipefail
folder=${1:?Which folder has the libraries?}
for name in CERTIFICATE CERTIFICATE_PASSWORD APPLE_ID TEAM PASSWORD; do
    [ -n "${!name:-}" ] || {
        echo "sign_macos.sh: $name is not set; docs/release.md lists the secrets." >&2
        exit 2
    }
done
shopt -s nullglob
libraries=("$folder"/*.dylib)
[ ${#libraries[@]} -gt 0 ] || {
    echo "sign_macos.sh: there is no library in $folder." >&2
    exit 2
}

work=$(mktemp -d)
keychain=$work/signing.keychain-db
cleanup() {
    security delete-keychain "$keychain" >/dev/null 2>&1 || true
    rm -rf "$work"
}
trap cleanup EXIT

# A keychain of its own, open for this run alone.
secret=$(uuidgen)
printf '%s' "$CERTIFICATE" | base64 --decode >"$work/certificate.p12"
security create-keychain -p "$secret" "$keychain"
security set-keychain-settings -lut 3600 "$keychain"
security unlock-keychain -p "$secret" "$keychain"
security import "$work/certificate.p12" -k "$keychain" -P "$CERTIFICATE_PASSWORD" -T "$(command -v codesign)"
security set-key-partition-list -S apple-tool:,apple: -s -k "$secret" "$keychain" >/dev/null
identity=$(security find-identity -v -p codesigning "$keychain" | sed -n 's/.*"\(Developer ID Application: .*\)".*/\1/p' | head -n 1)
[ -n "$identity" ] || {
    echo "sign_macos.sh: the certificate is no 'Developer ID Application' one." >&2
    exit 2
}
for library in "${libraries[@]}"; do
    codesign --force --timestamp --options runtime --keychain "$keychain" --sign "$identity" "$library"
    codesign --verify --strict "$library"
done

# notarytool ends well for what Apple refuses, too: its answer counts.
ditto -c -k "$folder" "$work/libraries.zip"
answer=$(xcrun notarytool submit "$work/libraries.zip" --wait --output-format json \
    --apple-id "$APPLE_ID" --team-id "$TEAM" --password "$PASSWORD")
case $answer in
*'"status":"Accepted"'* | *'"status": "Accepted"'*) echo "${#libraries[@]} libraries are signed and notarized." ;;
*)
    echo "sign_macos.sh: Apple did not accept them: $answer" >&2
    exit 1
    ;;
esac
