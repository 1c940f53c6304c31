#!/usr/bin/env bash
# Runs `trimtab-cli` tune, bench or terrain bake in parts on a Slurm cluster:
#   resources/cluster/slurm.sh PARTS FOLDER trimtab-cli tune ... -o FOLDER
# FOLDER and everything that the command names must lie where all nodes see it.
# Each round is an array of PARTS tasks and a job after it, whatever became of the tasks (afterany): that job joins what is
# there, and submits another round while the folder grows. Three rounds in which nothing is added end the work.
# `afterok` with requeue is no way: a killed batch shell counts as failed, and then the join never runs.
set -euo pipefail
usage() { sed -n '2,4s/^# //p' "$0" >&2; exit 2; }
[ $# -ge 3 ] || usage
self=$(realpath "$0") parts=$1 folder=$2 idle=${TRIMTAB_IDLE:-0}
shift 2
case $parts in '' | *[!0-9]*) usage ;; esac

# What is finished is a file below FOLDER or, of a bake, a line in the journal of its work beside FOLDER.
finished() {
  { find "$folder" -name '*.json'; cat "$(dirname "$folder")/.$(basename "$folder").work/journal"; } 2>/dev/null |
    wc -l || true
}
submit() {
  local array
  array=$(sbatch --parsable --array="1-$parts" --output="$folder.log/%A-%a.txt" --job-name=trimtab-part \
    --export=ALL,TRIMTAB_STEP=part "$self" "$parts" "$folder" "$@")
  sbatch --parsable --dependency="afterany:$array" --output="$folder.log/join-%j.txt" --job-name=trimtab-join \
    --export="ALL,TRIMTAB_STEP=join,TRIMTAB_FINISHED=$(finished),TRIMTAB_IDLE=$idle" "$self" "$parts" "$folder" "$@" >/dev/null
}

# In a job, Slurm runs a copy of this file: where it came from is in the first argument after TRIMTAB_SELF.
self=${TRIMTAB_SELF:-$self}
export TRIMTAB_SELF=$self
case ${TRIMTAB_STEP:-} in
  part) "$@" --part "$SLURM_ARRAY_TASK_ID/$parts" ;;
  join)
    code=0
    "$@" --join || code=$?
    case $code in
      0) echo complete >"$folder.log/state" && exit 0 ;;
      3) ;; # parts are missing
      *) echo "failed: see the logs in $folder.log" >"$folder.log/state" && exit 1 ;;
    esac
    if [ "$(finished)" -gt "$TRIMTAB_FINISHED" ]; then idle=0; else idle=$((idle + 1)); fi
    if [ "$idle" -ge 3 ]; then
      echo "nothing was added in three rounds; the logs in $folder.log say why" >"$folder.log/state"
      exit 1
    fi
    submit "$@"
    ;;
  *)
    mkdir -p "$folder.log"
    echo running >"$folder.log/state"
    # The first look makes the folder and its plan, so that no two tasks do.
    code=0
    "$@" --join || code=$?
    if [ "$code" -ne 3 ]; then
      [ "$code" -ne 0 ] || echo complete >"$folder.log/state"
      exit "$code"
    fi
    submit "$@"
    echo "submitted; $folder.log/state says when it is complete"
    ;;
esac
