#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the packages of FOLDER (build/release/packages) on clean systems and uses them there without a network, as root:
# scripts/package_test.sh [FOLDER]. The systems are made here and thrown away:
# - Debian 12 as mmdebstrap's variant "minbase" makes it: apt installs the .deb;
# - Debian 12 and 13 with nothing but glibc: the tarball is unpacked.
# What is fetched is kept in ~/.cache/telemime-packages (TELEMIME_PACKAGE_CACHE) for a week.
set -euo pipefail
if [[ -z "${TELEMIME_OWN_MOUNTS:-}" ]]; then
  TELEMIME_OWN_MOUNTS=1 exec unshare --mount bash "$0" "$@"  # what is mounted below ends with this script
fi
cd "$(dirname "$0")/.."
packages="$(realpath "${1:-build/release/packages}")"
cache="${TELEMIME_PACKAGE_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/telemime-packages}"
mirror=http://deb.debian.org/debian
scratch="$(mktemp -d)"
clean() {
  # Nothing is removed while something of the outside is still mounted in there.
  awk -v "top=$scratch/" 'index($2, top) == 1 {print $2}' /proc/mounts | tac | xargs -r umount
  rm -rf --one-file-system "$scratch"
}
trap clean EXIT
mkdir -p "$cache/archives/partial"
find "$cache" -name '*.tar' -mtime +7 -delete

# A clean system in $scratch/NAME: new_system NAME SUITE MMDEBSTRAP_OPTION...
new_system() {
  local name="$1" suite="$2" root="$scratch/$1"
  shift 2
  if [[ ! -f "$cache/$name.tar" ]]; then
    mmdebstrap --quiet "$@" "$suite" "$cache/half.tar" "$mirror"
    mv "$cache/half.tar" "$cache/$name.tar"
  fi
  mkdir -m 755 "$root"
  tar -C "$root" -xf "$cache/$name.tar"
  mkdir -p -m 755 "$root/proc" "$root/dev"
  mkdir -p -m 1777 "$root/tmp"
  mount -t proc proc "$root/proc"
  mount --rbind /dev "$root/dev"
}

check() {
  unshare --net /usr/bin/python3 scripts/package_test.py "$@"
}

deb=("$packages"/telemime_*.deb) tarball=("$packages"/telemime-*.tar.xz) development=("$packages"/libtelemime-dev_*.deb)
python=("$packages"/python3-telemime_*.deb)

echo "== a clean Debian 12, and ${deb[0]##*/}"
new_system minbase bookworm --variant=minbase
root="$scratch/minbase"
cp "${deb[0]}" "${development[0]}" "${python[0]}" "$root/tmp/"
cp /etc/resolv.conf "$root/etc/"
mount --bind "$cache/archives" "$root/var/cache/apt/archives"
apt=(chroot "$root" env DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 apt-get -qq)
"${apt[@]}" update
"${apt[@]}" install --no-install-recommends --download-only "/tmp/${deb[0]##*/}" "/tmp/${python[0]##*/}" > /dev/null
# That there is all that the library asks for, and a browser: nothing is fetched.
"${apt[@]}" install --simulate "/tmp/${deb[0]##*/}" "/tmp/${development[0]##*/}" > /dev/null
check deb "$root" "/tmp/${deb[0]##*/}" "/tmp/${python[0]##*/}"

mkdir -m 755 "$scratch/opt"
tar -C "$scratch/opt" -I "xz -T0" -xf "${tarball[0]}"
for suite in bookworm trixie; do
  echo "== nothing but the glibc of $suite, and ${tarball[0]##*/}"
  new_system "glibc-$suite" "$suite" --variant=extract --include=libc6
  root="$scratch/glibc-$suite"
  [[ -e "$root/lib64" ]] || ln -s usr/lib64 "$root/lib64"
  [[ -e "$root/lib" ]] || ln -s usr/lib "$root/lib"
  find "$root"/{usr/lib,lib}/ -name 'libgcc_s*' -delete 2> /dev/null || true  # libc6 depends on it
  mkdir "$root/opt"
  mount --bind "$scratch/opt" "$root/opt"
  check tarball "$root" "/opt/$(basename "${tarball[0]}" .tar.xz)"
done
