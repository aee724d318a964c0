#!/bin/bash
# Tests whether `ayumi selftest` gives the published hashes on ARM64: compiles the program for it by
# Debian's cross compiler and runs it under qemu.
#
#   tests/arm64.sh [FOLDER]         FOLDER keeps what is made (default: build/arm64)
#
# The libraries of ARM64 are Debian's. They are unpacked into FOLDER/root, which needs 1.7 GB and the
# network the first time; nothing of this machine's own system changes. It needs the Debian packages
# g++-12-aarch64-linux-gnu and qemu-user-static. The exit code is that of selftest: 1 where a hash differs.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
[[ ${1-} != -* ]] || { sed -n '2,10s/^# \{0,1\}//p' "$0"; exit 2; }
for program in aarch64-linux-gnu-g++-12 qemu-aarch64-static; do
  command -v "$program" >/dev/null ||
    { echo "$program is not installed: sudo apt-get install g++-12-aarch64-linux-gnu qemu-user-static" >&2
      exit 2; }
done
mkdir -p "${1:-build/arm64}"
place=$(cd "${1:-build/arm64}" && pwd)
root=$place/root triplet=aarch64-linux-gnu

# A second apt, which has the sources of this machine's apt but only knows ARM64 and believes that
# nothing is installed.
if [[ ! -e $root/complete ]]; then
  rm -rf "$root"
  mkdir -p "$place"/apt/{state,lists/partial,cache/archives/partial}
  touch "$place/apt/state/status"
  get=(apt-get -q -y --no-install-recommends -o "Dir::State=$place/apt/state"
    -o "Dir::State::status=$place/apt/state/status" -o "Dir::State::Lists=$place/apt/lists"
    -o "Dir::Cache=$place/apt/cache" -o APT::Architecture=arm64 -o APT::Architectures=arm64
    -o APT::Sandbox::User= -o Debug::NoLocking=1 -o Acquire::Languages=none)
  packages=$(awk '$2 == "build" && $1 ~ /-dev$/ && $1 !~ /^(python|pybind)/ {print $1}' .ci/packages.txt)
  "${get[@]}" update
  # shellcheck disable=SC2086
  "${get[@]}" --download-only install $packages libmujoco-dev
  mkdir -p "$root/usr/lib"
  ln -s usr/lib "$root/lib"
  for package in "$place"/apt/cache/archives/*.deb; do dpkg --extract "$package" "$root"; done
  # These are the tasks of the packages' own scripts: choosing one of several BLAS libraries, and
  # making links that stay inside this root.
  for name in libblas liblapack; do
    for end in so so.3; do
      ln -sf "openblas-serial/$name.$end" "$root/usr/lib/$triplet/$name.$end"
    done
  done
  for name in libopenblas.so libopenblas.so.0; do
    ln -sf "openblas-serial/$name" "$root/usr/lib/$triplet/$name"
  done
  find "$root" -type l -lname '/*' -printf '%p\t%l\n' | while IFS=$'\t' read -r link target; do
    ln -sfn "$root$target" "$link"
  done
  grep -rlZ '[";:]/usr/' --include='*.cmake' "$root/usr/lib" |
    xargs -0 sed -i "s|\\([\";:]\\)/usr/|\\1$root/usr/|g"
  rm -r "$place/apt/cache"
  touch "$root/complete"
fi

cat >"$place/toolchain.cmake" <<END
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER $triplet-g++-12)
set(CMAKE_SYSROOT $root)
set(CMAKE_LIBRARY_ARCHITECTURE $triplet)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static;-L;$root)
END
export PKG_CONFIG_SYSROOT_DIR=$root PKG_CONFIG_PATH=
export PKG_CONFIG_LIBDIR=$root/usr/lib/$triplet/pkgconfig:$root/usr/lib/pkgconfig:$root/usr/share/pkgconfig
jobs=$(nproc)
cmake -S . -B "$place/build" -G Ninja -DCMAKE_TOOLCHAIN_FILE="$place/toolchain.cmake" \
  -DCMAKE_BUILD_TYPE=Release -DAYUMI_BUILD_TESTS=OFF -DAYUMI_WITH_PYTHON=OFF >/dev/null
cmake --build "$place/build" --parallel "$((jobs < 2 ? jobs : 2))" --target ayumi
AYUMI_DATA=$PWD qemu-aarch64-static -L "$root" "$place/build/app/ayumi" selftest
