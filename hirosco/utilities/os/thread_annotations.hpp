// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Marks for clang's thread safety analysis; other compilers see nothing.
#if defined(__clang__)
#define HIROSCO_THREAD_MARK(x) __attribute__((x))
#else
#define HIROSCO_THREAD_MARK(x)
#endif

#define HIROSCO_CAPABILITY(name) HIROSCO_THREAD_MARK(capability(name))
#define HIROSCO_SCOPED_CAPABILITY HIROSCO_THREAD_MARK(scoped_lockable)
#define HIROSCO_GUARDED_BY(mutex) HIROSCO_THREAD_MARK(guarded_by(mutex))
#define HIROSCO_REQUIRES(...) HIROSCO_THREAD_MARK(requires_capability(__VA_ARGS__))
#define HIROSCO_EXCLUDES(...) HIROSCO_THREAD_MARK(locks_excluded(__VA_ARGS__))
#define HIROSCO_ACQUIRE(...) HIROSCO_THREAD_MARK(acquire_capability(__VA_ARGS__))
#define HIROSCO_TRY_ACQUIRE(...) HIROSCO_THREAD_MARK(try_acquire_capability(__VA_ARGS__))
#define HIROSCO_RELEASE(...) HIROSCO_THREAD_MARK(release_capability(__VA_ARGS__))
