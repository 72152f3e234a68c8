#!/usr/bin/env bash
# Makes the pictures of docs/gallery.md with chromium and ImageMagick, and prints the estimates that it quotes.
# Argument: the program; by default that of the build folder.
set -euo pipefail
cd "$(dirname "$0")/.."
program=${1:-build/release/apps/elastimate}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Leaves the specimen and the legend alone.
style='body > *:not(main), main > *:not(:has(.stage)), main h2, .viewer ~ *, .viewer > :first-child,
  .viewer .readout, .viewer .keys { display: none !important }  main * { margin-top: 0 !important }'

# picture NAME ARGUMENTS: writes docs/gallery/NAME.png from the page of an estimate.
picture() {
  local name=$1
  shift
  "$program" report "$@" --out="$work/$name.html" 2>/dev/null |
    grep -E '^(status|Young|Poisson|E |nu |[EG]_|nu_|E of|nu of|materials|regions|law chosen|map)' | sed "s/^/$name: /"
  sed "s|</head>|<style>${style//$'\n'/ }</style></head>|" "$work/$name.html" >"$work/picture.html"
  chromium --headless --no-sandbox --enable-unsafe-swiftshader --hide-scrollbars --window-size=760,500 \
    --virtual-time-budget=5000 --screenshot="$work/picture.png" "$work/picture.html" >/dev/null 2>&1
  convert "$work/picture.png" -crop 760x460+0+40 +repage -colors 64 "docs/gallery/$name.png"
}

mkdir -p docs/gallery
picture organ examples/scenes/organ.vtu --estimator=reduced-fe
picture block examples/block/scene.json --estimator=auto
picture steel_plate examples/steel_plate/plate.json --estimator=auto
picture bent_arm examples/bent_arm/scene.json --estimator=auto
picture cook_membrane examples/cook_membrane/scene.json --estimator=iterative-fe
picture three_regions examples/three_regions/block.vtu --regions=merge --estimator=auto
picture indenter examples/indenter/scene.json --estimator=auto --kinematics=small
picture carbon_plate examples/carbon_plate/scene.json --estimator=auto
