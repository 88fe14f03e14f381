#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Packs the built program with the libraries that it needs, for computers without Debian's packages:
# build/release/packages/telemime-VERSION-x86_64.tar.xz. Usage: scripts/tarball.sh [BUILD]
# What stays out: glibc, which belongs to the system's loader (2.36 or newer is needed), and drivers (OpenCL, OpenGL), which
# belong to the system's hardware and are loaded by name. The libraries that find drivers are in: programs start with them.
# XZ_OPT sets the compression: `XZ_OPT="-T0 -0"` packs in seconds.
set -euo pipefail
cd "$(dirname "$0")/.."
build="${1:-build/release}"
version="$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$build/CMakeCache.txt")"
name="telemime-$version-$(uname -m)"
stage="$build/packages/$name"
glibc='^(ld-linux.*|lib(c|m|dl|pthread|rt|resolv|util|anl|mvec|nsl|BrokenLocale)\.so.*)$'

rm -rf "$stage"
for component in program licence; do
  cmake --install "$build" --prefix "$stage" --component "$component" --strip > /dev/null
done
mkdir -p "$stage/lib/qt5/plugins/platforms" "$stage/share/opencv4/haarcascades"
cp "$build/copyright" "$stage/share/doc/telemime/"
cp /usr/share/opencv4/haarcascades/haarcascade_frontalface_alt2.xml "$stage/share/opencv4/haarcascades/"
# Qt, which shows the window of `telemime track --show`, loads this by name.
plugin=qt5/plugins/platforms/libqxcb.so
cp "/usr/lib/$(uname -m)-linux-gnu/$plugin" "$stage/lib/$plugin"
printf '[Paths]\nPrefix=..\nPlugins=lib/qt5/plugins\n' > "$stage/bin/qt.conf"

# The libraries, each under the name by which others ask for it. Files of Debian have no path of their own to search, so
# that of the program counts for all of them; it also comes before LD_LIBRARY_PATH.
ldd "$stage/bin/telemime" "$stage/lib/$plugin" | awk '$2 == "=>" {print $1, $3}' | sort -u > "$stage/libraries"
files=()
while read -r wanted path; do
  [[ ! "$wanted" =~ $glibc ]] || continue
  [[ -f "$path" ]] || { echo "tarball: $wanted is not installed here" >&2; exit 1; }
  cp "$path" "$stage/lib/$wanted"
  files+=("$(readlink -f "$path")")
done < "$stage/libraries"
rm "$stage/libraries"
for library in "$stage"/lib/*.so* "$stage/lib/$plugin"; do
  [[ -z "$(patchelf --print-rpath "$library")" ]] || patchelf --remove-rpath "$library"
done
patchelf --force-rpath --set-rpath "\$ORIGIN/../lib" "$stage/bin/telemime"

# Whose they are: the licence of each package, and where its source is.
notices="$stage/share/doc/telemime/libraries"
mkdir -p "$notices"
cp -rL /usr/share/common-licenses "$notices/"
files+=(/usr/share/opencv4/haarcascades/haarcascade_frontalface_alt2.xml)
# dpkg knows some files by their old place, without /usr; those of alternatives it does not know by the other.
{ dpkg-query -S "${files[@]}" "${files[@]#/usr}" 2> /dev/null || true; } > "$notices/owners"
for file in "${files[@]}"; do
  grep -qF -e ": $file" -e ": ${file#/usr}" "$notices/owners" || { echo "tarball: $file belongs to no package" >&2; exit 1; }
done
sed 's/[:,].*//' "$notices/owners" | sort -u > "$notices/packages"
rm "$notices/owners"
while read -r package; do
  cp -L "/usr/share/doc/$package/copyright" "$notices/$package.copyright"
  # shellcheck disable=SC2016  # the fields are dpkg's
  dpkg-query -W -f '${Package} ${Version}, from the source package ${source:Package} ${source:Version}\n' "$package" | head -1
done < "$notices/packages" > "$notices/SOURCES"
rm "$notices/packages"
sed "s/@VERSION@/$version/g" cmake/package/tarball_readme.in > "$stage/README"

tar -C "$build/packages" --sort=name --owner=0 --group=0 --numeric-owner -c "$name" |
  XZ_OPT="${XZ_OPT:--T0}" xz > "$build/packages/$name.tar.xz"
rm -rf "$stage"
echo "$build/packages/$name.tar.xz: $(du -m "$build/packages/$name.tar.xz" | cut -f1) MB, ${#files[@]} libraries"
