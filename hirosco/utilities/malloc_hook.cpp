// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Replaces the C library's heap functions in the executables that link it, reports each use to allocation_guard and goes
// on, where that does not refuse it, to the real ones, which glibc exports for exactly this. Operator new and delete stand on them. Sanitizers replace
// the same functions, so there it says that it is absent.

#include <cerrno>
#include <cstddef>

#include "hirosco/utilities/allocation_guard.hpp"
#include "hirosco/utilities/refused_allocations.hpp"

extern "C" bool hirosco_malloc_hook_present() noexcept;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)

extern "C" bool hirosco_malloc_hook_present() noexcept { return false; }

#else

namespace {
[[nodiscard]] void* refused() noexcept {
  errno = ENOMEM;
  return nullptr;
}
}  // namespace

extern "C" {

// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): the C library's own names
void* __libc_malloc(std::size_t octets);
void* __libc_calloc(std::size_t count, std::size_t octets);
void* __libc_realloc(void* place, std::size_t octets);
void* __libc_memalign(std::size_t alignment, std::size_t octets);
void __libc_free(void* place);
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)

bool hirosco_malloc_hook_present() noexcept { return true; }

void* malloc(std::size_t octets) noexcept {
  hirosco_note_allocation(octets);
  return hirosco_refuses_allocation() ? refused() : __libc_malloc(octets);
}

void* calloc(std::size_t count, std::size_t octets) noexcept {
  hirosco_note_allocation(count * octets);
  return hirosco_refuses_allocation() ? refused() : __libc_calloc(count, octets);
}

void* realloc(void* place, std::size_t octets) noexcept {
  hirosco_note_allocation(octets);
  return hirosco_refuses_allocation() ? refused() : __libc_realloc(place, octets);
}

void* memalign(std::size_t alignment, std::size_t octets) noexcept {
  hirosco_note_allocation(octets);
  return hirosco_refuses_allocation() ? refused() : __libc_memalign(alignment, octets);
}

void* aligned_alloc(std::size_t alignment, std::size_t octets) noexcept {
  hirosco_note_allocation(octets);
  return hirosco_refuses_allocation() ? refused() : __libc_memalign(alignment, octets);
}

int posix_memalign(void** place, std::size_t alignment, std::size_t octets) noexcept {
  if (alignment < sizeof(void*) || (alignment & (alignment - 1)) != 0) return EINVAL;
  hirosco_note_allocation(octets);
  void* const got = hirosco_refuses_allocation() ? nullptr : __libc_memalign(alignment, octets);
  if (got == nullptr) return ENOMEM;
  *place = got;
  return 0;
}

void free(void* place) noexcept {
  if (place != nullptr) hirosco_note_free();
  __libc_free(place);
}

}  // extern "C"

#endif
