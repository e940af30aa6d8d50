// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <string>
#include <string_view>

#include "hirosco/utilities/os/last_words.hpp"
#include "hirosco/utilities/program_options.hpp"
#include "tools/terminal/columns.hpp"
#include "tools/terminal/flight_screen.hpp"
#include "tools/terminal/lines.hpp"
#include "tools/terminal/screen.hpp"
#include "tools/terminal/terminal.hpp"

/// `hirosco-screen`: the screen of `hirosco run`, which starts it. Two processes: one draws; the other holds how the terminal was, and
/// puts it back however the first one ends.
namespace {

using namespace hirosco;
using namespace hirosco::terminal;
using Steady = std::chrono::steady_clock;

constexpr int exit_usage = 2;
constexpr int exit_environment = 3;
constexpr auto between_pictures = std::chrono::milliseconds{80};
constexpr auto look_at_silence = std::chrono::milliseconds{500};
/// What a flight says in a tenth of a second is far less; who floods is read on in the next turn.
constexpr std::size_t most_octets_in_a_turn = std::size_t{1} << 20;
constexpr std::size_t longest_line = std::size_t{1} << 18;
constexpr Duration patience = 1s;

struct Options {
  int keeper{0};
  std::string log;
};

constexpr std::array known_options{ProgramOption{"--keeper", "PID"}, ProgramOption{"--log", "FILE"}};

[[nodiscard]] sigset_t set_of(std::initializer_list<int> numbers) {
  sigset_t set;
  sigemptyset(&set);
  for (const int number : numbers) sigaddset(&set, number);
  return set;
}

[[nodiscard]] std::string in_ascii(std::string_view lines) {
  std::string shown;
  Lines{longest_line}.take(lines, [&](std::string_view line) { shown += ascii(line) + "\n"; });
  return shown;
}

/// One end of the flight's two pipes.
class Source {
 public:
  explicit Source(int descriptor) : descriptor_{descriptor} {}
  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }
  [[nodiscard]] bool over() const noexcept { return descriptor_ < 0; }
  void read_into(ScreenModel& model) {
    std::array<char, 65'536> octets;
    for (std::size_t all = 0; all < most_octets_in_a_turn;) {
      pollfd ready{descriptor_, POLLIN, 0};
      if (::poll(&ready, 1, 0) <= 0) return;
      const auto got = ::read(descriptor_, octets.data(), octets.size());
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) {
        descriptor_ = -1;
        return;
      }
      lines_.take({octets.data(), static_cast<std::size_t>(got)}, [&](std::string_view line) { model.take(line); });
      all += static_cast<std::size_t>(got);
    }
  }

 private:
  int descriptor_;
  Lines lines_{longest_line};
};

class Drawer {
 public:
  Drawer(const Options& options, const TerminalState& state, Terminal terminal)
      : options_{options}, state_{state}, terminal_{std::move(terminal)} {
    const char* none = std::getenv("NO_COLOR");
    palette_ = {.colour = none == nullptr || *none == '\0',
                .unicode = takes_unicode(std::getenv("LC_ALL"), std::getenv("LC_CTYPE"), std::getenv("LANG"))};
  }

  /// Until the flight is over or somebody wants this to end.
  void run(int signals) {
    while (!over_ && !(told_.over() && others_.over())) {
      wait(signals);
      draw_now();
    }
    std::string words;
    for (const std::string& line : farewell(model_, options_.log)) words += line + "\n";
    for (const std::string& line : model_.errors()) words += line + "\n";
    state_.restore(patience, palette_.unicode ? words : in_ascii(words));
  }

 private:
  void wait(int signals) {
    std::array<pollfd, 4> ready{{{told_.descriptor(), POLLIN, 0},
                                 {others_.descriptor(), POLLIN, 0},
                                 {signals, POLLIN, 0},
                                 {gone_ ? -1 : terminal_.descriptor(),
                                  static_cast<short>(terminal_.pending() ? POLLIN | POLLOUT : POLLIN), 0}}};
    const auto due = std::chrono::duration_cast<std::chrono::milliseconds>(next_ - Steady::now());
    const auto limit = changed_ && !terminal_.pending()
                           ? std::max(due, std::chrono::milliseconds{0}) + std::chrono::milliseconds{1}
                           : look_at_silence;
    if (::poll(ready.data(), ready.size(), static_cast<int>(limit.count())) < 0) return;
    if (ready[2].revents != 0) take_signal(signals);
    if ((ready[3].revents & POLLIN) != 0) take_keys();
    if ((ready[3].revents & (POLLHUP | POLLERR)) != 0) gone_ = true;
    const auto before = model_.overviews();
    for (const auto& [source, entry] : {std::pair{&told_, &ready[0]}, std::pair{&others_, &ready[1]}})
      if (entry->revents != 0) {
        source->read_into(model_);
        changed_ = true;
      }
    if (model_.overviews() != before) heard_at_ = Steady::now();
  }

  void take_signal(int signals) {
    signalfd_siginfo info{};
    if (::read(signals, &info, sizeof info) != sizeof info) return;
    switch (static_cast<int>(info.ssi_signo)) {
      case SIGTERM: over_ = true; break;
      case SIGHUP: gone_ = true; break;
      case SIGCONT: terminal_.begin(); [[fallthrough]];
      case SIGWINCH:
        last_ = {};
        anew_ = true;
        changed_ = true;
        break;
      default: break;
    }
  }

  void take_keys() {
    const std::string octets = terminal_.keys();
    for (std::string_view rest = octets; !rest.empty();) {
      switch (model_.press(take_key(rest), page_)) {
        case Wish::None: break;
        case Wish::EndFlight: ::kill(options_.keeper, SIGTERM); break;
        case Wish::StopActuators: ::kill(options_.keeper, SIGUSR1); break;
        case Wish::DrawAnew:
          last_ = {};
          anew_ = true;
          break;
      }
      changed_ = true;
    }
  }

  void draw_now() {
    if (gone_) return;
    if (!terminal_.go_on()) {
      gone_ = true;
      return;
    }
    // Of a terminal that takes nothing only the newest picture is drawn, once it does.
    const auto now = Steady::now();
    const double silent_s = model_.heard() ? std::chrono::duration<double>(now - heard_at_).count() : 0.0;
    const bool due = changed_ || silent_s > 1.0;
    if (terminal_.pending() || now < next_ || !due) return;
    const Size size = terminal_.size();
    if (size != size_ || anew_) {
      last_ = {};
      terminal_.send("\x1b[0m\x1b[2J");
    }
    size_ = size;
    anew_ = false;
    Picture next = draw(model_, size, silent_s);
    page_ = next.event_rows;
    terminal_.send(paint(next, last_, size, palette_));
    last_ = std::move(next);
    next_ = now + between_pictures;
    changed_ = false;
    if (!terminal_.go_on()) gone_ = true;
  }

  const Options& options_;
  const TerminalState& state_;
  Terminal terminal_;
  Palette palette_;
  ScreenModel model_;
  Source told_{screen_told_descriptor}, others_{screen_others_descriptor};
  Picture last_;
  Size size_{};
  std::size_t page_{1};
  Steady::time_point next_{}, heard_at_{};
  bool changed_{true}, anew_{false}, gone_{false}, over_{false};
};

[[nodiscard]] int draw_until_over(const Options& options, const TerminalState& state) {
  // Ordinary work goes first.
  static_cast<void>(::setpriority(PRIO_PROCESS, 0, 10));
  auto terminal = Terminal::take(state);
  if (!terminal) return exit_environment;
  const sigset_t heard = set_of({SIGTERM, SIGHUP, SIGWINCH, SIGCONT});
  const FileDescriptor signals{::signalfd(-1, &heard, SFD_CLOEXEC | SFD_NONBLOCK)};
  if (!signals) return exit_environment;
  Drawer{options, state, std::move(*terminal)}.run(signals.get());
  return 0;
}

/// The end of the one that draws, in order or not: what it did not put back is put back here.
[[nodiscard]] int hold(pid_t drawer, const TerminalState& state) {
  const sigset_t heard = set_of({SIGTERM, SIGHUP, SIGCHLD});
  for (;;) {
    int status = 0;
    if (::waitpid(drawer, &status, WNOHANG) == drawer) {
      if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) state.restore(patience);
      return 0;
    }
    const int number = ::sigwaitinfo(&heard, nullptr);
    if (number == SIGTERM || number == SIGHUP) ::kill(drawer, number);
  }
}

}  // namespace

int main(int argc, char** argv) {
  say_last_words("hirosco-screen");
  const auto given = given_options(argc, argv, known_options);
  if (!given) {
    fmt::print(stderr, "hirosco-screen: {} (started by 'hirosco run MISSION' on a terminal)\n", given.error());
    return exit_usage;
  }
  Options options;
  for (const auto& [name, value] : *given) {
    if (name == "--keeper") std::from_chars(value.data(), value.data() + value.size(), options.keeper);
    else if (name == "--log") options.log = value;
  }
  if (options.keeper <= 1 || ::getppid() != options.keeper) {
    fmt::print(stderr, "hirosco-screen: started by 'hirosco run MISSION' on a terminal\n");
    return exit_usage;
  }
  for (const int ignored : {SIGINT, SIGQUIT, SIGTSTP, SIGTTIN, SIGTTOU, SIGPIPE, SIGUSR1}) ::signal(ignored, SIG_IGN);
  const sigset_t taken = set_of({SIGTERM, SIGHUP, SIGWINCH, SIGCONT, SIGCHLD});
  ::sigprocmask(SIG_BLOCK, &taken, nullptr);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  const auto state = TerminalState::of(STDOUT_FILENO);
  if (!state || ::getppid() != options.keeper) return exit_environment;
  const pid_t holder = ::getpid();
  const pid_t drawer = ::fork();
  if (drawer < 0) return exit_environment;
  if (drawer > 0) return hold(drawer, *state);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != holder) ::_exit(exit_environment);
  return draw_until_over(options, *state);
}
