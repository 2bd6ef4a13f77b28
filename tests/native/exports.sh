#!/usr/bin/env bash
# The library as the loader sees it.  usage: exports.sh LIBRARY; prints `ok`, `FAIL` and `skip` lines like check.h.
set -euo pipefail
library=$1
failed=0

# check NAME OFFENDERS: passes when there are none.
check() {
    if [ -z "$2" ]; then echo "ok $1"; else echo "FAIL $1: $(echo "$2" | head -n 5 | tr '\n' ' ')"; failed=1; fi
}

exported=$(nm -D --defined-only "$library" | awk '{ print $NF }')
needed=$(readelf -d "$library" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p')

check exports_something "$([ -n "$exported" ] || echo nothing)"
check exports_only_orb_names "$(echo "$exported" | grep -v '^orb_' || true)"
if echo "$needed" | grep -q '^libcholmod'; then
    echo "skip needs_only_libc_and_libm: linked with an installed SuiteSparse"
else
    check needs_only_libc_and_libm "$(echo "$needed" | grep -vE '^(libc|libm|libpthread|ld-linux[^ ]*)\.so\.[0-9]+$' || true)"
fi
undefined=$(nm -D --undefined-only "$library" | awk '{ sub(/@.*/, "", $NF); print $NF }')
check leaves_signals_and_random_numbers_alone "$(echo "$undefined" | grep -xE 'raise|signal|sigaction|s?rand' || true)"
exit $failed
