#!/usr/bin/env bash
# The pictures of Blender's window in the user guide: `./build.sh docs window [NAME...]`, all if none is named. A Blender
# with the checkout's add-on, on a virtual screen, is driven by window_pictures.py. $ORBIFOLD_BLENDER is the Blender.
set -euo pipefail

docs=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(dirname "$docs")
work=$root/build/docs/window
pictures=$docs/window
size=1120x880
most=145000                             # bytes of a picture

# reduce FROM TO: as many colours as there is room for.
reduce() {
    local colours
    for colours in 128 96 64 48 32 24 16; do
        pngquant --force --speed 1 --strip --output "$2" "$colours" -- "$1"
        [ "$(wc -c <"$2")" -gt $most ] || break
    done
    echo "${2#"$root"/}: $colours colours"
}

main() {
    local log=$work/blender.log picture
    rm -rf "$work"
    mkdir -p "$work/pictures" "$work/scripts/addons" "$work/config" "$pictures"
    ln -s "$root/addon" "$work/scripts/addons/orbifold_uv"
    if ! BLENDER_USER_SCRIPTS=$work/scripts BLENDER_USER_CONFIG=$work/config LIBGL_ALWAYS_SOFTWARE=1 \
        PYTHONDONTWRITEBYTECODE=1 timeout 1200 xvfb-run -a -s "-screen 0 ${size}x24 +extension GLX" \
        "$ORBIFOLD_BLENDER" --factory-startup --enable-event-simulate --window-geometry 0 0 "${size%x*}" "${size#*x}" \
        --python "$docs/window_pictures.py" -- "$work/pictures" "$@" >"$log" 2>&1 </dev/null; then
        cat "$log" >&2
        echo "error: Blender stopped before it was done" >&2
        exit 1
    fi
    for picture in "$work"/pictures/*.png; do reduce "$picture" "$pictures/$(basename "$picture")"; done
}

main "$@"
