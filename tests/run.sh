#!/usr/bin/env bash
# Installs what is missing, builds, runs every test and ends with "N passed, N failed[, N skipped]".
# Options: --preset NAME (a CMake preset; default ci), --only PATTERN (programs whose name matches), --list
set -euo pipefail
cd "$(dirname "$0")/.."

preset=ci
only=.
while [ $# -gt 0 ]; do
  case $1 in
    --preset) preset=$2; shift 2 ;;
    --only) only=$2; shift 2 ;;
    --list) list=1; shift ;;
    *) echo "usage: tests/run.sh [--preset NAME] [--only PATTERN] [--list]" >&2; exit 2 ;;
  esac
done

bash resources/install-packages.sh
case $preset in
  release|ci) build=build ;;
  *) build=build-$preset ;;
esac
echo "configuring and building ($preset) in $build"
cmake --preset "$preset" >"$build.configure.log" 2>&1 || { cat "$build.configure.log"; exit 1; }
rm -f "$build.configure.log"
cmake --build "$build" -- -k 0 >"$build/build.log" 2>&1 || { grep -E "error|FAILED|warning" "$build/build.log" | head -60; echo "build failed: see $build/build.log"; exit 1; }

if [ -n "${list:-}" ]; then cat "$build/tests.list"; exit 0; fi

export QT_LOGGING_RULES="${QT_LOGGING_RULES:-*.debug=false}"
rm -f "$build/stress.txt"

# Runs one program, its log beside it, and leaves "STATUS SECONDS" in NAME.status.
run_program() {
  local name=$1 kind=$2 start=$SECONDS status=0
  local command=("$build/bin/$name")
  [ "$kind" = plain ] || command=(xvfb-run -a -s "-screen 0 1600x1000x24" "${command[@]}")
  timeout 1200 "${command[@]}" >"$build/$name.log" 2>&1 </dev/null || status=$?
  echo "$status $((SECONDS - start))" >"$build/$name.status"
}

# Adds up what a program's log says, and prints its line and its failures.
passed=0 failed=0 skipped=0
reasons=$build/skipped.txt
: >"$reasons"
report_program() {
  local name=$1 log=$build/$1.log status seconds ok bad skip
  read -r status seconds <"$build/$name.status"
  ok=$(grep -cE '^\[       OK \]' "$log" || true)
  bad=$(grep -cE '^\[  FAILED  \] .* \([0-9]+ ms\)$' "$log" || true)
  skip=$(grep -cE '^\[  SKIPPED \] .* \([0-9]+ ms\)$' "$log" || true)
  # A program that crashes or is stopped does not name the test it died in: that is one failure more.
  if [ "$status" -ne 0 ] && [ "$bad" -eq 0 ]; then
    bad=1
    echo "--- $name ended with status $status; the end of its log:"
    tail -25 "$log"
  fi
  if [ "$bad" -gt 0 ]; then grep -E -B 12 '^\[  FAILED  \] .* \([0-9]+ ms\)$' "$log" | cut -c1-400 | head -80 || true; fi
  awk -v RS='\n' '/: Skipped$/ {getline reason; print reason}' "$log" >>"$reasons"
  passed=$((passed + ok)) failed=$((failed + bad)) skipped=$((skipped + skip))
  printf '%-32s %4d passed %3d failed %3d skipped  %4d s\n' "$name" "$ok" "$bad" "$skip" "$seconds"
}

# Programs without windows share the cores; windows take their turns after them, because people's events have a pace.
streams=$(nproc)
for kind in plain display; do
  [ "$kind" = plain ] || streams=1
  names=()
  while read -r name its_kind; do
    [ "$its_kind" = "$kind" ] && [[ $name =~ $only ]] || continue
    names+=("$name")
    while [ "$(jobs -rp | wc -l)" -ge "$streams" ]; do wait -n || true; done
    run_program "$name" "$kind" &
  done <"$build/tests.list"
  wait
  for name in "${names[@]}"; do report_program "$name"; done
done

if [ "$skipped" -gt 0 ]; then
  echo "$skipped skipped, because:"
  sort "$reasons" | uniq -c | sort -rn | head -40
fi
if [ -f "$build/stress.txt" ]; then echo "numerical stress ($build/stress.txt): $(tail -1 "$build/stress.txt")"; fi
if [ "$skipped" -gt 0 ]; then
  echo "$passed passed, $failed failed, $skipped skipped"
else
  echo "$passed passed, $failed failed"
fi
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
