#!/usr/bin/env bash
# Runs `trimtab-cli` tune, bench or terrain bake in parts on machines that GNU parallel reaches by ssh:
#   resources/cluster/ssh.sh PARTS FOLDER HOSTS trimtab-cli tune ... -o FOLDER
# HOSTS is as `parallel --sshlogin` has it: "a,b,c", or ":" for this machine alone. FOLDER and everything that the command
# names must lie where all of them see it, under the same path.
set -euo pipefail
usage() { sed -n '2,5s/^# //p' "$0" >&2; exit 2; }
[ $# -ge 4 ] || usage
parts=$1 folder=$2 hosts=$3
shift 3
case $parts in '' | *[!0-9]*) usage ;; esac

# What is finished is a file below FOLDER or, of a bake, a line in the journal of its work beside FOLDER.
finished() {
  { find "$folder" -name '*.json'; cat "$(dirname "$folder")/.$(basename "$folder").work/journal"; } 2>/dev/null |
    wc -l || true
}
command=$(printf '%q ' "$@")
idle=0
# The first look makes the folder and its plan, so that no two parts do. It says 3 while parts are missing.
while code=0 && { "$@" --join || code=$?; } && [ "$code" -ne 0 ]; do
  [ "$code" -eq 3 ] || exit "$code"
  before=$(finished)
  parallel --sshlogin "$hosts" --workdir "$PWD" --halt never "$command --part {}/$parts" ::: $(seq "$parts") || true
  if [ "$(finished)" -gt "$before" ]; then idle=0; else idle=$((idle + 1)); fi
  [ "$idle" -lt 3 ] || { echo "nothing was added in three rounds" >&2; exit 1; }
done
