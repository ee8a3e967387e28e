#!/usr/bin/env bash
# Installs what Lobe needs on Debian 12 (or a relative) and is not there yet. Asks apt nothing when nothing is
# missing. Arguments: further things wanted, "validator" for the glTF validator's node and npm, "browser" for the
# viewer's tests, "bench" for lobes_benchmark's Google Benchmark.
set -euo pipefail

packages=(git cmake ninja-build g++ ccache
          libeigen3-dev libembree-dev libopenmesh-dev libopenexr-dev libtbb-dev libtinygltf-dev libcli11-dev
          nlohmann-json3-dev libpng-dev zlib1g-dev
          libcpp-httplib-dev pkg-config libgtest-dev libgmock-dev libboost-dev)

installed() { [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "Not a Debian system: please see to the equivalents of: ${packages[*]}" >&2
  exit 0
fi

missing=()
for package in "${packages[@]}"; do
  installed "$package" || missing+=("$package")
done
# By command, not by package: node often comes from elsewhere, and brings its own npm.
want_node() {
  command -v node >/dev/null || missing+=(nodejs)
  command -v npm >/dev/null || missing+=(npm ca-certificates)
}
for want in "$@"; do
  case "$want" in
    validator)
      want_node
      ;;
    browser)
      want_node
      command -v chromium >/dev/null || missing+=(chromium chromium-sandbox)
      installed fonts-dejavu-core || missing+=(fonts-dejavu-core)
      ;;
    bench)
      installed libbenchmark-dev || missing+=(libbenchmark-dev)
      ;;
    *)
      echo "install-dependencies.sh: unknown argument '$want', expected 'validator', 'browser' or 'bench'" >&2
      exit 2
      ;;
  esac
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" != 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "Please install, as root: ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
echo "Installing ${missing[*]}" >&2
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y)
"${apt[@]}" update
"${apt[@]}" install --no-install-recommends "${missing[@]}"
