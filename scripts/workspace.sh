# Copyright (c) 2026, the planecloud_slam authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Sourced by demo and test: installs what is missing, finds or makes the catkin workspace, builds.

set -euo pipefail

checkout="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)"

# Another python3 may come first in PATH; catkin needs the system's.
export PATH="/usr/bin:/bin:/usr/sbin:/sbin:$PATH"
export LC_ALL=C.UTF-8
export USER="${USER:-$(id -un)}"
export ROS_HOSTNAME="${ROS_HOSTNAME:-localhost}"
export ROS_MASTER_URI="${ROS_MASTER_URI:-http://localhost:11311}"
# Recordings beside the checkout; tests on real data are skipped without them.
if [ -d "$checkout/../shared/data" ]; then
  export PLANECLOUD_SLAM_DATA="${PLANECLOUD_SLAM_DATA:-$checkout/../shared/data}"
fi
jobs="${JOBS:-$(nproc)}"
# Several files in one go: most of the time of a compiler goes into headers.
unity=(-DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=8)

say() { printf '\n== %s\n' "$*"; }
fail() {
  printf 'error: %s\n' "$*" >&2
  exit 1
}

# Tags of the dependencies to look for in package.xml -> the keys in them.
package_keys() {
  sed -nE "s@.*<($1)>([^<]+)</.*@\2@p" "$checkout/package.xml" | sort -u
}

debian_packages() {
  local key names
  for key in $(package_keys "$1"); do
    names="$(sed -nE "s/^$key +//p" "$checkout/scripts/debian_packages")"
    [ -n "$names" ] || fail "scripts/debian_packages has no line for '$key' of package.xml"
    printf '%s\n' $names
  done | sort -u
}

missing_packages() {
  local name
  for name in $(debian_packages "$1"); do
    dpkg-query -W -f '${db:Status-Status}' "$name" 2>/dev/null | grep -qx installed || echo "$name"
  done
}

# Nothing knows localhost where /etc/hosts is missing, as in a bare root, and roslaunch asks for it.
name_localhost() {
  if ! getent ahosts localhost >/dev/null; then
    echo "127.0.0.1 localhost" | as_root tee -a /etc/hosts >/dev/null
  fi
}

as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  else
    command -v sudo >/dev/null || fail "as root: $*"
    sudo "$@"
  fi
}

# Installs the packages for the given tags of package.xml.
install_packages() {
  name_localhost
  if ! command -v dpkg-query >/dev/null || ! grep -qs 'VERSION_ID="12"' /etc/os-release; then
    command -v catkin_make >/dev/null ||
      fail "this is not Debian 12: install what package.xml names (rosdep install --from-paths $checkout)"
    return 0
  fi
  local missing
  missing="$(missing_packages "$1")"
  [ -n "$missing" ] || return 0
  local options=(-q -o DPkg::Lock::Timeout=600 -o Dpkg::Use-Pty=0)
  # Without an init system this is a container or chroot: an interrupted installation is thrown away
  # rather than repaired, so dpkg need not wait for the disk after every file.
  [ -d /run/systemd/system ] || options+=(-o DPkg::Options::=--force-unsafe-io)
  say "Installing $(wc -w <<<"$missing") packages"
  as_root apt-get "${options[@]}" update
  as_root env DEBIAN_FRONTEND=noninteractive apt-get "${options[@]}" -y install \
    --no-install-recommends $missing
}

# The workspace that already has the checkout in its src folder, else build/workspace in the checkout.
find_workspace() {
  local folder="$checkout"
  while [ "$folder" != / ]; do
    folder="$(dirname "$folder")"
    if [ -e "$folder/.catkin_workspace" ] && [[ "$checkout" == "$folder/src/"* ]]; then
      echo "$folder"
      return
    fi
  done
  echo "$checkout/build/workspace"
}

# Links the checkout's entries, not the checkout: the workspace lies in it, and rosrun and roslaunch
# would follow the loop.
link_package() {
  local entry
  mkdir -p "$1"
  find "$1" -maxdepth 1 -type l -delete
  for entry in "$checkout"/*; do
    case "${entry##*/}" in build* | output) ;; *) ln -s "$entry" "$1" ;; esac
  done
}

make_workspace() {
  workspace="$(find_workspace)"
  if [ "$workspace" = "$checkout/build/workspace" ]; then
    link_package "$workspace/src/planecloud_slam"
    touch "$workspace/CATKIN_IGNORE" "$workspace/.catkin_workspace"
  fi
  # Logs stay out of the home folder, which may be missing.
  export ROS_HOME="${ROS_HOME:-$workspace/.ros}"
}

# Builds targets (all without one) quietly; shows the log when that fails. TESTS=ON: what needs the
# packages of the tests as well.
build() {
  local log="$workspace/build.log" flags=("-DCATKIN_ENABLE_TESTING=${TESTS:-OFF}")
  if [ "${WERROR:-0}" = 1 ]; then flags+=(-DPLANECLOUD_SLAM_WERROR=ON); fi
  if ! catkin_make -C "$workspace" --no-color "-j$jobs" -DCMAKE_BUILD_TYPE=Release \
    -DPYTHON_EXECUTABLE=/usr/bin/python3 -DPython3_EXECUTABLE=/usr/bin/python3 \
    "${unity[@]}" "${flags[@]}" "$@" >"$log" 2>&1; then
    tail -n 60 "$log" >&2
    fail "the build failed; all of it is in $log"
  fi
}

# The workspace's environment, for rosrun and roslaunch.
enter_workspace() {
  set +u
  # shellcheck disable=SC1091
  source "$workspace/devel/setup.bash"
  set -u
}

trap 'printf "error: %s: line %s failed\n" "${0##*/}" "$LINENO" >&2' ERR
