#!/usr/bin/env bash
# Measures every performance and accuracy row of the project and sets it beside a peer.
# Options: --quick (fewer repeats), --only GROUP[.PART] (the beginning of a row's name), --json (one document
# {"rows": [...]} on standard output)
set -euo pipefail
cd "$(dirname "$0")/.."

usage() { echo "usage: tests/bench.sh [--quick] [--only GROUP[.PART]] [--json]" >&2; exit 2; }
only= json= options=()
while [ $# -gt 0 ]; do
  case $1 in
    --quick) options+=(--quick); shift ;;
    --json) json=1; options+=(--json); shift ;;
    --only) [ $# -ge 2 ] || usage; only=$2; shift 2 ;;
    *) usage ;;
  esac
done

log=$(mktemp)
trap 'rm -f "$log"' EXIT
fail() { tail -40 "$log" >&2; echo "$1 failed" >&2; exit 1; }
{ bash resources/install-packages.sh && cmake --preset release; } >"$log" 2>&1 || fail configuring
groups=$(cut -d' ' -f1 build/bench.list)
if [ -n "$only" ]; then
  case $only in *.*) options+=(--only "${only#*.}"); only=${only%%.*} ;; esac
  grep -qx "$only" <<<"$groups" || { echo "no group $only; there are: $(echo $groups)" >&2; exit 2; }
  groups=$only
fi
cmake --build build --target $(printf 'bench_%s ' $groups) >"$log" 2>&1 || fail building

rows=() status=0
ended() { echo "bench_$1 ended with status $2" >&2; status=1; }
# Runs a group's program, under an X server of its own if it needs one and there is none.
run_group() {
  local command=(build/bin/bench_"$1" "${options[@]}")
  if [ -z "${DISPLAY:-}" ] && grep -qx "$1 display" build/bench.list; then
    command=(xvfb-run -a -s "-screen 0 1920x1200x24" "${command[@]}")
  fi
  timeout 1200 "${command[@]}" </dev/null
}
for group in $groups; do
  echo "measuring $group" >&2
  if [ -z "$json" ]; then
    run_group "$group" || ended "$group" $?
    continue
  fi
  # The programs print one row a line, between the document's first and last line.
  output=$(run_group "$group") || ended "$group" $?
  while read -r row; do
    [[ $row == '{"id"'* ]] && rows+=("${row%,}")
  done <<<"$output"
done

if [ -n "$json" ]; then
  printf '{"rows": ['
  separator=
  for row in "${rows[@]+"${rows[@]}"}"; do printf '%s\n%s' "$separator" "$row"; separator=,; done
  printf '\n]}\n'
fi
exit $status
