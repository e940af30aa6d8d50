// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/device_shell.hpp"

#include <poll.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "hirosco/data_transfer/device/flow_means.hpp"
#include "hirosco/data_transfer/device/system_flow_factory.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/last_words.hpp"
#include "hirosco/utilities/os/thread.hpp"
#include "simulation/devices/control_socket.hpp"

namespace hirosco::simulation {
namespace {

constexpr int priority = 85;         // above every cycle: a device does not wait for those whom it serves
constexpr Duration control_period = std::chrono::milliseconds{10};
constexpr std::int64_t longest_stop_ms = 60'000;
constexpr std::string_view beside = "--beside";

std::map<std::string, Transfer> transfers() {
  std::map<std::string, Transfer> found;
  for (const FlowMeans& means : standard_flow_means()) found.emplace(to_text(means.transfer), means.transfer);
  return found;
}

const std::map<std::string, std::endian> byte_orders{{"little", std::endian::little}, {"big", std::endian::big}};
const std::map<std::string, SimulatedDevice::Stop> stops{{"drop", SimulatedDevice::Stop::Drop},
                                                         {"controlled", SimulatedDevice::Stop::Controlled},
                                                         {"hold", SimulatedDevice::Stop::Hold}};

struct Options {
  Transfer transfer{Transfer::SharedMemory};
  std::string address;
  std::string control;
  std::uint64_t seed{1};
  std::int64_t cycle_us{500};
  std::endian byte_order{std::endian::little};
  bool actuator{false};
  SimulatedDevice::Stop stop{SimulatedDevice::Stop::Drop};
  std::int64_t stop_within_ms{0};
  Transfer enable_transfer{Transfer::SharedMemory};
  std::string enable_address;
  std::vector<std::string> enable_fall_backs;
  std::vector<std::string> fall_backs;
  std::string endnode;
  std::vector<std::string> further;
  std::vector<std::string> drives;
  std::string power;
  std::vector<std::string> power_fall_backs;
  std::vector<std::string> files;
  std::vector<std::string> settings;
  std::optional<unsigned> core;
};

/// TRANSFER=ADDRESS. No address holds a comma or an equals sign (`read_configuration.cpp`).
std::optional<FlowAddress> address_in(std::string_view text) {
  const auto equals = text.find('=');
  if (equals == text.npos) return std::nullopt;
  const auto transfer = from_text<Transfer>(text.substr(0, equals));
  if (!transfer) return std::nullopt;
  return FlowAddress{*transfer, std::string{text.substr(equals + 1)}};
}

std::vector<std::string_view> parts_of(std::string_view text) {
  std::vector<std::string_view> parts;
  while (true) {
    const auto comma = text.find(',');
    parts.push_back(text.substr(0, comma));
    if (comma == text.npos) return parts;
    text.remove_prefix(comma + 1);
  }
}

/// False: one of them is none.
bool add_addresses(const auto& texts, std::vector<FlowAddress>& addresses) {
  for (const auto& text : texts) {
    auto address = address_in(text);
    if (!address) return false;
    addresses.push_back(std::move(*address));
  }
  return true;
}

/// NAME,BYTE_ORDER,TRANSFER=ADDRESS,...
std::optional<FurtherEndnode> endnode_in(std::string_view text) {
  const auto parts = parts_of(text);
  const auto order = parts.size() < 3 ? byte_orders.end() : byte_orders.find(std::string{parts[1]});
  if (order == byte_orders.end()) return std::nullopt;
  FurtherEndnode found{std::string{parts[0]}, {}, order->second};
  if (!add_addresses(std::span{parts}.subspan(2), found.addresses)) return std::nullopt;
  return found;
}

/// NAME,STOP,MILLISECONDS[,TRANSFER=ADDRESS[,TRANSFER=ADDRESS]...]. False: it is none, or of no endnode.
bool add_drive(std::string_view text, std::vector<FurtherEndnode>& endnodes) {
  const auto parts = parts_of(text);
  if (parts.size() < 3) return false;
  const auto endnode = std::ranges::find(endnodes, parts[0], &FurtherEndnode::name);
  const auto stop = stops.find(std::string{parts[1]});
  std::int64_t within_ms = 0;
  const char* const end = parts[2].data() + parts[2].size();
  const auto read = std::from_chars(parts[2].data(), end, within_ms);
  const bool is_time = read.ec == std::errc{} && read.ptr == end && within_ms >= 0 && within_ms <= longest_stop_ms;
  if (endnode == endnodes.end() || stop == stops.end() || !is_time) return false;
  FurtherActuator& made = endnode->actuator.emplace();
  made.stop = stop->second;
  made.stop_within = std::chrono::milliseconds{within_ms};
  if (parts.size() == 3) return true;
  made.enable = address_in(parts[3]);
  return made.enable && add_addresses(std::span{parts}.subspan(4), made.enable_fall_backs);
}

/// False: one of them is none.
bool add_endnodes(const Options& options, SimulatedDevice::Settings& settings) {
  if (!add_addresses(options.fall_backs, settings.fall_backs) ||
      !add_addresses(options.enable_fall_backs, settings.enable_fall_backs) ||
      !add_addresses(options.power_fall_backs, settings.power_fall_backs))
    return false;
  settings.endnode = options.endnode;
  for (const std::string& text : options.further) {
    auto endnode = endnode_in(text);
    if (!endnode) return false;
    settings.further.push_back(std::move(*endnode));
  }
  for (const std::string& text : options.drives)
    if (!add_drive(text, settings.further)) return false;
  if (!options.power.empty()) settings.power = address_in(options.power);
  return options.power.empty() || settings.power.has_value();
}

/// An exit code when the program is to end here.
std::optional<int> read_options(int argc, char** argv, const char* name, Options& options) {
  CLI::App app{"A simulated device of HIROSCO", name};
  app.add_option("--transfer", options.transfer, "Means of transfer")->transform(CLI::CheckedTransformer{transfers()});
  app.add_option("--address", options.address, "Address of the data flow")->required();
  app.add_option("--control", options.control, "Path of the control socket");
  app.add_option("--seed", options.seed, "Seed of all that is random");
  app.add_option("--cycle-us", options.cycle_us, "Device cycle")->check(CLI::Range(100, 100'000));
  app.add_option("--byte-order", options.byte_order, "Of the payload")->transform(CLI::CheckedTransformer{byte_orders});
  app.add_flag("--actuator", options.actuator,
               "It is one: if it is told to be active as it begins, it waits for a higher epoch");
  app.add_option("--stop", options.stop, "What it does by itself when its command is taken away")
      ->transform(CLI::CheckedTransformer{stops});
  app.add_option("--stop-within-ms", options.stop_within_ms, "Time of a controlled stop")
      ->check(CLI::Range(std::int64_t{0}, longest_stop_ms));
  app.add_option("--enable-transfer", options.enable_transfer, "Means of transfer of the second inhibit")
      ->transform(CLI::CheckedTransformer{transfers()});
  app.add_option("--enable-address", options.enable_address, "Its address; without one there is none");
  app.add_option("--enable-fall-back", options.enable_fall_backs, "TRANSFER=ADDRESS of another way to it");
  app.add_option("--fall-back", options.fall_backs, "TRANSFER=ADDRESS of another way to the same frames");
  app.add_option("--endnode", options.endnode, "Name of its endnode, where it has several");
  app.add_option("--further", options.further, "Another endnode: NAME,BYTE_ORDER,TRANSFER=ADDRESS and its fall-backs");
  app.add_option("--drive", options.drives,
                 "The actuator of one of these: NAME,STOP,MILLISECONDS, TRANSFER=ADDRESS of its second inhibit and its "
                 "fall-backs");
  app.add_option("--power", options.power, "TRANSFER=ADDRESS of its power switch; without one it has power");
  app.add_option("--power-fall-back", options.power_fall_backs, "TRANSFER=ADDRESS of another way to that");
  app.add_option("--file", options.files, "NAME=PATH of a file that a setting of the device names");
  app.add_option("--core", options.core, "Processor on which it goes; without one the last that it may use");
  app.add_option("--set", options.settings, "NAME=VALUE, carried out at the start");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& problem) {
    if (problem.get_exit_code() == 0) return app.exit(problem);  // it was asked for help
    // Among the lines of a flight: who it is has to stand there.
    std::cerr << name << ": " << problem.what() << "; --help tells what there is\n";
    return problem.get_exit_code();
  }
  return std::nullopt;
}

std::string text_of(const Error& error) {
  return fmt::format("{}: {} ({})", to_text(error.code), error.text, error.value);
}

/// Beside the control socket: what was injected, and when. What a flight does within two seconds after it has a cause.
void record_injection(const std::string& control, std::string_view line) {
  const std::int64_t now_ns = SystemClock{}.now().time_since_epoch().count();
  if (!control.empty()) std::ofstream{control + ".injected", std::ios::app} << fmt::format("{} {}\n", now_ns, line);
}

std::string answer(SimulatedDevice& device, std::string_view line, const std::string& control) {
  if (Words{line}[0] == "truth") return "ok " + device.truth();
  const auto done = device.fault(line);
  if (done) record_injection(control, line);
  return done ? "ok" : "error " + text_of(done.error());
}

/// Signals that end the program stay pending and are looked at: no handler, no global.
void hold_back_ending_signals() noexcept {
  sigset_t ending;
  sigemptyset(&ending);
  sigaddset(&ending, SIGTERM);
  sigaddset(&ending, SIGINT);
  (void)::sigprocmask(SIG_BLOCK, &ending, nullptr);
}

bool signalled_to_end() noexcept {
  sigset_t pending;
  if (::sigpending(&pending) != 0) return false;
  return sigismember(&pending, SIGTERM) == 1 || sigismember(&pending, SIGINT) == 1;
}

/// True when standard input is a pipe or socket of a starter: its end is the starter's.
bool input_tells_of_starter() noexcept {
  struct stat about{};
  return ::fstat(STDIN_FILENO, &about) == 0 && (S_ISFIFO(about.st_mode) || S_ISSOCK(about.st_mode));
}

bool input_closed() noexcept {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  if (::poll(&input, 1, 0) <= 0) return false;
  if ((input.revents & POLLIN) == 0) return true;  // hang-up alone
  std::array<char, 256> ignored;
  return ::read(STDIN_FILENO, ignored.data(), ignored.size()) == 0;
}

/// A device with its way in.
struct Played {
  Options options;
  std::unique_ptr<SimulatedDevice> device{};
  std::unique_ptr<ControlSocket> control{};
};

/// One world with all that are in it: each waits for its own frames in a thread of its own, and is stepped while no other one is.
struct World {
  std::vector<Played> all{};
  std::mutex stepping{};
  std::atomic<bool> ended{false};
};

/// Wishes, but for a core that is named: without the rights the device runs as well as it can, and its subsystem's limits are announced wider.
void take_priority(const Options& options) noexcept {
  if (options.core) (void)pin_to_cpu(*options.core);
  else if (realtime_permitted()) (void)pin_to_cycle_cpu();
  if (!realtime_permitted()) (void)ask_for_short_slices();
  (void)set_fifo_priority(priority);
}

void run(Played& played, World& world) {
  take_priority(played.options);
  const SystemClock clock;
  const bool watch_input = input_tells_of_starter();
  TimePoint look_at = clock.now();
  SimulatedDevice& device = *played.device;
  while (!world.ended) {
    const TimePoint wake = std::min(look_at, device.next_wake());
    if (const Duration rest = wake - clock.now(); rest > Duration::zero() && !device.wait(rest)) sleep_until(wake);
    const std::scoped_lock alone{world.stepping};
    device.step(clock.now());
    if (clock.now() < look_at) continue;
    look_at = clock.now() + control_period;
    if (signalled_to_end() || (watch_input && input_closed())) world.ended = true;
    else played.control->serve([&](std::string_view line) { return answer(device, line, played.options.control); });
  }
}

/// The first one, whose world it is, in this thread. Returns when all have ended.
Result<> run(World& world) {
  constexpr std::size_t stack_octets = std::size_t{1} << 20;
  std::vector<Thread> others;
  for (Played& each : std::span{world.all}.subspan(1)) {
    auto started = Thread::start("in-world", [&each, &world] { run(each, world); }, stack_octets);
    if (!started) {
      world.ended = true;
      return fail(started.error());
    }
    others.push_back(std::move(*started));
  }
  run(world.all.front(), world);
  return ok();
}

Result<> prepare(Played& played) {
  HIROSCO_TRY(played.device->plug());
  if (!played.options.control.empty()) HIROSCO_TRY(played.control->listen(played.options.control));
  for (std::string line : played.options.settings) {
    std::ranges::replace(line, '=', ' ');
    HIROSCO_TRY(played.device->fault(line));
  }
  return ok();
}

/// Empty: an endnode of its is none.
std::optional<SimulatedDevice::Settings> settings_of(const Options& options) {
  SimulatedDevice::Settings settings{.cycle = std::chrono::microseconds{options.cycle_us},
                                     .byte_order = options.byte_order,
                                     .seed = options.seed,
                                     .actuator = options.actuator,
                                     .stop = options.stop,
                                     .stop_within = std::chrono::milliseconds{options.stop_within_ms}};
  if (!options.enable_address.empty()) settings.enable = {options.enable_transfer, options.enable_address};
  if (!realtime_permitted()) settings.enable_limit = enable_limit_reduced;
  for (const std::string& text : options.files)
    settings.files[text.substr(0, text.find('='))] = text.substr(std::min(text.size(), text.find('=') + 1));
  if (!add_endnodes(options, settings)) return std::nullopt;
  return settings;
}

}  // namespace

int run_device(int argc, char** argv, const char* name, const MakeDevice& make) {
  say_last_words(name);
  SystemFlowFactory flows;
  World world;
  std::vector<Played>& all = world.all;
  for (int begin = 1; begin <= argc;) {
    int end = begin;
    while (end < argc && std::string_view{argv[end]} != beside) ++end;
    std::vector<char*> words{argv[0]};
    words.insert(words.end(), argv + begin, argv + end);
    all.emplace_back();
    if (const auto code = read_options(static_cast<int>(words.size()), words.data(), name, all.back().options))
      return *code;
    if (const auto core = all.back().options.core; core && !grants_processor(*core)) {
      std::cerr << name << ": core " << *core
                << ", which the mission gives it, is none of this computer that it may use\n";
      return 1;
    }
    begin = end + 1;
  }
  hold_back_ending_signals();
  for (Played& each : all) {
    auto settings = settings_of(each.options);
    if (!settings) {
      std::cerr << name << ": an endnode is TRANSFER=ADDRESS\n";
      return 1;
    }
    if (&each != &all.front()) settings->in_world_of = all.front().device.get();
    each.device = make(flows, {each.options.transfer, each.options.address}, *settings);
    each.control = std::make_unique<ControlSocket>();
    if (const auto ready = prepare(each); !ready) {
      std::cerr << name << ": " << text_of(ready.error()) << '\n';
      return 1;
    }
    for (const std::string& remark : each.device->remarks()) std::cerr << name << ": " << remark << '\n';
  }
  (void)lock_memory();
  if (const auto ran = run(world); !ran) {
    std::cerr << name << ": " << text_of(ran.error()) << '\n';
    return 1;
  }
  return 0;
}

}  // namespace hirosco::simulation
