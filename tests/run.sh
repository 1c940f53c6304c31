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
passed=0 failed=0 skipped=0
reasons=$build/skipped.txt
: >"$reasons"
rm -f "$build/stress.txt"
while read -r name kind; do
  [[ $name =~ $only ]] || continue
  log=$build/$name.log
  start=$SECONDS
  status=0
  if [ "$kind" = display ]; then
    timeout 1200 xvfb-run -a -s "-screen 0 1600x1000x24" "$build/bin/$name" >"$log" 2>&1 </dev/null || status=$?
  else
    timeout 1200 "$build/bin/$name" >"$log" 2>&1 </dev/null || status=$?
  fi
  ok=$(grep -cE '^\[       OK \]' "$log" || true)
  bad=$(grep -cE '^\[  FAILED  \] .* \([0-9]+ ms\)$' "$log" || true)
  skip=$(grep -cE '^\[  SKIPPED \] .* \([0-9]+ ms\)$' "$log" || true)
  # A program that crashes or is stopped says nothing of the test it died in: that is one failure more.
  if [ "$status" -ne 0 ] && [ "$bad" -eq 0 ]; then
    bad=1
    echo "--- $name ended with status $status; the end of its log:"
    tail -25 "$log"
  fi
  if [ "$bad" -gt 0 ]; then grep -E -B 12 '^\[  FAILED  \] .* \([0-9]+ ms\)$' "$log" | cut -c1-400 | head -80 || true; fi
  awk -v RS='\n' '/: Skipped$/ {getline reason; print reason}' "$log" >>"$reasons"
  passed=$((passed + ok)) failed=$((failed + bad)) skipped=$((skipped + skip))
  printf '%-32s %4d passed %3d failed %3d skipped  %4d s\n' "$name" "$ok" "$bad" "$skip" $((SECONDS - start))
done <"$build/tests.list"

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
