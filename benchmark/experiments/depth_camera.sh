#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Surfaces of an RGB-D folder against depth images that were kept out: ours and fusion by Open3D, in one run.
#   depth_camera.sh BUILD FOLDER KEPT_OUT JUDGE WORK
# FOLDER is an RGB-D folder, KEPT_OUT another one of the same sequence, JUDGE a program that prints figures of
# "MESH KEPT_OUT [--align]". Figures with the frames' poses as given, then with refined ones (--align: each kept-out frame
# is moved onto the mesh first).
set -euo pipefail
[ $# -eq 5 ] || { sed -n '3,7s/^# \{0,1\}//p' "$0" >&2; exit 2; }
build=$1 folder=$2 kept=$3 judge=$4 work=$5
peers=$(cd "$(dirname "$0")/../peers" && pwd)
mkdir -p "$work"
/usr/bin/python3 "$peers/open3d_tsdf.py" "$folder" "$work/tsdf_10mm.ply" --cell 0.01
/usr/bin/python3 "$peers/open3d_tsdf.py" "$folder" "$work/tsdf_5mm.ply" --cell 0.005
"$build/bin/fresco_model" "$folder" "$work/given" -use_poses -quiet
"$build/bin/fresco_model" "$folder" "$work/refined" -quiet
for align in "" --align; do
  echo "kept-out frames: ${align:-poses as given}"
  for mesh in tsdf_10mm.ply tsdf_5mm.ply given/work/surface.ply given/mesh.ply refined/work/surface.ply refined/mesh.ply; do
    printf '%-26s ' "$mesh"
    "$judge" "$work/$mesh" "$kept" $align
  done
done
