#!/usr/bin/env bash
# The film of docs/store/, of its pictures, of four that are drawn here, and of two of docs/captures/: make_store.sh reads
# this in.
clips=$work/clips
mkdir -p "$clips"

# card NAME TITLE TEXT: the icon beside words.
card() { draw gl_compatibility card "$clips/$1.png" "$out/icon_512.png" "$2" "$3"; }

encode() { ffmpeg -loglevel error -y "$@"; }
packed=(-r 24 -c:v libx264 -preset medium -crf 14 -pix_fmt yuv420p)

# still NAME PICTURE SECONDS: goes slowly nearer. It is enlarged before, or whole pixels would be seen to jump.
still() {
    encode -loop 1 -t "$3" -i "$2" -vf "scale=3840:2160,zoompan=z='1+0.05*on/(24*$3)':x='(iw-iw/zoom)/2':y='(ih-ih/zoom)/2':d=1:s=1280x720:fps=24" \
        -t "$3" "${packed[@]}" "$clips/$1.mp4"
}

# standing NAME PICTURE SECONDS: as it is.
standing() { encode -loop 1 -t "$3" -i "$2" -vf scale=1280:720 "${packed[@]}" "$clips/$1.mp4"; }

# beside NAME SECONDS FILM FILM TITLE TEXT: two films of docs/captures, of 640 x 360 pixels each, under words.
beside() {
    local film
    for film in "$3" "$4"; do
        mkdir -p "$clips/$film"
        python3 -c 'import sys; from PIL import Image, ImageSequence
for i, frame in enumerate(ImageSequence.Iterator(Image.open(sys.argv[1]))):
    frame.convert("RGB").save("%s/%04d.png" % (sys.argv[2], i))' "docs/captures/$film.webp" "$clips/$film"
    done
    card "$1" "$5" "$6"
    encode -loop 1 -i "$clips/$1.png" -stream_loop -1 -framerate 12 -i "$clips/$3/%04d.png" -stream_loop -1 -framerate 12 -i "$clips/$4/%04d.png" \
        -filter_complex '[0:v]crop=1280:288:0:216,pad=1280:720:0:0:color=0x10222e[page];[page][1:v]overlay=0:320[one];[one][2:v]overlay=640:320' \
        -t "$2" "${packed[@]}" "$clips/$1.mp4"
}

card title 'Tree Reconstruction' 'Real trees for Godot games'
card end 'Godot 4.6 and newer' 'Open source. Your trees are yours.'
draw "$renderer" stages "$clips" "$(scan rtls_leafy_urban.txt)" ''
standing 1 "$clips/title.png" 2.5
still 2 "$out/1_photos.jpg" 4.5
for i in 0 1 2 3; do
    standing $((3 + i)) "$clips/$i.png" 3
done
still 7 "$out/4_graft.jpg" 4.5
beside 8 7 one_tree felling 'Seasons, ages, felling' 'All of it while the game runs'
still 9 "$out/5_forest.jpg" 4.5
standing 10 "$clips/end.png" 2.5

# One fades into the next.
inputs=() graph='' last='[0:v]' at=0
for i in 1 2 3 4 5 6 7 8 9 10; do
    inputs+=(-i "$clips/$i.mp4")
    if [ $i -gt 1 ]; then
        graph+="$last[$((i - 1)):v]xfade=duration=0.7:offset=$at[v$i];"
        last="[v$i]"
    fi
    long=$(ffprobe -v error -show_entries format=duration -of csv=p=0 "$clips/$i.mp4")
    at=$(awk -v a="$at" -v l="$long" 'BEGIN { printf "%.3f", a + l - 0.7 }')
done
encode "${inputs[@]}" -filter_complex "${graph%;}" -map "$last" -c:v libx264 -preset veryslow -crf 30 -pix_fmt yuv420p \
    -movflags +faststart "$out/film.mp4"
echo "docs/store/film.mp4: $(($(stat -c %s "$out/film.mp4") / 1024)) kB"
