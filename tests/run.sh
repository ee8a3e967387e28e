#!/usr/bin/env bash
# Everything from a bare machine to the verdict: installs what is missing, builds the release preset, runs all
# tests. JOBS: parallel compilations and tests (default: the processors there are).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
jobs=${JOBS:-$(nproc)}

bash cmake/install-dependencies.sh validator browser
# A failure here is not the end: the GltfValidator test will fail and say so.
bash tests/gltf-validator/install.sh || echo "glTF validator could not be installed" >&2
# The viewer's packages come with its page, in the build; without them ViewerUnit and ViewerBrowser fail and say so.

cmake --preset release -DLOBE_VALIDATOR=ON -DLOBE_VIEWER_TESTS=ON
cmake --build --preset release --parallel "$jobs"
ctest --preset release --output-on-failure -j "${JOBS:-2}"
