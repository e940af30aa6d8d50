// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/mutex.hpp"

#include <cstdlib>

namespace hirosco {
namespace {

/// A failure here is a broken invariant of ours (double unlock, recursion): going on would corrupt data.
void must_be_zero(int error) noexcept {
  if (error != 0) std::abort();
}

}  // namespace

Mutex::Mutex() noexcept {
  pthread_mutexattr_t attributes;
  must_be_zero(pthread_mutexattr_init(&attributes));
  must_be_zero(pthread_mutexattr_settype(&attributes, PTHREAD_MUTEX_ERRORCHECK));
  inherits_priority_ = pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT) == 0;
  must_be_zero(pthread_mutex_init(&mutex_, &attributes));
  must_be_zero(pthread_mutexattr_destroy(&attributes));
}

Mutex::~Mutex() { (void)pthread_mutex_destroy(&mutex_); }

void Mutex::lock() noexcept { must_be_zero(pthread_mutex_lock(&mutex_)); }

bool Mutex::try_lock() noexcept { return pthread_mutex_trylock(&mutex_) == 0; }

void Mutex::unlock() noexcept { must_be_zero(pthread_mutex_unlock(&mutex_)); }

}  // namespace hirosco
