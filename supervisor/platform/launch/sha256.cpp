// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/sha256.hpp"

#include <openssl/crypto.h>
#include <openssl/evp.h>

#include <array>
#include <cstddef>
#include <string_view>

namespace hirosco::supervisor {

Result<std::string> sha256(Octets octets) {
  // A file of settings may name code to be loaded: none is read. Nor does it leave anything to be done at the end of a process
  // that may stand still.
  ::OPENSSL_init_crypto(OPENSSL_INIT_NO_LOAD_CONFIG | OPENSSL_INIT_NO_ATEXIT, nullptr);
  std::array<unsigned char, 32> digest{};
  unsigned int length = 0;
  if (::EVP_Digest(octets.data(), octets.size(), digest.data(), &length, ::EVP_sha256(), nullptr) != 1 ||
      length != digest.size())
    return fail(ErrorCode::SystemFailure, "libcrypto refuses SHA-256");
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
