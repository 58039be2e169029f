#!/usr/bin/env bash
# Installs the Debian packages on a clean Debian, runs the tools there, and removes them again. As root:
#   test/package/deb_test.sh PACKAGE_DIR [CHROOT [SUITE]]   CHROOT is made by debootstrap where it is missing, of bookworm
# PACKAGE_DIR: as cpack -G DEB writes it (cmake --preset package, cmake --build --preset package --target package).
set -euo pipefail
[ $# -ge 1 ] && [ "$(id -u)" -eq 0 ] || { sed -n '2,4s/^# //p' "$0" >&2; exit 2; }
packages=$(realpath "$1") root=$(realpath -m "${2:-/var/tmp/fresco-clean}")
[ -x "$root/usr/bin/apt-get" ] || debootstrap --variant=minbase "${3:-bookworm}" "$root" http://deb.debian.org/debian
echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/quick"
inside() { chroot "$root" env DEBIAN_FRONTEND=noninteractive LC_ALL=C PATH=/usr/sbin:/usr/bin:/sbin:/bin "$@"; }
mount -t proc proc "$root/proc"
trap 'umount "$root/proc"' EXIT
rm -rf "$root/packages" "$root/job"
mkdir "$root/packages" "$root/job"
cp "$packages"/*.deb "$root/packages/"
cp /etc/resolv.conf "$root/etc/resolv.conf"
list() { (cd "$root" && find usr etc -name '*fresco*' | sort); }

[ -z "$(list)" ] || { echo "the system is not clean: $(list)" >&2; exit 1; }
inside apt-get -q update >/dev/null
inside sh -c 'apt-get -q -y install --no-install-recommends /packages/libfresco0*.deb /packages/fresco-tools_*.deb' >"$root/job/install.log" 2>&1 ||
  { tail -20 "$root/job/install.log" >&2; exit 1; }
for tool in $(cd "$root/usr/bin" && ls fresco_*); do
  inside "$tool" -h >"$root/job/$tool.txt"
  [ -f "$root/usr/share/man/man1/$tool.1.gz" ] || { echo "$tool has no manual page" >&2; exit 1; }
done
cat >"$root/job/cube.obj" <<'END'
v 0 0 0
v 2 0 0
v 2 2 0
v 0 2 0
v 0 0 2
v 2 0 2
v 2 2 2
v 0 2 2
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 3 4 8 7
f 2 3 7 6
f 1 5 8 4
END
inside sh -ec 'cd /job
fresco_scan cube.obj scan -stations 1 -points 20000 -no_images -quiet
fresco_filter scan/scans/scan_00.pcd clean.pcd -veil 20 -quiet
fresco_normals clean.pcd oriented.pcd -bilateral 1 -quiet
fresco_reconstruct oriented.pcd mesh.ply -depth 6 -quiet
fresco_compare mesh.ply mesh.ply >compare.txt
fresco_snapshot mesh.ply mesh.png -size 320x240 -quiet'
[ -s "$root/job/mesh.png" ]
inside sh -c 'apt-get -q -y install --no-install-recommends /packages/python3-fresco_*.deb' >>"$root/job/install.log" 2>&1 ||
  { tail -20 "$root/job/install.log" >&2; exit 1; }
inside python3 -c 'import fresco; fresco.write_mesh("/job/python.ply", fresco.reconstruct(fresco.read_points("/job/oriented.pcd"), depth=6).mesh)'
cmp "$root/job/mesh.ply" "$root/job/python.ply"

inside sh -c 'apt-get -q -y install --no-install-recommends /packages/libfresco-dev_*.deb' >>"$root/job/install.log" 2>&1 ||
  { tail -20 "$root/job/install.log" >&2; exit 1; }
cat >"$root/job/program.cpp" <<'END'
#include <fresco/surface/volumetric_reconstruction.h>
#include <pcl/io/pcd_io.h>
int main()
{
  const pcl::PointCloud<pcl::PointNormal>::Ptr cloud(new pcl::PointCloud<pcl::PointNormal>);
  pcl::io::loadPCDFile("/job/oriented.pcd", *cloud);
  fresco::VolumetricReconstruction<pcl::PointNormal> reconstruction;
  reconstruction.setDepth(6);
  reconstruction.setInputCloud(cloud);
  pcl::PolygonMesh mesh;
  reconstruction.reconstruct(mesh);
  return mesh.polygons.empty();
}
END
cat >"$root/job/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.20)
project(program C CXX)
find_package(fresco REQUIRED COMPONENTS surface)
add_executable(program program.cpp)
target_link_libraries(program fresco::surface pcl_io)
END
inside apt-get -q -y install --no-install-recommends g++ cmake make >>"$root/job/install.log" 2>&1
inside sh -ec 'cmake -S /job -B /job/build && cmake --build /job/build && /job/build/program' >>"$root/job/install.log" 2>&1 ||
  { tail -20 "$root/job/install.log" >&2; exit 1; }
inside apt-get -q -y purge libfresco0.1 fresco-tools libfresco-dev python3-fresco >>"$root/job/install.log" 2>&1
[ -z "$(list)" ] || { echo "left behind: $(list)" >&2; exit 1; }
echo "packages: installed, ran $(cd "$root/job" && ls fresco_*.txt | wc -l) tools, removed"
