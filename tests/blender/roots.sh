#!/usr/bin/env bash
# Other releases of Debian, each a folder with a Blender of its own, to run tests in.
#
# usage: roots.sh make RELEASE              makes build/roots/RELEASE, unless it is there and complete
#        roots.sh in RELEASE COMMAND...     runs COMMAND there, in the checkout's folder, without a network
#        roots.sh releases                  the names of those that tests are run in
#
# What cannot be done is said in one line on stderr, with status 1. The packages come from the archive that this
# system's apt is set up for. Everything runs in namespaces of its own for mounts and processes: nothing stays mounted
# and nothing goes on running, however it ends.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
checkout=$(cd "$here/../.." && pwd)
roots=$checkout/build/roots
releases=(trixie sid)                   # Blender 4.3 and 5.2

die() { echo "error: $*" >&2; exit 1; }

# Blender looks for the libraries of GL while it starts; its extensions' Python modules are not all dependencies.
packages=(blender libgl1 libegl1 libglx-mesa0 libegl-mesa0 libgl1-mesa-dri python3-cattr python3-numpy python3-pytest
    python3-requests xauth xvfb)

# ---- namespaces

isolated() { unshare --mount --propagation private --pid --fork --kill-child "$@"; }

# The root that is made, and the processes in it, see the devices of this system, and their own processes only.
mount_system() {
    mount -t proc proc "$1/proc"
    mount --rbind /sys "$1/sys"
    mount --rbind /dev "$1/dev"
}

# As process 1 of its namespace, bash hears no signal that it does not trap, and traps wait for what is in front.
wait_for() {
    trap 'exit 143' INT TERM HUP
    "$@" &
    wait $!
}

# ---- make

archive_of_apt() {
    apt-get indextargets --format '$(ORIGIN) $(REPO_URI)' 'Created-By: Packages' |
        awk '$1 == "Debian" && $2 ~ /\/debian\/?$/ && !found { found = 1; print $2 }'
}

make_root() {
    local release=$1 uri log=$roots/$1.log key
    can_make
    mkdir -p "$roots"
    exec 9>"$roots/$release.lock"       # two at once: the second one waits, and finds it made
    flock 9
    key="$release ${packages[*]}"
    [ "$(cat "$roots/$release.complete" 2>/dev/null)" != "$key" ] || return 0
    uri=$(archive_of_apt)
    if [ -z "$uri" ]; then              # package lists are absent
        apt-get update >"$log" 2>&1 || true
        uri=$(archive_of_apt)
    fi
    [ -n "$uri" ] || die "apt has no archive of Debian configured, or does not reach it"
    /usr/lib/apt/apt-helper -o Acquire::Retries=1 -o Acquire::http::Timeout=20 -o Acquire::https::Timeout=20 \
        download-file "${uri%/}/dists/$release/InRelease" "$roots/$release.InRelease" >"$log" 2>&1 ||
        die "the archive of Debian ($uri) has no '$release' or does not answer"
    rm -f "$roots/$release.InRelease" "$roots/$release.complete"
    rm -rf --one-file-system "${roots:?}/$release"
    echo "making build/roots/$release, a few minutes, once"
    isolated bash "$here/roots.sh" made "$release" "${uri%/}" >"$log" 2>&1 </dev/null ||
        die "build/roots/$release could not be made: $(grep -m 1 '^E: ' "$log" || tail -n 1 "$log")"
    echo "$key" >"$roots/$release.complete"
}

can_make() {
    [ "$(id -u)" = 0 ] || die "this takes root"
    isolated true 2>/dev/null || die "mount namespaces are not allowed here"
    command -v debootstrap >/dev/null || die "there is no debootstrap"
    command -v apt-get >/dev/null || die "there is no apt-get"
}

# In the namespaces. wget and the apt inside take proxies from the environment.
made() {
    local release=$1 uri=$2 root=$roots/$1 http_proxy=${http_proxy:-}
    eval "$(apt-config shell http_proxy Acquire::http::Proxy)"
    export http_proxy DEBIAN_FRONTEND=noninteractive
    debootstrap --variant=minbase "$release" "$root" "$uri"
    cp /etc/resolv.conf "$root/etc/resolv.conf"
    echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/quick"
    printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d"       # no service starts
    chmod +x "$root/usr/sbin/policy-rc.d"
    mount_system "$root"
    local apt=(chroot "$root" apt-get -q -y -o Acquire::Check-Valid-Until=false -o Acquire::Retries=3)
    "${apt[@]}" update
    "${apt[@]}" install --no-install-recommends "${packages[@]}"
    "${apt[@]}" clean
    chroot "$root" blender --version
}

# ---- in

run_in() {
    local release=$1 scratch status=0
    shift
    [ -e "$roots/$release.complete" ] || die "build/roots/$release is not there: roots.sh make $release"
    scratch=$(mktemp -d)
    trap "rm -rf --one-file-system '$scratch'" EXIT
    isolated --net bash "$here/roots.sh" inside "$release" "$scratch" "$@" || status=$?
    return $status
}

# In the namespaces: the checkout, and the folder with meshes beside it, stand where they stand outside.
inside() {
    local release=$1 scratch=$2 root=$roots/$1 shared=$checkout/../shared
    shift 2
    mount_system "$root"
    chmod 1777 "$scratch"
    mount --bind "$scratch" "$root/tmp"
    mkdir -p "$root$checkout"
    mount --bind "$checkout" "$root$checkout"
    if [ -d "$shared" ]; then
        mkdir -p "$root$(dirname "$checkout")/shared"
        mount --bind "$shared" "$root$(dirname "$checkout")/shared"
    fi
    wait_for chroot "$root" env -u DISPLAY -u XAUTHORITY -u XDG_RUNTIME_DIR -u TMPDIR -u PYTHONPATH -u PYTHONHOME HOME=/tmp \
        PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
        sh -c 'cd "$0" && exec "$@"' "$checkout" "$@"
}

main() {
    local verb=${1:-}
    [ $# = 0 ] || shift
    case $verb in
        make) make_root "$1" ;;
        in) run_in "$@" ;;
        made | inside) wait_for "$verb" "$@" ;;
        releases) printf '%s\n' "${releases[@]}" ;;
        *) die "usage: roots.sh make RELEASE | in RELEASE COMMAND... | releases" ;;
    esac
}

main "$@"
