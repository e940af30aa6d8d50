// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <signal.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/fuzz/fuzz.hpp"

/// Calls a fuzz target without libFuzzer, so that a slice of each is in the checks: the inputs of a corpus, then so many that come of them by
/// small changes, always the same for one seed. It knows nothing of what an input reaches: what finds defects are sanitizers and what the
/// target expects. Whatever ends the process, the input is told in hexadecimal, and `--input` takes it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
/// Of the run-time library of a sanitizer; null without one.
extern "C" [[gnu::weak]] void __sanitizer_set_death_callback(void (*callback)());  // NOLINT: its name

namespace hirosco::fuzz {
namespace {

constexpr const char* usage =
    "usage: fuzz_slice_TARGET CORPUS [--runs N] [--seed N] [--longest OCTETS] [--patience SECONDS] [--input HEX]\n";
constexpr int exit_found = 1, exit_usage = 2;

struct Options {
  std::filesystem::path corpus;
  std::uint64_t runs{10'000};
  std::uint64_t seed{1};
  std::size_t longest{400};  ///< octets of an input; those of the corpus may be longer
  unsigned patience_s{20};  ///< of the processor, for one input
  std::optional<std::string> input;
};

/// What is being tried: handlers of signals are told nothing else.
struct Trying {
  std::uint64_t run{0};
  const std::string* input{nullptr};
};
Trying trying;

/// Here and below: as handlers of signals may.
void tell(std::string_view words) noexcept {
  while (!words.empty()) {
    const auto written = ::write(STDERR_FILENO, words.data(), words.size());
    if (written <= 0) return;
    words.remove_prefix(static_cast<std::size_t>(written));
  }
}

void tell_input() noexcept {
  const std::string* const input = std::exchange(trying.input, nullptr);
  if (input == nullptr) return;
  std::array<char, 24> number{};
  const char* const end = std::to_chars(number.data(), number.data() + number.size(), trying.run).ptr;
  tell("\nrun ");
  tell({number.data(), static_cast<std::size_t>(end - number.data())});
  tell(", input: ");
  constexpr std::string_view digits = "0123456789abcdef";
  for (const char letter : *input) {
    const auto octet = static_cast<unsigned char>(letter);
    const std::array hex{digits[octet >> 4U], digits[octet & 15U]};
    tell({hex.data(), hex.size()});
  }
  tell("\n");
}

/// abort() ends the process when this returns.
void on_abort(int) noexcept { tell_input(); }
void on_lost_patience(int) noexcept {
  tell("\nan input takes too long");
  tell_input();
  ::_exit(exit_found);
}

void watch_for_ends() {
  if (__sanitizer_set_death_callback != nullptr) __sanitizer_set_death_callback([] { tell_input(); });
  ::signal(SIGABRT, on_abort);
  ::signal(SIGPROF, on_lost_patience);
}

void try_input(const std::string& input, unsigned patience_s) {
  trying.input = &input;
  itimerval limit{};
  limit.it_value.tv_sec = static_cast<time_t>(patience_s);
  ::setitimer(ITIMER_PROF, &limit, nullptr);
  // As long as it is, so that reading behind it shows.
  const auto octets = std::make_unique<std::uint8_t[]>(input.size());
  std::ranges::copy(input, octets.get());
  static_cast<void>(LLVMFuzzerTestOneInput(octets.get(), input.size()));
  trying.input = nullptr;
}

// -- inputs -----------------------------------------------------------------------------------------------------------

[[nodiscard]] bool is_of_word(char letter) noexcept {
  return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_' || letter == '.' || letter == '-';
}

/// Those of a corpus, then changed ones.
class Inputs {
 public:
  Inputs(std::vector<std::string> seeds, std::size_t longest, std::uint64_t seed)
      : seeds_{std::move(seeds)}, longest_{longest}, random_{seed} {
    for (const std::string& each : seeds_)
      for (std::size_t at = 0; at < each.size();) {
        const std::string word = word_at(each, at);
        at += word.size() + 1;
        if (!word.empty()) words_.push_back(word);
      }
    std::ranges::sort(words_);
    words_.erase(std::unique(words_.begin(), words_.end()), words_.end());
  }

  [[nodiscard]] std::string next() {
    if (given_ < seeds_.size()) return seeds_[given_++];
    std::string input = !kept_.empty() && below(4) == 0 ? kept_[below(kept_.size())] : seeds_[below(seeds_.size())];
    const std::size_t room = std::max(longest_, input.size());
    const std::size_t changes = 1 + below(below(16) == 0 ? 16 : 4);
    for (std::size_t i = 0; i < changes; ++i) change(input);
    if (input.size() > room) input.resize(room);
    // Changed ones are changed on: what needs several of them is reached, too.
    constexpr std::size_t most_kept = 64;
    if (kept_.size() < most_kept) kept_.push_back(input);
    else kept_[below(most_kept)] = input;
    return input;
  }

 private:
  struct Range {
    std::size_t at{0}, octets{0};
  };

  /// Not std::uniform_int_distribution, which is another one in each library.
  [[nodiscard]] std::size_t below(std::size_t count) { return static_cast<std::size_t>(random_() % count); }
  [[nodiscard]] char any_octet() { return static_cast<char>(below(256)); }
  /// Of a text that is not empty; most are short.
  [[nodiscard]] Range any_range(const std::string& text) {
    constexpr std::size_t short_one = 16;
    const std::size_t at = below(text.size());
    const std::size_t most = text.size() - at;
    return {at, 1 + below(below(8) == 0 ? most : std::min(most, short_one))};
  }
  [[nodiscard]] std::string any_part() {
    const std::string& other = seeds_[below(seeds_.size())];
    if (other.empty()) return {};
    const Range range = any_range(other);
    return other.substr(range.at, range.octets);
  }
  [[nodiscard]] static std::string word_at(const std::string& text, std::size_t at) {
    std::size_t end = at;
    while (end < text.size() && is_of_word(text[end])) ++end;
    return text.substr(at, end - at);
  }

  void change(std::string& input) {
    if (input.empty()) {
      input = any_part();
      return;
    }
    const std::size_t at = below(input.size());
    const Range range = any_range(input);
    switch (below(12)) {
      case 0: input[at] = static_cast<char>(static_cast<unsigned char>(input[at]) ^ (1U << below(8))); return;
      case 1: input[at] = any_octet(); return;
      case 2: return put_limit(input, at);
      case 3: input[at] = static_cast<char>(static_cast<unsigned char>(input[at]) + 256 + below(9) - 4); return;
      case 4: input.erase(range.at, range.octets); return;
      case 5: input.insert(at, input.substr(range.at, range.octets)); return;
      case 6: input.resize(at); return;
      case 7: return put_octets(input, at);
      case 8: input.insert(at, any_part()); return;
      case 9: input.replace(range.at, range.octets, any_part()); return;
      case 10: return put_word(input, at);
      default: return put_number(input, at);
    }
  }

  void put_octets(std::string& input, std::size_t at) {
    const std::size_t count = 1 + below(8);
    input.insert(at, std::string(count, any_octet()));
  }
  /// A number of one to eight octets that is at an end of some type.
  void put_limit(std::string& input, std::size_t at) {
    constexpr std::array<std::uint64_t, 12> limits{0,
                                                   1,
                                                   0x7F,
                                                   0x80,
                                                   0x7FFF,
                                                   0x8000,
                                                   0x7FFF'FFFF,
                                                   0x8000'0000,
                                                   0x7FFF'FFFF'FFFF'FFFF,
                                                   0x8000'0000'0000'0000,
                                                   std::uint64_t{0} - 2,
                                                   std::uint64_t{0} - 1};
    const std::size_t octets = std::size_t{1} << below(4);
    const std::uint64_t limit = limits[below(limits.size())];
    const bool big_endian = below(2) == 0;
    for (std::size_t i = 0; i < octets && at + i < input.size(); ++i) {
      const std::size_t place = big_endian ? octets - 1 - i : i;
      input[at + i] = static_cast<char>(limit >> (8 * place) & 0xFFU);
    }
  }
  /// Another word of the corpus where one stands.
  void put_word(std::string& input, std::size_t at) {
    while (at > 0 && is_of_word(input[at - 1])) --at;
    if (!words_.empty()) input.replace(at, word_at(input, at).size(), words_[below(words_.size())]);
  }
  /// A telling number in digits where digits stand.
  void put_number(std::string& input, std::size_t at) {
    constexpr std::array<std::string_view, 14> numbers{"0",
                                                       "1",
                                                       "-1",
                                                       "0.5",
                                                       "255",
                                                       "256",
                                                       "65536",
                                                       "4294967295",
                                                       "4294967296",
                                                       "9223372036854775808",
                                                       "18446744073709551616",
                                                       "1e308",
                                                       "1e999",
                                                       "nan"};
    const auto is_digit = [](char letter) { return letter >= '0' && letter <= '9'; };
    const auto first = std::find_if(input.begin() + static_cast<std::ptrdiff_t>(at), input.end(), is_digit);
    const auto last = std::find_if_not(first, input.end(), is_digit);
    if (first != input.end()) input.replace(first, last, numbers[below(numbers.size())]);
  }

  std::vector<std::string> seeds_, kept_, words_;
  std::size_t longest_;
  std::size_t given_{0};
  std::mt19937_64 random_;
};

// -- what is asked for ------------------------------------------------------------------------------------------------

/// Empty: these are no pairs of hexadecimal digits, with or without blanks.
[[nodiscard]] std::optional<std::string> from_hex(std::string_view text) {
  std::string octets;
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    if (text.empty()) return octets;
    unsigned octet = 0;
    const std::string_view two = text.substr(0, 2);
    const auto [end, problem] = std::from_chars(two.data(), two.data() + two.size(), octet, 16);
    if (two.size() != 2 || problem != std::errc{} || end != two.data() + 2) return std::nullopt;
    octets += static_cast<char>(octet);
    text.remove_prefix(2);
  }
}

/// Of a line of a corpus (README.md); empty: of none of its forms.
[[nodiscard]] std::optional<std::string> seed_of(const std::string& line, const std::filesystem::path& folder) {
  constexpr std::string_view as_text = "text ", as_file = "file ";
  if (line.starts_with(as_text)) {
    std::string text = line.substr(as_text.size());
    for (std::size_t at = 0; (at = text.find("\\n", at)) != std::string::npos; ++at) text.replace(at, 2, "\n");
    return text;
  }
  if (!line.starts_with(as_file)) return from_hex(line);
  std::ifstream file{folder / line.substr(as_file.size()), std::ios::binary};
  if (!file) return std::nullopt;
  return std::string{std::istreambuf_iterator<char>{file}, {}};
}

/// Nothing: told why.
[[nodiscard]] std::vector<std::string> seeds_of(const std::filesystem::path& corpus) {
  std::vector<std::string> seeds;
  std::ifstream file{corpus};
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.starts_with('#')) continue;
    auto seed = seed_of(line, corpus.parent_path());
    if (!seed) {
      std::fprintf(stderr, "%s: neither octets in hexadecimal, nor text, nor a file that is there: %s\n",
                   corpus.c_str(), line.c_str());
      return {};
    }
    seeds.push_back(std::move(*seed));
  }
  if (seeds.empty()) std::fprintf(stderr, "%s: there is no input in it\n", corpus.c_str());
  return seeds;
}

template <class Whole>
[[nodiscard]] bool read_whole(std::string_view text, Whole& number) {
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
  return problem == std::errc{} && end == text.data() + text.size();
}

[[nodiscard]] std::optional<Options> options_of(const std::vector<std::string>& words) {
  Options options;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (!word.starts_with("--") && options.corpus.empty()) {
      options.corpus = word;
      continue;
    }
    if (++i == words.size()) return std::nullopt;
    const std::string& value = words[i];
    bool good = false;
    if (word == "--runs") good = read_whole(value, options.runs);
    else if (word == "--seed") good = read_whole(value, options.seed);
    else if (word == "--longest") good = read_whole(value, options.longest);
    else if (word == "--patience") good = read_whole(value, options.patience_s);
    else if (word == "--input") good = (options.input = from_hex(value)).has_value();
    if (!good) return std::nullopt;
  }
  return options.corpus.empty() ? std::nullopt : std::optional{options};
}

[[nodiscard]] int run(const Options& options) {
  watch_for_ends();
  if (options.input) {
    try_input(*options.input, options.patience_s);
    std::printf("nothing found\n");
    return 0;
  }
  std::vector<std::string> seeds = seeds_of(options.corpus);
  if (seeds.empty()) return exit_usage;
  const std::size_t of_corpus = seeds.size();
  Inputs inputs{std::move(seeds), options.longest, options.seed};
  const std::uint64_t runs = std::max<std::uint64_t>(options.runs, of_corpus);
  for (; trying.run < runs; ++trying.run) {
    if (trying.run == of_corpus && taken_so_far() == 0) {
      std::fprintf(stderr, "%s: nothing in it is taken any more, so that what comes of it reaches nothing\n",
                   options.corpus.c_str());
      return exit_found;
    }
    try_input(inputs.next(), options.patience_s);
  }
  std::printf("%llu runs of seed %llu in %.1f s of the processor, %llu times something was taken: nothing found\n",
              static_cast<unsigned long long>(runs), static_cast<unsigned long long>(options.seed),
              static_cast<double>(std::clock()) / CLOCKS_PER_SEC, static_cast<unsigned long long>(taken_so_far()));
  return 0;
}

}  // namespace
}  // namespace hirosco::fuzz

int main(int count, char** words) {
  const auto options = hirosco::fuzz::options_of({words + 1, words + count});
  if (options) return hirosco::fuzz::run(*options);
  std::fputs(hirosco::fuzz::usage, stderr);
  return hirosco::fuzz::exit_usage;
}
