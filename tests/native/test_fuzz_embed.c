/* What tests/fuzz/fuzz_embed.c has come upon so far, once more. SPDX-License-Identifier: GPL-3.0-or-later */
#define LLVMFuzzerTestOneInput fuzz_embed
#include "../fuzz/fuzz_embed.c"
#include "../fuzz/replay.h"

TEST(corpus_of_embed) { replay("embed.txt", fuzz_embed); }
