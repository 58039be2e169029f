# Sourced by benchmark/fandisk and benchmark/conference_room.

# Path of a file or folder of the real data.
experiment_data() {
  local data=${FRESCO_DATA:-../shared/data}
  [ -e "$data/$1" ] || { echo "$data/$1: not there; FRESCO_DATA names the folder of the data" >&2; exit 1; }
  realpath "$data/$1"
}

tool() {
  local name=$1
  shift
  build/bin/"fresco_$name" "$@" -quiet
}

# picture MODEL NAME OPTION...: into the output folder.
picture() {
  tool snapshot "$1" "$out/$2" -size 960x720 -oversampling 2 "${@:3}"
}

table_head() {
  echo '| symmetric error at the vertices | max | mean | RMS | max, % | mean, % | RMS, % | normals, mean degrees | above 20, % | vertices |'
  echo '|---|---|---|---|---|---|---|---|---|---|'
}

# table_row TITLE MESH REFERENCE: of the two directions the larger one.
table_row() {
  build/bin/fresco_compare "$2" "$3" -quiet | awk -v title="$1" '
    $1 == "symmetric" { error = $2 " | " $3 " | " $4 " | " $5 " | " $6 " | " $7 }
    $1 == "normals" { in_normals = 1 }
    in_normals && ($1 == "mesh" || $1 == "reference") && $2 == "to" {
      if ($4 > angle) angle = $4
      if ($7 > share) share = $7
    }
    $1 == "mesh" && $2 == "V" { vertices = $3 }
    END { printf "| %s | %s | %.2f | %.2f | %s |\n", title, error, angle, share, vertices }'
}

# room_row TITLE MESH REFERENCE: from the mesh to the room only, since much of a room is hidden from the scanners.
room_row() {
  build/bin/fresco_compare "$2" "$3" -quiet | awk -v title="$1" '
    $1 == "normals" { in_normals = 1 }
    $1 == "mesh" && $2 == "to" && !in_normals { error = sprintf("%.3f | %.1f | %.1f", $4, 1000 * $5, 1000 * $6) }
    $1 == "mesh" && $2 == "to" && in_normals { angles = sprintf("%.2f | %.1f", $5, $7) }
    $1 == "mesh" && $2 == "V" { size = $3 " | " $5 }
    END { printf "| %s | %s | %s | %s |\n", title, size, error, angles }'
}

# join_pcd OUT FILE...: binary files with the same fields as one.
join_pcd() {
  /usr/bin/python3 - "$@" <<'END'
import re
import sys
bodies, count = [], 0
for path in sys.argv[2:]:
    with open(path, "rb") as file:
        head, body = re.split(rb"(?<=\nDATA binary\n)", file.read(), maxsplit=1)
    count += int(re.search(rb"\nPOINTS (\d+)", head)[1])
    bodies.append(body)
head = re.sub(rb"\n(WIDTH|POINTS) \d+", rb"\n\1 %d" % count, head)
with open(sys.argv[1], "wb") as file:
    file.write(head + b"".join(bodies))
END
}
