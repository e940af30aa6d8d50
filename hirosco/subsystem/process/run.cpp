// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/process/run.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <expected>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hirosco/data_transfer/channel/socket_channel.hpp"
#include "hirosco/data_transfer/device/system_flow_factory.hpp"
#include "hirosco/data_transfer/memory/sealed_memory.hpp"
#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/subsystem/process/loops.hpp"
#include "hirosco/subsystem/service_loop/generic_subsystem.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/last_words.hpp"
#include "hirosco/utilities/os/life.hpp"
#include "hirosco/utilities/os/process_usage.hpp"
#include "hirosco/utilities/os/sandbox.hpp"
#include "hirosco/utilities/os/thread.hpp"
#include "hirosco/utilities/program_options.hpp"
#include "hirosco/xml/reader.hpp"

namespace hirosco {
namespace {

constexpr int exit_usage = 2;
constexpr int exit_environment = 3;

struct Options {
  std::string descriptor;
  std::vector<std::pair<std::string, std::string>> changes;  ///< as the mission has them
  int channel{-1};
  int vital{-1};
  int permit{-1};
  int text{-1};  ///< of the descriptor; -1: its file is read
  std::optional<unsigned> core{};  ///< of its cycle, where its mission names one
  [[nodiscard]] bool complete() const { return !descriptor.empty() && channel >= 0 && vital >= 0 && permit >= 0; }
};

/// Those behind the first six change what the descriptor says (descriptor::changes_of()).
constexpr std::array known_options{ProgramOption{"--descriptor", "FILE"},
                                   ProgramOption{"--channel", "FD"},
                                   ProgramOption{"--vital", "FD"},
                                   ProgramOption{"--permit", "FD"},
                                   ProgramOption{"--text", "FD"},
                                   ProgramOption{"--core", "NUMBER"},
                                   ProgramOption{"--as", "NAME:ID"},
                                   ProgramOption{"--set", "PARAMETER=VALUES"},
                                   ProgramOption{"--address", "DEVICE=ADDRESS"},
                                   ProgramOption{"--enable", "DEVICE=ADDRESS"},
                                   ProgramOption{"--power", "DEVICE=ADDRESS"},
                                   ProgramOption{"--fall-back", "DEVICE=ADDRESS=ADDRESS"},
                                   ProgramOption{"--setting", "DEVICE:NAME=VALUE"},
                                   ProgramOption{"--commands", "NAME=ID:FILE"},
                                   ProgramOption{"--subscribes", "NAME=ID:FILE"}};

[[nodiscard]] int number_of(std::string_view text) {
  int number = -1;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

[[nodiscard]] std::expected<Options, std::string> read_options(int argc, char** argv) {
  auto given = given_options(argc, argv, known_options);
  if (!given) return std::unexpected{std::move(given.error())};
  Options options;
  for (const auto& [name, value] : *given) {
    if (name == "--descriptor") options.descriptor = value;
    else if (name == "--channel") options.channel = number_of(value);
    else if (name == "--vital") options.vital = number_of(value);
    else if (name == "--permit") options.permit = number_of(value);
    else if (name == "--text") options.text = number_of(value);
    else if (name == "--core") options.core = static_cast<unsigned>(number_of(value));
    else options.changes.emplace_back(name, value);
  }
  return options;
}

/// Empty: none was handed over, or it cannot be read.
[[nodiscard]] std::optional<std::string> handed_text(int descriptor) {
  if (descriptor < 0) return std::nullopt;
  const FileDescriptor owned{descriptor};
  const auto size = ::lseek(descriptor, 0, SEEK_END);
  if (size <= 0 || size > static_cast<off_t>(xml::max_document_octets)) return std::nullopt;
  std::string text(static_cast<std::size_t>(size), '\0');
  return ::pread(descriptor, text.data(), text.size(), 0) == size ? std::optional{std::move(text)} : std::nullopt;
}

[[nodiscard]] Mapping map_page(SealedMemory& memory, int descriptor, Access access) {
  auto mapping = memory.map(SealedMemory::adopt(descriptor), access);
  return mapping ? std::move(*mapping) : Mapping{};
}

/// Why the pages that the supervisor handed over are not used; empty when they are.
[[nodiscard]] std::string refuse_pages(const Mapping& vital, const Mapping& permit) {
  if (vital.octets.size() < sizeof(VitalPage) || permit.octets.size() < sizeof(PermitPage))
    return "the vital or permit page cannot be mapped";
  const auto& page = *reinterpret_cast<const PermitPage*>(permit.octets.data());
  if (page.magic != page_magic) return "what should be the permit page is none";
  if (page.version != page_version)
    return fmt::format(
        "the supervisor's pages are of version {}, this program's of version {}: build both from one hirosco",
        page.version, page_version);
  return {};
}

}  // namespace

int run_subsystem(int argc, char** argv, const std::function<std::unique_ptr<Subsystem>()>& make) {
  say_last_words(argv[0]);
  name_refused_calls(argv[0]);
  // A terminal or pipe that is gone takes no words any more; that must not end a subsystem.
  static_cast<void>(std::signal(SIGPIPE, SIG_IGN));
  const auto said = read_options(argc, argv);
  if (!said) {
    fmt::print(stderr, "{}: {} (the supervisor passes them: hirosco run MISSION)\n", argv[0], said.error());
    return exit_usage;
  }
  const Options& options = *said;
  if (!options.complete()) {
    fmt::print(
        stderr,
        "{}: a subsystem is started by the supervisor (hirosco run MISSION), which passes\n"
        "  --descriptor FILE --channel FD --vital FD --permit FD [--as NAME:ID] [--set PARAMETER=VALUES]\n"
        "  [--text FD] [--core NUMBER] [--address DEVICE=ADDRESS] [--enable DEVICE=ADDRESS] [--power DEVICE=ADDRESS]\n"
        "  [--fall-back DEVICE=ADDRESS=ADDRESS] [--setting DEVICE:NAME=VALUE] [--commands NAME=ID:FILE]\n"
        "  [--subscribes NAME=ID:FILE]\n",
        argv[0]);
    return exit_usage;
  }
  if (options.core && !grants_processor(*options.core)) {
    fmt::print(stderr, "{}: core {}, which the mission gives its cycle, is none of this computer that it may use\n",
               argv[0], *options.core);
    return exit_environment;
  }
  const auto source = descriptor::file_system();
  // What flies is what the supervisor has judged, whatever the file says by now.
  const auto handed = handed_text(options.text);
  const descriptor::FileSource in_force = [&](const std::filesystem::path& file) -> Result<std::string> {
    return handed ? Result<std::string>{*handed} : source(file);
  };
  auto reading = descriptor::read_subsystem(options.descriptor, in_force);
  for (const auto& problem : reading.problems) fmt::print(stderr, "{}", descriptor::render(problem, in_force, false));
  if (!reading.value) return exit_environment;
  for (const auto& [word, text] : options.changes)
    if (const auto applied = descriptor::needs_other(word) ? descriptor::apply_other(*reading.value, word, text, source)
                                                           : descriptor::apply_change(*reading.value, word, text);
        !applied) {
      fmt::print(stderr, "{}: {} {}: {}\n", argv[0], word, text, applied.error().text);
      return exit_environment;
    }

  SystemClock clock;
  SealedMemory memory;
  SystemFlowFactory flows;
  SocketChannel channel{FileDescriptor{options.channel}};
  const Mapping vital = map_page(memory, options.vital, Access::ReadWrite);
  const Mapping permit = map_page(memory, options.permit, Access::ReadOnly);
  if (const std::string why = refuse_pages(vital, permit); !why.empty()) {
    fmt::print(stderr, "{}: {}\n", argv[0], why);
    return exit_environment;
  }
  // Where the system has no such word, the supervisor hears of our end by our process alone.
  static_cast<void>(hold_life(reinterpret_cast<VitalPage*>(vital.octets.data())->life));
  const bool realtime = realtime_permitted();
  if (realtime) {
    static_cast<void>(lock_memory());
    static_cast<void>(set_shared_priority(service_loop_priority));
  }
  auto meter = ProcessMeter::own();
  CycleCore core{.named = options.core};
  const descriptor::SubsystemDescriptor begun = *reading.value;
  const Platform platform{
      .clock = clock,
      .memory = memory,
      .flows = flows,
      .realtime = realtime,
      .precise = may_spin(realtime, options.core),
      .wakes = true,
      .explain = [](std::string_view text) { std::fputs(fmt::format("{}\n", text).c_str(), stderr); },
      .usage = [&meter, &core]() -> std::optional<ProcessUsage> {
        auto usage = meter ? meter->look() : std::nullopt;
        if (usage) usage->cycle_core = core.is.load(std::memory_order_relaxed);
        return usage;
      },
      .read_again = [&begun,
                     &options](std::string_view text) { return descriptor::read_again(begun, text, options.changes); }};
  const auto author = make();
  GenericSubsystem subsystem{*author,
                             std::move(*reading.value),
                             platform,
                             channel,
                             *reinterpret_cast<VitalPage*>(vital.octets.data()),
                             *reinterpret_cast<const PermitPage*>(permit.octets.data())};
  auto bell = Bell::make();
  if (!bell) {
    fmt::print(stderr, "{}: {} (errno {})\n", argv[0], bell.error().text, bell.error().value);
    return exit_environment;
  }
  CycleThread cycle{subsystem, clock, *bell, realtime, nullptr, &core};
  if (const auto started = cycle.start("cycle"); !started) {
    fmt::print(stderr, "{}: {} (errno {})\n", argv[0], started.error().text, started.error().value);
    return exit_environment;
  }
  bool told_version = false;
  const auto tell_version = [&] {
    if (const auto theirs = channel.foreign_version(); theirs && !std::exchange(told_version, true))
      fmt::print(stderr,
                 "{}: the supervisor's control channel is of version {}, this program's of version {}: build both from "
                 "one hirosco\n",
                 argv[0], *theirs, envelope::version);
  };
  std::vector<std::unique_ptr<OwnLoopThread>> loops;
  for (std::size_t i = 0; i < subsystem.own_loops(); ++i) {
    loops.push_back(std::make_unique<OwnLoopThread>(subsystem, i, clock, *bell, realtime, nullptr, options.core));
    if (const auto started = loops.back()->start(); !started) {
      fmt::print(stderr, "{}: {} (errno {})\n", argv[0], started.error().text, started.error().value);
      return exit_environment;
    }
  }
  serve({.subsystem = subsystem,
         .clock = clock,
         .channel = channel,
         .cycle = cycle,
         .bell = *bell,
         .after_step = tell_version});
  cycle.end();
  for (const auto& loop : loops) loop->end();
  cycle.tell_heap_uses(argv[0]);
  return 0;
}

}  // namespace hirosco
