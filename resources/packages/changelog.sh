#!/usr/bin/env bash
# Writes CHANGELOG.md as a compressed changelog of a Debian package: changelog.sh PACKAGE MAINTAINER CHANGELOG.md OUT.gz
# Versions without a date were never released and are left out.
set -euo pipefail
package=$1 maintainer=$2 source=$3 out=$4

# Markdown's bold, code and links are only their text here; paragraphs and headings are no entries.
sed -E 's/\*+([^* ][^*]*)\*+/\1/g; s/`//g; s/\[([^]]*)\]\([^)]*\)/\1/g' "$source" |
  while IFS= read -r line; do
    if [[ $line =~ ^'## '([0-9.]+)' - '([0-9-]{10})$ ]]; then
      [ -z "${date:-}" ] || printf '\n -- %s  %s\n\n' "$maintainer" "$date"
      date=$(LC_ALL=C date -u -R -d "${BASH_REMATCH[2]} 12:00")
      printf '%s (%s) unstable; urgency=medium\n\n' "$package" "${BASH_REMATCH[1]}"
    elif [[ $line == '## '* ]]; then
      break
    elif [[ $line == '- '* ]]; then
      fold -s -w 72 <<<"${line#- }" | sed -E '1s/^/  * /; 2,$s/^/    /; s/ +$//'
    fi
  done >"$out.text"
# The loop ran in a process of its own, so the last date is read again.
last=$(sed -nE 's/^## [0-9.]+ - ([0-9-]{10})$/\1/p' "$source" | tail -1)
[ -n "$last" ] || { echo "$source: expected a version with a date" >&2; exit 1; }
printf '\n -- %s  %s\n' "$maintainer" "$(LC_ALL=C date -u -R -d "$last 12:00")" >>"$out.text"
gzip -9nc "$out.text" >"$out"
rm "$out.text"
