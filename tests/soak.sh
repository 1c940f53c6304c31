#!/usr/bin/env bash
# Flies an IG for hours while everything changes, and feeds damaged inputs to every reader; writes one page,
# out/soak/report.txt. Options: --hours N (default 2; 0.05 is three minutes), --no-fuzz (flies only)
#
# The IG follows a host at 60 Hz over the sample terrain; every ten seconds its preset is another one: weather, head motion,
# symbols, tiles or patches, culling. Its memory, handles and threads are noted every ten seconds. It passes if from the
# first tenth of the time on memory grows by at most 2 %, handles and threads stay, and the 99th percentile of the frame
# time of the last quarter is at most 1.25 times that of the second one: the presets go round in both.
set -euo pipefail
cd "$(dirname "$0")/.."
export LC_NUMERIC=C

usage() { echo "usage: tests/soak.sh [--hours N] [--no-fuzz]" >&2; exit 2; }
hours=2 fuzz=yes
while [ $# -gt 0 ]; do
  case $1 in
    --hours) [ $# -ge 2 ] || usage; hours=$2; shift 2 ;;
    --no-fuzz) fuzz=; shift ;;
    *) usage ;;
  esac
done
seconds=$(awk -v h="$hours" 'BEGIN { printf "%d", h * 3600 }')
[ "$seconds" -ge 60 ] || { echo "--hours: at least 0.017, a minute" >&2; exit 2; }

out=out/soak
rm -rf "$out" && mkdir -p "$out"
build=build
programs=$(grep -o 'trimtab_fuzzer([a-z_]*' tests/fuzz/CMakeLists.txt | grep -v 'fuzzer(NAME' | sed 's/.*(/test_fuzz_/' | sort -u)
bash resources/install-packages.sh
{ cmake --preset release && cmake --build "$build" --target trimtab-ig trimtab-cli ${fuzz:+$programs}; } >"$out/build.log" 2>&1 ||
  { tail -30 "$out/build.log" >&2; exit 1; }

cli=$build/bin/trimtab-cli
$cli terrain sample -o "$out/sample.tif" >"$out/bake.log" 2>&1
$cli terrain bake "$out/sample.tif" -o "$out/terrain" >>"$out/bake.log" 2>&1

# The presets that take turns, each as a whole export.
presets=(
  "static_lod.terrain=patches"
  "static_lod.terrain=levels weather.step=rain_heavy"
  "static_lod.terrain=patches weather.step=snow_medium symbology.enabled=true"
  "static_lod.terrain=levels culling.occlusion=horizon"
  "static_lod.terrain=patches weather.step=snow_light culling.occlusion=depth_map"
  "static_lod.terrain=patches culling.case=view_frustum"
)
for i in "${!presets[@]}"; do
  sets=()
  for set in ${presets[$i]}; do sets+=(--set "$set"); done
  $cli preset export default "${sets[@]}" -o "$out/preset-$i.json" 2>>"$out/bake.log"
done
cp "$out/preset-0.json" "$out/preset.json"

children=()
stop() { for child in "${children[@]}"; do kill "$child" 2>/dev/null || true; done; }
trap stop EXIT
$build/bin/trimtab-ig --preset "$out/preset.json" --watch --terrain "$out/terrain" --listen 0 --headless --size 320x200 \
  --head sweep:120deg/2s/3s --trace "$out/trace.csv" --json >"$out/ig.json" 2>"$out/ig.err" &
ig=$!
children+=("$ig")
for _ in $(seq 600); do grep -q "listening on UDP port" "$out/ig.err" && break; sleep 0.1; done
port=$(sed -n 's/.*listening on UDP port \([0-9]*\).*/\1/p' "$out/ig.err")
[ -n "$port" ] || { cat "$out/ig.err" >&2; exit 1; }
$cli feed play resources/flights/yecheon-circuit.csv --to "$port" --protocol cigi3 --loop --symbols >/dev/null 2>"$out/host.err" &
children+=("$!")

# Damaged inputs beside it: each reader for the same share of the time.
if [ -n "$fuzz" ]; then
  share=$((seconds / $(echo "$programs" | wc -w)))
  (for program in $programs; do
    TRIMTAB_FUZZ_SECONDS=$share "$build/bin/$program" --gtest_filter='*RandomDamage' >"$out/$program.log" 2>&1 ||
      echo "$program failed: $out/$program.log"
  done) >"$out/fuzz.failed" &
  fuzzer=$!
fi

echo "second,rss_kb,handles,threads" >"$out/process.csv"
turn=0 end=$((SECONDS + seconds))
while [ "$SECONDS" -lt "$end" ] && kill -0 "$ig" 2>/dev/null; do
  echo "$((SECONDS + seconds - end)),$(awk '/^VmRSS/ { print $2 }' /proc/$ig/status),$(ls /proc/$ig/fd | wc -l),$(ls /proc/$ig/task | wc -l)" \
    >>"$out/process.csv"
  turn=$(((turn + 1) % ${#presets[@]}))
  cp "$out/preset-$turn.json" "$out/next.json" && mv "$out/next.json" "$out/preset.json"
  sleep 10
done
[ -z "$fuzz" ] || wait "$fuzzer" || true
code=0
kill -TERM "$ig" 2>/dev/null || true
wait "$ig" || code=$?

failed=0
note() { echo "$2  $1" >>"$out/report.txt"; [ "$2" = good ] || failed=1; }
{
  echo "Soak of $hours hours, $(date -u +%Y-%m-%d), $(nproc) cores, commit $(git rev-parse --short HEAD 2>/dev/null || echo none)"
  echo
} >"$out/report.txt"
[ "$code" -eq 0 ] && note "the IG ended with 0" good || note "the IG ended with $code: $out/ig.err" BAD
awk -F, -v s="$seconds" '
  NR > 1 && $1 >= s / 10 { if (!n++) { r0 = $2; h0 = $3; t0 = $4; h1 = h0 } r1 = $2; if ($3 > h1) h1 = $3; t1 = $4 }
  END { printf "%.2f %d %d %d %d\n", 100 * (r1 - r0) / r0, h0, h1, t0, t1 }' "$out/process.csv" >"$out/growth"
read -r grown h0 h1 t0 t1 <"$out/growth"
awk -v g="$grown" 'BEGIN { exit !(g <= 2) }' && state=good || state=BAD
note "memory grew by $grown % after the first tenth" "$state"
[ "$h1" -le "$h0" ] && [ "$t1" -le "$t0" ] && state=good || state=BAD
note "handles $h0 to $h1 at most, threads $t0 to $t1" "$state"
# Quarters of the trace by rows: 99th percentile of the frame's time.
column=$(head -1 "$out/trace.csv" | tr ',' '\n' | grep -nx "total_ms" | cut -d: -f1)
rows=$(($(wc -l <"$out/trace.csv") - 1))
p99() { sed -n "$2,$3p" "$out/trace.csv" | cut -d, -f"$1" | grep . | sort -g | awk '{ v[NR] = $1 } END { print v[int(NR * 0.99)] }'; }
early=$(p99 "$column" $((rows / 4)) $((rows / 2))) late=$(p99 "$column" $((rows * 3 / 4)) $((rows + 1)))
awk -v a="$early" -v b="$late" 'BEGIN { exit !(b <= 1.25 * a) }' && state=good || state=BAD
note "frame time p99: $early ms in the second quarter, $late ms in the last, of $rows rows" "$state"
if [ -n "$fuzz" ]; then
  [ -s "$out/fuzz.failed" ] && note "damaged inputs: $(cat "$out/fuzz.failed")" BAD || note "damaged inputs: no reader failed" good
  grep -h "damaged inputs" "$out"/test_fuzz_*.log | sed 's/^/      /' >>"$out/report.txt" || true
fi
cat "$out/report.txt"
exit $failed
