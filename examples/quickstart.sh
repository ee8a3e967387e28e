#!/usr/bin/env bash
# From a bare machine to two pictures: installs what is missing, builds, solves the glossy Cornell box once and
# shows it from two cameras. Safe to repeat. JOBS: parallel compilations (default: the processors there are).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
root=$PWD

step() { printf '\n== %s\n' "$*" >&2; }

step "1/4 what Lobe stands on"
bash cmake/install-dependencies.sh

step "2/4 build (some minutes the first time)"
cmake --preset release
cmake --build --preset release --parallel "${JOBS:-$(nproc)}" --target lobe
lobe=build/release/app/lobe

mkdir -p out
step "3/4 solve: light of all bounces, in every direction, stored on the mesh"
"$lobe" solve examples/scenes/cornell_glossy.glb -o out/cornell_glossy.solution.glb

step "4/4 look at it from two cameras: no light is computed any more"
for camera in view0 view1; do
  "$lobe" render out/cornell_glossy.solution.glb --camera "$camera" -o "out/$camera.exr" -o "out/$camera.png"
done

cat >&2 <<END

Pictures:  $root/out/view0.png  $root/out/view1.png  (and .exr, scene-linear)
Solution:  $root/out/cornell_glossy.solution.glb  (any glTF viewer shows it, baked)

How to go on, in $root:
  $lobe info out/cornell_glossy.solution.glb
  $lobe render out/cornell_glossy.solution.glb --eye 0,1,3 --target 0,1,0 --fov 40 -o out/mine.png
  $lobe solve YOUR_SCENE.glb -o out/yours.glb
END
