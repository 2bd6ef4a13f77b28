#!/usr/bin/env bash
# The pictures of docs/orbifolds.md, made by the program itself: `./build.sh docs [SIGNATURE...]`, all if none is named;
# and as `map` that of docs/batch.md.
# Each is what `./build.sh run MESH --orbifold SIGNATURE` renders, with fewer colours. $ORBIFOLD_BLENDER is the Blender.
set -euo pipefail

docs=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(dirname "$docs")
work=$root/build/docs
pictures=$docs/orbifolds
colours=80

# signature and mesh (of sample_meshes.py; creature: the program's own), and cones where the automatic ones do not suit
table="
532 creature        432 creature        332 creature        22(5) creature      55 creature
*532 mask           *432 mask           *332 mask           *224 mask           *44 mask
3*2 mask            2*3 leaf            5* leaf             3x boy
442 creature        333 creature        632 creature        2222 creature
*442 mask           *333 mask           *632 mask           *2222 mask
4*2 mask            3*3 mask            2*22 leaf           22* leaf            22x boy
** vase             *x moebius          xx bottle           o knot
237 creature        2222222 creature    *237 mask           *22222 mask         5*3 mask            23*4 leaf
2** vase            *2*2 vase           *** open_mask       33x boy             2*x moebius
o3 knot             oo pretzel          ooo long_pretzel
"

# *442 -> star442: what the picture's file is called.
file_of() { sed 's/\*/star/g; s/[()]//g' <<<"$1"; }

picture() {
    local signature=$1 mesh=$2 name words=() log=$work/blender.log
    name=$(file_of "$signature")
    [ "$mesh" = creature ] || words=("$work/meshes/$mesh.off")
    echo "$signature on the $mesh"
    if ! "$ORBIFOLD_BLENDER" --background --factory-startup --python-exit-code 1 --python "$root/addon/run.py" -- \
        "${words[@]}" --orbifold "$signature" --output "$work/$name" >"$log" 2>&1 </dev/null; then
        grep '^orbifold error: ' "$log" >&2 || cat "$log" >&2
        return 1
    fi
    pngquant --force --speed 1 --strip --output "$pictures/$name.png" "$colours" -- "$work/$name/$mesh.png"
    rm -r "${work:?}/$name"
}

# All of them on one sheet, for the README.
sheet() {
    local signature mesh files=()
    while read -r signature mesh; do files+=("$pictures/$(file_of "$signature").png"); done < <(xargs -n 2 <<<"$table")
    montage "${files[@]}" -tile 9x -geometry 213x120+1+1 -background white "$work/families.png"
    pngquant --force --speed 1 --strip --output "$docs/families.png" "$colours" -- "$work/families.png"
}

# The example of batch.md.
map() {
    local log=$work/blender.log start=("$ORBIFOLD_BLENDER" --background --factory-startup --python-exit-code 1)
    echo "map"
    if ! "${start[@]}" --python-expr "import bpy; bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=6); \
            bpy.ops.wm.obj_export(filepath='$work/ball.obj', export_selected_objects=True)" >"$log" 2>&1 </dev/null ||
        ! "${start[@]}" --python "$root/addon/run.py" -- --cones 3879,3976,3929,4027,4074,5184,5816,4124 --files png \
            --map-to "$work/ball.obj" --map-cones 1850,7975,8511,9071,10147,5006,2967,2039 --output "$work" \
            >"$log" 2>&1 </dev/null; then
        grep '^orbifold error: ' "$log" >&2 || cat "$log" >&2
        return 1
    fi
    pngquant --force --speed 1 --strip --output "$docs/map.png" "$colours" -- "$work/ball.png"
}

# wanted NAME [NAME...]: whether the first is among the others, or there are none.
wanted() { [ $# = 1 ] || printf '%s\n' "${@:2}" | grep -qxF -- "$1"; }

main() {
    local signature mesh failed=0
    mkdir -p "$work" "$pictures"
    "${ORBIFOLD_PYTHON:-python3}" "$docs/sample_meshes.py" "$work/meshes"
    while read -r signature mesh; do
        if wanted "$signature" "$@"; then
            picture "$signature" "$mesh" || failed=$((failed + 1))
        fi
    done < <(xargs -n 2 <<<"$table")
    sheet
    if wanted map "$@"; then map || failed=$((failed + 1)); fi
    du -sh "$pictures" | sed 's/\t.*/ of pictures/'
    [ $failed = 0 ] || { echo "error: $failed pictures could not be made" >&2; exit 1; }
}

main "$@"
