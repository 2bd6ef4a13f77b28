#!/usr/bin/env bash
# Other releases of Debian, each a folder with a Blender of its own, to run tests in.
#
# usage: roots.sh make RELEASE              makes build/roots/RELEASE, unless it is there and complete
#        roots.sh in RELEASE COMMAND...     runs COMMAND there, in the checkout's folder, without a network
#        roots.sh releases                  the names of those that tests are run in
#        roots.sh complete                  of these, the names of those that can be used at once
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
packages=(blender imagemagick libgl1 libegl1 libglx-mesa0 libegl-mesa0 libgl1-mesa-dri python3-cattr python3-numpy
    python3-pytest python3-requests xauth xvfb)

# ---- namespaces

isolated=(unshare --mount --propagation private --pid --fork --kill-child)

# The root that is made, and the processes in it, see the devices of this system, and their own processes only.
mount_system() {
    mount -t proc proc "$1/proc"
    mount --rbind /sys "$1/sys"
    mount --rbind /dev "$1/dev"
}

# interruptibly COMMAND...: in namespaces; a signal ends it and all that it started (SIGKILL: process 1 of a namespace
# hears nothing else from outside). A trap runs at once only while bash waits for what is in the background.
interruptibly() {
    local status=0
    "${isolated[@]}" "$@" </dev/null &
    trap "kill -KILL $! 2>/dev/null; wait $! 2>/dev/null || true; exit 143" INT TERM HUP
    wait $! || status=$?
    trap - INT TERM HUP
    return $status
}

# ---- make

archive_of_apt() {
    apt-get indextargets --format '$(ORIGIN) $(REPO_URI)' 'Created-By: Packages' |
        awk '$1 == "Debian" && $2 ~ /\/debian\/?$/ && !found { found = 1; print $2 }'
}

make_root() {
    local release=$1 uri log=$roots/$1.log
    can_make
    exec 9>"$roots/$release.lock"       # two at once: the second one waits, and finds it made
    flock 9
    ! is_complete "$release" || return 0
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
    interruptibly bash "$here/roots.sh" made "$release" "${uri%/}" >"$log" 2>&1 ||
        die "build/roots/$release could not be made: $(grep -m 1 '^E: ' "$log" || tail -n 1 "$log")"
    stamp "$release" >"$roots/$release.complete"
}

stamp() { echo "$1 ${packages[*]}"; }
is_complete() { [ "$(cat "$roots/$1.complete" 2>/dev/null)" = "$(stamp "$1")" ]; }

complete() {
    local release
    [ "$(id -u)" = 0 ] && "${isolated[@]}" true 2>/dev/null || return 0
    for release in "${releases[@]}"; do
        if is_complete "$release"; then echo "$release"; fi
    done
}

can_make() {
    [ "$(id -u)" = 0 ] || die "this takes root"
    mkdir -p "$roots"
    "${isolated[@]}" true 2>/dev/null || die "mount namespaces are not allowed here"
    command -v apt-get >/dev/null || die "there is no apt-get"
    command -v debootstrap >/dev/null || install_debootstrap >"$roots/debootstrap.log" 2>&1 ||
        die "there is no debootstrap, and apt could not install it"
}

install_debootstrap() {
    local install=(env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends debootstrap)
    "${install[@]}" || { apt-get update && "${install[@]}"; }
}

# In the namespaces. wget and the apt inside take proxies from the environment.
made() {
    local release=$1 uri=$2 root=$roots/$1 http_proxy=${http_proxy:-}
    eval "$(apt-config shell http_proxy Acquire::http::Proxy)"
    export http_proxy DEBIAN_FRONTEND=noninteractive
    debootstrap --variant=minbase "$release" "$root" "$uri"
    cp /etc/resolv.conf "$root/etc/resolv.conf"
    echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/quick"
    ln -s /proc/self/mounts "$root/etc/mtab"                           # Blender reads it
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
    local release=$1 scratch
    shift
    is_complete "$release" || die "build/roots/$release is not there: roots.sh make $release"
    scratch=$(mktemp -d)
    trap "rm -rf --one-file-system '$scratch'" EXIT
    interruptibly --net bash "$here/roots.sh" inside "$release" "$scratch" "$@"
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
    unset DISPLAY XAUTHORITY XDG_RUNTIME_DIR TMPDIR PYTHONPATH PYTHONHOME
    chroot "$root" env HOME=/tmp \
        PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
        sh -c 'cd "$0" && exec "$@"' "$checkout" "$@"
}

main() {
    local verb=${1:-}
    [ $# = 0 ] || shift
    case $verb in
        make) make_root "$1" ;;
        in) run_in "$@" ;;
        made | inside) "$verb" "$@" ;;
        releases) printf '%s\n' "${releases[@]}" ;;
        complete) complete ;;
        *) die "usage: roots.sh make RELEASE | in RELEASE COMMAND... | releases" ;;
    esac
}

main "$@"
