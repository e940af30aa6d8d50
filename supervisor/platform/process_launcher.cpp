// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/process_launcher.hpp"

#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <new>
#include <string>

#include "hirosco/data_transfer/control/socket_channel.hpp"
#include "hirosco/subsystem/pages.hpp"
#include "hirosco/utilities/os/installation.hpp"

namespace hirosco::supervisor {
namespace {

// Descriptor numbers in the new process.
constexpr int channel_number = 3;
constexpr int vital_number = 4;
constexpr int permit_number = 5;

[[nodiscard]] FileDescriptor open_statm(const std::string& process) {
  return FileDescriptor{::open(("/proc/" + process + "/statm").c_str(), O_RDONLY | O_CLOEXEC)};
}

/// Works on a process by its handle, so never on another one that got its number later.
class LinuxGrip final : public ProcessGrip {
 public:
  explicit LinuxGrip(Process process) : process_{std::move(process)} {
    if (::clock_getcpuclockid(process_.pid(), &clock_) != 0) clock_ = CLOCK_MONOTONIC_COARSE;
  }
  void take_realtime() noexcept override {
    if (!runs()) return;
    std::error_code failed;
    bool refused = false;
    const auto tasks = std::filesystem::path{"/proc"} / std::to_string(process_.pid()) / "task";
    for (const auto& task : std::filesystem::directory_iterator{tasks, failed}) {
      int thread = 0;
      const std::string name = task.path().filename();
      std::from_chars(name.data(), name.data() + name.size(), thread);
      const sched_param ordinary{};
      // What the thread has of this flag an ordinary user may not take away.
      const int kept = std::max(::sched_getscheduler(thread), 0) & SCHED_RESET_ON_FORK;
      if (thread > 0 && ::sched_setscheduler(thread, SCHED_OTHER | kept, &ordinary) != 0 && errno != ESRCH)
        refused = true;
    }
    if (refused) kill();  // or the others would not have the processor until its grace is over
  }
  Duration processor_time() noexcept override {
    timespec time{};
    if (clock_ == CLOCK_MONOTONIC_COARSE || ::clock_gettime(clock_, &time) != 0) return {};
    return std::chrono::seconds{time.tv_sec} + Duration{time.tv_nsec};
  }
  void kill() noexcept override { static_cast<void>(process_.send_signal(SIGKILL)); }

 private:
  [[nodiscard]] bool runs() noexcept { return process_.send_signal(0).has_value(); }
  Process process_;
  clockid_t clock_{};
};

/// A page in memory of its own, constructed in place.
template <class Page>
[[nodiscard]] Result<std::pair<MemoryHandle, Mapping>> make_page(SealedMemory& memory, const char* name) {
  HIROSCO_TRY_LET(MemoryHandle handle, memory.create(name, sizeof(Page)));
  HIROSCO_TRY_LET(Mapping mapping, memory.map(handle, Access::ReadWrite));
  ::new (mapping.octets.data()) Page;
  return std::pair{std::move(handle), std::move(mapping)};
}

}  // namespace

Result<std::shared_ptr<ProcessGrip>> grip_of(const Process& process) {
  FileDescriptor handle{::fcntl(process.handle().get(), F_DUPFD_CLOEXEC, 0)};
  if (!handle) return fail(ErrorCode::SystemFailure, "hold of a process", errno);
  HIROSCO_TRY_LET(Process second, Process::adopt(process.pid(), std::move(handle)));
  return std::make_shared<LinuxGrip>(std::move(second));
}

Result<LaunchedSubsystem> SystemLauncher::launch(const descriptor::MissionSubsystem& subsystem) {
  const auto program = find_program(subsystem.executable);
  if (program.empty()) return fail(ErrorCode::NotFound, "its executable is neither beside this program nor in PATH");
  HIROSCO_TRY_LET(auto vital, make_page<VitalPage>(memory_, "hirosco-vital"));
  HIROSCO_TRY_LET(auto permit, make_page<PermitPage>(memory_, "hirosco-permit"));
  // Its counts go on where those of the process before it ended (decision 8b).
  auto& before = vital_[subsystem.subsystem.name];
  if (before.octets.size() >= sizeof(VitalPage))
    reinterpret_cast<VitalPage*>(vital.second.octets.data())->counters =
        reinterpret_cast<const VitalPage*>(before.octets.data())->counters;
  before = vital.second;
  // The subsystem reads what gates its actuators; from now on nobody can map it otherwise (hazard SF13).
  HIROSCO_TRY(memory_.seal_writers(permit.first));
  HIROSCO_TRY_LET(auto ends, SocketChannel::make_pair());
  ProcessStart start;
  start.executable = program.string();
  start.arguments = {"--descriptor", subsystem.subsystem.file.string(), "--channel", std::to_string(channel_number),
                     "--vital",      std::to_string(vital_number),      "--permit",  std::to_string(permit_number)};
  for (const auto& [word, text] : descriptor::changes_of(subsystem))
    start.arguments.insert(start.arguments.end(), {word, text});
  start.inherited = {{ends.second.get(), channel_number},
                     {SealedMemory::descriptor(vital.first), vital_number},
                     {SealedMemory::descriptor(permit.first), permit_number}};
  // What it writes to its standard error is shown with its name, within limits.
  const auto errors = errors_.open(subsystem.subsystem.name);
  if (errors) start.inherited.push_back({errors->get(), STDERR_FILENO});
  HIROSCO_TRY_LET(Process process, Process::spawn(start));
  auto grip = grip_of(process);
  if (!grip) {
    // One that nobody could end is not let go at all.
    static_cast<void>(process.send_signal(SIGKILL));
    return fail(grip.error());
  }
  LaunchedSubsystem launched;
  launched.vital = std::move(vital.second);
  launched.permit = std::move(permit.second);
  launched.port = std::make_unique<LocalMemberPort>(std::make_unique<SocketChannel>(std::move(ends.first)),
                                                    launched.vital, launched.permit);
  launched.process = next_++;
  launched.grip = std::move(*grip);
  memory_use_[launched.process] = open_statm(std::to_string(process.pid()));
  if (!memory_use_[0]) memory_use_[0] = open_statm("self");
  processes_.emplace(launched.process, std::move(process));
  return launched;
}

std::optional<ProcessEnd> SystemLauncher::ended(std::uint32_t process) {
  const auto found = processes_.find(process);
  if (found == processes_.end()) return ProcessEnd{};
  const auto status = found->second.poll();
  if (!status || !*status) return std::nullopt;
  const ProcessEnd end{(*status)->kind == ExitStatus::Kind::Signalled, (*status)->value};
  processes_.erase(found);
  memory_use_.erase(process);
  return end;
}

void SystemLauncher::kill(std::uint32_t process) {
  if (const auto found = processes_.find(process); found != processes_.end())
    static_cast<void>(found->second.send_signal(SIGKILL));
}

std::uint32_t SystemLauncher::resident_kb(std::uint32_t process) noexcept {
  const auto found = memory_use_.find(process);
  if (found == memory_use_.end()) return 0;
  std::array<char, 128> text;
  const auto octets = ::pread(found->second.get(), text.data(), text.size(), 0);
  if (octets <= 0) return 0;
  // "size resident shared ...", in pages.
  const std::string_view line{text.data(), static_cast<std::size_t>(octets)};
  const auto blank = line.find(' ');
  std::uint64_t pages = 0;
  if (blank != std::string_view::npos) std::from_chars(line.data() + blank + 1, line.data() + line.size(), pages);
  static const auto page_octets = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return static_cast<std::uint32_t>(pages * page_octets / 1024);
}

void SystemLauncher::kill_all() {
  for (auto& [number, process] : processes_) static_cast<void>(process.send_signal(SIGKILL));
}

bool SystemLauncher::any_running() {
  for (auto entry = processes_.begin(); entry != processes_.end();) {
    const auto status = entry->second.poll();
    entry = !status || status->has_value() ? processes_.erase(entry) : std::next(entry);
  }
  return !processes_.empty();
}

int SystemLauncher::wait_descriptor(std::uint32_t process) {
  const auto found = processes_.find(process);
  return found != processes_.end() ? found->second.handle().get() : -1;
}

}  // namespace hirosco::supervisor
