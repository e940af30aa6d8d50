// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/hear_safe.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>

namespace hirosco::tools {

HeardSafe hear_safe(int socket, std::chrono::steady_clock::time_point limit,
                    const std::function<void(std::string_view)>& print) {
  using supervisor::SafeAnswer;
  SafeAnswer answer;
  // Whatever ends it: by what was said it is known whether that was all, and never by how it ended.
  const auto ended = [&](std::string_view how) -> HeardSafe {
    if (answer.stop() == SafeAnswer::Stop::Nobody) return {};
    const std::string_view why = answer.why_not_whole();
    return {answer.stop(), why.empty() || how.empty() ? std::string{why} : fmt::format("{} ({})", why, how)};
  };
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(limit - std::chrono::steady_clock::now());
    pollfd wanted{socket, POLLIN, 0};
    const int ready = ::poll(&wanted, 1, static_cast<int>(std::max<std::int64_t>(left.count(), 0)));
    if (ready < 0 && errno == EINTR) continue;
    if (ready < 0) return ended(std::strerror(errno));
    if (ready == 0) return ended("no more came in time");
    std::array<char, 512> line;
    const auto octets = ::recv(socket, line.data(), line.size(), MSG_DONTWAIT | MSG_TRUNC);
    if (octets < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (octets < 0) return ended(std::strerror(errno));
    if (octets == 0) return ended("the connection ended");
    const std::size_t here = std::min(static_cast<std::size_t>(octets), line.size());
    const std::string_view message{line.data(), here};
    if (here < static_cast<std::size_t>(octets)) {
      answer.take_cut_off();
      print(message);
      continue;
    }
    if (const auto words = answer.take(message); !words.empty()) print(words);
  }
}

}  // namespace hirosco::tools
