#!/usr/bin/env bash
# Orbifold UV: the one command.  Nothing has to be done before it: what is missing is asked of apt.
#
#   ./build.sh run  [MESH ...] [--jobs LIST] [--orbifold SIGNATURE] [--cones i,j,k | --cones auto] [--orders n,n,n]
#                   [--weights conformal|cotan|delaunay|mean-value|mean-value-exact|uniform]
#                   [--holes refuse|fill|mirror] [--output DIR] [--files ENDINGS] [--export] [--blender PATH]
#   ./build.sh run  [MESH ...] [--cones i,j,k] --map-to MESH [--map-cones i,j,k] ... [--transfer WHAT,WHAT]
#                                         what the one mesh has, on the other; options as above
#   ./build.sh test [--blender PATH]      everything; ends with `N passed, N failed`
#   ./build.sh test --all                 the same, and what is tested in Blender also in 4.3 and 5.2, in roots of other
#                                         releases of Debian (build/roots/, made once: takes root and a network)
#   ./build.sh test --all-if-possible     the same; where a root cannot be made, a line says why, and nothing fails
#   ./build.sh native                     build the library only, into addon/core/ (macOS, Windows: docs/building.md)
#   ./build.sh package [--blender PATH]   build/orbifold_uv-VERSION.zip, to install in Blender, and build/repository/,
#                                         an extension repository that Blender 4.2 and later can subscribe to
#   ./build.sh bench [ROUNDS [MESHES]]    seconds of each stage on several meshes
#   ./build.sh fuzz [SECONDS]             libFuzzer on meshes and images, so long each; the corpus in tests/fuzz/ grows
#   ./build.sh docs [--blender PATH]      the pictures of docs/orbifolds.md and docs/batch.md, rendered
#   ./build.sh docs window [NAME...]      the pictures of Blender's window, of a real one on a virtual screen
#   ./build.sh docs cones                 the tables of docs/cones.md, measured (an hour)
#   ./build.sh docs zoo                   docs/zoo.md: what becomes of bad meshes
#   ./build.sh deps                       install what all of these need, and nothing else
#   ./build.sh clean                      remove what was built
#
# VERBOSE=1 shows what the compiler and Blender say, DEBUG=1 builds the library for a debugger, CC chooses the compiler.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$root/build
verbose=${VERBOSE:-}
jobs=$(nproc 2>/dev/null || echo 2)
roots=$root/tests/blender/roots.sh
blender=""                              # --blender, made absolute
all=""                                  # --all: always; --all-if-possible: possible
arguments=()                            # the command line without verb and --blender

die() { echo "error: $*" >&2; exit 1; }
usage() { sed -n '2,/^set -euo/ { /^#/ s/^# \{0,1\}//p }' "${BASH_SOURCE[0]}"; }

# ---- what the machine must have

missing=()

# want PACKAGE [COMMAND]: unless the command, or else the package, is there.
want() {
    if [ -n "${2:-}" ]; then
        command -v "$2" >/dev/null && return
    elif ! command -v dpkg-query >/dev/null || [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; then
        return 0
    fi
    missing+=("$1")
}

want_native() {
    local package
    case $(uname -s) in                 # never run on these two; native/platform.mk, docs/building.md
        Darwin)
            brew list suite-sparse >/dev/null 2>&1 || missing+=(suite-sparse)
            return ;;
        MINGW* | MSYS*)
            for package in make "$MINGW_PACKAGE_PREFIX"-{gcc,openblas,suitesparse,python}; do
                pacman -Q "$package" >/dev/null 2>&1 || missing+=("$package")
            done
            return ;;
    esac
    want gcc "${CC:-cc}"
    want make make
    want patch patch
    want xz-utils xz
    want libc6-dev
    want libopenblas-serial-dev
}

# want_python MODULE...: Debian's own Python when it has none of the ones asked for.
want_python() {
    local module
    [ -z "$(find_python "$@")" ] || return 0
    want python3 /usr/bin/python3
    for module; do want "python3-$module"; done
}

# Blender 4 and 5 look for libegl1 and libgl1 while they start; the package does not depend on both.
want_blender() {
    [ -z "$blender" ] || return 0
    command -v blender >/dev/null || { want blender; want libegl1; want libgl1; }
}

want_tests() { want_native; want_python numpy pytest; want_blender; want_screen; }

# A virtual screen, and what looks at it.
want_screen() {
    want xvfb xvfb-run
    want xauth xauth
    want imagemagick import
    want libgl1-mesa-dri
}

# Both targets for so many seconds each, from the kept corpus on; what they find is left in build/fuzz.
fuzz() {
    local name folder seconds=${arguments[0]:-60} binary
    want_native
    want clang clang
    want_python sys
    install_missing
    make_native fuzz
    export PYTHONDONTWRITEBYTECODE=1
    for name in embed images; do
        folder=$build/fuzz/$name binary=$build/native/fuzz/fuzz_$name
        "$(find_python sys)" "$root/tests/fuzz/corpus.py" unpack "$root/tests/fuzz/$name.txt" "$folder"
        "$binary" -max_total_time="$seconds" -max_len=256 -timeout=30 -artifact_prefix="$folder-" "$folder" \
            2>"$folder.log" || die "fuzz_$name found something: $folder.log"
        tail -n 1 "$folder.log"
        mkdir -p "$folder.least"
        "$binary" -merge=1 "$folder.least" "$folder" 2>>"$folder.log"
        "$(find_python sys)" "$root/tests/fuzz/corpus.py" pack "$folder.least" "$root/tests/fuzz/$name.txt"
    done
}

want_docs() {
    want_blender
    want_python numpy
    want pngquant pngquant
    want imagemagick montage
    want xvfb xvfb-run
    want xauth xauth
}

install_missing() {
    [ ${#missing[@]} -gt 0 ] || return 0
    local log=$build/apt.log root_shell=()
    case $(uname -s) in
        Darwin) brew install "${missing[@]}"; missing=(); return ;;
        MINGW* | MSYS*) pacman -S --needed --noconfirm "${missing[@]}"; missing=(); return ;;
    esac
    command -v apt-get >/dev/null || die "please install ${missing[*]}: there is no apt-get here to do it"
    if [ "$(id -u)" != 0 ]; then
        command -v sudo >/dev/null || die "please install ${missing[*]}: this takes root, and there is no sudo here"
        root_shell=(sudo)
    fi
    echo "installing ${missing[*]}"
    mkdir -p "$build"
    local install=("${root_shell[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${missing[@]}")
    if ! "${install[@]}" >"$log" 2>&1 </dev/null; then
        # Package lists are absent or out of date.
        "${root_shell[@]}" apt-get update >>"$log" 2>&1 </dev/null || true
        "${install[@]}" >>"$log" 2>&1 </dev/null || { tail -n 20 "$log" >&2; die "apt could not install ${missing[*]}"; }
    fi
    missing=()
    hash -r
}

# The first Python that can import the modules; Debian's first, the one that its packages are for.
find_python() {
    local python imports
    imports=$(IFS=,; echo "$*")
    for python in /usr/bin/python3 python3; do
        if "$python" -c "import $imports" 2>/dev/null; then echo "$python"; return; fi
    done
}

find_blender() {
    if [ -n "$blender" ]; then echo "$blender"; else command -v blender || die "there is no blender in PATH"; fi
}

# ---- the verbs

deps() { want_tests; want_docs; install_missing; }

make_native() { make -C "$root/native" --no-print-directory -j "$jobs" $([ -n "$verbose" ] && echo VERBOSE=1 || echo -s) "$@"; }

native() { want_native; install_missing; make_native all; }

run() {
    want_blender
    native
    local program log status=0
    program=$(find_blender)
    log=$(mktemp "$build/run.XXXXXX")
    trap "rm -f '$log'" EXIT             # expanded now: log is local
    [ ! -t 1 ] || export ORBIFOLD_TERMINAL=/dev/tty     # for a progress bar: below, stdout is a pipe
    "$program" --background --factory-startup --python-exit-code 1 --python "$root/addon/run.py" -- "${arguments[@]}" 2>&1 </dev/null |
        tee "$log" | show_run || status=1
    if grep -q '^orbifold error: ' "$log"; then
        [ -n "$verbose" ] || sed -n 's/^orbifold error: /error: /p' "$log" | paste -s -d ' ' >&2
        return 1
    fi
    [ $status = 0 ] || { [ -n "$verbose" ] || cat "$log" >&2; die "Blender stopped before it was done"; }
}

# Of all that Blender says, our own lines.
show_run() { if [ -n "$verbose" ]; then cat; else sed -u -n 's/^orbifold: //p'; fi; }

package() {
    local version zip python platforms folder=$build/package/orbifold_uv
    [ -n "$(find_python tomllib zipfile)" ] || want python3
    native
    python=$(find_python tomllib zipfile)
    [ -n "$python" ] || die "packaging takes Python 3.11 or later"
    version=$(sed -n 's/^version *= *"\([^"]*\)".*/\1/p' "$root/addon/blender_manifest.toml")
    [ -n "$version" ] || die "addon/blender_manifest.toml names no version"
    zip=$build/orbifold_uv-$version.zip
    rm -rf "$build/package" "$build"/orbifold_uv-*.zip
    mkdir -p "$folder"
    cp -R "$root/addon/." "$root/LICENSE" "$folder/"
    cp -R "$build/suitesparse/licenses" "$folder/" 2>/dev/null || true
    find "$folder" \( -name __pycache__ -o -name '.*' -o -name '*.blend1' -o -name '*~' \) -prune -exec rm -rf {} +
    platforms=$("$python" "$root/docs/packaging.py" platforms "$folder/core")
    sed "s/^platforms = .*/platforms = $platforms/" "$root/addon/blender_manifest.toml" >"$folder/blender_manifest.toml"
    find "$folder" -exec env TZ=UTC touch -t 200001010000 {} +
    (cd "$build/package" && "$python" -m zipfile -c "$zip" orbifold_uv)
    echo "${zip#"$PWD"/}"
    repository "$zip" "$python"
}

# repository ZIP PYTHON: a folder with the zip and an index of it, by Blender itself if it can. Its check first.
repository() {
    local folder=$build/repository log=$build/repository.log server
    mapfile -t server < <(extension_blender)
    rm -rf "$folder"
    mkdir -p "$folder"
    cp "$1" "$folder/"
    if [ ${#server[@]} = 0 ]; then
        "$2" "$root/docs/packaging.py" index "$folder" >/dev/null
    else
        "${server[@]}" --command extension validate "$folder/$(basename "$1")" >"$log" 2>&1 </dev/null &&
            "${server[@]}" --command extension server-generate --repo-dir "$folder" >>"$log" 2>&1 </dev/null ||
            { cat "$log" >&2; die "Blender does not take the package"; }
    fi
    folder=$folder/
    echo "${folder#"$PWD"/}"
}

# How to start a Blender that has extensions, a word a line: the one that was named, the system's, or one of the roots.
extension_blender() {
    local program=${blender:-$(command -v blender || true)} version release
    if [ -n "$program" ]; then
        version=$(version_of "$program")
        if [ "$(printf '%s\n' 4.2 "$version" | sort -V | sed 1q)" = 4.2 ]; then echo "$program"; return; fi
    fi
    for release in $(bash "$roots" complete); do
        printf '%s\n' bash "$roots" in "$release" blender
        return
    done
}

# version_of BLENDER...
version_of() { "$@" --version 2>/dev/null </dev/null | sed -n 's/^Blender \([0-9.]*\).*/\1/p'; }

bench() { native; make_native bench; "$build/native/bench" "${arguments[@]}"; }

docs() {
    export PYTHONDONTWRITEBYTECODE=1
    case ${arguments[*]} in cones | zoo) want_python numpy; native ;; esac
    case ${arguments[*]} in
        cones) "$(find_python numpy)" "$root/docs/make_cones.py"; return ;;
        zoo) "$(find_python numpy)" "$root/tests/core/zoo.py" >"$build/zoo.md"; mv "$build/zoo.md" "$root/docs/zoo.md"; return ;;
    esac
    local script=make_pictures.sh
    if [ "${arguments[0]:-}" = window ]; then script=make_window_pictures.sh arguments=("${arguments[@]:1}"); fi
    want_docs
    native
    ORBIFOLD_BLENDER=$(find_blender) ORBIFOLD_PYTHON=$(find_python numpy) bash "$root/docs/$script" "${arguments[@]}"
}

clean() { rm -rf --one-file-system "$build" "$root/out" "$root"/addon/core/liborbifold.{so,dylib,dll}; }

# ---- test

passed=0 failed=0 skipped=0
versions=()                             # a line for each Blender

fail() { echo "FAIL $*"; failed=$((failed + 1)); }

# program LABEL COMMAND...: one that prints `ok`, `FAIL` and `skip` lines.
program() {
    local label=$1 log=$build/test.log status=0 failures
    shift
    echo "-- $label"
    (cd "$root" && timeout 1200 "$@") >"$log" 2>&1 </dev/null || status=$?
    cat "$log"
    failures=$(grep -c '^FAIL ' "$log" || true)
    passed=$((passed + $(grep -c '^ok ' "$log" || true)))
    skipped=$((skipped + $(grep -c '^skip ' "$log" || true)))
    failed=$((failed + failures))
    [ $status = 0 ] || [ "$failures" != 0 ] || fail "$label: stopped with status $status"
    [ $status != 0 ] || [ "$failures" = 0 ] || fail "$label: reports failures but exits with 0"
}

# c_programs TARGET FOLDER: build the C tests and run them; one that does not build is a failure.
c_programs() {
    local source name
    make_native --keep-going "$1" || fail "make $1"
    for source in "$root"/tests/native/test_*.c; do
        name=$(basename "$source" .c)
        if [ -x "$2/$name" ]; then program "$1 $name" "$2/$name"; fi
    done
}

# pytest_in FOLDER [RELEASE]: here, or in the root of a release of Debian; leaves a report, which is what counts.
pytest_in() {
    local report python
    report=$(report_of "$@")
    rm -f "$report"
    python=("$(find_python numpy pytest)")
    [ -z "${2:-}" ] || python=(bash "$roots" in "$2" env ORBIFOLD_BLENDER=/usr/bin/blender /usr/bin/python3)
    (cd "$root" && PYTHONDONTWRITEBYTECODE=1 timeout 3000 "${python[@]}" -m pytest -p no:cacheprovider \
        -q -rs --junitxml "$report" "tests/$1") </dev/null
}

report_of() { echo "$build/$1${2:+-$2}.xml"; }

# count_report STATUS FOLDER [RELEASE]: what pytest ended with, and what it ran.
count_report() {
    local status=$1 report label=tests/$2${3:+ in Debian $3} total bad left_out
    report=$(report_of "${@:2}")
    if [ ! -s "$report" ]; then fail "$label: pytest left no report, status $status"; return; fi
    total=$(report_number tests "$report") left_out=$(report_number skipped "$report")
    bad=$(($(report_number failures "$report") + $(report_number errors "$report")))
    passed=$((passed + total - bad - left_out)) failed=$((failed + bad)) skipped=$((skipped + left_out))
    case $status in 0 | 5) ;; *) [ $bad != 0 ] || fail "$label: pytest ended with status $status" ;; esac
}

report_number() { grep -o '<testsuite [^>]*' "$2" | grep -o " $1=\"[0-9]*\"" | tr -dc 0-9; }

python_tests() {
    local status=0
    echo "-- tests/$1"
    pytest_in "$1" || status=$?
    count_report $status "$1"
}

# count_version VERSION PASSED FAILED SKIPPED: these were the counts before.
count_version() { versions+=("Blender $1: $(counts $((passed - $2)) $((failed - $3)) $((skipped - $4)))"); }

blender_tests() {
    local before=($passed $failed $skipped)
    python_tests blender
    count_version "$(version_of "$1")" "${before[@]}"
}

# The Blenders of other releases of Debian: one after the other, in the background, for most tests keep one core busy.
# What they say, and how they end, is kept in build/.
others=""                               # the process group, while it runs
start_others() {
    local release
    set -m
    for release in $(bash "$roots" releases); do
        rm -f "$build/blender-$release".{log,status,refused}
        if bash "$roots" make "$release" >"$build/blender-$release.log" 2>"$build/blender-$release.refused"; then
            pytest_in blender "$release" >>"$build/blender-$release.log" 2>&1 && echo 0 || echo $?
        fi >"$build/blender-$release.status"
    done &
    others=$!
    set +m
    trap 'kill -TERM -- -$others 2>/dev/null || true' EXIT
}

finish_others() {
    local release name before reason
    wait "$others" || true
    trap - EXIT
    for release in $(bash "$roots" releases); do
        name=$build/blender-$release before=($passed $failed $skipped)
        echo "-- tests/blender in Debian $release"
        cat "$name.log" || true
        if [ -s "$name.status" ]; then
            count_report "$(cat "$name.status")" blender "$release"
            count_version "$(version_of bash "$roots" in "$release" blender) (Debian $release)" "${before[@]}"
            continue
        fi
        if [ ! -s "$name.refused" ]; then fail "Blender of Debian $release: its tests were broken off"; continue; fi
        reason="Blender of Debian $release: $(sed 's/^error: //' "$name.refused")"
        if [ "$all" = always ]; then
            fail "$reason"
        else
            echo "skip $reason"
            skipped=$((skipped + 1))
        fi
    done
}

counts() { echo "$1 passed, $2 failed$([ "$3" = 0 ] || echo ", $3 skipped")"; }

run_tests() {
    want_tests
    install_missing
    mkdir -p "$build"
    c_programs test "$build/native"
    export ASAN_OPTIONS=exitcode=99 UBSAN_OPTIONS=print_stacktrace=1
    c_programs test-asan "$build/native/asan"
    if "$root/build.sh" package ${blender:+--blender "$blender"}; then
        program exports bash "$root/tests/native/exports.sh" "$root/addon/core/liborbifold.so"
        ORBIFOLD_BLENDER=$(find_blender)
        ORBIFOLD_ZIP=$(echo "$build"/orbifold_uv-*.zip)
        export ORBIFOLD_BLENDER ORBIFOLD_ZIP
        [ -z "$all" ] || start_others
        python_tests core
        blender_tests "$ORBIFOLD_BLENDER"
        [ -z "$all" ] || finish_others
    else
        fail "package"
    fi
    [ -z "$all" ] || [ ${#versions[@]} = 0 ] || printf '%s\n' "${versions[@]}"
    counts $passed $failed $skipped
    [ $failed = 0 ]
}

# ---- the command line

main() {
    local verb=${1:-help}
    [ $# = 0 ] || shift
    while [ $# -gt 0 ]; do
        case $1 in
            --blender) [ $# -gt 1 ] || die "--blender needs a path"; blender=$2; shift 2 ;;
            --blender=*) blender=${1#*=}; shift ;;
            --all | --all-if-possible)
                [ "$verb" = test ] || die "$1 goes with test"
                case $1 in --all) all=always ;; *) all=possible ;; esac
                shift ;;
            *) arguments+=("$1"); shift ;;
        esac
    done
    if [ -n "$blender" ]; then
        blender=$(realpath -s -- "$(command -v -- "$blender")" 2>/dev/null) || die "--blender: there is no such program"
    fi
    case $verb in
        run | bench | fuzz | docs) "$verb" ;;
        test | native | package | clean | deps)
            [ ${#arguments[@]} = 0 ] || die "$verb takes no argument '${arguments[0]}'"
            case $verb in test) run_tests ;; *) "$verb" ;; esac ;;
        help | -h | --help) usage ;;
        *) usage >&2; die "there is no verb '$verb'" ;;
    esac
}

main "$@"
