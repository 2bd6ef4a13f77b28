/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "balance.h"

#include <math.h>
#include <stdlib.h>

#include "lu.h"

/* x -> a x + b conj(x) + shift, which an isometry of the plane is */
typedef struct motion {
    double complex a, b, shift;
} motion;

typedef struct workspace {
    const orb_balance *balance;
    const orb_point *position;
    int32_t *unknown; /* [n_vertices+1] first row of each vertex */
    orb_entries entries;
    double *right, *solution; /* [rows] */
} workspace;

static double complex apply(motion m, double complex x) { return m.a * x + m.b * conj(x) + m.shift; }

/* From the frame of copy v to that of copy u: h_u^-1 h_v. */
static motion motion_between(const orb_balance *balance, int32_t u, int32_t v) {
    const orb_copies *copies = balance->copies;
    if (copies->isometry[u] == copies->isometry[v])
        return (motion){1, 0, 0};
    const orb_isometry back = isometry_inverse(copies->isometries[copies->isometry[u]]);
    const orb_isometry g = isometry_compose(balance->geometry, back, copies->isometries[copies->isometry[v]]);
    const double complex zero = isometry_apply(balance->geometry, g, point_of(0)).z;
    const double complex one = isometry_apply(balance->geometry, g, point_of(1)).z - zero;
    const double complex i = isometry_apply(balance->geometry, g, point_of(CMPLX(0, 1))).z - zero;
    return (motion){(one + CMPLX(0, -1) * i) / 2, (one + CMPLX(0, 1) * i) / 2, zero};
}

/* The directions that a vertex may move in. */
static int basis_of(const orb_balance *balance, int32_t v, double complex basis[2]) {
    basis[0] = balance->freedom[v] == 1 ? balance->direction[v] : 1;
    basis[1] = CMPLX(0, 1);
    return balance->freedom[v];
}

static double along(double complex direction, double complex force) { return creal(conj(direction) * force); }

static void add_entry(workspace *work, int32_t row, int32_t column, double value) {
    orb_entries *entries = &work->entries;
    entries->row[entries->n_entries] = row;
    entries->column[entries->n_entries] = column;
    entries->value[entries->n_entries++] = value;
}

/* The force weight * (h_u^-1 h_v x_v - x_u) on the vertex of u, in its rows. Unknowns are displacements from the
 * positions that were given. */
static void add_force(workspace *work, int32_t u, int32_t v, double weight) {
    const orb_balance *balance = work->balance;
    const int32_t i = balance->copies->vertex[u], j = balance->copies->vertex[v];
    const motion m = motion_between(balance, u, v);
    const double complex force = weight * (apply(m, work->position[j].z) - work->position[i].z);
    double complex at_i[2], at_j[2];
    const int rows = basis_of(balance, i, at_i), columns = basis_of(balance, j, at_j);
    for (int a = 0; a < rows; a++) {
        const int32_t row = work->unknown[i] + a;
        work->right[row] += along(at_i[a], force);
        add_entry(work, row, row, weight);
        for (int b = 0; b < columns; b++) {
            const double complex moved = m.a * at_j[b] + m.b * conj(at_j[b]);
            add_entry(work, row, work->unknown[j] + b, -weight * along(at_i[a], moved));
        }
    }
}

static orb_status allocate(workspace *work, orb_error *error) {
    const orb_balance *balance = work->balance;
    const size_t edges = (size_t)balance->n_edges;
    if (balance->n_edges > INT32_MAX / 12) /* UMFPACK counts entries in 32 bits */
        return error_memory(error);
    work->unknown = malloc(((size_t)balance->n_vertices + 1) * sizeof *work->unknown);
    work->entries.row = malloc((12 * edges + 1) * sizeof *work->entries.row); /* 2 ends, 2 rows, 1 + 2 columns */
    work->entries.column = malloc((12 * edges + 1) * sizeof *work->entries.column);
    work->entries.value = malloc((12 * edges + 1) * sizeof *work->entries.value);
    if (!work->unknown || !work->entries.row || !work->entries.column || !work->entries.value)
        return error_memory(error);
    int32_t rows = 0;
    for (int32_t v = 0; v < balance->n_vertices; v++) {
        work->unknown[v] = rows;
        rows += balance->freedom[v];
    }
    work->unknown[balance->n_vertices] = rows;
    work->right = calloc((size_t)rows + 1, sizeof *work->right);
    work->solution = calloc((size_t)rows + 1, sizeof *work->solution);
    return work->right && work->solution ? ORB_OK : error_memory(error);
}

static void release(workspace *work) {
    free(work->unknown);
    free(work->entries.row);
    free(work->entries.column);
    free(work->entries.value);
    free(work->right);
    free(work->solution);
}

/* What is left of the forces at the solution. */
static orb_status measure(workspace *work, double *relative, orb_error *error) {
    const orb_balance *balance = work->balance;
    double complex *sum = calloc((size_t)balance->n_vertices + 1, sizeof *sum);
    double *size = calloc((size_t)balance->n_vertices + 1, sizeof *size);
    orb_status status = sum && size ? ORB_OK : error_memory(error);
    for (int32_t k = 0; k < 2 * balance->n_edges && status == ORB_OK; k++) {
        const int32_t u = balance->edges[k], v = balance->edges[k ^ 1];
        const int32_t i = balance->copies->vertex[u], j = balance->copies->vertex[v];
        const motion m = motion_between(balance, u, v);
        const double complex force = balance->weights[k] * (apply(m, work->position[j].z) - work->position[i].z);
        sum[i] += force;
        size[i] += cabs(force);
    }
    *relative = 0;
    for (int32_t v = 0; v < balance->n_vertices && status == ORB_OK; v++) {
        double complex basis[2];
        double left = 0;
        for (int a = basis_of(balance, v, basis); a-- > 0;)
            left = hypot(left, along(basis[a], sum[v]));
        if (left > *relative * size[v] || left != left)
            *relative = left / size[v];
    }
    free(sum);
    free(size);
    return status;
}

static bool is_anything_fixed(const orb_balance *balance) {
    for (int32_t k = 0; k < 2 * balance->n_edges; k++)
        if (balance->freedom[balance->copies->vertex[balance->edges[k]]] == 0)
            return true;
    return false;
}

/* Adds the displacements that were found to the positions. */
static void displace(const workspace *work, orb_point *position) {
    for (int32_t v = 0; v < work->balance->n_vertices; v++) {
        double complex basis[2];
        for (int a = basis_of(work->balance, v, basis); a-- > 0;)
            position[v] = point_of(position[v].z + work->solution[work->unknown[v] + a] * basis[a]);
    }
}

orb_status balance_solve(const orb_balance *balance, orb_point *position, double *relative, orb_error *error) {
    workspace work = {.balance = balance, .position = position};
    if (!is_anything_fixed(balance))
        return error_set(error, ORB_BAD_ARGUMENT,
                         "weights that are not symmetric need a cone or a corner that stays in its place: take "
                         "symmetric ones (mean-value)");
    orb_status status = allocate(&work, error);
    if (status != ORB_OK)
        goto done;
    for (int32_t k = 0; k < 2 * balance->n_edges; k++) /* vertices that no edge joins have no force and no freedom */
        add_force(&work, balance->edges[k], balance->edges[k ^ 1], balance->weights[k]);
    status = lu_solve(work.unknown[balance->n_vertices], &work.entries, work.right, work.solution, error);
    if (status != ORB_OK)
        goto done;
    orb_point *moved = malloc(((size_t)balance->n_vertices + 1) * sizeof *moved);
    if (!moved) {
        status = error_memory(error);
        goto done;
    }
    for (int32_t v = 0; v < balance->n_vertices; v++)
        moved[v] = position[v];
    displace(&work, moved);
    work.position = moved;
    double left = 0;
    if (relative)
        status = measure(&work, &left, error);
    for (int32_t v = 0; v < balance->n_vertices && status == ORB_OK; v++)
        position[v] = moved[v];
    if (relative)
        *relative = left;
    free(moved);
done:
    release(&work);
    return status;
}
