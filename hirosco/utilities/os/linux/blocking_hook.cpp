// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Stands before the C library's locks and outputs in the executables that link it, reports each use to allocation_guard and
// goes on to the real ones. std::mutex, streams and fmt stand on them. Trying a lock is no wait, so it is not counted; nor are
// sockets, which devices and links are spoken to by. What prints by way of another output counts more than once.
// A program built with _FORTIFY_SOURCE prints by functions of other names, as __printf_chk for printf().

#include <features.h>
// With an optimiser the C library has some of these functions inline, which clang does not let anybody define again.
#undef __USE_EXTERN_INLINES

#include <dlfcn.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cstdarg>
#include <cstdio>

#include "hirosco/utilities/allocation_guard.hpp"

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace {

/// The next definition of a function behind this executable's own, looked for once.
template <class Function>
class Real {
 public:
  constexpr explicit Real(const char* name) noexcept : name_{name} {}
  template <class... Arguments>
  auto operator()(Arguments... arguments) noexcept {
    Function* found = found_.load(std::memory_order_relaxed);
    if (found == nullptr) {
      found = reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name_));
      found_.store(found, std::memory_order_relaxed);
    }
    return found(arguments...);
  }

 private:
  const char* name_;
  std::atomic<Function*> found_{nullptr};
};

constinit Real<int(pthread_mutex_t*)> real_mutex_lock{"pthread_mutex_lock"};
constinit Real<int(pthread_mutex_t*, const timespec*)> real_mutex_timedlock{"pthread_mutex_timedlock"};
constinit Real<int(pthread_rwlock_t*)> real_rwlock_rdlock{"pthread_rwlock_rdlock"};
constinit Real<int(pthread_rwlock_t*)> real_rwlock_wrlock{"pthread_rwlock_wrlock"};
constinit Real<int(sem_t*)> real_sem_wait{"sem_wait"};
constinit Real<ssize_t(int, const void*, std::size_t)> real_write{"write"};
constinit Real<ssize_t(int, const iovec*, int)> real_writev{"writev"};
constinit Real<std::size_t(const void*, std::size_t, std::size_t, FILE*)> real_fwrite{"fwrite"};
constinit Real<int(const char*, FILE*)> real_fputs{"fputs"};
constinit Real<int(const char*)> real_puts{"puts"};
constinit Real<int(int, FILE*)> real_fputc{"fputc"};
constinit Real<int(int, FILE*)> real_putc{"putc"};
constinit Real<int(int)> real_putchar{"putchar"};
constinit Real<int(FILE*, const char*, va_list)> real_vfprintf{"vfprintf"};
constinit Real<int(FILE*, int, const char*, va_list)> real_vfprintf_chk{"__vfprintf_chk"};

}  // namespace

#pragma GCC visibility push(default)
extern "C" {

int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  hirosco_note_lock();
  return real_mutex_lock(mutex);
}

int pthread_mutex_timedlock(pthread_mutex_t* mutex, const timespec* until) noexcept {
  hirosco_note_lock();
  return real_mutex_timedlock(mutex, until);
}

int pthread_rwlock_rdlock(pthread_rwlock_t* lock) noexcept {
  hirosco_note_lock();
  return real_rwlock_rdlock(lock);
}

int pthread_rwlock_wrlock(pthread_rwlock_t* lock) noexcept {
  hirosco_note_lock();
  return real_rwlock_wrlock(lock);
}

int sem_wait(sem_t* semaphore) {
  hirosco_note_lock();
  return real_sem_wait(semaphore);
}

ssize_t write(int file, const void* octets, std::size_t count) {
  hirosco_note_output();
  return real_write(file, octets, count);
}

ssize_t writev(int file, const iovec* parts, int count) {
  hirosco_note_output();
  return real_writev(file, parts, count);
}

std::size_t fwrite(const void* octets, std::size_t size, std::size_t count, FILE* file) {
  hirosco_note_output();
  return real_fwrite(octets, size, count, file);
}

int fputs(const char* text, FILE* file) {
  hirosco_note_output();
  return real_fputs(text, file);
}

int puts(const char* text) {
  hirosco_note_output();
  return real_puts(text);
}

int fputc(int letter, FILE* file) {
  hirosco_note_output();
  return real_fputc(letter, file);
}

int putc(int letter, FILE* file) {
  hirosco_note_output();
  return real_putc(letter, file);
}

int putchar(int letter) {
  hirosco_note_output();
  return real_putchar(letter);
}

int vfprintf(FILE* file, const char* format, va_list arguments) {
  hirosco_note_output();
  return real_vfprintf(file, format, arguments);
}

int vprintf(const char* format, va_list arguments) {
  hirosco_note_output();
  return real_vfprintf(stdout, format, arguments);
}

int fprintf(FILE* file, const char* format, ...) {
  hirosco_note_output();
  va_list arguments;
  va_start(arguments, format);
  const int written = real_vfprintf(file, format, arguments);
  va_end(arguments);
  return written;
}

int printf(const char* format, ...) {
  hirosco_note_output();
  va_list arguments;
  va_start(arguments, format);
  const int written = real_vfprintf(stdout, format, arguments);
  va_end(arguments);
  return written;
}

// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): the C library's own names
int __vfprintf_chk(FILE* file, int checks, const char* format, va_list arguments) {
  hirosco_note_output();
  return real_vfprintf_chk(file, checks, format, arguments);
}

int __vprintf_chk(int checks, const char* format, va_list arguments) {
  hirosco_note_output();
  return real_vfprintf_chk(stdout, checks, format, arguments);
}

int __fprintf_chk(FILE* file, int checks, const char* format, ...) {
  hirosco_note_output();
  va_list arguments;
  va_start(arguments, format);
  const int written = real_vfprintf_chk(file, checks, format, arguments);
  va_end(arguments);
  return written;
}

int __printf_chk(int checks, const char* format, ...) {
  hirosco_note_output();
  va_list arguments;
  va_start(arguments, format);
  const int written = real_vfprintf_chk(stdout, checks, format, arguments);
  va_end(arguments);
  return written;
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)

}  // extern "C"
#pragma GCC visibility pop

#endif
