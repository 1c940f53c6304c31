#!/usr/bin/env bash
# Runs a command in a root folder, with this machine's /proc, /dev and display and nothing else of it: in_root.sh ROOT COMMAND
# The mounts are in a namespace of their own, which ends with the command.
set -euo pipefail
[ "${inside:-}" ] || inside=1 exec unshare --mount bash "$0" "$@"
root=$1 command=$2
mount --bind /proc "$root/proc"
mount --rbind /dev "$root/dev"
if [ -d /tmp/.X11-unix ]; then
  mkdir -p "$root/tmp/.X11-unix"
  mount --bind /tmp/.X11-unix "$root/tmp/.X11-unix"
fi
[ -z "${XAUTHORITY:-}" ] || cp "$XAUTHORITY" "$root/tmp/xauthority"
exec chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DISPLAY="${DISPLAY:-}" \
  XAUTHORITY=/tmp/xauthority LIBGL_ALWAYS_SOFTWARE=1 sh -c "cd /tmp && $command"
