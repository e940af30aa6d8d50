// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/serial_flow.hpp"

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "hirosco/data_transfer/device/framed_stream.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/os/thread.hpp"

namespace hirosco {
namespace {

constexpr std::string_view devices = "/dev/", pseudo_terminals = "/dev/pts/";

struct Speed {
  std::uint32_t baud;
  speed_t code;
};
constexpr std::array speeds{
    Speed{1200, B1200},         Speed{2400, B2400},         Speed{4800, B4800},         Speed{9600, B9600},
    Speed{19'200, B19200},      Speed{38'400, B38400},      Speed{57'600, B57600},      Speed{115'200, B115200},
    Speed{230'400, B230400},    Speed{460'800, B460800},    Speed{500'000, B500000},    Speed{921'600, B921600},
    Speed{1'000'000, B1000000}, Speed{2'000'000, B2000000}, Speed{3'000'000, B3000000}, Speed{4'000'000, B4000000}};

[[nodiscard]] const Speed* find_speed(std::uint32_t baud) noexcept {
  const auto found = std::ranges::find(speeds, baud, &Speed::baud);
  return found != speeds.end() ? &*found : nullptr;
}

[[nodiscard]] bool is_raw(int line) noexcept {
  termios settings{};
  return ::tcgetattr(line, &settings) == 0 && (settings.c_lflag & (ICANON | ECHO | ISIG)) == 0 &&
         (settings.c_oflag & OPOST) == 0;
}

/// Octets as they are, both ways, and nothing of before.
[[nodiscard]] Result<> make_raw(int line, std::uint32_t baud) noexcept {
  termios settings{};
  if (::tcgetattr(line, &settings) != 0) return fail(ErrorCode::InvalidArgument, "this is no serial line", errno);
  ::cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  // Neither is a device reset by who opens its line, nor does a frame wait for wires that many have not.
  settings.c_cflag &= ~static_cast<tcflag_t>(HUPCL | CRTSCTS | CSTOPB | PARENB);
  settings.c_cc[VMIN] = 1;
  settings.c_cc[VTIME] = 0;
  const Speed* const speed = find_speed(baud);
  if (speed == nullptr || ::cfsetspeed(&settings, speed->code) != 0)
    return fail(ErrorCode::InvalidArgument, "no line has this speed", baud);
  if (::tcsetattr(line, TCSANOW, &settings) != 0)
    return fail(ErrorCode::SystemFailure, "settings of a serial line", errno);
  (void)::tcflush(line, TCIOFLUSH);
  return ok();
}

/// What opens a line that is there. Unavailable: it is not.
[[nodiscard]] Result<FileDescriptor> open_line(const SerialLine& wanted) noexcept {
  FileDescriptor line{::open(wanted.path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)};
  if (!line) return fail(ErrorCode::Unavailable, "serial line", errno);
  // The number of a pseudo-terminal that ended is given to the next one, which may be somebody's terminal.
  std::array<char, 64> name{};
  const bool pseudo = ::ttyname_r(line.get(), name.data(), name.size()) == 0 &&
                      std::string_view{name.data()}.starts_with(pseudo_terminals);
  if (pseudo && !is_raw(line.get())) return fail(ErrorCode::Unavailable, "its device has not made the terminal raw");
  if (::flock(line.get(), LOCK_EX | LOCK_NB) != 0)
    return fail(ErrorCode::AlreadyExists, "another process has this line", errno);
  HIROSCO_TRY(make_raw(line.get(), wanted.baud));
  return line;
}

template <class T>
[[nodiscard]] bool is_gone(const Result<T>& result) noexcept {
  return !result && result.error().code == ErrorCode::Unavailable && result.error().value != 0;
}

/// A line by its path, which may come and go.
class SerialFlow final : public DataFlow {
 public:
  SerialFlow(SerialLine wanted, FileDescriptor line, Framing framing)
      : wanted_{std::move(wanted)}, line_{std::move(line)}, stream_{FramedStream::Carrier::Line, framing} {
    was_there_ = line_.valid();
  }

 private:
  [[nodiscard]] bool ready() noexcept {
    if (line_) return true;
    const TimePoint now = clock_.now();
    if (now < next_try_) return false;
    next_try_ = now + reconnect_pause;
    auto line = open_line(wanted_);
    if (!line) return false;
    line_ = std::move(*line);
    stream_.restart();
    sent_octets_ = 0;
    was_there_ = true;
    return true;
  }

  [[nodiscard]] Result<> do_send(Octets frame) noexcept override {
    if (frame.size() > max_frame_octets)
      return fail(ErrorCode::OutOfRange, "octets of frame", static_cast<std::int64_t>(frame.size()));
    for (int tries = 0; tries < 2 && ready(); ++tries) {
      // What waits is sent in its time, so what goes behind it comes late: at most the frame before may still be there.
      int waiting = 0;
      if (::ioctl(line_.get(), TIOCOUTQ, &waiting) == 0 && waiting > static_cast<int>(sent_octets_))
        return fail(ErrorCode::Unavailable, "the line is slower than the cycle");
      const auto sent = stream_.send(line_.get(), frame);
      if (sent) sent_octets_ = frame.size() + stream_overhead_octets;
      if (!is_gone(sent)) return sent;
      line_.reset();
    }
    return fail(ErrorCode::Unavailable, "nobody listens");
  }

  [[nodiscard]] Result<Received> do_receive(MutableOctets buffer) noexcept override {
    if (!ready()) return was_there_ ? Result<Received>{fail(ErrorCode::Unavailable, "peer has hung up")} : Received{};
    auto received = stream_.receive(line_.get(), buffer);
    if (is_gone(received)) line_.reset();
    return received;
  }

  [[nodiscard]] bool do_wait(Duration timeout) noexcept override {
    const TimePoint end = clock_.now() + timeout;
    do {
      const Duration left = std::max(end - clock_.now(), Duration::zero());
      if (ready()) {
        pollfd looked{line_.get(), POLLIN, 0};
        const timespec rest{left / std::chrono::seconds{1}, (left % std::chrono::seconds{1}).count()};
        return ::ppoll(&looked, 1, &rest, nullptr) > 0;
      }
      sleep_until(clock_.now() + std::min(left, reconnect_pause));
    } while (clock_.now() < end);
    return false;
  }

  SystemClock clock_;
  SerialLine wanted_;
  FileDescriptor line_;
  FramedStream stream_;
  TimePoint next_try_{};
  std::size_t sent_octets_{0};
  bool was_there_{false};
};

/// The device's end of a pseudo-terminal.
class PseudoTerminal final : public DataFlow {
 public:
  PseudoTerminal(std::string link, std::string target, FileDescriptor master, Framing framing)
      : link_{std::move(link)},
        target_{std::move(target)},
        master_{std::move(master)},
        stream_{FramedStream::Carrier::Line, framing} {}
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;
  ~PseudoTerminal() override {
    std::array<char, 64> found{};
    const ssize_t octets = ::readlink(link_.c_str(), found.data(), found.size());
    if (octets > 0 && target_ == std::string_view{found.data(), static_cast<std::size_t>(octets)})
      (void)::unlink(link_.c_str());
  }

 private:
  [[nodiscard]] Result<> do_send(Octets frame) noexcept override { return stream_.send(master_.get(), frame); }
  [[nodiscard]] Result<Received> do_receive(MutableOctets buffer) noexcept override {
    auto received = stream_.receive(master_.get(), buffer);
    // Whoever opens it next begins with a whole frame.
    if (is_gone(received)) stream_.restart();
    return received;
  }
  [[nodiscard]] bool do_wait(Duration timeout) noexcept override {
    const TimePoint end = clock_.now() + timeout;
    do {
      pollfd looked{master_.get(), POLLIN, 0};
      const Duration left = std::max(end - clock_.now(), Duration::zero());
      const timespec rest{left / std::chrono::seconds{1}, (left % std::chrono::seconds{1}).count()};
      if (::ppoll(&looked, 1, &rest, nullptr) > 0 && (looked.revents & POLLIN) != 0) return true;
      // That nobody has it open is told at once each time.
      if (looked.revents != 0) sleep_until(std::min(end, clock_.now() + std::chrono::milliseconds{1}));
    } while (clock_.now() < end);
    return false;
  }

  SystemClock clock_;
  std::string link_;
  std::string target_;
  FileDescriptor master_;
  FramedStream stream_;
};

/// Whether a device lives behind the link. A file that is no link to a pseudo-terminal is nobody's to replace.
[[nodiscard]] Result<> make_room(const std::string& link) {
  struct stat status{};
  if (::lstat(link.c_str(), &status) != 0) return ok();
  std::array<char, 64> found{};
  const ssize_t octets = ::readlink(link.c_str(), found.data(), found.size());
  const std::string_view target{found.data(), octets > 0 ? static_cast<std::size_t>(octets) : 0};
  if (!target.starts_with(pseudo_terminals))
    return fail(ErrorCode::AlreadyExists, "the name of a pseudo-terminal is a file's");
  const FileDescriptor living{::open(link.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)};
  if (living && is_raw(living.get())) return fail(ErrorCode::AlreadyExists, "this side of the flow is open");
  (void)::unlink(link.c_str());
  return ok();
}

[[nodiscard]] Result<std::unique_ptr<DataFlow>> make_pseudo_terminal(const SerialLine& wanted, Framing framing) {
  HIROSCO_TRY(make_room(wanted.path));
  FileDescriptor master{::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)};
  std::array<char, 64> name{};
  if (!master || ::grantpt(master.get()) != 0 || ::unlockpt(master.get()) != 0 ||
      ::ptsname_r(master.get(), name.data(), name.size()) != 0)
    return fail(ErrorCode::SystemFailure, "make a pseudo-terminal", errno);
  HIROSCO_TRY(make_raw(master.get(), wanted.baud));
  if (::symlink(name.data(), wanted.path.c_str()) != 0)
    return fail(ErrorCode::SystemFailure, "link to a pseudo-terminal", errno);
  return std::make_unique<PseudoTerminal>(wanted.path, name.data(), std::move(master), framing);
}

}  // namespace

Result<std::unique_ptr<DataFlow>> open_serial_flow(const FlowOpening& opening) {
  HIROSCO_TRY_LET(SerialLine line, read_serial_line(opening.address));
  if (opening.side == FlowSide::Device && !line.path.starts_with(devices))
    return make_pseudo_terminal(line, opening.framing);
  auto opened = open_line(line);
  // One that is not there may be plugged in later.
  if (!opened && opened.error().code != ErrorCode::Unavailable) return fail(opened.error());
  return std::make_unique<SerialFlow>(std::move(line), opened ? std::move(*opened) : FileDescriptor{}, opening.framing);
}

namespace {

[[nodiscard]] std::string file_of_line(const std::string& address) {
  const std::string line = address.substr(0, address.rfind('@'));
  return line.starts_with('/') ? line : "/dev/pts";
}

}  // namespace

void let_in_serial(const std::string& address, Sandbox& sandbox) { let_write(file_of_line(address), sandbox); }

bool is_reached_by_serial(const std::string& address, const Sandbox& sandbox) {
  return may_write(file_of_line(address), sandbox);
}

std::string_view why_not_own_serial(const std::string& address) {
  return address.starts_with('/') ? "" : "a pseudo-terminal belongs to whoever plays the device";
}

}  // namespace hirosco
