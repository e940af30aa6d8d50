// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <signal.h>

namespace hirosco::supervisor {

/// For a process that carries out stops: no terminal stops it, by Ctrl-Z or because it writes (`stty tostop`) or reads in the background
/// (docs/adr/0167). Whom it starts begins with the system's own again.
inline void ignore_job_control() noexcept {
  for (const int number : {SIGTSTP, SIGTTIN, SIGTTOU}) ::signal(number, SIG_IGN);
}

}  // namespace hirosco::supervisor
