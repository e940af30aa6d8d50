// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/shell/gzip.hpp"

#include <array>
#include <boost/beast/zlib/deflate_stream.hpp>
#include <boost/crc.hpp>
#include <cstdint>

namespace hirosco::ground {
namespace {

namespace zlib = boost::beast::zlib;

constexpr int level = 6, window_bits = 15, memory_level = 8;
/// Identification, deflate, no flags, no time, no extra flags, system unknown.
constexpr std::array<char, 10> header{'\x1f', '\x8b', 8, 0, 0, 0, 0, 0, 0, '\xff'};

void append_little_endian(std::string& to, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) to += static_cast<char>(value >> static_cast<unsigned>(8 * i) & 0xFFU);
}

}  // namespace

std::optional<std::string> zipped(std::string_view text) {
  if (text.size() < least_zipped_octets || text.size() > most_zipped_octets) return std::nullopt;
  zlib::deflate_stream stream;
  stream.reset(level, window_bits, memory_level, zlib::Strategy::normal);
  std::string out{header.begin(), header.end()};
  const std::size_t before = out.size();
  out.resize(before + stream.upper_bound(text.size()));
  zlib::z_params parameters;
  parameters.next_in = text.data();
  parameters.avail_in = text.size();
  parameters.next_out = out.data() + before;
  parameters.avail_out = out.size() - before;
  boost::beast::error_code failed;
  stream.write(parameters, zlib::Flush::finish, failed);
  if (failed != zlib::error::end_of_stream) return std::nullopt;
  out.resize(before + parameters.total_out);
  boost::crc_32_type sum;
  sum.process_bytes(text.data(), text.size());
  append_little_endian(out, sum.checksum());
  append_little_endian(out, static_cast<std::uint32_t>(text.size()));
  return out.size() < text.size() ? std::optional{std::move(out)} : std::nullopt;
}

bool takes_gzip(std::string_view accepts) {
  const std::size_t at = accepts.find("gzip");
  if (at == std::string_view::npos) return false;
  const std::string_view weight = accepts.substr(at + 4, accepts.find(',', at) - at - 4);
  const std::size_t digits = weight.find("q=");
  return digits == std::string_view::npos ||
         weight.substr(digits + 2).find_first_of("123456789") != std::string_view::npos;
}

}  // namespace hirosco::ground
