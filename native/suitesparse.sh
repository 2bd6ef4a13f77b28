#!/usr/bin/env bash
# Build CHOLMOD and what it needs (AMD, COLAMD, CAMD, CCOLAMD, METIS), and UMFPACK, as position independent code, and
# tell the Makefile how to use them.
#
# usage: suitesparse.sh DIR
#
#   DIR/include             cholmod.h, umfpack.h and their companions
#   DIR/lib/libsuitesparse.a, DIR/lib/openblas.o
#   DIR/licenses            the texts that go along with the code
#   DIR/flags.mk            SUITESPARSE_CFLAGS and SUITESPARSE_LIBS, relative to $(SUITESPARSE), which is DIR
#
# The sources are Debian's own source packages, asked of the archive that this machine's apt is set up for;
# apt's configuration and state stay as they are.  Debian's libcholmod.a is of no use to us: it is not position
# independent.  Without apt, or offline, an installed SuiteSparse serves instead, and that is said.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
out=${1:?usage: suitesparse.sh DIR}
mkdir -p "$out"
out=$(cd "$out" && pwd)
cc=${CC:-cc}
jobs=${JOBS:-$(nproc)}
work=$out/work
cflags="-std=gnu11 -O3 -fPIC -fvisibility=hidden -ffunction-sections -fdata-sections -DNDEBUG -DNPRINT -include stdio.h -w"

say() { echo "suitesparse: $*"; }
die() { echo "suitesparse: error: $*" >&2; exit 1; }

# What the result depends on besides the sources, which have their checksums.
stamp_key() { { cat "$here/suitesparse.sh" "$here/suitesparse.sha256" "$here"/*.patch "$here/openblas.c"; $cc --version; } | sha256sum; }

# One deb-src line for each Debian repository in apt's configuration, whichever syntax it is written in
# (apt itself reads it).  Before the first apt-get update apt does not know origins; then the paths speak.
source_lines() {
    local keyring option=""
    for keyring in /usr/share/keyrings/debian-archive-keyring.{pgp,gpg}; do
        [ -r "$keyring" ] && option="[signed-by=$keyring] "
    done
    {
        apt-get indextargets --format '$(ORIGIN) $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages'
        apt_sources_as_written
    } | awk -v option="$option" '
        $1 == "Debian" || ($1 == "?" && $2 ~ /\/debian\/?$/) {
            sub(/\/$/, "", $2)
            if ($4 == "main") print "deb-src " option $2, $3, $4
        }' | sort -u
}

# Prints "? URI SUITE COMPONENT" for each binary entry of apt's configuration files.
apt_sources_as_written() {
    local file
    for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
        [ -r "$file" ] || continue
        awk '$1 == "deb" { sub(/\[[^]]*\]/, ""); for (i = 4; i <= NF; i++) print "?", $2, $3, $i }' "$file"
    done
    for file in /etc/apt/sources.list.d/*.sources; do
        [ -r "$file" ] || continue
        awk -F': *' '
            function flush(  u, s, c, nu, ns, nc, i, j, k) {
                nu = split(field["uris"], u, " "); ns = split(field["suites"], s, " ")
                nc = split(field["components"], c, " ")
                if (field["types"] ~ /(^| )deb( |$)/ && tolower(field["enabled"]) != "no")
                    for (i = 1; i <= nu; i++) for (j = 1; j <= ns; j++) for (k = 1; k <= nc; k++)
                        print "?", u[i], s[j], c[k]
                delete field
            }
            /^#/ { next }
            /^[[:space:]]*$/ { flush(); next }
            /^[A-Za-z-]+:/ { name = tolower($1); value = $0; sub(/^[^:]*: */, "", value); field[name] = value; next }
            { field[name] = field[name] " " $0 }
            END { flush() }' "$file"
    done
}

# Download the two source packages into $work/download with an apt that has a configuration of its own.
download() {
    local apt=$work/apt log=$work/download.log
    command -v apt-get >/dev/null || { say "there is no apt-get here"; return 1; }
    mkdir -p "$apt/state/lists/partial" "$apt/cache/archives/partial" "$work/download"
    source_lines >"$apt/sources.list"
    [ -s "$apt/sources.list" ] || { say "apt has no Debian archive configured"; return 1; }
    : >"$apt/status"
    local options=(-q -o Dir::Etc::sourcelist="$apt/sources.list" -o Dir::Etc::sourceparts=/dev/null
                   -o Dir::State="$apt/state" -o Dir::State::status="$apt/status" -o Dir::Cache="$apt/cache"
                   -o APT::Sandbox::User="$(id -un)" -o Acquire::Retries=3)
    if ! { apt-get "${options[@]}" update && cd "$work/download" &&
           apt-get "${options[@]}" source --download-only suitesparse metis; } >"$log" 2>&1; then
        say "apt could not fetch the sources: $(grep -m 1 '^E:' "$log" || echo "see $log")"
        return 1
    fi
}

# A tarball whose checksum we recorded must match it; another version is taken on apt's signature, and said.
verify() {
    local file want
    for file in "$work"/download/*.orig.tar.*; do
        want=$(awk -v name="$(basename "$file")" '$2 == name { print $1 }' "$here/suitesparse.sha256")
        if [ -z "$want" ]; then
            say "$(basename "$file") is not the version that native/suitesparse.sha256 records; going on with it"
        elif [ "$(sha256sum <"$file" | cut -d' ' -f1)" != "$want" ]; then
            die "$(basename "$file") does not match native/suitesparse.sha256"
        fi
    done
}

unpack() {
    local package
    for package in suitesparse metis; do
        mkdir -p "$work/$package"
        tar -xf "$work/download/$package"_*.orig.tar.* -C "$work/$package" --strip-components=1 \
            --exclude='*/GraphBLAS/*' --exclude='*/Demo/*' --exclude='*/MATLAB/*' --exclude='*/Tcov/*'
    done
    if [ -d "$work/suitesparse/CHOLMOD/SuiteSparse_metis" ]; then
        patch -s -d "$work/suitesparse/CHOLMOD/SuiteSparse_metis" -p1 <"$here/metis.patch"
    else
        patch -s -d "$work/metis" -p1 <"$here/metis.patch"
        patch -s -d "$work" -p1 <"$here/suitesparse5.patch"
    fi
}

# Prints one compilation a line: object, source, flags; all relative to $work.
compilations() (
    cd "$work"
    local s=suitesparse m=metis modules module file variant variants="INT LONG" includes=""
    for module in SuiteSparse_config {AMD,COLAMD,CAMD,CCOLAMD,CHOLMOD,UMFPACK}/Include CHOLMOD; do includes+=" -I$s/$module"; done
    if [ -d $s/CHOLMOD/SuiteSparse_metis ]; then   # SuiteSparse 6 and later have a METIS of their own,
        variants="INT"                             # and two files where there was one, compiled for each integer
        for module in include libmetis GKlib; do includes+=" -I$s/CHOLMOD/SuiteSparse_metis/$module"; done
    else
        includes+=" -I$m/include"
        for file in $m/GKlib/*.c $m/libmetis/*.c; do
            echo "objects/$(basename "$(dirname "$file")")_$(basename "$file" .c).o $file" \
                 "-I$m/GKlib -I$m/libmetis -I$m/include -DUSE_GKRAND -DNDEBUG2 -DLINUX -D_GNU_SOURCE"
        done
    fi
    echo "objects/config.o $s/SuiteSparse_config/SuiteSparse_config.c $includes"
    modules="AMD/Source COLAMD/Source CAMD/Source CCOLAMD/Source"
    for module in Check Cholesky Core Utility MatrixOps Partition Supernodal; do modules+=" CHOLMOD/$module"; done
    for module in $modules; do
        for file in "$s/$module"/*.c; do
            [ -e "$file" ] && [[ $(basename "$file") != t_* ]] || continue
            for variant in $variants; do
                echo "objects/$(basename "$file" .c)_$variant.o $file -DD$variant $includes"
            done
        done
    done
    umfpack_compilations
)

# UMFPACK for real matrices and indices of 32 bits, as its own makefile compiles it; without what prints, saves and
# loads. Since SuiteSparse 7 the variants are files of their own, in Source2. (Uses the locals of compilations.)
umfpack_compilations() {
    local u=$s/UMFPACK file flags="-DDINT -DNCHOLMOD -I$s/UMFPACK/Source $includes" files=($s/UMFPACK/Source/*.c)
    [ -d $u/Source2 ] && files=($u/Source2/{umf_i_,umf_di_,umfpack_di_,umfpack_gn_}*.c)
    for file in "${files[@]}"; do
        case $file in *report* | *_save_* | *_load_* | */umf_triplet.c | *multicompile*) continue ;; esac
        [ -e "$file" ] || continue
        echo "objects/$(basename "$file" .c).o $file $flags"
    done
    [ -d $u/Source2 ] && return
    echo "objects/umf_lhsolve.o $u/Source/umf_ltsolve.c -DCONJUGATE_SOLVE $flags"
    echo "objects/umf_uhsolve.o $u/Source/umf_utsolve.c -DCONJUGATE_SOLVE $flags"
    echo "objects/umf_assemble_fixq.o $u/Source/umf_assemble.c -DFIXQ $flags"
    echo "objects/umf_store_lu_drop.o $u/Source/umf_store_lu.c -DDROP $flags"
    echo "objects/umfpack_wsolve.o $u/Source/umfpack_solve.c -DWSOLVE $flags"
    echo "objects/umf_triplet_map_x.o $u/Source/umf_triplet.c -DDO_MAP -DDO_VALUES $flags"
    echo "objects/umf_triplet_map_nox.o $u/Source/umf_triplet.c -DDO_MAP $flags"
    echo "objects/umf_triplet_nomap_x.o $u/Source/umf_triplet.c -DDO_VALUES $flags"
    echo "objects/umf_triplet_nomap_nox.o $u/Source/umf_triplet.c $flags"
}

compile() {
    mkdir -p "$work/objects" "$out/include" "$out/lib" "$out/licenses"
    compilations >"$work/compilations"
    (cd "$work" && xargs -P "$jobs" -L 1 sh -c 'object=$1 source=$2; shift 2; '"$cc $cflags"' "$@" -c "$source" -o "$object"' sh <compilations)
    rm -f "$out/lib/libsuitesparse.a"
    ar rcs "$out/lib/libsuitesparse.a" "$work"/objects/*.o
    $cc -O2 -fPIC -fvisibility=hidden -pthread -c "$here/openblas.c" -o "$out/lib/openblas.o"
    cp "$work"/suitesparse/SuiteSparse_config/SuiteSparse_config.h "$work"/suitesparse/{AMD/Include/amd,CHOLMOD/Include/cholmod,UMFPACK/Include/umfpack}*.h "$out/include/"
    cp "$work/suitesparse/LICENSE.txt" "$out/licenses/SuiteSparse.txt"
    cp "$work/metis/LICENSE.txt" "$out/licenses/METIS.txt"
    cp /usr/share/doc/libopenblas-serial-dev/copyright "$out/licenses/OpenBLAS.txt" 2>/dev/null || true
}

# A static, position independent, serial BLAS, with what it lacks (openblas.c); or whatever the linker finds.
blas() {
    local file
    for file in /usr/lib/*/openblas-serial/libopenblas.a "$($cc -print-file-name=libopenblas.a)"; do
        case $file in /*) [ -e "$file" ] || continue ;; *) continue ;; esac
        echo "-Wl,--wrap=blas_memory_alloc,--wrap=blas_memory_free,--wrap=getenv \$(SUITESPARSE)/lib/openblas.o $file"
        return
    done
    say "no static OpenBLAS (libopenblas-serial-dev): linking -llapack -lblas" >&2
    echo "-llapack -lblas"
}

build_own() {
    verify
    unpack
    compile
    printf '%s\n' 'SUITESPARSE_CFLAGS = -isystem $(SUITESPARSE)/include' \
        "SUITESPARSE_LIBS = \$(SUITESPARSE)/lib/libsuitesparse.a $(blas)" >"$out/flags.mk"
    say "built $(cd "$work/download" && echo *.orig.tar.*)"
}

use_installed() {
    local include
    for include in /usr/include/suitesparse /usr/local/include/suitesparse /usr/include /usr/local/include; do
        [ -e "$include/cholmod.h" ] && [ -e "$include/umfpack.h" ] || continue
        printf '%s\n' '$(info suitesparse: using the installed SuiteSparse, linked dynamically)' \
            "SUITESPARSE_CFLAGS = -isystem $include" 'SUITESPARSE_LIBS = -lumfpack -lcholmod' >"$out/flags.mk"
        return
    done
    die "no SuiteSparse: its sources could not be fetched, and none is installed (libsuitesparse-dev)"
}

main() {
    local key
    exec 9>"$out/lock"                      # two builds at once wait for each other
    if command -v flock >/dev/null; then flock 9; fi
    key=$(stamp_key)
    if [ -e "$out/flags.mk" ] && [ "$(cat "$out/stamp" 2>/dev/null)" = "$key" ]; then
        touch "$out/flags.mk"
        return
    fi
    rm -rf "$out/stamp" "$out/flags.mk" "$work"
    mkdir -p "$work"
    say "fetching and compiling the sources, once, about a minute"
    if download; then
        build_own
        echo "$key" >"$out/stamp"
    else
        use_installed
    fi
    rm -rf "$work"
}

main
