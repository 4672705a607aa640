#!/bin/sh
# folders.sh SOURCE: a folder of src holds what a person can hold in mind, and a room's README.md names the folders in it.
cd "$1" || exit 2
find src -mindepth 1 -type d | sort | {
  status=0
  while read -r folder; do
    files=$(find "$folder" -maxdepth 1 -type f | wc -l)
    [ "$files" -le 17 ] || { echo "$folder holds $files files: about 15 are enough"; status=1; }
    room=$(echo "$folder" | cut -d/ -f1-2)
    [ "$folder" = "$room" ] || grep -qF "${folder#"$room"/}" "$room/README.md" || { echo "$room/README.md does not name $folder"; status=1; }
  done
  exit $status
}
