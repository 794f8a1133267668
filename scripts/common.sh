# shellcheck shell=bash disable=SC1091
# Sourced by the scripts beside it: environment, missing packages, build. For bash with set -euo pipefail.

root_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build_dir=${BUILD_DIR:-$root_dir/build}

export PATH=/usr/sbin:/usr/bin:/sbin:/bin:$PATH  # the system's python3, for which the ROS modules are installed
export ROS_HOSTNAME=localhost                    # a name that resolves on every machine
unset ROS_IP

# Every script explains itself: --help prints the comment at its top.
case "${1:-}" in
  -h | --help)
    sed -n -e '2,/^[^#]/s/^# \{0,1\}//p' "$0"
    exit 0
    ;;
esac

fail() {
  echo "error: $*" >&2
  exit 1
}

failUsage() {
  echo "error: $*" >&2
  exit 2
}

asRoot() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo > /dev/null; then
    sudo "$@"
  else
    fail "need root or sudo for: $*"
  fi
}

# Noetic's own environment where it is installed, else Debian's ROS packages under /usr.
useRos() {
  package_list=$root_dir/scripts/packages.txt
  test_package_list=$root_dir/scripts/packages_test.txt
  if [ -e /opt/ros/noetic/setup.bash ]; then
    package_list=$root_dir/scripts/packages_noetic.txt
    test_package_list=$package_list
    set +u
    . /opt/ros/noetic/setup.bash
    set -u
  fi
}

# Packages of the list in $1 that dpkg does not know as installed.
missingPackages() {
  local package
  grep -v -E '^[[:space:]]*(#|$)' "$1" | while read -r package; do
    dpkg-query -W -f '${db:Status-Status}' "$package" 2> /dev/null | grep -q '^installed$' || echo "$package"
  done
}

installMissing() {
  command -v dpkg-query > /dev/null || fail "needs Debian 12 or 13, or Ubuntu with ROS Noetic under /opt/ros"
  local missing
  missing=$(missingPackages "$package_list")
  [ -z "$missing" ] && return 0
  # shellcheck disable=SC2086  # one line
  echo "installing:" $missing
  asRoot env DEBIAN_FRONTEND=noninteractive apt-get update -q || fail "apt-get update"
  # shellcheck disable=SC2086  # one word per package
  asRoot env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $missing ||
    fail "apt-get install failed; needed are the packages of $package_list"
}

# Into the directory in $1: what git knows, uncommitted changes included; without git the whole tree but its builds.
copySource() {
  if git -C "$root_dir" ls-files --error-unmatch package.xml > /dev/null 2>&1; then
    git -C "$root_dir" ls-files -z --cached --others --exclude-standard | tar -c -C "$root_dir" --null -T - | tar -x -C "$1"
  else
    tar -c -C "$root_dir" --exclude=./build --exclude='./build_*' . | tar -x -C "$1"
  fi
}

# A bare chroot or container may lack /etc/hosts; ROS then cannot reach itself.
checkLocalhost() {
  getent hosts localhost > /dev/null && return 0
  echo "/etc/hosts: adding 127.0.0.1 localhost"
  asRoot sh -c 'echo "127.0.0.1 localhost" >> /etc/hosts'
}

# cmake_options: more of them. A build directory keeps its generator. Headers that many files include are compiled once,
# and all files of a target as one: most of what compiling costs is what headers make, once for each target.
cmake_options=()
configure() {
  local log generator=()
  [ -e "$build_dir/CMakeCache.txt" ] || generator=(-G Ninja)
  log=$(mktemp)
  cmake -S "$root_dir" -B "$build_dir" "${generator[@]}" -DCMAKE_BUILD_TYPE=Release \
    -DHAMMER_LOADS_PRECOMPILE=ON -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=100 \
    "${cmake_options[@]}" > "$log" 2>&1 || {
    cat "$log" >&2
    rm -f "$log"
    fail "cmake cannot configure $root_dir"
  }
  rm -f "$log"
}

# Targets as arguments, of what is configured.
compile() { cmake --build "$build_dir" -j "$(nproc)" --target "$@" || fail "build"; }

# Targets as arguments.
build() {
  configure
  compile "$@"
}

# This build's commands and messages.
useBuild() {
  set +u
  . "$build_dir/devel/setup.bash"
  set -u
}

# A port that no ROS master uses yet.
freePort() {
  python3 -c 'import socket; s = socket.socket(); s.bind(("localhost", 0)); print(s.getsockname()[1])'
}

prepare() {
  useRos
  installMissing
  checkLocalhost
}

# For tests.
prepareTests() {
  prepare
  package_list=$test_package_list installMissing
}
