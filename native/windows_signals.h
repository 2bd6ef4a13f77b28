/* What job.c uses of POSIX signals and MinGW lacks. Windows runs no handler on a thread that is at work, so there is
 * nothing to block. platform.mk has it included before all others. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef WINDOWS_SIGNALS_H
#define WINDOWS_SIGNALS_H
#include <pthread.h>
#include <signal.h>
enum { SIGBUS = NSIG, SIGTRAP, SIGSYS };
typedef int sigset_t;
#define sigfillset(set) ((void)(*(set) = 0))
#define sigdelset(set, number) ((void)(number))
#undef pthread_sigmask
#define pthread_sigmask windows_sigmask
static inline int windows_sigmask(int how, const sigset_t *set, sigset_t *before) {
    (void)how;
    (void)set;
    (void)before;
    return 0;
}
#endif
