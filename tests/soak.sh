#!/usr/bin/env bash
# Flies an IG for hours while everything changes, and feeds damaged inputs to every reader; writes one page,
# out/soak/report.txt. Options: --hours N (default 2; 0.05 is three minutes), --no-fuzz (flies only),
# --sanitize (the readers are built with the address and the undefined-behaviour sanitizer, in build-asan)
#
# The IG follows a host at 60 Hz; every ten seconds its preset is another one (weather, head motion, symbols, tiles or patches,
# culling), and every seventy its terrain is the other one of two. It writes its memory, handles, threads, GL objects and latency
# every ten seconds (--health). The tenth of the time after the first tenth is compared with the last tenth. The flight passes if the
# mean of memory grows by at most 2 %, the most handles, threads and GL objects are no more, and the 99th percentiles of latency and
# of the frame time are at most 1.25 times as long. Runs below an hour are too short for that: their tenths hold few presets.
set -euo pipefail
cd "$(dirname "$0")/.."
export LC_NUMERIC=C

usage() { echo "usage: tests/soak.sh [--hours N] [--no-fuzz | --sanitize]" >&2; exit 2; }
hours=2 fuzz=yes sanitize=
while [ $# -gt 0 ]; do
  case $1 in
    --hours) [ $# -ge 2 ] || usage; hours=$2; shift 2 ;;
    --no-fuzz) fuzz=; shift ;;
    --sanitize) sanitize=yes; shift ;;
    *) usage ;;
  esac
done
[ -n "$fuzz" ] || [ -z "$sanitize" ] || usage
seconds=$(awk -v h="$hours" 'BEGIN { printf "%d", h * 3600 }')
[ "$seconds" -ge 60 ] || { echo "--hours: at least 0.017, a minute" >&2; exit 2; }

out=out/soak
rm -rf "$out" && mkdir -p "$out"
build=build readers=build readers_preset=release
[ -z "$sanitize" ] || readers=build-asan readers_preset=asan
programs=$(grep -o '^ *trimtab_fuzzer([a-z_][a-z_]*' tests/fuzz/CMakeLists.txt | sed 's/.*(/test_fuzz_/' | sort -u)
bash resources/install-packages.sh
build() { cmake --preset "$1" && cmake --build --preset "$1" --target "${@:2}"; }
{ build release trimtab-ig trimtab-cli && { [ -z "$fuzz" ] || build "$readers_preset" $programs; }; } >"$out/build.log" 2>&1 ||
  { tail -30 "$out/build.log" >&2; exit 1; }

cli=$build/bin/trimtab-cli
for terrain in 1:60 2:90; do
  $cli terrain sample --seed "${terrain%:*}" --post-m "${terrain#*:}" -o "$out/sample-${terrain%:*}.tif" >>"$out/bake.log" 2>&1
  $cli terrain bake "$out/sample-${terrain%:*}.tif" -o "$out/terrain-${terrain%:*}" >>"$out/bake.log" 2>&1
done
lead_to() { ln -s "terrain-$1" "$out/next" && mv -T "$out/next" "$out/terrain"; }
lead_to 1

# The presets that take turns, each as a whole export.
presets=(
  "terrain.form=patches"
  "terrain.form=tiles weather.step=rain_heavy"
  "terrain.form=patches weather.step=snow_medium symbology.enabled=true"
  "terrain.form=tiles culling.occlusion=horizon"
  "terrain.form=patches weather.step=snow_light culling.occlusion=depth_map"
  "terrain.form=patches culling.case=view_frustum"
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
  --head sweep:120deg/2s/3s --trace "$out/trace.csv" --health "$out/health.csv" --json >"$out/ig.json" 2>"$out/ig.err" &
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
    TRIMTAB_FUZZ_SECONDS=$share "$readers/bin/$program" --gtest_filter='*RandomDamage' >"$out/$program.log" 2>&1 ||
      echo "$program failed: $out/$program.log"
  done) >"$out/fuzz.failed" &
  fuzzer=$!
fi

turn=0 end=$((SECONDS + seconds))
while [ "$SECONDS" -lt "$end" ] && kill -0 "$ig" 2>/dev/null; do
  sleep 10
  turn=$((turn + 1))
  cp "$out/preset-$((turn % ${#presets[@]})).json" "$out/next.json" && mv "$out/next.json" "$out/preset.json"
  [ $((turn % 7)) -ne 0 ] || lead_to $((turn / 7 % 2 + 1))
done
[ -z "$fuzz" ] || wait "$fuzzer" || true
code=0
kill -TERM "$ig" 2>/dev/null || true
wait "$ig" || code=$?

failed=0
note() { echo "$2  $1" >>"$out/report.txt"; [ "$2" = good ] || failed=1; }
{
  echo "Soak of $hours hours, $(date -u +%Y-%m-%d), $(nproc) cores, commit $(git rev-parse --short HEAD 2>/dev/null || echo none)"
  [ -z "$sanitize" ] || echo "The readers were built with the address and the undefined-behaviour sanitizer."
  echo
} >"$out/report.txt"
[ "$code" -eq 0 ] && note "the IG ended with 0" good || note "the IG ended with $code: $out/ig.err" BAD
# Prints one number of a column over the tenth of the time that begins at tenth $2: its mean, or the most.
tenth() {
  awk -F, -v name="$1" -v from="$2" -v what="$3" -v s="$seconds" '
    NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) c = i; if (!c) exit 1 }
    NR > 1 && $c != "" && $1 >= s * from / 10 && $1 < s * (from + 1) / 10 { n++; sum += $c; if ($c > most) most = $c }
    END { if (!n) exit 1; printf what == "mean" ? "%.2f\n" : "%d\n", what == "mean" ? sum / n : most }' "$out/health.csv"
}
compare() { awk -v a="$1" -v b="$2" -v f="$3" 'BEGIN { print b <= f * a ? "good" : "BAD" }'; }
m0=$(tenth memory_kb 1 mean) m1=$(tenth memory_kb 9 mean)
grown=$(awk -v a="$m0" -v b="$m1" 'BEGIN { printf "%.2f", 100 * (b - a) / a }')
note "memory: mean $m0 kB in the second tenth, $m1 kB in the last, $grown % more" "$(compare "$m0" "$m1" 1.02)"
for what in handles threads gl_objects; do
  n0=$(tenth "$what" 1 most) n1=$(tenth "$what" 9 most)
  note "$what: at most $n0 in the second tenth, $n1 in the last" "$(compare "$n0" "$n1" 1)"
done
l0=$(tenth latency_p99_ms 1 mean) l1=$(tenth latency_p99_ms 9 mean)
note "latency p99, packet to image: $l0 ms in the second tenth, $l1 ms in the last" "$(compare "$l0" "$l1" 1.25)"
column=$(head -1 "$out/trace.csv" | tr ',' '\n' | grep -nx "total_ms" | cut -d: -f1)
rows=$(($(wc -l <"$out/trace.csv") - 1))
p99() { sed -n "$2,$3p" "$out/trace.csv" | cut -d, -f"$1" | grep . | sort -g | awk '{ v[NR] = $1 } END { print v[int(NR * 0.99)] }'; }
early=$(p99 "$column" $((rows / 10)) $((rows / 5))) late=$(p99 "$column" $((rows * 9 / 10)) $((rows + 1)))
note "frame time p99: $early ms in the second tenth, $late ms in the last, of $rows packets" "$(compare "$early" "$late" 1.25)"
count() { sed -n 's/.*"'"$1"'": \([0-9]*\).*/\1/p' "$out/ig.json" | head -1; }
note "$(count frames) images, $(count preset_reloads) changes of the preset, $(count terrain_reloads) of the terrain" \
  "$([ "$(count presets_refused)" = 0 ] && [ "$(count terrains_refused)" = 0 ] && [ "$(count terrain_reloads)" -gt 0 ] && echo good || echo BAD)"
if [ -n "$fuzz" ]; then
  [ -s "$out/fuzz.failed" ] && note "damaged inputs: $(cat "$out/fuzz.failed")" BAD || note "damaged inputs: no reader failed" good
  grep -h "damaged inputs" "$out"/test_fuzz_*.log | sed 's/^/      /' >>"$out/report.txt" || true
fi
cat "$out/report.txt"
exit $failed
