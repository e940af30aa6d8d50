// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/system_launcher.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "hirosco/data_transfer/channel/socket_channel.hpp"
#include "hirosco/subsystem/pages/pages.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/installation.hpp"
#include "supervisor/platform/launch/own_users.hpp"
#include "supervisor/platform/launch/subsystem_sandbox.hpp"

namespace hirosco::supervisor {
namespace {

// Descriptor numbers in the new process.
constexpr int channel_number = 3;
constexpr int vital_number = 4;
constexpr int permit_number = 5;
constexpr int script_number = 6;
constexpr int text_number = 7;

/// The supervisor's end of a channel. The keeper has a duplicate, so that closing it alone would not end what is at the other end;
/// a supervisor that is killed closes nothing. No subsystem sends it any memory.
class OwnedEnd final : public Channel {
 public:
  explicit OwnedEnd(FileDescriptor socket) noexcept : channel_{std::move(socket), SocketChannel::Memory::Dropped} {}
  ~OwnedEnd() override { ::shutdown(channel_.wait_descriptor(), SHUT_RDWR); }
  Result<> send(const Message& message) override { return channel_.send(message); }
  std::size_t send_all(std::span<const Message> messages) override { return channel_.send_all(messages); }
  Result<Found> receive(MessageBuffer& buffer) override { return channel_.receive(buffer); }
  [[nodiscard]] int wait_descriptor() const noexcept override { return channel_.wait_descriptor(); }

 private:
  SocketChannel channel_;
};

/// Of whom only the handle is known.
constexpr int unknown_pid = -1;

/// Of the process behind a handle; empty: there is none, it has ended, or no descriptor is left to ask by.
[[nodiscard]] std::optional<int> pid_of(int handle) {
  if (handle < 0) return std::nullopt;
  const FileDescriptor file{::open(("/proc/self/fdinfo/" + std::to_string(handle)).c_str(), O_RDONLY | O_CLOEXEC)};
  std::array<char, 512> text;
  const auto octets = file ? ::read(file.get(), text.data(), text.size()) : 0;
  const std::string_view lines{text.data(), static_cast<std::size_t>(std::max<ssize_t>(octets, 0))};
  constexpr std::string_view word = "\nPid:\t";
  const auto at = lines.find(word);
  int pid = 0;
  if (at != std::string_view::npos) std::from_chars(lines.data() + at + word.size(), lines.data() + lines.size(), pid);
  return pid > 0 ? std::optional{pid} : std::nullopt;
}

/// A page in memory of its own, constructed in place.
template <class Page>
[[nodiscard]] Result<std::pair<MemoryHandle, Mapping>> make_page(SealedMemory& memory, const char* name) {
  HIROSCO_TRY_LET(MemoryHandle handle, memory.create(name, sizeof(Page)));
  HIROSCO_TRY_LET(Mapping mapping, memory.map(handle, Access::ReadWrite));
  ::new (mapping.octets.data()) Page;
  return std::pair{std::move(handle), std::move(mapping)};
}

[[nodiscard]] Result<MemoryHandle> make_text(SealedMemory& memory, const std::string& text) {
  HIROSCO_TRY_LET(MemoryHandle handle, memory.create("hirosco-descriptor", text.size()));
  HIROSCO_TRY_LET(const Mapping mapping, memory.map(handle, Access::ReadWrite));
  std::ranges::copy(std::as_bytes(std::span{text}), mapping.octets.begin());
  HIROSCO_TRY(memory.seal_writers(handle));
  return handle;
}

/// What comes with HIROSCO is found from where a program stands, and one that runs from memory stands nowhere.
[[nodiscard]] std::string placed(const std::string& file) {
  if (!file.starts_with(shipped_prefix)) return file;
  const auto found = find_shipped(std::string_view{file}.substr(shipped_prefix.size()));
  return found.empty() ? file : found.string();
}

[[nodiscard]] std::vector<std::string> arguments_of(const descriptor::MissionSubsystem& subsystem) {
  std::vector<std::string> words{"--descriptor", placed(subsystem.subsystem.file.string()),
                                 "--channel",    std::to_string(channel_number),
                                 "--vital",      std::to_string(vital_number),
                                 "--permit",     std::to_string(permit_number)};
  if (subsystem.subsystem.text) words.insert(words.end(), {"--text", std::to_string(text_number)});
  if (subsystem.cores.cycle) words.insert(words.end(), {"--core", std::to_string(*subsystem.cores.cycle)});
  for (const auto& [word, text] : descriptor::changes_of(subsystem)) {
    // "NAME=12:FILE"
    const auto file_at = descriptor::needs_other(word) ? text.find(':') + 1 : text.size();
    words.insert(words.end(), {word, text.substr(0, file_at) + placed(text.substr(file_at))});
  }
  return words;
}

/// Counts of a process go on where those of the one before it ended (decision 8b).
void count_on(Mapping& newest, const Mapping& now) {
  const Mapping before = std::exchange(newest, now);
  if (before.octets.size() >= sizeof(VitalPage))
    reinterpret_cast<VitalPage*>(now.octets.data())->counters =
        reinterpret_cast<const VitalPage*>(before.octets.data())->counters;
}

/// Of a process that obeys `page` and is about to obey `fresh`. Should this supervisor die before its guard has written on the new page, the
/// next one finds there what this one has found, permitted apart.
[[nodiscard]] AdoptedSubsystem found_on(const PermitPage& page, PermitPage& fresh) {
  AdoptedSubsystem adopted;
  adopted.epoch = page.epoch.load(std::memory_order_acquire);
  adopted.permitted = page.permits(adopted.epoch);
  adopted.stopped = page.stop.load(std::memory_order_acquire) != 0;
  adopted.powered = page.powered.load(std::memory_order_acquire);
  fresh.epoch.store(adopted.epoch, std::memory_order_release);
  fresh.stop.store(adopted.stopped ? 1 : 0, std::memory_order_release);
  fresh.powered.store(adopted.powered, std::memory_order_release);
  fresh.newest_stop.store(page.newest_stop.load(std::memory_order_acquire), std::memory_order_release);
  return adopted;
}

/// What is wrong, and where the system refuses something how it calls that.
[[nodiscard]] std::string in_words(const Error& why) {
  const bool of_system = why.code == ErrorCode::SystemFailure && why.value > 0;
  return of_system ? fmt::format("{} ({})", why.text, std::strerror(static_cast<int>(why.value)))
                   : std::string{why.text};
}

}  // namespace

std::expected<std::string, std::string> SystemLauncher::begin(const descriptor::Mission& mission) {
  if (!begin_collecting() || !running_.watch().looks()) return std::unexpected{"no thread to watch processes by"};
  SpareFolders::sweep();
  users_ = mission.users;
  one_user_ = why_one_user(mission, own_users_granted_);
  for (const auto& subsystem : mission.subsystems)
    if (subsystem.user) user_of_[subsystem.subsystem.name] = *subsystem.user;
  if (!mission.manifest) return std::string{};
  if (page_ != nullptr && page_->starts.load() > 1) {
    programs_.hold_to_beside(mission);
    return std::string{"executables of the manifest are read anew, beside the flight"};
  }
  const SystemClock clock;
  const TimePoint begun = clock.now();
  const HeldPrograms& held = programs_.hold_to(mission);
  return fmt::format("{} executables of {} kB are as the manifest says, read in {:.1f} ms", held.count(),
                     held.octets() / 1024, 1e3 * seconds(clock.now() - begun));
}

std::string SystemLauncher::shut_out(std::uint32_t process, const descriptor::MissionSubsystem& flown,
                                     const descriptor::MissionSubsystem& fresh) {
  Sandbox had = sandbox_of(flown, {}, instance_, user_of_processes());
  reach_.add_possible(process, fresh, had);
  return supervisor::shut_out(had, sandbox_of(fresh, {}, instance_, user_of_processes()));
}

std::optional<OwnGroup> SystemLauncher::own_group_of(const descriptor::MissionSubsystem& subsystem) const {
  const auto user = user_of_.find(subsystem.subsystem.name);
  if (user_of_processes() != ProcessUser::ItsOwn || user == user_of_.end()) return std::nullopt;
  return OwnGroup{user->second, {users_->first, users_->last}};
}

std::string SystemLauncher::left_open(const descriptor::MissionSubsystem& subsystem) const {
  return sandbox_is_off() || subsystem.carries_ground ? ""
                                                      : supervisor::left_open(sandbox_of(subsystem, {}, instance_));
}

std::vector<std::string> SystemLauncher::isolation_lacks() const {
  auto lacks = hirosco::isolation_lacks();
  if (!one_user_.empty()) lacks.push_back(one_user_);
  return lacks;
}

std::string SystemLauncher::isolation_not_asked() const {
  if (users_) return {};
  return "subsystems are all of the user who flies: who may open a UNIX socket opens each of his; <Isolation "
         "users=\"FIRST-LAST\"/> makes each a user of its own";
}

Result<LaunchedSubsystem> SystemLauncher::launch(const descriptor::MissionSubsystem& subsystem) {
  HIROSCO_TRY_LET(const auto found, programs_.find(subsystem));
  const auto& [program, interpreter, image] = found;
  HIROSCO_TRY_LET(auto vital, make_page<VitalPage>(memory_, "hirosco-vital"));
  HIROSCO_TRY_LET(auto permit, make_page<PermitPage>(memory_, "hirosco-permit"));
  count_on(vital_[subsystem.subsystem.name], vital.second);
  // The subsystem reads what gates its actuators; from now on nobody can map it otherwise (hazard SF13).
  HIROSCO_TRY(memory_.seal_writers(permit.first));
  HIROSCO_TRY_LET(auto ends, SocketChannel::make_pair(subsystem.subsystem.resources.channel_kb));
  ProcessStart start;
  start.executable = program.string();
  start.arguments = arguments_of(subsystem);
  start.inherited = {{ends.second.get(), channel_number},
                     {SealedMemory::descriptor(vital.first), vital_number},
                     {SealedMemory::descriptor(permit.first), permit_number}};
  // What it reads is what the mission was judged with, whatever the file says by now (docs/adr/0095).
  MemoryHandle text;
  if (subsystem.subsystem.text) {
    HIROSCO_TRY_LET(text, make_text(memory_, *subsystem.subsystem.text));
    start.inherited.push_back({SealedMemory::descriptor(text), text_number});
  }
  start.limits = limits_of(subsystem.subsystem.resources);
  // Below those of devices, guard and keeper, whatever it asks for.
  start.limits.realtime_priority = descriptor::greatest_cycle_priority;
  start.limits.goes_first = true;  // and not the supervisor
  // Whatever it starts begins there; its cycle goes from there to its own.
  if (!subsystem.cores.services.empty()) start.limits.processors = ProcessorSet::of(subsystem.cores.services);
  if (user_of_processes() == ProcessUser::ItsOwn) {
    const auto own = own_group_of(subsystem);
    if (!own) return fail(ErrorCode::NotFound, "the mission has no user for it");
    if (const auto made = make_own_places(subsystem, *own, instance_, PlaceTime::AtStart); !made)
      return fail(ErrorCode::Mismatch, "a folder of its device is open to others, or of another user");
    start.user = own->group;
  }
  std::optional<PreparedSandbox> sandbox;
  SpareFolders spares;
  if (image != nullptr) start.image = image->descriptor();
  if (image != nullptr && interpreter) start.inherited.push_back({image->descriptor(), script_number});
  if (!sandbox_is_off() && (!interpreter || interpreter->open.empty())) {
    // Of one that runs from memory no file is executed.
    const std::filesystem::path file = image != nullptr ? "" : program;
    Sandbox made = start.user ? sandbox_of(subsystem, file, instance_, ProcessUser::ItsOwn)
                              : make_sandbox(subsystem, file, instance_);
    if (interpreter) supervisor::let_in(*interpreter, made);
    spares = reach_.make_spares(subsystem, made);
    sandbox.emplace(std::move(made));
    start.sandbox = &*sandbox;
  }
  // What it writes is shown with its name, within limits. The terminal of whoever flies is not its own: by it, whoever has it stops him (docs/adr/0164).
  FileDescriptor errors_read;
  const auto errors = errors_.open(subsystem.subsystem.name, &errors_read);
  const FileDescriptor nothing{::open("/dev/null", O_RDWR | O_CLOEXEC)};
  if (!nothing) return fail(ErrorCode::SystemFailure, "open /dev/null for its standard input", errno);
  start.inherited.push_back({nothing.get(), STDIN_FILENO});
  for (const int output : {STDOUT_FILENO, STDERR_FILENO})
    start.inherited.push_back({errors ? errors->get() : nothing.get(), output});
  auto spawned = Process::spawn(start);
  if (!spawned) {
    programs_.look_again(subsystem);
    return fail(spawned.error());
  }
  auto held = hold(*spawned, std::move(ends.first), std::move(vital.second), std::move(permit.second));
  if (!held) {
    // One that nobody could end is not let go at all.
    running_.end_now(std::move(*spawned));
    return fail(held.error());
  }
  LaunchedSubsystem& launched = *held;
  reach_.began(launched.process, running_.find(launched.process)->pid(), subsystem, std::move(spares),
               sandbox.has_value());
  keep(subsystem.subsystem.name, launched, vital.first, permit.first, errors_read);
  if (interpreter && image != nullptr) launched.not_held = "it is a script, whose interpreter is another file";
  if (interpreter && !sandbox_is_off()) launched.not_isolated = interpreter->open;
  return held;
}

Result<LaunchedSubsystem> SystemLauncher::hold(Process& process, FileDescriptor channel, Mapping vital,
                                               Mapping permit) {
  // Nobody is let go whom nobody could end.
  if (const auto reached = process.send_signal(0); !reached && reached.error().code == ErrorCode::NotPermitted)
    return fail(ErrorCode::NotPermitted, "it is a user whom the supervisor may not end");
  HIROSCO_TRY_LET(auto grip, grip_of(process));
  FileDescriptor handle{::fcntl(process.handle().get(), F_DUPFD_CLOEXEC, 0)};
  if (!handle) return fail(ErrorCode::SystemFailure, "look at a process", errno);
  LaunchedSubsystem launched;
  launched.vital = std::move(vital);
  launched.permit = std::move(permit);
  launched.port = std::make_unique<LocalMemberPort>(std::make_unique<OwnedEnd>(std::move(channel)), launched.vital,
                                                    launched.permit);
  launched.grip = grip;
  launched.process = running_.add(std::move(process), std::move(handle), std::move(grip));
  return launched;
}

bool SystemLauncher::keep_with(StoreClient store, const descriptor::Mission& mission, InheritedParts inherited,
                               KeeperPage* page) {
  store_ = store;
  inherited_ = std::move(inherited);
  page_ = page;
  running_.ends_told_by(page);
  for (const auto& subsystem : mission.subsystems) slots_.emplace(subsystem.subsystem.name, slots_.size());
  return true;
}

/// What cannot be kept ends with this process, as everything did that has no keeper.
void SystemLauncher::keep(const std::string& name, LaunchedSubsystem& launched, const MemoryHandle& vital,
                          const MemoryHandle& permit, const FileDescriptor& errors) {
  const auto slot = slots_.find(name);
  const Process* process = running_.find(launched.process);
  if (slot == slots_.end() || process == nullptr) return;
  const int handle = process->handle().get();
  if (page_ != nullptr && slot->second < most_kept) page_->not_taken[slot->second].store(0, std::memory_order_release);
  const auto taken =
      store_.keep(slot->second, {launched.port->channel().wait_descriptor(), SealedMemory::descriptor(vital),
                                 SealedMemory::descriptor(permit), handle, errors ? errors.get() : handle});
  if (taken) kept_[launched.process] = slot->second;
  else if (store_.has_keeper()) launched.not_kept = taken.error().text;
}

std::string_view SystemLauncher::take_not_kept(std::uint32_t process) {
  const auto slot = kept_.find(process);
  if (page_ == nullptr || slot == kept_.end() || slot->second >= most_kept) return {};
  const bool taken = page_->not_taken[slot->second].exchange(0) == 0;
  return taken ? std::string_view{} : "the keeper has no descriptors left to hold it by";
}

std::expected<AdoptedSubsystem, NotAdopted> SystemLauncher::adopt(const descriptor::MissionSubsystem& subsystem) {
  const std::string& name = subsystem.subsystem.name;
  const auto slot = slots_.find(name);
  if (slot == slots_.end()) return std::unexpected{NotAdopted{}};
  const auto found = inherited_.extract(slot->second);
  const auto nothing_runs = [&] {
    store_.forget(slot->second);
    return std::unexpected{NotAdopted{}};
  };
  if (!found) return nothing_runs();
  FileDescriptor& handle = found.mapped()[static_cast<std::size_t>(KeptRole::Process)];
  const auto pid = pid_of(handle.get());
  auto process = Process::adopt(pid.value_or(unknown_pid), std::move(handle));
  if (!process) return nothing_runs();
  // Its handle alone says that it has ended: that needs no descriptor, and what cannot be told counts as a life.
  if (const auto end = process->poll(); end && *end) return nothing_runs();
  auto adopted = pid ? take_over(name, *process, found.mapped())
                     : Result<AdoptedSubsystem>{fail(ErrorCode::Unavailable, "its process id cannot be read")};
  if (adopted) reach_.goes_on(adopted->launched.process, *pid, subsystem);
  if (adopted) return std::move(*adopted);
  return std::unexpected{end_at_once(slot->second, std::move(*process), adopted.error())};
}

/// It obeys a permit page that nobody can write any more.
NotAdopted SystemLauncher::end_at_once(std::size_t slot, Process process, const Error& why) {
  const std::uint32_t number = running_.end_now(std::move(process));
  if (number == 0) store_.forget(slot);
  else kept_[number] = slot;  // another supervisor tries again
  return {.why = in_words(why), .process = number};
}

Result<AdoptedSubsystem> SystemLauncher::take_over(const std::string& name, Process& process,
                                                   std::array<FileDescriptor, kept_roles>& kept) {
  const auto of = [&](KeptRole role) -> FileDescriptor& { return kept[static_cast<std::size_t>(role)]; };
  const MemoryHandle vital = SealedMemory::adopt(std::move(of(KeptRole::Vital)));
  const MemoryHandle old_permit = SealedMemory::adopt(std::move(of(KeptRole::Permit)));
  HIROSCO_TRY(memory_.verify(vital, sizeof(VitalPage), false));
  HIROSCO_TRY_LET(Mapping vital_page, memory_.map(vital, Access::ReadWrite));
  HIROSCO_TRY(memory_.verify(old_permit, sizeof(PermitPage), true));
  HIROSCO_TRY_LET(const Mapping before, memory_.map(old_permit, Access::ReadOnly));
  HIROSCO_TRY_LET(auto permit, make_page<PermitPage>(memory_, "hirosco-permit"));
  HIROSCO_TRY(memory_.seal_writers(permit.first));
  AdoptedSubsystem adopted = found_on(*reinterpret_cast<const PermitPage*>(before.octets.data()),
                                      *reinterpret_cast<PermitPage*>(permit.second.octets.data()));
  vital_[name] = vital_page;
  HIROSCO_TRY_LET(adopted.launched,
                  hold(process, std::move(of(KeptRole::Channel)), std::move(vital_page), std::move(permit.second)));
  FileDescriptor& errors = of(KeptRole::Errors);
  keep(name, adopted.launched, vital, permit.first, errors);
  errors_.go_on(name, std::move(errors));
  adopted.permit = std::move(permit.first);
  return adopted;
}

std::optional<ProcessEnd> SystemLauncher::ended(std::uint32_t process) {
  if (running_.find(process) == nullptr) return ProcessEnd{};
  const auto end = running_.ended(process);
  if (end) reach_.ended(process);
  if (const auto slot = kept_.find(process); end && slot != kept_.end()) {
    store_.forget(slot->second);
    kept_.erase(slot);
  }
  return end;
}

int SystemLauncher::wait_descriptor(std::uint32_t process) {
  const Process* found = running_.find(process);
  return found != nullptr ? found->handle().get() : -1;
}

}  // namespace hirosco::supervisor
