#!/usr/bin/env bash
# The viewer's tests: `run.sh unit`, or `run.sh browser [NAME ...]`, which needs
#   LOBE_PROGRAM        the built program
#   LOBE_VIEWER_BUNDLE  the built page, as viewer/build.sh leaves it
#   LOBE_VIEWER_WORK    a folder for solutions and for what the tests saw; pictures stay there
# NAME: the beginning of a file's name, such as "picture".
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
viewer=$here/../../viewer

missing() {
  echo "The viewer cannot be tested: $1" >&2
  exit 1
}

command -v node >/dev/null || missing "there is no Node.js; \`bash cmake/install-dependencies.sh browser\` installs it"
# npm writes this file last.
[ -e "$viewer/node_modules/.package-lock.json" ] && [ ! "$viewer/package-lock.json" -nt "$viewer/node_modules/.package-lock.json" ] ||
  missing "its packages are not installed, or not those of package-lock.json; see why \`npm ci\` in viewer/ fails"

case "${1:-}" in
  unit)
    cd "$viewer"
    # Vitest gives a test five seconds, which is little on a busy machine.
    exec npm test -- --testTimeout=60000
    ;;
  browser)
    [ -f "${LOBE_VIEWER_BUNDLE:?}/index.html" ] || missing "there is no page in $LOBE_VIEWER_BUNDLE; see why viewer/build.sh fails"
    command -v chromium >/dev/null || missing "there is no chromium; \`bash cmake/install-dependencies.sh browser\` installs it"
    exec node --test-reporter=spec "$here/run.mjs" "${@:2}"
    ;;
  *)
    echo "usage: run.sh unit | run.sh browser [NAME ...]" >&2
    exit 2
    ;;
esac
