/* What tests/fuzz/fuzz_images.c has come upon so far, once more. SPDX-License-Identifier: GPL-3.0-or-later */
#define LLVMFuzzerTestOneInput fuzz_images
#include "../fuzz/fuzz_images.c"
#include "../fuzz/replay.h"

TEST(corpus_of_images) { replay("images.txt", fuzz_images); }
