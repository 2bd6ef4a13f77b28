/* A test program is one file that includes this and defines tests; main is here.
 *
 *     TEST(three_points_make_a_plane)
 *     {
 *         REQUIRE(start() == 0);               stops the test when it fails
 *         CHECK(sides == 3);                   goes on
 *         CHECK_NEAR(area, 0.5, 1e-12);        |area - 0.5| <= 1e-12; a NaN fails
 *         if (!have_mesh) SKIP("no mesh");
 *     }
 *
 * Tests run in the order of definition and print `ok NAME`, `FAIL NAME: why` or `skip NAME: why`.  An argument
 * runs only the tests whose names contain it. */
#ifndef CHECK_H
#define CHECK_H

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef void (*check_function)(void);
static struct {
    const char *name;
    check_function run;
} check_tests[256];
static int check_count, check_failures, check_skipped;
static const char *check_name;

static inline void check_register(const char *name, check_function run) {
    if (check_count < (int)(sizeof check_tests / sizeof *check_tests)) {
        check_tests[check_count].name = name;
        check_tests[check_count].run = run;
    }
    check_count++;
}

#define TEST(name)                                                                                                     \
    static void name(void);                                                                                            \
    __attribute__((constructor)) static void check_register_##name(void) { check_register(#name, name); }              \
    static void name(void)

/* The first failure of a test is its FAIL line; the others follow, indented. */
#define CHECK_FAILED(format, ...)                                                                                      \
    printf("%s%s: %s:%d: " format "\n", check_failures++ ? "     " : "FAIL ", check_name, __FILE__, __LINE__,          \
           __VA_ARGS__)
#define CHECK(condition) ((condition) ? (void)0 : (void)CHECK_FAILED("%s", #condition))
#define REQUIRE(condition)                                                                                             \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            CHECK_FAILED("%s", #condition);                                                                            \
            return;                                                                                                    \
        }                                                                                                              \
    } while (0)
#define CHECK_NEAR(a, b, tolerance)                                                                                    \
    do {                                                                                                               \
        double check_a = (a), check_b = (b), check_tolerance = (tolerance);                                            \
        if (!(fabs(check_a - check_b) <= check_tolerance))                                                             \
            CHECK_FAILED("%s = %.17g, not %.17g within %g", #a, check_a, check_b, check_tolerance);                    \
    } while (0)
#define SKIP(why)                                                                                                      \
    do {                                                                                                               \
        printf("skip %s: %s\n", check_name, why);                                                                      \
        check_skipped = 1;                                                                                             \
        return;                                                                                                        \
    } while (0)

int main(int argc, char **argv) {
    int failed = check_count > (int)(sizeof check_tests / sizeof *check_tests);
    if (failed)
        return printf("FAIL check: more than 256 tests in one file\n"), 1;
    setvbuf(stdout, NULL, _IOLBF, BUFSIZ);
    for (int i = 0; i < check_count; i++) {
        check_name = check_tests[i].name;
        if (argc > 1 && !strstr(check_name, argv[1]))
            continue;
        check_failures = check_skipped = 0;
        check_tests[i].run();
        if (check_failures)
            failed = 1;
        else if (!check_skipped)
            printf("ok %s\n", check_name);
    }
    return failed;
}

#endif
