// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/sha256.hpp"

#include <nettle/sha2.h>

#include <array>
#include <cstdint>
#include <string_view>

namespace hirosco::supervisor {

std::string sha256(Octets octets) {
  sha256_ctx context{};
  ::sha256_init(&context);
  ::sha256_update(&context, octets.size(), reinterpret_cast<const std::uint8_t*>(octets.data()));
  std::array<std::uint8_t, SHA256_DIGEST_SIZE> digest{};
  ::sha256_digest(&context, digest.size(), digest.data());
  constexpr std::string_view digits{"0123456789abcdef"};
  std::string text;
  text.reserve(2 * digest.size());
  for (const unsigned octet : digest) {
    text += digits[octet >> 4U];
    text += digits[octet & 0xFU];
  }
  return text;
}

}  // namespace hirosco::supervisor
