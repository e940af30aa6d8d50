// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/command_line.hpp"

#include <CLI/CLI.hpp>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <new>
#include <system_error>

#include "hirosco/utilities/os/last_words.hpp"
#include "tools/hirosco/commands.hpp"

namespace hirosco::tools {

Duration duration_of(const std::string& text) {
  std::size_t used = 0;
  double number = 0.0;
  try {
    number = std::stod(text, &used);
  } catch (const std::exception&) {
    throw CLI::ValidationError("not a duration: '" + text + "' (for example 60s, 500ms, 10min)");
  }
  const std::string unit = text.substr(used);
  const double scale = unit == "ms"                   ? 1e-3
                       : unit == "min" || unit == "m" ? 60.0
                       : unit == "h"                  ? 3600.0
                       : unit.empty() || unit == "s"  ? 1.0
                                                      : -1.0;
  constexpr double longest_s = 1e7;
  if (scale < 0 || !(number >= 0) || number * scale > longest_s)
    throw CLI::ValidationError("not a duration: '" + text + "' (for example 60s, 500ms, 10min)");
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(number * scale));
}

std::uint64_t seed_of(const std::string& text) {
  std::uint64_t seed = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (problem != std::errc{} || end != text.data() + text.size() || text.empty())
    throw CLI::ValidationError("not a seed: '" + text + "' (0 to 18446744073709551615)");
  return seed;
}

int run_main(const char* program, const std::function<int()>& run) {
  say_last_words(program);  // of its threads: what main itself meets is caught
  int code = exit_internal;
  try {
    code = run();
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
    std::fprintf(stderr, "%s: what it prints cannot be written: %s\n", program, std::strerror(errno));
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "%s: no memory left for this\n", program);
  } catch (const std::system_error& problem) {
    // Output that fails, a thread that cannot be started.
    std::fprintf(stderr, "%s: %s\n", program, problem.what());
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "%s: %s\n", program, problem.what());
    return exit_internal;
  }
  return exit_environment;
}

}  // namespace hirosco::tools
