#!/bin/sh
# `talus plot --animate --format mp4` with ffmpeg itself: a film that players play, a frame for each state, and none where it fails.
. "$(dirname "$0")/library.sh"
for program in gnuplot ffmpeg ffprobe; do
  command -v $program >/dev/null || { echo "skipped: there is no $program"; exit 77; }
done
cantilever >case.yaml
expect "a run" 0 "$talus" run case.yaml --out run --set analysis.steps=4 --set output.every="{steps: 1}"
states=$(ls run/points_*.hdf | wc -l)

# Sizes of films in yuv420p, which every player takes, are even.
for size in 640x480 481x333; do
  expect "a film of $size" 0 "$talus" plot run --animate --size $size --out film.mp4
  says out.txt "picture = film.mp4"
  ffprobe -v error -count_frames -show_entries stream=codec_name,pix_fmt,width,height,nb_read_frames -of default=nk=1:nw=1 film.mp4 >got.txt 2>&1
  w=${size%x*} h=${size#*x}
  [ "$(tr '\n' ' ' <got.txt)" = "h264 $((w / 2 * 2)) $((h / 2 * 2)) yuv420p $states " ] || fail "$name: $(tr '\n' ' ' <got.txt)"
done

# The film shows what the GIF shows: its last frame in grey, to a few parts of 255.
expect "a GIF" 0 "$talus" plot run --animate --size 640x480 --format gif --out film.gif
expect "a film again" 0 "$talus" plot run --animate --size 640x480 --out film.mp4
for kind in gif mp4; do ffmpeg -v error -y -i film.$kind -vf "select=eq(n\,$((states - 1)))" -frames:v 1 -f rawvideo -pix_fmt gray $kind.raw; done
apart=$(cmp -l gif.raw mp4.raw | awk '{ a = int($2 / 100) * 64 + int($2 / 10) % 10 * 8 + $2 % 10; b = int($3 / 100) * 64 + int($3 / 10) % 10 * 8 + $3 % 10; s += (a - b) ^ 2 }
  END { print int(10 * sqrt(s / (640 * 480))) }')
[ "$(wc -c <mp4.raw)" -eq 307200 ] && [ "$apart" -lt 60 ] || fail "the film's last frame is $apart tenths of 255 from the GIF's"

# An ffmpeg that gives up, or is killed: told, and nothing is left.
mkdir bin
for how in 'exec '"$(command -v ffmpeg)"' -loglevel error -f gif -i no-such-file -f null -' 'kill -9 $$'; do
  printf '#!/bin/sh\n%s\n' "$how" >bin/ffmpeg
  chmod +x bin/ffmpeg
  rm -f film.mp4
  expect "ffmpeg fails" 2 env PATH="$PWD/bin:$PATH" "$talus" plot run --animate --out film.mp4
  case $how in
    kill*) says err.txt "ffmpeg could not draw the picture: it was killed by signal 9" ;;
    *) says err.txt "ffmpeg could not draw the picture: no-such-file: No such file" ;;
  esac
  ls | grep -q -e film.mp4 && fail "$name: something is left: $(ls | tr '\n' ' ')"
done
finish
