/* Conway's notation. SPDX-License-Identifier: GPL-3.0-or-later */
#include "signature.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LARGEST_ORDER = 1000000 };

static orb_status bad_character(orb_error *error, size_t position, const char *why) {
    int32_t element = (int32_t)position;
    return error_set_elements(error, ORB_BAD_SIGNATURE, ORB_CHARACTER, &element, 1, 1,
                              "the signature does not parse at character %zu: %s", position + 1, why);
}

/* Reads one order at text[*position]: a digit, or digits in parentheses. */
static orb_status read_order(const char *text, size_t *position, int32_t *order, orb_error *error) {
    size_t start = *position, at = start;
    bool grouped = text[at] == '(';
    long value = 0;
    at += grouped;
    size_t first = at;
    while (text[at] >= '0' && text[at] <= '9' && (grouped || at == first)) {
        value = 10 * value + (text[at] - '0');
        if (value > LARGEST_ORDER)
            return bad_character(error, start, "the order is larger than 1000000");
        at++;
    }
    if (at == first)
        return bad_character(error, at,
                             grouped ? "an order is missing after the parenthesis"
                                     : "expected a digit, an order in parentheses, *, x or o");
    if (grouped && text[at++] != ')')
        return bad_character(error, at - 1, "a closing parenthesis is missing");
    if (value < 2) {
        int32_t element = (int32_t)first;
        return error_set_elements(error, ORB_BAD_ORDER, ORB_CHARACTER, &element, 1, 1,
                                  "order %ld at character %zu of the signature is below 2: leave that cone out", value,
                                  first + 1);
    }
    *order = (int32_t)value;
    *position = at;
    return ORB_OK;
}

static orb_status read_features(const char *text, orb_signature *signature, orb_error *error) {
    for (size_t at = 0; text[at];) {
        char c = text[at];
        if (c == '*' || c == 'x' || c == 'o') {
            if (c == '*')
                signature->mirror_start[signature->n_mirrors] = signature->n_cones + signature->n_corners;
            int32_t *count = c == '*'   ? &signature->n_mirrors
                             : c == 'x' ? &signature->n_crosscaps
                                        : &signature->n_handles;
            ++*count;
            at++;
            continue;
        }
        if (c == ' ') {
            at++;
            continue;
        }
        if (signature->n_crosscaps)
            return bad_character(error, at, "orders stand before x");
        int32_t total = signature->n_cones + signature->n_corners;
        orb_status status = read_order(text, &at, &signature->orders[total], error);
        if (status != ORB_OK)
            return status;
        ++*(signature->n_mirrors ? &signature->n_corners : &signature->n_cones);
    }
    signature->mirror_start[signature->n_mirrors] = signature->n_cones + signature->n_corners;
    return ORB_OK;
}

/* Twice the Euler characteristic as an exact fraction: its sign must not depend on rounding. */
__extension__ typedef __int128 wide_integer;
typedef struct fraction {
    wide_integer numerator, denominator;
} fraction;

static wide_integer common_divisor(wide_integer a, wide_integer b) {
    while (b) {
        wide_integer rest = a % b;
        a = b;
        b = rest;
    }
    return a < 0 ? -a : a;
}

/* f + p / q, reduced; false when it does not fit in 126 bits. */
static bool fraction_add(fraction *f, int64_t p, int64_t q) {
    wide_integer shared = common_divisor(f->denominator, q), n, d, m;
    if (__builtin_mul_overflow(f->denominator, (wide_integer)q / shared, &d) ||
        __builtin_mul_overflow(f->numerator, (wide_integer)q / shared, &n) ||
        __builtin_mul_overflow((wide_integer)p, f->denominator / shared, &m) || __builtin_add_overflow(n, m, &n))
        return false;
    shared = common_divisor(n, d);
    f->numerator = n / shared;
    f->denominator = d / shared;
    return true;
}

/* Conway's cost formula (docs/mathematics.md, section 4), and its sign from exact integers. */
static void count_euler(orb_signature *signature) {
    int32_t whole = 2 - signature->n_mirrors - signature->n_crosscaps - 2 * signature->n_handles;
    fraction exact = {2 * (int64_t)whole, 1}; /* 2 chi */
    bool fits = true;
    double twice = 2.0 * whole;
    for (int32_t i = 0; i < signature->n_cones + signature->n_corners; i++) {
        int64_t n = signature->orders[i], share = i < signature->n_cones ? 2 : 1;
        twice -= (double)(share * (n - 1)) / (double)n;
        fits = fits && fraction_add(&exact, -share * (n - 1), n);
    }
    /* More than six orders of up to 10^6 are needed to overflow 127 bits; then chi is far below 0, unless most are
     * corners of order 2, whose fractions do not grow. */
    signature->curvature = fits ? (exact.numerator > 0) - (exact.numerator < 0) : (twice > 0) - (twice < 0);
    signature->euler = signature->curvature == 0 ? 0 : twice / 2;
}

/* Teardrops and spindles: a sphere with one cone or two of different orders, a disk with such corners. */
static orb_status refuse_bad_orbifold(const orb_signature *signature, orb_error *error) {
    const int32_t *n = signature->orders;
    bool sphere = !signature->n_mirrors && !signature->n_crosscaps && !signature->n_handles;
    bool disk = signature->n_mirrors == 1 && !signature->n_crosscaps && !signature->n_handles && !signature->n_cones;
    int32_t count = sphere ? signature->n_cones : signature->n_corners;
    if ((!sphere && !disk) || count > 2 || count == 0)
        return ORB_OK;
    const char *left = n[0] < 10 ? "" : "(", *right = n[0] < 10 ? "" : ")";
    if (count == 1)
        return error_set(
            error, ORB_BAD_ORBIFOLD,
            "%s is not a good orbifold: a single cone or corner has no tiling; take %s%s%d%s%s%d%s or three of them",
            signature->text, disk ? "*" : "", left, (int)n[0], right, left, (int)n[0], right);
    if (n[0] != n[1])
        return error_set(error, ORB_BAD_ORBIFOLD,
                         "%s is not a good orbifold: two cones or corners need equal orders, as in %s%s%d%s%s%d%s",
                         signature->text, disk ? "*" : "", left, (int)n[0], right, left, (int)n[0], right);
    return ORB_OK;
}

static void write_text(orb_signature *signature, size_t room) {
    char *out = signature->text, *end = out + room;
    for (int32_t i = 0; i < signature->n_handles; i++)
        *out++ = 'o';
    for (int32_t i = 0, m = 0, total = signature->n_cones + signature->n_corners; i <= total; i++) {
        for (; m < signature->n_mirrors && signature->mirror_start[m] == i; m++)
            *out++ = '*';
        if (i < total)
            out +=
                snprintf(out, (size_t)(end - out), signature->orders[i] > 9 ? "(%d)" : "%d", (int)signature->orders[i]);
    }
    for (int32_t i = 0; i < signature->n_crosscaps; i++)
        *out++ = 'x';
    *out = 0;
}

orb_status signature_parse(const char *text, orb_signature **result, orb_error *error) {
    *result = NULL;
    if (!text)
        return error_set(error, ORB_BAD_ARGUMENT, "the signature is missing");
    size_t length = strlen(text), room = length + 16;
    if (length == 0 || strspn(text, " ") == length)
        return bad_character(error, 0, "it is empty; write the cones' orders, as in 442");
    if (length > ORB_MAX_SIGNATURE)
        return bad_character(error, ORB_MAX_SIGNATURE, "it is longer than 4096 characters");
    orb_signature *signature = calloc(1, sizeof *signature);
    orb_status status = error_memory(error);
    if (!signature)
        return status;
    signature->orders = malloc((length + 1) * sizeof *signature->orders);
    signature->mirror_start = malloc((length + 1) * sizeof *signature->mirror_start);
    signature->text = malloc(room);
    if (!signature->orders || !signature->mirror_start || !signature->text)
        goto done;
    status = read_features(text, signature, error);
    if (status != ORB_OK)
        goto done;
    write_text(signature, room);
    count_euler(signature);
    status = refuse_bad_orbifold(signature, error);
    if (status != ORB_OK)
        goto done;
    error_set(error, ORB_OK, "%s", "");
    *result = signature;
    signature = NULL;
done:
    signature_free(signature);
    return status;
}

void signature_free(orb_signature *signature) {
    if (!signature)
        return;
    free(signature->orders);
    free(signature->mirror_start);
    free(signature->text);
    free(signature);
}

bool signature_is_supported(const orb_signature *signature) {
    return signature->n_cones + signature->n_corners > 0 || signature->euler <= 0;
}

orb_status signature_refuse(const orb_signature *signature, orb_error *error) {
    return error_set(error, ORB_UNSUPPORTED_SIGNATURE,
                     "%s has no cone or corner that would hold it in place on the sphere: add %s", signature->text,
                     signature->n_mirrors ? "a cone, as in 2*, or two corners, as in *22" : "a cone, as in 2x");
}

orb_status signature_with_mirrors(const orb_signature *signature, int32_t extra, orb_signature **result,
                                  orb_error *error) {
    *result = NULL;
    size_t length = strlen(signature->text), crosscaps = (size_t)signature->n_crosscaps, head = length - crosscaps;
    char *text = malloc(length + (size_t)extra + 1);
    if (!text)
        return error_memory(error);
    memcpy(text, signature->text, head);
    memset(text + head, '*', (size_t)extra);
    memcpy(text + head + extra, signature->text + head, crosscaps + 1);
    orb_status status = signature_parse(text, result, error);
    free(text);
    return status;
}

orb_status orb_signature_read(const char *text, orb_signature_info *info, int32_t *orders, int32_t capacity,
                              orb_error *error) {
    if (!info || (orders && capacity < 0))
        return error_set(error, ORB_BAD_ARGUMENT, "orb_signature_read needs a record to fill");
    orb_signature *signature = NULL;
    orb_status status = signature_parse(text, &signature, error);
    if (status != ORB_OK)
        return status;
    static const char *const names[] = {"hyperbolic", "euclidean", "spherical"};
    int32_t total = signature->n_cones + signature->n_corners;
    *info = (orb_signature_info){.curvature = signature->curvature,
                                 .geometry = names[signature->curvature + 1],
                                 .euler = signature->euler,
                                 .n_cones = total,
                                 .supported = signature_is_supported(signature),
                                 .n_interior = signature->n_cones,
                                 .n_mirrors = signature->n_mirrors,
                                 .n_crosscaps = signature->n_crosscaps,
                                 .n_handles = signature->n_handles};
    for (int32_t i = 0; orders && i < total && i < capacity; i++)
        orders[i] = signature->orders[i];
    signature_free(signature);
    return ORB_OK;
}
