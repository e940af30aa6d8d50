// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Under qemu-user only, for processors whose byte order is not this computer's: the kernel writes the holder of a mutex that lends its
// priority into the mutex itself, in this computer's byte order, and the emulator cannot turn it round. This is preloaded there, and
// mutexes lend nothing.
#include <pthread.h>

extern "C" int pthread_mutexattr_setprotocol(pthread_mutexattr_t*, int) noexcept { return 0; }
