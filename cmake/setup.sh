# Sourced by ./demo, ./check and ./package: installs what is missing on Debian 12 or 13 and builds into build/.

# For libraries and tools. PCL's package brings Boost and FLANN.
fresco_packages=(
  g++ cmake ninja-build ccache pkg-config ca-certificates
  libpcl-dev libvtk9-dev libopencv-core-dev libopencv-features2d-dev libopencv-imgproc-dev libeigen3-dev libembree-dev
  libtinygltf-dev libjpeg-dev libpng-dev libwebp-dev zlib1g-dev liblzf-dev libmeshoptimizer-dev libpugixml-dev nlohmann-json3-dev
  libegl-dev libglew-dev libegl-mesa0 libgl1-mesa-dri
)

# For tests, the Python module and programs of several processes.
fresco_check_packages=(
  libgtest-dev clang-format clang-tidy git python3 binutils
  libopenmpi-dev openmpi-bin python3-numpy
  pybind11-dev python3-dev python3-pytest python3-nbclient python3-ipykernel mypy
)

# For Debian packages, that of the Python module among them.
fresco_package_packages=(dpkg-dev file pybind11-dev python3-dev python3-numpy)

fresco_say() { printf '== %s\n' "$*" >&2; }

# Packages of those given that are not installed.
fresco_missing() {
  local name
  for name in "$@"; do
    dpkg-query -W -f '${Status}' "$name" 2>/dev/null | grep -q '^install ok installed' || echo "$name"
  done
}

# fresco_install PACKAGE...
fresco_install() {
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    fresco_say "no apt here: install the packages at the top of cmake/setup.sh by hand"
    return
  fi
  local missing as_root=()
  mapfile -t missing < <(fresco_missing "$@")
  [ "${#missing[@]}" -eq 0 ] && return
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { fresco_say "missing packages, and neither root nor sudo: ${missing[*]}"; exit 1; }
    as_root=(sudo)
  fi
  fresco_say "installing: ${missing[*]}"
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q update
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y install --no-install-recommends "${missing[@]}"
  [ ! -f build/CMakeCache.txt ] || cmake -S . -B build >/dev/null # finds what is new
}

# fresco_build TARGET...: configures build/ (Release, unless it is configured already) and builds.
fresco_build() {
  fresco_say "building into build/"
  [ -f build/CMakeCache.txt ] || cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release >build-configure.log 2>&1 ||
    { cat build-configure.log >&2; rm -rf build build-configure.log; exit 1; }
  [ -f build-configure.log ] && mv build-configure.log build/configure.log
  cmake --build build --parallel "$(nproc)" --target "$@"
}
