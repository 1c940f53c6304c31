#!/usr/bin/env bash
# Installs what is missing, builds, makes the sample terrain, and starts the workbench with a simulated host that flies
# over it. Without a display it runs for some 20 s on a virtual one and leaves a screenshot and an exported preset in out/.
# Options: --imagery (drapes a picture of 10 m over the sample), --terrain DB (instead of the sample), --preset P,
# --port PORT (default: a free one), --no-host
set -euo pipefail
here=$PWD
cd "$(dirname "$0")/.."
export LC_NUMERIC=C

terrain= preset=default port= host=yes imagery=
usage() { sed -n '2,5s/^# //p' app/run.sh; }
while [ $# -gt 0 ]; do
  case $1 in
    --terrain) terrain=$(cd "$here" && realpath "$2"); shift 2 ;;
    --preset) preset=$2; [ ! -e "$here/$2" ] || preset=$(cd "$here" && realpath "$2"); shift 2 ;;
    --port) port=$2; shift 2 ;;
    --no-host) host=no; shift ;;
    --imagery) imagery=yes; shift ;;
    -h|--help) usage; exit 0 ;;
    *) usage >&2; exit 2 ;;
  esac
done

bash resources/install-packages.sh
echo "building (log: build/run.log)"
mkdir -p build
{ cmake --preset release && cmake --build build --target trimtab trimtab-cli trimtab-ig; } >build/run.log 2>&1 ||
  { grep -E "error|FAILED|CMake Error" build/run.log | head -40 >&2; echo "the build failed: see build/run.log" >&2; exit 1; }

if [ -z "$terrain" ]; then
  terrain=build/sample/world${imagery:+-imagery}
  # One that another version baked is made again.
  if ! build/bin/trimtab-cli terrain info "$terrain" >/dev/null 2>&1; then
    echo "making the sample terrain in build/sample (once)"
    mkdir -p build/sample
    [ -f build/sample/sample.tif ] && [ -f build/sample/sample-objects.csv ] || build/bin/trimtab-cli terrain sample -o build/sample/sample.tif >build/sample/log 2>&1
    drape=()
    if [ -n "$imagery" ]; then
      drape=(--imagery build/sample/picture.tif)
      [ -f "${drape[1]}" ] || build/bin/trimtab-cli terrain picture build/sample/sample.tif -o "${drape[1]}" >>build/sample/log 2>&1
    fi
    build/bin/trimtab-cli terrain bake build/sample/sample.tif "${drape[@]}" --objects build/sample/sample-objects.csv -o "$terrain" >>build/sample/log 2>&1
  fi
fi

# A free port: no two runs on one machine get in each other's way.
if [ -z "$port" ]; then
  port=8004
  while grep -q ":$(printf '%04X' "$port") " /proc/net/udp; do port=$((port + 1)); done
fi

children=()
stop() { for child in "${children[@]}"; do kill "$child" 2>/dev/null || true; done; }
trap stop EXIT
trap 'exit 130' INT TERM

if [ "$host" = yes ]; then
  flight=resources/flights/yecheon-circuit.csv
  echo "simulated host: $flight over CIGI 3.3 to UDP port $port"
  build/bin/trimtab-cli feed play "$flight" --to "127.0.0.1:$port" --protocol cigi3 --start-s 232 --loop 2>build/feed.log &
  children+=($!)
fi

arguments=(--preset "$preset" --terrain "$terrain" --listen "$port")
if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
  echo "starting the workbench; close its window to end"
  build/bin/trimtab "${arguments[@]}" &
else
  mkdir -p out
  echo "no display: 20 s on a virtual one"
  xvfb-run -a -s "-screen 0 1600x1000x24" build/bin/trimtab "${arguments[@]}" --size 1600x1000 \
    --screenshot out/window.png --after-s 20 --export out/preset.json &
fi
workbench=$!
children+=("$workbench")
status=0
wait "$workbench" || status=$?
if [ -z "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] && [ "$status" -eq 0 ]; then
  echo "screenshot: $PWD/out/window.png"
  echo "exported preset: $PWD/out/preset.json"
fi
exit "$status"
