// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace hirosco {

/// A sanitizer maps more memory than there is: what a process takes there says nothing of its program, so no limit of memory holds. g++
/// says so by a macro, clang by a feature.
inline constexpr bool built_with_sanitizer =
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
    true;
#else
    false;
#endif
#else
    false;
#endif

}  // namespace hirosco
