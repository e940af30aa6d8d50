// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/guard/guard_shell.hpp"

#include <fmt/format.h>
#include <link.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "supervisor/guard/safe_answer.hpp"

namespace hirosco::supervisor {
namespace {

/// Of the guard's thread: what it uses of it stays in memory.
constexpr std::size_t stack_octets = std::size_t{256} << 10;

constexpr std::size_t most_clients = 8;
constexpr Duration patience = std::chrono::seconds{1};
constexpr Duration knock_pause = std::chrono::milliseconds{1};
/// Until who has no room for its answer is tried again.
constexpr Duration say_pause = std::chrono::milliseconds{10};

[[nodiscard]] std::string line_of(const StopAnswer& answer) {
  if (!answer.stopped) return safe_line(false, answer.name + " did not confirm that it stopped");
  return safe_line(true, fmt::format("{} stopped {:.0f} ms{}{}{}{}", answer.name,
                                     std::chrono::duration<double, std::milli>(*answer.stopped).count(),
                                     answer.asked_device ? ", says the device" : "",
                                     answer.killed ? ", its subsystem was ended" : "",
                                     answer.otherwise.empty() ? "" : ", but ", answer.otherwise));
}

/// The code of a program or library as it is in memory.
int lock_code(dl_phdr_info* object, std::size_t, void*) {
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const auto& part = object->dlpi_phdr[i];
    if (part.p_type == PT_LOAD && (part.p_flags & PF_X) != 0)
      static_cast<void>(::mlock(reinterpret_cast<const void*>(object->dlpi_addr + part.p_vaddr), part.p_memsz));
  }
  return 0;
}

}  // namespace

void keep_code_in_memory() noexcept {
  // What has been used stays; all else of the heap and of stacks would be memory that nobody needs.
  static_cast<void>(::mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT));
  ::dl_iterate_phdr(lock_code, nullptr);
}

Result<std::unique_ptr<GuardShell>> GuardShell::start(Guard& guard, const Clock& clock,
                                                      const std::filesystem::path& folder, Calls calls) {
  HIROSCO_TRY_LET(WakeEvent ending, WakeEvent::create());
  std::unique_ptr<GuardShell> shell{new GuardShell{guard, clock, std::move(ending)}};
  shell->calls_ = std::move(calls);
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGUSR1);
  shell->signals_.reset(::signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK));
  if (!shell->signals_) return fail(ErrorCode::SystemFailure, "signalfd of the guard", errno);
  if (!folder.empty()) {
    HIROSCO_TRY(shell->listen(folder));
    HIROSCO_TRY(shell->waits_.add(shell->listener_.get()));
  }
  HIROSCO_TRY(shell->waits_.add(shell->signals_.get()));
  HIROSCO_TRY(shell->waits_.add(shell->ending_.descriptor()));
  HIROSCO_TRY_LET(shell->thread_, Thread::start("guard", [self = shell.get()] { self->run(); }, stack_octets));
  return shell;
}

GuardShell::~GuardShell() {
  ended_.store(true);
  ending_.notify();
  thread_.join();
  if (!socket_path_.empty()) ::unlink(socket_path_.c_str());
}

Result<> GuardShell::listen(const std::filesystem::path& folder) {
  socket_path_ = folder / "safe.socket";
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (socket_path_.native().size() >= sizeof address.sun_path)
    return fail(ErrorCode::OutOfRange, "path of the guard's socket",
                static_cast<std::int64_t>(socket_path_.native().size()));
  std::memcpy(address.sun_path, socket_path_.c_str(), socket_path_.native().size());
  listener_.reset(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  ::unlink(socket_path_.c_str());  // of a flight that was killed; the flight's lock keeps others away
  if (!listener_ || ::bind(listener_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(listener_.get(), static_cast<int>(most_clients)) != 0)
    return fail(ErrorCode::SystemFailure, "socket of the guard", errno);
  return ok();
}

void GuardShell::run() {
  // Where it is not granted the reduced promise holds, as for the cycles.
  static_cast<void>(set_fifo_priority(priority));
  if (calls_.on_begin) calls_.on_begin();
  while (!ended_.load()) {
    const TimePoint wake = guard_.step(clock_.now());
    answer_clients(clock_.now());
    const Duration rest = std::max(wake - clock_.now(), Duration{0});
    const auto ready = waits_.wait(has_more_to_say() ? std::min(rest, say_pause) : rest);
    if (!ready) continue;
    bool asked = false;
    for (const Ready& entry : *ready) {
      // No descriptor is left for whoever knocks: it goes on knocking, and the guard must not keep the processor for that.
      if (entry.descriptor == listener_.get() && !welcome(clock_.now())) sleep_until(clock_.now() + knock_pause);
      if (entry.descriptor != signals_.get()) continue;
      signalfd_siginfo info;
      while (::read(signals_.get(), &info, sizeof info) > 0) asked = true;
    }
    if (asked) stop();
  }
}

bool GuardShell::welcome(TimePoint now) {
  FileDescriptor socket{::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK)};
  if (!socket) return errno == EAGAIN;
  if (clients_.size() == most_clients) {
    // Who has asked waits for its answer; only where all have is one of them let go, the oldest.
    const auto silent = std::ranges::find(clients_, 0U, &Client::stop);
    clients_.erase(silent != clients_.end() ? silent : clients_.begin());
  }
  clients_.push_back({.socket = std::move(socket), .until = now + patience});
  return true;
}

void GuardShell::hear(Client& client) {
  std::array<char, 8> words{};
  const auto octets = ::recv(client.socket.get(), words.data(), words.size(), MSG_DONTWAIT);
  if (octets < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (octets > 0 && std::string_view{words.data(), static_cast<std::size_t>(octets)} == safe_request) {
    client.stop = stop();
    return;
  }
  client.socket.reset();
}

bool GuardShell::has_more_to_say() const noexcept {
  return std::ranges::any_of(clients_, [](const Client& client) { return !client.answer.empty(); });
}

/// All of it, or the end of the connection without the last line: who hears that knows that somebody is missing.
void GuardShell::say(Client& client, TimePoint now) {
  for (; client.said < client.answer.size(); ++client.said) {
    const std::string& line = client.answer[client.said];
    if (::send(client.socket.get(), line.data(), line.size(), MSG_DONTWAIT | MSG_NOSIGNAL) >= 0) continue;
    const bool no_room = errno == EAGAIN || errno == EINTR || errno == ENOBUFS || errno == ENOMEM;
    if (no_room && now < client.until) return;
    break;
  }
  client.socket.reset();
}

void GuardShell::answer_clients(TimePoint now) {
  for (Client& client : clients_) {
    if (client.stop == 0) hear(client);
    if (!client.socket) continue;
    if (client.stop == 0) {
      if (now >= client.until) client.socket.reset();
      continue;
    }
    if (client.answer.empty()) {
      const auto answers = guard_.stop_outcome(client.stop);
      if (!answers) continue;
      for (const StopAnswer& answer : *answers) client.answer.push_back(line_of(answer));
      client.answer.push_back(safe_last_line(answers->size()));
      client.until = now + patience;
    }
    say(client, now);
  }
  std::erase_if(clients_, [](const Client& client) { return !client.socket; });
}

}  // namespace hirosco::supervisor
