#!/usr/bin/env bash
# Puts the Khronos validator into node_modules here, at the version and hash of package-lock.json.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
if [ node_modules/.package-lock.json -nt package-lock.json ]; then exit 0; fi
npm ci --ignore-scripts --no-audit --no-fund
touch node_modules/.package-lock.json
