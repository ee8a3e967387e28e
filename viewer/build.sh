#!/usr/bin/env bash
# Builds the page into the folder OUT, which is absent, old or complete, whatever happens:
#   bash viewer/build.sh [--optional] OUT
# Packages come from package-lock.json, and are fetched only when that is newer than what is here. With --optional a
# failure is a warning and exit code 0, and OUT is gone: the rest of Lobe does without a page rather than with an old
# one. NPM: the program, npm if not set.
set -euo pipefail

optional=no
if [ "${1:-}" = --optional ]; then
  optional=yes
  shift
fi
if [ $# -ne 1 ]; then
  echo "usage: build.sh [--optional] OUT" >&2
  exit 2
fi
mkdir -p "$(dirname "$1")"
out=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
cd "$(dirname "${BASH_SOURCE[0]}")"
npm=${NPM:-npm}

# Two builds at once would fetch into one folder.
if command -v flock >/dev/null; then
  exec 9<package.json
  flock 9
fi

fetch() {
  if [ node_modules/.package-lock.json -nt package-lock.json ]; then return 0; fi
  "$npm" ci --ignore-scripts --no-audit --no-fund || return 1
  touch node_modules/.package-lock.json
}

build() {
  if ! node -e 'process.exit(parseInt(process.versions.node) < 18 ? 1 : 0)'; then
    echo "Node.js is $(node --version 2>/dev/null || echo missing), 18 or newer is needed" >&2
    return 1
  fi
  fetch || return 1
  rm -rf "$out.part"
  "$npm" run build -- --outDir "$out.part" --emptyOutDir || return 1
  [ -f "$out.part/index.html" ] || return 1
  rm -rf "$out"
  mv "$out.part" "$out"
}

if build; then exit 0; fi
rm -rf "$out.part"
if [ $optional = no ]; then exit 1; fi
rm -rf "$out"
echo "warning: the viewer's page could not be built; \`lobe view\` and \`lobe export\` will ask for it." \
     "To try again, configure and build once more." >&2
