# What differs between systems: how the library is called and linked, and where SuiteSparse comes from.
# Linux is what is built and tested. The other two have never been run: no such machine was at hand. What is known of
# them is in docs/building.md.

SYSTEM := $(shell uname -s)

ifeq ($(SYSTEM),Darwin)
# Apple's clang; SuiteSparse's static libraries of Homebrew, with Apple's BLAS and LAPACK, which every Mac has.
BREW := $(shell brew --prefix)
LIBRARY_NAME := liborbifold.dylib
SHARED = -dynamiclib -install_name @rpath/$(LIBRARY_NAME) -Wl,-exported_symbol,'_orb_*' $(if $(DEBUG),,-Wl,-x)
SECTIONS := -Wl,-dead_strip -mmacosx-version-min=11.0
SUITESPARSE_CFLAGS := -isystem $(BREW)/opt/suite-sparse/include/suitesparse -mmacosx-version-min=11.0
SUITESPARSE_LIBS := $(patsubst %,$(BREW)/opt/suite-sparse/lib/lib%.a,umfpack cholmod amd colamd camd ccolamd \
    suitesparseconfig) -framework Accelerate

else ifneq ($(filter MINGW% MSYS%,$(SYSTEM)),)
# MSYS2's UCRT64 shell: gcc, SuiteSparse, OpenBLAS, all linked statically, so that the DLL needs Windows' own only.
ifeq ($(origin CC),default)
CC := gcc
endif
LIBRARY_NAME := liborbifold.dll
SHARED = -shared -static -Wl,--exclude-libs,ALL -Wl,--no-undefined $(if $(DEBUG),,-Wl,-s)
SECTIONS := -Wl,--gc-sections
# gcc knows the formats of an older C library (no %zu) than the one of UCRT64.
SUITESPARSE_CFLAGS := -isystem $(MINGW_PREFIX)/include/suitesparse -include windows_signals.h -Wno-format \
    -Wno-format-extra-args
SUITESPARSE_LIBS := -lumfpack -lcholmod -lamd -lcolamd -lcamd -lccolamd -lsuitesparseconfig -lopenblas \
    -lgomp -lgfortran -lquadmath

else
LIBRARY_NAME := liborbifold.so
SHARED = -shared -Wl,--exclude-libs,ALL -Wl,--no-undefined $(if $(DEBUG),,-Wl,-s)
SECTIONS := -Wl,--gc-sections
FLAGS := $(SUITESPARSE)/flags.mk
endif
